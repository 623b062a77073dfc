(** The dependency graph of plans: which visits wait for which others if robots keep the order of the plans. Lawful
    plans and all executions in their order keep its edges.

    The functions are there for their proofs: none is faster than it must be to be right. *)
Require Import ZArith List Bool Lia Relations.
From Carproof Require Import Law Ways Execution Dependencies.
Import ListNotations.
Open Scope Z_scope.

(** The visits from the number [n] on. *)
Fixpoint numbered (id : Z) (n : nat) (vs : list visit) : list (node * visit) :=
  match vs with [] => [] | v :: rest => ((id, n), v) :: numbered id (S n) rest end.
Definition stays (ps : list plan) : list (node * visit) := flat_map (fun p => numbered (plan_robot p) 0 (visits p)) ps.
Definition nodes (ps : list plan) : list node := map fst (stays ps).

Definition visit_at (ps : list plan) (n : node) : option visit :=
  option_map snd (find (fun s => same (fst s) n) (stays ps)).

(** The places of both are known and the same. *)
Definition same_place (v w : option visit) : bool :=
  match v, w with Some v, Some w => visit_resource v =? visit_resource w | _, _ => false end.

Lemma found_by_id {A} (key : A -> Z) (l : list A) x : NoDup (map key l) -> In x l ->
  find (fun y => key y =? key x) l = Some x.
Proof.
  intros N X. destruct (find _ l) as [y|] eqn:F.
  - apply find_some in F as [Y E]. apply Z.eqb_eq in E. f_equal. revert N X Y E. clear. induction l as [|z l IH].
    + intros _ [].
    + simpl. intros N X Y E. inversion N as [|? ? H K]; subst. destruct X as [<-|X], Y as [<-|Y]; auto.
      * destruct H. rewrite <- E. apply in_map. exact Y.
      * destruct H. rewrite E. apply in_map. exact X.
  - apply (find_none _ _ F) in X. rewrite Z.eqb_refl in X. discriminate.
Qed.

Section Order.
Variable i : instance.
Notation gap := (gap i).
Notation Executes := (Executes i).
Notation Left_before := (Left_before i).

(** The ticks that the robot needs in the place at least. *)
Definition needs (id place : Z) : Z :=
  match find (fun a => robot_id a =? id) (robots i), find (fun r => resource_id r =? place) (resources i) with
  | Some a, Some r => least_stay a r
  | _, _ => 0
  end.

Definition is_left_before (v w : visit) : bool :=
  match leave v with Some l => l + gap <=? enter w | None => false end.

(** A robot enters its next visit when it has stayed for the duration. *)
Definition travels (ps : list plan) (s : node * visit) : list dependency :=
  let (n, v) := s in
  match visit_at ps (next n) with
  | Some _ => [Dependency n (next n) (needs (fst n) (visit_resource v)) true]
  | None => []
  end.

(** The one robot leaves to where the other comes from. *)
Definition is_opposite (ps : list plan) (one other : node) : bool :=
  match snd other with
  | O => false
  | S n => same_place (visit_at ps (next one)) (visit_at ps (fst other, n))
  end.

(** A robot enters when the one before it has entered its next visit, or has stayed in its last one for the
    duration. *)
Definition wait (ps : list plan) (one : node * visit) (n : node) : dependency :=
  let (m, v) := one in
  match visit_at ps (next m) with
  | Some _ => Dependency (next m) n (if is_opposite ps m n then 1 else gap) false
  | None => Dependency m n (needs (fst m) (visit_resource v) + gap) true
  end.
Definition waits (ps : list plan) (one other : node * visit) : list dependency :=
  let (n, w) := other in
  if (visit_resource (snd one) =? visit_resource w) && is_left_before (snd one) w then [wait ps one n] else [].

(** The edges of the dependency graph, also those that follow from others. *)
Definition dependencies (ps : list plan) : list dependency :=
  flat_map (travels ps) (stays ps) ++ flat_map (fun one => flat_map (waits ps one) (stays ps)) (stays ps).

(** No visit there is after the one and before the other. *)
Definition is_direct (ps : list plan) (one other : node * visit) : bool :=
  negb (existsb (fun u => (visit_resource (snd u) =? visit_resource (snd one)) && is_left_before (snd one) (snd u)
    && is_left_before (snd u) (snd other)) (stays ps)).
Definition direct_waits (ps : list plan) (one other : node * visit) : list dependency :=
  if is_direct ps one other then waits ps one other else [].

(** The edges of the dependency graph but for those that follow from others. *)
Definition direct_dependencies (ps : list plan) : list dependency :=
  flat_map (travels ps) (stays ps)
  ++ flat_map (fun one => flat_map (direct_waits ps one) (stays ps)) (stays ps).

(** * Look-ups *)

Lemma in_numbered id vs : forall k n v, In (n, v) (numbered id k vs) <->
  exists j, n = (id, (k + j)%nat) /\ nth_error vs j = Some v.
Proof.
  induction vs as [|x vs IH]; intros k n v; simpl.
  - split; [tauto|]. intros ([|j] & _ & H); discriminate.
  - rewrite IH. split.
    + intros [E|(j & -> & H)].
      * injection E as <- <-. exists 0%nat. rewrite Nat.add_0_r. auto.
      * exists (S j). rewrite Nat.add_succ_r. auto.
    + intros ([|j] & -> & H).
      * injection H as ->. rewrite Nat.add_0_r. auto.
      * right. exists j. rewrite Nat.add_succ_r. auto.
Qed.

Lemma in_stays ps n v : In (n, v) (stays ps) <-> Visit_of ps (fst n) (snd n) v.
Proof.
  unfold stays, Visit_of. rewrite in_flat_map. setoid_rewrite in_numbered. split.
  - intros (p & P & j & -> & V). exists p. auto.
  - intros (p & P & E & V). exists p. split; [exact P|]. exists (snd n). rewrite E. destruct n. auto.
Qed.

Lemma in_nodes ps n : In n (nodes ps) <-> exists v, Visit_of ps (fst n) (snd n) v.
Proof.
  unfold nodes. rewrite in_map_iff. split.
  - intros ([m v] & <- & H). exists v. apply in_stays. exact H.
  - intros (v & H). exists (n, v). split; [reflexivity|]. apply in_stays. exact H.
Qed.

Lemma visit_at_iff ps n v : NoDup (map plan_robot ps) ->
  visit_at ps n = Some v <-> Visit_of ps (fst n) (snd n) v.
Proof.
  intros N. unfold visit_at. rewrite <- in_stays. destruct (find _ _) as [[m w]|] eqn:F; simpl.
  - apply find_some in F as [F E]. apply same_iff in E. simpl in E. subst m. split.
    + intros E. injection E as ->. exact F.
    + intros V. apply in_stays in F, V. f_equal. eapply visit_is_unique; eauto.
  - split; [discriminate|]. intros V. apply (find_none _ _ F) in V. simpl in V.
    assert (same n n = true) by (apply same_iff; reflexivity). congruence.
Qed.

Lemma visit_at_none ps n : NoDup (map plan_robot ps) ->
  visit_at ps n = None <-> forall v, ~ Visit_of ps (fst n) (snd n) v.
Proof.
  intros N. split.
  - intros E v V. apply visit_at_iff in V; congruence.
  - intros H. destruct (visit_at ps n) as [v|] eqn:E; auto. apply visit_at_iff in E; auto. destruct (H v E).
Qed.

Lemma is_left_before_iff v w : is_left_before v w = true <-> Left_before v w.
Proof.
  unfold is_left_before, Left_before. destruct (leave v) as [l|].
  - rewrite Z.leb_le. split; [intros H; exists l; auto | intros (k & E & H); injection E as ->; exact H].
  - split; [discriminate | intros (k & E & _); discriminate].
Qed.

Section Plans.
Variable ps : list plan.
Hypothesis one_plan_each : NoDup (map plan_robot ps).

Lemma is_opposite_iff m n : is_opposite ps m n = true <-> exists k v' w',
  snd n = S k /\ Visit_of ps (fst m) (S (snd m)) v' /\ Visit_of ps (fst n) k w' /\
  visit_resource v' = visit_resource w'.
Proof.
  unfold is_opposite. destruct (snd n) as [|k]; [split; [discriminate | intros (k & v & w & E & _); discriminate]|].
  unfold same_place. destruct (visit_at ps (next m)) as [v|] eqn:V, (visit_at ps (fst n, k)) as [w|] eqn:W.
  - apply visit_at_iff in V, W; auto. simpl in V, W. rewrite Z.eqb_eq. split.
    + intros E. exists k, v, w. auto.
    + intros (j & v' & w' & E & V' & W' & F). injection E as <-.
      assert (v' = v) as <- by eauto using visit_is_unique. assert (w' = w) as <- by eauto using visit_is_unique.
      exact F.
  - split; [discriminate|]. intros (j & v' & w' & E & _ & W' & _). injection E as <-.
    apply visit_at_none with (v := w') in W; auto.
  - split; [discriminate|]. intros (j & v' & w' & E & V' & _). apply visit_at_none with (v := v') in V; auto.
  - split; [discriminate|]. intros (j & v' & w' & E & V' & _). apply visit_at_none with (v := v') in V; auto.
Qed.

(** The edges of the graph. *)
Inductive Edge : dependency -> Prop :=
  | Travel n v w : Visit_of ps (fst n) (snd n) v -> Visit_of ps (fst n) (S (snd n)) w ->
      Edge (Dependency n (next n) (needs (fst n) (visit_resource v)) true)
  | Order_moving m v v' n w : Visit_of ps (fst m) (snd m) v -> Visit_of ps (fst n) (snd n) w ->
      visit_resource v = visit_resource w -> Left_before v w ->
      Visit_of ps (fst m) (S (snd m)) v' ->
      Edge (Dependency (next m) n (if is_opposite ps m n then 1 else gap) false)
  | Order_ending m v n w : Visit_of ps (fst m) (snd m) v -> Visit_of ps (fst n) (snd n) w ->
      visit_resource v = visit_resource w -> Left_before v w ->
      (forall v', ~ Visit_of ps (fst m) (S (snd m)) v') ->
      Edge (Dependency m n (needs (fst m) (visit_resource v) + gap) true).

Lemma in_dependencies e : In e (dependencies ps) <-> Edge e.
Proof.
  unfold dependencies. rewrite in_app_iff, !in_flat_map. split.
  - intros [((n, v) & V & T)|((m, v) & V & O)].
    + apply in_stays in V. unfold travels in T. destruct (visit_at ps (next n)) as [w|] eqn:W; [|destruct T].
      apply visit_at_iff in W; auto. destruct T as [<-|[]]. eapply Travel; eauto.
    + apply in_flat_map in O as ((n, w) & W & O). apply in_stays in V, W. unfold waits in O. simpl in O.
      destruct (Z.eqb_spec (visit_resource v) (visit_resource w)) as [E|]; [|destruct O].
      destruct (is_left_before v w) eqn:L; [|destruct O]. apply is_left_before_iff in L. destruct O as [<-|[]].
      unfold wait. destruct (visit_at ps (next m)) as [v'|] eqn:F.
      * apply visit_at_iff in F; auto. eapply Order_moving; eauto.
      * eapply Order_ending; eauto. exact (proj1 (visit_at_none ps (next m) one_plan_each) F).
  - intros [n v w V W|m v v' n w V W E L F|m v n w V W E L F].
    + left. exists (n, v). split; [apply in_stays; exact V|]. unfold travels.
      rewrite (proj2 (visit_at_iff ps (next n) w one_plan_each) W). left. reflexivity.
    + right. exists (m, v). split; [apply in_stays; exact V|]. apply in_flat_map. exists (n, w).
      split; [apply in_stays; exact W|]. unfold waits. simpl.
      rewrite (proj2 (Z.eqb_eq _ _) E), (proj2 (is_left_before_iff v w) L).
      rewrite (proj2 (visit_at_iff ps (next m) v' one_plan_each) F). left. reflexivity.
    + right. exists (m, v). split; [apply in_stays; exact V|]. apply in_flat_map. exists (n, w).
      split; [apply in_stays; exact W|]. unfold waits. simpl.
      rewrite (proj2 (Z.eqb_eq _ _) E), (proj2 (is_left_before_iff v w) L).
      rewrite (proj2 (visit_at_none ps (next m) one_plan_each) F). left. reflexivity.
Qed.

End Plans.

(** * Lawful plans keep their own order *)

Section Lawful.
Variable s : solution.
Hypothesis well_formed : Well_formed i.
Hypothesis lawful : Lawful i s.
Notation ps := (plans s).
Notation Edge := (Edge (plans s)).
Let one_plan_each : NoDup (map plan_robot ps) := planned_once i s lawful.

Lemma plan_is_of_a_robot p : In p ps -> exists a, In a (robots i) /\ robot_id a = plan_robot p /\ Plan_lawful i a p.
Proof.
  intros P. destruct (covers_robots i s lawful) as [_ C].
  assert (H : In (plan_robot p) (robot_ids i)) by (apply C, in_or_app; left; apply in_map; exact P).
  apply in_map_iff in H as (a & E & A). exists a. split; [exact A|]. split; [exact E|].
  apply (plans_lawful i s lawful p a P A E).
Qed.

Lemma needs_of a r : In a (robots i) -> In r (resources i) -> needs (robot_id a) (resource_id r) = least_stay a r.
Proof.
  intros A R. unfold needs.
  rewrite (found_by_id robot_id (robots i) a), (found_by_id resource_id (resources i) r); auto.
  - apply resource_ids_are_unique; auto.
  - apply robot_ids_are_unique; auto.
Qed.

(** The robot and the resource of a planned visit. *)
Lemma visit_is_known id n v : Visit_of ps id n v -> exists p a r, In p ps /\ plan_robot p = id /\
  nth_error (visits p) n = Some v /\ In a (robots i) /\ robot_id a = id /\ Plan_lawful i a p /\
  In r (resources i) /\ resource_id r = visit_resource v.
Proof.
  intros (p & P & E & V). destruct (plan_is_of_a_robot p P) as (a & A & F & L).
  pose proof (visits_resources i a p L v (nth_error_In _ _ V)) as R. apply in_map_iff in R as (r & G & R).
  exists p, a, r. do 7 (split; [first [assumption | congruence]|]). exact G.
Qed.

Lemma leaves_as_it_moves id n v w : Visit_of ps id n v -> Visit_of ps id (S n) w -> leave v = Some (enter w).
Proof.
  intros V W. destruct (visit_is_known id n v V) as (p & a & _ & P & E & F & _ & _ & L & _).
  destruct W as (q & Q & G & W). assert (q = p) as -> by (apply (plan_of_robot_is_unique ps); congruence).
  apply (is_contiguous i a p L). apply consecutive_by_number. eauto.
Qed.

Lemma needs_are_positive id n v : Visit_of ps id n v -> 1 <= needs id (visit_resource v).
Proof.
  intros V. destruct (visit_is_known id n v V) as (p & a & r & _ & _ & _ & A & <- & _ & R & <-).
  rewrite needs_of by auto. unfold least_stay. pose proof (paces_are_positive i well_formed a A).
  pose proof (durations_are_positive i well_formed r R). nia.
Qed.

Lemma visits_take_time id n v l : Visit_of ps id n v -> leave v = Some l -> enter v < l.
Proof.
  intros V D. pose proof (needs_are_positive id n v V) as P.
  destruct (visit_is_known id n v V) as (p & a & r & _ & _ & F & A & B & L & R & G).
  pose proof (respects_durations i a p L v r l (nth_error_In _ _ F) R G D).
  rewrite <- B, <- G, needs_of in P by auto. lia.
Qed.

Lemma next_visit_is_later id n v w : Visit_of ps id n v -> Visit_of ps id (S n) w -> enter v < enter w.
Proof. intros V W. apply (visits_take_time id n v _ V). exact (leaves_as_it_moves id n v w V W). Qed.

Lemma later_visits_are_later id m n v w : Visit_of ps id m v -> Visit_of ps id n w -> (m < n)%nat ->
  enter v < enter w.
Proof.
  intros V W L. revert w W. induction L as [|n L IH]; intros w W; [eapply next_visit_is_later; eauto|].
  destruct (visit_before ps id n w W) as (u & U). pose proof (next_visit_is_later id n u w U W).
  specialize (IH u U). lia.
Qed.

Lemma moves_are_to_other_places id n v w : Visit_of ps id n v -> Visit_of ps id (S n) w ->
  visit_resource v <> visit_resource w.
Proof.
  intros V W. destruct (visit_is_known id n v V) as (p & a & r & P & E & F & A & _ & L & R & G).
  destruct (visit_is_known id (S n) w W) as (q & _ & r' & Q & E' & F' & _ & _ & _ & R' & G').
  assert (q = p) as -> by (apply (plan_of_robot_is_unique ps); congruence).
  assert (M : Move i (visit_resource v) (visit_resource w)).
  { apply (follows_moves i a p L); [apply consecutive_by_number; eauto | |];
      rewrite <- ?G, <- ?G'; apply in_map; auto. }
  intros S0. rewrite S0 in M. destruct M as [M|[_ M]]; apply (edges_join_resources i well_formed) in M; tauto.
Qed.

Lemma last_visit_ends id n v l : Visit_of ps id n v -> leave v = Some l ->
  (exists w, Visit_of ps id (S n) w) \/ after_goal i = Vanish /\ forall w, ~ Visit_of ps id (S n) w.
Proof.
  intros V E. destruct (visit_at ps (id, S n)) as [w|] eqn:W.
  - left. exists w. apply visit_at_iff in W; auto.
  - right. pose proof (proj1 (visit_at_none ps (id, S n) one_plan_each) W) as M. split; [|exact M].
    destruct (visit_is_known id n v V) as (p & a & _ & P & F & G & _ & _ & L & _).
    destruct (ends_at_goal i a p L) as (front & last & D & _ & T). assert (v = last) as ->.
    { destruct (nth_error (visits p) (S n)) as [w|] eqn:H; [destruct (M w); exists p; auto|].
      rewrite D in G, H. apply nth_error_None in H. rewrite app_length in H. simpl in H.
      assert (n < length (front ++ [last]))%nat by (apply nth_error_Some; congruence).
      rewrite app_length in *. simpl in *. assert (n = length front) as -> by lia.
      rewrite nth_error_app2, Nat.sub_diag in G by lia. simpl in G. congruence. }
    destruct (after_goal i); [reflexivity | congruence].
Qed.

(** A lawful solution is an execution of itself, without delays. *)
Theorem lawful_solution_executes_itself : Executes ps ps.
Proof.
  split.
  - exact one_plan_each.
  - tauto.
  - intros id n x X. exists x. auto.
  - intros a x A X. destruct (visit_is_known _ _ _ X) as (p & b & _ & P & E & F & B & G & L & _).
    assert (a = b) as <-.
    { pose proof (robot_ids_are_unique i well_formed) as N. pose proof (found_by_id robot_id (robots i) a N A) as H.
      rewrite <- G in H. rewrite (found_by_id robot_id (robots i) b N B) in H. congruence. }
    destruct (starts_at_release i a p L) as (first & rest & D & _ & R). rewrite D in F.
    simpl in F. injection F as ->. lia.
  - apply leaves_as_it_moves.
  - apply last_visit_ends.
  - intros a r n x l A R X E D. destruct (visit_is_known _ _ _ X) as (p & b & _ & P & G & F & B & H & L & _).
    assert (a = b) as <-.
    { pose proof (robot_ids_are_unique i well_formed) as N. pose proof (found_by_id robot_id (robots i) a N A) as K.
      rewrite <- H in K. rewrite (found_by_id robot_id (robots i) b N B) in K. congruence. }
    apply (respects_durations i a p L x r l (nth_error_In _ _ F) R (eq_sym E) D).
  - intros one m v other n w y V W E L Y. assert (y = w) as -> by eauto using visit_is_unique. eauto.
  - intros one m v v' other n w w' y V V' W' W E F L Y. assert (y = w) as -> by eauto using visit_is_unique. eauto.
Qed.

(** An execution keeps each edge of the graph: it has entered the one visit when it enters the other. *)
Lemma execution_keeps_edges ts e y : Executes ps ts -> Edge e -> Visit_of ts (fst (later e)) (snd (later e)) y ->
  exists x, Visit_of ts (fst (earlier e)) (snd (earlier e)) x /\ enter x + ticks e <= enter y.
Proof.
  intros X [n v w V W|m v v' n w V W E L V'|m v n w V W E L M] Y; simpl in *.
  - destruct (visit_before _ _ _ _ Y) as (x & X'). exists x. split; [exact X'|].
    destruct (visits_are_planned _ ps ts X _ _ _ X') as (u & U & F).
    assert (u = v) as -> by eauto using visit_is_unique.
    destruct (visit_is_known _ _ _ V) as (p & a & r & _ & _ & _ & A & G & _ & R & H).
    pose proof (visits_are_contiguous _ ps ts X _ _ _ _ X' Y) as D. rewrite <- G, <- H, needs_of by auto.
    rewrite <- G in X'. pose proof (durations_are_kept _ ps ts X a r _ x (enter y) A R X') as K.
    rewrite F in K. specialize (K (eq_sym H) D). lia.
  - destruct (order_is_kept _ ps ts X _ _ v _ _ w y V W E L Y) as (x & X' & l & D & G).
    destruct (stays_until_it_moves _ ps ts X _ _ x l X' D) as [(x' & Z')|[_ M]]; [|destruct (M v' V')].
    exists x'. split; [exact Z'|]. pose proof (visits_are_contiguous _ ps ts X _ _ _ _ X' Z') as D'.
    destruct (is_opposite ps m n) eqn:O; [|rewrite D in D'; injection D' as ->; exact G].
    apply (is_opposite_iff ps one_plan_each) in O as (k & u & w' & K & U & W' & F).
    assert (u = v') as -> by eauto using visit_is_unique. rewrite K in *.
    destruct (exchange_order_is_kept _ ps ts X _ _ v v' _ k w w' y V V' W' W E F) as (z & Z0 & S0); [|exact Y|].
    + destruct L as (l' & D2 & L). rewrite (leaves_as_it_moves _ _ v v' V V') in D2. injection D2 as <-.
      assert (enter v' <= enter w) by (unfold Law.gap in L; destruct (following_is_forbidden i); lia).
      destruct (Z.eq_dec (enter v') (enter w)) as [T|T]; [|lia]. exfalso.
      pose proof (move_of_plans ps one_plan_each _ _ v v' V V') as MV.
      pose proof (move_of_plans ps one_plan_each _ _ w' w W' W) as MW.
      destruct (Z.eq_dec (fst m) (fst n)) as [I|I].
      * destruct (Nat.lt_trichotomy (snd m) k) as [C|[C|C]].
        -- rewrite I in V'. pose proof (later_visits_are_later _ _ _ _ _ V' W (proj1 (Nat.succ_lt_mono _ _) C)). lia.
        -- subst k. rewrite <- I in W'. assert (w' = v) as -> by eauto using visit_is_unique.
           apply (moves_are_to_other_places _ _ v v' V V'). congruence.
        -- rewrite I in V'. pose proof (later_visits_are_later _ _ _ _ _ W V' (proj1 (Nat.succ_lt_mono _ _) C)). lia.
      * destruct (visit_is_known _ _ _ V) as (_ & _ & r & _ & _ & _ & _ & _ & _ & R & B).
        destruct (visit_is_known _ _ _ V') as (_ & _ & r' & _ & _ & _ & _ & _ & _ & R' & B').
        apply (swaps_are_avoided i s lawful (fst m) (fst n)) with (visit_resource v) (visit_resource v') (enter v');
          auto.
        -- rewrite <- B. apply in_map. exact R.
        -- rewrite <- B'. apply in_map. exact R'.
        -- rewrite T, F, E. exact MW.
    + rewrite (executed_once _ ps ts X _ _ x' z Z' Z0). lia.
  - destruct (order_is_kept _ ps ts X _ _ v _ _ w y V W E L Y) as (x & X' & l & D & G).
    exists x. split; [exact X'|]. destruct (visits_are_planned _ ps ts X _ _ _ X') as (u & U & F).
    assert (u = v) as -> by eauto using visit_is_unique.
    destruct (visit_is_known _ _ _ V) as (p & a & r & _ & _ & _ & A & B & _ & R & H).
    rewrite <- B in X'. pose proof (durations_are_kept _ ps ts X a r _ x l A R X') as K.
    rewrite F in K. specialize (K (eq_sym H) D). rewrite <- B, <- H, needs_of by auto. lia.
Qed.
End Lawful.
End Order.
