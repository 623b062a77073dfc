(** Stops: counting a stop as served as soon as a visit allows it decides whether a plan serves its stops. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law.
Import ListNotations.
Open Scope Z_scope.

(** * The computation *)

(** A visit lasts at least so many ticks. *)
Definition stays_for (v : visit) (ticks : Z) : bool :=
  match leave v with Some l => enter v + ticks <=? l | None => true end.

(** The visit may serve the stop. *)
Definition serves (v : visit) (s : stop) : bool := (visit_resource v =? stop_resource s) && stays_for v (service s).

(** The stops that are left after a visit that is not the last. The last stop is never counted there. *)
Definition next_stops (ss : list stop) (v : visit) : list stop :=
  match ss with s :: ((_ :: _) as later) => if serves v s then later else ss | _ => ss end.

(** A stop counts as served as soon as a visit allows it. *)
Fixpoint serves_all (ss : list stop) (v : visit) (later : list visit) : bool :=
  match later with
  | [] => match ss with [s] => serves v s | _ => false end
  | w :: rest => serves_all (next_stops ss v) w rest
  end.

(** instance/stops. *)
Fixpoint neighbours_differ (ss : list stop) : bool :=
  match ss with
  | s :: ((t :: _) as later) => negb (stop_resource s =? stop_resource t) && neighbours_differ later
  | _ => true
  end.
Definition stops_accepted (known : Z -> bool) (ss : list stop) : bool :=
  negb (length ss =? 0)%nat && forallb (fun s => known (stop_resource s) && (0 <=? service s)) ss
  && neighbours_differ ss.

(** * Stops of an instance *)

Lemma neighbours_differ_iff ss : neighbours_differ ss = true <->
  forall before s t later, ss = before ++ s :: t :: later -> stop_resource s <> stop_resource t.
Proof.
  induction ss as [|s [|t ss] IH]; simpl.
  - split; auto. intros _ [|x before]; discriminate.
  - split; auto. intros _ [|x [|y before]]; discriminate.
  - rewrite andb_true_iff, negb_true_iff, Z.eqb_neq. simpl in IH. rewrite IH. split.
    + intros [N D] [|x before] u v later E; injection E; intros; subst; [exact N | eapply D; eassumption].
    + intros H. split; [exact (H [] s t ss eq_refl)|]. intros before u v later E. apply (H (s :: before) u v later).
      rewrite E. reflexivity.
Qed.

(** The stops end with the last one. *)
Lemma stops_end a : stops a <> [] -> exists front, stops a = front ++ [last_stop a].
Proof. intros N. eexists. apply app_removelast_last. exact N. Qed.

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).

Lemma last_stop_is_a_stop : In (last_stop a) (stops a).
Proof.
  destruct (stops_end a (robots_have_stops i well_formed a of_instance)) as (front & E). rewrite E.
  apply in_or_app. right. left. reflexivity.
Qed.

Lemma goal_is_a_resource : In (goal a) (resource_ids i).
Proof. exact (stops_are_resources i well_formed a _ of_instance last_stop_is_a_stop). Qed.

Lemma last_service_is_a_tick : 0 <= service (last_stop a).
Proof. exact (services_are_ticks i well_formed a _ of_instance last_stop_is_a_stop). Qed.
End Robot.

(** * Serving, visit by visit *)

Lemma serves_iff v s : serves v s = true <-> Serves v s.
Proof.
  unfold serves, stays_for, Serves, Lasts, No_earlier. rewrite andb_true_iff, Z.eqb_eq.
  destruct (leave v); [rewrite Z.leb_le|]; tauto.
Qed.

(** Each visit but the last serves the next stop, unless that is the last, or none. *)
Fixpoint Served (ss : list stop) (v : visit) (later : list visit) : Prop :=
  match later with
  | [] => exists s, ss = [s] /\ Serves v s
  | w :: rest => Served ss w rest \/ exists s ss', ss = s :: ss' /\ Serves v s /\ Served ss' w rest
  end.

Lemma serving_begins_later ss v w rest (f : nat -> nat) :
  (forall j k, (j < k < length ss)%nat -> (f j < f k)%nat) ->
  (forall j s, nth_error ss j = Some s -> exists x, nth_error (v :: w :: rest) (f j) = Some x /\ Serves x s) ->
  (1 <= length ss)%nat -> S (f (length ss - 1)%nat) = length (v :: w :: rest) -> (0 < f O)%nat ->
  Serves_stops ss (w :: rest).
Proof.
  intros I S N L P. assert (A : forall j, (j < length ss)%nat -> (0 < f j)%nat).
  { intros [|j] J; auto. specialize (I O (Datatypes.S j)). lia. }
  exists (fun j => pred (f j)). repeat split; auto.
  - intros j k J. pose proof (I j k J). pose proof (A j). lia.
  - intros j s J. destruct (S j s J) as (x & X & Y). exists x. split; auto.
    assert (j < length ss)%nat by (apply nth_error_Some; congruence). specialize (A j H).
    destruct (f j); [lia | exact X].
  - simpl in L |- *. pose proof (A (length ss - 1)%nat). lia.
Qed.

Lemma served_iff later : forall v ss, Serves_stops ss (v :: later) <-> Served ss v later.
Proof.
  induction later as [|w rest IH]; intros v ss; simpl Served; split.
  - intros (f & I & S & N & L). simpl in L. destruct ss as [|s [|t ss]]; simpl in N; [lia| |].
    + exists s. split; auto. destruct (S O s eq_refl) as (x & X & Y). simpl in L. injection L as L. rewrite L in X.
      injection X as ->. exact Y.
    + specialize (I O (length (s :: t :: ss) - 1)%nat). simpl in I, L. lia.
  - intros (s & -> & Y). exists (fun _ => O). split; [simpl; intros; lia|]. split; [|split; simpl; auto].
    intros [|[|j]] x X; try discriminate. injection X as <-. exists v. auto.
  - intros (f & I & S & N & L). destruct (f O) eqn:F.
    + destruct ss as [|s ss]; [simpl in N; lia|]. destruct (S O s eq_refl) as (x & X & Y). rewrite F in X.
      injection X as <-. right. exists s, ss. split; auto. split; auto. apply IH.
      assert (K : (1 <= length ss)%nat).
      { destruct ss as [|t ss]; simpl; [|lia]. simpl in L. rewrite F in L. lia. }
      apply (serving_begins_later ss v w rest (fun j => f (Datatypes.S j))).
      * intros j k J. apply I. simpl. lia.
      * intros j t J. apply (S (Datatypes.S j) t J).
      * exact K.
      * simpl in L |- *. replace (Datatypes.S (length ss - 1)) with (length ss - 0)%nat by lia. exact L.
      * enough (f O < f 1%nat)%nat by lia. apply I. simpl. lia.
    + left. apply IH. apply (serving_begins_later ss v w rest f); auto. lia.
  - intros [H|(s & ss' & -> & Y & H)]; apply IH in H as (f & I & S & N & L).
    + exists (fun j => Datatypes.S (f j)). repeat split; auto.
      * intros j k J. specialize (I j k J). lia.
      * simpl in L |- *. lia.
    + exists (fun j => match j with O => O | Datatypes.S j => Datatypes.S (f j) end). repeat split; simpl; try lia.
      * intros [|j] [|k] J; try lia. specialize (I j k). lia.
      * intros [|j] t J; simpl in *; [injection J as <-; eauto | auto].
      * destruct (length ss' - 0)%nat eqn:E; [lia|]. simpl in L. rewrite <- L. do 3 f_equal. lia.
Qed.

Lemma served_has_stops later : forall v, ~ Served [] v later.
Proof.
  induction later as [|w rest IH]; intros v; simpl; [intros (s & E & _); discriminate|].
  intros [H|(s & ss & E & _)]; [exact (IH w H) | discriminate].
Qed.

(** Fewer stops are served where more are. *)
Lemma served_fewer later : forall v s t ss, Served (s :: t :: ss) v later -> Served (t :: ss) v later.
Proof.
  induction later as [|w rest IH]; intros v s t ss; simpl.
  - intros (x & E & _). discriminate.
  - intros [H|(x & ss' & E & _ & H)]; left; [exact (IH w s t ss H) | injection E as _ <-; exact H].
Qed.

Lemma served_next ss v w rest : Served ss v (w :: rest) <-> Served (next_stops ss v) w rest.
Proof.
  simpl. unfold next_stops. destruct ss as [|s [|t ss]].
  - split; [intros [H|(s & ss & E & _)]; [exact H | discriminate] | auto].
  - split; [|auto]. intros [H|(x & ss & E & _ & H)]; auto. injection E as _ <-. destruct (served_has_stops rest w H).
  - destruct (serves v s) eqn:E.
    + apply serves_iff in E. split; [|intros H; right; eauto].
      intros [H|(x & ss' & F & _ & H)]; [exact (served_fewer _ _ _ _ _ H) | injection F as _ <-; exact H].
    + split; [|auto]. intros [H|(x & ss' & F & Y & H)]; auto. injection F as <- <-. apply serves_iff in Y. congruence.
Qed.

(** Counting greedily loses nothing. *)
Theorem plans_that_serve_all_are_counted ss v later : serves_all ss v later = true <-> Serves_stops ss (v :: later).
Proof.
  rewrite served_iff. revert ss v. induction later as [|w rest IH]; intros ss v.
  - simpl. destruct ss as [|s [|t ss]].
    + split; [discriminate|]. intros (s & E & _). discriminate.
    + rewrite serves_iff. split; [eauto|]. intros (x & E & H). injection E as <-. exact H.
    + split; [discriminate|]. intros (x & E & _). discriminate.
  - rewrite served_next. simpl. apply IH.
Qed.

(** What has been served so far need not be served again, whatever comes later. *)
Theorem stops_served_so_far_count past : forall ss v later,
  Serves_stops ss (past ++ v :: later) <-> Serves_stops (fold_left next_stops past ss) (v :: later).
Proof.
  induction past as [|u past IH]; intros ss v later; simpl; [tauto|]. rewrite <- IH.
  destruct past as [|x past]; simpl; rewrite !served_iff; apply served_next.
Qed.

(** * Robots with a goal alone *)

(** The robot has one stop, without service. *)
Definition Has_goal_alone (a : robot) : Prop := exists place, stops a = only place.

Lemma goal_alone a : Has_goal_alone a -> stops a = only (goal a) /\ service (last_stop a) = 0.
Proof. intros [place E]. unfold goal, last_stop. rewrite E. auto. Qed.

Lemma goal_alone_needs_its_duration a r : Has_goal_alone a -> 0 <= least_stay a r -> last_stay a r = least_stay a r.
Proof. intros H N. apply goal_alone in H as [_ S]. unfold last_stay. rewrite S. lia. Qed.

Lemma goal_alone_is_served a before v : Has_goal_alone a -> visit_resource v = goal a ->
  No_earlier (leave v) (enter v) -> Serves_stops (stops a) (before ++ [v]).
Proof.
  intros H R L. apply goal_alone in H as [-> _]. exists (fun _ => length before). repeat split; simpl; auto.
  - intros j k J. lia.
  - intros [|[|j]] s E; try discriminate. injection E as <-. exists v. split.
    + rewrite nth_error_app2, Nat.sub_diag by auto. reflexivity.
    + split; [exact R|]. unfold Lasts. simpl. rewrite Z.add_0_r. exact L.
  - rewrite app_length. simpl. lia.
Qed.
