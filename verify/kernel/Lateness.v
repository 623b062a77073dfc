(** How late robots are that keep the order of lawful plans: never by more ticks than all delays have together.

    The function is there for its proof: it is no faster than it must be to be right. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Execution Dependencies Order Waiting Retiming.
Import ListNotations.
Open Scope Z_scope.

Section Lateness.
Variable i : instance.
Notation Executes := (Executes i).
Notation dependencies := (dependencies i).

(** The robot needs that number of ticks more for the visit than the duration. *)
Definition delays := node -> Z.

(** Who waits for the robot to have stayed somewhere waits for its delay there too. *)
Definition delayed (late : delays) (e : dependency) : dependency :=
  Dependency (earlier e) (later e) (ticks e + if by_staying e then late (earlier e) else 0) (by_staying e).

Definition release_entry : times := fun n => match snd n with O => release_of i (fst n) | S _ => 0 end.

(** The delays at all visits that are entered, by the plans, before the tick. *)
Definition delay_before (ps : list plan) (late : delays) (tick : Z) : Z :=
  fold_right (fun n sum => (if enter (snd n) <? tick then late (fst n) else 0) + sum) 0 (stays ps).
Definition total_delay (ps : list plan) (late : delays) : Z :=
  fold_right (fun n sum => late (fst n) + sum) 0 (stays ps).

Definition latest_entry (ps : list plan) (late : delays) : times := fun n =>
  match visit_at ps n with Some v => enter v + delay_before ps late (enter v) | None => release_entry n end.

(** The entry of each visit if every robot continues as soon as the edges and its delays allow. *)
Definition entry_in_order (ps : list plan) (late : delays) : times :=
  settled (map (delayed late) (dependencies ps))
    (Z.to_nat (distance release_entry (latest_entry ps late) (nodes ps))) release_entry.

Section Lawful.
Variable s : solution.
Hypothesis well_formed : Well_formed i.
Hypothesis lawful : Lawful i s.
Notation ps := (plans s).
Let one_plan_each : NoDup (map plan_robot ps) := planned_once i s lawful.

Variable late : delays.
Hypothesis delays_are_positive : forall n, 0 <= late n.

Lemma delay_grows one other : one <= other -> delay_before ps late one <= delay_before ps late other /\
  forall n, In n (stays ps) -> one <= enter (snd n) < other ->
  delay_before ps late one + late (fst n) <= delay_before ps late other.
Proof.
  intros L. unfold delay_before. induction (stays ps) as [|m l [IH IK]]; simpl; [split; [lia | tauto]|].
  pose proof (delays_are_positive (fst m)). split.
  - destruct (Z.ltb_spec (enter (snd m)) one), (Z.ltb_spec (enter (snd m)) other); lia.
  - intros n [->|N] T.
    + destruct (Z.ltb_spec (enter (snd n)) one), (Z.ltb_spec (enter (snd n)) other); lia.
    + specialize (IK n N T). destruct (Z.ltb_spec (enter (snd m)) one), (Z.ltb_spec (enter (snd m)) other); lia.
Qed.

Lemma delay_is_part_of_total tick : 0 <= delay_before ps late tick <= total_delay ps late.
Proof.
  unfold delay_before, total_delay. induction (stays ps) as [|m l IH]; simpl; [lia|].
  pose proof (delays_are_positive (fst m)). destruct (enter (snd m) <? tick); lia.
Qed.

Lemma staying_takes_time e : Edge i ps e -> by_staying e = true -> 1 <= ticks e.
Proof.
  pose proof (needs_are_positive i s well_formed lawful) as P.
  intros [n v w V W|m v v' n w V W _ _ V'|m v n w V W _ _ _]; simpl; [|discriminate|]; intros _.
  - exact (P _ _ _ V).
  - specialize (P _ _ _ V). unfold Law.gap. destruct (following_is_forbidden i); lia.
Qed.

Lemma latest_entries_keep_edges e : In e (dependencies ps) -> Keeps (latest_entry ps late) (delayed late e).
Proof.
  intros E. pose proof (edges_join_nodes i s lawful e E) as [M N].
  rewrite in_nodes in M, N. destruct M as (v & V), N as (w & W).
  apply (in_dependencies i ps one_plan_each) in E.
  destruct (execution_keeps_edges i s well_formed lawful ps e w) as (v0 & V0 & K);
    [apply lawful_solution_executes_itself; auto | exact E | exact W |].
  assert (v0 = v) as -> by eauto using visit_is_unique. unfold Keeps, delayed, latest_entry. simpl.
  rewrite (proj2 (visit_at_iff ps (earlier e) v one_plan_each) V).
  rewrite (proj2 (visit_at_iff ps (later e) w one_plan_each) W).
  destruct (edges_take_time i s well_formed lawful e E) as [P _].
  destruct (delay_grows (enter v) (enter w)) as [D G]; [lia|].
  destruct (by_staying e) eqn:B; [|lia]. pose proof (staying_takes_time e E B).
  specialize (G (earlier e, v)). simpl in G. specialize (G (proj2 (in_stays ps (earlier e) v) V)). lia.
Qed.

Lemma latest_entries_are_allowed n : release_entry n <= latest_entry ps late n.
Proof.
  unfold latest_entry. destruct (visit_at ps n) as [v|] eqn:V; [|lia]. apply (visit_at_iff ps n v one_plan_each) in V.
  pose proof (no_visit_is_before_its_release i s well_formed lawful _ _ v V).
  pose proof (delay_is_part_of_total (enter v)). unfold release_entry. destruct (snd n); lia.
Qed.

(** Robots that go on as soon as their dependencies and delays allow keep the order, and none of them enters a visit
    later than planned by more than the sum of all delays. *)
Theorem lateness_is_at_most_the_delays :
  (forall e, In e (dependencies ps) -> Keeps (entry_in_order ps late) (delayed late e)) /\
  (forall t, (forall e, In e (dependencies ps) -> Keeps t (delayed late e)) -> (forall n, release_entry n <= t n) ->
    forall n, entry_in_order ps late n <= t n) /\
  Executes ps (timed i (entry_in_order ps late) ps) /\
  forall id n v, Visit_of ps id n v -> entry_in_order ps late (id, n) <= enter v + total_delay ps late.
Proof.
  set (t := entry_in_order ps late). assert (K : forall e, In e (dependencies ps) -> Keeps t (delayed late e)).
  { intros e E. apply settled_keeps_edges with (latest_entry ps late) (nodes ps).
    - intros f F. apply in_map_iff in F as (g & <- & G). split; [apply latest_entries_keep_edges, G|].
      apply (edges_join_nodes i s lawful g G).
    - exact latest_entries_are_allowed.
    - destruct (distance_is_positive release_entry (latest_entry ps late) (nodes ps)) as [D _];
        [exact latest_entries_are_allowed | lia].
    - apply in_map. exact E. }
  split; [exact K|]. split; [|split].
  - intros other L R n. apply settled_is_least; [|exact R]. intros e E. apply in_map_iff in E as (f & <- & F). auto.
  - apply (ticks_that_keep_the_edges_are_an_execution i s well_formed lawful).
    + intros e E. apply (in_dependencies i ps one_plan_each) in E. specialize (K e E).
      unfold Keeps, delayed in *. simpl in K. pose proof (delays_are_positive (earlier e)).
      destruct (by_staying e); lia.
    + intros a v A _. rewrite <- (release_of_robot i well_formed a A).
      apply (settled_is_no_earlier (map (delayed late) (dependencies ps)) _ release_entry (robot_id a, 0%nat)).
  - intros id n v V. transitivity (latest_entry ps late (id, n)).
    + apply settled_is_least; [|exact latest_entries_are_allowed].
      intros e E. apply in_map_iff in E as (f & <- & F). apply latest_entries_keep_edges, F.
    + unfold latest_entry. rewrite (proj2 (visit_at_iff ps (id, n) v one_plan_each) V).
      pose proof (delay_is_part_of_total (enter v)). lia.
Qed.
End Lawful.
End Lateness.
