(** The checker: executable, and accepts exactly what the law allows. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey.
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
  && Ids.distinct (robot_ids i)
  && forallb (fun a => known (start a) && known (goal a) && (0 <=? release a) && (1 <=? pace a)) (robots i).

Theorem instance_is_well_formed_exactly_when_accepted i : instance_accepted i = true <-> Well_formed i.
Proof.
  unfold instance_accepted. cbv zeta.
  rewrite !andb_true_iff, !forallb_forall, !Ids.distinct_iff, !Pairs.distinct_iff, orb_true_iff, forallb_forall. split.
  - intros ((((((U & R) & E) & V) & D) & W) & A). constructor; auto.
    + intros r H. specialize (R r H). lia.
    + intros r H. specialize (R r H). lia.
    + intros r s H. specialize (E _ H). simpl in E. rewrite !andb_true_iff, !Ids.contains_of_list in E.
      destruct E as [[E K] L]. split; auto. intros <-. rewrite Z.eqb_refl in E. discriminate.
    + intros F r s H K. destruct D as [D|D]; [congruence|]. specialize (D _ H).
      apply negb_true_iff in D. change (swap (r, s)) with (s, r) in D.
      rewrite (proj2 (Pairs.contains_of_list _ _) K) in D. discriminate.
    + intros a H. specialize (A a H). rewrite !andb_true_iff, !Ids.contains_of_list in A. tauto.
    + intros a H. specialize (A a H). rewrite !andb_true_iff in A. lia.
    + intros a H. specialize (A a H). rewrite !andb_true_iff in A. lia.
  - intros [U C D E V W A P R S]. repeat split; auto.
    + intros r H. specialize (C r H). specialize (D r H). lia.
    + intros [r s] H. destruct (E r s H) as (N & K & L). simpl.
      rewrite !andb_true_iff, !Ids.contains_of_list. repeat split; auto.
      apply negb_true_iff, Z.eqb_neq. exact N.
    + destruct (directed i); [auto|]. right. intros [r s] H. apply negb_true_iff.
      destruct (Pairs.contains (Pairs.of_list (edges i)) (swap (r, s))) eqn:F; auto.
      apply Pairs.contains_of_list in F. destruct (W eq_refl r s H F).
    + intros a H. destruct (P a H). specialize (R a H). specialize (S a H).
      rewrite !andb_true_iff, !Ids.contains_of_list. repeat split; auto; lia.
Qed.

(** * Plans *)

(** What the checker looks up: resources and robots by their ids, and the moves of the graph. *)
Record lookup := Lookup { resource_of : Map.t resource; robot_of : Map.t robot; move_set : Pairs.S.t }.

(** The moves of the graph: its edges, and those of an undirected graph backwards too. *)
Definition moves_of_graph (i : instance) : list (Z * Z) :=
  if directed i then edges i else fold_left (fun all e => swap e :: all) (edges i) (edges i).

Definition lookup_of (i : instance) : lookup :=
  Lookup (index resource_id (resources i)) (index robot_id (robots i)) (Pairs.of_list (moves_of_graph i)).

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
  | Vanish, Some r => same_end (leave v) (Some (enter v + least_stay a r))
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
  end.

(** The same of a plan of any robot; plans of robots that the instance does not have are left to solution/covers. *)
Definition plan_of_robot_accepted (p : plan) : bool :=
  match Map.find (plan_robot p) (robot_of known) with None => true | Some a => plan_accepted a p end.

(** * Plans together *)

(** joint/capacity. *)
Definition capacity_accepted (ps : list plan) : bool :=
  let stays := timetable ps in
  forallb (fun r => never_more_than (capacity r) (listed stays (resource_id r))) (resources i).

Definition opposite (m : move) : move := (fst m, swap (snd m)).

(** joint/exchange. *)
Definition exchanges_accepted (ps : list plan) : bool :=
  let made := moves ps in
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
  && capacity_accepted i (plans s)
  && exchanges_accepted (plans s).

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
    apply F. apply (endpoints_are_resources i well_formed a A).
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
  - rewrite !andb_true_iff, !Z.eqb_eq, chain_accepted_iff by exact A. split.
    + intros ((R & T) & C). exists v, later. auto.
    + intros (w & rest & E & R & T & C). injection E as <- <-. auto.
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

(** * Proofs: plans together *)

Section Together.
Variable ps : list plan.
Hypothesis robots_are_known : forall p, In p ps -> exists a, In a (robots i) /\ robot_id a = plan_robot p.
Hypothesis plans_are_lawful : Plans_lawful i ps.
Hypothesis robots_are_distinct : NoDup (map plan_robot ps).

Lemma plan_has_chain p : In p ps -> exists a v later, In a (robots i) /\ visits p = v :: later /\ Chain i a v later.
Proof.
  intros P. destruct (robots_are_known p P) as (a & A & E). pose proof (plans_are_lawful p a P A E) as L.
  apply plan_lawful_iff in L as (v & later & V & _ & _ & C). eauto 6.
Qed.

Lemma plan_holds_once p : In p ps -> Holds_once p.
Proof.
  intros P place tick. destruct (plan_has_chain p P) as (a & v & later & A & -> & C).
  exact (chain_holds_once i a well_formed A place tick v later C).
Qed.

Lemma plan_enters_no_earlier_than_0 p v : In p ps -> In v (visits p) -> 0 <= enter v.
Proof.
  intros P V. destruct (robots_are_known p P) as (a & A & E). pose proof (plans_are_lawful p a P A E) as L.
  apply plan_lawful_iff in L as (w & later & F & _ & T & C). rewrite F in V.
  pose proof (releases_are_ticks i well_formed a A). destruct V as [<-|V]; [lia|].
  destruct (chain_later i a well_formed A w later C v V) as (l & _ & _ & K). lia.
Qed.

Lemma occupants_before_0 place tick : tick < 0 -> occupants ps place tick = 0.
Proof.
  intros T. unfold occupants. destruct (filter (fun p => occupies p place tick) ps) as [|p l] eqn:E; auto.
  assert (P : In p (filter (fun p => occupies p place tick) ps)) by (rewrite E; left; auto).
  apply filter_In in P as [P O]. apply occupies_iff in O as (v & V & _ & H & _).
  pose proof (plan_enters_no_earlier_than_0 p v P V). lia.
Qed.

Theorem capacity_accepted_iff : capacity_accepted i ps = true <-> Capacity_is_kept i ps.
Proof.
  unfold capacity_accepted, Capacity_is_kept. cbv zeta. rewrite forallb_forall.
  assert (H : forall r, In r (resources i) ->
    never_more_than (capacity r) (listed (timetable ps) (resource_id r)) = true
    <-> forall tick, occupants ps (resource_id r) tick <= capacity r).
  - intros r R. pose proof (capacities_are_positive i well_formed r R). rewrite never_more_than_iff by lia. split.
    + intros K tick. destruct (Z.leb_spec 0 tick) as [T|T].
      * rewrite <- occupancy_of_timetable by exact plan_holds_once. apply K. exact T.
      * rewrite occupants_before_0 by exact T. lia.
    + intros K tick _. rewrite occupancy_of_timetable by exact plan_holds_once. apply K.
  - split.
    + intros K r tick ids R N O. revert ids N O. apply occupants_iff; [exact robots_are_distinct|].
      apply H; auto.
    + intros K r R. apply H; auto. intros tick. apply occupants_iff; [exact robots_are_distinct|].
      intros ids. apply K. exact R.
Qed.

Lemma plan_of_robot_is_unique p q : In p ps -> In q ps -> plan_robot p = plan_robot q -> p = q.
Proof.
  intros P Q E. clear -robots_are_distinct P Q E. induction ps as [|x l IH]; [destruct P|].
  simpl in robots_are_distinct. inversion robots_are_distinct as [|? ? X N]; subst.
  destruct P as [<-|P], Q as [<-|Q]; auto.
  - destruct X. rewrite E. apply in_map. exact Q.
  - destruct X. rewrite <- E. apply in_map. exact P.
Qed.

Lemma no_plan_exchanges_with_itself p r s tick : In p ps -> Moves p (tick, (r, s)) -> Moves p (tick, (s, r)) -> False.
Proof.
  intros P (v & w & C & E) (x & y & D & F). injection E as -> -> ->. injection F as T S R.
  destruct (plan_has_chain p P) as (a & u & later & A & V & H). unfold Consecutive in C, D. rewrite V in C, D.
  assert (v = x) by (eapply (chain_enters_once i a well_formed A u later H); eauto). subst x.
  apply chain_iff in H as (_ & _ & H). destruct (H v w C) as [_ M]. rewrite S in M.
  destruct M as [M|[_ M]]; destruct (edges_join_resources i well_formed _ _ M); auto.
Qed.

Theorem exchanges_accepted_iff : exchanges_accepted ps = true <-> Exchanges_are_avoided i ps.
Proof.
  unfold exchanges_accepted, Exchanges_are_avoided. cbv zeta. rewrite forallb_forall. split.
  - intros H one other r s tick N R S (p & v & w & P & _ & C & E & F & T) (q & x & y & Q & _ & D & G & K & U).
    assert (I : In (tick, (r, s)) (moves ps)).
    { apply in_moves. exists p. split; auto. exists v, w. split; auto. congruence. }
    assert (J : In (tick, (s, r)) (moves ps)).
    { apply in_moves. exists q. split; auto. exists x, y. split; auto. congruence. }
    specialize (H _ I). apply negb_true_iff in H.
    rewrite (proj2 (Triples.contains_of_list _ _)) in H; [discriminate | exact J].
  - intros H [tick [r s]] I. apply negb_true_iff.
    destruct (Triples.contains (Triples.of_list (moves ps)) (opposite (tick, (r, s)))) eqn:E; auto.
    exfalso. apply Triples.contains_of_list in E. unfold opposite, swap in E. simpl in E.
    apply in_moves in I as (p & P & M), E as (q & Q & K).
    destruct (Z.eq_dec (plan_robot p) (plan_robot q)) as [F|F].
    + apply (plan_of_robot_is_unique p q P Q) in F. subst q. exact (no_plan_exchanges_with_itself p r s tick P M K).
    + destruct M as (v & w & C & G), K as (x & y & D & L). injection G as -> -> ->. injection L as T S R.
      destruct (plan_has_chain p P) as (a & u & later & A & V & B). apply chain_iff in B as (_ & B & _).
      assert (V' : In v (visits p) /\ In w (visits p)).
      { destruct C as (b & l & ->). split; apply in_or_app; simpl; auto. }
      rewrite V in V'. apply (H (plan_robot p) (plan_robot q) (visit_resource v) (visit_resource w) (enter w) F).
      * apply B. tauto.
      * apply B. tauto.
      * exists p, v, w. auto 10.
      * exists q, x, y. repeat split; auto.
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
      * apply capacity_accepted_iff; auto.
      * apply exchanges_accepted_iff; auto.
    + intros [C O P K X]. destruct (H C) as [N R]. repeat (split; auto).
      * apply capacity_accepted_iff; auto.
      * apply exchanges_accepted_iff; auto.
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
