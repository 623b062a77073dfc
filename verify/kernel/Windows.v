(** The free windows of a resource. *)
Require Import ZArith List Bool Lia Sorted.
From Carproof Require Import Law Collections Timeline Journey Checker.
Import ListNotations.
Open Scope Z_scope.

(** The ticks from [opens] up to, not including, [closes]; [None] is for ever. *)
Record window := Window { opens : Z; closes : option Z }.

Definition In_window (w : window) (tick : Z) : Prop := opens w <= tick /\ Before tick (closes w).

(** A maximal interval in which a property of ticks holds: not empty, and it holds neither before nor behind it. *)
Record Maximal (P : Z -> Prop) (w : window) : Prop := {
  is_not_empty : Before (opens w) (closes w);
  holds_inside : forall tick, In_window w tick -> P tick;
  not_before : ~ P (opens w - 1);
  not_behind : forall tick, closes w = Some tick -> ~ P tick
}.

(** * The computation *)

(** A sweep over changes in order: [inside] robots are there, and a window is open since [opened] if it is one. *)
Fixpoint sweep (most inside : Z) (opened : option Z) (l : list (Z * Z)) : list window :=
  match l with
  | [] => match opened with Some tick => [Window tick None] | None => [] end
  | (tick, change) :: later =>
    let now_inside := inside + change in
    match opened with
    | None => sweep most now_inside (if now_inside <? most then Some tick else None) later
    | Some first =>
      if now_inside <? most then sweep most now_inside opened later
      else Window first (Some tick) :: sweep most now_inside None later
    end
  end.

(** The windows, in order of time, in which fewer than [most] of the stays hold. *)
Definition free_windows (stays : list stay) (most : Z) : list window := sweep most 0 None (changes stays).

(** * Proofs *)

(** The property whose maximal intervals the sweep makes from here on. *)
Definition Open (most inside : Z) (opened : option Z) (l : list (Z * Z)) (tick : Z) : Prop :=
  match opened with Some first => first <= tick | None => True end /\ inside + level l tick < most.

(** A window is open if and only if there is room, and it has been open before the changes to come. *)
Definition Consistent (most inside : Z) (opened : option Z) (l : list (Z * Z)) : Prop :=
  match opened with
  | Some first => inside < most /\ forall c, In c l -> first < fst c
  | None => most <= inside
  end.

Lemma maximal_iff P Q w : (forall tick, P tick <-> Q tick) -> Maximal P w <-> Maximal Q w.
Proof.
  intros E. split; intros [N I B A]; split; auto.
  - intros tick T. apply E. auto.
  - intros H. apply B. apply E. auto.
  - intros tick C H. apply (A tick C). apply E. auto.
  - intros tick T. apply E. auto.
  - intros H. apply B. apply E. auto.
  - intros tick C H. apply (A tick C). apply E. auto.
Qed.

(** A window that ends before the rest begins stands alone. *)
Lemma maximal_in_two P Q first last w : first < last ->
  (forall tick, P tick <-> first <= tick < last \/ Q tick) -> (forall tick, tick <= last -> ~ Q tick) ->
  Maximal P w <-> w = Window first (Some last) \/ Maximal Q w.
Proof.
  intros F E N. split.
  - intros [M I B A]. destruct (Z.ltb_spec (opens w) last) as [L|L].
    + left. destruct w as [o c]. simpl in *. assert (o = first).
      { assert (P o) as H by (apply I; split; simpl; auto; lia). apply E in H as [H|H]; [|destruct (N o); [lia | auto]].
        destruct (Z.eqb_spec o first); auto. destruct B. apply E. left. lia. }
      subst o. f_equal. destruct c as [c|].
      * f_equal. destruct (Z.lt_trichotomy c last) as [C|[C|C]]; auto.
        -- destruct (A c eq_refl). apply E. left. simpl in M. lia.
        -- assert (P last) as H by (apply I; split; simpl; lia). apply E in H as [H|H]; [lia|].
           destruct (N last); auto. lia.
      * assert (P last) as H by (apply I; split; simpl; auto; lia). apply E in H as [H|H]; [lia|].
        destruct (N last); auto. lia.
    + right. split; auto.
      * intros tick T. pose proof (I tick T) as H. apply E in H as [H|H]; auto. destruct T. lia.
      * intros H. apply B. apply E. auto.
      * intros tick C H. apply (A tick C). apply E. auto.
  - intros [->|[M I B A]].
    + split; simpl.
      * exact F.
      * intros tick [T U]. apply E. simpl in *. auto.
      * intros H. apply E in H as [H|H]; [lia|]. destruct (N (first - 1)); auto. lia.
      * intros tick C H. injection C as <-. apply E in H as [H|H]; [lia|]. destruct (N last); auto. lia.
    + assert (L : last < opens w).
      { assert (Q (opens w)) as H by (apply I; split; auto; lia).
        destruct (Z.ltb_spec last (opens w)); auto. destruct (N (opens w)); auto. }
      split; auto.
      * intros tick T. apply E. auto.
      * intros H. apply E in H as [H|H]; [lia | auto].
      * intros tick C H. apply E in H as [H|H]; [|destruct (A tick C); auto].
        rewrite C in M. simpl in M. lia.
Qed.

Lemma level_at_first k d l tick : (forall c, In c l -> k < fst c) ->
  level ((k, d) :: l) tick = if k <=? tick then d + level l tick else 0.
Proof.
  intros A. simpl. destruct (Z.leb_spec k tick); auto. rewrite level_before; auto.
  intros c C. specialize (A c C). lia.
Qed.

Lemma sweep_iff most l : In_order l -> forall inside opened, Consistent most inside opened l ->
  forall w, In w (sweep most inside opened l) <-> Maximal (Open most inside opened l) w.
Proof.
  intros O. induction O as [|[k d] l O IH A]; intros inside opened C w.
  - destruct opened as [first|]; simpl in *.
    + destruct C as [C _]. split.
      * intros [<-|[]]. split; unfold Open; simpl; auto.
        -- intros tick [T _]. simpl in T. lia.
        -- lia.
        -- discriminate.
      * intros [M I B N]. unfold Open in *. simpl in *. left. destruct w as [o c]; simpl in *. f_equal.
        -- destruct (Z.eqb_spec o first) as [|D]; auto. destruct B.
           destruct (I o) as [H _]; [split; simpl; auto; lia|]. split; lia.
        -- destruct c as [c|]; auto. destruct (N c eq_refl). simpl in M.
           destruct (I o) as [H _]; [split; simpl; auto; lia|]. split; lia.
    + split; [tauto|]. intros [M I _ _]. destruct (I (opens w)); [split; auto; lia|]. simpl in *. lia.
  - rewrite Forall_forall in A. simpl in A. cbn [sweep]. cbv zeta.
    destruct opened as [first|]; [destruct C as [C K]; pose proof (K _ (or_introl eq_refl)) as F; simpl in F|];
      destruct (Z.ltb_spec (inside + d) most) as [R|R].
    + rewrite IH.
      * apply maximal_iff. intros tick. unfold Open. rewrite (level_at_first k d l tick A).
        destruct (Z.leb_spec k tick) as [T|T]; [lia|]. rewrite level_before; [lia|].
        intros c H. specialize (A c H). lia.
      * split; auto. intros c H. apply K. right. exact H.
    + simpl In. rewrite IH by exact R.
      rewrite (maximal_in_two (Open most inside (Some first) ((k, d) :: l)) (Open most (inside + d) None l)
        first k w F).
      * intuition.
      * intros tick. unfold Open. rewrite (level_at_first k d l tick A). destruct (Z.leb_spec k tick) as [T|T]; [lia|].
        rewrite (level_before l tick); [lia|]. intros c H. specialize (A c H). lia.
      * intros tick T [_ H]. rewrite (level_before l tick) in H; [lia|]. intros c I. specialize (A c I). lia.
    + rewrite IH.
      * apply maximal_iff. intros tick. unfold Open. rewrite (level_at_first k d l tick A). simpl in C.
        destruct (Z.leb_spec k tick) as [T|T]; lia.
      * split; auto.
    + rewrite IH by exact R. apply maximal_iff. intros tick. unfold Open. rewrite (level_at_first k d l tick A).
      simpl in C.
      destruct (Z.leb_spec k tick) as [T|T]; [lia|]. rewrite level_before; [lia|].
      intros c H. specialize (A c H). lia.
Qed.

Lemma sweep_covers most l : In_order l -> forall inside opened, Consistent most inside opened l ->
  forall tick, Open most inside opened l tick -> exists w, In w (sweep most inside opened l) /\ In_window w tick.
Proof.
  intros O. induction O as [|[k d] l O IH A]; intros inside opened C tick H.
  - destruct opened as [first|]; simpl in *; destruct H as [H L]; simpl in *; [|lia].
    exists (Window first None). split; auto. split; simpl; auto.
  - rewrite Forall_forall in A. simpl in A. cbn [sweep]. cbv zeta. destruct H as [H L].
    rewrite (level_at_first k d l tick A) in L.
    assert (B : tick < k -> level l tick = 0).
    { intros T. apply level_before. intros c X. specialize (A c X). lia. }
    destruct opened as [first|];
      [destruct C as [C K]; pose proof (K _ (or_introl eq_refl)) as F; simpl in F | simpl in C];
      destruct (Z.ltb_spec (inside + d) most) as [R|R].
    + apply IH; [split; auto; intros c X; apply K; right; exact X|]. split; auto.
      destruct (Z.leb_spec k tick) as [T|T]; [lia|]. specialize (B T). lia.
    + destruct (Z.leb_spec k tick) as [T|T].
      * destruct (IH (inside + d) None R tick) as (w & W & I); [split; auto; lia|]. exists w. split; [right|]; auto.
      * exists (Window first (Some k)). split; [left; auto|]. split; simpl; auto.
    + apply IH; [split; auto|]. destruct (Z.leb_spec k tick) as [T|T]; [split; auto; lia | lia].
    + apply IH; [exact R|]. split; auto. destruct (Z.leb_spec k tick) as [T|T]; lia.
Qed.

(** There is room at the tick: fewer than [most] of the stays hold it. *)
Definition Free (stays : list stay) (most tick : Z) : Prop := 0 <= tick /\ occupancy stays tick < most.

Lemma free_windows_unfold stays most : exists opened inside l,
  free_windows stays most = sweep most inside opened l /\ In_order l /\ Consistent most inside opened l /\
  forall tick, Open most inside opened l tick <-> Free stays most tick.
Proof.
  unfold free_windows, Free. destruct (changes_begin_at_0 stays) as (d & l & E & A).
  pose proof (changes_are_in_order stays) as O. rewrite E in *. inversion O as [|? ? O' _]; subst.
  assert (L : forall tick, 0 <= tick -> d + level l tick = occupancy stays tick).
  { intros tick T. rewrite <- level_of_changes by exact T. rewrite E. simpl. destruct (Z.leb_spec 0 tick); lia. }
  assert (B : forall tick, tick < 0 -> level l tick = 0).
  { intros tick T. apply level_before. intros c C. specialize (A c C). lia. }
  cbn [sweep]. cbv zeta. destruct (Z.ltb_spec (0 + d) most) as [R|R].
  - exists (Some 0), (0 + d), l. repeat split; auto.
    + destruct H as [T H]. exact T.
    + destruct H as [T H]. specialize (L tick T). lia.
    + tauto.
    + destruct H as [T H]. specialize (L tick T). lia.
  - exists None, (0 + d), l. repeat split; auto.
    + destruct H as [_ H]. destruct (Z.leb_spec 0 tick) as [T|T]; auto. specialize (B tick T). lia.
    + destruct H as [_ H]. destruct (Z.leb_spec 0 tick) as [T|T]; [specialize (L tick T) | specialize (B tick T)]; lia.
    + destruct H as [T H]. specialize (L tick T). lia.
Qed.

Theorem free_windows_are_maximal_intervals stays most w :
  In w (free_windows stays most) <-> Maximal (Free stays most) w.
Proof.
  destruct (free_windows_unfold stays most) as (opened & inside & l & -> & O & C & E).
  rewrite sweep_iff by auto. apply maximal_iff. exact E.
Qed.

Theorem free_ticks_are_in_windows stays most tick :
  Free stays most tick -> exists w, In w (free_windows stays most) /\ In_window w tick.
Proof.
  destruct (free_windows_unfold stays most) as (opened & inside & l & -> & O & C & E).
  intros F. apply sweep_covers; auto. apply E. exact F.
Qed.

(** Each window of the list has ended before the next opens. *)
Definition In_order_of_time : list window -> Prop :=
  StronglySorted (fun v w => exists last, closes v = Some last /\ last < opens w).

Lemma sweep_opens most l : forall inside opened w, In w (sweep most inside opened l) ->
  opened = Some (opens w) \/ exists c, In c l /\ fst c = opens w.
Proof.
  induction l as [|[k d] l IH]; intros inside opened w W; cbn [sweep] in W; cbv zeta in W.
  - destruct opened as [first|]; [destruct W as [<-|[]]; auto | destruct W].
  - assert (H : forall opened', In w (sweep most (inside + d) opened' l) ->
      opened' = opened \/ opened' = Some k \/ opened' = None ->
      opened = Some (opens w) \/ exists c, In c ((k, d) :: l) /\ fst c = opens w).
    { intros opened' I E. apply IH in I as [I|(c & C & F)]; [|right; exists c; split; [right|]; auto].
      destruct E as [E|[E|E]]; rewrite E in I; auto; [|discriminate]. injection I as ->. right. exists (opens w, d).
      split; [left|]; reflexivity. }
    destruct opened as [first|]; destruct (inside + d <? most); eauto.
    destruct W as [<-|W]; eauto.
Qed.

Theorem free_windows_are_in_order_of_time stays most : In_order_of_time (free_windows stays most).
Proof.
  unfold free_windows, In_order_of_time. pose proof (changes_are_in_order stays) as O. revert O.
  generalize (changes stays) as l. assert (H : forall l, In_order l -> forall inside opened,
    StronglySorted (fun v w => exists last, closes v = Some last /\ last < opens w) (sweep most inside opened l)).
  - intros l O. induction O as [|[k d] l O IH A]; intros inside opened; cbn [sweep]; cbv zeta.
    + destruct opened; repeat constructor.
    + destruct opened as [first|]; destruct (inside + d <? most); auto. constructor; auto.
      rewrite Forall_forall in *. intros w W. exists k. split; [reflexivity|].
      apply sweep_opens in W as [W|(c & C & <-)]; [discriminate | exact (A c C)].
  - intros l O. apply H. exact O.
Qed.

(** A stay whose ticks are all free lies in one window. *)
Theorem free_stays_are_in_windows stays most enter leave : Before enter leave ->
  (forall tick, enter <= tick -> Before tick leave -> Free stays most tick) ->
  exists w, In w (free_windows stays most) /\ opens w <= enter /\
  forall last, closes w = Some last -> exists l, leave = Some l /\ l <= last.
Proof.
  intros N F. destruct (free_ticks_are_in_windows stays most enter) as (w & W & I & J); [apply F; auto; lia|].
  exists w. repeat split; auto. intros last C. apply free_windows_are_maximal_intervals in W.
  destruct leave as [l|].
  - exists l. split; auto. destruct (Z.leb_spec l last) as [L|L]; auto.
    destruct (not_behind _ _ W last C). apply F; [|exact L]. rewrite C in J. simpl in J. lia.
  - destruct (not_behind _ _ W last C). apply F; [|exact Logic.I]. rewrite C in J. simpl in J. lia.
Qed.

(** * Limits *)

(** When as many of the stays hold as fit in, or more: the windows of the changes turned round. *)
Definition full_stays (stays : list stay) (capacity : Z) : list stay :=
  map (fun w => (opens w, closes w)) (sweep (1 - capacity) 0 None (map (fun c => (fst c, - snd c)) (changes stays))).

(** The windows in which none of the limits is full, now or when the gap is over. *)
Definition windows_between (gap : Z) (full : list stay) : list window :=
  free_windows (map (fun s => (fst s - gap, snd s)) full) 1.

(** The limits of a resource, each as often as it is full. *)
Definition full_at (known : lookup) (full : Z -> list stay) (place : Z) : list stay :=
  flat_map full (keys_at known place).

Definition full_in_timetable (known : lookup) (stays : Map.t (list stay)) (key : Z) : list stay :=
  match Map.find key (limit_of known) with Some (_, l) => full_stays (listed stays key) (limit_capacity l) | None => [] end.

Definition windows_of (known : lookup) (committed : list plan) (r : resource) : list window :=
  let stays := stays_in_limits known (counts_longer known) committed in
  windows_between (counts_longer known) (full_at known (full_in_timetable known stays) (resource_id r)).

Lemma turned_changes_are_in_order l : In_order l -> In_order (map (fun c => (fst c, - snd c)) l).
Proof.
  intros O. unfold In_order in *. induction O as [|c l O IH A]; simpl; constructor; auto.
  rewrite Forall_forall in *. intros d D. apply in_map_iff in D as (e & <- & E). exact (A e E).
Qed.

Lemma level_of_turned_changes l tick : level (map (fun c => (fst c, - snd c)) l) tick = - level l tick.
Proof. induction l as [|c l IH]; simpl; [reflexivity|]. rewrite IH. destruct (fst c <=? tick); lia. Qed.

Lemma full_stays_iff stays capacity tick : 1 <= capacity -> 0 <= tick ->
  (exists s, In s (full_stays stays capacity) /\ holds s tick = true) <-> capacity <= occupancy stays tick.
Proof.
  intros C T. unfold full_stays. set (turned := map (fun c => (fst c, - snd c)) (changes stays)).
  pose proof (turned_changes_are_in_order _ (changes_are_in_order stays)) as O. fold turned in O.
  pose proof (level_of_turned_changes (changes stays) tick) as L. fold turned in L.
  rewrite level_of_changes in L by exact T.
  assert (K : Consistent (1 - capacity) 0 None turned) by (unfold Consistent; lia). split.
  - intros (s & S & H). apply in_map_iff in S as (w & <- & W). apply (sweep_iff _ _ O _ _ K) in W.
    enough (X : Open (1 - capacity) 0 None turned tick) by (unfold Open in X; lia). apply (holds_inside _ _ W).
    unfold holds, In_window, before, Before in *. simpl in H. destruct (closes w); lia.
  - intros H. destruct (sweep_covers _ _ O _ _ K tick) as (w & W & I); [unfold Open; split; auto; lia|].
    exists (opens w, closes w). split; [apply (in_map (fun w => (opens w, closes w))); exact W|]. unfold holds, In_window, before, Before in *. simpl.
    destruct (closes w); lia.
Qed.

Lemma full_stays_last stays capacity s : 1 <= capacity -> In s (full_stays stays capacity) -> Before (fst s) (snd s).
Proof.
  intros C S. unfold full_stays in S. apply in_map_iff in S as (w & <- & W).
  apply sweep_iff in W; [exact (is_not_empty _ _ W) | | unfold Consistent; lia].
  exact (turned_changes_are_in_order _ (changes_are_in_order stays)).
Qed.

Section Room.
Variables (i : instance) (committed : list plan).
Hypothesis well_formed : Well_formed i.
Hypothesis robots_are_known : forall p, In p committed -> exists a, In a (robots i) /\ robot_id a = plan_robot p.
Hypothesis plans_are_lawful : Plans_lawful i committed.
Hypothesis robots_are_distinct : NoDup (map plan_robot committed).
Local Notation known := (lookup_of i).

(** There is room in each limit of the resource for one robot more than those that count. *)
Definition Room_beside (r : resource) (tick : Z) : Prop :=
  forall l ids, In l (limits i) -> In (resource_id r) (limit_places l) -> NoDup ids ->
  (forall id, In id ids -> Counts i committed id l tick) -> Z.of_nat (length ids) < limit_capacity l.

(** The robot may be in the resource at the tick: there is room then, and for as long as it still counts. *)
Definition Room_for_one_more (r : resource) (tick : Z) : Prop :=
  0 <= tick /\ forall longer, 0 <= longer <= gap i -> Room_beside r (tick + longer).

Lemma room_beside_iff r tick : Room_beside r tick <-> forall key l, In (key, l) (keyed_limits i) ->
  In (resource_id r) (limit_places l) -> occupants (keys_at known) (gap i) committed key tick < limit_capacity l.
Proof.
  assert (E : forall key l, In (key, l) (keyed_limits i) ->
    (forall ids, NoDup ids -> (forall id, In id ids -> Counts i committed id l tick) ->
      Z.of_nat (length ids) <= limit_capacity l - 1) <->
    occupants (keys_at known) (gap i) committed key tick <= limit_capacity l - 1).
  { intros key l L. apply (occupants_iff _ _ (fun id => Counts i committed id l tick)); auto.
    intros id. apply (counts_iff i well_formed committed); auto. }
  unfold Room_beside. split.
  - intros H key l L P. enough (occupants (keys_at known) (gap i) committed key tick <= limit_capacity l - 1) by lia.
    apply (E key l L). intros ids N C. enough (Z.of_nat (length ids) < limit_capacity l) by lia.
    apply (H l); auto. apply in_limits; eauto.
  - intros H l ids L P N C. apply in_limits in L as (key & L); auto. specialize (H key l L P).
    enough (Z.of_nat (length ids) <= limit_capacity l - 1) by lia. apply (E key l L); auto. lia.
Qed.

Lemma windows_are_of_room r tick : In r (resources i) ->
  Free (map (fun s => (fst s - gap i, snd s)) (full_at known (full_in_timetable known
    (stays_in_limits known (gap i) committed)) (resource_id r))) 1 tick <-> Room_for_one_more r tick.
Proof.
  intros R. unfold Free, Room_for_one_more. setoid_rewrite room_beside_iff. pose proof (gap_is_short i) as G.
  set (stays := stays_in_limits known (gap i) committed).
  set (full := full_at known (full_in_timetable known stays) (resource_id r)).
  assert (F : forall t, 0 <= t -> (exists s, In s full /\ holds s t = true) <-> exists key l,
    In (key, l) (keyed_limits i) /\ In (resource_id r) (limit_places l) /\
    limit_capacity l <= occupants (keys_at known) (gap i) committed key t).
  { intros t T. unfold full, full_at. setoid_rewrite in_flat_map. split.
    - intros (s & (key & K & S) & H). apply in_keys_at in K as (l & L & P). exists key, l. repeat split; auto.
      unfold full_in_timetable in S. rewrite (proj2 (find_limit i well_formed key l) L) in S.
      rewrite <- (occupancy_of_timetable _ _ (keys_are_different i well_formed) committed key t)
        by exact (plan_counts_once i well_formed committed robots_are_known plans_are_lawful).
      apply full_stays_iff; eauto using limit_capacity_is_positive.
    - intros (key & l & L & P & H).
      rewrite <- (occupancy_of_timetable _ _ (keys_are_different i well_formed) committed key t) in H
        by exact (plan_counts_once i well_formed committed robots_are_known plans_are_lawful).
      apply full_stays_iff in H as (s & S & H); eauto using limit_capacity_is_positive.
      exists s. split; auto. exists key. split; [apply in_keys_at; eauto|].
      unfold full_in_timetable. rewrite (proj2 (find_limit i well_formed key l) L). exact S. }
  assert (D : forall s, In s full -> Before (fst s) (snd s)).
  { intros s S. unfold full, full_at in S. apply in_flat_map in S as (key & _ & S). unfold full_in_timetable in S.
    destruct (Map.find key (limit_of known)) as [[k l]|] eqn:L; [|destruct S].
    apply (find_in_index fst) in L as [L <-]; [|exact (keys_are_unique i well_formed)].
    eapply full_stays_last; [exact (limit_capacity_is_positive i well_formed _ _ L) | exact S]. }
  assert (Z0 : occupancy (map (fun s => (fst s - gap i, snd s)) full) tick < 1 <->
    forall s, In s full -> holds (fst s - gap i, snd s) tick = false).
  { unfold occupancy. split.
    - intros H s S. apply not_true_iff_false. intros X.
      assert (Y : In (fst s - gap i, snd s) (filter (fun s => holds s tick) (map (fun s => (fst s - gap i, snd s)) full))).
      { apply filter_In. split; auto. apply (in_map (fun s => (fst s - gap i, snd s))). exact S. }
      destruct (filter _ _); [destruct Y | simpl in H; lia].
    - intros H. destruct (filter (fun s => holds s tick) (map (fun s => (fst s - gap i, snd s)) full)) as [|x y] eqn:E;
        [simpl; lia|].
      assert (Y : In x (x :: y)) by (left; auto). rewrite <- E in Y. apply filter_In in Y as [Y X].
      apply in_map_iff in Y as (s & <- & S). rewrite (H s S) in X. discriminate. }
  rewrite Z0. split; intros [T H]; split; auto.
  - intros longer L key l K P. apply Z.nle_gt. intros C. destruct (proj2 (F (tick + longer) ltac:(lia))) as (s & S & X);
      [eauto|].
    specialize (H s S). apply not_true_iff_false in H. apply H. unfold holds, before in *. simpl.
    destruct (snd s); lia.
  - intros s S. apply not_true_iff_false. intros X. specialize (D s S).
    assert (exists longer, 0 <= longer <= gap i /\ holds s (tick + longer) = true) as (longer & L & Y).
    { unfold holds, before, Before in *. simpl in X.
      exists (Z.max 0 (fst s - tick)). split; [lia|]. destruct (snd s); lia. }
    destruct (proj1 (F (tick + longer) ltac:(lia))) as (key & l & K & P & C); [eauto|].
    specialize (H longer L key l K P). lia.
Qed.

(** window/free: for lawful plans of different robots, exactly the maximal intervals, from tick 0, in which one more
    robot may be in the resource. *)
Theorem free_windows_are_maximal r w : In r (resources i) ->
  In w (windows_of known committed r) <-> Maximal (Room_for_one_more r) w.
Proof.
  intros R. unfold windows_of, windows_between. cbv zeta. rewrite free_windows_are_maximal_intervals.
  apply maximal_iff. intros tick. exact (windows_are_of_room r tick R).
Qed.
End Room.
