(** Sets and maps with whole numbers, pairs and triples of them as keys, and the few facts about them that are used. *)
Require Import ZArith List Bool Lia.
Require Import OrderedType OrderedTypeEx FSetAVL FSetFacts FMapAVL FMapFacts.
Import ListNotations.
Open Scope Z_scope.

(** Pairs in lexicographic order. *)
Module Pair (A B : UsualOrderedType) <: UsualOrderedType.
  Definition t := (A.t * B.t)%type.
  Definition eq := @Logic.eq t.
  Definition eq_refl := @Logic.eq_refl t.
  Definition eq_sym := @Logic.eq_sym t.
  Definition eq_trans := @Logic.eq_trans t.
  Definition lt (x y : t) : Prop := A.lt (fst x) (fst y) \/ fst x = fst y /\ B.lt (snd x) (snd y).

  Lemma lt_trans : forall x y z, lt x y -> lt y z -> lt x z.
  Proof.
    intros [a b] [c d] [e f]. unfold lt. simpl.
    intros [H|[-> H]] [K|[<- K]]; eauto using A.lt_trans, B.lt_trans.
  Qed.

  Lemma lt_not_eq : forall x y, lt x y -> ~ eq x y.
  Proof.
    intros [a b] [c d]. unfold lt, eq. simpl. intros [H|[_ H]] E; injection E as E F.
    - exact (A.lt_not_eq _ _ H E).
    - exact (B.lt_not_eq _ _ H F).
  Qed.

  Definition compare (x y : t) : Compare lt eq x y.
  Proof.
    destruct x as [a b], y as [c d]. destruct (A.compare a c) as [H|E|H].
    - apply LT. left. exact H.
    - destruct (B.compare b d) as [K|F|K].
      + apply LT. right. split; [exact E | exact K].
      + apply EQ. unfold A.eq in E. unfold B.eq in F. unfold eq. congruence.
      + apply GT. right. split; [symmetry; exact E | exact K].
    - apply GT. left. exact H.
  Defined.

  Definition eq_dec (x y : t) : {eq x y} + {~ eq x y}.
  Proof.
    destruct (compare x y) as [H|E|H].
    - right. exact (lt_not_eq _ _ H).
    - left. exact E.
    - right. intros E. apply (lt_not_eq _ _ H). symmetry. exact E.
  Defined.
End Pair.

(** Sets with membership and "no element twice". *)
Module Members (O : UsualOrderedType).
  Module S := FSetAVL.Make O.
  Module F := FSetFacts.Facts S.

  Definition of_list (l : list O.t) : S.t := fold_left (fun s x => S.add x s) l S.empty.
  Definition contains (s : S.t) (x : O.t) : bool := S.mem x s.

  Lemma contains_added x y s : contains (S.add x s) y = true <-> y = x \/ contains s y = true.
  Proof. unfold contains. rewrite <- !F.mem_iff, F.add_iff. unfold O.eq. intuition. Qed.

  Lemma contains_empty x : contains S.empty x = false.
  Proof. unfold contains. apply F.not_mem_iff. rewrite F.empty_iff. auto. Qed.

  Lemma contains_of_list l x : contains (of_list l) x = true <-> In x l.
  Proof.
    unfold of_list. assert (H : forall s, contains (fold_left (fun s x => S.add x s) l s) x = true
      <-> In x l \/ contains s x = true).
    - induction l as [|y l IH]; intros s; simpl; [tauto|]. rewrite IH, contains_added. intuition.
    - rewrite H, contains_empty. intuition discriminate.
  Qed.

  Fixpoint distinct_from (seen : S.t) (l : list O.t) : bool :=
    match l with
    | [] => true
    | x :: later => if contains seen x then false else distinct_from (S.add x seen) later
    end.

  (** No element is in the list twice. *)
  Definition distinct : list O.t -> bool := distinct_from S.empty.

  Lemma distinct_from_iff l : forall seen,
    distinct_from seen l = true <-> NoDup l /\ forall x, In x l -> contains seen x = false.
  Proof.
    induction l as [|x l IH]; intros seen; simpl.
    - split; [intros _; split; [constructor | tauto] | auto].
    - destruct (contains seen x) eqn:E.
      + split; [discriminate|]. intros [_ H]. rewrite (H x) in E; auto.
      + rewrite IH. assert (A : forall y, contains (S.add x seen) y = false <-> y <> x /\ contains seen y = false).
        { intros y. pose proof (contains_added x y seen) as H.
          destruct (contains (S.add x seen) y), (contains seen y); intuition congruence. }
        split.
        * intros [H K]. split.
          -- constructor; auto. intros Hx. apply K, A in Hx. tauto.
          -- intros y [<-|Hy]; auto. apply A. auto.
        * intros [H K]. inversion H; subst. split; auto. intros y Hy. apply A. split; [congruence | auto].
  Qed.

  Lemma distinct_iff l : distinct l = true <-> NoDup l.
  Proof.
    unfold distinct. rewrite distinct_from_iff. split; [tauto|]. intros H.
    split; [exact H|]. intros x _. apply contains_empty.
  Qed.
End Members.

Module Z_pair := Pair Z_as_OT Z_as_OT.
Module Z_triple := Pair Z_as_OT Z_pair.
Module Ids := Members Z_as_OT.
Module Pairs := Members Z_pair.
Module Triples := Members Z_triple.

(** * Maps from whole numbers *)

Module Map := FMapAVL.Make Z_as_OT.
Module Map_facts := FMapFacts.WFacts_fun Z_as_OT Map.
Module Map_properties := FMapFacts.WProperties_fun Z_as_OT Map.

(** The map to each element from its key. *)
Definition index {A} (key : A -> Z) (l : list A) : Map.t A :=
  fold_left (fun m x => Map.add (key x) x m) l (Map.empty A).

Lemma find_in_index {A} (key : A -> Z) l k x : NoDup (map key l) ->
  Map.find k (index key l) = Some x <-> In x l /\ key x = k.
Proof.
  unfold index. assert (H : forall l m, NoDup (map key l) ->
    Map.find k (fold_left (fun m x => Map.add (key x) x m) l m) = Some x
    <-> In x l /\ key x = k \/ ~ In k (map key l) /\ Map.find k m = Some x).
  - clear l. induction l as [|y l IH]; intros m N; simpl; [tauto|].
    inversion N as [|? ? Hy Hl]; subst. rewrite IH; auto. rewrite Map_facts.add_o.
    destruct (Z_as_OT.eq_dec (key y) k) as [E|E]; unfold Z_as_OT.eq in E.
    + split.
      * intros [[Hx Hk]|[Hk Hx]]; [auto|]. injection Hx as ->. auto.
      * intros [[[<-|Hx] Hk]|[Hk Hx]]; [| |tauto]; auto. right. subst k. auto.
    + split.
      * intros [[Hx Hk]|[Hk Hx]]; auto. right. tauto.
      * intros [[[->|Hx] Hk]|[Hk Hx]]; auto; tauto.
  - intros N. rewrite H by auto. rewrite Map_facts.empty_o. intuition discriminate.
Qed.

Lemma find_in_index_none {A} (key : A -> Z) l k : NoDup (map key l) ->
  Map.find k (index key l) = None <-> ~ In k (map key l).
Proof.
  intros N. split.
  - intros H K. apply in_map_iff in K as (x & <- & Hx).
    assert (E : Map.find (key x) (index key l) = Some x) by (apply find_in_index; auto). congruence.
  - intros H. destruct (Map.find k (index key l)) as [x|] eqn:E; auto. exfalso. apply H.
    apply find_in_index in E as [Hx <-]; auto. apply in_map. auto.
Qed.

(** The list that a map holds for a key. *)
Definition listed {A} (m : Map.t (list A)) (k : Z) : list A := match Map.find k m with Some l => l | None => [] end.

(** Put one element in front of the list of a key. *)
Definition enlist {A} (k : Z) (x : A) (m : Map.t (list A)) : Map.t (list A) := Map.add k (x :: listed m k) m.

Lemma listed_enlist {A} k (x : A) m j : listed (enlist k x m) j = if k =? j then x :: listed m k else listed m j.
Proof.
  unfold enlist, listed. rewrite Map_facts.add_o.
  destruct (Z_as_OT.eq_dec k j) as [E|E], (Z.eqb_spec k j) as [F|F]; unfold Z_as_OT.eq in E; congruence.
Qed.

Lemma listed_empty {A} k : listed (Map.empty (list A)) k = [].
Proof. unfold listed. rewrite Map_facts.empty_o. auto. Qed.

Lemma distinct_in_front {A} (l m : list A) : NoDup (l ++ m) -> NoDup l.
Proof.
  induction l as [|x l IH]; simpl; intros N; [constructor|]. inversion N as [|? ? H K]; subst.
  constructor; auto. intros X. apply H, in_or_app. auto.
Qed.

Lemma distinct_together {A} (l m : list A) : NoDup l -> NoDup m -> (forall x, In x l -> ~ In x m) -> NoDup (l ++ m).
Proof.
  intros L M D. induction L as [|x l X L IH]; simpl; auto. constructor.
  - intros H. apply in_app_or in H as [H|H]; [tauto|]. exact (D x (or_introl eq_refl) H).
  - apply IH. intros y Y. apply D. right. exact Y.
Qed.
