(** Prices of resources and exchanges, and why the robots of a lawful solution together pay no more than the prices
    times the capacities. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Ways.
Import ListNotations.
Open Scope Z_scope.

(** * Sums *)

Definition sum {A} (f : A -> Z) (l : list A) : Z := fold_right (fun x total => f x + total) 0 l.

Lemma sum_is_monotone {A} (f g : A -> Z) l : (forall x, In x l -> f x <= g x) -> sum f l <= sum g l.
Proof.
  induction l as [| x l IH]; simpl; intros H; [lia |].
  pose proof (H x (or_introl eq_refl)). assert (sum f l <= sum g l) by auto. lia.
Qed.

Lemma sum_of_equal {A} (f g : A -> Z) l : (forall x, In x l -> f x = g x) -> sum f l = sum g l.
Proof. intros H. apply Z.le_antisymm; apply sum_is_monotone; intros x Hx; rewrite (H x Hx); lia. Qed.

Lemma sum_of_sums {A} (f g : A -> Z) l : sum (fun x => f x + g x) l = sum f l + sum g l.
Proof. induction l as [| x l IH]; simpl; lia. Qed.

Lemma sum_of_multiples {A} (f : A -> Z) k l : sum (fun x => k * f x) l = k * sum f l.
Proof. induction l as [| x l IH]; simpl; lia. Qed.

Lemma sum_of_zeros {A} (l : list A) : sum (fun _ => 0) l = 0.
Proof. induction l; simpl; lia. Qed.

Lemma sum_is_not_negative {A} (f : A -> Z) l : (forall x, In x l -> 0 <= f x) -> 0 <= sum f l.
Proof. intros H. rewrite <- (sum_of_zeros l). apply sum_is_monotone, H. Qed.

Lemma sums_are_exchanged {A B} (f : A -> B -> Z) l m :
  sum (fun x => sum (f x) m) l = sum (fun y => sum (fun x => f x y) l) m.
Proof.
  induction l as [| x l IH]; simpl; [symmetry; apply sum_of_zeros |].
  rewrite IH. symmetry. apply (sum_of_sums (f x)).
Qed.

(** * What prices are paid for *)

(** A price of being in the resource [place] at the tick; or, with another resource, of their exchange at the tick. *)
Record price := Price { place : Z; other : option Z; tick : Z; amount : Z }.

Definition is_before (t : Z) (end_ : option Z) : bool := match end_ with Some l => t <? l | None => true end.

(** A visit pays the price of its resource at each of its ticks, and that of an exchange at each but the first. *)
Definition visit_pays (x : price) (v : visit) : bool :=
  (visit_resource v =? place x) && is_before (tick x) (leave v) &&
  match other x with None => enter v <=? tick x | Some _ => enter v <? tick x end.

Definition moves_at (r s t : Z) (v w : visit) : bool :=
  (visit_resource v =? r) && (visit_resource w =? s) && (enter w =? t).

Lemma makes_the_move r s t v w :
  moves_at r s t v w = true -> visit_resource v = r /\ visit_resource w = s /\ enter w = t.
Proof. unfold moves_at. rewrite !andb_true_iff, !Z.eqb_eq. tauto. Qed.

(** A move pays the price of an exchange that it would be a part of, in either direction. *)
Definition move_pays (x : price) (v w : visit) : bool :=
  match other x with
  | None => false
  | Some s => moves_at (place x) s (tick x) v w || moves_at s (place x) (tick x) v w
  end.

Definition visit_paid (xs : list price) (v : visit) : Z := sum (fun x => amount x * Z.b2z (visit_pays x v)) xs.
Definition move_paid (xs : list price) (v w : visit) : Z := sum (fun x => amount x * Z.b2z (move_pays x v w)) xs.

(** What the visits and the moves between them pay together. *)
Fixpoint paid (xs : list price) (vs : list visit) : Z :=
  match vs with
  | [] => 0
  | v :: rest => visit_paid xs v + match rest with [] => 0 | w :: _ => move_paid xs v w end + paid xs rest
  end.

(** The capacity of the resource of the id. *)
Definition room (i : instance) (id : Z) : Z :=
  match find (fun r => resource_id r =? id) (resources i) with Some r => capacity r | None => 0 end.

(** The prices times the capacities. *)
Definition worth (i : instance) (xs : list price) : Z := sum (fun x => amount x * room i (place x)) xs.

(** A price of being in one of the resources of a group at the tick. *)
Record group_price := Group_price { priced_group : Z; group_tick : Z; group_amount : Z }.

Definition group_of (i : instance) (x : group_price) : option group :=
  find (fun g => group_id g =? priced_group x) (groups i).

(** Who is in a resource pays the prices of its groups. *)
Definition prices_within (i : instance) (x : group_price) : list price :=
  match group_of i x with
  | Some g => map (fun r => Price r None (group_tick x) (group_amount x)) (group_resources g)
  | None => []
  end.

Definition group_room (i : instance) (x : group_price) : Z :=
  match group_of i x with Some g => group_capacity g | None => 0 end.

Lemma prices_within_are_right i x y : Well_formed i -> 0 <= group_amount x -> In y (prices_within i x) ->
  0 <= amount y /\ In (place y) (resource_ids i) /\ match other y with Some r => In r (resource_ids i) | None => True end.
Proof.
  intros right A H. unfold prices_within in H. destruct (group_of i x) as [g |] eqn:G; [| destruct H].
  apply find_some in G as [Hg _]. apply in_map_iff in H as (r & <- & Hr). simpl. repeat split; auto.
  apply (groups_are_of_the_graph i right g r Hg Hr).
Qed.

(** * How often a plan pays a price *)

Fixpoint times (x : price) (vs : list visit) : Z :=
  match vs with
  | [] => 0
  | v :: rest =>
      Z.b2z (visit_pays x v) + match rest with [] => 0 | w :: _ => Z.b2z (move_pays x v w) end + times x rest
  end.

Lemma paid_is_by_price xs vs : paid xs vs = sum (fun x => amount x * times x vs) xs.
Proof.
  assert (Z0 : 0 = sum (fun x => amount x * 0) xs) 
    by (symmetry; etransitivity; [apply sum_of_equal | apply (sum_of_zeros xs)]; intros; simpl; lia).
  induction vs as [| v rest IH]; [exact Z0 |]. cbn [paid times]. rewrite IH. unfold visit_paid, move_paid.
  destruct rest as [| w later]; rewrite ?Z.add_0_r, <- !sum_of_sums; apply sum_of_equal; intros; lia.
Qed.

Lemma paid_of_joined xs ys vs : paid (xs ++ ys) vs = paid xs vs + paid ys vs.
Proof.
  rewrite !paid_is_by_price. induction xs as [| x xs IH]; simpl; [lia |]. rewrite IH. lia.
Qed.

Lemma times_from_the_second_visit_on x v w later :
  times x (v :: w :: later) = Z.b2z (visit_pays x v) + Z.b2z (move_pays x v w) + times x (w :: later).
Proof. reflexivity. Qed.

Lemma times_is_not_negative x vs : 0 <= times x vs.
Proof.
  induction vs as [| v rest IH]; cbn [times]; [lia |].
  destruct rest as [| w later], (visit_pays x v); try destruct (move_pays x v w); simpl Z.b2z; lia.
Qed.

Lemma one_place_at_most r ids : NoDup ids -> sum (fun id => Z.b2z (r =? id)) ids <= 1.
Proof.
  intros N. induction N as [| id ids Hid N IH]; simpl; [lia |]. destruct (Z.eqb_spec r id) as [-> |]; [| simpl; lia].
  rewrite (sum_of_equal _ (fun _ => 0)); [rewrite sum_of_zeros; simpl; lia |].
  intros x Hx. destruct (Z.eqb_spec id x) as [-> |]; [contradiction | reflexivity].
Qed.

Ltac split_bools := repeat match goal with
  | H : _ && _ = true |- _ => apply andb_true_iff in H as [? ?]
  | H : (_ =? _) = true |- _ => apply Z.eqb_eq in H
  | H : (_ <=? _) = true |- _ => apply Z.leb_le in H
  | H : (_ <? _) = true |- _ => apply Z.ltb_lt in H
  end.

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).

(** Nothing is paid for a tick before the first visit; for an exchange, nothing either at the tick of entering it. *)
Lemma later_visits_pay_nothing x vs : Way i a vs -> forall w rest, vs = w :: rest ->
  (match other x with None => tick x < enter w | Some _ => tick x <= enter w end) -> times x vs = 0.
Proof.
  intros H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH]; intros u rest E T; injection E as <- <-.
  - cbn [times]. unfold visit_pays. destruct (other x); [destruct (Z.ltb_spec (enter v) (tick x)) |
      destruct (Z.leb_spec (enter v) (tick x))]; try lia; rewrite andb_false_r; reflexivity.
  - pose proof (need_is_positive i a right known (visit_resource v)).
    assert (IHw : times x (w :: later) = 0) by (apply (IH w later eq_refl); destruct (other x); lia).
    rewrite times_from_the_second_visit_on, IHw. unfold visit_pays, move_pays, moves_at.
    destruct (other x); [destruct (Z.ltb_spec (enter v) (tick x)), (Z.eqb_spec (enter w) (tick x)) |
      destruct (Z.leb_spec (enter v) (tick x))]; try lia; rewrite !andb_false_r; reflexivity.
Qed.

Lemma price_is_paid_once x vs : Way i a vs -> times x vs <= 1.
Proof.
  intros H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH].
  - cbn [times]. destruct (visit_pays x v); simpl Z.b2z; lia.
  - pose proof (later_visits_pay_nothing x (w :: later) Hw w later eq_refl) as Later.
    pose proof (need_is_positive i a right known (visit_resource v)).
    rewrite times_from_the_second_visit_on. destruct (visit_pays x v) eqn:Pays.
    + unfold visit_pays in Pays. rewrite Hl in Pays. simpl in Pays. split_bools.
      assert (N : move_pays x v w = false).
      { unfold move_pays, moves_at. destruct (other x); auto. destruct (Z.eqb_spec (enter w) (tick x)); [lia |].
        rewrite !andb_false_r. reflexivity. }
      rewrite N, Later; [simpl Z.b2z; lia | destruct (other x); lia].
    + destruct (move_pays x v w) eqn:Moves; [| simpl Z.b2z; lia].
      unfold move_pays in Moves. destruct (other x); [| discriminate]. rewrite Later; [simpl Z.b2z; lia |].
      unfold moves_at in Moves. apply orb_true_iff in Moves as [M | M]; split_bools; lia.
Qed.

(** A robot is in one resource at a time: of the same price in different resources it pays one. *)
Lemma one_of_many_places_is_paid t n ids vs : NoDup ids -> Way i a vs ->
  sum (fun r => times (Price r None t n) vs) ids <= 1.
Proof.
  intros N H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH].
  - apply Z.le_trans with (sum (fun r => Z.b2z (visit_resource v =? r)) ids).
    + apply sum_is_monotone. intros r _. cbn [times]. unfold visit_pays. cbn [place other tick].
      destruct (visit_resource v =? r), (is_before _ _), (enter v <=? t); simpl Z.b2z; lia.
    + apply one_place_at_most, N.
  - destruct (enter w <=? t) eqn:Later.
    + rewrite (sum_of_equal _ (fun r => times (Price r None t n) (w :: later))); [exact IH |].
      intros r _. rewrite times_from_the_second_visit_on. unfold visit_pays, move_pays. rewrite Hl.
      cbn [place other tick is_before]. apply Z.leb_le in Later. destruct (Z.ltb_spec t (enter w)); [lia |].
      rewrite andb_false_r. reflexivity.
    + apply Z.leb_gt in Later.
      apply Z.le_trans with (sum (fun r => Z.b2z (visit_resource v =? r)) ids); [| apply one_place_at_most, N].
      apply sum_is_monotone. intros r _. rewrite times_from_the_second_visit_on.
      rewrite (later_visits_pay_nothing (Price r None t n) (w :: later) Hw w later eq_refl) by exact Later.
      unfold visit_pays, move_pays. cbn [place other tick].
      destruct (visit_resource v =? r), (is_before _ _), (enter v <=? t); simpl Z.b2z; lia.
Qed.

(** Who pays for a resource is there; who pays for an exchange stays there from just before, or moves. *)
Lemma who_pays_visits_or_moves x vs : 0 < times x vs ->
  (exists v, In v vs /\ visit_pays x v = true) \/
  (exists before v w later, vs = before ++ v :: w :: later /\ move_pays x v w = true).
Proof.
  induction vs as [| v rest IH]; [simpl; lia |]. intros H.
  destruct (visit_pays x v) eqn:V; [left; exists v; simpl; auto |].
  destruct rest as [| w later]; [simpl in H; rewrite V in H; simpl in H; lia |].
  destruct (move_pays x v w) eqn:M; [right; exists [], v, w, later; auto |].
  rewrite times_from_the_second_visit_on, V, M in H.
  destruct IH as [(u & Hin & Hu) | (before & u & u' & rest & E & Hu)]; [exact H | |].
  - left. exists u. simpl. auto.
  - right. exists (v :: before), u, u', rest. rewrite E. auto.
Qed.

(** Who makes a move holds its source just before, and its target from then on. *)
Lemma mover_holds_both before v w later : Way i a (before ++ v :: w :: later) ->
  Holds v (enter w - 1) /\ Holds w (enter w).
Proof.
  intros H. apply way_has_ways in H; [| discriminate].
  inversion H as [| v' w' rest Hl Hn Hm Hw]; subst. split.
  - unfold Holds. rewrite Hl. simpl. pose proof (need_is_positive i a right known (visit_resource v)). lia.
  - apply (first_visit_holds_its_entry i a right known w later Hw).
Qed.

End Robot.

(** * All robots together *)

Section Solution.
Variables (i : instance) (s : solution).
Hypothesis right : Well_formed i.
Hypothesis lawful : Lawful i s.

Lemma planned_robot_is_known p : In p (plans s) -> exists a, In a (robots i) /\ robot_id a = plan_robot p.
Proof.
  intros H. destruct (covers_robots i s lawful) as [_ C].
  assert (K : In (plan_robot p) (robot_ids i)) by (apply C, in_or_app; left; apply in_map, H).
  apply in_map_iff in K as (a & E & Ha). eauto.
Qed.

Lemma plan_is_a_way p : In p (plans s) -> exists a, In a (robots i) /\ robot_id a = plan_robot p /\ Way i a (visits p).
Proof.
  intros H. destruct (planned_robot_is_known p H) as (a & Ha & E). exists a. split; [| split]; auto.
  apply lawful_plan_is_a_way; auto. apply (plans_lawful i s lawful p a); auto.
Qed.

Lemma robots_have_one_plan : NoDup (planned s).
Proof.
  destruct (covers_robots i s lawful) as [N _]. induction (planned s) as [| p ps IH]; [constructor |].
  inversion N as [| ? ? Hn Hd]; subst. constructor; auto. intros H. apply Hn, in_or_app. auto.
Qed.

Lemma room_is_capacity r : In r (resources i) -> room i (resource_id r) = capacity r.
Proof. intros H. unfold room. rewrite resource_is_found; auto. Qed.

(** Plans whose robots all occupy a resource at a tick are no more than there is room. *)
Lemma occupants_have_room ps id t : In id (resource_ids i) -> NoDup (map plan_robot ps) ->
  (forall p, In p ps -> Occupies (plans s) (plan_robot p) id t) -> Z.of_nat (length ps) <= room i id.
Proof.
  intros Hid N H. apply in_map_iff in Hid as (r & <- & Hr). rewrite room_is_capacity by auto.
  rewrite <- (map_length plan_robot). apply (capacity_is_kept i s lawful r t); auto.
  intros robot Hin. apply in_map_iff in Hin as (p & <- & Hp). apply H, Hp.
Qed.

Definition payers (x : price) : list plan := filter (fun p => 0 <? times x (visits p)) (plans s).

Lemma payer_pays x p : In p (payers x) -> In p (plans s) /\ 0 < times x (visits p).
Proof. intros H. apply filter_In in H as [Hp Ht]. split_bools. auto. Qed.

Lemma payers_are_different x : NoDup (map plan_robot (payers x)).
Proof.
  pose proof robots_have_one_plan as N. unfold payers, planned in *.
  induction (plans s) as [| p ps IH]; simpl in *; auto.
  inversion N as [| ? ? Hn Hd]; subst. destruct (0 <? times x (visits p)); simpl; auto. constructor; auto.
  intros H. apply Hn. apply in_map_iff in H as (q & E & Hq). apply filter_In in Hq as [Hq _].
  apply in_map_iff. eauto.
Qed.

Lemma holding_visit_occupies p v t : In p (plans s) -> In v (visits p) -> Holds v t ->
  Occupies (plans s) (plan_robot p) (visit_resource v) t.
Proof. intros. exists p, v. auto. Qed.

Lemma before_is_right t end_ : is_before t end_ = true <-> Before t end_.
Proof. destruct end_; simpl; [apply Z.ltb_lt | tauto]. Qed.

Lemma paying_visit_holds x v : visit_pays x v = true ->
  visit_resource v = place x /\ Holds v (tick x) /\ (other x <> None -> Holds v (tick x - 1)).
Proof.
  unfold visit_pays. intros H. apply andb_true_iff in H as [H Enter]. apply andb_true_iff in H as [Place Leave].
  apply before_is_right in Leave. apply Z.eqb_eq in Place. unfold Holds, Before in *.
  destruct (other x), (leave v); split_bools; repeat split; auto; try congruence; intros; lia.
Qed.

(** Somebody makes the move, or nobody does. *)
Lemma move_is_made_or_not r r' t ps : (forall p, In p ps -> In p (plans s)) ->
  (exists id, Makes_move (plans s) id r r' t) \/
  (forall p before v w later, In p ps -> visits p = before ++ v :: w :: later -> moves_at r r' t v w = false).
Proof.
  induction ps as [| p ps IH]; intros Hps; [right; intros ? ? ? ? ? [] |].
  destruct IH as [IH | IH]; [intros; apply Hps; right; auto | auto |].
  assert (D : (exists before v w later, visits p = before ++ v :: w :: later /\ moves_at r r' t v w = true) \/
              (forall before v w later, visits p = before ++ v :: w :: later -> moves_at r r' t v w = false)).
  { clear -p. induction (visits p) as [| v vs [(before & u & w & later & E & M) | N]].
    - right. intros [|]; discriminate.
    - left. exists (v :: before), u, w, later. rewrite E. auto.
    - destruct vs as [| w later]; [right; intros [| ? [|]]; discriminate |].
      destruct (moves_at r r' t v w) eqn:M; [left; exists [], v, w, later; auto |].
      right. intros [| x before] u u' rest E; [injection E as <- <- <-; auto | injection E as _ E; eauto]. }
  destruct D as [(before & v & w & later & E & M) | N].
  - left. exists (plan_robot p), p, v, w. apply makes_the_move in M as (V & W & T). repeat split; auto.
    + apply Hps. left. auto.
    + exists before, later. exact E.
  - right. intros q before v w later [<- | Hq]; eauto.
Qed.

Lemma mover_occupies p before v w later : In p (plans s) -> visits p = before ++ v :: w :: later ->
  Occupies (plans s) (plan_robot p) (visit_resource v) (enter w - 1) /\
  Occupies (plans s) (plan_robot p) (visit_resource w) (enter w).
Proof.
  intros Hp E. destruct (plan_is_a_way p Hp) as (a & Ha & _ & W). rewrite E in W.
  destruct (mover_holds_both i a right Ha before v w later W) as [Hv Hw].
  split; apply holding_visit_occupies; auto; rewrite E; apply in_or_app; simpl; auto.
Qed.

(** No more robots pay a price than there is room in its resource. *)
Lemma payers_have_room x : In (place x) (resource_ids i) ->
  match other x with Some r => In r (resource_ids i) | None => True end ->
  Z.of_nat (length (payers x)) <= room i (place x).
Proof.
  intros Hr Ho.
  assert (Stays : forall p v, In p (plans s) -> In v (visits p) -> visit_pays x v = true ->
    Occupies (plans s) (plan_robot p) (place x) (tick x) /\
    (other x <> None -> Occupies (plans s) (plan_robot p) (place x) (tick x - 1))).
  { intros p v Hp Hv V. apply paying_visit_holds in V as (<- & H1 & H2).
    split; [| intros N; specialize (H2 N)]; apply holding_visit_occupies; auto. }
  destruct (other x) as [r |] eqn:Other.
  - destruct (move_is_made_or_not (place x) r (tick x) (plans s) (fun _ H => H)) as [(mover & M) | N].
    + apply occupants_have_room with (t := tick x - 1); auto using payers_are_different.
      intros p Hp. apply payer_pays in Hp as [Hp T].
      destruct (who_pays_visits_or_moves x (visits p) T) as [(v & Hv & V) | (before & v & w & later & E & Mv)].
      * apply (Stays p v); auto. discriminate.
      * unfold move_pays in Mv. rewrite Other in Mv.
        destruct (mover_occupies p before v w later Hp E) as [Hv Hw].
        apply orb_true_iff in Mv as [Mv | Mv]; apply makes_the_move in Mv as (V & W & T').
        { rewrite <- V, <- T'. exact Hv. }
        destruct (Z.eq_dec mover (plan_robot p)) as [Same | Different].
        -- destruct M as (q & v' & w' & Hq & <- & (first & rest & C) & S1 & S2 & S3).
           destruct (mover_occupies q first v' w' rest Hq C) as [Hv' _]. rewrite S1, S3, Same in Hv'. exact Hv'.
        -- destruct (swaps_are_avoided i s lawful mover (plan_robot p) (place x) r (tick x)); auto.
           exists p, v, w. repeat split; auto. exists before, later. auto.
    + apply occupants_have_room with (t := tick x); auto using payers_are_different.
      intros p Hp. apply payer_pays in Hp as [Hp T].
      destruct (who_pays_visits_or_moves x (visits p) T) as [(v & Hv & V) | (before & v & w & later & E & Mv)].
      * apply (Stays p v); auto.
      * unfold move_pays in Mv. rewrite Other, (N p before v w later Hp E) in Mv. simpl in Mv.
        destruct (mover_occupies p before v w later Hp E) as [_ Hw]. apply makes_the_move in Mv as (_ & <- & <-).
        exact Hw.
  - apply occupants_have_room with (t := tick x); auto using payers_are_different.
    intros p Hp. apply payer_pays in Hp as [Hp T].
    destruct (who_pays_visits_or_moves x (visits p) T) as [(v & Hv & V) | (before & v & w & later & E & Mv)].
    + apply (Stays p v); auto.
    + unfold move_pays in Mv. rewrite Other in Mv. discriminate.
Qed.

Lemma price_is_paid_by_payers x : sum (fun p => times x (visits p)) (plans s) <= Z.of_nat (length (payers x)).
Proof.
  unfold payers. assert (A : forall p, In p (plans s) -> 0 <= times x (visits p) <= 1).
  { intros p Hp. split; [apply times_is_not_negative |]. destruct (plan_is_a_way p Hp) as (a & Ha & _ & W).
    apply (price_is_paid_once i a right Ha x (visits p) W). }
  induction (plans s) as [| p ps IH]; simpl; [lia |].
  pose proof (A p (or_introl eq_refl)). assert (IHps := IH (fun q Hq => A q (or_intror Hq))).
  destruct (Z.ltb_spec 0 (times x (visits p))); simpl length; lia.
Qed.

(** Prices of resources of the graph, at least 0: all robots together pay no more than prices times capacities. *)
Theorem all_pay_no_more_than_prices_times_capacities xs :
  (forall x, In x xs -> 0 <= amount x /\ In (place x) (resource_ids i) /\
    match other x with Some r => In r (resource_ids i) | None => True end) ->
  sum (fun p => paid xs (visits p)) (plans s) <= worth i xs.
Proof.
  intros H. rewrite (sum_of_equal _ (fun p => sum (fun x => amount x * times x (visits p)) xs))
    by (intros; apply paid_is_by_price).
  rewrite sums_are_exchanged. apply sum_is_monotone. intros x Hx. destruct (H x Hx) as (Ha & Hp & Ho).
  rewrite (sum_of_multiples (fun p => times x (visits p))). apply Z.mul_le_mono_nonneg_l; auto.
  eapply Z.le_trans; [apply price_is_paid_by_payers | apply payers_have_room; auto].
Qed.

(** All robots together pay for a group at most its price times its capacity. *)
Lemma group_price_is_paid_by_few x : 0 <= group_amount x ->
  sum (fun p => paid (prices_within i x) (visits p)) (plans s) <= group_amount x * group_room i x.
Proof.
  intros A. unfold prices_within, group_room. destruct (group_of i x) as [g |] eqn:G.
  2: { rewrite (sum_of_equal _ (fun _ => 0)); [rewrite sum_of_zeros; lia |].
       intros p _. rewrite paid_is_by_price. reflexivity. }
  apply find_some in G as [Hg _].
  set (often := fun p => sum (fun r => times (Price r None (group_tick x) (group_amount x)) (visits p)) (group_resources g)).
  rewrite (sum_of_equal _ (fun p => group_amount x * often p)).
  2: { intros p _. rewrite paid_is_by_price. unfold often. rewrite <- sum_of_multiples. 
       generalize (group_resources g). intros ids. induction ids as [| r ids IH]; simpl; [reflexivity |]. rewrite <- IH.
       reflexivity. }
  rewrite sum_of_multiples. apply Z.mul_le_mono_nonneg_l; auto.
  set (those := filter (fun p => 0 <? often p) (plans s)).
  apply Z.le_trans with (Z.of_nat (length those)).
  - assert (O : forall p, In p (plans s) -> 0 <= often p <= 1).
    { intros p Hp. split; [apply sum_is_not_negative; intros; apply times_is_not_negative |].
      destruct (plan_is_a_way p Hp) as (a & Ha & _ & W).
      apply (one_of_many_places_is_paid i a right Ha); auto. apply (groups_name_resources_once i right g Hg). }
    unfold those. clear those. induction (plans s) as [| p ps IH]; simpl; [lia |].
    pose proof (O p (or_introl eq_refl)). assert (IHps := IH (fun q Hq => O q (or_intror Hq))).
    destruct (Z.ltb_spec 0 (often p)); simpl length; lia.
  - change (group_capacity g) with (limit_capacity (Limit (group_resources g) (group_capacity g))).
    rewrite <- (map_length plan_robot). apply (limits_are_kept i s lawful) with (tick := group_tick x).
    + unfold limits. apply in_or_app. right. apply in_map_iff. eauto.
    + pose proof robots_have_one_plan as N. unfold those, planned in *. clear those.
      induction (plans s) as [| p ps IH]; simpl in *; auto.
      inversion N as [| ? ? Hn Hd]; subst. destruct (0 <? often p); simpl; auto. constructor; auto.
      intros H. apply Hn. apply in_map_iff in H as (q & E & Hq). apply filter_In in Hq as [Hq _].
      apply in_map_iff. eauto.
    + intros id Hid. apply in_map_iff in Hid as (p & <- & Hp). apply filter_In in Hp as [Hp Often].
      apply Z.ltb_lt in Often. unfold often in Often.
      assert (E : exists r, In r (group_resources g) /\ 0 < times (Price r None (group_tick x) (group_amount x)) (visits p)).
      { clear -Often. induction (group_resources g) as [| r ids IH]; simpl in Often; [lia |].
        destruct (Z.ltb_spec 0 (times (Price r None (group_tick x) (group_amount x)) (visits p))).
        - exists r. simpl. auto.
        - destruct IH as (q & Hq & T); [lia |]. exists q. simpl. auto. }
      destruct E as (r & Hr & T). exists r, 0. rewrite Z.sub_0_r.
      split; [exact Hr |]. split; [unfold gap; destruct (following_is_forbidden i); lia |].
      destruct (who_pays_visits_or_moves _ (visits p) T) as [(v & Hv & V) | (before & v & w & later & E & Mv)].
      * apply paying_visit_holds in V as (Place & Held & _). cbn [place tick] in Place, Held. rewrite <- Place.
        apply holding_visit_occupies; auto.
      * unfold move_pays in Mv. simpl in Mv. discriminate.
Qed.

(** Prices of groups, at least 0: all robots together pay no more than prices times capacities. *)
Theorem all_pay_no_more_than_group_prices_times_capacities xs : (forall x, In x xs -> 0 <= group_amount x) ->
  sum (fun p => paid (flat_map (prices_within i) xs) (visits p)) (plans s) <=
  sum (fun x => group_amount x * group_room i x) xs.
Proof.
  intros H. rewrite (sum_of_equal _ (fun p => sum (fun x => paid (prices_within i x) (visits p)) xs)).
  - rewrite sums_are_exchanged. apply sum_is_monotone. intros x Hx. apply group_price_is_paid_by_few, H, Hx.
  - intros p _. induction xs as [| x xs IH]; [rewrite paid_is_by_price; reflexivity |]. simpl.
    rewrite paid_of_joined, IH; [reflexivity |]. intros y Hy. apply H. right. exact Hy.
Qed.

End Solution.
