(** The plans that the query makes keep what the robot has done (fleet/history). *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context Past QueryCertificate.
From Carproof Require Import Query QuerySearch QuerySound.
Import ListNotations.
Open Scope Z_scope.

Lemma from_reversed {A} (l before : list A) x : rev l = x :: before -> l = rev before ++ [x].
Proof. intros E. rewrite <- (rev_involutive l), E. reflexivity. Qed.

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
Local Notation known := (lookup_of i).

(** * Histories of lawful plans *)

Lemma chain_history now later : forall v, Chain i a v later -> exists rest,
  v :: later = filter (fun w => enter w <=? now) (v :: later) ++ rest /\ forall w, In w rest -> now < enter w.
Proof.
  induction later as [|w rest IH]; intros v C.
  - simpl. destruct (Z.leb_spec (enter v) now); [exists [] | exists [v]]; split; auto.
    + intros w [].
    + intros w [<-|[]]. lia.
  - pose proof (chain_later i a well_formed of_instance v (w :: rest) C) as L. destruct C as (_ & _ & _ & C).
    destruct (IH w C) as (r & E & R).
    change (filter (fun x => enter x <=? now) (v :: w :: rest)) with
      (if enter v <=? now then v :: filter (fun x => enter x <=? now) (w :: rest)
       else filter (fun x => enter x <=? now) (w :: rest)).
    destruct (Z.leb_spec (enter v) now) as [V|V].
    + exists r. split; auto. exact (f_equal (cons v) E).
    + assert (A : forall x, In x (w :: rest) -> now < enter x).
      { intros x X. destruct (L x X) as (_ & _ & _ & H). lia. }
      exists (v :: w :: rest). split.
      * replace (filter (fun x => enter x <=? now) (w :: rest)) with (@nil visit); auto.
        destruct (filter (fun x => enter x <=? now) (w :: rest)) as [|x l] eqn:F; auto.
        assert (X : In x (filter (fun x => enter x <=? now) (w :: rest))) by (rewrite F; left; auto).
        apply filter_In in X as [X T]. specialize (A x X). lia.
      * intros x [<-|X]; auto.
Qed.

(** What a lawful plan has entered by now comes first in it. *)
Lemma history_comes_first p now : Plan_lawful i a p ->
  exists rest, visits p = history p now ++ rest /\ forall v, In v rest -> now < enter v.
Proof.
  intros L. apply lawful_plan_is_a_chain in L as (v & later & E & _ & _ & C). unfold history. rewrite E.
  apply chain_history. exact C.
Qed.

(** A plan that has ended keeps what it was. *)
Theorem ended_plan_keeps_itself p now : Plan_lawful i a p -> Has_ended p now -> Keeps_history p p now.
Proof.
  intros L H. destruct (history_comes_first p now L) as (rest & E & R). split.
  - intros n v N. exists v. repeat split; auto.
    + rewrite E. rewrite nth_error_app1; auto. apply nth_error_Some. congruence.
    + intros O. destruct (leave v) as [l|] eqn:M; simpl; auto.
      destruct (Z.leb_spec now l); auto. destruct O. exists l. split; auto. lia.
  - intros _. destruct H as (before & last & F & l & M & T).
    destruct rest as [|x rest] using rev_ind; [rewrite E, app_nil_r; apply le_n|]. exfalso. clear IHrest.
    rewrite E, app_assoc in F. apply app_inj_tail in F as [_ ->].
    assert (I : In last (visits p)) by (rewrite E; apply in_or_app; right; apply in_or_app; right; left; auto).
    apply (lawful_plan_is_a_course i a) in L as [C _].
    pose proof (stay_is_positive i a well_formed of_instance last l (stays _ _ _ C last I) M).
    specialize (R last ltac:(apply in_or_app; right; left; auto)). lia.
Qed.

(** * Robots under way *)

Variables (now : Z) (followed : option plan).
Hypothesis is_under_way : forall before, followed = Some before -> Plan_lawful i a before /\ ~ Has_ended before now.
Let s := standing_of known a now followed.

(** The visits go on from what the robot has done. *)
Definition Continues (vs : list visit) : Prop := exists current later, vs = past s ++ current :: later /\
  visit_resource current = place s /\ enter current = since s /\ No_earlier (leave current) now.

(** Whatever continues what the robot has done keeps it. *)
Theorem continued_past_is_kept made : Continues (visits made) -> Fits_the_past followed made now.
Proof.
  unfold Continues, s, standing_of. intros (current & later & E & R & T & N).
  destruct followed as [before|].
  2:{ simpl in *. intros first rest F. rewrite F in E. injection E as -> _. exact N. }
  destruct (is_under_way before eq_refl) as [L U]. split; [|tauto].
  destruct (rev (history before now)) as [|v earlier] eqn:H.
  - assert (G : history before now = []) by (rewrite <- (rev_involutive (history before now)), H; reflexivity).
    rewrite G. intros [|n] v; discriminate.
  - pose proof (from_reversed _ _ _ H) as G.
    simpl in E, R, T. rewrite E, G. intros n w W.
    destruct (Nat.ltb_spec n (length (rev earlier))) as [M|M].
    + rewrite nth_error_app1 in W |- * by exact M. exists w. repeat split; auto.
      intros O. destruct O. destruct (nth_error_split _ _ W) as (b & r & I & _). destruct r as [|x r].
      * apply (history_has_ended i a well_formed of_instance before now b w v [] L).
        rewrite G, I, <- app_assoc. reflexivity.
      * apply (history_has_ended i a well_formed of_instance before now b w x (r ++ [v]) L).
        rewrite G, I, <- app_assoc. reflexivity.
    + assert (K : n = length (rev earlier)).
      { assert (n < length (rev earlier ++ [v]))%nat by (apply nth_error_Some; congruence).
        rewrite app_length in *. simpl in *. lia. }
      subst n. rewrite nth_error_app2, Nat.sub_diag in W |- * by apply le_n. injection W as <-.
      exists current. repeat split; auto.
      intros O. destruct (current_has_not_ended i a before now _ _ L U G O).
Qed.

(** What the robot has done is the beginning of a lawful plan. *)
Theorem past_is_a_course : exists current, visit_resource current = place s /\ enter current = since s /\
  Course i a (past s ++ [current]).
Proof.
  assert (A : Course i a ([] ++ [Visit (start a) (release a) None])).
  { split.
    - exists (Visit (start a) (release a) None), []. auto.
    - intros v [<-|[]]. split; [exact (starts_are_resources i well_formed a of_instance) | discriminate].
    - intros v w V. destruct (not_adjacent_in_one _ _ _ V). }
  unfold s, standing_of. destruct followed as [before|]; [|exists (Visit (start a) (release a) None); auto].
  destruct (is_under_way before eq_refl) as [L _].
  destruct (rev (history before now)) as [|v earlier] eqn:H; [exists (Visit (start a) (release a) None); auto|].
  pose proof (from_reversed _ _ _ H) as G.
  exists v. split; [reflexivity|]. split; [reflexivity|]. simpl.
  destruct (history_comes_first before now L) as (rest & E & _). rewrite G in E.
  apply (lawful_plan_is_a_course i a) in L as [C _]. rewrite E in C. apply course_of_front in C; [exact C|].
  destruct (rev earlier); discriminate.
Qed.

Lemma continues_with_another_end b v w :
  Continues (b ++ [v]) -> Same_entry v w -> No_earlier (leave w) now -> Continues (b ++ [w]).
Proof.
  intros (x & later & E & R & T & N) [P Q] M. destruct later as [|y later] using rev_ind.
  - apply app_inj_tail in E as [-> ->]. exists w, []. repeat split; auto; congruence.
  - clear IHlater. exists x, (later ++ [w]). repeat split; auto.
    change (x :: later ++ [y]) with ((x :: later) ++ [y]) in E. rewrite app_assoc in E.
    apply app_inj_tail in E as [-> _]. rewrite <- app_assoc. reflexivity.
Qed.

Lemma continues_further vs later : Continues vs -> Continues (vs ++ later).
Proof. intros (x & rest & -> & H). exists x, (rest ++ later). rewrite <- app_assoc. auto. Qed.

(** * The labels of the search *)

Variable c : context.

(** The way to a label keeps what the robot has done. *)
Definition Kept (l : label) : Prop :=
  Continues (behind l ++ [visit_until l (Some (ready_from l))]) /\ now <= ready_from l.

Lemma moved_way_is_kept l e : Kept l -> Moved i known c a l e -> 0 <= least_stay a (target e) -> Kept e.
Proof.
  intros [C N] M P. pose proof (is_ready _ _ _ _ _ _ M). pose proof (stays_least _ _ _ _ _ _ M). split; [|lia].
  rewrite (comes_from _ _ _ _ _ _ M). apply continues_further.
  eapply continues_with_another_end; [exact C | split; reflexivity | simpl; lia].
Qed.

(** A plan that ends with a label keeps what the robot has done. *)
Theorem history_is_kept l : Kept l -> can_end i a now l = true -> Fits_the_past followed (plan_of i a l) now.
Proof.
  intros [C N] E. apply continued_past_is_kept. unfold plan_of. simpl.
  eapply continues_with_another_end; [exact C | split; reflexivity|].
  unfold can_end in E. apply andb_true_iff in E as [_ E]. destruct (after_goal i); simpl; auto. lia.
Qed.

Lemma start_is_kept from : start_label known c s = Some from -> Kept from /\ Right_way i a c from.
Proof.
  unfold start_label. destruct (Map.find (place s) (resource_of known)) as [r|] eqn:F; [|discriminate].
  apply (find_resource i well_formed) in F as [R E].
  destruct (allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))])) eqn:A; [|discriminate].
  destruct (find _ (windows_in c r)) as [w|] eqn:W; [|discriminate]. apply find_some in W as [W H].
  intros D. injection D as <-. pose proof (standing_is_ready i a now followed) as T. cbv zeta in T. fold s in T.
  rewrite <- E, (least_ticks_of i well_formed a r R) in T.
  set (from := Label r w (since s) (ready s) (past s)).
  assert (V : visit_until from (Some (ready s)) = Visit (place s) (since s) (Some (ready s))).
  { unfold visit_until. simpl. rewrite E. reflexivity. }
  assert (S : Stay_lawful i a (visit_until from (Some (ready s)))).
  { apply (stay_lawful_iff i a well_formed); simpl; [exact R | lia]. }
  split; [split; simpl; [|lia]|split; simpl; auto; [| | lia]]; rewrite ?V in *.
  - exists (Visit (place s) (since s) (Some (ready s))), []. repeat split; auto. simpl. lia.
  - destruct past_is_a_course as (v & X & Y & C). eapply course_with_another_end; [exact C | split; auto | exact S].
  - apply (allows_iff i); auto.
Qed.
End Robot.
