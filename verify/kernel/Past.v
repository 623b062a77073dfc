(** What a robot has done by the tick at which it is planned (fleet/history), and where its plan begins. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context.
Import ListNotations.
Open Scope Z_scope.

(** Where a robot is: [past] are the visits that it has made; it has been in [place] since the tick [since], and may
    leave it at [ready] at the earliest. *)
Record standing := Standing { past : list visit; place : Z; since : Z; ready : Z }.

(** The robot has left the system by the tick [now]. *)
Definition has_ended (p : plan) (now : Z) : bool :=
  match rev (visits p) with
  | last :: _ => match leave last with Some l => l <=? now | None => false end
  | [] => false
  end.

(** The least ticks that the robot needs in the resource of an id; 0 in one that the graph does not have. *)
Definition least_ticks (known : lookup) (a : robot) (id : Z) : Z :=
  match Map.find id (resource_of known) with Some r => least_stay a r | None => 0 end.

(** A robot has done what it has entered by [now]; without a plan it stands at its start from its release on. *)
Definition standing_of (known : lookup) (a : robot) (now : Z) (followed : option plan) : standing :=
  let entered := match followed with Some before => history before now | None => [] end in
  let at_ past place since := Standing past place since (Z.max (since + least_ticks known a place) now) in
  match rev entered with
  | [] => at_ [] (start a) (release a)
  | current :: before => at_ (rev before) (visit_resource current) (enter current)
  end.

Lemma has_ended_iff p now : has_ended p now = true <-> Has_ended p now.
Proof.
  unfold has_ended, Has_ended, Ended. destruct (rev (visits p)) as [|last before] eqn:E.
  - split; [discriminate|]. intros (before & last & F & _). rewrite F, rev_app_distr in E. discriminate.
  - assert (F : visits p = rev before ++ [last]) by (rewrite <- (rev_involutive (visits p)), E; reflexivity).
    rewrite F. split.
    + intros H. exists (rev before), last. split; auto. destruct (leave last) as [l|]; [|discriminate].
      exists l. split; auto. lia.
    + intros (b & x & G & l & L & T). apply app_inj_tail in G as [_ <-]. rewrite L. lia.
Qed.

Lemma filter_split {A} (f : A -> bool) l : forall x v y, filter f l = x ++ v :: y ->
  exists b r, l = b ++ v :: r /\ y = filter f r.
Proof.
  induction l as [|u l IH]; intros x v y E; simpl in E; [destruct x; discriminate|].
  destruct (f u).
  - destruct x as [|z x]; simpl in E; injection E; intros F G.
    + subst. exists [], l. auto.
    + destruct (IH x v y F) as (b & r & -> & H). exists (u :: b), r. auto.
  - destruct (IH x v y E) as (b & r & -> & H). exists (u :: b), r. auto.
Qed.

Lemma prefix_of_nth {A} (l : list A) : forall m, (forall n v, nth_error l n = Some v -> nth_error m n = Some v) ->
  exists r, m = l ++ r.
Proof.
  induction l as [|x l IH]; intros m H; [exists m; auto|].
  destruct m as [|y m]; [specialize (H O x eq_refl); discriminate|].
  pose proof (H O x eq_refl) as E. injection E as ->. destruct (IH m) as (r & ->); [|exists r; auto].
  intros n v N. exact (H (S n) v N).
Qed.


Section Robot.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
Local Notation known := (lookup_of i).

Lemma chain_behind b : forall u later v l, Chain i a u later -> u :: later = b ++ v :: l -> Chain i a v l.
Proof.
  induction b as [|x b IH]; intros u later v l C E; injection E as -> ->; [exact C|].
  destruct b as [|y b]; simpl in *; destruct C as (_ & _ & _ & C); [exact C|]. eapply IH; [exact C | reflexivity].
Qed.

(** Visits that another one follows in the history have ended. *)
Lemma history_has_ended before now earlier v w later : Plan_lawful i a before ->
  history before now = earlier ++ v :: w :: later -> Ended v now.
Proof.
  intros L H. apply lawful_plan_is_a_chain in L as (u & rest & E & _ & _ & C).
  unfold history in H. apply filter_split in H as (b & r & F & G). rewrite E in F.
  pose proof (chain_behind b u rest v r C F) as K.
  assert (W : In w (filter (fun v => enter v <=? now) r)) by (rewrite <- G; left; auto).
  apply filter_In in W as [W T]. destruct (chain_later i a well_formed of_instance v r K w W) as (l & M & N & _).
  exists l. split; auto. lia.
Qed.

(** The last visit of the history has not ended if the plan has not. *)
Lemma current_has_not_ended before now earlier v : Plan_lawful i a before -> ~ Has_ended before now ->
  history before now = earlier ++ [v] -> ~ Ended v now.
Proof.
  intros L N H (l & M & T). apply lawful_plan_is_a_chain in L as (u & rest & E & _ & _ & C).
  unfold history in H. apply filter_split in H as (b & r & F & G).
  pose proof (chain_behind b u rest v r C (eq_trans (eq_sym E) F)) as K. destruct r as [|w r].
  - apply N. exists b, v. split; auto. exists l. auto.
  - destruct K as (_ & K & _ & _). simpl in G. destruct (Z.leb_spec (enter w) now); [discriminate|].
    rewrite K in M. injection M as <-. lia.
Qed.

Definition Visit_kept (v again : visit) : Prop := visit_resource again = visit_resource v /\ enter again = enter v.

Lemma visit_unchanged v again : Visit_kept v again -> leave again = leave v -> again = v.
Proof. destruct v, again. unfold Visit_kept. simpl. intros [-> ->] ->. reflexivity. Qed.

(** The plan of a robot that is under way begins with what it has done. *)
Theorem plan_begins_with_the_past followed made now :
  (forall before, followed = Some before -> Plan_lawful i a before /\ ~ Has_ended before now) ->
  Plan_lawful i a made -> Fits_the_past followed made now ->
  let s := standing_of known a now followed in
  exists current later, visits made = past s ++ current :: later /\
  visit_resource current = place s /\ enter current = since s /\ No_earlier (leave current) now.
Proof.
  intros B L F. unfold standing_of. cbv zeta.
  assert (S : exists first later, visits made = first :: later /\
    visit_resource first = start a /\ enter first = release a
    /\ Chain i a first later) by (apply lawful_plan_is_a_chain; exact L).
  destruct S as (first & later & E & R & T & C).
  destruct followed as [before|]; [|exists first, later; simpl; repeat split; auto; exact (F first later E)].
  destruct (B before eq_refl) as [K N]. destruct F as [F _].
  destruct (rev (history before now)) as [|current earlier] eqn:H.
  - exists first, later. simpl. repeat split; auto.
    assert (G : history before now = []) by (rewrite <- (rev_involutive (history before now)), H; reflexivity).
    apply lawful_plan_is_a_chain in K as (u & rest & V & _ & U & _). unfold history in G. rewrite V in G. simpl in G.
    destruct (Z.leb_spec (enter u) now); [discriminate|].
    assert (P : Stay_lawful i a first) by (destruct later; apply C).
    destruct (leave first) as [l|] eqn:M; simpl; auto.
    pose proof (stay_is_positive i a well_formed of_instance first l P M). lia.
  - assert (G : history before now = rev earlier ++ [current]).
    { rewrite <- (rev_involutive (history before now)), H. reflexivity. }
    simpl. rewrite G in F.
    destruct (prefix_of_nth (rev earlier) (visits made)) as (rest & V).
    + intros n v Q. destruct (F n v) as (again & P & X & Y & D & _).
      { rewrite nth_error_app1; auto. apply nth_error_Some. congruence. }
      rewrite P. f_equal. apply visit_unchanged; [split; auto|]. apply D.
      destruct (nth_error_split _ _ Q) as (b & r & I & _).
      destruct r as [|w r].
      * apply (history_has_ended before now b v current [] K). rewrite G, I, <- app_assoc. reflexivity.
      * apply (history_has_ended before now b v w (r ++ [current]) K). rewrite G, I, <- app_assoc. reflexivity.
    + destruct (F (length (rev earlier)) current) as (again & P & X & Y & _ & D).
      { rewrite nth_error_app2, Nat.sub_diag by auto. reflexivity. }
      rewrite V, nth_error_app2, Nat.sub_diag in P by auto.
      destruct rest as [|x rest]; [discriminate|]. injection P as ->.
      exists again, rest. repeat split; auto. apply D. exact (current_has_not_ended before now _ _ K N G).
Qed.

(** A plan that has ended is unchanged. *)
Theorem ended_plan_is_unchanged before made now : Plan_lawful i a before -> Has_ended before now ->
  Keeps_history before made now -> visits made = visits before.
Proof.
  intros L N [F D]. specialize (D N).
  assert (H : history before now = visits before /\ forall v, In v (visits before) -> Ended v now).
  { pose proof L as P. apply lawful_plan_is_a_chain in P as (u & rest & E & _ & _ & C).
    destruct N as (b & last & G & l & M & T).
    assert (A : forall v, In v (visits before) -> Ended v now).
    { intros v V. rewrite G in V. apply in_app_or in V as [V|[<-|[]]]; [|exists l; auto].
      apply in_split in V as (x & y & ->). rewrite <- app_assoc in G.
      assert (K : Chain i a v (y ++ [last])) by (eapply (chain_behind x); [exact C | rewrite <- E; exact G]).
      assert (I : In last (y ++ [last])) by (apply in_or_app; right; left; reflexivity).
      destruct (chain_later i a well_formed of_instance v _ K last I) as (k & Q & R & _).
      pose proof (stay_is_positive i a well_formed of_instance last l (chain_lawful i a v _ K last (or_intror I)) M).
      exists k. split; auto. lia. }
    split; auto. unfold history.
    assert (Q : forall l, (forall v, In v l -> In v (visits before)) -> filter (fun v => enter v <=? now) l = l).
    { intros m. induction m as [|v m IH]; intros I; simpl; auto. rewrite IH by (intros; apply I; right; auto).
      destruct (A v (I v (or_introl eq_refl))) as (k & K & U).
      assert (S : Stay_lawful i a v) by (apply (chain_lawful i a u rest C); rewrite <- E; apply I; left; auto).
      pose proof (stay_is_positive i a well_formed of_instance v k S K).
      destruct (Z.leb_spec (enter v) now); [auto | lia]. }
    apply Q. auto. }
  destruct H as [H A]. rewrite H in *. destruct (prefix_of_nth (visits before) (visits made)) as (r & E).
  - intros n v V. destruct (F n v V) as (again & P & X & Y & Z & _). rewrite P. f_equal.
    apply visit_unchanged; [split; auto|]. apply Z. apply A. eapply nth_error_In. exact V.
  - rewrite E in *. rewrite app_length in D. destruct r as [|x r]; [apply app_nil_r|]. simpl in D. lia.
Qed.
End Robot.
