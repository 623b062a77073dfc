(** The checker: executable, and accepts exactly what the law allows. *)
Require Import ZArith List Bool Lia FinFun.
From Carproof Require Import Law Stops Collections Timeline Journey.
Import ListNotations.
Open Scope Z_scope.

(** * Instances *)

Definition swap (move : Z * Z) : Z * Z := (snd move, fst move).

(** The rules instance/... . *)
Definition instance_accepted (i : instance) : bool :=
  let ids := Ids.of_list (resource_ids i) in
  let known := Ids.contains ids in
  let edge_set := Pairs.of_list (edges i) in
  Ids.distinct (resource_ids i)
  && forallb (fun r => (1 <=? capacity r) && (1 <=? duration r)) (resources i)
  && forallb (fun e => negb (fst e =? snd e) && known (fst e) && known (snd e)) (edges i)
  && Pairs.distinct (edges i)
  && (directed i || forallb (fun e => negb (Pairs.contains edge_set (swap e))) (edges i))
  && Ids.distinct (map group_id (groups i))
  && forallb (fun g =>
       negb (length (group_resources g) =? 0)%nat && Ids.distinct (group_resources g)
       && forallb known (group_resources g) && (1 <=? group_capacity g)) (groups i)
  && Ids.distinct (robot_ids i)
  && forallb (fun a =>
       known (start a) && stops_accepted known (stops a) && (0 <=? release a) && (1 <=? pace a)) (robots i).

Theorem instance_is_well_formed_exactly_when_accepted i : instance_accepted i = true <-> Well_formed i.
Proof.
  unfold instance_accepted. cbv zeta.
  rewrite !andb_true_iff, !forallb_forall, !Ids.distinct_iff, !Pairs.distinct_iff, orb_true_iff, forallb_forall. split.
  - intros ((((((((U & R) & E) & V) & D) & N) & G) & W) & A).
    assert (GH : forall g, In g (groups i) -> length (group_resources g) <> 0%nat /\ NoDup (group_resources g) /\
      (forall r, In r (group_resources g) -> In r (resource_ids i)) /\ 1 <= group_capacity g).
    { intros g X. specialize (G g X). rewrite !andb_true_iff, negb_true_iff, Nat.eqb_neq, Ids.distinct_iff,
        forallb_forall, Z.leb_le in G. destruct G as (((K & D') & C) & P). repeat split; auto.
      intros r Y. apply Ids.contains_of_list. auto. }
    assert (AH : forall a, In a (robots i) -> In (start a) (resource_ids i) /\ stops a <> [] /\
      (forall s, In s (stops a) -> In (stop_resource s) (resource_ids i)) /\
      (forall s, In s (stops a) -> 0 <= service s) /\
      (forall before s t later, stops a = before ++ s :: t :: later -> stop_resource s <> stop_resource t) /\
      0 <= release a /\ 1 <= pace a).
    { intros a X. specialize (A a X). unfold stops_accepted in A. rewrite !andb_true_iff, Ids.contains_of_list,
        neighbours_differ_iff, forallb_forall, negb_true_iff, Nat.eqb_neq, !Z.leb_le in A.
      destruct A as (((K & (L & S) & O) & T) & P). repeat split; auto.
      - intros F. apply L. rewrite F. reflexivity.
      - intros s Y. specialize (S s Y). rewrite andb_true_iff, Ids.contains_of_list in S. apply S.
      - intros s Y. specialize (S s Y). lia. }
    clear G A. constructor; auto.
    + intros r H. specialize (R r H). lia.
    + intros r H. specialize (R r H). lia.
    + intros r s H. specialize (E _ H). simpl in E. rewrite !andb_true_iff, !Ids.contains_of_list in E.
      destruct E as [[E K] L]. split; auto. intros <-. rewrite Z.eqb_refl in E. discriminate.
    + intros F r s H K. destruct D as [D|D]; [congruence|]. specialize (D _ H).
      apply negb_true_iff in D. change (swap (r, s)) with (s, r) in D.
      rewrite (proj2 (Pairs.contains_of_list _ _) K) in D. discriminate.
    + intros g X E0. destruct (GH g X) as [L _]. rewrite E0 in L. auto.
    + intros g r X. apply (GH g X).
    + intros g X. apply (GH g X).
    + intros g X. apply (GH g X).
    + intros a H. apply (AH a H).
    + intros a H. apply (AH a H).
    + intros a s H. apply (AH a H).
    + intros a s H. apply (AH a H).
    + intros a before s t later H. apply (AH a H).
    + intros a H. apply (AH a H).
    + intros a H. apply (AH a H).
  - intros [U C D E V W GI GN GG GO GC A P SN SR SS SD R S]. repeat split; auto.
    + intros r H. specialize (C r H). specialize (D r H). lia.
    + intros [r s] H. destruct (E r s H) as (N & K & L). simpl.
      rewrite !andb_true_iff, !Ids.contains_of_list. repeat split; auto.
      apply negb_true_iff, Z.eqb_neq. exact N.
    + destruct (directed i); [auto|]. right. intros [r s] H. apply negb_true_iff.
      destruct (Pairs.contains (Pairs.of_list (edges i)) (swap (r, s))) eqn:F; auto.
      apply Pairs.contains_of_list in F. destruct (W eq_refl r s H F).
    + intros g G. rewrite !andb_true_iff, negb_true_iff, Nat.eqb_neq, Ids.distinct_iff, forallb_forall, Z.leb_le.
      repeat split; auto.
      * intros K. apply length_zero_iff_nil in K. exact (GN g G K).
      * intros r H. apply Ids.contains_of_list. exact (GG g r G H).
    + intros a H. specialize (P a H). specialize (R a H). specialize (S a H). unfold stops_accepted.
      rewrite !andb_true_iff, Ids.contains_of_list, neighbours_differ_iff, forallb_forall, negb_true_iff, Nat.eqb_neq.
      repeat split; auto; try lia.
      * intros L. apply length_zero_iff_nil in L. exact (SN a H L).
      * intros s Y. specialize (SR a s H Y). specialize (SS a s H Y).
        rewrite andb_true_iff, Ids.contains_of_list, Z.leb_le. auto.
      * intros before s t later. exact (SD a before s t later H).
Qed.

(** * Plans *)

(** Keys of limits: resources have the even ones, groups the odd ones. *)
Definition resource_key (id : Z) : Z := 2 * id.
Definition group_key (g : group) : Z := 2 * group_id g + 1.

Definition resource_limits (i : instance) : list (Z * limit) :=
  map (fun r => (resource_key (resource_id r), Limit [resource_id r] (capacity r))) (resources i).
Definition group_limits (gs : list group) : list (Z * limit) :=
  map (fun g => (group_key g, Limit (group_resources g) (group_capacity g))) gs.
Definition keyed_limits (i : instance) : list (Z * limit) := resource_limits i ++ group_limits (groups i).

(** The keys of the limits that hold a place, by place. *)
Definition keys_by_place (ls : list (Z * limit)) : Map.t (list Z) :=
  fold_left (fun m l => fold_left (fun m place => enlist place (fst l) m) (limit_places (snd l)) m) ls
    (Map.empty (list Z)).

(** What the checker looks up: resources and robots by their ids, the moves of the graph, and limits: by their keys,
    and their keys by place. Of [swap_keys] two robots in one place that share a key are close. *)
Record lookup := Lookup {
  resource_of : Map.t resource; robot_of : Map.t robot; move_set : Pairs.S.t;
  limit_of : Map.t (Z * limit); limit_keys : Map.t (list Z); swap_keys : Map.t (list Z); counts_longer : Z
}.

(** The moves of the graph: its edges, and those of an undirected graph backwards too. *)
Definition moves_of_graph (i : instance) : list (Z * Z) :=
  if directed i then edges i else fold_left (fun all e => swap e :: all) (edges i) (edges i).

Definition lookup_of (i : instance) : lookup :=
  Lookup (index resource_id (resources i)) (index robot_id (robots i)) (Pairs.of_list (moves_of_graph i))
    (index fst (keyed_limits i)) (keys_by_place (keyed_limits i))
    (keys_by_place (resource_limits i ++ group_limits (filter (fun g => group_capacity g =? 1) (groups i)))) (gap i).

Section Lookup.
Variables (i : instance) (known : lookup).

Definition has_move (source target : Z) : bool := Pairs.contains (move_set known) (source, target).

Definition same_end (one other : option Z) : bool :=
  match one, other with Some l, Some m => l =? m | None, None => true | _, _ => false end.

(** plan/resource and plan/duration, for one visit. *)
Definition stay_accepted (a : robot) (v : visit) : bool :=
  match Map.find (visit_resource v) (resource_of known) with
  | None => false
  | Some r => match leave v with None => true | Some l => least_stay a r <=? l - enter v end
  end.

(** plan/goal, for the last visit. *)
Definition end_accepted (a : robot) (v : visit) : bool :=
  (visit_resource v =? goal a) &&
  match after_goal i, Map.find (goal a) (resource_of known) with
  | Park, _ => same_end (leave v) None
  | Vanish, Some r => same_end (leave v) (Some (enter v + last_stay a r))
  | Vanish, None => false
  end.

(** The rules [plan/...] from one visit on. *)
Fixpoint chain_accepted (a : robot) (v : visit) (later : list visit) : bool :=
  if stay_accepted a v then
    match later with
    | [] => end_accepted a v
    | w :: rest =>
      if same_end (leave v) (Some (enter w)) && has_move (visit_resource v) (visit_resource w)
      then chain_accepted a w rest else false
    end
  else false.

(** The rules [plan/...] of a robot's plan. *)
Definition plan_accepted (a : robot) (p : plan) : bool :=
  match visits p with
  | [] => false
  | v :: later => (visit_resource v =? start a) && (enter v =? release a) && chain_accepted a v later
    && serves_all (stops a) v later
  end.

(** The same of a plan of any robot; plans of robots that the instance does not have are left to solution/covers. *)
Definition plan_of_robot_accepted (p : plan) : bool :=
  match Map.find (plan_robot p) (robot_of known) with None => true | Some a => plan_accepted a p end.

(** * Plans together *)

(** The stays of plans by the keys of limits. *)
Definition keys_at (place : Z) : list Z := listed (limit_keys known) place.
Definition stays_in_limits (longer : Z) (ps : list plan) : Map.t (list stay) := timetable keys_at longer ps.

(** joint/capacity, joint/group and joint/following, of these limits and where a robot counts for so many ticks longer. *)
Definition limits_accepted (longer : Z) (ls : list (Z * limit)) (ps : list plan) : bool :=
  let stays := stays_in_limits longer ps in
  forallb (fun l => never_more_than (limit_capacity (snd l)) (listed stays (fst l))) ls.

(** What a move leaves and enters: the keys of limits, of those that hold one robot, and of the resources themselves. *)
Definition keys_of_one_only (place other : Z) : list Z :=
  let others := listed (swap_keys known) other in
  filter (fun key => negb (existsb (Z.eqb key) others)) (listed (swap_keys known) place).
Definition crossings (m : move) : list move :=
  let (tick, places) := m in
  let entered := keys_of_one_only (snd places) (fst places) in
  flat_map (fun one => map (fun other => (tick, (one, other))) entered) (keys_of_one_only (fst places) (snd places)).

Definition opposite (m : move) : move := (fst m, swap (snd m)).

(** joint/exchange. *)
Definition exchanges_accepted (ps : list plan) : bool :=
  let made := flat_map crossings (moves ps) in
  let made_set := Triples.of_list made in
  forallb (fun m => negb (Triples.contains made_set (opposite m))) made.

(** * Solutions *)

(** Both lists have the same elements, and none twice. *)
Definition same_members (one other : list Z) : bool :=
  let one_set := Ids.of_list one in
  let other_set := Ids.of_list other in
  Ids.distinct one && forallb (Ids.contains other_set) one && forallb (Ids.contains one_set) other.

(** solution/covers and solution/order. *)
Definition covers_accepted (s : solution) : bool := same_members (planned s ++ unplanned s) (robot_ids i).
Definition order_accepted (s : solution) : bool := same_members (order s) (planned s).
End Lookup.

(** The rules of a solution one after the other; the rules of plans together only where the others hold. *)
Definition accepted (i : instance) (s : solution) : bool :=
  let known := lookup_of i in
  covers_accepted i s
  && order_accepted s
  && forallb (plan_of_robot_accepted i known) (plans s)
  && limits_accepted known (counts_longer known) (keyed_limits i) (plans s)
  && exchanges_accepted known (plans s).

(** The instance is well-formed, and the solution keeps the law. *)
Definition solution_accepted (i : instance) (s : solution) : bool := instance_accepted i && accepted i s.

(** The total cost; each robot is looked up. *)
Definition solution_cost (i : instance) (s : solution) : Z :=
  let known := robot_of (lookup_of i) in
  fold_left (fun total p =>
    total + match Map.find (plan_robot p) known with Some a => cost a p | None => 0 end) (plans s) 0.

(** * Proofs: plans *)

Lemma same_end_iff one other : same_end one other = true <-> one = other.
Proof.
  destruct one as [l|], other as [m|]; simpl; split; intros H; try discriminate; auto.
  - apply Z.eqb_eq in H. congruence.
  - injection H as ->. apply Z.eqb_refl.
Qed.

Section Proofs.
Variable i : instance.
Hypothesis well_formed : Well_formed i.
Let known := lookup_of i.

Lemma has_move_iff r s : has_move known r s = true <-> Move i r s.
Proof.
  unfold has_move, known, lookup_of, move_set, moves_of_graph, Move. rewrite Pairs.contains_of_list.
  destruct (directed i); [intuition discriminate|].
  assert (H : forall l all, In (r, s) (fold_left (fun all e => swap e :: all) l all) <-> In (r, s) all \/ In (s, r) l).
  - induction l as [|[x y] l IH]; intros all; simpl; [tauto|]. rewrite IH. simpl. unfold swap. simpl. split.
    + intros [[E|H]|H]; auto. injection E as -> ->. auto.
    + intros [H|[E|H]]; auto. injection E as -> ->. auto.
  - rewrite H. tauto.
Qed.

Lemma find_resource id r : Map.find id (resource_of known) = Some r <-> In r (resources i) /\ resource_id r = id.
Proof. apply find_in_index. apply resource_ids_are_unique. exact well_formed. Qed.

Lemma resource_is_unique r s : In r (resources i) -> In s (resources i) -> resource_id r = resource_id s -> r = s.
Proof.
  intros R S E. assert (F : Map.find (resource_id s) (resource_of known) = Some r) by (apply find_resource; auto).
  assert (G : Map.find (resource_id s) (resource_of known) = Some s) by (apply find_resource; auto). congruence.
Qed.

Lemma find_robot id a : Map.find id (robot_of known) = Some a <-> In a (robots i) /\ robot_id a = id.
Proof. apply find_in_index. apply robot_ids_are_unique. exact well_formed. Qed.

Lemma robot_is_unique a b : In a (robots i) -> In b (robots i) -> robot_id a = robot_id b -> a = b.
Proof.
  intros A B E. assert (F : Map.find (robot_id b) (robot_of known) = Some a) by (apply find_robot; auto).
  assert (G : Map.find (robot_id b) (robot_of known) = Some b) by (apply find_robot; auto). congruence.
Qed.

Lemma stay_accepted_iff a v : stay_accepted known a v = true <-> Stay_lawful i a v.
Proof.
  unfold stay_accepted, Stay_lawful. destruct (Map.find (visit_resource v) (resource_of known)) as [r|] eqn:F.
  - apply find_resource in F as [R E]. split.
    + intros H. split; [rewrite <- E; apply in_map; exact R|]. intros s l S G L. rewrite L in H.
      rewrite (resource_is_unique s r) by congruence. lia.
    + intros [_ H]. destruct (leave v) as [l|]; auto. specialize (H r l R E eq_refl). lia.
  - split; [discriminate|]. intros [K _]. apply in_map_iff in K as (r & E & R).
    assert (G : Map.find (visit_resource v) (resource_of known) = Some r) by (apply find_resource; auto). congruence.
Qed.

Lemma end_accepted_iff a v : In a (robots i) -> end_accepted i known a v = true <-> Ends i a v.
Proof.
  intros A. unfold end_accepted, Ends. rewrite andb_true_iff, Z.eqb_eq.
  destruct (after_goal i); [|rewrite same_end_iff; tauto].
  destruct (Map.find (goal a) (resource_of known)) as [r|] eqn:F.
  - apply find_resource in F as [R E]. rewrite same_end_iff. split; intros [G L]; (split; [exact G|]).
    + intros s S H. rewrite (resource_is_unique s r) by congruence. exact L.
    + exact (L r R E).
  - exfalso. apply find_in_index_none in F; [|apply resource_ids_are_unique; exact well_formed].
    apply F. exact (goal_is_a_resource i a well_formed A).
Qed.

Lemma chain_accepted_iff a later : In a (robots i) ->
  forall v, chain_accepted i known a v later = true <-> Chain i a v later.
Proof.
  intros A. induction later as [|w rest IH]; intros v; simpl.
  - pose proof (stay_accepted_iff a v) as S. pose proof (end_accepted_iff a v A) as E.
    destruct (stay_accepted known a v); intuition discriminate.
  - pose proof (stay_accepted_iff a v) as S. destruct (stay_accepted known a v); [|intuition discriminate].
    destruct (same_end (leave v) (Some (enter w)) && has_move known (visit_resource v) (visit_resource w)) eqn:H.
    + apply andb_true_iff in H as [L M]. apply same_end_iff in L. apply has_move_iff in M. rewrite IH. tauto.
    + split; [discriminate|]. intros (_ & L & M & _). apply andb_false_iff in H as [H|H].
      * apply same_end_iff in L. congruence.
      * apply has_move_iff in M. congruence.
Qed.

Theorem plan_accepted_iff a p : In a (robots i) -> plan_accepted i known a p = true <-> Plan_lawful i a p.
Proof.
  intros A. rewrite plan_lawful_iff. unfold plan_accepted. destruct (visits p) as [|v later].
  - split; [discriminate|]. intros (v & later & E & _). discriminate.
  - rewrite !andb_true_iff, !Z.eqb_eq, plans_that_serve_all_are_counted, chain_accepted_iff by exact A. split.
    + intros (((R & T) & C) & S). exists v, later. auto.
    + intros (w & rest & E & R & T & C & S). injection E as <- <-. auto.
Qed.

Lemma plans_accepted_iff ps : forallb (plan_of_robot_accepted i known) ps = true <-> Plans_lawful i ps.
Proof.
  rewrite forallb_forall. unfold Plans_lawful, plan_of_robot_accepted. split.
  - intros H p a P A E. specialize (H p P). destruct (Map.find (plan_robot p) (robot_of known)) as [b|] eqn:F.
    + apply find_robot in F as F'. destruct F' as [B G].
      assert (K : Map.find (plan_robot p) (robot_of known) = Some a) by (apply find_robot; auto).
      rewrite F in K. injection K as ->. apply plan_accepted_iff; auto.
    + assert (K : Map.find (plan_robot p) (robot_of known) = Some a) by (apply find_robot; auto). congruence.
  - intros H p P. destruct (Map.find (plan_robot p) (robot_of known)) as [a|] eqn:F; auto.
    apply find_robot in F as [A E]. apply plan_accepted_iff; auto.
Qed.

(** * Proofs: limits and their keys *)

Lemma gap_is_short : 0 <= gap i <= 1.
Proof. unfold gap. destruct (following_is_forbidden i); lia. Qed.

Lemma listed_in_places key place ps : forall m : Map.t (list Z),
  listed (fold_left (fun m p => enlist p key m) ps m) place
  = repeat key (length (filter (Z.eqb place) ps)) ++ listed m place.
Proof.
  induction ps as [|p ps IH]; intros m; simpl; auto. rewrite IH, listed_enlist. rewrite (Z.eqb_sym p place).
  destruct (Z.eqb_spec place p) as [<-|N]; auto. simpl.
  change (key :: listed m place) with ([key] ++ listed m place). rewrite app_assoc, <- repeat_cons. reflexivity.
Qed.

Lemma in_keys_by_place ls key place :
  In key (listed (keys_by_place ls) place) <-> exists l, In (key, l) ls /\ In place (limit_places l).
Proof.
  unfold keys_by_place. enough (H : forall m, In key (listed (fold_left (fun m l => fold_left (fun m p => enlist p (fst l) m)
    (limit_places (snd l)) m) ls m) place) <-> (exists l, In (key, l) ls /\ In place (limit_places l)) \/
    In key (listed m place)).
  { rewrite H, listed_empty. simpl. tauto. }
  induction ls as [|[k l] ls IH]; intros m; simpl.
  - split; auto. intros [(l & [] & _)|H]. exact H.
  - rewrite IH, listed_in_places, in_app_iff.
    assert (R : In key (repeat k (length (filter (Z.eqb place) (limit_places l)))) <->
      k = key /\ In place (limit_places l)).
    { split.
      - intros H. pose proof (repeat_spec _ _ _ H) as <-. split; auto.
        destruct (filter (Z.eqb place) (limit_places l)) as [|x r] eqn:E; [destruct H|].
        assert (X : In x (filter (Z.eqb place) (limit_places l))) by (rewrite E; left; auto).
        apply filter_In in X as [X F]. apply Z.eqb_eq in F. congruence.
      - intros [<- H]. assert (X : In place (filter (Z.eqb place) (limit_places l))).
        { apply filter_In. split; auto. apply Z.eqb_refl. }
        destruct (filter (Z.eqb place) (limit_places l)); [destruct X | left; auto]. }
    rewrite R. split.
    + intros [(x & X)|[[<- H]|H]]; [left; exists x; tauto | left; exists l; auto | auto].
    + intros [(x & [X|X] & H)|H]; [injection X as -> ->; auto | left; eauto | auto].
Qed.

Lemma keys_by_place_are_different ls place : NoDup (map fst ls) ->
  (forall key l, In (key, l) ls -> NoDup (limit_places l)) -> NoDup (listed (keys_by_place ls) place).
Proof.
  intros N D. unfold keys_by_place.
  enough (H : forall m : Map.t (list Z), NoDup (listed m place) ->
    (forall key, In key (map fst ls) -> ~ In key (listed m place)) ->
    NoDup (listed (fold_left (fun m l => fold_left (fun m p => enlist p (fst l) m) (limit_places (snd l)) m) ls m) place)).
  { apply H; intros; rewrite ?listed_empty; [constructor | tauto]. }
  induction ls as [|[k l] ls IH]; intros m M K; simpl; auto. inversion N as [|? ? Nk Nl]; subst.
  specialize (D k l (or_introl eq_refl)) as Dl. specialize (IH Nl (fun key l' H => D key l' (or_intror H))).
  assert (L : (length (filter (Z.eqb place) (limit_places l)) <= 1)%nat).
  { clear -Dl. induction Dl as [|x ps X Dl IHl]; simpl; [lia|]. destruct (Z.eqb_spec place x) as [<-|]; [|exact IHl].
    simpl. enough (E : filter (Z.eqb place) ps = []) by (rewrite E; simpl; lia).
    destruct (filter (Z.eqb place) ps) as [|y r] eqn:E; auto.
    assert (Y : In y (filter (Z.eqb place) ps)) by (rewrite E; left; auto).
    apply filter_In in Y as [Y F]. apply Z.eqb_eq in F. congruence. }
  apply IH; rewrite listed_in_places.
  - destruct (filter (Z.eqb place) (limit_places l)) as [|x [|y r]]; simpl in *; auto; [|lia].
    constructor; auto.
  - intros key H X. apply in_app_or in X as [X|X]; [apply repeat_spec in X; subst; auto|].
    apply (K key); simpl; auto.
Qed.

Lemma keys_are_unique : NoDup (map fst (keyed_limits i)).
Proof.
  unfold keyed_limits, resource_limits, group_limits. rewrite map_app, !map_map. simpl.
  apply distinct_together.
  - rewrite <- (map_map resource_id resource_key). apply FinFun.Injective_map_NoDup.
    + intros x y. unfold resource_key. lia.
    + exact (resource_ids_are_unique i well_formed).
  - unfold group_key. rewrite <- (map_map group_id (fun n => 2 * n + 1)). apply FinFun.Injective_map_NoDup.
    + intros x y. lia.
    + exact (group_ids_are_unique i well_formed).
  - intros x H K. apply in_map_iff in H as (r & <- & _). apply in_map_iff in K as (g & E & _).
    unfold resource_key, group_key in E. lia.
Qed.

Lemma in_keyed_limits key l : In (key, l) (keyed_limits i) <->
  (exists r, In r (resources i) /\ key = resource_key (resource_id r) /\ l = Limit [resource_id r] (capacity r)) \/
  (exists g, In g (groups i) /\ key = group_key g /\ l = Limit (group_resources g) (group_capacity g)).
Proof.
  unfold keyed_limits, resource_limits, group_limits. rewrite in_app_iff, !in_map_iff. split.
  - intros [(r & E & H)|(g & E & H)]; injection E as <- <-; eauto 6.
  - intros [(r & H & -> & ->)|(g & H & -> & ->)]; eauto.
Qed.

Lemma in_limits l : In l (limits i) <-> exists key, In (key, l) (keyed_limits i).
Proof.
  setoid_rewrite in_keyed_limits. unfold limits. rewrite in_app_iff, !in_map_iff. split.
  - intros [(r & <- & H)|(g & <- & H)]; eauto 7.
  - intros (key & [(r & H & _ & ->)|(g & H & _ & ->)]); eauto.
Qed.

Lemma find_limit key l : Map.find key (limit_of known) = Some (key, l) <-> In (key, l) (keyed_limits i).
Proof. unfold known, lookup_of, limit_of. rewrite (find_in_index fst) by exact keys_are_unique. simpl. tauto. Qed.

Lemma limit_of_key_is_unique key l m : In (key, l) (keyed_limits i) -> In (key, m) (keyed_limits i) -> l = m.
Proof. intros L M. apply find_limit in L, M. congruence. Qed.

Lemma limit_capacity_is_positive key l : In (key, l) (keyed_limits i) -> 1 <= limit_capacity l.
Proof.
  intros H. apply in_keyed_limits in H as [(r & H & _ & ->)|(g & H & _ & ->)]; simpl.
  - exact (capacities_are_positive i well_formed r H).
  - exact (group_capacities_are_positive i well_formed g H).
Qed.

Lemma in_keys_at key place :
  In key (keys_at known place) <-> exists l, In (key, l) (keyed_limits i) /\ In place (limit_places l).
Proof. apply in_keys_by_place. Qed.

Lemma keys_are_different place : NoDup (keys_at known place).
Proof.
  apply keys_by_place_are_different; [exact keys_are_unique|].
  intros key l H. apply in_keyed_limits in H as [(r & H & _ & ->)|(g & H & _ & ->)]; simpl.
  - repeat constructor. intros [].
  - exact (groups_name_resources_once i well_formed g H).
Qed.

Lemma group_is_unique g h : In g (groups i) -> In h (groups i) -> group_id g = group_id h -> g = h.
Proof.
  intros G H E. assert (F : Map.find (group_id h) (index group_id (groups i)) = Some g)
    by (apply find_in_index; auto; apply group_ids_are_unique; exact well_formed).
  assert (F' : Map.find (group_id h) (index group_id (groups i)) = Some h)
    by (apply find_in_index; auto; apply group_ids_are_unique; exact well_formed). congruence.
Qed.

(** The keys that two close resources share: of the resource itself, or of a group of capacity 1. *)
Lemma in_swap_keys key place : In key (listed (swap_keys known) place) <->
  key = resource_key place /\ In place (resource_ids i) \/
  exists g, In g (groups i) /\ group_capacity g = 1 /\ key = group_key g /\ In place (group_resources g).
Proof.
  unfold known, lookup_of, swap_keys. rewrite in_keys_by_place. unfold resource_limits, group_limits. split.
  - intros (l & H & P). apply in_app_or in H as [H|H]; apply in_map_iff in H as (r & E & H); injection E as <- <-;
      simpl in P.
    + left. destruct P as [<-|[]]. split; auto. apply in_map. exact H.
    + right. apply filter_In in H as [H C]. apply Z.eqb_eq in C. eauto 6.
  - intros [[-> H]|(g & G & C & -> & P)].
    + apply in_map_iff in H as (r & <- & H). exists (Limit [resource_id r] (capacity r)). split; [|simpl; auto].
      apply in_or_app. left. apply in_map_iff. eauto.
    + exists (Limit (group_resources g) (group_capacity g)). split; [|exact P].
      apply in_or_app. right. apply in_map_iff. exists g. split; auto. apply filter_In. split; auto.
      apply Z.eqb_eq. exact C.
Qed.

Lemma sharing_keys_are_close key r s :
  In key (listed (swap_keys known) r) -> In key (listed (swap_keys known) s) -> Close i r s.
Proof.
  intros R S. apply in_swap_keys in R as [[-> _]|(g & G & C & -> & R)];
    apply in_swap_keys in S as [[E _]|(h & H & _ & E & S)]; unfold resource_key, group_key in E; try lia.
  - left. lia.
  - right. assert (h = g) as -> by (apply group_is_unique; auto; lia). eauto.
Qed.

Lemma close_iff r s : In r (resource_ids i) -> Close i r s <->
  exists key, In key (listed (swap_keys known) r) /\ In key (listed (swap_keys known) s).
Proof.
  intros R. split.
  - intros [<-|(g & G & C & Rg & Sg)].
    + exists (resource_key r). split; apply in_swap_keys; auto.
    + exists (group_key g). split; apply in_swap_keys; right; eauto.
  - intros (key & H & K). exact (sharing_keys_are_close key r s H K).
Qed.

(** * Proofs: plans together *)

Section Together.
Variable ps : list plan.
Hypothesis robots_are_known : forall p, In p ps -> exists a, In a (robots i) /\ robot_id a = plan_robot p.
Hypothesis plans_are_lawful : Plans_lawful i ps.
Hypothesis robots_are_distinct : NoDup (map plan_robot ps).

Lemma plan_has_chain p : In p ps -> exists a v later, In a (robots i) /\ visits p = v :: later /\ Chain i a v later.
Proof.
  intros P. destruct (robots_are_known p P) as (a & A & E). pose proof (plans_are_lawful p a P A E) as L.
  apply lawful_plan_is_a_chain in L as (v & later & V & _ & _ & C). eauto 6.
Qed.

Lemma plan_counts_once p : In p ps -> Counts_once (keys_at known) (gap i) p.
Proof.
  intros P key tick. destruct (plan_has_chain p P) as (a & v & later & A & V & C). unfold stays_of_plan, counts.
  rewrite V. exact (chain_counts_once _ _ i a well_formed A gap_is_short key tick later v C).
Qed.

Lemma plan_enters_no_earlier_than_0 p v : In p ps -> In v (visits p) -> 0 <= enter v.
Proof.
  intros P V. destruct (robots_are_known p P) as (a & A & E). pose proof (plans_are_lawful p a P A E) as L.
  apply lawful_plan_is_a_chain in L as (w & later & F & _ & T & C). rewrite F in V.
  pose proof (releases_are_ticks i well_formed a A). destruct V as [<-|V]; [lia|].
  destruct (chain_later i a well_formed A w later C v V) as (l & _ & _ & K). lia.
Qed.

Lemma occupants_before_0 key tick : tick < 0 -> occupants (keys_at known) (gap i) ps key tick = 0.
Proof.
  intros T. unfold occupants. destruct (filter (fun p => counts (keys_at known) (gap i) p key tick) ps) as [|p l] eqn:E;
    auto.
  assert (P : In p (filter (fun p => counts (keys_at known) (gap i) p key tick) ps)) by (rewrite E; left; auto).
  apply filter_In in P as [P O]. apply existsb_exists in O as (v & V & O).
  pose proof (plan_enters_no_earlier_than_0 p v P V). unfold counts_in, holds in O. simpl in O. lia.
Qed.

(** A robot counts in a limit at a tick if a visit of its plan does. *)
Lemma counts_iff key l tick id : In (key, l) (keyed_limits i) ->
  Counts i ps id l tick <-> exists p, In p ps /\ plan_robot p = id /\ counts (keys_at known) (gap i) p key tick = true.
Proof.
  intros L. unfold counts. setoid_rewrite existsb_exists. split.
  - intros (place & back & In_l & B & p & v & P & E & V & F & H). exists p. repeat split; auto. exists v. split; auto.
    destruct (plan_has_chain p P) as (a & u & later & A & W & C). rewrite W in V.
    apply (counts_in_iff _ _ i a well_formed A gap_is_short); [exact (chain_lawful i a u later C v V)|].
    split; [|eauto]. apply in_keys_at. exists l. rewrite F. auto.
  - intros (p & P & E & v & V & H). destruct (plan_has_chain p P) as (a & u & later & A & W & C).
    pose proof V as V'. rewrite W in V'.
    apply (counts_in_iff _ _ i a well_formed A gap_is_short) in H as [K (back & B & H)];
      [|exact (chain_lawful i a u later C v V')].
    apply in_keys_at in K as (m & K & F). rewrite (limit_of_key_is_unique key m l K L) in F.
    exists (visit_resource v), back. repeat split; auto; try lia. exists p, v. auto.
Qed.

Lemma kept_iff : Limits_are_kept i ps <-> forall key l tick, In (key, l) (keyed_limits i) ->
  occupants (keys_at known) (gap i) ps key tick <= limit_capacity l.
Proof.
  unfold Limits_are_kept. split.
  - intros H key l tick L. apply (occupants_iff _ _ (fun id => Counts i ps id l tick)); auto.
    + intros id. apply counts_iff. exact L.
    + intros ids. apply H. apply in_limits. eauto.
  - intros H l tick ids L. apply in_limits in L as (key & L). revert ids.
    change (forall ids, NoDup ids -> (forall id, In id ids -> Counts i ps id l tick) ->
      Z.of_nat (length ids) <= limit_capacity l).
    apply (occupants_iff (keys_at known) (gap i) (fun id => Counts i ps id l tick) ps key tick); auto.
    intros id. apply counts_iff. exact L.
Qed.

Theorem limits_accepted_iff : limits_accepted known (gap i) (keyed_limits i) ps = true <-> Limits_are_kept i ps.
Proof.
  rewrite kept_iff. unfold limits_accepted, stays_in_limits. cbv zeta. rewrite forallb_forall.
  assert (H : forall key l, In (key, l) (keyed_limits i) ->
    never_more_than (limit_capacity l) (listed (timetable (keys_at known) (gap i) ps) key) = true
    <-> forall tick, occupants (keys_at known) (gap i) ps key tick <= limit_capacity l).
  - intros key l L. pose proof (limit_capacity_is_positive key l L). rewrite never_more_than_iff by lia. split.
    + intros K tick. destruct (Z.leb_spec 0 tick) as [T|T].
      * rewrite <- (occupancy_of_timetable _ _ keys_are_different ps key tick plan_counts_once). apply K. exact T.
      * rewrite occupants_before_0 by exact T. lia.
    + intros K tick _. rewrite (occupancy_of_timetable _ _ keys_are_different ps key tick plan_counts_once). apply K.
  - split.
    + intros K key l tick L. apply (H key l L). exact (K _ L).
    + intros K [key l] L. apply (H key l L). intros tick. exact (K key l tick L).
Qed.

Lemma plan_of_robot_is_unique p q : In p ps -> In q ps -> plan_robot p = plan_robot q -> p = q.
Proof.
  intros P Q E. clear -robots_are_distinct P Q E. induction ps as [|x l IH]; [destruct P|].
  simpl in robots_are_distinct. inversion robots_are_distinct as [|? ? X N]; subst.
  destruct P as [<-|P], Q as [<-|Q]; auto.
  - destruct X. rewrite E. apply in_map. exact Q.
  - destruct X. rewrite <- E. apply in_map. exact P.
Qed.

(** A move leaves one resource of the graph, and enters another. *)
Lemma move_of_plan p v w : In p ps -> Consecutive p v w -> visit_resource v <> visit_resource w /\
  In (visit_resource v) (resource_ids i) /\ In (visit_resource w) (resource_ids i) /\
  Occupies ps (plan_robot p) (visit_resource v) (enter w - 1) /\ Occupies ps (plan_robot p) (visit_resource w) (enter w).
Proof.
  intros P C. destruct (plan_has_chain p P) as (a & u & later & A & V & H).
  assert (I : In v (visits p) /\ In w (visits p)).
  { destruct C as (b & l & ->). split; apply in_or_app; simpl; auto. }
  unfold Consecutive in C. rewrite V in C. pose proof H as H'. apply chain_iff in H' as (_ & S & M).
  rewrite V in I. destruct I as [Iv Iw]. destruct (M v w C) as [L Mv]. pose proof (S v Iv) as Sv. pose proof (S w Iw) as Sw.
  pose proof (stay_is_positive i a well_formed A v _ Sv L) as T. repeat split.
  - intros E. rewrite E in Mv. destruct Mv as [Mv|[_ Mv]]; destruct (edges_join_resources i well_formed _ _ Mv); auto.
  - apply Sv.
  - apply Sw.
  - exists p, v. rewrite V. repeat split; auto; [lia|]. rewrite L. simpl. lia.
  - exists p, w. rewrite V. repeat split; auto; [lia|]. destruct (leave w) as [l|] eqn:E; simpl; auto.
    exact (stay_is_positive i a well_formed A w l Sw E).
Qed.

(** Two robots in places that share a key of one robot: both are in the resource of the key. *)
Lemma two_in_one one other r s key tick : Limits_are_kept i ps -> one <> other ->
  Occupies ps one r tick -> Occupies ps other s tick ->
  In key (listed (swap_keys known) r) -> In key (listed (swap_keys known) s) -> r = s /\ key = resource_key r.
Proof.
  intros K N R S Kr Ks. apply in_swap_keys in Kr as [[-> _]|(g & G & C & -> & Rg)].
  - apply in_swap_keys in Ks as [[E _]|(g & _ & _ & E & _)]; unfold resource_key, group_key in *; lia.
  - apply in_swap_keys in Ks as [[E _]|(h & H & _ & E & Sg)]; [unfold resource_key, group_key in E; lia|].
    assert (h = g) as -> by (apply group_is_unique; auto; unfold group_key in E; lia).
    exfalso. enough (Z.of_nat (length [one; other]) <= 1) by (simpl in *; lia). rewrite <- C.
    apply (K (Limit (group_resources g) (group_capacity g)) tick).
    + apply in_or_app. right. apply in_map_iff. eauto.
    + repeat constructor; simpl; intuition.
    + pose proof gap_is_short. intros id [<-|[<-|[]]]; [exists r | exists s]; exists 0; rewrite Z.sub_0_r; simpl;
        repeat split; auto; lia.
Qed.

Lemma own_key_is_of_one r s : In (resource_key r) (listed (swap_keys known) s) -> s = r.
Proof.
  intros H. apply in_swap_keys in H as [[E _]|(g & _ & _ & E & _)]; unfold resource_key, group_key in E; lia.
Qed.

Lemma in_keys_of_one_only key r s :
  In key (keys_of_one_only known r s) <-> In key (listed (swap_keys known) r) /\ ~ In key (listed (swap_keys known) s).
Proof.
  unfold keys_of_one_only. cbv zeta. rewrite filter_In, negb_true_iff, <- not_true_iff_false, existsb_exists.
  split; intros [H K]; split; auto; intros X; apply K.
  - exists key. split; auto. apply Z.eqb_refl.
  - destruct X as (k & X & E). apply Z.eqb_eq in E. congruence.
Qed.

Lemma in_crossings x tick r s : In x (crossings known (tick, (r, s))) <->
  exists one other, x = (tick, (one, other)) /\ In one (keys_of_one_only known r s) /\ In other (keys_of_one_only known s r).
Proof.
  unfold crossings. simpl. rewrite in_flat_map. setoid_rewrite in_map_iff. split.
  - intros (one & O & other & <- & H). eauto.
  - intros (one & other & -> & O & H). eauto 6.
Qed.

(** Where limits are kept, two robots exchange places exactly if they cross a pair of keys in opposite directions. *)
Lemma close_moves_cross p v w q x y : Limits_are_kept i ps -> In p ps -> In q ps -> plan_robot p <> plan_robot q ->
  Consecutive p v w -> Consecutive q x y -> enter w = enter y ->
  Close i (visit_resource v) (visit_resource y) -> Close i (visit_resource w) (visit_resource x) ->
  exists m, In m (crossings known (enter w, (visit_resource v, visit_resource w))) /\
  In (opposite m) (crossings known (enter y, (visit_resource x, visit_resource y))).
Proof.
  intros K P Q N C D T Cv Cw. destruct (move_of_plan p v w P C) as (Np & Rv & Rw & Ov & Ow).
  destruct (move_of_plan q x y Q D) as (Nq & Rx & Ry & Ox & Oy). rewrite <- T in Ox, Oy.
  apply (close_iff _ _ Rv) in Cv as (k & Kv & Ky). apply (close_iff _ _ Rw) in Cw as (l & Lw & Lx).
  pose proof (fun r s key => two_in_one (plan_robot p) (plan_robot q) r s key) as X.
  exists (enter w, (k, l)). rewrite <- T. unfold opposite, swap. cbn [fst snd]. rewrite !in_crossings.
  assert (Kw : ~ In k (listed (swap_keys known) (visit_resource w))).
  { intros H. destruct (X _ _ k _ K N Ow Oy H Ky) as [_ ->]. apply own_key_is_of_one in Kv. congruence. }
  assert (Kx : ~ In k (listed (swap_keys known) (visit_resource x))).
  { intros H. destruct (X _ _ k _ K N Ov Ox Kv H) as [E ->]. apply own_key_is_of_one in Ky. congruence. }
  assert (Lv : ~ In l (listed (swap_keys known) (visit_resource v))).
  { intros H. destruct (X _ _ l _ K N Ov Ox H Lx) as [_ ->]. apply own_key_is_of_one in Lw. congruence. }
  assert (Ly : ~ In l (listed (swap_keys known) (visit_resource y))).
  { intros H. destruct (X _ _ l _ K N Ow Oy Lw H) as [E ->]. apply own_key_is_of_one in Lx. congruence. }
  split; [exists k, l | exists l, k]; rewrite !in_keys_of_one_only; auto.
Qed.

(** Moves that cross a pair of keys in opposite directions are an exchange. *)
Lemma crossing_moves_are_close r s s' r' tick m : In m (crossings known (tick, (r, s))) ->
  In (opposite m) (crossings known (tick, (s', r'))) -> Close i r r' /\ Close i s s'.
Proof.
  intros H K. apply in_crossings in H as (one & other & -> & O & P). apply in_crossings in K as (k & l & E & Q & R).
  unfold opposite, swap in E. simpl in E. injection E as <- <-. rewrite in_keys_of_one_only in *.
  split; [exact (sharing_keys_are_close one r r' (proj1 O) (proj1 R)) |
    exact (sharing_keys_are_close other s s' (proj1 P) (proj1 Q))].
Qed.

Theorem exchanges_accepted_iff : Limits_are_kept i ps ->
  exchanges_accepted known ps = true <-> Exchanges_are_avoided i ps.
Proof.
  intros K. unfold exchanges_accepted, Exchanges_are_avoided. cbv zeta. rewrite forallb_forall. split.
  - intros H one other r s s' r' tick N _ _ _ _ (p & v & w & P & A & C & E & F & T) (q & x & y & Q & B & D & G & L & U).
    subst. intros Cr Cs. destruct (close_moves_cross p v w q x y K P Q N C D (eq_sym U) Cr Cs) as (m & M & O).
    assert (I : In m (flat_map (crossings known) (moves ps))).
    { apply in_flat_map. eexists. split; [|exact M]. apply in_moves. exists p. split; auto. exists v, w. auto. }
    specialize (H m I). apply negb_true_iff in H.
    rewrite (proj2 (Triples.contains_of_list _ _)) in H; [discriminate|].
    apply in_flat_map. eexists. split; [|exact O]. apply in_moves. exists q. split; auto. exists x, y. auto.
  - intros H m I. apply negb_true_iff.
    destruct (Triples.contains (Triples.of_list (flat_map (crossings known) (moves ps))) (opposite m)) eqn:E; auto.
    exfalso. apply Triples.contains_of_list in E. apply in_flat_map in I as (a & I & M), E as (b & J & O).
    apply in_moves in I as (p & P & v & w & C & ->), J as (q & Q & x & y & D & ->).
    assert (T : enter y = enter w).
    { apply in_crossings in M as (k & l & -> & _). apply in_crossings in O as (k' & l' & E & _).
      unfold opposite in E. simpl in E. congruence. }
    rewrite T in O. destruct (crossing_moves_are_close _ _ _ _ _ m M O) as [Cr Cs].
    destruct (Z.eq_dec (plan_robot p) (plan_robot q)) as [F|F].
    + apply (plan_of_robot_is_unique p q P Q) in F. subst q. destruct (plan_has_chain p P) as (a & u & later & A & V & B).
      unfold Consecutive in C, D. rewrite V in C, D.
      assert (x = v) by (eapply (chain_enters_once i a well_formed A u later B); eauto). subst x.
      apply in_crossings in M as (k & l & -> & Mk & Ml). apply in_crossings in O as (k' & l' & E & Ok & Ol).
      unfold opposite, swap in E. simpl in E. injection E as <- <-. rewrite in_keys_of_one_only in *. tauto.
    + destruct (move_of_plan p v w P C) as (_ & Rv & Rw & _). destruct (move_of_plan q x y Q D) as (_ & Rx & Ry & _).
      apply (H (plan_robot p) (plan_robot q) (visit_resource v) (visit_resource w) (visit_resource x) (visit_resource y)
        (enter w) F); auto.
      * exists p, v, w. auto 10.
      * exists q, x, y. auto 10.
Qed.
End Together.

(** * Proofs: solutions *)

Lemma same_members_iff one other :
  same_members one other = true <-> NoDup one /\ forall id, In id one <-> In id other.
Proof.
  unfold same_members. cbv zeta. rewrite !andb_true_iff, !forallb_forall, Ids.distinct_iff. split.
  - intros ((N & H) & K). split; auto. intros id. split; intros I.
    + specialize (H id I). apply Ids.contains_of_list in H. exact H.
    + specialize (K id I). apply Ids.contains_of_list in K. exact K.
  - intros (N & H). repeat split; auto; intros id I; apply Ids.contains_of_list; apply H; exact I.
Qed.

(** Accepted if and only if all rules solution/..., plan/... and joint/... hold. *)
Theorem checker_accepts_exactly_lawful_solutions s : accepted i s = true <-> Lawful i s.
Proof.
  unfold accepted. cbv zeta. fold known. unfold covers_accepted, order_accepted.
  rewrite !andb_true_iff, !same_members_iff, plans_accepted_iff.
  assert (H : Covers_robots i s -> NoDup (planned s) /\
    forall p, In p (plans s) -> exists a, In a (robots i) /\ robot_id a = plan_robot p).
  - intros [N C]. split; [exact (distinct_in_front _ _ N)|]. intros p P.
    assert (I : In (plan_robot p) (robot_ids i)).
    { apply C, in_or_app. left. unfold planned. apply in_map. exact P. }
    apply in_map_iff in I as (a & E & A). eauto.
  - split.
    + intros ((((C & O) & P) & K) & X). destruct (H C) as [N R]. constructor; auto.
      * apply (limits_accepted_iff (plans s)); auto.
      * apply (exchanges_accepted_iff (plans s)); auto. apply (limits_accepted_iff (plans s)); auto.
    + intros [C O P K X]. destruct (H C) as [N R]. repeat (split; auto).
      * apply (limits_accepted_iff (plans s)); auto.
      * apply (exchanges_accepted_iff (plans s)); auto.
Qed.
End Proofs.

(** The same from the documents on. *)
Theorem accepted_solutions_are_exactly_the_lawful_ones i s :
  solution_accepted i s = true <-> Well_formed i /\ Lawful i s.
Proof.
  unfold solution_accepted. rewrite andb_true_iff, instance_is_well_formed_exactly_when_accepted.
  split; intros [W L]; (split; [exact W |]); apply (checker_accepts_exactly_lawful_solutions i W); exact L.
Qed.

Theorem solution_cost_is_the_total_cost i s : Well_formed i -> solution_cost i s = total_cost i s.
Proof.
  intros W. unfold solution_cost, total_cost. cbv zeta.
  assert (E : forall p, match Map.find (plan_robot p) (robot_of (lookup_of i)) with Some a => cost a p | None => 0 end =
    cost_of_plan i p).
  { intros p. unfold cost_of_plan. destruct (find (fun a => robot_id a =? plan_robot p) (robots i)) as [a|] eqn:E.
    - apply find_some in E as [A E]. apply Z.eqb_eq in E.
      assert (F : Map.find (plan_robot p) (robot_of (lookup_of i)) = Some a) by (apply find_robot; auto).
      rewrite F. reflexivity.
    - destruct (Map.find (plan_robot p) (robot_of (lookup_of i))) as [a|] eqn:F; auto.
      apply find_robot in F as [A F]; [|exact W]. apply (find_none _ _ E) in A. apply Z.eqb_neq in A. congruence. }
  generalize 0 at 2 3. induction (plans s) as [|p ps IH]; intros n; [reflexivity|]. cbn [fold_left]. rewrite E.
  apply IH.
Qed.
