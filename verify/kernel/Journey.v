(** What the rules of one plan mean step by step, and where robots are in lawful plans. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline.
Import ListNotations.
Open Scope Z_scope.

(** * Lawful plans, visit by visit *)

(** The visit is to a resource of the graph and lasts long enough. *)
Definition Stay_lawful (i : instance) (a : robot) (v : visit) : Prop :=
  In (visit_resource v) (resource_ids i) /\
  forall r l, In r (resources i) -> resource_id r = visit_resource v -> leave v = Some l ->
  least_stay a r <= l - enter v.

(** A plan may end with the visit. *)
Definition Ends (i : instance) (a : robot) (v : visit) : Prop :=
  visit_resource v = goal a /\
  match after_goal i with
  | Park => leave v = None
  | Vanish => forall r, In r (resources i) -> resource_id r = goal a -> leave v = Some (enter v + least_stay a r)
  end.

(** The visit and those after it keep the rules, up to the goal. *)
Fixpoint Chain (i : instance) (a : robot) (v : visit) (later : list visit) : Prop :=
  Stay_lawful i a v /\
  match later with
  | [] => Ends i a v
  | w :: rest => leave v = Some (enter w) /\ Move i (visit_resource v) (visit_resource w) /\ Chain i a w rest
  end.

Lemma consecutive_cons {A} (v w : A) rest x y :
  (exists before later, v :: w :: rest = before ++ x :: y :: later)
  <-> x = v /\ y = w \/ (exists before later, w :: rest = before ++ x :: y :: later).
Proof.
  split.
  - intros ([|b before] & later & E); simpl in E; injection E; intros; subst; eauto.
  - intros [[-> ->]|(before & later & E)].
    + exists [], rest. auto.
    + exists (v :: before), later. rewrite E. auto.
Qed.

Lemma not_consecutive {A} (v x y : A) : ~ (exists before later, [v] = before ++ x :: y :: later).
Proof. intros ([|b [|c before]] & later & E); discriminate. Qed.

Lemma last_cons {A} (P : A -> Prop) v w rest :
  (exists before last, v :: w :: rest = before ++ [last] /\ P last)
  <-> (exists before last, w :: rest = before ++ [last] /\ P last).
Proof.
  split.
  - intros ([|b before] & last & E & H); simpl in E; injection E; intros; subst; eauto. discriminate.
  - intros (before & last & E & H). exists (v :: before), last. rewrite E. auto.
Qed.

Lemma chain_iff i a later : forall v, Chain i a v later <->
  (exists before last, v :: later = before ++ [last] /\ Ends i a last) /\
  (forall x, In x (v :: later) -> Stay_lawful i a x) /\
  (forall x y, (exists b l, v :: later = b ++ x :: y :: l) ->
    leave x = Some (enter y) /\ Move i (visit_resource x) (visit_resource y)).
Proof.
  induction later as [|w rest IH]; intros v; simpl Chain.
  - split.
    + intros [S E]. split; [|split].
      * exists [], v. auto.
      * intros x [<-|[]]. exact S.
      * intros x y H. destruct (not_consecutive _ _ _ H).
    + intros ((before & last & E & H) & S & _). split; [apply S; left; auto|].
      destruct before as [|b [|c before]]; [injection E as ->; exact H | discriminate | discriminate].
  - rewrite IH, last_cons. setoid_rewrite consecutive_cons. split.
    + intros (S & L & M & E & T & C). split; [exact E|]. split.
      * intros x [<-|H]; auto.
      * intros x y [[-> ->]|H]; auto.
    + intros (E & S & C). destruct (C v w) as [L M]; [auto|].
      split; [apply S; left; auto|]. split; [exact L|]. split; [exact M|]. split; [exact E|]. split.
      * intros x H. apply S. right. exact H.
      * intros x y H. apply C. right. exact H.
Qed.

(** The rules [plan/...] hold if and only if the plan starts as it should and leads step by step to the goal. *)
Theorem plan_lawful_iff i a p : Plan_lawful i a p <->
  exists v later, visits p = v :: later /\ visit_resource v = start a /\ enter v = release a /\ Chain i a v later.
Proof.
  split.
  - intros [(v & later & E & R & T) G K M C D]. exists v, later. repeat split; auto.
    unfold Ends_at_goal, Visits_resources, Follows_moves, Is_contiguous, Respects_durations, Consecutive in *.
    rewrite E in *. apply chain_iff. split; [|split].
    + destruct G as (before & last & F & H & P). exists before, last. repeat split; auto.
    + intros x H. split; [exact (K x H) | intros r l; exact (D x r l H)].
    + intros x y H. split; [exact (C x y H)|]. apply M; [exact H | |]; apply K; destruct H as (b & l & F);
        rewrite F; apply in_or_app; simpl; auto.
  - intros (v & later & E & R & T & H). apply chain_iff in H as ((before & last & F & G & P) & S & C).
    split; unfold Starts_at_release, Ends_at_goal, Visits_resources, Follows_moves, Is_contiguous, Respects_durations,
      Consecutive; rewrite E.
    + exists v, later. auto.
    + exists before, last. auto.
    + intros x X. apply S. exact X.
    + intros x y X _ _. apply C. exact X.
    + intros x y X. apply C. exact X.
    + intros x r l X. apply S. exact X.
Qed.

(** * Ticks of lawful plans *)

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).

Lemma least_stay_is_positive r : In r (resources i) -> 1 <= least_stay a r.
Proof.
  intros R. unfold least_stay. pose proof (paces_are_positive i well_formed a of_instance).
  pose proof (durations_are_positive i well_formed r R). nia.
Qed.

Lemma stay_is_positive v l : Stay_lawful i a v -> leave v = Some l -> enter v < l.
Proof.
  intros [K D] L. apply in_map_iff in K as (r & E & R). pose proof (least_stay_is_positive r R).
  specialize (D r l R E L). lia.
Qed.

Lemma chain_lawful v later : Chain i a v later -> forall w, In w (v :: later) -> Stay_lawful i a w.
Proof. intros C. apply chain_iff in C. apply C. Qed.

Lemma chain_later v later : Chain i a v later -> forall w, In w later ->
  exists l, leave v = Some l /\ l <= enter w /\ enter v < enter w.
Proof.
  revert v. induction later as [|x rest IH]; intros v C w W; [destruct W|].
  destruct C as (S & L & _ & C). exists (enter x). pose proof (stay_is_positive v _ S L).
  destruct W as [<-|W].
  - repeat split; auto. lia.
  - destruct (IH x C w W) as (l & _ & _ & T). repeat split; auto; lia.
Qed.

(** How many of the visits are to the place and hold the tick. *)
Definition holding (place tick : Z) (v : visit) : bool :=
  (visit_resource v =? place) && holds (enter v, leave v) tick.

Lemma holds_iff v tick : holds (enter v, leave v) tick = true <-> Holds v tick.
Proof.
  unfold holds, Holds, before, Before. simpl. rewrite andb_true_iff, Z.leb_le.
  destruct (leave v); rewrite ?Z.ltb_lt; tauto.
Qed.

Lemma holding_iff place tick v : holding place tick v = true <-> visit_resource v = place /\ Holds v tick.
Proof. unfold holding. rewrite andb_true_iff, Z.eqb_eq, holds_iff. tauto. Qed.

Lemma chain_holds_once place tick v later : Chain i a v later ->
  (length (filter (holding place tick) (v :: later)) <= 1)%nat.
Proof.
  revert v. induction later as [|w rest IH]; intros v C.
  - simpl. destruct (holding place tick v); simpl; lia.
  - pose proof (chain_later v (w :: rest) C) as L. destruct C as (_ & _ & _ & C). specialize (IH w C).
    change (filter (holding place tick) (v :: w :: rest)) with
      (if holding place tick v
       then v :: filter (holding place tick) (w :: rest) else filter (holding place tick) (w :: rest)).
    destruct (holding place tick v) eqn:H; [|exact IH].
    enough (E : filter (holding place tick) (w :: rest) = []) by (rewrite E; simpl; lia).
    destruct (filter (holding place tick) (w :: rest)) as [|x l] eqn:E; auto.
    assert (X : In x (filter (holding place tick) (w :: rest))) by (rewrite E; left; auto).
    apply filter_In in X as [X G]. apply holding_iff in H, G. destruct H as [_ [_ H]], G as [_ [G _]].
    destruct (L x X) as (l' & F & T & _). rewrite F in H. simpl in H. lia.
Qed.

Lemma chain_enters_once v later : Chain i a v later -> forall x y z w,
  (exists b l, v :: later = b ++ x :: y :: l) -> (exists b l, v :: later = b ++ z :: w :: l) ->
  enter y = enter w -> x = z.
Proof.
  revert v. induction later as [|u rest IH]; intros v C x y z w X Z E.
  - destruct (not_consecutive _ _ _ X).
  - destruct C as (_ & _ & _ & C). pose proof (chain_later u rest C) as L.
    assert (N : forall p q, (exists b l, u :: rest = b ++ p :: q :: l) -> enter u < enter q).
    { intros p q ([|b before] & l & F); injection F as -> ->.
      - destruct (L q) as (k & _ & _ & T); [left; auto | exact T].
      - destruct (L q) as (k & _ & _ & T); [apply in_or_app; right; right; left; auto | exact T]. }
    apply consecutive_cons in X as [[-> ->]|X]; apply consecutive_cons in Z as [[-> ->]|Z]; auto.
    + specialize (N _ _ Z). lia.
    + specialize (N _ _ X). lia.
    + eapply IH; eauto.
Qed.
End Robot.

(** * Plans together *)

(** The stays of plans by resource. *)
Definition add_visits (m : Map.t (list stay)) (p : plan) : Map.t (list stay) :=
  fold_left (fun m v => enlist (visit_resource v) (enter v, leave v) m) (visits p) m.
Definition timetable (ps : list plan) : Map.t (list stay) := fold_left add_visits ps (Map.empty (list stay)).

Definition occupies (p : plan) (place tick : Z) : bool := existsb (holding place tick) (visits p).

(** How many of the plans occupy the place at the tick. *)
Definition occupants (ps : list plan) (place tick : Z) : Z :=
  Z.of_nat (length (filter (fun p => occupies p place tick) ps)).

(** No plan has two visits that hold the same tick in the same place. *)
Definition Holds_once (p : plan) : Prop :=
  forall place tick, (length (filter (holding place tick) (visits p)) <= 1)%nat.

Lemma occupancy_of_add_visits p place tick m :
  occupancy (listed (add_visits m p) place) tick
  = Z.of_nat (length (filter (holding place tick) (visits p))) + occupancy (listed m place) tick.
Proof.
  unfold add_visits. revert m. induction (visits p) as [|v vs IH]; intros m; simpl; [lia|].
  rewrite IH, listed_enlist. unfold holding at 2.
  destruct (Z.eqb_spec (visit_resource v) place) as [->|N]; simpl; [|lia].
  unfold occupancy at 1. simpl. destruct (holds (enter v, leave v) tick); simpl length; unfold occupancy; lia.
Qed.

Lemma holds_once_counts p place tick : Holds_once p ->
  Z.of_nat (length (filter (holding place tick) (visits p))) = if occupies p place tick then 1 else 0.
Proof.
  intros O. specialize (O place tick). destruct (occupies p place tick) eqn:E.
  - apply existsb_exists in E as (v & V & H).
    assert (F : In v (filter (holding place tick) (visits p))) by (apply filter_In; auto).
    destruct (filter (holding place tick) (visits p)) as [|x l]; [destruct F | simpl in *; lia].
  - destruct (filter (holding place tick) (visits p)) as [|x l] eqn:F; auto.
    assert (X : In x (filter (holding place tick) (visits p))) by (rewrite F; left; auto).
    apply filter_In in X as [X H]. enough (occupies p place tick = true) by congruence.
    apply existsb_exists. eauto.
Qed.

(** In the timetable the stays that hold a tick are as many as the plans that occupy the place. *)
Theorem occupancy_of_timetable ps place tick : (forall p, In p ps -> Holds_once p) ->
  occupancy (listed (timetable ps) place) tick = occupants ps place tick.
Proof.
  intros O. unfold timetable. assert (H : forall m, occupancy (listed (fold_left add_visits ps m) place) tick
    = occupants ps place tick + occupancy (listed m place) tick).
  - induction ps as [|p ps IH]; intros m; simpl; [unfold occupants; simpl; lia|].
    rewrite IH by (intros; apply O; right; auto). rewrite occupancy_of_add_visits.
    rewrite holds_once_counts by (apply O; left; auto). unfold occupants. simpl.
    destruct (occupies p place tick); simpl length; lia.
  - rewrite H, listed_empty. unfold occupancy. simpl. lia.
Qed.

Lemma occupies_iff p place tick : occupies p place tick = true <->
  exists v, In v (visits p) /\ visit_resource v = place /\ Holds v tick.
Proof.
  unfold occupies. rewrite existsb_exists. split; intros (v & V & H); exists v; split; auto; apply holding_iff; auto.
Qed.

(** For plans of different robots, "at most [most] of the robots" is a number of plans. *)
Lemma occupants_iff ps place tick most : NoDup (map plan_robot ps) ->
  (forall ids, NoDup ids -> (forall id, In id ids -> Occupies ps id place tick) -> Z.of_nat (length ids) <= most)
  <-> occupants ps place tick <= most.
Proof.
  intros N. set (here := filter (fun p => occupies p place tick) ps).
  assert (I : forall id, In id (map plan_robot here) <-> Occupies ps id place tick).
  { intros id. rewrite in_map_iff. unfold here, Occupies. setoid_rewrite filter_In. setoid_rewrite occupies_iff.
    split.
    - intros (p & <- & P & v & V). exists p, v. tauto.
    - intros (p & v & P & <- & V). exists p. repeat split; eauto. }
  assert (D : NoDup (map plan_robot here)).
  { unfold here. clear -N. induction ps as [|p ps IH]; simpl; [constructor|].
    inversion N as [|? ? P Q]; subst. destruct (occupies p place tick); simpl; auto.
    constructor; auto. intros H. apply P. apply in_map_iff in H as (q & <- & H).
    apply in_map. apply filter_In in H. tauto. }
  unfold occupants. fold here. rewrite <- (map_length plan_robot here). split.
  - intros H. apply H; auto. intros id. apply I.
  - intros H ids M O. enough (length ids <= length (map plan_robot here))%nat by lia.
    apply NoDup_incl_length; auto. intros id J. apply I, O, J.
Qed.

(** * Moves *)

(** The moves of plans: the tick, the resource that is left and the one that is entered. *)
Definition move := (Z * (Z * Z))%type.

Fixpoint moves_onto (known : list move) (v : visit) (later : list visit) : list move :=
  match later with
  | [] => known
  | w :: rest => moves_onto ((enter w, (visit_resource v, visit_resource w)) :: known) w rest
  end.

Definition add_moves (known : list move) (p : plan) : list move :=
  match visits p with [] => known | v :: later => moves_onto known v later end.

Definition moves (ps : list plan) : list move := fold_left add_moves ps [].

Definition Moves (p : plan) (m : move) : Prop :=
  exists v w, Consecutive p v w /\ m = (enter w, (visit_resource v, visit_resource w)).

Lemma in_add_moves known p m : In m (add_moves known p) <-> In m known \/ Moves p m.
Proof.
  unfold add_moves, Moves, Consecutive. destruct (visits p) as [|v later].
  - split; auto. intros [H|(v & w & (b & l & E) & _)]; auto. destruct b; discriminate.
  - revert known v. induction later as [|w rest IH]; intros known v; simpl.
    + split; auto. intros [H|(x & y & H & _)]; auto. destruct (not_consecutive _ _ _ H).
    + rewrite IH. setoid_rewrite consecutive_cons. simpl. split.
      * intros [[<-|H]|(x & y & H & E)].
        -- right. exists v, w. auto.
        -- left. exact H.
        -- right. exists x, y. auto.
      * intros [H|(x & y & [[-> ->]|H] & ->)].
        -- left. right. exact H.
        -- left. left. reflexivity.
        -- right. exists x, y. auto.
Qed.

Lemma in_moves ps m : In m (moves ps) <-> exists p, In p ps /\ Moves p m.
Proof.
  unfold moves. assert (H : forall known, In m (fold_left add_moves ps known)
    <-> In m known \/ exists p, In p ps /\ Moves p m).
  - induction ps as [|p ps IH]; intros known; simpl.
    + split; auto. intros [H|(p & [] & _)]. exact H.
    + rewrite IH, in_add_moves. split.
      * intros [[H|H]|(q & Q & H)]; eauto 6.
      * intros [H|(q & [<-|Q] & H)]; eauto.
  - rewrite H. simpl. split; auto. intros [[]|K]. exact K.
Qed.
