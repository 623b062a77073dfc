(** What the rules of one plan mean step by step, and where robots are in lawful plans. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops Collections Timeline.
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
  | Vanish => forall r, In r (resources i) -> resource_id r = goal a -> leave v = Some (enter v + last_stay a r)
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

(** The rules [plan/...] hold if and only if the plan starts as it should, leads step by step to the goal, and serves
    the stops. *)
Theorem plan_lawful_iff i a p : Plan_lawful i a p <->
  exists v later, visits p = v :: later /\ visit_resource v = start a /\ enter v = release a /\ Chain i a v later /\
  Serves_stops (stops a) (v :: later).
Proof.
  split.
  - intros [(v & later & E & R & T) G O K M C D]. exists v, later. rewrite E in O. repeat (split; auto).
    unfold Ends_at_goal, Visits_resources, Follows_moves, Is_contiguous, Respects_durations, Consecutive in *.
    rewrite E in *. apply chain_iff. split; [|split].
    + destruct G as (before & last & F & H & P). exists before, last. repeat split; auto.
    + intros x H. split; [exact (K x H) | intros r l; exact (D x r l H)].
    + intros x y H. split; [exact (C x y H)|]. apply M; [exact H | |]; apply K; destruct H as (b & l & F);
        rewrite F; apply in_or_app; simpl; auto.
  - intros (v & later & E & R & T & H & O). apply chain_iff in H as ((before & last & F & G & P) & S & C).
    split; unfold Starts_at_release, Ends_at_goal, Visits_resources, Follows_moves, Is_contiguous, Respects_durations,
      Consecutive; rewrite E.
    + exists v, later. auto.
    + exists before, last. auto.
    + exact O.
    + intros x X. apply S. exact X.
    + intros x y X _ _. apply C. exact X.
    + intros x y X. apply C. exact X.
    + intros x r l X. apply S. exact X.
Qed.

Lemma lawful_plan_is_a_chain i a p : Plan_lawful i a p ->
  exists v later, visits p = v :: later /\ visit_resource v = start a /\ enter v = release a /\ Chain i a v later.
Proof. intros L. apply plan_lawful_iff in L as (v & later & E & R & T & C & _). eauto 6. Qed.

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

Lemma holds_iff v tick : holds (enter v, leave v) tick = true <-> Holds v tick.
Proof.
  unfold holds, Holds, before, Before. simpl. rewrite andb_true_iff, Z.leb_le.
  destruct (leave v); rewrite ?Z.ltb_lt; tauto.
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

(** Robots are counted in limits, which have keys. *)
Section Keys.
(** The keys of the limits that a place is in, and the ticks for which a robot still counts that has left them. *)
Variables (keys : Z -> list Z) (gap : Z).

Definition has_key (key place : Z) : bool := existsb (Z.eqb key) (keys place).

Definition end_of_count (end_ : option Z) : option Z := match end_ with Some l => Some (l + gap) | None => None end.

(** The stays of plans by the keys of limits. A stay ends later by the gap, unless its robot moves on within the limit:
    so a robot counts once. *)
Fixpoint add_from (m : Map.t (list stay)) (v : visit) (here : list Z) (later : list visit) : Map.t (list stay) :=
  let next := match later with [] => [] | w :: _ => keys (visit_resource w) end in
  let end_for key := if existsb (Z.eqb key) next then leave v else end_of_count (leave v) in
  let m := fold_left (fun m key => enlist key (enter v, end_for key) m) here m in
  match later with [] => m | w :: rest => add_from m w next rest end.

Definition add_visits (m : Map.t (list stay)) (p : plan) : Map.t (list stay) :=
  match visits p with [] => m | v :: later => add_from m v (keys (visit_resource v)) later end.
Definition timetable (ps : list plan) : Map.t (list stay) := fold_left add_visits ps (Map.empty (list stay)).

(** The visit counts in the limit of the key at the tick. *)
Definition counts_in (key tick : Z) (v : visit) : bool :=
  has_key key (visit_resource v) && holds (enter v, end_of_count (leave v)) tick.
Definition counts (p : plan) (key tick : Z) : bool := existsb (counts_in key tick) (visits p).

(** How many of the plans count in the limit at the tick. *)
Definition occupants (ps : list plan) (key tick : Z) : Z :=
  Z.of_nat (length (filter (fun p => counts p key tick) ps)).

(** The stays of one plan in one limit. *)
Fixpoint stays_from (key : Z) (v : visit) (later : list visit) : list stay :=
  let goes_on := match later with [] => false | w :: _ => has_key key (visit_resource w) end in
  let rest := match later with [] => [] | w :: rest => stays_from key w rest end in
  if has_key key (visit_resource v)
  then (enter v, if goes_on then leave v else end_of_count (leave v)) :: rest else rest.

Definition stays_of_plan (key : Z) (p : plan) : list stay :=
  match visits p with [] => [] | v :: later => stays_from key v later end.

(** The stays of a plan in a limit hold a tick once if the plan counts then. *)
Definition Counts_once (p : plan) : Prop :=
  forall key tick, occupancy (stays_of_plan key p) tick = Z.b2z (counts p key tick).

Hypothesis keys_are_different : forall place, NoDup (keys place).

Lemma occupancy_of_cons s l tick : occupancy (s :: l) tick = Z.b2z (holds s tick) + occupancy l tick.
Proof. unfold occupancy. simpl. destruct (holds s tick); simpl length; unfold Z.b2z; lia. Qed.

Lemma listed_by_keys (f : Z -> stay) key here : NoDup here -> forall m,
  listed (fold_left (fun m k => enlist k (f k) m) here m) key
  = if existsb (Z.eqb key) here then f key :: listed m key else listed m key.
Proof.
  induction 1 as [|k here N D IH]; intros m; simpl; auto. rewrite IH, listed_enlist.
  destruct (Z.eqb_spec key k) as [->|E]; simpl.
  - rewrite Z.eqb_refl. destruct (existsb (Z.eqb k) here) eqn:X; auto.
    destruct N. apply existsb_exists in X as (j & J & X). apply Z.eqb_eq in X. congruence.
  - destruct (Z.eqb_spec k key); [congruence|]. reflexivity.
Qed.

Lemma occupancy_of_add_from key tick later : forall v m,
  occupancy (listed (add_from m v (keys (visit_resource v)) later) key) tick
  = occupancy (stays_from key v later) tick + occupancy (listed m key) tick.
Proof.
  induction later as [|w rest IH]; intros v m; cbn [add_from stays_from]; cbv zeta; rewrite ?IH;
    rewrite (listed_by_keys (fun k => (enter v, _))) by apply keys_are_different;
    fold (has_key key (visit_resource v)); destruct (has_key key (visit_resource v)); rewrite ?occupancy_of_cons.
  - simpl. unfold occupancy. simpl. lia.
  - reflexivity.
  - unfold has_key. lia.
  - lia.
Qed.

Lemma occupancy_of_add_visits p key tick m :
  occupancy (listed (add_visits m p) key) tick
  = occupancy (stays_of_plan key p) tick + occupancy (listed m key) tick.
Proof.
  unfold add_visits, stays_of_plan. destruct (visits p) as [|v later]; [reflexivity | apply occupancy_of_add_from].
Qed.

(** In the timetable the stays that hold a tick are as many as the plans that count in the limit. *)
Theorem occupancy_of_timetable ps key tick : (forall p, In p ps -> Counts_once p) ->
  occupancy (listed (timetable ps) key) tick = occupants ps key tick.
Proof.
  intros O. unfold timetable. assert (H : forall m, occupancy (listed (fold_left add_visits ps m) key) tick
    = occupants ps key tick + occupancy (listed m key) tick).
  - induction ps as [|p ps IH]; intros m; simpl; [unfold occupants; simpl; lia|].
    rewrite IH by (intros; apply O; right; auto). rewrite occupancy_of_add_visits.
    rewrite (O p (or_introl eq_refl)). unfold occupants. simpl.
    destruct (counts p key tick); simpl length; unfold Z.b2z; lia.
  - rewrite H, listed_empty. unfold occupancy. simpl. lia.
Qed.

(** For plans of different robots, "at most [most] of the robots" is a number of plans. *)
Lemma occupants_iff (P : Z -> Prop) ps key tick most : NoDup (map plan_robot ps) ->
  (forall id, P id <-> exists p, In p ps /\ plan_robot p = id /\ counts p key tick = true) ->
  (forall ids, NoDup ids -> (forall id, In id ids -> P id) -> Z.of_nat (length ids) <= most)
  <-> occupants ps key tick <= most.
Proof.
  intros N E. set (here := filter (fun p => counts p key tick) ps).
  assert (I : forall id, In id (map plan_robot here) <-> P id).
  { intros id. rewrite in_map_iff, E. unfold here. setoid_rewrite filter_In.
    split; intros (p & H); exists p; tauto. }
  assert (D : NoDup (map plan_robot here)).
  { unfold here. clear -N. induction ps as [|p ps IH]; simpl; [constructor|].
    inversion N as [|? ? P Q]; subst. destruct (counts p key tick); simpl; auto.
    constructor; auto. intros H. apply P. apply in_map_iff in H as (q & <- & H).
    apply in_map. apply filter_In in H. tauto. }
  unfold occupants. fold here. rewrite <- (map_length plan_robot here). split.
  - intros H. apply H; auto. intros id. apply I.
  - intros H ids M O. enough (length ids <= length (map plan_robot here))%nat by lia.
    apply NoDup_incl_length; auto. intros id J. apply I, O, J.
Qed.

Section Chain.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
Hypothesis gap_is_short : 0 <= gap <= 1.

(** A visit counts in a limit at the ticks at which it is there, and for the gap after them. *)
Lemma counts_in_iff key tick v : Stay_lawful i a v -> counts_in key tick v = true <->
  In key (keys (visit_resource v)) /\ exists back, 0 <= back <= gap /\ Holds v (tick - back).
Proof.
  intros S. unfold counts_in, has_key, holds, Holds, before, Before. simpl. rewrite !andb_true_iff, Z.leb_le.
  assert (K : existsb (Z.eqb key) (keys (visit_resource v)) = true <-> In key (keys (visit_resource v))).
  { rewrite existsb_exists. split; [intros (k & H & E); apply Z.eqb_eq in E; congruence|].
    intros H. exists key. split; auto. apply Z.eqb_refl. }
  rewrite K. destruct (leave v) as [l|] eqn:L; simpl.
  - pose proof (stay_is_positive i a well_formed of_instance v l S L) as P. rewrite Z.ltb_lt. split.
    + intros (H & T & B). split; auto. exists (Z.max 0 (tick - l + 1)). lia.
    + intros (H & back & B & T & U). repeat split; auto; lia.
  - split.
    + intros (H & T & _). split; auto. exists 0. rewrite Z.sub_0_r. repeat split; auto; lia.
    + intros (H & back & B & T & _). repeat split; auto. lia.
Qed.

Lemma later_counts_later key tick v later : Chain i a v later -> tick < enter v ->
  existsb (counts_in key tick) (v :: later) = false.
Proof.
  intros C T. apply not_true_iff_false. intros H. apply existsb_exists in H as (x & X & H).
  assert (enter v <= enter x).
  { destruct X as [<-|X]; [lia|]. destruct (chain_later i a well_formed of_instance v later C x X) as (_ & _ & _ & L). lia. }
  unfold counts_in, holds in H. simpl in H. lia.
Qed.

Lemma chain_counts_once key tick later : forall v, Chain i a v later ->
  occupancy (stays_from key v later) tick = Z.b2z (existsb (counts_in key tick) (v :: later)).
Proof.
  induction later as [|w rest IH]; intros v C.
  - cbn [stays_from existsb]. cbv zeta. unfold counts_in.
    destruct (has_key key (visit_resource v)); simpl; [|reflexivity].
    rewrite occupancy_of_cons, orb_false_r. unfold occupancy. simpl. lia.
  - pose proof C as (_ & L & _ & D). specialize (IH w D).
    assert (Sw : Stay_lawful i a w) by (destruct rest; apply D).
    pose proof (later_counts_later key tick w rest D) as N.
    cbn [stays_from]. cbv zeta. change (existsb (counts_in key tick) (v :: w :: rest)) with
      (counts_in key tick v || existsb (counts_in key tick) (w :: rest)).
    fold (stays_from key w rest).
    assert (A : ~ In key (keys (visit_resource w)) -> tick < enter w + gap ->
      existsb (counts_in key tick) (w :: rest) = false).
    { intros K T. cbn [existsb]. destruct (counts_in key tick w) eqn:W.
      { apply (counts_in_iff key tick w Sw) in W as [W _]. tauto. }
      simpl. destruct rest as [|x rest]; auto. destruct D as (_ & M & _ & D).
      pose proof (stay_is_positive i a well_formed of_instance w _ Sw M).
      apply (later_counts_later key tick x rest D). lia. }
    unfold counts_in at 1. destruct (has_key key (visit_resource v)) eqn:V; [|exact IH].
    rewrite occupancy_of_cons, IH, L. unfold holds, before. cbn [end_of_count fst snd].
    destruct (has_key key (visit_resource w)) eqn:W.
    + unfold before. destruct (Z.leb_spec (enter v) tick) as [T|T].
      2:{ simpl. reflexivity. }
      destruct (Z.ltb_spec tick (enter w)) as [U|U]; simpl.
      * change (counts_in key tick w || existsb (counts_in key tick) rest) with
          (existsb (counts_in key tick) (w :: rest)). rewrite N by exact U.
        destruct (Z.ltb_spec tick (enter w + gap)); [reflexivity | lia].
      * destruct (Z.ltb_spec tick (enter w + gap)); [|reflexivity].
        replace (counts_in key tick w) with true; [reflexivity|]. symmetry. unfold counts_in. rewrite W. simpl.
        unfold holds. simpl. apply andb_true_iff. split; [lia|]. unfold before.
        destruct (leave w) as [l|] eqn:M; simpl; auto.
        pose proof (stay_is_positive i a well_formed of_instance w l Sw M). lia.
    + unfold before. destruct ((enter v <=? tick) && (tick <? enter w + gap)) eqn:U; [|reflexivity].
      rewrite A; [reflexivity | | lia].
      intros K. apply not_true_iff_false in W. apply W. unfold has_key. apply existsb_exists. exists key.
      split; auto. apply Z.eqb_refl.
Qed.
End Chain.
End Keys.

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
