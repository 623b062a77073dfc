(** How many stays hold each tick: sorted changes of the number, and a sweep over them. *)
Require Import ZArith List Bool Lia Sorted SetoidList OrderedTypeEx.
From Carproof Require Import Law Collections.
Import ListNotations.
Open Scope Z_scope.

(** A stay [enter, leave) in one resource; [None] is for ever. *)
Definition stay := (Z * option Z)%type.

Definition before (tick : Z) (end_ : option Z) : bool := match end_ with Some l => tick <? l | None => true end.

(** The stay holds the tick. *)
Definition holds (s : stay) (tick : Z) : bool := (fst s <=? tick) && before tick (snd s).

(** How many of the stays hold the tick. *)
Definition occupancy (stays : list stay) (tick : Z) : Z := Z.of_nat (length (filter (fun s => holds s tick) stays)).

(** * Changes of the occupancy, by tick *)

Definition add_change (tick change : Z) (m : Map.t Z) : Map.t Z :=
  Map.add tick (match Map.find tick m with Some known => known + change | None => change end) m.

(** A stay adds one robot as it begins (not before tick 0) and takes it away as it ends; one that has no tick is left
    out. *)
Definition add_stay (m : Map.t Z) (s : stay) : Map.t Z :=
  let enter := Z.max 0 (fst s) in
  match snd s with
  | None => add_change enter 1 m
  | Some leave => if enter <? leave then add_change leave (-1) (add_change enter 1 m) else m
  end.

(** The changes in order of time, the first at tick 0. *)
Definition changes (stays : list stay) : list (Z * Z) :=
  Map.elements (fold_left add_stay stays (add_change 0 0 (Map.empty Z))).

(** The sum of all changes up to the tick. *)
Definition level (l : list (Z * Z)) (tick : Z) : Z :=
  fold_right (fun c sum => (if fst c <=? tick then snd c else 0) + sum) 0 l.

Definition level_of (m : Map.t Z) (tick : Z) : Z := level (Map.elements m) tick.

Lemma level_of_fold m tick :
  level_of m tick = Map.fold (fun k d sum => (if k <=? tick then d else 0) + sum) m 0.
Proof.
  unfold level_of. rewrite Map.fold_1. generalize (Map.elements m) as l.
  assert (H : forall l s, fold_left (fun a c => (if fst c <=? tick then snd c else 0) + a) l s = level l tick + s).
  { induction l as [|c l IH]; intros s; simpl; [lia|]. rewrite IH. lia. }
  intros l. rewrite H. lia.
Qed.

Lemma level_of_add m k d tick : ~ Map.In k m ->
  level_of (Map.add k d m) tick = (if k <=? tick then d else 0) + level_of m tick.
Proof.
  intros H. rewrite !level_of_fold.
  refine (@Map_properties.fold_Add Z Z eq eq_equivalence _ _ _ m (Map.add k d m) k d 0 H (fun y => eq_refl)).
  intros a b c e f _. lia.
Qed.

Lemma level_of_equal m n tick : Map.Equal m n -> level_of m tick = level_of n tick.
Proof.
  intros E. rewrite !level_of_fold.
  apply (@Map_properties.fold_Equal Z Z eq eq_equivalence); auto.
  - intros a b F c d G e f K. unfold Z_as_OT.eq in F. subst. reflexivity.
  - intros a b c d e _. lia.
Qed.

Lemma level_of_add_change m k d tick :
  level_of (add_change k d m) tick = (if k <=? tick then d else 0) + level_of m tick.
Proof.
  unfold add_change. destruct (Map.find k m) as [v|] eqn:E.
  - assert (N : ~ Map.In k (Map.remove k m)).
    { rewrite Map_facts.remove_in_iff. unfold Z_as_OT.eq. tauto. }
    rewrite (level_of_equal (Map.add k (v + d) m) (Map.add k (v + d) (Map.remove k m))).
    + rewrite level_of_add by exact N.
      rewrite (level_of_equal m (Map.add k v (Map.remove k m))).
      * rewrite level_of_add by exact N. destruct (k <=? tick); lia.
      * intros y. rewrite Map_facts.add_o, Map_facts.remove_o.
        destruct (Z_as_OT.eq_dec k y) as [F|F]; auto. unfold Z_as_OT.eq in F. subst. auto.
    + intros y. rewrite !Map_facts.add_o, Map_facts.remove_o. destruct (Z_as_OT.eq_dec k y); auto.
  - apply level_of_add. rewrite Map_facts.not_find_in_iff. auto.
Qed.

Lemma level_of_add_stay m s tick : 0 <= tick ->
  level_of (add_stay m s) tick = (if holds s tick then 1 else 0) + level_of m tick.
Proof.
  intros T. destruct s as [e [l|]]; unfold add_stay, holds, before; cbn [fst snd]; cbv zeta.
  - destruct (Z.ltb_spec (Z.max 0 e) l) as [L|L].
    + rewrite !level_of_add_change.
      destruct (Z.leb_spec l tick), (Z.leb_spec (Z.max 0 e) tick), (Z.leb_spec e tick), (Z.ltb_spec tick l);
        cbn [andb]; lia.
    + destruct (Z.leb_spec e tick), (Z.ltb_spec tick l); cbn [andb]; lia.
  - rewrite level_of_add_change.
    destruct (Z.leb_spec (Z.max 0 e) tick), (Z.leb_spec e tick); cbn [andb]; lia.
Qed.

Lemma level_of_changes stays tick : 0 <= tick -> level (changes stays) tick = occupancy stays tick.
Proof.
  intros T. unfold changes. fold (level_of (fold_left add_stay stays (add_change 0 0 (Map.empty Z))) tick).
  assert (H : forall m, level_of (fold_left add_stay stays m) tick = occupancy stays tick + level_of m tick).
  - induction stays as [|s stays IH]; intros m; simpl; [unfold occupancy; simpl; lia|].
    rewrite IH, level_of_add_stay by exact T. unfold occupancy. simpl.
    destruct (holds s tick); simpl length; lia.
  - rewrite H, level_of_add_change. unfold level_of at 1. simpl. destruct (0 <=? tick); lia.
Qed.

(** Changes are sorted by their ticks, and no two have the same. *)
Definition In_order (l : list (Z * Z)) : Prop := StronglySorted (fun c d => fst c < fst d) l.

Lemma changes_are_in_order stays : In_order (changes stays).
Proof.
  unfold In_order, changes. generalize (fold_left add_stay stays (add_change 0 0 (Map.empty Z))) as m. intros m.
  pose proof (Map.elements_3 m) as H. apply Sorted_StronglySorted; auto.
  intros a b c. unfold Z_as_OT.lt. lia.
Qed.

(** No change is before tick 0. *)
Definition Not_negative (m : Map.t Z) : Prop := forall k, Map.In k m -> 0 <= k.

Lemma not_negative_add_change m k d : 0 <= k -> Not_negative m -> Not_negative (add_change k d m).
Proof.
  intros K N j. unfold add_change. rewrite Map_facts.add_in_iff. unfold Z_as_OT.eq.
  intros [<-|H]; auto.
Qed.

Lemma changes_begin_at_0 stays : exists d l, changes stays = (0, d) :: l /\ forall c, In c l -> 0 < fst c.
Proof.
  unfold changes. set (m := fold_left add_stay stays (add_change 0 0 (Map.empty Z))).
  assert (N : Not_negative m /\ Map.In 0 m).
  { assert (H : forall m, Not_negative m /\ Map.In 0 m ->
      Not_negative (fold_left add_stay stays m) /\ Map.In 0 (fold_left add_stay stays m)).
    - clear m. induction stays as [|[e [l|]] stays IH]; intros m H; simpl; auto; apply IH; unfold add_stay; simpl;
        [destruct (Z.ltb_spec (Z.max 0 e) l); [|exact H] |]; destruct H as [H Z0].
      + split; [repeat apply not_negative_add_change; auto; lia|].
        unfold add_change. rewrite !Map_facts.add_in_iff. auto.
      + split; [apply not_negative_add_change; auto; lia|].
        unfold add_change. rewrite !Map_facts.add_in_iff. auto.
    - apply H. split.
      + apply not_negative_add_change; [lia|]. intros k K. apply Map_facts.empty_in_iff in K. tauto.
      + unfold add_change. rewrite Map_facts.add_in_iff. left. reflexivity. }
  destruct N as [N [d Z0]]. assert (I : forall c, In c (Map.elements m) -> 0 <= fst c).
  { intros [k v] H. apply N. exists v. apply Map.elements_2. apply InA_alt. exists (k, v). split; [|exact H].
    split; reflexivity. }
  assert (Z0' : exists v, In (0, v) (Map.elements m)).
  { apply Map.elements_1 in Z0. apply InA_alt in Z0 as ([k v] & [E F] & H). simpl in E, F.
    unfold Z_as_OT.eq in E. subst k v. exists d. exact H. }
  pose proof (changes_are_in_order stays) as O. unfold In_order, changes in O. fold m in O.
  destruct (Map.elements m) as [|[k v] l]; [destruct Z0' as [v []]|].
  inversion O as [|? ? _ A]; subst. rewrite Forall_forall in A. simpl in A.
  assert (k = 0).
  { destruct Z0' as [w [E|H]]; [congruence|]. specialize (A _ H). specialize (I (k, v) (or_introl eq_refl)).
    simpl in A, I. lia. }
  subst k. exists v, l. split; [reflexivity | exact A].
Qed.

Lemma level_before l tick : (forall c, In c l -> tick < fst c) -> level l tick = 0.
Proof.
  induction l as [|c l IH]; intros H; simpl; auto. rewrite (IH (fun d D => H d (or_intror D))).
  specialize (H c (or_introl eq_refl)). destruct (Z.leb_spec (fst c) tick); lia.
Qed.

(** * The sweep *)

(** The number [inside] and those after each change are at most [most]. *)
Fixpoint within (most inside : Z) (l : list (Z * Z)) : bool :=
  match l with
  | [] => true
  | (_, change) :: later => if inside + change <=? most then within most (inside + change) later else false
  end.

Lemma within_iff most l : In_order l -> forall inside,
  inside <= most /\ within most inside l = true <-> forall tick, inside + level l tick <= most.
Proof.
  intros O. induction O as [|[k d] l O IH A]; intros inside; simpl.
  - split; [lia|]. intros H. specialize (H 0). split; [lia | auto].
  - rewrite Forall_forall in A. simpl in A. split.
    + intros [I W] tick. destruct (Z.leb_spec (inside + d) most); [|discriminate].
      destruct (Z.leb_spec k tick).
      * enough (inside + d + level l tick <= most) by lia. apply (proj1 (IH (inside + d))). auto.
      * rewrite level_before; [lia|]. intros c C. specialize (A c C). lia.
    + intros H. assert (I : inside <= most).
      { specialize (H (k - 1)). rewrite level_before in H.
        - destruct (Z.leb_spec k (k - 1)); lia.
        - intros c C. specialize (A c C). lia. }
      split; auto. assert (K : inside + d <= most).
      { specialize (H k). rewrite level_before in H; auto. destruct (Z.leb_spec k k); lia. }
      destruct (Z.leb_spec (inside + d) most); [|lia]. apply (proj2 (IH (inside + d))). intros tick.
      destruct (Z.leb_spec k tick) as [T|T].
      * specialize (H tick). destruct (Z.leb_spec k tick); lia.
      * rewrite level_before; [lia|]. intros c C. specialize (A c C). lia.
Qed.

(** At no tick hold more than [most] of the stays. *)
Definition never_more_than (most : Z) (stays : list stay) : bool := within most 0 (changes stays).

Theorem never_more_than_iff most stays : 0 <= most ->
  never_more_than most stays = true <-> forall tick, 0 <= tick -> occupancy stays tick <= most.
Proof.
  intros M. pose proof (within_iff most (changes stays) (changes_are_in_order stays) 0) as W.
  unfold never_more_than. split.
  - intros H tick T. rewrite <- level_of_changes by exact T. apply (proj1 W). auto.
  - intros H. apply W. intros tick. destruct (Z.leb_spec 0 tick) as [T|T].
    + rewrite level_of_changes by exact T. apply H. auto.
    + destruct (changes_begin_at_0 stays) as (d & l & -> & P).
      rewrite level_before; [lia|]. intros c [<-|C]; [simpl; lia|]. specialize (P c C). lia.
Qed.
