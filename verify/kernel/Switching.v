(** Switching: robots enter places for one in another order than planned. Ticks that keep the switched edges break no
    joint rule, so an executor may switch whatever leaves the graph without a cycle. *)
Require Import ZArith List Bool Lia Sorted.
From Carproof Require Import Law Ways Execution Dependencies Order Waiting Retiming.
Import ListNotations.
Open Scope Z_scope.

Section Switching.
Variable i : instance.
Notation gap := (gap i).
Notation Room_is_kept := (Room_is_kept i).
Notation Left_before := (Left_before i).
Notation wait := (wait i).
Notation direct_waits := (direct_waits i).

(** A place in which the order of visits is given, first to last. *)
Record row := Row { row_place : Z; sequence : list (node * visit) }.

(** In a row each visit waits for the one before it. *)
Fixpoint queue (ps : list plan) (l : list (node * visit)) : list dependency :=
  match l with one :: (other :: _) as rest => wait ps one (fst other) :: queue ps rest | _ => [] end.

Definition has_row (rows : list row) (n : node * visit) : bool :=
  existsb (fun x => row_place x =? visit_resource (snd n)) rows.

(** The edges of the dependency graph if the visits to some places have another order. *)
Definition switched (ps : list plan) (rows : list row) : list dependency :=
  flat_map (travels i ps) (stays ps)
  ++ flat_map (fun one => flat_map (direct_waits ps one) (stays ps))
    (filter (fun n => negb (has_row rows n)) (stays ps))
  ++ flat_map (fun x => queue ps (sequence x)) rows.

(** A row holds all visits to a place for one robot at a time; only the last of them may be for ever. *)
Record Right_row (ps : list plan) (x : row) : Prop := {
  row_is_for_one : forall r, In r (resources i) -> resource_id r = row_place x -> capacity r = 1;
  row_holds_all_visits : forall n, In n (sequence x) <-> In n (stays ps) /\ visit_resource (snd n) = row_place x;
  nobody_parks_in_the_way : forall front n later, sequence x = front ++ n :: later -> later <> [] ->
    exists l, leave (snd n) = Some l
}.

Section Lawful.
Variable s : solution.
Hypothesis well_formed : Well_formed i.
Hypothesis lawful : Lawful i s.
Hypothesis room : Room_is_kept (plans s).
Notation ps := (plans s).
Notation timed := (timed i).
Let one_plan_each : NoDup (map plan_robot ps) := planned_once i s lawful.
Let needs_are_positive := needs_are_positive i s well_formed lawful.
Let timed_visit := timed_visit i s lawful.

Variables (rows : list row) (t : times).
Hypothesis rows_are_right : forall x, In x rows -> Right_row ps x.
Hypothesis edges_are_kept : forall e, In e (switched ps rows) -> Keeps t e.

(** The one goes first: it leaves, and the other keeps its edge. *)
Definition Goes_first (m n : node * visit) : Prop :=
  In m (stays ps) /\ In n (stays ps) /\ (exists l, leave (snd m) = Some l) /\ Keeps t (wait ps m (fst n)).

Lemma travel_is_kept id n v w : Visit_of ps id n v -> Visit_of ps id (S n) w -> t (id, n) + 1 <= t (id, S n).
Proof.
  intros V W. pose proof (needs_are_positive id n v V).
  enough (K : Keeps t (Dependency (id, n) (next (id, n)) (needs i id (visit_resource v)) true)).
  { unfold Keeps, next in K. simpl in K. lia. }
  apply edges_are_kept. unfold switched. apply in_or_app. left. apply in_flat_map. exists ((id, n), v).
  split; [apply in_stays; exact V|]. unfold travels.
  rewrite (proj2 (visit_at_iff ps (next (id, n)) w one_plan_each) W). left. reflexivity.
Qed.

(** Who goes first has left when the other enters. *)
Lemma first_has_left m v n w x y : Goes_first (m, v) (n, w) ->
  Visit_of (timed t ps) (fst m) (snd m) x -> Visit_of (timed t ps) (fst n) (snd n) y ->
  exists l, leave x = Some l /\ l + (if is_opposite ps m n then 1 else gap) <= enter y /\ enter x < l.
Proof.
  intros (M & N & (k & D) & K) X Y. apply in_stays in M, N. simpl in M, N, D, K.
  destruct (timed_visit _ _ _ _ Y) as (_ & _ & _ & T & _).
  destruct (timed_visit _ _ _ _ X) as (v0 & V0 & _ & U & [[(w0 & W0) L]|[L E]]).
  - exists (t (fst m, S (snd m))). split; [exact L|]. rewrite T, U.
    pose proof (travel_is_kept _ _ v0 w0 V0 W0). unfold wait, Order.wait in K.
    rewrite (proj2 (visit_at_iff ps (next m) w0 one_plan_each) W0) in K. unfold Keeps, next in K. simpl in K.
    destruct n as [b j]. simpl in *. lia.
  - assert (v0 = v) as -> by eauto using visit_is_unique. rewrite D in E. simpl in E.
    exists (enter x + needs i (fst m) (visit_resource v)). split; [exact E|].
    pose proof (needs_are_positive _ _ v V0). unfold wait, Order.wait in K.
    rewrite (proj2 (visit_at_none ps (next m) one_plan_each) L) in K. unfold Keeps in K. simpl in K.
    destruct (is_opposite ps m n) eqn:O.
    + apply (is_opposite_iff ps one_plan_each) in O as (j & v' & _ & _ & V' & _). destruct (L v' V').
    + rewrite T, U. destruct m as [a j], n as [b h]. simpl in *. lia.
Qed.

Lemma entered m v : In (m, v) (stays ps) -> exists x, Visit_of (timed t ps) (fst m) (snd m) x /\ enter x = t m.
Proof.
  intros M. apply in_stays in M. simpl in M. destruct (visit_timed i s lawful t _ _ _ M) as (x & X & T). exists x.
  split; [exact X|]. destruct m. exact T.
Qed.

Lemma going_first_is_transitive m k n : Goes_first m k -> Goes_first k n -> Goes_first m n.
Proof.
  destruct m as [m v], k as [k u], n as [n w]. intros A B. pose proof A as A'. pose proof B as B'.
  destruct A as (M & K & D & Q), B as (_ & N & _ & P).
  destruct (entered m v M) as (x & X & XT), (entered k u K) as (y & Y & YT), (entered n w N) as (z & Z0 & ZT).
  destruct (first_has_left _ _ _ _ _ _ A' X Y) as (l & L & H & _).
  destruct (first_has_left _ _ _ _ _ _ B' Y Z0) as (l' & L' & H' & G').
  split; [exact M|]. split; [exact N|]. split; [exact D|]. simpl in *.
  assert (0 <= gap <= 1) by (unfold Law.gap; destruct (following_is_forbidden i); lia).
  assert (J : forall a b : bool, (if a then 1 else gap) <= (if b then 1 else gap) + 1) by (intros [] []; lia).
  unfold Keeps, Order.wait in *. destruct (visit_at ps (next m)); simpl in *.
  - specialize (J (is_opposite ps m n) (is_opposite ps m k)).
    destruct (is_opposite ps m n), (is_opposite ps m k), (is_opposite ps k n); lia.
  - destruct (is_opposite ps m k), (is_opposite ps k n); lia.
Qed.

(** Of two visits in a row one goes first. *)
Lemma one_goes_first x m n : In x rows -> In m (sequence x) -> In n (sequence x) -> fst m <> fst n ->
  Goes_first m n \/ Goes_first n m.
Proof.
  intros X. pose proof (rows_are_right x X) as R.
  assert (Q : forall e, In e (queue ps (sequence x)) -> Keeps t e).
  { intros e E. apply edges_are_kept. unfold switched. apply in_or_app. right. apply in_or_app. right.
    apply in_flat_map. exists x. auto. }
  assert (S0 : StronglySorted Goes_first (sequence x)).
  { apply Sorted_StronglySorted; [intros a b c; apply going_first_is_transitive|].
    pose proof (nobody_parks_in_the_way ps x R) as P. pose proof (fun n => proj1 (row_holds_all_visits ps x R n)) as A.
    revert P A Q. generalize (sequence x) as l. clear. induction l as [|a l IH]; intros P A Q; constructor.
    - apply IH.
      + intros front n later ->. apply (P (a :: front)). reflexivity.
      + intros n N. apply A. right. exact N.
      + intros e E. apply Q. destruct l; [destruct E | right; exact E].
    - destruct l as [|b l]; constructor. split; [apply A; left; reflexivity|].
      split; [apply A; right; left; reflexivity|]. split; [apply (P [] a (b :: l)); [reflexivity | discriminate]|].
      apply Q. left. reflexivity. }
  intros M N D. clear - S0 M N D. induction S0 as [|a l S0 IH F]; [destruct M|]. rewrite Forall_forall in F.
  destruct M as [->|M], N as [->|N]; [congruence | left | right | ]; auto.
Qed.

(** A visit to a place without a row goes before those that it went before by the plans. *)
Lemma order_is_unchanged m v n w : In (m, v) (stays ps) -> In (n, w) (stays ps) ->
  visit_resource v = visit_resource w -> Left_before v w -> has_row rows (m, v) = false -> Goes_first (m, v) (n, w).
Proof.
  intros M N E L H. split; [exact M|]. split; [exact N|]. split; [destruct L as (l & L & _); eauto|].
  destruct (way_along_direct_edges i s well_formed lawful (switched ps rows) (visit_resource v)
    (Z.to_nat (enter w - enter v))) with (one := (m, v)) (other := (n, w)) as (k & K & W); auto.
  - intros u U e F. apply in_or_app. left. apply in_flat_map. eauto.
  - intros one other A B P e F. apply in_or_app. right. apply in_or_app. left. apply in_flat_map. exists one.
    split; [|apply in_flat_map; eauto]. apply filter_In. split; [exact A|]. unfold has_row in *. rewrite P. simpl in H.
    rewrite H. reflexivity.
  - simpl. lia.
  - pose proof (ways_are_kept _ t _ _ k edges_are_kept W). unfold Keeps. rewrite wait_ends. simpl in *. lia.
Qed.

Lemma row_or_none place : (exists x, In x rows /\ row_place x = place) \/
  forall m v, visit_resource v = place -> has_row rows (m, v) = false.
Proof.
  destruct (existsb (fun x => row_place x =? place) rows) eqn:E.
  - left. apply existsb_exists in E as (x & X & E). apply Z.eqb_eq in E. eauto.
  - right. intros m v <-. exact E.
Qed.

Lemma timed_once : NoDup (map plan_robot (timed t ps)).
Proof. rewrite robots_of_timed. exact one_plan_each. Qed.

Lemma room_in_switched_order : Room_is_kept (timed t ps).
Proof.
  intros r tick ids R. revert tick ids.
  assert (G : 0 <= gap <= 1) by (unfold Law.gap; destruct (following_is_forbidden i); lia).
  destruct (row_or_none (resource_id r)) as [(x & X & P)|U].
  - intros tick ids N C. rewrite (row_is_for_one ps x (rows_are_right x X) r R (eq_sym P)).
    destruct ids as [|a [|b ids]]; simpl; [lia | lia | exfalso].
    assert (D : a <> b) by (inversion N as [|? ? H _]; subst; intros ->; apply H; left; reflexivity).
    destruct (C a) as (m & y & Y & E & T & B); [left; reflexivity|].
    destruct (C b) as (n & z & Z0 & F & T' & B'); [right; left; reflexivity|].
    destruct (timed_visit _ _ _ _ Y) as (v & V & K & _), (timed_visit _ _ _ _ Z0) as (w & W & L & _).
    destruct (one_goes_first x ((a, m), v) ((b, n), w) X) as [O|O].
    + apply (row_holds_all_visits ps x (rows_are_right x X)). split; [apply in_stays; exact V | simpl; congruence].
    + apply (row_holds_all_visits ps x (rows_are_right x X)). split; [apply in_stays; exact W | simpl; congruence].
    + simpl. congruence.
    + destruct (first_has_left _ _ _ _ _ _ O Y Z0) as (l & H & J & _). rewrite H in B. simpl in B.
      destruct (is_opposite ps (a, m) (b, n)); lia.
    + destruct (first_has_left _ _ _ _ _ _ O Z0 Y) as (l & H & J & _). rewrite H in B'. simpl in B'.
      destruct (is_opposite ps (b, n) (a, m)); lia.
  - apply (order_keeps_room i ps (timed t ps) r timed_once).
    + intros id n x X. destruct (timed_visit _ _ _ _ X) as (v & V & E & _). eauto.
    + intros one m v other n w y V W E F L Y.
      assert (O : Goes_first ((one, m), v) ((other, n), w)).
      { apply order_is_unchanged; auto; try (apply in_stays; assumption). congruence. }
      destruct (visit_timed i s lawful t _ _ _ V) as (x & X & _). exists x. split; [exact X|].
      destruct (first_has_left _ _ _ _ _ _ O X Y) as (l & H & J & _). exists l. split; [exact H|].
      destruct (is_opposite ps (one, m) (other, n)); lia.
    + intros tick ids. apply room. exact R.
Qed.

(** Where the order is given by a row, or by plans that make these moves at different ticks, nobody exchanges places. *)
Lemma no_exchange_here one m v v' other n w w' : one <> other ->
  Visit_of ps one m v -> Visit_of ps one (S m) v' -> Visit_of ps other n w' -> Visit_of ps other (S n) w ->
  visit_resource v = visit_resource w -> visit_resource v' = visit_resource w' ->
  (exists x, In x rows /\ row_place x = visit_resource v) \/ Goes_first ((one, m), v) ((other, S n), w) ->
  t (one, S m) <> t (other, S n).
Proof.
  intros D V V' W' W E F H T.
  destruct (visit_timed i s lawful t _ _ _ V) as (x & X & XT), (visit_timed i s lawful t _ _ _ W) as (y & Y & YT).
  assert (G : 0 <= gap) by (unfold Law.gap; destruct (following_is_forbidden i); lia).
  pose proof (travel_is_kept one m v v' V V') as K.
  assert (A : Goes_first ((one, m), v) ((other, S n), w) -> False).
  { intros O. assert (P : is_opposite ps (one, m) (other, S n) = true).
    { apply (is_opposite_iff ps one_plan_each). simpl. eauto 7. }
    destruct (first_has_left _ _ _ _ _ _ O X Y) as (l & L & J & _). rewrite P in J.
    destruct (timed_visit _ _ _ _ X) as (u & U & _ & _ & [[_ M]|[M _]]); [|exact (M v' V')].
    rewrite L in M. injection M as ->. lia. }
  destruct H as [(r & R & P)|H]; [|exact (A H)].
  destruct (one_goes_first r ((one, m), v) ((other, S n), w) R) as [O|O].
  - apply (row_holds_all_visits ps r (rows_are_right r R)). split; [apply in_stays; exact V | simpl; congruence].
  - apply (row_holds_all_visits ps r (rows_are_right r R)). split; [apply in_stays; exact W | simpl; congruence].
  - simpl. congruence.
  - exact (A O).
  - destruct (first_has_left _ _ _ _ _ _ O Y X) as (l & L & J & I).
    destruct (is_opposite ps (other, S n) (one, m)); lia.
Qed.

Lemma exchanges_in_switched_order : Swaps_are_avoided i (timed t ps).
Proof.
  intros one other r q tick D R Q M N.
  assert (A : forall id r q, Makes_move (timed t ps) id r q tick -> exists n v w, Visit_of ps id n v /\
    Visit_of ps id (S n) w /\ visit_resource v = r /\ visit_resource w = q /\ t (id, S n) = tick).
  { intros id r' q' (p & x & y & P & E & C & F & G & T). apply consecutive_by_number in C as (n & X & Y).
    destruct (timed_visit t id n x) as (v & V & K & _); [exists p; auto|].
    destruct (timed_visit t id (S n) y) as (w & W & L & U & _); [exists p; auto|].
    exists n, v, w. repeat split; auto; congruence. }
  destruct (A _ _ _ M) as (m & v & v' & V & V' & E & E' & T), (A _ _ _ N) as (n & w' & w & W' & W & F' & F & T').
  assert (there : visit_resource v = visit_resource w) by congruence.
  assert (back : visit_resource w' = visit_resource v') by congruence.
  assert (G : 0 <= gap <= 1) by (unfold Law.gap; destruct (following_is_forbidden i); lia).
  assert (H : (exists x, In x rows /\ row_place x = visit_resource v) \/ Goes_first ((one, m), v) ((other, S n), w) ->
    False).
  { intros H. apply (no_exchange_here one m v v' other n w w' D V V' W' W there (eq_sym back) H). congruence. }
  assert (I : (exists x, In x rows /\ row_place x = visit_resource w') \/
    Goes_first ((other, n), w') ((one, S m), v') -> False).
  { intros I. apply (no_exchange_here other n w' w one m v' v (not_eq_sym D) W' W V V' back (eq_sym there) I).
    congruence. }
  destruct (row_or_none (visit_resource v)) as [X|X]; [tauto|].
  destruct (row_or_none (visit_resource w')) as [Y|Y]; [tauto|].
  destruct (Z.lt_trichotomy (enter v') (enter w)) as [L|[L|L]].
  - apply H. right. apply order_is_unchanged; auto; try (apply in_stays; assumption).
    exists (enter v'). split; [exact (leaves_as_it_moves i s lawful one m v v' V V') | lia].
  - pose proof (move_of_plans ps one_plan_each one m v v' V V') as MV.
    pose proof (move_of_plans ps one_plan_each other n w' w W' W) as MW.
    rewrite E, E', L in MV. rewrite F, F' in MW. exact (swaps_are_avoided i s lawful one other r q _ D R Q MV MW).
  - apply I. right. apply order_is_unchanged; auto; try (apply in_stays; assumption).
    exists (enter w). split; [exact (leaves_as_it_moves i s lawful other n w' w W' W) | lia].
Qed.
End Lawful.

(** Ticks that keep the edges of a lawful solution, with other orders in places for one, make plans that break no joint
    rule; without groups. *)
Theorem switched_order_is_safe s rows t : groups i = [] -> Well_formed i -> Lawful i s -> Room_is_kept (plans s) ->
  (forall x, In x rows -> Right_row (plans s) x) -> (forall e, In e (switched (plans s) rows) -> Keeps t e) ->
  Room_is_kept (timed i t (plans s)) /\ Limits_are_kept i (timed i t (plans s)) /\
  Exchanges_are_avoided i (timed i t (plans s)).
Proof.
  intros G W L K R E. assert (F : Room_is_kept (timed i t (plans s))) by (eapply room_in_switched_order; eauto).
  split; [exact F|]. split; [exact (room_keeps_limits i _ G F)|]. apply (exchanges_without_groups i _ G).
  eapply exchanges_in_switched_order; eauto.
Qed.
End Switching.
