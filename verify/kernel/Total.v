(** A refuted total is impossible, and refuted deadlines are not all kept: the clauses of an accepted blueprint are kept
    by every lawful solution that plans every robot and in which those of the group do what is demanded. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Checker Ways Prices Labels Tables Bound Refutation Routes Formula.
Import ListNotations.
Open Scope Z_scope.

(** The tables are those of the instance, and all guides are accepted. *)
Record Right_tables (i : instance) (w : tables) : Prop := {
  policy_is_right : policy w = after_goal i;
  takes_are_right : forall a r, takes_in (places w) a r = need i a r;
  places_are_right : forall r x, Map.find r (places w) = Some x -> In x (resources i) /\ resource_id x = r;
  onwards_are_moves : forall r s, In s (onwards w r) <-> Move i r s;
  backwards_are_moves : forall r s, In s (backwards w r) <-> Move i s r;
  crew_is_known : forall m, In m (crew w) -> In (fst m) (robots i);
  crew_is_distinct : NoDup (map (fun m : member => robot_id (fst m)) (crew w));
  members_are_found : forall id m, Map.find id (member_of w) = Some m <-> In m (crew w) /\ robot_id (fst m) = id;
  guides_are_accepted : forall m, In m (crew w) -> guide_accepted w (resource_ids i) m = true
}.

Lemma predecessors_are_moves i r s : Well_formed i -> In s (listed (predecessor_table i) r) <-> Move i s r.
Proof.
  intros right. rewrite <- (has_move_iff i). unfold has_move. simpl. rewrite Pairs.contains_of_list.
  unfold predecessor_table.
  assert (H : forall l m, In s (listed (fold_left (fun m e => enlist (snd e) (fst e) m) l m) r) <->
    In (s, r) l \/ In s (listed m r)).
  { induction l as [| [x y] l IH]; intros m; simpl; [tauto |]. rewrite IH, listed_enlist. simpl.
    destruct (Z.eqb_spec y r) as [-> | N]; simpl; intuition congruence. }
  rewrite H, listed_empty. simpl. tauto.
Qed.

Lemma combined_with_as_many {A B} (l : list A) (m : list B) : length m = length l -> map fst (combine l m) = l.
Proof. revert m. induction l as [| x l IH]; intros [| y m] E; try discriminate; auto. simpl. rewrite IH; auto. Qed.

Lemma tables_are_right i group b : Well_formed i -> (forall a, In a group -> In a (robots i)) ->
  NoDup (map robot_id group) -> (length (guides b) =? length group)%nat = true ->
  forallb (guide_accepted (tables_of i group b) (resource_ids i)) (crew (tables_of i group b)) = true ->
  Right_tables i (tables_of i group b).
Proof.
  intros right Known Distinct Length Guides. apply Nat.eqb_eq in Length.
  assert (All : map fst (crew (tables_of i group b)) = group) by (apply combined_with_as_many, Length).
  assert (N : NoDup (map (fun m : member => robot_id (fst m)) (crew (tables_of i group b)))).
  { rewrite <- All, map_map in Distinct. exact Distinct. }
  constructor; auto.
  - intros a r. apply takes_what_is_needed, right.
  - intros r x H. apply find_in_index in H; auto. apply (resource_ids_are_unique i right).
  - intros r s. apply successors_are_moves, right.
  - intros r s. apply predecessors_are_moves, right.
  - intros m H. apply Known. rewrite <- All. apply in_map, H.
  - intros id m. apply (find_in_index (fun m : member => robot_id (fst m))), N.
  - apply forallb_forall, Guides.
Qed.

(** The robot enters its goal for the last time by its deadline (robot, tick), if it has a plan. *)
Definition Keeps_deadline (s : solution) (d : Z * Z) : Prop :=
  forall p, In p (plans s) -> plan_robot p = fst d -> arrives (visits p) <= snd d.

(** The robots of the group do what is demanded. *)
Definition Meets (i : instance) (s : solution) (group : list robot) (asked : demand) : Prop :=
  match asked with
  | Lawful_plans => True
  | Cheaper_than total => sum (fun a => cost_of_robot i s (robot_id a)) group < total
  | In_time due => forall d, In d due -> Keeps_deadline s d
  end.

Lemma sum_over_images {A B} (f : B -> Z) (g : A -> B) l : sum f (map g l) = sum (fun x => f (g x)) l.
Proof. induction l as [| x l IH]; simpl; auto. rewrite IH. reflexivity. Qed.

Section Solution.
Variables (i : instance) (w : tables) (s : solution).
Hypothesis right : Well_formed i.
Hypothesis tabled : Right_tables i w.
Hypothesis lawful : Lawful i s.
Hypothesis complete : Plans_every_plannable_robot i s.

(** * What the variables mean *)

(** What counts of the robot's plan. *)
Definition route (a : robot) : list visit :=
  counted i a match find (fun p => plan_robot p =? robot_id a) (plans s) with Some p => visits p | None => [] end.

Definition route_cost (a : robot) : Z := arrives (route a) - release a.
Definition delay (m : member) : Z := route_cost (fst m) - shortest (snd m).
Definition presence (r t : Z) (m : member) : Z := Z.b2z (is_in i (fst m) (route (fst m)) r t).

(** The sum over the robots whose keys are in a range. *)
Definition ranged (key f : member -> Z) (first end_ : Z) : Z :=
  sum (fun m => if (first <=? key m) && (key m <? end_) then f m else 0) (crew w).
Definition delays := ranged (fun m => rank (snd m)) delay.
Definition presences (r t : Z) := ranged (fun m => seat (snd m)) (presence r t).

Definition is_true (m : meaning) : bool :=
  match m with
  | Free id r t => of_robot w id (fun a _ => is_free i a (route a) r t)
  | Costs id x => of_robot w id (fun a _ => x <=? route_cost a)
  | Present id r t => of_robot w id (fun a _ => is_in i a (route a) r t)
  | Stands _ => true
  | Delayed first end_ least => least <=? delays first end_
  | Crowded first end_ r t least => least <=? presences r t first end_
  end.

(** One of the literals is true. *)
Definition Kept (c : list signed) : Prop := exists l, In l c /\ is_true (snd l) = fst l.

(** * Members *)

Lemma member_is_a_robot m : In m (crew w) -> In (fst m) (robots i).
Proof. apply (crew_is_known i w tabled). Qed.

Lemma member_has_a_plan m : In m (crew w) -> exists p v rest, In p (plans s) /\ plan_robot p = robot_id (fst m) /\
  Way i (fst m) (visits p) /\ route (fst m) = counted i (fst m) (visits p) /\
  visits p = v :: rest /\ visit_resource v = start (fst m) /\ enter v = release (fst m).
Proof.
  intros H. pose proof (guides_are_accepted i w tabled m H) as G. pose proof (member_is_a_robot m H) as Ha.
  destruct m as [a g]. simpl in *. decided.
  assert (P : In (robot_id a) (planned s)).
  { apply complete; auto. apply (leads_on_leads (onwards w) i _ (leads g)); auto.
    intros r t. apply (onwards_are_moves i w tabled). }
  unfold route. destruct (find (fun p => plan_robot p =? robot_id a) (plans s)) as [p |] eqn:F.
  - apply find_some in F as [Hp E]. decided. pose proof (plans_lawful i s lawful p a Hp Ha (eq_sym E)) as L.
    destruct (starts_at_release i a p L) as (v & rest & V & R & T). exists p, v, rest.
    repeat split; auto. apply lawful_plan_is_a_way; auto.
  - apply in_map_iff in P as (p & E & Hp). apply (find_none _ _ F) in Hp. decided. congruence.
Qed.

Lemma member_has_a_route m : In m (crew w) -> Route i (fst m) (route (fst m)) /\
  exists v later, route (fst m) = v :: later /\ visit_resource v = start (fst m) /\ enter v = release (fst m).
Proof.
  intros H. destruct (member_has_a_plan m H) as (p & v & rest & Hp & E & W & -> & V & R & T).
  pose proof (member_is_a_robot m H) as Ha. split; [apply way_is_a_route; auto |].
  rewrite V. destruct (counted_begins_alike i (fst m) v rest) as [later L]. eauto.
Qed.

Lemma route_costs_no_more m : In m (crew w) -> route_cost (fst m) <= cost_of_robot i s (robot_id (fst m)).
Proof.
  intros H. destruct (member_has_a_plan m H) as (p & v & rest & Hp & E & W & R & V & _ & _).
  pose proof (member_is_a_robot m H) as Ha. pose proof (counted_arrives_no_later i _ right Ha _ W) as L.
  assert (C : forall q, In q (plans s) -> 0 <= cost_of_plan i q).
  { intros q Hq. destruct (plan_is_a_way i s right lawful q Hq) as (a & Hb & F & Wq).
    rewrite (cost_is_of_robot i right a q Hb (eq_sym F)).
    destruct (starts_at_release i a q (plans_lawful i s lawful q a Hq Hb F)) as (u & later & U & _ & T).
    pose proof (way_does_not_arrive_before_it_starts i right a _ Hb Wq u later U) as A.
    unfold cost, arrival. rewrite U in *. unfold arrives in A. simpl in *. lia. }
  unfold cost_of_robot, route_cost. rewrite R.
  pose proof (sum_is_above_each (fun q => if plan_robot q =? robot_id (fst m) then cost_of_plan i q else 0) (plans s) p)
    as S. cbv beta in S. rewrite E, Z.eqb_refl in S. rewrite (cost_is_of_robot i right (fst m) p Ha E) in S.
  assert (K : cost (fst m) p = arrives (visits p) - release (fst m)).
  { unfold cost, arrival, arrives. rewrite V. reflexivity. }
  rewrite K in S. etransitivity; [| apply S; auto]; [lia |].
  intros q Hq. destruct (_ =? _); auto; lia.
Qed.

(** ** What accepted guides say *)

Lemma is_passable_is_right a r : is_passable w a r = passable i a r.
Proof. unfold is_passable, passable. rewrite (policy_is_right i w tabled). reflexivity. Qed.

Lemma guides_are_right a g r t : In (a, g) (crew w) -> Move i r t -> guides_moves w (a, g) r = true.
Proof.
  intros H M. pose proof (guides_are_accepted i w tabled _ H) as G. cbn [guide_accepted] in G. decided.
  match goal with K : forallb _ _ = true |- _ => apply (proj1 (forallb_forall _ _) K) end.
  apply (moves_join_resources i right r t M).
Qed.

Lemma at_most_iff x y : at_most x y = true <-> exists n, x = Some n /\ n <= y.
Proof.
  destruct x as [n |]; simpl; [rewrite Z.leb_le |]; split; try discriminate; eauto.
  - intros (m & E & L). injection E as ->. auto.
  - intros (m & E & _). discriminate.
Qed.

Lemma guided_rests_are_least a g : In (a, g) (crew w) -> forall r t, Move i r t ->
  (t = goal a -> exists x, Map.find r (rests g) = Some x /\ x <= 0) /\
  (forall y, Map.find t (rests g) = Some y -> exists x, Map.find r (rests g) = Some x /\ x <= need i a t + y).
Proof.
  intros H r t M. pose proof (guides_are_right a g r t H M) as G. unfold guides_moves in G.
  pose proof (proj1 (forallb_forall _ _) G t (proj2 (onwards_are_moves i w tabled r t) M)) as K. cbv zeta beta in K.
  rewrite (takes_are_right i w tabled) in K. apply andb_true_iff in K as [K L]. split.
  - intros ->. rewrite Z.eqb_refl in K. apply at_most_iff, K.
  - intros y E. rewrite E in L. apply andb_true_iff in L as [L _]. apply at_most_iff, L.
Qed.

Lemma guided_firsts_are_least a g : In (a, g) (crew w) -> forall r t x, Move i r t ->
  Map.find r (firsts g) = Some x -> passable i a t = true -> Map.find t (rests g) <> None ->
  exists y, Map.find t (firsts g) = Some y /\ y <= x + need i a t.
Proof.
  intros H r t x M F P N. pose proof (guides_are_right a g r t H M) as G. unfold guides_moves in G.
  pose proof (proj1 (forallb_forall _ _) G t (proj2 (onwards_are_moves i w tabled r t) M)) as K. cbv zeta beta in K.
  rewrite (takes_are_right i w tabled), F, is_passable_is_right, P in K. apply andb_true_iff in K as [_ K].
  destruct (Map.find t (rests g)); [| congruence]. apply andb_true_iff in K as [_ K]. apply at_most_iff, K.
Qed.

Section Member.
Variables (a : robot) (g : guide) (id : Z).
Hypothesis found : Map.find id (member_of w) = Some (a, g).

Lemma found_member : In (a, g) (crew w) /\ robot_id a = id.
Proof. apply (members_are_found i w tabled id (a, g)), found. Qed.

Lemma listed_member : In (a, g) (crew w).
Proof. apply found_member. Qed.

Lemma known : In a (robots i).
Proof. apply (member_is_a_robot (a, g) listed_member). Qed.

Lemma routed : Route i a (route a).
Proof. apply (member_has_a_route (a, g) listed_member). Qed.

Lemma of_found_robot f : of_robot w id f = f a g.
Proof. unfold of_robot. rewrite found. reflexivity. Qed.

Lemma free_robot_is_guided r t : is_free i a (route a) r t = true ->
  (exists rest, Map.find r (rests g) = Some rest /\ t + rest - release a <= route_cost a) /\
  (exists first, Map.find r (firsts g) = Some first /\ first <= t) /\
  is_passable w a r = true.
Proof.
  intros F. pose proof (guides_are_accepted i w tabled _ listed_member) as G. cbn [guide_accepted] in G.
  rewrite (takes_are_right i w tabled) in G. decided.
  destruct (free_robot_has_a_rest i a (fun r => Map.find r (rests g)) (guided_rests_are_least a g listed_member)
    _ r t routed F) as (rest & R & L).
  split; [exists rest; unfold route_cost; split; [auto | lia] |]. split.
  - apply (free_robot_is_not_too_early i a (fun r => Map.find r (rests g)) (guided_rests_are_least a g listed_member)
      (fun r => Map.find r (firsts g)) (guided_firsts_are_least a g listed_member) _ r t routed); auto.
    intros v x later E. destruct (member_has_a_route (a, g) listed_member) as (Ru & u & later' & E' & S & T).
    cbn [fst] in *. rewrite E in E'. injection E' as <- _. rewrite S, T. apply at_most_iff. auto.
  - rewrite is_passable_is_right. apply (free_robot_can_pass i a _ r t routed F).
Qed.

Lemma shortest_is_least : shortest g <= route_cost a.
Proof.
  pose proof (guides_are_accepted i w tabled _ listed_member) as G. cbn [guide_accepted] in G.
  rewrite (takes_are_right i w tabled) in G. decided. unfold route_cost.
  destruct (member_has_a_route (a, g) listed_member) as (Rv & v & later & E & S & T). cbn [fst] in *.
  pose proof routed as R. rewrite E in *. inversion R as [u Hg | u x rest Hp Hn Hm Hx]; subst.
  - rewrite (proj2 (Z.eqb_eq (start a) (goal a))) in * by congruence. decided. unfold arrives. simpl. lia.
  - destruct (mover_has_a_rest i a (fun r => Map.find r (rests g)) (guided_rests_are_least a g listed_member)
      _ R v x rest eq_refl) as (n & F & L). rewrite S, F in *.
    pose proof (route_arrives_after_its_start i a right known _ R v (x :: rest) eq_refl).
    destruct (start a =? goal a); decided; lia.
Qed.

(** * Clauses of one robot *)

Section Clause.
Variable c : list signed.

(** Look for the literal that makes a clause hold. *)
Ltac look H l := apply existsb_exists in H as (l & ? & H); destruct l as [[|] []]; try discriminate; decided; subst.
Ltac shown := eexists; split; [eassumption |]; cbn [is_true fst snd]; rewrite ?of_found_robot.

Lemma kept_unless_free r t : unless_free c id r t = true -> is_free i a (route a) r t = false -> Kept c.
Proof. unfold unless_free. intros H F. look H l. shown. exact F. Qed.

Lemma kept_if_costs x : if_costs c id x = true -> x <= route_cost a -> Kept c.
Proof. unfold if_costs. intros H L. look H l. shown. apply Z.leb_le. lia. Qed.

Lemma kept_if_cheaper x : if_cheaper w c id x = true -> route_cost a < x -> Kept c.
Proof.
  unfold if_cheaper. rewrite of_found_robot. intros H L. apply orb_true_iff in H as [H | H].
  - look H l. shown. apply Z.leb_gt. lia.
  - pose proof shortest_is_least. decided. lia.
Qed.

Lemma kept_if_free r t : if_free w c id r t = true -> is_free i a (route a) r t = true -> Kept c.
Proof.
  unfold if_free. rewrite of_found_robot. intros H F. apply orb_true_iff in H as [H | H]; [look H l; shown; exact F |].
  destruct (free_robot_is_guided r t F) as ((rest & R & L) & (first & S & M) & P). rewrite R, S, P in H. simpl in H.
  apply orb_true_iff in H as [H | H]; [decided; lia |]. apply (kept_if_costs _ H L).
Qed.

Lemma kept_unless_present r t : unless_present w c id r t = true -> is_in i a (route a) r t = false -> Kept c.
Proof.
  unfold unless_present. rewrite of_found_robot, (takes_are_right i w tabled). intros H F.
  apply orb_true_iff in H as [H | H].
  - look H l.
    + shown. destruct (is_free i a (route a) r tick) eqn:E; auto.
      rewrite (free_robot_is_inside i a _ r tick t routed E) in F; auto; discriminate.
    + shown. exact F.
    + destruct (member_has_a_route (a, g) listed_member) as (R & v & later & E & S & T). cbn [fst] in *.
      rewrite E in *. rewrite <- S in *. rewrite is_passable_is_right in *.
      rewrite (standing_robot_is_inside i a v later t R) in F; [discriminate | | |]; auto; lia.
  - decided. subst r. destruct (Z_lt_le_dec (route_cost a) (t + 1 - release a)) as [L | L].
    + destruct (after_goal i) eqn:Policy; rewrite (policy_is_right i w tabled), Policy in *.
      * destruct (Z_lt_le_dec (route_cost a) (t + 1 - release a - need i a (goal a))) as [M | M].
        -- eapply kept_if_cheaper; eauto.
        -- rewrite (arrived_robot_is_inside i a _ t routed) in F; [discriminate | |]; unfold route_cost in *;
             rewrite ?Policy; lia.
      * rewrite (arrived_robot_is_inside i a _ t routed) in F; [discriminate | |]; unfold route_cost in *;
             rewrite ?Policy; auto; lia.
    + eapply kept_if_costs; eauto.
Qed.

Lemma kept_at_the_start : if_free w c id (start a) (release a + need i a (start a)) = true ->
  start a <> goal a \/ if_cheaper w c id 1 = true -> Kept c.
Proof.
  intros F C. destruct (member_has_a_route (a, g) listed_member) as (R & v & later & E & S & T). cbn [fst] in *.
  inversion R as [u Hg K | u x rest Hp Hn Hm Hx K]; rewrite E in K; injection K as <- K; subst.
  - destruct C as [C | C]; [congruence |]. apply (kept_if_cheaper _ C). unfold route_cost. rewrite E. unfold arrives.
    simpl. lia.
  - apply (kept_if_free _ _ F). rewrite E, <- S, <- T. apply mover_is_free; lia.
Qed.

Lemma kept_by_going_on r t : unless_free c id r t = true -> if_free w c id r (t + 1) = true ->
  (forall x, Move i r x -> if_free w c id x (t + need i a x) = true) ->
  (Move i r (goal a) -> if_cheaper w c id (t + 1 - release a) = true) -> Kept c.
Proof.
  intros U W M G. destruct (is_free i a (route a) r t) eqn:F; [| eapply kept_unless_free; eauto].
  destruct (free_robot_goes_on i a _ r t routed F) as [K | [(x & Hx & K) | (Hx & K)]].
  - exact (kept_if_free _ _ W K).
  - exact (kept_if_free _ _ (M _ Hx) K).
  - apply (kept_if_cheaper _ (G Hx)). unfold route_cost. lia.
Qed.

Lemma kept_by_coming_from r t : unless_free c id r t = true -> if_free w c id r (t - 1) = true ->
  (forall x, Move i x r -> if_free w c id x (t - need i a r) = true) ->
  r <> start a \/ t <> release a + need i a r -> Kept c.
Proof.
  intros U W M N. destruct (is_free i a (route a) r t) eqn:F; [| eapply kept_unless_free; eauto].
  destruct (free_robot_comes_from i a _ r t routed F) as [K | [(x & Hx & K) | (v & rest & E & Hr & Ht)]].
  - exact (kept_if_free _ _ W K).
  - exact (kept_if_free _ _ (M _ Hx) K).
  - destruct (member_has_a_route (a, g) listed_member) as (R & u & later & E' & S & T). cbn [fst] in *.
    rewrite E in E'. injection E' as <- <-. exfalso. destruct N; congruence.
Qed.

Lemma kept_by_arriving x : if_costs c id (x + 1) = true -> if_cheaper w c id x = true ->
  (forall r, Move i r (goal a) -> if_free w c id r (release a + x) = true) ->
  start a <> goal a \/ x <> 0 -> Kept c.
Proof.
  intros C D M N. destruct (Z_lt_le_dec (route_cost a) x) as [L | L]; [eapply kept_if_cheaper; eauto |].
  destruct (Z_lt_le_dec x (route_cost a)) as [L' | L']; [eapply kept_if_costs; eauto; lia |].
  assert (A : arrives (route a) = release a + x) by (unfold route_cost in *; lia).
  destruct (arrival_comes_from i a _ routed) as [(r & Hr & F) | (v & E & Hg)].
  - rewrite A in F. exact (kept_if_free _ _ (M _ Hr) F).
  - destruct (member_has_a_route (a, g) listed_member) as (R & u & later & E' & S & T). cbn [fst] in *.
    rewrite E in *. injection E' as <- _. unfold arrives in A. simpl in A. exfalso. destruct N; [congruence | lia].
Qed.
End Clause.
End Member.

(** The robot of a condition that holds is a member. *)
Lemma some_robot id f : of_robot w id f = true -> exists a g, Map.find id (member_of w) = Some (a, g) /\ f a g = true.
Proof. unfold of_robot. destruct (Map.find id (member_of w)) as [[a g] |]; [eauto | discriminate]. Qed.

Lemma presence_is_of_a_robot c id r t : unless_present w c id r t = true ->
  exists a g, Map.find id (member_of w) = Some (a, g) /\ (is_in i a (route a) r t = false -> Kept c).
Proof.
  intros H. pose proof (some_robot _ _ H) as (a & g & F & _). exists a, g. split; auto.
  apply (kept_unless_present a g id F c r t H).
Qed.

(** * Clauses of robots together *)

(** A robot that is in a resource on its route occupies it. *)
Lemma robot_inside_occupies m r t : In m (crew w) -> is_in i (fst m) (route (fst m)) r t = true ->
  Occupies (plans s) (robot_id (fst m)) r t.
Proof.
  intros H K. destruct (member_has_a_plan m H) as (p & v & rest & Hp & E & W & R & _).
  rewrite R in K. destruct (counted_visits_hold i (fst m) _ r t W K) as (u & Hu & Hr & Ht). exists p, u. auto.
Qed.

Lemma robot_free_elsewhere_makes_the_move m r x t : In m (crew w) -> is_free i (fst m) (route (fst m)) r t = true ->
  is_in i (fst m) (route (fst m)) x t = true -> r <> x -> Makes_move (plans s) (robot_id (fst m)) r x t.
Proof.
  intros H F K D. destruct (member_has_a_plan m H) as (p & v & rest & Hp & E & W & R & _).
  destruct (member_has_a_route m H) as [Routed _].
  destruct (free_robot_elsewhere_moves i (fst m) right (member_is_a_robot m H) _ r x t Routed F K D) as
    (before & u & u' & later & V & Hu & Hu' & T).
  destruct (counted_is_a_prefix i (fst m) (visits p)) as [end_ P]. rewrite <- R, V in P.
  exists p, u, u'. repeat split; auto. exists before, (later ++ end_). rewrite P, <- app_assoc. reflexivity.
Qed.

(** ** Sums over ranges *)

Lemma range_is_widened key f first end_ first' end' : (forall m, In m (crew w) -> 0 <= f m) ->
  first' <= first -> end_ <= end' -> ranged key f first end_ <= ranged key f first' end'.
Proof.
  intros P L K. unfold ranged. apply sum_is_monotone. intros m H. specialize (P m H).
  destruct (Z.leb_spec first (key m)), (Z.ltb_spec (key m) end_), (Z.leb_spec first' (key m)),
    (Z.ltb_spec (key m) end'); simpl; lia.
Qed.

Lemma ranges_are_joined key f first middle middle' end_ first' end' : (forall m, In m (crew w) -> 0 <= f m) ->
  first' <= Z.min first middle' -> middle <= middle' -> Z.max middle end_ <= end' ->
  ranged key f first middle + ranged key f middle' end_ <= ranged key f first' end'.
Proof.
  intros P L M K. unfold ranged. rewrite <- sum_of_sums. apply sum_is_monotone. intros m H. specialize (P m H).
  destruct (Z.leb_spec first (key m)), (Z.ltb_spec (key m) middle), (Z.leb_spec middle' (key m)),
    (Z.ltb_spec (key m) end_), (Z.leb_spec first' (key m)), (Z.ltb_spec (key m) end'); simpl; lia.
Qed.

Lemma one_is_in_its_range key f m : (forall m, In m (crew w) -> 0 <= f m) -> In m (crew w) ->
  f m <= ranged key f (key m) (key m + 1).
Proof.
  intros P H. unfold ranged.
  pose proof (sum_is_above_each
    (fun x => if (key m <=? key x) && (key x <? key m + 1) then f x else 0) (crew w) m) as S.
  cbv beta in S. rewrite Z.leb_refl, (proj2 (Z.ltb_lt (key m) (key m + 1))) in S by lia. simpl in S. apply S; auto.
  intros x Hx. specialize (P x Hx). destruct (_ && _); lia.
Qed.

Lemma delays_are_not_negative m : In m (crew w) -> 0 <= delay m.
Proof.
  intros H. destruct m as [a g]. unfold delay. pose proof (shortest_is_least a g (robot_id a)) as L. simpl.
  rewrite (members_are_found i w tabled) in L. simpl in L. specialize (L (conj H eq_refl)). lia.
Qed.

Lemma presences_are_not_negative r t m : 0 <= presence r t m.
Proof. unfold presence. destruct (is_in _ _ _ _ _); simpl; lia. Qed.

(** A clause that adds up is kept. *)
Lemma kept_by_adding if_false true_if value c key f : value = ranged key f -> (forall m, In m (crew w) -> 0 <= f m) ->
  (forall l first end_ n, if_false l = Some (first, end_, n) -> is_true (snd l) = fst l \/ n <= value first end_) ->
  (forall l first end_ n, true_if l = Some (first, end_, n) -> n <= value first end_ -> is_true (snd l) = fst l) ->
  adds if_false true_if c = true -> Kept c.
Proof.
  intros -> P F T H. unfold adds in H. destruct c as [| l [| k [| total [| ? ?]]]]; try discriminate.
  - destruct (if_false l) as [[[first end_] n] |] eqn:Fl; [| discriminate].
    destruct (true_if k) as [[[first' end'] least] |] eqn:Tk; [| discriminate]. decided.
    destruct (F _ _ _ _ Fl) as [K | K]; [exists l; simpl; auto |]. exists k. split; [simpl; auto |].
    apply (T _ _ _ _ Tk). pose proof (range_is_widened key f first end_ first' end' P ltac:(lia) ltac:(lia)). lia.
  - destruct (if_false l) as [[[first middle] n] |] eqn:Fl; [| discriminate].
    destruct (if_false k) as [[[middle' end_] m] |] eqn:Fk; [| discriminate].
    destruct (true_if total) as [[[first' end'] least] |] eqn:Tk; [| discriminate]. decided.
    destruct (F _ _ _ _ Fl) as [K | K]; [exists l; simpl; auto |].
    destruct (F _ _ _ _ Fk) as [K' | K']; [exists k; simpl; auto |]. exists total. split; [simpl; auto |].
    apply (T _ _ _ _ Tk). 
    pose proof (ranges_are_joined key f first middle middle' end_ first' end' P ltac:(lia) ltac:(lia) ltac:(lia)). lia.
Qed.

Lemma kept_by_adding_delays c : adds (delays_if_false w) true_if_delays c = true -> Kept c.
Proof.
  apply (kept_by_adding _ _ delays c (fun m => rank (snd m)) delay); auto using delays_are_not_negative.
  - intros [[|] []] from upto n E; try discriminate; simpl in E.
    + destruct (Map.find id (member_of w)) as [[a g] |] eqn:Found; [| discriminate]. injection E as <- <- <-.
      cbn [is_true fst snd]. rewrite (of_found_robot a g id Found).
      destruct (least <=? route_cost a) eqn:L; auto. decided. right.
      pose proof (one_is_in_its_range (fun m => rank (snd m)) delay (a, g) delays_are_not_negative) as K.
      specialize (K (listed_member a g id Found)). unfold delays. simpl in *. unfold delay at 1 in K. simpl in K. lia.
    + injection E as <- <- <-. cbn [is_true fst snd]. destruct (least <=? delays first end_) eqn:L; auto. decided. auto.
  - intros [[|] []] from upto n E L; try discriminate; simpl in E. injection E as <- <- <-.
    apply Z.leb_le. exact L.
Qed.

Lemma kept_by_adding_robots c r t : adds (robots_if_false w r t) (true_if_robots r t) c = true -> Kept c.
Proof.
  apply (kept_by_adding _ _ (presences r t) c (fun m => seat (snd m)) (presence r t));
    auto using presences_are_not_negative.
  - intros l from upto n E.
    assert (One : match Map.find (robot_of_meaning (snd l)) (member_of w) with
      | Some (_, g) =>
          if unless_present w [l] (robot_of_meaning (snd l)) r t then Some (seat g, seat g + 1, 1) else None
      | None => None
      end = Some (from, upto, n) -> is_true (snd l) = fst l \/ n <= presences r t from upto).
    { intros H. destruct (unless_present w [l] (robot_of_meaning (snd l)) r t) eqn:U;
        [| destruct (Map.find _ _) as [[? ?] |]; discriminate].
      destruct (presence_is_of_a_robot _ _ _ _ U) as (a & g & Found & K). rewrite Found in H. injection H as <- <- <-.
      destruct (is_in i a (route a) r t) eqn:In_it.
      - right. pose proof (found_member a g _ Found) as [M E'].
        pose proof (one_is_in_its_range (fun m => seat (snd m)) (presence r t) (a, g)
          (fun m _ => presences_are_not_negative r t m) M) as L.
        unfold presence at 1 in L. cbn [fst snd] in L. rewrite In_it in L. exact L.
      - left. destruct (K eq_refl) as (l' & [<- | []] & T). exact T. }
    unfold robots_if_false in E. destruct l as [[|] []];
      try (apply One, E).
    destruct ((place =? r) && (tick =? t)) eqn:Same; [| discriminate]. decided. subst. injection E as <- <- <-.
    cbn [is_true fst snd]. destruct (least <=? presences r t first end_) eqn:L; auto. decided. auto.
  - intros [[|] []] from upto n E L; try discriminate; simpl in E.
    destruct ((place =? r) && (tick =? t)) eqn:Same; [| discriminate]. decided. subst. injection E as <- <- <-.
    apply Z.leb_le. exact L.
Qed.

(** ** Capacity *)

Lemma room_is_not_exceeded x r t ids : Map.find r (places w) = Some x -> NoDup ids ->
  (forall id, In id ids -> Occupies (plans s) id r t) -> Z.of_nat (length ids) <= capacity x.
Proof.
  intros F N H. destruct (places_are_right i w tabled r x F) as [Hx <-]. apply (capacity_is_kept i s lawful x t); auto.
Qed.

Lemma presences_keep_capacity x r t first end_ : Map.find r (places w) = Some x ->
  presences r t first end_ <= capacity x.
Proof.
  intros F. set (here := filter (fun m => is_in i (fst m) (route (fst m)) r t) (crew w)).
  assert (L : presences r t first end_ <= Z.of_nat (length here)).
  { unfold presences, ranged, here. clear. induction (crew w) as [| m l IH]; simpl; [lia |].
    unfold presence at 1. destruct (_ && _), (is_in _ _ _ _ _); simpl length; simpl Z.b2z; lia. }
  rewrite <- (map_length (fun m => robot_id (fst m))) in L. etransitivity; [exact L |].
  apply (room_is_not_exceeded x r t); auto.
  - pose proof (crew_is_distinct i w tabled) as N. unfold here. clear - N.
    induction (crew w) as [| m l IH]; simpl in *; auto. inversion N as [| ? ? Hn Hd]; subst.
    destruct (is_in _ _ _ _ _); simpl; auto. constructor; auto. intros H. apply Hn.
    apply in_map_iff in H as (x & E & H). apply filter_In in H as [H _]. apply in_map_iff. eauto.
  - intros id H. apply in_map_iff in H as (m & <- & H). apply filter_In in H as [H K].
    apply robot_inside_occupies; auto.
Qed.

Lemma kept_by_capacity c :
  existsb (fun l => match l with (false, Crowded _ _ r _ n) => room_below w r n | _ => false end) c = true -> Kept c.
Proof.
  intros H. apply existsb_exists in H as (l & Hl & H). destruct l as [[|] []]; try discriminate.
  exists (false, Crowded first end_ place tick least). split; auto. simpl. apply Z.leb_gt.
  unfold room_below in H. destruct (Map.find place (places w)) as [x |] eqn:F; [| discriminate]. decided.
  pose proof (presences_keep_capacity x place tick first end_ F). lia.
Qed.

Lemma kept_by_room_for_one c one other r t : one <> other -> room_below w r 2 = true ->
  unless_present w c one r t = true -> unless_present w c other r t = true -> Kept c.
Proof.
  intros D R U V. destruct (presence_is_of_a_robot _ _ _ _ U) as (a & g & F & K).
  destruct (presence_is_of_a_robot _ _ _ _ V) as (b & h & G & L).
  destruct (is_in i a (route a) r t) eqn:A; [| auto]. destruct (is_in i b (route b) r t) eqn:B; [| auto]. exfalso.
  destruct (found_member a g one F) as [Ma Ea]. destruct (found_member b h other G) as [Mb Eb].
  unfold room_below in R. destruct (Map.find r (places w)) as [x |] eqn:X; [| discriminate]. decided.
  pose proof (room_is_not_exceeded x r t [one; other] X) as C. simpl length in C.
  assert (Z.of_nat 2 <= capacity x); [apply C | lia].
  - repeat constructor; simpl; intuition congruence.
  - intros id [<- | [<- | []]]; [rewrite <- Ea | rewrite <- Eb].
    + apply (robot_inside_occupies (a, g)); auto.
    + apply (robot_inside_occupies (b, h)); auto.
Qed.

(** ** Exchange *)

Lemma kept_by_exchange c one other r x t : one <> other -> r <> x ->
  unless_free c one r t = true -> unless_free c other x t = true ->
  unless_present w c one x t = true -> unless_present w c other r t = true -> Kept c.
Proof.
  intros D E Fr Fx U V. destruct (presence_is_of_a_robot _ _ _ _ U) as (a & g & F & K).
  destruct (presence_is_of_a_robot _ _ _ _ V) as (b & h & G & L).
  destruct (is_in i a (route a) x t) eqn:A; [| auto]. destruct (is_in i b (route b) r t) eqn:B; [| auto].
  destruct (is_free i a (route a) r t) eqn:A'; [| exact (kept_unless_free a g one F c _ _ Fr A')].
  destruct (is_free i b (route b) x t) eqn:B'; [| exact (kept_unless_free b h other G c _ _ Fx B')]. exfalso.
  destruct (found_member a g one F) as [Ma <-]. destruct (found_member b h other G) as [Mb <-].
  pose proof (robot_inside_occupies (a, g) x t Ma A) as (p & u & Hp & _ & Hu & Ru & _).
  pose proof (robot_inside_occupies (b, h) r t Mb B) as (q & v & Hq & _ & Hv & Rv & _).
  assert (Known : forall p u, In p (plans s) -> In u (visits p) -> In (visit_resource u) (resource_ids i)).
  { intros p' u' Hp' Hu'. destruct (planned_robot_is_known i s lawful p' Hp') as (a' & Ha' & E').
    apply (visits_resources i a' p' (plans_lawful i s lawful p' a' Hp' Ha' E') u' Hu'). }
  apply (exchanges_are_avoided i s lawful (robot_id a) (robot_id b) r x t); auto.
  - rewrite <- Rv. exact (Known q v Hq Hv).
  - rewrite <- Ru. exact (Known p u Hp Hu).
  - apply (robot_free_elsewhere_makes_the_move (a, g)); auto.
  - apply (robot_free_elsewhere_makes_the_move (b, h)); auto.
Qed.

(** ** What is demanded *)

Let met := Meets i s (map fst (crew w)).

Lemma all_delays_are_below total first end_ : met (Cheaper_than total) -> delays first end_ < delays_below w total.
Proof.
  unfold met, Meets. rewrite (sum_over_images (A := member)). intros H. unfold delays, ranged, delays_below.
  assert (L : forall l, (forall m, In m l -> In m (crew w)) ->
    sum (fun m : member => if (first <=? rank (snd m)) && (rank (snd m) <? end_) then delay m else 0) l +
    sum (fun m : member => shortest (snd m)) l <= sum (fun m : member => cost_of_robot i s (robot_id (fst m))) l).
  { unfold sum. induction l as [| m l IH]; cbn [fold_right]; intros Hl; [lia |].
    specialize (IH (fun x Hx => Hl x (or_intror Hx))). pose proof (Hl m (or_introl eq_refl)) as M.
    pose proof (route_costs_no_more m M). pose proof (delays_are_not_negative m M).
    assert (delay m + shortest (snd m) <= cost_of_robot i s (robot_id (fst m))) by (unfold delay; lia).
    destruct (_ && _); lia. }
  specialize (L (crew w) (fun _ H => H)). lia.
Qed.

Lemma kept_by_costing_less asked c : met asked -> too_late w asked c = true -> Kept c.
Proof.
  unfold too_late. destruct asked as [| k |]; try discriminate. intros L H. apply orb_true_iff in H as [H | H].
  - decided. pose proof (all_delays_are_below k 0 0 L) as D. unfold delays in D.
    assert (0 <= ranged (fun m => rank (snd m)) delay 0 0); [| lia].
    apply sum_is_not_negative. intros m Hm. pose proof (delays_are_not_negative m Hm). destruct (_ && _); lia.
  - apply existsb_exists in H as (l & Hl & H). exists l. split; auto.
    destruct l as [[|] []]; try discriminate; cbn [delays_if_false] in H.
    + destruct (Map.find id (member_of w)) as [[a g] |] eqn:Found; [| discriminate]. decided.
      cbn [is_true fst snd]. rewrite (of_found_robot a g id Found). apply Z.leb_gt.
      pose proof (one_is_in_its_range (fun m => rank (snd m)) delay (a, g) delays_are_not_negative
        (listed_member a g id Found)) as D.
      pose proof (all_delays_are_below k (rank g) (rank g + 1) L) as B. unfold delays in B. cbn [snd] in D.
      unfold delay at 1 in D. simpl in D. lia.
    + decided. cbn [is_true fst snd]. apply Z.leb_gt. pose proof (all_delays_are_below k first end_ L). lia.
Qed.

Lemma kept_by_keeping_the_deadline asked c id : met asked -> if_in_time w asked c id = true -> Kept c.
Proof.
  unfold if_in_time. destruct asked as [| | due]; try discriminate. intros L H.
  apply some_robot in H as (a & g & Found & H). apply existsb_exists in H as (d & Hd & H). decided.
  apply (kept_if_cheaper a g id Found c (snd d + 1 - release a)); auto. destruct (found_member a g id Found) as [M E].
  destruct (member_has_a_plan (a, g) M) as (p & _ & _ & Hp & Ep & W & R & _). cbn [fst] in *.
  pose proof (L d Hd p Hp ltac:(congruence)).
  pose proof (counted_arrives_no_later i a right (member_is_a_robot (a, g) M) _ W).
  unfold route_cost. rewrite R. lia.
Qed.

(** * All clauses *)

Theorem justified_clause_is_kept asked c why : met asked -> justified w asked c why = true -> Kept c.
Proof.
  intros L H. destruct why; cbn [justified] in H.
  - apply some_robot in H as (a & g & Found & H). rewrite (takes_are_right i w tabled) in H. decided.
    apply (kept_at_the_start a g id Found); auto.
    match goal with K : _ || _ = true |- _ => apply orb_true_iff in K as [K | K] end; decided; auto.
  - apply some_robot in H as (a & g & Found & H). decided.
    match goal with K : forallb _ _ = true |- _ => rename K into All end.
    assert (Each : forall x, Move i place x -> if_free w c id x (tick + need i a x) = true /\
      (x = goal a -> if_cheaper w c id (tick + 1 - release a) = true)).
    { intros x M. apply (onwards_are_moves i w tabled) in M. apply (proj1 (forallb_forall _ _) All) in M.
      rewrite (takes_are_right i w tabled) in M. apply andb_true_iff in M as [M N]. split; auto. intros ->.
      rewrite Z.eqb_refl in N. exact N. }
    apply (kept_by_going_on a g id Found c place tick); auto; intros; eapply Each; eauto.
  - apply some_robot in H as (a & g & Found & H). rewrite (takes_are_right i w tabled) in H. decided.
    match goal with K : forallb _ _ = true |- _ => rename K into All end.
    match goal with K : _ && _ = false |- _ => rename K into Not_first end.
    apply (kept_by_coming_from a g id Found c place tick); auto.
    + intros x M. apply (backwards_are_moves i w tabled) in M. apply (proj1 (forallb_forall _ _) All) in M. exact M.
    + apply andb_false_iff in Not_first as [N | N]; decided; auto.
  - apply some_robot in H as (a & g & Found & H). apply andb_true_iff in H as [U F].
    destruct (is_free i a (route a) place tick) eqn:Is_free; [| exact (kept_unless_free a g id Found c _ _ U Is_free)].
    exact (kept_if_free a g id Found c _ _ F Is_free).
  - apply some_robot in H as (a & g & Found & H). decided.
    match goal with K : forallb _ _ = true |- _ => rename K into All end.
    match goal with K : _ && _ = false |- _ => rename K into Not_first end.
    apply (kept_by_arriving a g id Found c cost); auto.
    + intros x M. apply (backwards_are_moves i w tabled) in M. apply (proj1 (forallb_forall _ _) All) in M. exact M.
    + apply andb_false_iff in Not_first as [N | N]; decided; auto.
  - apply some_robot in H as (a & g & Found & H). apply andb_true_iff in H as [C D].
    destruct (Z_lt_le_dec (route_cost a) cost) as [K | K]; [exact (kept_if_cheaper a g id Found c _ D K) |].
    exact (kept_if_costs a g id Found c _ C K).
  - decided. match goal with K : unless_present _ _ _ _ _ = true |- _ => rename K into Unless end.
    destruct (presence_is_of_a_robot _ _ _ _ Unless) as (a & g & Found & K).
    destruct (is_in i a (route a) place tick) eqn:Inside; auto.
    match goal with E : existsb _ _ = true |- _ => apply existsb_exists in E as (l & Hl & E) end.
    destruct l as [[|] []]; try discriminate. decided. subst. eexists. split; [eassumption |].
    cbn [is_true fst snd]. rewrite (of_found_robot a g id Found). exact Inside.
  - apply existsb_exists in H as (l & Hl & H). destruct l as [[|] []]; try discriminate. eexists. eauto.
  - apply kept_by_adding_delays, H.
  - apply (kept_by_adding_robots c place tick), H.
  - apply kept_by_capacity, H.
  - decided. apply (kept_by_room_for_one c one other place tick); auto.
  - decided. apply (kept_by_exchange c one other source target tick); auto.
  - eapply kept_by_costing_less; eauto.
  - eapply kept_by_keeping_the_deadline; eauto.
Qed.

(** The valuation that a solution gives the variables. *)
Definition valuation (known : Numbered.t meaning) (n : Z) : bool :=
  match Numbered.find n known with Some m => is_true m | None => false end.

Lemma read_literal_is_true known l r : read_literal known l = Some r -> is_true (snd r) = fst r ->
  True_in (valuation known) l.
Proof.
  unfold read_literal, True_in, valuation. intros H T.
  destruct (Numbered.find (Z.abs l) known) as [m |] eqn:F; [| discriminate].
  destruct (Z.eqb_spec l 0) as [-> | N]; [discriminate |]. injection H as <-. simpl in T.
  destruct (Z.ltb_spec 0 l).
  - left. rewrite Z.abs_eq in F by lia. rewrite F. auto.
  - right. rewrite Z.abs_neq in F by lia. rewrite F. split; [lia | auto].
Qed.

Lemma kept_clause_is_satisfied known c : Kept (read_clause known c) -> Satisfies (valuation known) c.
Proof.
  intros (r & H & T). unfold Satisfies. induction c as [| l rest IH]; simpl in H; [destruct H |].
  destruct (read_literal known l) as [r' |] eqn:E.
  - destruct H as [-> | H].
    + exists l. split; [left; auto | apply (read_literal_is_true known l r E T)].
    + destruct (IH H) as (k & Hk & K). exists k. simpl. auto.
  - destruct (IH H) as (k & Hk & K). exists k. simpl. auto.
Qed.

Lemma justified_clauses_are_satisfied asked known f : forall why, met asked ->
  all_justified w asked known f why = true -> forall c, In c f -> Satisfies (valuation known) c.
Proof.
  induction f as [| c f IH]; simpl; intros why L H d Hd; [destruct Hd |].
  destruct why as [| r why]; [discriminate |].
  destruct (justified w asked (read_clause known c) r) eqn:J; [| discriminate].
  destruct Hd as [<- | Hd]; [| apply (IH why L H d Hd)].
  apply kept_clause_is_satisfied, (justified_clause_is_kept asked _ r L J).
Qed.
End Solution.

Lemma refuted_blueprint_has_no_solution i group asked b lines s : Well_formed i ->
  (forall a, In a group -> In a (robots i)) -> NoDup (map robot_id group) ->
  blueprint_accepted i group asked b && refutes (formula b) lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s -> ~ Meets i s group asked.
Proof.
  intros right Known Distinct H lawful complete L. unfold blueprint_accepted in H.
  apply andb_true_iff in H as [H R]. apply andb_true_iff in H as [H J]. apply andb_true_iff in H as [N G].
  assert (All : map fst (crew (tables_of i group b)) = group) by (apply combined_with_as_many, Nat.eqb_eq, N).
  apply (accepted_refutation_means_unsatisfiable _ _ R (valuation i (tables_of i group b) s (meanings b))).
  apply (justified_clauses_are_satisfied i (tables_of i group b) s right
    (tables_are_right i group b right Known Distinct N G) lawful complete asked (meanings b) _ (reasons b)); auto.
  rewrite All. exact L.
Qed.

Lemma costs_add_up i s : Well_formed i -> Lawful i s ->
  sum (fun a => cost_of_robot i s (robot_id a)) (robots i) = total_cost i s.
Proof.
  intros right lawful. rewrite total_is_the_sum. unfold cost_of_robot. rewrite sums_are_exchanged.
  apply sum_of_equal. intros p Hp.
  rewrite (sum_of_equal _ (fun a => cost_of_plan i p * Z.b2z (robot_id a =? plan_robot p))).
  - rewrite sum_of_multiples, one_of_different_ids; [lia | apply (robot_ids_are_unique i right) |].
    apply (covers_robots i s lawful), in_or_app. left. apply in_map, Hp.
  - intros a _. rewrite Z.eqb_sym. destruct (_ =? _); simpl; lia.
Qed.

(** If the formula of an accepted blueprint of a total is refuted, no lawful solution that plans every robot with a way
    to its goal costs less. *)
Theorem refuted_total_is_impossible i total b lines s : Well_formed i ->
  refuted i (Cheaper_than total) b lines = true -> Lawful i s -> Plans_every_plannable_robot i s -> total <= total_cost i s.
Proof.
  intros right H lawful complete. apply Z.le_ngt. rewrite <- costs_add_up by auto.
  apply (refuted_blueprint_has_no_solution i (robots i) (Cheaper_than total) b lines s right); auto.
  apply (robot_ids_are_unique i right).
Qed.

(** If the formula of an accepted blueprint without a total is refuted, no lawful solution plans every robot with a way
    to its goal. *)
Theorem refuted_instance_has_no_solution i b lines s : Well_formed i -> refuted i Lawful_plans b lines = true ->
  Lawful i s -> ~ Plans_every_plannable_robot i s.
Proof.
  intros right H lawful complete.
  apply (refuted_blueprint_has_no_solution i (robots i) Lawful_plans b lines s right); simpl; auto.
  apply (robot_ids_are_unique i right).
Qed.

(** * Cuts and deadlines *)

Lemma group_is_known i ids a : Well_formed i -> In a (group_of i ids) -> In a (robots i).
Proof.
  intros right H. unfold group_of in H. apply in_flat_map in H as (id & Hid & H).
  destruct (Map.find id (index robot_id (robots i))) as [b |] eqn:F; [| destruct H].
  destruct H as [<- | []]. apply find_in_index in F as [F <-]; auto. apply (robot_ids_are_unique i right).
Qed.

Lemma group_has_the_ids i ids : Well_formed i -> length (group_of i ids) = length ids ->
  map robot_id (group_of i ids) = ids.
Proof.
  intros right. unfold group_of.
  assert (Short : forall l, (length (flat_map (fun id : Z => match Map.find id (index robot_id (robots i)) with
    | Some a => [a] | None => [] end) l) <= length l)%nat).
  { induction l as [| id l IH]; simpl; auto. rewrite app_length.
    destruct (Map.find id (index robot_id (robots i))); simpl; lia. }
  induction ids as [| id ids IH]; simpl; auto. intros L. rewrite app_length in L. specialize (Short ids).
  destruct (Map.find id (index robot_id (robots i))) as [a |] eqn:F; cbn [app map length] in *; [| lia].
  apply find_in_index in F as [_ E]; [| apply (robot_ids_are_unique i right)]. rewrite IH by lia. congruence.
Qed.

Lemma refuted_group_does_not_meet i ids asked b lines s : Well_formed i -> group_refuted i ids asked b lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s ->
  map robot_id (group_of i ids) = ids /\ ~ Meets i s (group_of i ids) asked.
Proof.
  intros right H lawful complete. unfold group_refuted in H. rewrite <- andb_assoc in H.
  apply andb_true_iff in H as [H R]. apply andb_true_iff in H as [D L].
  apply Ids.distinct_iff in D. apply Nat.eqb_eq in L. apply (group_has_the_ids i _ right) in L. split; auto.
  apply (refuted_blueprint_has_no_solution i _ asked b lines s right); auto.
  - intros a Ha. apply (group_is_known i ids); auto.
  - rewrite L. exact D.
Qed.

(** The robots of a refuted cut cost at least its least total together. *)
Theorem refuted_cut_holds i k b lines s : Well_formed i -> cut_refuted i k b lines = true -> Lawful i s ->
  Plans_every_plannable_robot i s -> Cut_holds i s k.
Proof.
  intros right H lawful complete.
  destruct (refuted_group_does_not_meet i _ _ b lines s right H lawful complete) as [E N].
  unfold Cut_holds. apply Z.le_ngt. rewrite <- E, sum_over_images. exact N.
Qed.

(** In every lawful solution that plans every robot with a way to its goal, one of the robots with refuted deadlines
    enters its goal for the last time after its own. *)
Theorem refuted_deadlines_are_not_all_kept i g b lines s : Well_formed i -> deadlines_refuted i g b lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s ->
  exists id tick p, In (id, tick) (deadlines g) /\ In p (plans s) /\ plan_robot p = id /\ tick < arrives (visits p).
Proof.
  intros right H lawful complete.
  destruct (refuted_group_does_not_meet i _ _ b lines s right H lawful complete) as [_ N].
  set (late := fun d p => (plan_robot p =? fst d) && (snd d <? arrives (visits p))).
  destruct (existsb (fun d => existsb (late d) (plans s)) (deadlines g)) eqn:Late.
  - apply existsb_exists in Late as ([id tick] & Hd & Late). apply existsb_exists in Late as (p & Hp & Late).
    unfold late in Late. decided. exists id, tick, p. auto.
  - destruct N. intros d Hd p Hp E. apply Z.le_ngt. intros L. apply not_true_iff_false in Late. apply Late.
    apply existsb_exists. exists d. split; auto. apply existsb_exists. exists p. split; auto.
    unfold late. apply andb_true_iff. split; [apply Z.eqb_eq, E | apply Z.ltb_lt, L].
Qed.

Lemma robot_has_one_plan_at_most i s id : Lawful i s -> sum (fun p => Z.b2z (plan_robot p =? id)) (plans s) <= 1.
Proof.
  intros lawful. destruct (in_dec Z.eq_dec id (planned s)) as [H | H].
  - rewrite one_of_different_ids; [lia | | exact H]. apply (robots_have_one_plan i s lawful).
  - rewrite (sum_of_equal _ (fun _ => 0)), sum_of_zeros; [lia |]. intros p Hp.
    destruct (Z.eqb_spec (plan_robot p) id) as [<- |]; auto. destruct H. apply in_map, Hp.
Qed.

Lemma refuted_deadlines_hold i g b lines s : Well_formed i -> deadlines_refuted i g b lines = true -> Lawful i s ->
  Plans_every_plannable_robot i s -> Group_holds s g.
Proof.
  intros right H lawful complete.
  destruct (refuted_deadlines_are_not_all_kept i g b lines s right H lawful complete)
    as (id & tick & p & Hd & Hp & E & L).
  set (late := fun q d => Z.b2z ((plan_robot q =? fst d) && (snd d <? arrives (visits q)))).
  set (all := sum (fun q => sum (late q) (deadlines g)) (plans s)).
  assert (One : 1 <= all).
  { assert (P : forall q d, 0 <= late q d) by (intros; unfold late; destruct (_ && _); simpl; lia).
    assert (S : late p (id, tick) = 1).
    { unfold late. simpl. rewrite (proj2 (Z.eqb_eq _ _) E), (proj2 (Z.ltb_lt _ _) L). reflexivity. }
    rewrite <- S. etransitivity; [apply (sum_is_above_each (late p) (deadlines g)); auto |].
    apply (sum_is_above_each (fun q => sum (late q) (deadlines g)) (plans s)); auto.
    intros q _. apply sum_is_not_negative. auto. }
  unfold Group_holds. set (kept := fun q d => Z.b2z (keeps (plan_robot q) (arrives (visits q)) d)).
  assert (All : sum (fun q => sum (kept q) (deadlines g)) (plans s) + all <= Z.of_nat (length (deadlines g)));
    [| unfold kept in All; lia].
  unfold all. rewrite <- sum_of_sums.
  rewrite (sum_of_equal _ (fun q => sum (fun d => Z.b2z (plan_robot q =? fst d)) (deadlines g))).
  - rewrite sums_are_exchanged. clear - lawful. induction (deadlines g) as [| d l IH]; simpl; [lia |].
    pose proof (robot_has_one_plan_at_most i s (fst d) lawful). lia.
  - intros q _. rewrite <- sum_of_sums. apply sum_of_equal. intros d _. unfold late, kept, keeps. rewrite Z.eqb_sym.
    rewrite Z.ltb_antisym. destruct (_ =? _), (_ <=? _); reflexivity.
Qed.

Lemma all_refuted_claims_hold {A} refuted (Holds : A -> Prop) claimed :
  (forall k b lines, refuted k b lines = true -> Holds k) ->
  forall proofs, all_refuted refuted claimed proofs = true -> forall k, In k claimed -> Holds k.
Proof.
  intros R. induction claimed as [| k claimed IH]; intros proofs H j Hj; [destruct Hj |].
  destruct proofs as [| [b lines] proofs]; [discriminate |]. simpl in H.
  destruct (refuted k b lines) eqn:K; [| discriminate].
  destruct Hj as [<- | Hj]; [apply (R _ _ _ K) | apply (IH proofs H j Hj)].
Qed.

(** No lawful solution that plans every robot with a way to its goal costs less than an accepted bound whose cuts and
    deadlines are refuted. *)
Theorem bound_with_refuted_groups_is_below_every_solution i s c all of_cuts of_deadlines : Well_formed i ->
  bound_accepted i c all = true -> groups_refuted i c of_cuts of_deadlines = true ->
  Lawful i s -> Plans_every_plannable_robot i s -> bound c <= total_cost i s.
Proof.
  intros right H R lawful complete. apply andb_true_iff in R as [Cuts Deadlines].
  apply (accepted_bound_is_below_every_solution i s c all); auto.
  - apply (all_refuted_claims_hold (cut_refuted i) _ _ (fun k b lines K =>
      refuted_cut_holds i k b lines s right K lawful complete) _ Cuts).
  - apply (all_refuted_claims_hold (deadlines_refuted i) _ _ (fun g b lines K =>
      refuted_deadlines_hold i g b lines s right K lawful complete) _ Deadlines).
Qed.
