(** Who waits for whom: the edges of the dependency graph that follow from others, its cycles, and deadlocks. *)
Require Import ZArith List Bool Lia Relations.
From Carproof Require Import Law Execution Dependencies Order.
Import ListNotations.
Open Scope Z_scope.

Section Waiting.
Variable i : instance.
Notation gap := (gap i).
Notation Executes := (Executes i).
Notation Left_before := (Left_before i).
Notation needs := (needs i).
Notation wait := (wait i).
Notation waits := (waits i).
Notation direct_waits := (direct_waits i).
Notation is_direct := (is_direct i).
Notation dependencies := (dependencies i).
Notation direct_dependencies := (direct_dependencies i).
Notation travels := (travels i).

Section Lawful.
Variable s : solution.
Hypothesis well_formed : Well_formed i.
Hypothesis lawful : Lawful i s.
Notation ps := (plans s).
Notation Edge := (Edge i (plans s)).
Let one_plan_each : NoDup (map plan_robot ps) := planned_once i s lawful.
Let needs_are_positive := needs_are_positive i s well_formed lawful.
Let visits_take_time := visits_take_time i s well_formed lawful.

(** * Edges that follow from others *)

(** If one visit is before another, a way leads between them along direct edges, and takes as long. *)
Lemma way_along_direct_edges edges place size : (forall n, In n (stays ps) -> incl (travels ps n) edges) ->
  (forall one other, In one (stays ps) -> In other (stays ps) -> visit_resource (snd one) = place ->
    incl (direct_waits ps one other) edges) ->
  forall one other, In one (stays ps) -> In other (stays ps) -> visit_resource (snd one) = place ->
  visit_resource (snd other) = place -> Left_before (snd one) (snd other) ->
  enter (snd other) - enter (snd one) <= Z.of_nat size ->
  exists k, ticks (wait ps one (fst other)) <= k /\ Way edges (earlier (wait ps one (fst other))) (fst other) k.
Proof.
  intros T D. assert (G : 0 <= gap <= 1) by (unfold Law.gap; destruct (following_is_forbidden i); lia).
  induction size as [|size IH]; intros one other A B P Q L Z0.
  { destruct one as [m v]. destruct L as (l & E & L). apply in_stays in A. simpl in *.
    pose proof (visits_take_time _ _ v l A E). lia. }
  destruct (is_direct ps one other) eqn:F.
  - exists (ticks (wait ps one (fst other))). split; [lia|].
    assert (W : later (wait ps one (fst other)) = fst other).
    { unfold Order.wait. destruct one as [m v]. destruct (visit_at ps (next m)); reflexivity. }
    rewrite <- W at 2. apply Way_edge. apply (D one other A B P). unfold Order.direct_waits, Order.waits. rewrite F.
    destruct other as [n w]. simpl in *. rewrite P, Q, Z.eqb_refl, (proj2 (is_left_before_iff _ _ w) L).
    left. reflexivity.
  - unfold Order.is_direct in F. apply negb_false_iff, existsb_exists in F as (u & U & F).
    apply andb_true_iff in F as [F H]. apply andb_true_iff in F as [F K]. apply Z.eqb_eq in F.
    apply is_left_before_iff in H, K. rewrite P in F.
    assert (X : enter (snd one) < enter (snd u) /\ enter (snd u) < enter (snd other)).
    { destruct K as (a & Ea & K), H as (b & Eb & H). destruct one as [m v], u as [k u].
      apply in_stays in A, U. simpl in *. pose proof (visits_take_time _ _ v a A Ea).
      pose proof (visits_take_time _ _ u b U Eb). lia. }
    destruct (IH one u A U P F K) as (a & La & Wa); [lia|].
    destruct (IH u other U B F Q H) as (b & Lb & Wb); [lia|]. clear IH.
    assert (N : 1 <= needs (fst (fst u)) (visit_resource (snd u))).
    { destruct u as [k u]. apply in_stays in U. apply (needs_are_positive _ _ _ U). }
    assert (C : 1 <= b /\ earlier (wait ps u (fst other)) = fst u \/ 0 <= b /\
      exists c, 1 <= c /\ Way edges (fst u) (earlier (wait ps u (fst other))) c).
    { destruct u as [k u]. unfold Order.wait in *. simpl in *.
      destruct (visit_at ps (next k)) as [z|] eqn:V; simpl in *.
      - right. split; [destruct (is_opposite ps k (fst other)); lia|].
        exists (needs (fst k) (visit_resource u)). split; [exact N|].
        apply (Way_edge edges (Dependency k (next k) (needs (fst k) (visit_resource u)) true)).
        apply (T (k, u) U). unfold Order.travels. rewrite V. left. reflexivity.
      - left. split; [lia | reflexivity]. }
    assert (M : earlier (wait ps one (fst u)) = earlier (wait ps one (fst other)) /\ 0 <= a /\
      ticks (wait ps one (fst other)) <= Z.max a 1).
    { destruct one as [m v]. apply in_stays in A. pose proof (needs_are_positive _ _ _ A).
      unfold Order.wait in *. simpl in *.
      destruct (visit_at ps (next m)); simpl in *; split; auto.
      - destruct (is_opposite ps m (fst u)), (is_opposite ps m (fst other)); lia.
      - lia. }
    destruct M as (M & A0 & M'). rewrite M in Wa. destruct C as [[C E]|(C & c & C1 & Wc)].
    + exists (a + b). split; [lia|]. rewrite E in Wb. eapply Way_on; [exact Wa | exact Wb].
    + exists (a + (c + b)). split; [lia|]. eapply Way_on; [exact Wa|]. eapply Way_on; [exact Wc | exact Wb].
Qed.

Lemma wait_ends ps' one n : later (wait ps' one n) = n.
Proof. unfold Order.wait. destruct one as [m v]. destruct (visit_at ps' (next m)); reflexivity. Qed.

Lemma in_waits ps' one other e : In e (waits ps' one other) <-> visit_resource (snd one) = visit_resource (snd other) /\
  Left_before (snd one) (snd other) /\ e = wait ps' one (fst other).
Proof.
  unfold Order.waits. destruct other as [n w]. simpl.
  rewrite <- (is_left_before_iff i), <- Z.eqb_eq.
  destruct (visit_resource (snd one) =? visit_resource w), (is_left_before _ (snd one) w); simpl; intuition congruence.
Qed.

Lemma way_of_dependency e : In e (dependencies ps) ->
  exists k, ticks e <= k /\ Way (direct_dependencies ps) (earlier e) (later e) k.
Proof.
  intros E. unfold Order.dependencies in E. apply in_app_or in E as [E|E].
  - exists (ticks e). split; [lia|]. apply Way_edge, in_or_app. left. exact E.
  - apply in_flat_map in E as (one & O & E). apply in_flat_map in E as (other & R & E).
    apply in_waits in E as (P & L & ->). rewrite wait_ends.
    apply way_along_direct_edges with (visit_resource (snd one)) (Z.to_nat (enter (snd other) - enter (snd one))); auto.
    + intros n N f F. apply in_or_app. left. apply in_flat_map. eauto.
    + intros one' other' A B _ f F. apply in_or_app. right. apply in_flat_map. exists one'. split; [exact A|].
      apply in_flat_map. eauto.
    + lia.
Qed.

Lemma direct_dependencies_are_dependencies : incl (direct_dependencies ps) (dependencies ps).
Proof.
  intros e E. apply in_or_app. apply in_app_or in E as [E|E]; [left; exact E | right].
  apply in_flat_map in E as (one & O & E). apply in_flat_map in E as (other & R & E).
  apply in_flat_map. exists one. split; [exact O|]. apply in_flat_map. exists other. split; [exact R|].
  unfold Order.direct_waits in E. destruct (is_direct ps one other); [exact E | destruct E].
Qed.

(** The edges that follow from others can be left out: the same ticks keep the rest, and the same cycles are in it. *)
Theorem direct_edges_are_enough :
  (forall t, (forall e, In e (direct_dependencies ps) -> Keeps t e) <->
    forall e, In e (dependencies ps) -> Keeps t e) /\
  (Acyclic (direct_dependencies ps) <-> Acyclic (dependencies ps)).
Proof.
  split; [intros t|]; split.
  - intros K e E. destruct (way_of_dependency e E) as (k & L & W). pose proof (ways_are_kept _ t _ _ k K W).
    unfold Keeps. lia.
  - intros K e E. apply K, direct_dependencies_are_dependencies, E.
  - intros A n C. apply (A n). eapply way_of_steps; [|exact C]. intros m k (e & E & <- & <-).
    destruct (way_of_dependency e E) as (l & _ & W). eapply way_waits. exact W.
  - intros A n C. apply (A n). eapply way_of_steps; [|exact C]. intros m k (e & E & F & G). apply t_step.
    exists e. split; [apply direct_dependencies_are_dependencies, E | auto].
Qed.

(** * Cycles and deadlocks *)

Lemma edges_join_nodes e : In e (dependencies ps) -> In (earlier e) (nodes ps) /\ In (later e) (nodes ps).
Proof.
  intros E. apply (in_dependencies i ps one_plan_each) in E. rewrite !in_nodes.
  destruct E as [n v w V W|m v v' n w V W _ _ V'|m v n w V W _ _ _]; simpl; eauto.
Qed.

Lemma edges_take_time e : Edge e -> 0 <= ticks e /\ (following_is_forbidden i = true -> 1 <= ticks e).
Proof.
  assert (G : 0 <= gap /\ (following_is_forbidden i = true -> 1 <= gap)).
  { unfold Law.gap. destruct (following_is_forbidden i); split; intros; lia. }
  intros [n v w V W|m v v' n w V W _ _ V'|m v n w V W _ _ _]; simpl.
  - pose proof (needs_are_positive _ _ v V). split; intros; lia.
  - destruct (is_opposite ps m n); [split; intros; lia | exact G].
  - pose proof (needs_are_positive _ _ v V). split; intros; lia.
Qed.

Lemma plans_keep_ways m n v w : clos_trans node (Waits (dependencies ps)) m n ->
  Visit_of ps (fst m) (snd m) v -> Visit_of ps (fst n) (snd n) w ->
  enter v <= enter w /\ (following_is_forbidden i = true -> enter v < enter w).
Proof.
  intros C. revert v w. induction C as [m n (e & E & <- & <-)|m k n _ IH C IK]; intros v w V W.
  - apply (in_dependencies i ps one_plan_each) in E. pose proof (edges_take_time e E) as [P G].
    destruct (execution_keeps_edges i s well_formed lawful ps e w) as (v0 & V0 & K);
      [apply lawful_solution_executes_itself; auto | exact E | exact W|].
    assert (v0 = v) as -> by eauto using visit_is_unique. split; [lia | intros F; specialize (G F); lia].
  - assert (K : exists u, Visit_of ps (fst k) (snd k) u).
    { clear - C one_plan_each. induction C as [k n (e & E & <- & <-)|]; auto. apply in_nodes, edges_join_nodes, E. }
    destruct K as (u & U). destruct (IH v u V U) as [A B], (IK u w U W) as [D E].
    split; [lia | intros F; specialize (B F); lia].
Qed.

(** Robots that wait for each other in a circle enter, by the plans, at one tick: they rotate. *)
Theorem cycles_are_rotations m n v w : clos_trans node (Waits (dependencies ps)) m n ->
  clos_trans node (Waits (dependencies ps)) n m ->
  Visit_of ps (fst m) (snd m) v -> Visit_of ps (fst n) (snd n) w -> enter v = enter w.
Proof. intros C D V W. destruct (plans_keep_ways m n v w C V W), (plans_keep_ways n m w v D W V). lia. Qed.

(** Where following is forbidden, nobody rotates. *)
Theorem without_following_no_cycle : following_is_forbidden i = true -> Acyclic (dependencies ps).
Proof.
  intros F n C. assert (K : exists v, Visit_of ps (fst n) (snd n) v).
  { destruct (waits_in_a_cycle (dependencies ps) n C) as (m & (e & E & _ & <-) & _).
    apply in_nodes, edges_join_nodes, E. }
  destruct K as (v & V). destruct (plans_keep_ways n n v v C V V) as [_ K]. specialize (K F). lia.
Qed.

(** While a visit is left to enter, one can be entered: all visits that it waits for have been. *)
Theorem late_robots_never_deadlock ts : Acyclic (dependencies ps) -> Executes ps ts ->
  (exists id n v, Visit_of ps id n v /\ forall x, ~ Visit_of ts id n x) ->
  exists id n v, Visit_of ps id n v /\ (forall x, ~ Visit_of ts id n x) /\
  forall e, In e (dependencies ps) -> later e = (id, n) -> exists x, Visit_of ts (fst (earlier e)) (snd (earlier e)) x.
Proof.
  intros A X (id & n & v & V & M). pose proof (robots_are_named_once _ ps ts X) as N.
  set (waiting := filter (fun n => match visit_at ts n with Some _ => false | None => true end) (nodes ps)).
  assert (W : forall k, In k waiting <-> (exists u, Visit_of ps (fst k) (snd k) u) /\
    forall x, ~ Visit_of ts (fst k) (snd k) x).
  { intros k. unfold waiting. rewrite filter_In, in_nodes, <- (visit_at_none ts k N).
    destruct (visit_at ts k); intuition congruence. }
  destruct (no_deadlock (dependencies ps) waiting A) as ([id' n'] & I & R).
  - intros E. assert (H : In (id, n) waiting) by (apply W; simpl; eauto). rewrite E in H. destruct H.
  - apply W in I as [(u & U) I]. exists id', n', u. split; [exact U|]. split; [exact I|]. intros e E L.
    destruct (visit_at ts (earlier e)) as [x|] eqn:F; [exists x; apply visit_at_iff; auto|].
    destruct (R (earlier e)); [exists e; auto|]. apply W. split; [|apply visit_at_none; auto].
    apply in_nodes, edges_join_nodes, E.
Qed.

(** The test for cycles: every robot gets to enter if and only if no cycle exists. *)
Theorem everybody_arrives_exactly_when_acyclic :
  is_acyclic (dependencies ps) (nodes ps) = true <-> Acyclic (dependencies ps).
Proof. apply nobody_is_stuck_exactly_when_acyclic. exact edges_join_nodes. Qed.
End Lawful.
End Waiting.
