(** The query is right: its plan is sound, none arrives earlier, and it finds a plan wherever one exists. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops Collections Timeline Journey Checker Windows Context Past QueryCertificate.
From Carproof Require Import Query QuerySearch QuerySound QueryHistory.
Import ListNotations.
Open Scope Z_scope.

(** * Windows *)

(** Two maximal intervals that share a tick are one. *)
Theorem free_windows_are_unique P v w tick :
  Maximal P v -> Maximal P w -> In_window v tick -> In_window w tick -> v = w.
Proof.
  intros [_ I B A] [_ J C D] [O U] [Q V]. destruct v as [o c], w as [q d]. simpl in *.
  assert (o = q).
  { destruct (Z.lt_trichotomy o q) as [H|[H|H]]; auto.
    - destruct C. apply I. split; simpl; [lia|]. destruct c; simpl in *; auto. lia.
    - destruct B. apply J. split; simpl; [lia|]. destruct d; simpl in *; auto. lia. }
  subst q. f_equal. destruct c as [c|], d as [d|]; auto; simpl in *.
  - destruct (Z.lt_trichotomy c d) as [H|[H|H]]; [|congruence|].
    + destruct (A c eq_refl). apply J. split; simpl; lia.
    + destruct (D d eq_refl). apply I. split; simpl; lia.
  - destruct (A c eq_refl). apply J. split; simpl; [lia | exact Logic.I].
  - destruct (D d eq_refl). apply I. split; simpl; [lia | exact Logic.I].
Qed.

Section Robot.
Variables (i : instance) (a : robot) (committed : list plan) (c : context) (now : Z).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
Hypothesis goes_to_a_goal : Has_goal_alone a.
Hypothesis others : Committed i a committed.
Hypothesis represents : Represents i c committed.
Local Notation known := (lookup_of i).
Local Notation labels := (Query.labels i known c a).

(** * Dominance *)

(** The label concerns the window that the visit is in, entered no later, and left no later if the robot wants. *)
Record Dominates (l : label) (v : visit) : Prop := {
  same_place : In (target l) (resources i) /\ resource_id (target l) = visit_resource v;
  same_room : holds_stay (room l) (enter v) (leave v) = true;
  no_later : entry l <= enter v;
  ready_in_time : No_earlier (leave v) (ready_from l);
  not_over : now <= entry l \/ entry l = enter v /\ now <= ready_from l
}.

Lemma dominating_label_can_end l v : Dominates l v -> Ends i a v -> can_end i a now l = true.
Proof.
  intros [[R E] H T L N] [G F]. unfold can_end. rewrite E, G, Z.eqb_refl. simpl.
  destruct (after_goal i); [|rewrite F in H; apply andb_true_iff in H; apply H].
  pose proof (least_stay_is_positive i a well_formed of_instance _ R).
  rewrite (F (target l) R ltac:(congruence)), goal_alone_needs_its_duration in L by (auto; lia). simpl in L. lia.
Qed.

Section From_start.
Variable from : label.
Hypothesis started : now <= ready_from from.

Lemma reached_label_is_ready_later l : Reached i known c a from l -> ready_from from <= ready_from l.
Proof.
  induction 1 as [|l e _ IH M]; [lia|]. pose proof (is_ready _ _ _ _ _ _ M). rewrite (stays_least _ _ _ _ _ _ M).
  pose proof (least_stay_is_positive i a well_formed of_instance _ (has_resource _ _ _ _ _ _ M)). lia.
Qed.

Lemma dominance_goes_on l v w : In l (labels from) -> Dominates l v ->
  leave v = Some (enter w) -> Move i (visit_resource v) (visit_resource w) ->
  is_exchange known c (visit_resource v) (visit_resource w) (enter w) = false -> Stay_lawful i a w -> Has_room i c w ->
  exists again, In again (labels from) /\ Dominates again w.
Proof.
  intros L [[R E] H T Y _] Z M X S (r & room & Q & F & W & I). rewrite Z in *.
  assert (D : holds_stay room (enter w) (Some (enter w + least_stay a r)) = true).
  { unfold holds_stay, lasts in *. apply andb_true_iff in I as [-> I]. simpl. destruct (closes room); auto.
    destruct (leave w) as [out|] eqn:O; [|discriminate]. destruct S as [_ S]. specialize (S r out Q F O). lia. }
  destruct (allowed_entry_is_found i known c a l r room (enter w)) as (e & G & J & K & N); auto.
  - rewrite E, F. apply (has_move_iff i). exact M.
  - rewrite E, F. exact X.
  - apply andb_true_iff in H. apply H.
  - destruct (labels_are_closed i known c a (least_stay_is_positive i a well_formed of_instance) from l e L G)
      as (again & A & (before & B & P) & C & U).
    unfold cell in C. rewrite J, K in C. injection C as C V. pose proof (has_resource _ _ _ _ _ _ P) as O.
    assert (G' : target again = r) by (apply (resource_is_unique i well_formed); auto).
    pose proof (stays_least _ _ _ _ _ _ P) as Ra. rewrite G' in Ra.
    exists again. split; auto. split; rewrite ?G'; auto.
    + rewrite V. exact I.
    + lia.
    + destruct (leave w) as [out|] eqn:O'; simpl; auto. destruct S as [_ S]. specialize (S r out Q F O'). lia.
    + left. pose proof (reached_label_is_ready_later before B). pose proof (is_ready _ _ _ _ _ _ P). lia.
Qed.

(** Wherever a robot can go after a later entry into a window, it can go after an earlier one: from a label that
    dominates a visit, the search finds a label to end with, entered no later than the last visit. *)
Theorem earliest_entry_dominates later : forall v l, In l (labels from) -> Dominates l v -> Chain i a v later ->
  Free i c (v :: later) ->
  exists last, In last (labels from) /\ can_end i a now last = true /\ entry last <= last_entry v later.
Proof.
  induction later as [|w rest IH]; intros v l L D C F.
  - exists l. split; auto. split; [exact (dominating_label_can_end l v D (proj2 C)) | exact (no_later l v D)].
  - destruct C as (_ & T & M & C). destruct F as [R X].
    destruct (dominance_goes_on l v w L D T M) as (again & A & E).
    + apply X. exists [], rest. reflexivity.
    + apply (chain_lawful i a w rest C). left. auto.
    + apply R. right. left. auto.
    + apply (IH w again A E C). split; [intros x Y; apply R; right; exact Y|].
      intros x y Y. apply X. apply consecutive_cons. auto.
Qed.
End From_start.

(** * The plan of least arrival *)

Variable followed : option plan.
Hypothesis is_under_way : forall before, followed = Some before -> Plan_lawful i a before /\ ~ Has_ended before now.
Let s := standing_of known a now followed.

Lemma sound_plan_is_free p : Sound i a committed p -> Free i c (visits p).
Proof.
  intros S. apply (allows_iff i); auto.
  apply (sound_visits_are_allowed i well_formed a committed c of_instance others represents p S).
  exists [], []. rewrite app_nil_r. reflexivity.
Qed.

(** If the robot has a sound plan, the search starts, and its first label dominates where the robot is in the plan. *)
Lemma start_dominates p : Sound i a committed p -> Fits_the_past followed p now ->
  exists from current later b, start_label known c s = Some from /\ Dominates from current /\ now <= ready_from from /\
  visits p = b ++ current :: later.
Proof.
  intros S F. pose proof (is_lawful _ _ _ _ S) as L.
  destruct (plan_begins_with_the_past i a well_formed of_instance followed p now is_under_way L F)
    as (current & later & V & P & T & N). fold s in V, P, T.
  pose proof (standing_is_ready i a now followed) as Y. cbv zeta in Y. fold s in Y.
  assert (A : allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))]) = true).
  { apply not_false_iff_true. exact (start_is_allowed i well_formed a committed c p s current later now
      of_instance others represents S V P T N Y). }
  assert (I : In current (visits p)) by (rewrite V; apply in_or_app; right; left; auto).
  destruct (has_room _ _ _ (sound_plan_is_free p S) current I) as (r & w & R & E & W & H).
  rewrite <- P, <- E, (least_ticks_of i well_formed a r R) in Y.
  assert (B : No_earlier (leave current) (ready s)).
  { destruct (leave current) as [l|] eqn:M; simpl in *; auto.
    pose proof (respects_durations _ _ _ L current r l I R E M). lia. }
  pose proof (least_stay_is_positive i a well_formed of_instance r R).
  assert (K : holds_stay w (since s) (Some (ready s)) = true).
  { unfold holds_stay, lasts in *. rewrite T in H. apply andb_true_iff in H as [-> H]. simpl.
    destruct (closes w); auto. destruct (leave current); [simpl in B; lia | discriminate]. }
  unfold start_label. rewrite (proj2 (find_resource i well_formed (place s) r)) by (split; congruence). rewrite A.
  destruct (find (fun w => holds_stay w (since s) (Some (ready s))) (windows_in c r)) as [x|] eqn:X.
  2:{ rewrite (find_none _ _ X w W) in K. discriminate. }
  apply find_some in X as [X J].
  assert (U : x = w).
  { rewrite (has_windows _ _ _ represents r) in X, W.
    apply (free_windows_are_maximal i committed well_formed (are_of_robots _ _ _ others) (are_lawful _ _ _ others)
      (are_distinct _ _ _ others) r _ R) in X, W.
    unfold holds_stay, lasts in J, K. apply andb_true_iff in J as [J J'], K as [K K'].
    apply (free_windows_are_unique _ x w (since s) X W); split; try lia.
    - destruct (closes x); simpl; auto. lia.
    - destruct (closes w); simpl; auto. lia. }
  subst x. eexists. exists current, later, (past s). split; [reflexivity|]. split; [|split; [simpl; lia | exact V]].
  split; simpl; auto; [lia|]. right. lia.
Qed.

(** query/optimal: no sound plan that keeps what the robot has done arrives earlier. *)
Lemma plan_from_is_least p : Sound i a committed p -> Fits_the_past followed p now ->
  exists made, plan_from i known c a now s = Some made /\ arrival (release a) made <= arrival (release a) p.
Proof.
  intros S F. destruct (start_dominates p S F) as (from & current & later & b & E & D & N & V).
  assert (C : Chain i a current later).
  { pose proof (is_lawful _ _ _ _ S) as L. apply lawful_plan_is_a_chain in L as (u & rest & G & _ & _ & C).
    rewrite G in V. exact (chain_behind i a b u rest current later C V). }
  assert (Fr : Free i c (current :: later)).
  { destruct (sound_plan_is_free p S) as [H X]. rewrite V in *. split.
    - intros v I. apply H. apply in_or_app. auto.
    - intros v w (x & y & I). apply X. exists (b ++ x), y. rewrite I, app_assoc. reflexivity. }
  destruct (earliest_entry_dominates from N later current from (or_introl eq_refl) D C Fr) as (last & L & Q & T).
  unfold plan_from. rewrite E. pose proof (earliest_is_least (filter (can_end i a now) (labels from))) as M.
  assert (I : In last (filter (can_end i a now) (labels from))) by (apply filter_In; auto).
  destruct (earliest (filter (can_end i a now) (labels from))) as [l|]; [|rewrite M in I; destruct I].
  exists (plan_of i a l). split; auto. destruct M as [_ M]. specialize (M last I).
  rewrite (arrival_behind _ _ _ _ _ V). unfold plan_of, arrival. simpl. rewrite fold_left_app. simpl. lia.
Qed.

Hypothesis limits_are_kept : Limits_are_kept i committed.
Hypothesis exchanges_are_avoided : Exchanges_are_avoided i committed.

(** query/sound: the plan breaks no rule, alone or with the committed plans, and keeps what the robot has done. *)
Lemma plan_from_is_sound made : plan_from i known c a now s = Some made ->
  Sound i a committed made /\ Fits_the_past followed made now.
Proof.
  unfold plan_from. destruct (start_label known c s) as [from|] eqn:E; [|discriminate].
  pose proof (earliest_is_least (filter (can_end i a now) (labels from))) as M.
  destruct (earliest (filter (can_end i a now) (labels from))) as [l|]; [|discriminate].
  intros F. injection F as <-. destruct M as [M _]. apply filter_In in M as [L Q].
  destruct (start_is_kept i a well_formed of_instance now followed is_under_way c from E) as [K R].
  assert (W : forall l, Reached i known c a from l -> Kept i a now followed l /\ Right_way i a c l).
  { induction 1 as [|x e _ [Kx Rx] Me]; [auto|]. split.
    - apply (moved_way_is_kept i a now followed c x e Kx Me).
      pose proof (least_stay_is_positive i a well_formed of_instance _ (has_resource _ _ _ _ _ _ Me)). lia.
    - exact (moved_way_is_right i a well_formed c x e Rx Me). }
  destruct (W l) as [Kl Rl].
  { apply (labels_are_reached i known c a (least_stay_is_positive i a well_formed of_instance)) in L as [->|L];
      [constructor | exact (entered_is_reached i known c a from l L)]. }
  split.
  - exact (right_way_is_sound i a well_formed of_instance c committed others represents limits_are_kept exchanges_are_avoided
      now l goes_to_a_goal Rl Q).
  - exact (history_is_kept i a well_formed of_instance now followed is_under_way l Kl Q).
Qed.
End Robot.

(** * The theorems *)

Section Query.
Variables (i : instance) (a : robot) (committed : list plan) (now : Z) (followed : option plan).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
(** The search knows no stops. *)
Hypothesis goes_to_a_goal : Has_goal_alone a.
(** The committed plans are lawful plans of other robots, alone and together. *)
Hypothesis others : Committed i a committed.
Hypothesis limits_are_kept : Limits_are_kept i committed.
Hypothesis exchanges_are_avoided : Exchanges_are_avoided i committed.
(** What the robot has followed until now, if anything, is a lawful plan of it. *)
Hypothesis followed_is_lawful : forall p, followed = Some p -> plan_robot p = robot_id a /\ Plan_lawful i a p.

Local Notation known := (lookup_of i).
Local Notation c := (context_of known committed).

(** The plan keeps all rules, alone and together with the committed plans, and what the robot has done by now. *)
Definition Right_plan (p : plan) : Prop := Sound i a committed p /\ Fits_the_past followed p now.

Lemma under_way : (forall p, followed = Some p -> has_ended p now = false) ->
  query i committed a now followed = plan_from i known c a now (standing_of known a now followed) /\
  (forall before, followed = Some before -> Plan_lawful i a before /\ ~ Has_ended before now).
Proof.
  intros N. split.
  - unfold query, query_in_context. destruct followed as [p|]; auto. rewrite (N p eq_refl). reflexivity.
  - intros p E. split; [apply (followed_is_lawful p E)|]. rewrite <- has_ended_iff, (N p E). discriminate.
Qed.

Lemma ended_or_under_way :
  (exists p, followed = Some p /\ has_ended p now = true) \/ (forall p, followed = Some p -> has_ended p now = false).
Proof.
  destruct followed as [p|]; [|right; discriminate]. destruct (has_ended p now) eqn:E; [left; eauto|].
  right. intros q F. injection F as <-. exact E.
Qed.

(** A right plan of a robot whose plan has ended is that plan, and the query returns it. *)
Lemma ended_plan_is_returned p made : followed = Some p -> has_ended p now = true -> Right_plan made ->
  visits made = visits p /\ query i committed a now followed = Some p.
Proof.
  intros E H [S F]. destruct (followed_is_lawful p E) as [_ L]. rewrite E in F.
  assert (V : visits made = visits p).
  { apply (ended_plan_is_unchanged i a well_formed of_instance p made now L); [|exact F].
    apply has_ended_iff. exact H. }
  split; auto. unfold query, query_in_context. rewrite E, H.
  rewrite (sound_visits_are_allowed i well_formed a committed c of_instance others
    (context_of_represents i well_formed committed) made S); auto.
  exists [], []. rewrite app_nil_r. exact V.
Qed.

(** query/sound and query/optimal. *)
Theorem query_returns_a_sound_plan_of_least_arrival made : query i committed a now followed = Some made ->
  Right_plan made /\ forall rival, Right_plan rival -> arrival (release a) made <= arrival (release a) rival.
Proof.
  intros Q. pose proof (context_of_represents i well_formed committed) as R.
  destruct ended_or_under_way as [(p & E & H)|H].
  - assert (M : p = made /\ allows known c (visits p) = true).
    { unfold query, query_in_context in Q. rewrite E, H in Q.
      destruct (allows known c (visits p)); [injection Q; auto | discriminate]. }
    destruct M as [<- A]. destruct (followed_is_lawful p E) as [I L]. split.
    + split.
      * apply (free_plan_is_sound i a well_formed of_instance c committed others R limits_are_kept exchanges_are_avoided p I L).
        apply (allows_iff i well_formed). exact A.
      * rewrite E. apply (ended_plan_keeps_itself i a well_formed of_instance p now L). apply has_ended_iff. exact H.
    + intros rival X. destruct (ended_plan_is_returned p rival E H X) as [V _]. unfold arrival. rewrite V. lia.
  - destruct (under_way H) as [-> U] in Q. split.
    + exact (plan_from_is_sound i a committed c now well_formed of_instance goes_to_a_goal others R followed U
        limits_are_kept exchanges_are_avoided made Q).
    + intros rival [S F].
      destruct (plan_from_is_least i a committed c now well_formed of_instance goes_to_a_goal others R followed U rival S F)
        as (best & B & T).
      rewrite B in Q. injection Q as <-. exact T.
Qed.

(** query/complete. *)
Theorem query_returns_none_only_if_there_is_none : query i committed a now followed = None -> forall p, ~ Right_plan p.
Proof.
  intros Q p X. pose proof (context_of_represents i well_formed committed) as R.
  destruct ended_or_under_way as [(before & E & H)|H].
  - destruct (ended_plan_is_returned before p E H X) as [_ K]. congruence.
  - destruct (under_way H) as [K U]. destruct X as [S F].
    destruct (plan_from_is_least i a committed c now well_formed of_instance goes_to_a_goal others R followed U p S F)
      as (best & B & _).
    congruence.
Qed.
End Query.
