(** Retiming: after what has happened, the rest of the way in the order of the plans, as early as possible.

    The functions are there for their proofs: none is faster than it must be to be right. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops Execution Dependencies Order.
Import ListNotations.
Open Scope Z_scope.

Section Retiming.
Variable i : instance.
Notation Executes := (Executes i).
Notation Room_is_kept := (Room_is_kept i).
Notation dependencies := (dependencies i).
Notation needs := (needs i).

(** * Visits at given ticks *)

(** The visits from the number [n] on, entered at these ticks; the last one is left after the duration, or never. *)
Fixpoint timed_visits (t : times) (id : Z) (n : nat) (vs : list visit) : list visit :=
  match vs with
  | [] => []
  | v :: rest =>
    let due := option_map (fun _ => t (id, n) + needs id (visit_resource v)) (leave v) in
    let moves := Some (t (id, S n)) in
    Visit (visit_resource v) (t (id, n)) (match rest with [] => due | _ => moves end) :: timed_visits t id (S n) rest
  end.
Definition timed (t : times) (ps : list plan) : list plan :=
  map (fun p => Plan (plan_robot p) (timed_visits t (plan_robot p) 0 (visits p))) ps.

(** * Retiming *)

Definition release_of (id : Z) : Z :=
  match find (fun a => robot_id a =? id) (robots i) with Some a => release a | None => 0 end.

(** Visits that have been entered by the tick [now] keep their ticks; the others come after it, and no robot before its
    release. *)
Definition least_entry (ts : list plan) (now : Z) : times := fun n =>
  match visit_at ts n with
  | Some x => enter x
  | None => match snd n with O => Z.max (now + 1) (release_of (fst n)) | S _ => now + 1 end
  end.

(** Ticks late enough for every dependency: the visits that have not been entered come later than planned, all by the
    same delay. *)
Definition longest_wait (ps : list plan) : Z := fold_right (fun e most => Z.max (ticks e) most) 0 (dependencies ps).
Definition late_entry (ps ts : list plan) (now : Z) : times := fun n =>
  match visit_at ts n, visit_at ps n with
  | None, Some v => enter v + (Z.max 0 now + 1 + longest_wait ps)
  | _, _ => least_entry ts now n
  end.

(** The earliest ticks for all visits after the execution [ts] by the tick [now]. *)
Definition earliest_entry (ps ts : list plan) (now : Z) : times :=
  let first := least_entry ts now in
  settled (dependencies ps) (Z.to_nat (distance first (late_entry ps ts now) (nodes ps))) first.
Definition retimed (ps ts : list plan) (now : Z) : list plan := timed (earliest_entry ps ts now) ps.

(** An execution continues what has happened by the tick [now]: that is kept, and all else comes after it. *)
Record Continues (ts after : list plan) (now : Z) : Prop := {
  what_happened_is_kept : forall id n x, Visit_of ts id n x -> exists y, Visit_of after id n y /\ enter y = enter x;
  the_rest_is_later : forall id n y, Visit_of after id n y -> (exists x, Visit_of ts id n x) \/ now < enter y
}.

(** * Ticks that keep the edges make an execution *)

Section Lawful.
Variable s : solution.
Hypothesis well_formed : Well_formed i.
Hypothesis lawful : Lawful i s.
Notation ps := (plans s).
Notation Edge := (Edge i (plans s)).
Let one_plan_each : NoDup (map plan_robot ps) := planned_once i s lawful.
Let keeps_edges := execution_keeps_edges i s well_formed lawful.
Let known := visit_is_known i s lawful.
Let needed := needs_of i well_formed.

Lemma is_edge e : In e (dependencies ps) <-> Edge e.
Proof. exact (in_dependencies i ps one_plan_each e). Qed.

Lemma nth_timed t id vs : forall k n x, nth_error (timed_visits t id k vs) n = Some x ->
  exists v, nth_error vs n = Some v /\ visit_resource x = visit_resource v /\ enter x = t (id, (k + n)%nat) /\
  leave x = match nth_error vs (S n) with
            | Some _ => Some (t (id, (k + S n)%nat))
            | None => option_map (fun _ => enter x + needs id (visit_resource v)) (leave v)
            end.
Proof.
  induction vs as [|v vs IH]; intros k [|n] x X; try discriminate.
  - injection X as <-. exists v. rewrite Nat.add_0_r, Nat.add_succ_r, Nat.add_0_r. destruct vs; auto.
  - destruct (IH (S k) n x X) as (w & W & E & T & L). exists w. rewrite !Nat.add_succ_r in *. auto.
Qed.

Lemma timed_visit t id n x : Visit_of (timed t ps) id n x -> exists v,
  Visit_of ps id n v /\ visit_resource x = visit_resource v /\ enter x = t (id, n) /\
  ((exists w, Visit_of ps id (S n) w) /\ leave x = Some (t (id, S n)) \/
   (forall w, ~ Visit_of ps id (S n) w) /\
     leave x = option_map (fun _ => enter x + needs id (visit_resource v)) (leave v)).
Proof.
  intros (q & Q & E & X). apply in_map_iff in Q as (p & <- & P). simpl in E, X.
  destruct (nth_timed t _ _ _ _ _ X) as (v & V & F & T & L). rewrite E in *. cbn [Nat.add] in *. exists v.
  split; [exists p; auto|]. split; [exact F|]. split; [exact T|].
  rewrite L. destruct (nth_error (visits p) (S n)) as [w|] eqn:W; [left | right]; split; auto.
  - exists w, p. auto.
  - intros u (q & Q & G & U). assert (q = p) as -> by (apply (plan_of_robot_is_unique ps); congruence). congruence.
Qed.

Lemma visit_timed t id n v : Visit_of ps id n v -> exists x, Visit_of (timed t ps) id n x /\ enter x = t (id, n).
Proof.
  intros (p & P & E & V).
  assert (H : exists x, nth_error (timed_visits t id 0 (visits p)) n = Some x).
  { revert V. generalize 0%nat as k. generalize (visits p) as vs. induction n as [|n IH]; intros [|w vs] k V;
      try discriminate; simpl; eauto. }
  destruct H as (x & X). exists x.
  assert (Y : Visit_of (timed t ps) id n x).
  { exists (Plan id (timed_visits t id 0 (visits p))). repeat split; auto. apply in_map_iff. exists p. subst id. auto. }
  split; [exact Y|]. destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & T & _). exact T.
Qed.

Lemma robots_of_timed t : map plan_robot (timed t ps) = map plan_robot ps.
Proof. unfold timed. rewrite map_map. apply map_ext. reflexivity. Qed.

Theorem ticks_that_keep_the_edges_are_an_execution t : (forall e, Edge e -> Keeps t e) ->
  (forall a v, In a (robots i) -> Visit_of ps (robot_id a) 0 v -> release a <= t (robot_id a, 0%nat)) ->
  Executes ps (timed t ps).
Proof.
  intros K R. split.
  - rewrite robots_of_timed. exact one_plan_each.
  - rewrite robots_of_timed. tauto.
  - intros id n x X. destruct (timed_visit _ _ _ _ X) as (v & V & E & _). eauto.
  - intros a x A X. destruct (timed_visit _ _ _ _ X) as (v & V & _ & T & _). rewrite T. eauto.
  - intros id n x y X Y. destruct (timed_visit _ _ _ _ X) as (v & V & _ & _ & [[_ L]|[L _]]).
    + destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & T & _). congruence.
    + destruct (timed_visit _ _ _ _ Y) as (w & W & _). destruct (L w W).
  - intros id n x l X E. destruct (timed_visit _ _ _ _ X) as (v & V & _ & _ & [[(w & W) L]|[M L]]).
    + left. destruct (visit_timed t _ _ _ W) as (y & Y & _). eauto.
    + right. rewrite E in L. destruct (leave v) as [k|] eqn:D; [|discriminate].
      destruct (last_visit_ends i s lawful _ _ v k V D) as [(w & W)|H]; [destruct (M w W) | exact H].
  - intros a r n x l A I X E D. destruct (timed_visit _ _ _ _ X) as (v & V & F & T & [[(w & W) L]|[M L]]).
    + pose proof (K _ (Travel i ps (robot_id a, n) v w V W)) as G. unfold Keeps, next in G. simpl in G.
      rewrite <- F, E, needed in G by auto. rewrite L in D. injection D as <-. lia.
    + rewrite D in L. destruct (leave v); [|discriminate]. injection L as ->. rewrite <- F, E, needed by auto. lia.
  - intros one m v other n w y V W E B Y. destruct (visit_timed t _ _ _ V) as (x & X & T). exists x.
    split; [exact X|]. destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & U & _).
    destruct (timed_visit _ _ _ _ X) as (v0 & V0 & F & _ & [[(v' & V') L]|[M L]]).
    + exists (t (one, S m)). split; [exact L|].
      pose proof (K _ (Order_moving i ps (one, m) v v' (other, n) w V W E B V')) as G.
      unfold Keeps, next in G. simpl in G. unfold Law.gap in *.
      destruct (is_opposite _ _ _), (following_is_forbidden i); lia.
    + assert (v0 = v) as -> by eauto using visit_is_unique.
      pose proof (K _ (Order_ending i ps (one, m) v (other, n) w V W E B M)) as G. unfold Keeps in G. simpl in G.
      destruct B as (l & B & _). rewrite B in L. simpl in L. exists (enter x + needs one (visit_resource v)).
      split; [exact L | lia].
  - intros one m v v' other n w w' y V V' W' W E F L Y. destruct (visit_timed t _ _ _ V') as (x & X & T). exists x.
    split; [exact X|]. destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & U & _).
    assert (B : Left_before i v w).
    { exists (enter v'). split; [apply (leaves_as_it_moves i s lawful one m v v' V V')|].
      unfold Law.gap. destruct (following_is_forbidden i); lia. }
    pose proof (K _ (Order_moving i ps (one, m) v v' (other, S n) w V W E B V')) as G.
    assert (O : is_opposite ps (one, m) (other, S n) = true).
    { apply (is_opposite_iff ps one_plan_each). simpl. eauto 7. }
    unfold Keeps, next in G. simpl in G. rewrite O in G. lia.
Qed.

(** * The retimed plans *)

Section Retimed.
Variables (ts : list plan) (now : Z).
Hypothesis executed : Executes ps ts.
Hypothesis happened : Happened_by ts now.

Lemma release_of_robot a : In a (robots i) -> release_of (robot_id a) = release a.
Proof.
  intros A. unfold release_of. rewrite (found_by_id robot_id (robots i) a); auto.
  apply robot_ids_are_unique. exact well_formed.
Qed.

Lemma first_visit_is_at_release id v : Visit_of ps id 0 v -> enter v = release_of id.
Proof.
  intros V. destruct (known _ _ _ V) as (p & a & _ & P & E & F & A & G & L & _). subst id.
  rewrite <- G, release_of_robot by exact A. destruct (starts_at_release i a p L) as (w & rest & D & _ & R).
  rewrite D in F. injection F as ->. exact R.
Qed.

Lemma no_visit_is_before_its_release id n v : Visit_of ps id n v -> 0 <= release_of id <= enter v.
Proof.
  intros V. split.
  - destruct (known _ _ _ V) as (p & a & _ & _ & _ & _ & A & <- & _).
    rewrite release_of_robot by exact A. apply (releases_are_ticks i well_formed a A).
  - destruct n as [|n]; [rewrite (first_visit_is_at_release id v V); lia|].
    assert (H : exists u, Visit_of ps id 0 u).
    { clear - V. revert v V. induction n as [|n IH]; intros v V; apply visit_before in V as (w & W); eauto. }
    destruct H as (u & U). rewrite <- (first_visit_is_at_release id u U).
    pose proof (later_visits_are_later i s well_formed lawful id 0 (S n) u v U V (Nat.lt_0_succ n)). lia.
Qed.

Lemma edge_joins_visits e : Edge e -> (exists v, Visit_of ps (fst (earlier e)) (snd (earlier e)) v) /\
  exists w, Visit_of ps (fst (later e)) (snd (later e)) w.
Proof. intros [n v w V W|m v v' n w V W _ _ V'|m v n w V W _ _ _]; simpl; eauto. Qed.

Lemma wait_is_no_longer e : Edge e -> ticks e <= longest_wait ps.
Proof.
  intros E. apply is_edge in E. unfold longest_wait. induction (dependencies ps) as [|f l IH]; [destruct E|].
  simpl. destruct E as [<-|E]; [lia|]. specialize (IH E). lia.
Qed.

Lemma longest_wait_is_positive : 0 <= longest_wait ps.
Proof. unfold longest_wait. induction (dependencies ps); simpl; lia. Qed.

Lemma happened_at id n x : Visit_of ts id n x <-> visit_at ts (id, n) = Some x.
Proof. rewrite visit_at_iff; [tauto | exact (robots_are_named_once _ ps ts executed)]. Qed.

Lemma planned_at id n v : Visit_of ps id n v <-> visit_at ps (id, n) = Some v.
Proof. rewrite visit_at_iff; [tauto | exact one_plan_each]. Qed.

Lemma late_entries_are_no_earlier n : least_entry ts now n <= late_entry ps ts now n.
Proof.
  unfold late_entry. destruct n as [id n]. destruct (visit_at ts (id, n)) as [x|] eqn:X; [lia|].
  destruct (visit_at ps (id, n)) as [v|] eqn:V; [|lia]. unfold least_entry. rewrite X. simpl.
  apply planned_at, no_visit_is_before_its_release in V. pose proof longest_wait_is_positive. destruct n; lia.
Qed.

Lemma late_entries_keep_edges e : Edge e -> Keeps (late_entry ps ts now) e.
Proof.
  intros E. destruct (edge_joins_visits e E) as [(v & V) (w & W)]. unfold Keeps, late_entry, least_entry.
  pose proof (wait_is_no_longer e E) as L. pose proof longest_wait_is_positive as P.
  destruct (keeps_edges ps e w (lawful_solution_executes_itself i s well_formed lawful) E W) as (v0 & V0 & K).
  assert (v0 = v) as -> by eauto using visit_is_unique.
  pose proof (no_visit_is_before_its_release _ _ _ W).
  destruct (earlier e) as [a m] eqn:D, (later e) as [b n] eqn:F. simpl in V, W.
  rewrite (proj1 (planned_at _ _ _) V), (proj1 (planned_at _ _ _) W).
  destruct (visit_at ts (b, n)) as [y|] eqn:Y.
  - apply happened_at in Y. destruct (keeps_edges ts e y executed E) as (x & X & G); [rewrite F; exact Y|].
    rewrite D in X. simpl in X. rewrite (proj1 (happened_at _ _ _) X). lia.
  - destruct (visit_at ts (a, m)) as [x|] eqn:X; [|lia]. apply happened_at in X.
    destruct (happened a m x X) as [T _]. lia.
Qed.

Lemma edges_end_in_nodes e : In e (dependencies ps) -> In (later e) (nodes ps).
Proof. intros E. apply is_edge in E. apply in_nodes. apply (edge_joins_visits e E). Qed.

Lemma earliest_entries_keep_edges e : Edge e -> Keeps (earliest_entry ps ts now) e.
Proof.
  intros E. apply is_edge in E. unfold earliest_entry.
  apply settled_keeps_edges with (late_entry ps ts now) (nodes ps); auto using late_entries_are_no_earlier.
  - intros f F. split; [|apply edges_end_in_nodes; exact F]. apply late_entries_keep_edges, is_edge. exact F.
  - destruct (distance_is_positive (least_entry ts now) (late_entry ps ts now) (nodes ps)) as [D _];
      [exact late_entries_are_no_earlier | lia].
Qed.

Lemma earliest_entry_of_happened id n x : Visit_of ts id n x -> earliest_entry ps ts now (id, n) = enter x.
Proof.
  intros X. apply happened_at in X. apply Z.le_antisymm.
  - transitivity (late_entry ps ts now (id, n)).
    + apply settled_is_least; [|exact late_entries_are_no_earlier].
      intros e E. apply late_entries_keep_edges, is_edge. exact E.
    + unfold late_entry, least_entry. rewrite X. lia.
  - transitivity (least_entry ts now (id, n)); [unfold least_entry; rewrite X; lia | apply settled_is_no_earlier].
Qed.

Lemma earliest_entry_is_allowed n : least_entry ts now n <= earliest_entry ps ts now n.
Proof. apply settled_is_no_earlier. Qed.

Lemma retimed_plans_execute : Executes ps (retimed ps ts now).
Proof.
  apply ticks_that_keep_the_edges_are_an_execution; [exact earliest_entries_keep_edges|].
  intros a v A V. pose proof (earliest_entry_is_allowed (robot_id a, 0%nat)) as L. unfold least_entry in L. simpl in L.
  destruct (visit_at ts (robot_id a, 0%nat)) as [x|] eqn:X.
  - apply happened_at in X. pose proof (first_entry_is_late _ ps ts executed a x A X). lia.
  - rewrite release_of_robot in L by exact A. lia.
Qed.

Lemma retimed_plans_continue : Continues ts (retimed ps ts now) now.
Proof.
  split.
  - intros id n x X. destruct (visits_are_planned _ ps ts executed _ _ _ X) as (v & V & _).
    destruct (visit_timed (earliest_entry ps ts now) _ _ _ V) as (y & Y & T). exists y. split; [exact Y|].
    rewrite T. apply earliest_entry_of_happened. exact X.
  - intros id n y Y. destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & T & _). rewrite T.
    pose proof (earliest_entry_is_allowed (id, n)) as L. unfold least_entry in L. simpl in L.
    destruct (visit_at ts (id, n)) as [x|] eqn:X; [left; exists x; apply happened_at; exact X | right].
    destruct n; lia.
Qed.

Lemma retimed_plans_are_complete : Completes ps (retimed ps ts now).
Proof. intros id n v V. destruct (visit_timed (earliest_entry ps ts now) _ _ _ V) as (y & Y & _). eauto. Qed.

(** Another execution, finished or not, that continues what has happened. *)
Lemma retimed_is_least after id n y : Executes ps after -> Continues ts after now -> Visit_of after id n y ->
  earliest_entry ps ts now (id, n) <= enter y.
Proof.
  intros X C Y. set (t := earliest_entry ps ts now).
  set (other := fun n => match visit_at after n with Some y => Z.min (enter y) (t n) | None => t n end).
  assert (A : forall id n y, Visit_of after id n y <-> visit_at after (id, n) = Some y).
  { intros. rewrite visit_at_iff; [tauto | exact (robots_are_named_once _ ps after X)]. }
  assert (L : t (id, n) <= other (id, n)).
  { unfold t at 1, earliest_entry. apply settled_is_least.
    - intros e E. apply is_edge in E. pose proof (earliest_entries_keep_edges e E) as K. fold t in K.
      unfold Keeps, other in *. destruct (later e) as [b k] eqn:F. destruct (visit_at after (b, k)) as [w|] eqn:W.
      + apply A in W. destruct (keeps_edges after e w X E) as (v & V & G); [rewrite F; exact W|].
        destruct (earlier e) as [a m]. apply A in V. simpl in V. rewrite V. lia.
      + destruct (visit_at after (earlier e)); lia.
    - intros [a m]. pose proof (earliest_entry_is_allowed (a, m)) as L. fold t in L. unfold other.
      destruct (visit_at after (a, m)) as [w|] eqn:W; [|exact L]. apply Z.min_glb; [|exact L].
      apply A in W. unfold least_entry. simpl. destruct (visit_at ts (a, m)) as [x|] eqn:V.
      + apply happened_at in V. destruct (what_happened_is_kept _ _ _ C _ _ _ V) as (z & Z0 & E).
        rewrite (executed_once _ ps after X _ _ w z W Z0). lia.
      + destruct (the_rest_is_later _ _ _ C _ _ _ W) as [(x & H)|H]; [apply happened_at in H; congruence|].
        destruct m as [|m]; [|lia]. destruct (visits_are_planned _ ps after X _ _ _ W) as (v & U & _).
        destruct (known _ _ _ U) as (_ & r & _ & _ & _ & _ & R & <- & _).
        rewrite release_of_robot by exact R. pose proof (first_entry_is_late _ ps after X r w R W). lia. }
  unfold other in L. rewrite (proj1 (A _ _ _) Y) in L. fold t. lia.
Qed.
End Retimed.

(** The retimed plans keep the order and all that has happened; no execution that does so, whatever its delays, has a
    robot enter a visit earlier. *)
Theorem retime_is_earliest ts now : Executes ps ts -> Happened_by ts now ->
  let after := retimed ps ts now in
  Executes ps after /\ Completes ps after /\ Continues ts after now /\
  forall other, Executes ps other -> Continues ts other now ->
    forall id n y, Visit_of other id n y -> exists x, Visit_of after id n x /\ enter x <= enter y.
Proof.
  intros E H after. split; [|split; [|split]].
  - apply retimed_plans_execute; auto.
  - apply retimed_plans_are_complete.
  - apply retimed_plans_continue; auto.
  - intros other O C id n y Y. destruct (visits_are_planned _ _ _ O _ _ _ Y) as (v & V & _).
    destruct (visit_timed (earliest_entry ps ts now) _ _ _ V) as (x & V' & T).
    exists x. split; [exact V'|]. rewrite T. eapply retimed_is_least; eauto.
Qed.

(** * Executions that are solutions *)

Lemma last_of_timed t id front last : forall k, exists others,
  timed_visits t id k (front ++ [last]) = others ++ [Visit (visit_resource last) (t (id, (k + length front)%nat))
    (option_map (fun _ => t (id, (k + length front)%nat) + needs id (visit_resource last)) (leave last))].
Proof.
  induction front as [|v front IH]; intros k; simpl.
  - exists []. rewrite Nat.add_0_r. reflexivity.
  - destruct (IH (S k)) as (others & E). rewrite E. rewrite Nat.add_succ_r.
    destruct (front ++ [last]) as [|w rest] eqn:F; [destruct front; discriminate|].
    exists (Visit (visit_resource v) (t (id, k)) (Some (t (id, S k))) :: others). reflexivity.
Qed.

Lemma timed_plan_is_lawful t a p : Executes ps (timed t ps) -> In p (timed t ps) -> In a (robots i) ->
  robot_id a = plan_robot p -> Has_goal_alone a -> t (robot_id a, 0%nat) = release a -> Plan_lawful i a p.
Proof.
  intros X P A E O T. pose proof P as Q. apply in_map_iff in Q as (q & <- & Q). simpl in E.
  pose proof (plans_lawful i s lawful q a Q A E) as L. set (p := Plan _ _) in *.
  assert (V : forall n x, nth_error (visits p) n = Some x -> Visit_of (timed t ps) (robot_id a) n x /\
    exists v, nth_error (visits q) n = Some v /\ visit_resource x = visit_resource v).
  { intros n x N. split; [exists p; auto|]. destruct (nth_timed t _ _ _ _ _ N) as (v & V & F & _). eauto. }
  assert (stay_is_not_empty : forall r, In r (resources i) -> 0 <= least_stay a r).
  { intros r R. unfold least_stay. pose proof (paces_are_positive i well_formed a A).
    pose proof (durations_are_positive i well_formed r R). nia. }
  split.
  - destruct (starts_at_release i a q L) as (v & rest & D & S0 & _). unfold p. rewrite D.
    eexists. eexists. split; [reflexivity|]. simpl. rewrite <- E. auto.
  - destruct (ends_at_goal i a q L) as (front & last & D & G & B). unfold p, Ends_at_goal. rewrite D.
    destruct (last_of_timed t (plan_robot q) front last 0) as (others & ->). eexists. eexists.
    split; [reflexivity|]. simpl. split; [exact G|]. destruct (after_goal i); [|rewrite B; reflexivity].
    intros r R F. rewrite (B r R F), goal_alone_needs_its_duration by auto.
    simpl. rewrite G, <- F, <- E, needed by auto. reflexivity.
  - destruct (ends_at_goal i a q L) as (front & last & D & G & B). unfold p. simpl. rewrite D.
    destruct (last_of_timed t (plan_robot q) front last 0) as (others & ->). apply goal_alone_is_served; simpl; auto.
    destruct (leave last); simpl; auto. rewrite G, <- E.
    pose proof (goal_is_a_resource i a well_formed A) as K. apply in_map_iff in K as (r & K & R).
    rewrite <- K, needed by auto. pose proof (stay_is_not_empty r R). lia.
  - intros x N. apply In_nth_error in N as (n & N). destruct (V n x N) as (_ & v & W & ->).
    apply (visits_resources i a q L), (nth_error_In _ _ W).
  - intros x y C R S0. apply consecutive_by_number in C as (n & N & M).
    destruct (V n x N) as (_ & v & W & F), (V (S n) y M) as (_ & w & U & G). rewrite F, G in *.
    apply (follows_moves i a q L); auto. apply consecutive_by_number. eauto.
  - intros x y C. apply consecutive_by_number in C as (n & N & M).
    apply (visits_are_contiguous _ _ _ X (robot_id a) n); apply V; auto.
  - intros x r l N R F D. apply In_nth_error in N as (n & N).
    apply (durations_are_kept _ _ _ X a r n x l A R (proj1 (V n x N)) (eq_sym F) D).
Qed.

(** If each robot appears at its release, the retimed plans are a lawful solution, with the same room; without groups,
    and for robots with a goal alone. *)
Theorem retimed_solution_is_lawful ts now : groups i = [] -> (forall a, In a (robots i) -> Has_goal_alone a) ->
  Room_is_kept ps -> Executes ps ts -> Happened_by ts now ->
  let after := Solution (retimed ps ts now) (order s) (unplanned s) in
  (forall p a, In p (plans after) -> In a (robots i) -> robot_id a = plan_robot p -> Starts_at_release a p) ->
  Lawful i after /\ Room_is_kept (plans after).
Proof.
  intros N0 O K E H after R. pose proof (retimed_plans_execute ts now E H) as X.
  destruct (order_preserving_execution_is_safe i s (plans after) N0 lawful K X) as (F & C & D).
  assert (M : planned after = planned s) by apply robots_of_timed.
  split; [split; unfold Covers_robots, Orders_plans; rewrite ?M; simpl | exact F]; auto.
  - exact (covers_robots i s lawful).
  - exact (orders_plans i s lawful).
  - intros p a P A G. apply (timed_plan_is_lawful (earliest_entry ps ts now)); auto.
    destruct (R p a P A G) as (x & rest & N & _ & T). rewrite <- T.
    destruct (timed_visit (earliest_entry ps ts now) (robot_id a) 0 x) as (_ & _ & _ & U & _); [|auto].
    exists p. rewrite N. auto.
Qed.
End Lawful.
End Retiming.
