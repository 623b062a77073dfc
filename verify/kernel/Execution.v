(** Executions: what late robots do if they keep the order of lawful plans, and why no joint rule is broken.

    An execution has the form of plans: the visits that each robot has entered, the last of them perhaps not left. Its
    ticks are what happened, whatever the delays were. A robot that has not left a place counts as there for ever. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Ways.
Import ListNotations.
Open Scope Z_scope.

(** The visit with this number in the robot's plan; the first has number 0. *)
Definition Visit_of (ps : list plan) (id : Z) (n : nat) (v : visit) : Prop :=
  exists p, In p ps /\ plan_robot p = id /\ nth_error (visits p) n = Some v.

Section Execution.
Variable i : instance.

Local Notation gap := (gap i).

(** joint/capacity, and joint/following where following is forbidden: no tick has more robots in a resource than its
    capacity if each stay counts [gap] ticks longer. *)
Definition Crowds (ps : list plan) (id place tick : Z) : Prop :=
  exists n v, Visit_of ps id n v /\ visit_resource v = place /\
  enter v <= tick /\ Before tick (option_map (Z.add gap) (leave v)).
Definition Room_is_kept (ps : list plan) : Prop :=
  forall r tick ids, In r (resources i) -> NoDup ids ->
  (forall id, In id ids -> Crowds ps id (resource_id r) tick) -> Z.of_nat (length ids) <= capacity r.

(** * The rules of an execution *)

(** One robot has left a resource when another enters it. *)
Definition Left_before (v w : visit) : Prop := exists l, leave v = Some l /\ l + gap <= enter w.

(** The execution [ts] keeps the order of the plans [ps]. *)
Record Executes (ps ts : list plan) : Prop := {
  (** trace/robots: each planned robot is named once, and no other. *)
  robots_are_named_once : NoDup (map plan_robot ts);
  robots_are_the_planned : forall id, In id (map plan_robot ts) <-> In id (map plan_robot ps);
  (** trace/prefix: the resources that a robot has visited are the first ones of its plan. *)
  visits_are_planned : forall id n x, Visit_of ts id n x ->
    exists v, Visit_of ps id n v /\ visit_resource x = visit_resource v;
  (** trace/ticks: the first visit is entered at the release or later, each other one as the one before is left ... *)
  first_entry_is_late : forall a x, In a (robots i) -> Visit_of ts (robot_id a) 0 x -> release a <= enter x;
  visits_are_contiguous : forall id n x y, Visit_of ts id n x -> Visit_of ts id (S n) y -> leave x = Some (enter y);
  (** ... and only the last visit of a plan is left for good, and with [Park] none is. *)
  stays_until_it_moves : forall id n x l, Visit_of ts id n x -> leave x = Some l ->
    (exists y, Visit_of ts id (S n) y) \/ after_goal i = Vanish /\ forall w, ~ Visit_of ps id (S n) w;
  (** execution/duration: a visit that is left has lasted at least the duration times the pace. *)
  durations_are_kept : forall a r n x l, In a (robots i) -> In r (resources i) ->
    Visit_of ts (robot_id a) n x -> visit_resource x = resource_id r -> leave x = Some l ->
    least_stay a r <= l - enter x;
  (** execution/order: a robot enters a resource only when each robot has left it that, by the plans, has left it when
      the robot enters. *)
  order_is_kept : forall one m v other n w y,
    Visit_of ps one m v -> Visit_of ps other n w -> visit_resource v = visit_resource w -> Left_before v w ->
    Visit_of ts other n y -> exists x, Visit_of ts one m x /\ Left_before x y;
  (** execution/exchange: of two moves that are planned at different ticks, (r, s) and (s, r), the first is made at an
      earlier tick than the second. *)
  exchange_order_is_kept : forall one m v v' other n w w' y,
    Visit_of ps one m v -> Visit_of ps one (S m) v' -> Visit_of ps other n w' -> Visit_of ps other (S n) w ->
    visit_resource v = visit_resource w -> visit_resource v' = visit_resource w' -> enter v' < enter w ->
    Visit_of ts other (S n) y -> exists x, Visit_of ts one (S m) x /\ enter x < enter y
}.

(** trace/ticks: nothing happens after the tick [now]. *)
Definition Happened_by (ts : list plan) (now : Z) : Prop :=
  forall id n x, Visit_of ts id n x -> enter x <= now /\ forall l, leave x = Some l -> l <= now.

(** Every planned visit has been entered. *)
Definition Completes (ps ts : list plan) : Prop :=
  forall id n v, Visit_of ps id n v -> exists x, Visit_of ts id n x.

(** * Visits by their numbers *)

Lemma consecutive_by_number p v w :
  Consecutive p v w <-> exists n, nth_error (visits p) n = Some v /\ nth_error (visits p) (S n) = Some w.
Proof.
  unfold Consecutive. generalize (visits p) as vs. intros vs. split.
  - intros (front & later & ->). exists (length front). induction front as [|x front IH]; simpl; auto.
  - intros (n & V & W). revert vs V W. induction n as [|n IH]; intros [|x vs] V W; try discriminate.
    + destruct vs as [|y vs]; [discriminate|]. injection V as ->. injection W as ->. exists [], vs. auto.
    + destruct (IH vs V W) as (front & later & ->). exists (x :: front), later. auto.
Qed.

Lemma plan_of_robot_is_unique (ps : list plan) p q : NoDup (map plan_robot ps) ->
  In p ps -> In q ps -> plan_robot p = plan_robot q -> p = q.
Proof.
  induction ps as [|x ps IH]; simpl; [tauto|]. intros N P Q E. inversion N as [|? ? H K]; subst.
  destruct P as [<-|P], Q as [<-|Q]; auto.
  - destruct H. rewrite E. apply in_map. auto.
  - destruct H. rewrite <- E. apply in_map. auto.
Qed.

Lemma visit_is_unique ps id n v w : NoDup (map plan_robot ps) -> Visit_of ps id n v -> Visit_of ps id n w -> v = w.
Proof.
  intros N (p & P & E & V) (q & Q & F & W).
  assert (p = q) by (apply (plan_of_robot_is_unique ps); congruence). congruence.
Qed.

Lemma visit_before ps id n v : Visit_of ps id (S n) v -> exists w, Visit_of ps id n w.
Proof.
  intros (p & P & E & V). destruct (nth_error (visits p) n) as [w|] eqn:W; [exists w, p; auto|].
  apply nth_error_None in W. assert (S n < length (visits p))%nat by (apply nth_error_Some; congruence). lia.
Qed.

Lemma visit_is_of_planned ps id n v : Visit_of ps id n v -> In id (map plan_robot ps).
Proof. intros (p & P & <- & _). apply in_map. exact P. Qed.

Lemma visit_by_membership ps p v : In p ps -> In v (visits p) -> exists n, Visit_of ps (plan_robot p) n v.
Proof. intros P V. apply In_nth_error in V as (n & V). exists n, p. auto. Qed.

(** Without groups, room in the resources is all that limits ask for. *)
Lemma room_keeps_limits ps : groups i = [] -> Room_is_kept ps -> Limits_are_kept i ps.
Proof.
  intros G K l tick ids L N C. unfold limits in L. rewrite G, app_nil_r in L. apply in_map_iff in L as (r & <- & R).
  apply (K r tick ids R N). intros id I. destruct (C id I) as (place & back & [<-|[]] & B & p & v & P & <- & V & E & T).
  destruct (visit_by_membership ps p v P V) as (n & X). exists n, v. destruct T as [T U]. repeat split; auto; [lia|].
  unfold Before in *. destruct (leave v); simpl; auto. lia.
Qed.

(** * Safety *)

(** Of finitely many, one has the latest tick. *)
Lemma latest (P : Z -> Z -> Prop) ids : ids <> [] -> (forall id, In id ids -> exists tick, P id tick) ->
  exists tick, (exists id, In id ids /\ P id tick) /\ forall id, In id ids -> exists t, P id t /\ t <= tick.
Proof.
  induction ids as [|x ids IH]; [tauto|]. intros _ H. destruct (H x (or_introl eq_refl)) as (t & T).
  destruct ids as [|y ids].
  - exists t. split; [exists x; simpl; auto|]. intros id [<-|[]]. exists t. split; [exact T | lia].
  - destruct IH as (u & (id & I & U) & L); [discriminate | intros; apply H; right; auto |].
    destruct (Z.le_ge_cases t u) as [C|C].
    + exists u. split; [exists id; simpl; auto|]. intros k [<-|K]; eauto.
    + exists t. split; [exists x; simpl; auto|]. intros k [<-|K].
      * exists t. split; [exact T | lia].
      * destruct (L k K) as (s & S & ?). exists s. split; [exact S | lia].
Qed.

(** Where visits keep their order, a resource stays as empty as it was planned to be. *)
Definition Room_in (ps : list plan) (r : resource) : Prop := forall tick ids, NoDup ids ->
  (forall id, In id ids -> Crowds ps id (resource_id r) tick) -> Z.of_nat (length ids) <= capacity r.

Lemma order_keeps_room ps ts r : NoDup (map plan_robot ts) ->
  (forall id n x, Visit_of ts id n x -> exists v, Visit_of ps id n v /\ visit_resource x = visit_resource v) ->
  (forall one m v other n w y, Visit_of ps one m v -> Visit_of ps other n w -> visit_resource v = resource_id r ->
    visit_resource w = resource_id r -> Left_before v w -> Visit_of ts other n y ->
    exists x, Visit_of ts one m x /\ Left_before x y) ->
  Room_in ps r -> Room_in ts r.
Proof.
  intros U A O K tick ids N C.
  destruct (list_eq_dec Z.eq_dec ids []) as [->|M]; [apply (K tick []); auto; intros ? []|].
  set (P := fun id t => exists n v x, Visit_of ps id n v /\ Visit_of ts id n x /\ visit_resource v = resource_id r /\
    enter v = t /\ enter x <= tick /\ Before tick (option_map (Z.add gap) (leave x))).
  destruct (latest P ids M) as (t & (last & _ & k & w & y & W & Y & E & <- & B & _) & L).
  { intros id H. destruct (C id H) as (n & x & X & E & T & B). destruct (A id n x X) as (v & V & F).
    exists (enter v), n, v, x. repeat split; auto. congruence. }
  apply (K (enter w) ids N). intros id H. destruct (L id H) as (u & (n & v & x & V & X & F & <- & T & D) & G).
  exists n, v. repeat split; auto. unfold Before. destruct (leave v) as [l|] eqn:Q; simpl; auto.
  destruct (Z.lt_ge_cases (enter w) (gap + l)) as [H'|H']; [exact H'|]. exfalso.
  destruct (O id n v last k w y) as (x' & X' & l' & Q' & G'); auto.
  - exists l. split; [exact Q | lia].
  - assert (x' = x) as -> by (apply (visit_is_unique ts id n); auto). rewrite Q' in D. simpl in D. lia.
Qed.

Section Safety.
Variables ps ts : list plan.
Hypothesis one_plan_each : NoDup (map plan_robot ps).
Hypothesis executed : Executes ps ts.

Lemma executed_once id n x y : Visit_of ts id n x -> Visit_of ts id n y -> x = y.
Proof. apply visit_is_unique, (robots_are_named_once ps ts executed). Qed.

Lemma room_stays_kept : Room_is_kept ps -> Room_is_kept ts.
Proof.
  intros K r tick ids R. revert tick ids. apply (order_keeps_room ps ts r).
  - exact (robots_are_named_once ps ts executed).
  - exact (visits_are_planned ps ts executed).
  - intros one m v other n w y V W E F. apply (order_is_kept ps ts executed one m v other n w y V W). congruence.
  - intros tick ids. apply K. exact R.
Qed.

Lemma moves_of_execution id r s tick : Makes_move ts id r s tick -> exists n v w y,
  Visit_of ps id n v /\ Visit_of ps id (S n) w /\ visit_resource v = r /\ visit_resource w = s /\
  Visit_of ts id (S n) y /\ enter y = tick.
Proof.
  intros (p & x & y & P & E & C & R & G & T). apply consecutive_by_number in C as (n & X & Y).
  destruct (visits_are_planned ps ts executed id n x) as (v & V & F); [exists p; auto|].
  destruct (visits_are_planned ps ts executed id (S n) y) as (w & W & H); [exists p; auto|].
  exists n, v, w, y. repeat split; auto; try congruence. exists p. auto.
Qed.

Lemma move_of_plans id n v w : Visit_of ps id n v -> Visit_of ps id (S n) w ->
  Makes_move ps id (visit_resource v) (visit_resource w) (enter w).
Proof.
  intros (p & P & E & V) (q & Q & F & W). assert (p = q) as <- by (apply (plan_of_robot_is_unique ps); congruence).
  exists p, v, w. repeat split; auto. apply consecutive_by_number. eauto.
Qed.

Lemma exchanges_stay_avoided : Swaps_are_avoided i ps -> Swaps_are_avoided i ts.
Proof.
  intros A one other r s tick N R Q M O.
  destruct (moves_of_execution one r s tick M) as (m & v & v' & x & V & V' & E & E' & X & <-).
  destruct (moves_of_execution other s r (enter x) O) as (n & w' & w & y & W' & W & F' & F & Y & T).
  pose proof (move_of_plans one m v v' V V') as MV. pose proof (move_of_plans other n w' w W' W) as MW.
  rewrite E, E' in MV. rewrite F, F' in MW. destruct (Z.lt_trichotomy (enter v') (enter w)) as [L|[L|L]].
  - destruct (exchange_order_is_kept ps ts executed one m v v' other n w w' y) as (z & Z0 & G); auto; try congruence.
    assert (z = x) by (apply (executed_once one (S m)); auto). subst z. lia.
  - rewrite L in MV. exact (A one other r s (enter w) N R Q MV MW).
  - destruct (exchange_order_is_kept ps ts executed other n w' w one m v' v x) as (z & Z0 & G); auto; try congruence.
    assert (z = y) by (apply (executed_once other (S n)); auto). subst z. lia.
Qed.
End Safety.

Lemma planned_once s : Lawful i s -> NoDup (map plan_robot (plans s)).
Proof.
  intros L. destruct (covers_robots i s L) as [N _]. unfold planned in N.
  induction (map plan_robot (plans s)) as [|x l IH]; [constructor|]. inversion N as [|? ? H K]; subst.
  constructor; auto. intros X. apply H, in_or_app. auto.
Qed.

(** An execution that keeps the order of a lawful solution breaks no joint rule, whatever its delays; without groups. *)
Theorem order_preserving_execution_is_safe s ts : groups i = [] -> Lawful i s -> Room_is_kept (plans s) ->
  Executes (plans s) ts -> Room_is_kept ts /\ Limits_are_kept i ts /\ Exchanges_are_avoided i ts.
Proof.
  intros G L K E. pose proof (planned_once s L) as N. pose proof (room_stays_kept (plans s) ts E K) as R.
  split; [exact R|]. split; [exact (room_keeps_limits ts G R)|]. apply (exchanges_without_groups i _ G).
  exact (exchanges_stay_avoided (plans s) ts N E (swaps_are_avoided i s L)).
Qed.
End Execution.
