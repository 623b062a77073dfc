(** Tables of an instance and of prices, and why they hold what they should. *)
Require Import ZArith List Bool Lia.
Require Import OrderedTypeEx FMapAVL FMapFacts.
From Carproof Require Import Law Collections Checker Ways Prices Labels.
Import ListNotations.
Open Scope Z_scope.

Module Pair_map := FMapAVL.Make Z_pair.
Module Pair_facts := FMapFacts.WFacts_fun Z_pair Pair_map.
Module Triple_map := FMapAVL.Make Z_triple.
Module Triple_facts := FMapFacts.WFacts_fun Z_triple Triple_map.

(** * The instance *)

Definition successor_table (i : instance) : Map.t (list Z) :=
  fold_left (fun m e => enlist (fst e) (snd e) m) (moves_of_graph i) (Map.empty (list Z)).

Lemma successors_are_moves i r s : Well_formed i -> In s (listed (successor_table i) r) <-> Move i r s.
Proof.
  intros right. rewrite <- (has_move_iff i). unfold has_move. simpl. rewrite Pairs.contains_of_list.
  unfold successor_table.
  assert (H : forall l m, In s (listed (fold_left (fun m e => enlist (fst e) (snd e) m) l m) r) <->
    In (r, s) l \/ In s (listed m r)).
  { induction l as [| [x y] l IH]; intros m; simpl; [tauto |]. rewrite IH, listed_enlist. simpl.
    destruct (Z.eqb_spec x r) as [-> | N]; simpl; intuition congruence. }
  rewrite H, listed_empty. simpl. tauto.
Qed.

Definition resource_table (i : instance) : Map.t resource := index resource_id (resources i).

(** The ticks that the robot needs in the resource. *)
Definition takes_in (table : Map.t resource) (a : robot) (id : Z) : Z :=
  match Map.find id table with Some r => least_stay a r | None => 1 end.

Definition room_in (table : Map.t resource) (id : Z) : Z :=
  match Map.find id table with Some r => capacity r | None => 0 end.

Lemma table_finds_resources i id : Well_formed i ->
  Map.find id (resource_table i) = find (fun r => resource_id r =? id) (resources i).
Proof.
  intros right. pose proof (find_in_index resource_id (resources i) id) as F.
  destruct (find _ (resources i)) as [r |] eqn:E.
  - apply find_some in E as [Hr Eq]. apply Z.eqb_eq in Eq. apply F; auto. apply (resource_ids_are_unique i right).
  - apply find_in_index_none; [apply (resource_ids_are_unique i right) |]. intros H.
    apply in_map_iff in H as (r & Eq & Hr). apply (find_none _ _ E) in Hr. apply Z.eqb_neq in Hr. auto.
Qed.

Lemma takes_what_is_needed i a id : Well_formed i -> takes_in (resource_table i) a id = need i a id.
Proof. intros right. unfold takes_in, need. rewrite table_finds_resources by auto. reflexivity. Qed.

Lemma room_is_looked_up i id : Well_formed i -> room_in (resource_table i) id = room i id.
Proof. intros right. unfold room_in, room. rewrite table_finds_resources by auto. reflexivity. Qed.

(** * Prices *)

(** The amounts of prices added up by their keys; a price without a key is left out. *)
Definition pair_tally (key : price -> option (Z * Z)) (xs : list price) : Pair_map.t Z :=
  fold_left (fun m x =>
    match key x with
    | Some k => Pair_map.add k (amount x + match Pair_map.find k m with Some n => n | None => 0 end) m
    | None => m
    end) xs (Pair_map.empty Z).

Definition triple_tally (key : price -> option (Z * (Z * Z))) (xs : list price) : Triple_map.t Z :=
  fold_left (fun m x =>
    match key x with
    | Some k => Triple_map.add k (amount x + match Triple_map.find k m with Some n => n | None => 0 end) m
    | None => m
    end) xs (Triple_map.empty Z).

Definition pair_at (m : Pair_map.t Z) (x y : Z) : Z := match Pair_map.find (x, y) m with Some n => n | None => 0 end.
Definition triple_at (m : Triple_map.t Z) (x y z : Z) : Z :=
  match Triple_map.find (x, (y, z)) m with Some n => n | None => 0 end.

Lemma pair_tally_is_the_sum key xs x y (chosen : price -> bool) :
  (forall p, chosen p = true <-> key p = Some (x, y)) -> pair_at (pair_tally key xs) x y = priced xs chosen.
Proof.
  intros C. unfold pair_tally. rewrite <- (Z.add_0_l (priced xs chosen)).
  change 0 with (pair_at (Pair_map.empty Z) x y) at 2. generalize (Pair_map.empty Z).
  induction xs as [| p xs IH]; intros m; [unfold priced; simpl; lia |]. cbn [fold_left]. rewrite IH.
  change (priced (p :: xs) chosen) with (amount p * Z.b2z (chosen p) + priced xs chosen). specialize (C p).
  destruct (key p) as [k |]; [| destruct (chosen p); [destruct C as [C _]; discriminate C; auto | simpl; lia]].
  unfold pair_at at 1. rewrite Pair_facts.add_o. destruct (Z_pair.eq_dec k (x, y)) as [E | E].
  - unfold Z_pair.eq in E. subst k. rewrite (proj2 C eq_refl). fold (pair_at m x y). simpl. lia.
  - destruct (chosen p); [destruct E; destruct C as [C _]; injection (C eq_refl); auto |]. fold (pair_at m x y).
    simpl. lia.
Qed.

Lemma triple_tally_is_the_sum key xs x y z (chosen : price -> bool) :
  (forall p, chosen p = true <-> key p = Some (x, (y, z))) -> triple_at (triple_tally key xs) x y z = priced xs chosen.
Proof.
  intros C. unfold triple_tally. rewrite <- (Z.add_0_l (priced xs chosen)).
  change 0 with (triple_at (Triple_map.empty Z) x y z) at 2. generalize (Triple_map.empty Z).
  induction xs as [| p xs IH]; intros m; [unfold priced; simpl; lia |]. cbn [fold_left]. rewrite IH.
  change (priced (p :: xs) chosen) with (amount p * Z.b2z (chosen p) + priced xs chosen). specialize (C p).
  destruct (key p) as [k |]; [| destruct (chosen p); [destruct C as [C _]; discriminate C; auto | simpl; lia]].
  unfold triple_at at 1. rewrite Triple_facts.add_o. destruct (Z_triple.eq_dec k (x, (y, z))) as [E | E].
  - unfold Z_triple.eq in E. subst k. rewrite (proj2 C eq_refl). fold (triple_at m x y z). simpl. lia.
  - destruct (chosen p); [destruct E; destruct C as [C _]; injection (C eq_refl); auto |]. fold (triple_at m x y z).
    simpl. lia.
Qed.

(** The first tick from which on there are no prices. *)
Definition last_tick (xs : list price) : Z := fold_left (fun end_ x => Z.max end_ (tick x + 1)) xs 0.

Lemma no_price_is_later x xs : In x xs -> tick x < last_tick xs.
Proof.
  unfold last_tick. assert (H : forall l n, n <= fold_left (fun end_ x => Z.max end_ (tick x + 1)) l n).
  { induction l as [| y l IH]; intros n; simpl; [lia |]. specialize (IH (Z.max n (tick y + 1))). lia. }
  generalize 0. induction xs as [| y xs IH]; intros n; simpl; [intros [] |]. intros [-> | Hx]; auto.
  specialize (H xs (Z.max n (tick x + 1))). lia.
Qed.

Definition key_here (x : price) := match other x with None => Some (place x, tick x) | Some _ => None end.
Definition key_across (x : price) := match other x with Some _ => Some (place x, tick x) | None => None end.
Definition key_exchange (x : price) := match other x with Some o => Some (place x, (o, tick x)) | None => None end.

Definition tariff_of (xs : list price) : tariff :=
  let heres := pair_tally key_here xs in
  let acrosses := pair_tally key_across xs in
  let exchanges := triple_tally key_exchange xs in
  Tariff (pair_at heres) (pair_at acrosses) (triple_at exchanges) (last_tick xs).

Lemma tariff_holds_prices xs : (forall x, In x xs -> 0 <= amount x) -> Holds_prices (tariff_of xs) xs.
Proof.
  intros H. constructor; simpl; auto using no_price_is_later; intros.
  - apply pair_tally_is_the_sum. intros p. unfold is_here, key_here. destruct (other p); [split; discriminate |].
    rewrite andb_true_iff, !Z.eqb_eq. split; [intros [<- <-] | injection 1]; auto.
  - apply pair_tally_is_the_sum. intros p. unfold is_across, key_across. destruct (other p); [| split; discriminate].
    rewrite andb_true_iff, !Z.eqb_eq. split; [intros [<- <-] | injection 1]; auto.
  - apply triple_tally_is_the_sum. intros p. unfold is_exchange, key_exchange.
    destruct (other p); [| split; discriminate].
    rewrite !andb_true_iff, !Z.eqb_eq. split; [intros [[<- <-] <-] | injection 1]; auto.
Qed.

(** * Evidence given as lists *)

Definition pairs_of (l : list (Z * Z * Z)) : Pair_map.t Z :=
  fold_left (fun m x => Pair_map.add (fst x) (snd x) m) l (Pair_map.empty Z).

Lemma found_pair_is_listed l k n : Pair_map.find k (pairs_of l) = Some n -> In (k, n) l.
Proof.
  unfold pairs_of.
  assert (H : forall m, Pair_map.find k (fold_left (fun m x => Pair_map.add (fst x) (snd x) m) l m) = Some n ->
    In (k, n) l \/ Pair_map.find k m = Some n).
  { induction l as [| [j y] l IH]; intros m; simpl; auto. intros F. apply IH in F as [F | F]; auto.
    simpl in F. rewrite Pair_facts.add_o in F. destruct (Z_pair.eq_dec j k) as [E | E]; auto.
    unfold Z_pair.eq in E. injection F as <-. subst j. auto. }
  intros F. apply H in F as [F | F]; auto. rewrite Pair_facts.empty_o in F. discriminate.
Qed.
