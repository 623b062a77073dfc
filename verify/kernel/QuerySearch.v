(** The search of the query settles every window that the robot can enter, at its earliest entry. *)
Require Import ZArith List Bool Lia SetoidList.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context Past Query.
Import ListNotations.
Open Scope Z_scope.

(** * The least allowed entry *)

Section Entry.
Variables (known : lookup) (c : context).

(** How many of the committed moves are made at the tick or later. *)
Definition moves_from (tick : Z) : nat :=
  length (filter (fun m => tick <=? fst m) (Triples.S.elements (moves_made c))).

Lemma filter_is_shorter {A} (f g : A -> bool) l : (forall x, f x = true -> g x = true) ->
  (length (filter f l) <= length (filter g l))%nat.
Proof.
  intros H. induction l as [|y l IH]; simpl; [lia|].
  destruct (f y) eqn:F; [rewrite (H y F); simpl; lia|]. destruct (g y); simpl; lia.
Qed.

Lemma filter_is_strictly_shorter {A} (f g : A -> bool) x l : (forall y, f y = true -> g y = true) ->
  In x l -> f x = false -> g x = true -> (length (filter f l) < length (filter g l))%nat.
Proof.
  intros H X F G. apply in_split in X as (b & r & ->). rewrite !filter_app, !app_length. simpl. rewrite F, G. simpl.
  pose proof (filter_is_shorter f g b H). pose proof (filter_is_shorter f g r H). lia.
Qed.

Lemma exchange_is_passed from to tick : is_exchange known c from to tick = true ->
  (moves_from (tick + 1) < moves_from tick)%nat.
Proof.
  unfold is_exchange, Triples.contains. intros E. apply existsb_exists in E as (n & N & E).
  apply in_flat_map in N as (one & _ & N). apply in_map_iff in N as (other & <- & _).
  apply Triples.S.mem_2, Triples.S.elements_1 in E. apply InA_alt in E as (m & <- & M).
  refine (filter_is_strictly_shorter _ _ _ _ _ M _ _); simpl; intros; lia.
Qed.

Lemma first_allowed_skips from to moves_left : forall tick, let found := first_allowed known c from to moves_left tick in
  tick <= found /\ (forall other, tick <= other < found -> is_exchange known c from to other = true) /\
  ((moves_from tick <= moves_left)%nat -> is_exchange known c from to found = false).
Proof.
  induction moves_left as [|fewer IH]; intros tick; simpl.
  - repeat split; [lia | lia|]. intros M. destruct (is_exchange known c from to tick) eqn:E; auto.
    apply exchange_is_passed in E. lia.
  - destruct (is_exchange known c from to tick) eqn:E; [|repeat split; auto; lia].
    destruct (IH (tick + 1)) as (L & S & A). repeat split; [lia| |].
    + intros other O. destruct (Z.eq_dec other tick) as [->|]; [exact E | apply S; lia].
    + intros M. apply A. apply exchange_is_passed in E. lia.
Qed.

(** The first tick allowed is no exchange, and no tick before it is allowed. *)
Theorem entry_is_the_least_allowed from to tick :
  let found := first_allowed known c from to (Triples.S.cardinal (moves_made c)) tick in
  tick <= found /\ is_exchange known c from to found = false /\
  forall other, tick <= other -> is_exchange known c from to other = false -> found <= other.
Proof.
  cbv zeta. destruct (first_allowed_skips from to (Triples.S.cardinal (moves_made c)) tick) as (L & S & A).
  repeat split; auto.
  - apply A. rewrite Triples.S.cardinal_1. unfold moves_from.
    induction (Triples.S.elements (moves_made c)) as [|m l IH]; simpl; [lia|]. destruct (tick <=? fst m); simpl; lia.
  - intros other O E. apply Z.nlt_ge. intros B. rewrite S in E by lia. discriminate.
Qed.
End Entry.

(** * One step *)

(** The window of a label. *)
Definition cell (l : label) : Z * window := (resource_id (target l), room l).

Lemma same_window_iff one other : same_window one other = true <-> cell one = cell other.
Proof.
  unfold same_window, cell. destruct (room one) as [o c], (room other) as [p d]. simpl.
  rewrite !andb_true_iff, !Z.eqb_eq, same_end_iff. split.
  - intros [[-> ->] ->]. reflexivity.
  - intros E. injection E. auto.
Qed.

Lemma earliest_is_least ls : match earliest ls with
  | Some e => In e ls /\ forall l, In l ls -> entry e <= entry l
  | None => ls = []
  end.
Proof.
  induction ls as [|l ls IH]; simpl; auto. destruct (earliest ls) as [e|].
  - destruct IH as [I L]. destruct (Z.ltb_spec (entry e) (entry l)).
    + split; auto. intros x [<-|X]; [lia | auto].
    + split; auto. intros x [<-|X]; [lia | specialize (L x X); lia].
  - subst. split; auto. intros x [<-|[]]. lia.
Qed.

Section Search.
Variables (i : instance) (known : lookup) (c : context) (a : robot).
Hypothesis ids_are_unique :
  forall r s, In r (resources i) -> In s (resources i) -> resource_id r = resource_id s -> r = s.
Hypothesis stays_are_positive : forall r, In r (resources i) -> 1 <= least_stay a r.

(** The label [e] is entered by a move from the label [l], at the tick [entry e]. *)
Record Moved (l e : label) : Prop := {
  has_resource : In (target e) (resources i);
  has_window : In (room e) (windows_in c (target e));
  makes_move : has_move known (resource_id (target l)) (resource_id (target e)) = true;
  is_no_exchange : is_exchange known c (resource_id (target l)) (resource_id (target e)) (entry e) = false;
  is_ready : ready_from l <= entry e;
  was_in_room : lasts (room l) (Some (entry e)) = true;
  fits : holds_stay (room e) (entry e) (Some (ready_from e)) = true;
  stays_least : ready_from e = entry e + least_stay a (target e);
  comes_from : behind e = behind l ++ [visit_until l (Some (entry e))]
}.

Lemma first_entry_is_least l r w : let found := first_entry known c l r w in
  Z.max (ready_from l) (opens w) <= found /\ is_exchange known c (resource_id (target l)) (resource_id r) found = false /\
  forall tick, Z.max (ready_from l) (opens w) <= tick ->
  is_exchange known c (resource_id (target l)) (resource_id r) tick = false -> found <= tick.
Proof. apply entry_is_the_least_allowed. Qed.

Lemma expansion_is_moved l e : In e (expand i known c a l) -> Moved l e.
Proof.
  unfold expand. intros E. apply in_flat_map in E as (r & R & E). apply filter_In in R as [R M].
  apply in_flat_map in E as (w & W & E). unfold move_into in E. cbv zeta in E.
  destruct (first_entry_is_least l r w) as (L & X & _). set (tick := first_entry known c l r w) in *.
  destruct (lasts (room l) (Some tick)) eqn:Q; [|destruct E].
  destruct (holds_stay w tick (Some (tick + least_stay a r))) eqn:F; [|destruct E].
  destruct E as [<-|[]]. split; simpl; auto. lia.
Qed.

(** If the robot may move into a window at some tick, the search enters it then or before. *)
Lemma allowed_entry_is_found l r w tick : In r (resources i) -> In w (windows_in c r) ->
  has_move known (resource_id (target l)) (resource_id r) = true ->
  is_exchange known c (resource_id (target l)) (resource_id r) tick = false ->
  ready_from l <= tick -> lasts (room l) (Some tick) = true ->
  holds_stay w tick (Some (tick + least_stay a r)) = true ->
  exists e, In e (expand i known c a l) /\ target e = r /\ room e = w /\ entry e <= tick.
Proof.
  intros R W M X T Q F.
  destruct (first_entry_is_least l r w) as (L & _ & A). set (first := first_entry known c l r w) in *.
  unfold holds_stay, lasts in *. apply andb_true_iff in F as [O F]. specialize (A tick ltac:(lia) X).
  exists (Label r w first (first + least_stay a r) (behind l ++ [visit_until l (Some first)])).
  repeat split; auto. unfold expand. apply in_flat_map. exists r. split; [apply filter_In; auto|].
  apply in_flat_map. exists w. split; auto. unfold move_into. cbv zeta. fold first.
  replace (lasts (room l) (Some first) && holds_stay w first (Some (first + least_stay a r))) with true;
    [left; reflexivity|]. symmetry. unfold holds_stay, lasts. rewrite !andb_true_iff. repeat split; [|lia|].
  - destruct (closes (room l)); auto. lia.
  - destruct (closes w); auto. lia.
Qed.

(** * The search *)

(** The labels that moves lead to from the first one. *)
Inductive Reached (from : label) : label -> Prop :=
| reached_at_once : Reached from from
| reached_by_move l e : Reached from l -> Moved l e -> Reached from e.

Definition Entered (from e : label) : Prop := exists l, Reached from l /\ Moved l e.

Lemma entered_is_reached from e : Entered from e -> Reached from e.
Proof. intros (l & R & M). exact (reached_by_move from l e R M). Qed.

Lemma entry_before_ready from e : Entered from e -> entry e < ready_from e.
Proof.
  intros (l & _ & M). pose proof (stays_are_positive _ (has_resource l e M)). rewrite (stays_least l e M). lia.
Qed.

(** Every window into which a move leads has a label with an entry that is no later. *)
Definition Covered (ls : list label) (e : label) : Prop := exists l, In l ls /\ cell l = cell e /\ entry l <= entry e.

Definition all_cells : list (Z * window) :=
  flat_map (fun r => map (fun w => (resource_id r, w)) (windows_in c r)) (resources i).

Lemma number_of_cells : length all_cells = number_of_windows i c.
Proof.
  unfold all_cells, number_of_windows. generalize (resources i) as rs. induction rs as [|r rs IH]; simpl; auto.
  rewrite !app_length, map_length, IH. reflexivity.
Qed.

Lemma entered_cell from e : Entered from e -> In (cell e) all_cells.
Proof.
  intros (l & _ & M). apply in_flat_map. exists (target e). split; [exact (has_resource l e M)|].
  unfold cell. apply (in_map (fun w => (resource_id (target e), w))). exact (has_window l e M).
Qed.

(** What holds at every step of the search: windows are settled in the order of their entries, each once. *)
Record Searching (from : label) (settled queue : list label) : Prop := {
  are_entered : forall l, In l (settled ++ queue) -> Entered from l;
  are_covered : forall l e, l = from \/ In l settled -> In e (expand i known c a l) -> Covered (settled ++ queue) e;
  are_in_order : forall l e, In l settled -> In e queue -> entry l <= entry e;
  are_settled_once : NoDup (map cell settled);
  are_not_settled : forall e, In e queue -> ~ In (cell e) (map cell settled)
}.

Lemma is_settled_iff e settled : existsb (same_window e) settled = true <-> In (cell e) (map cell settled).
Proof.
  rewrite existsb_exists, in_map_iff. setoid_rewrite same_window_iff.
  split; intros (l & H); exists l; intuition.
Qed.

Lemma search_goes_on from settled queue l : Searching from settled queue -> earliest queue = Some l ->
  Searching from (l :: settled)
    (filter (fun e => negb (existsb (same_window e) (l :: settled))) (queue ++ expand i known c a l)).
Proof.
  intros [E C O N U] L. pose proof (earliest_is_least queue) as K. rewrite L in K. destruct K as [Q K].
  set (rest := filter _ _).
  assert (R : forall e, In e rest <->
    (In e queue \/ In e (expand i known c a l)) /\ ~ In (cell e) (map cell (l :: settled))).
  { intros e. unfold rest. rewrite filter_In, in_app_iff, negb_true_iff, <- not_true_iff_false, is_settled_iff. tauto. }
  assert (T : Entered from l) by (apply E, in_or_app; auto).
  assert (G : forall e, In e (expand i known c a l) -> entry l <= entry e).
  { intros e X. pose proof (entry_before_ready from l T). pose proof (is_ready l e (expansion_is_moved l e X)). lia. }
  assert (V : forall e, In e (queue ++ expand i known c a l) -> Covered ((l :: settled) ++ rest) e).
  { intros e X.
    destruct (existsb (same_window e) (l :: settled)) eqn:B.
    - apply is_settled_iff, in_map_iff in B as (x & F & [<-|S]).
      + exists l. split; [left; auto|]. split; auto. apply in_app_or in X as [X|X]; auto.
      + exists x. split; [right; apply in_or_app; auto|]. split; auto. apply in_app_or in X as [X|X]; auto.
        specialize (O x l S Q). specialize (G e X). lia.
    - exists e. split; [|split; [reflexivity | lia]]. apply in_or_app. right. apply R.
      apply in_app_or in X. split; auto.
      intros Y. apply is_settled_iff in Y. congruence. }
  split.
  - intros x X. apply in_app_or in X as [[<-|X]|X]; auto; [apply E, in_or_app; auto|].
    apply R in X as [[X|X] _]; [apply E, in_or_app; auto|]. exists l. split; [exact (entered_is_reached from l T)|].
    apply expansion_is_moved. exact X.
  - intros x e [X|[<-|X]] Y; [| apply V, in_or_app; auto |]; (destruct (C x e) as (z & Z & F & M); auto);
      (apply in_app_or in Z as [Z|Z]; [exists z; repeat split; auto; right; apply in_or_app; auto|]);
      (destruct (V z) as (y & I & J & H); [apply in_or_app; auto|]); exists y; repeat split; auto; try congruence; lia.
  - intros x e [<-|X] Y; apply R in Y as [[Y|Y] _]; auto. specialize (O x l X Q). specialize (G e Y). lia.
  - simpl. constructor; auto.
  - intros e X. apply R in X. tauto.
Qed.

Lemma settled_windows_are_covered from windows_left : forall settled queue, Searching from settled queue ->
  (number_of_windows i c <= windows_left + length settled)%nat ->
  Searching from (settle i known c a windows_left settled queue) [].
Proof.
  induction windows_left as [|fewer IH]; intros settled queue S N.
  - simpl. assert (Q : queue = []); [|rewrite <- Q; exact S]. destruct queue as [|e queue]; auto. exfalso.
    assert (D : NoDup (map cell (e :: settled))).
    { simpl. constructor; [|exact (are_settled_once _ _ _ S)]. apply (are_not_settled _ _ _ S). left. auto. }
    assert (I : incl (map cell (e :: settled)) all_cells).
    { intros x X. apply in_map_iff in X as (l & <- & L). apply (entered_cell from), (are_entered _ _ _ S).
      apply in_or_app. destruct L as [<-|L]; simpl; auto. }
    pose proof (NoDup_incl_length D I) as K. rewrite number_of_cells, map_length in K. simpl in K. lia.
  - simpl. pose proof (earliest_is_least queue) as L. destruct (earliest queue) as [l|] eqn:E; [|rewrite <- L; exact S].
    apply IH; [exact (search_goes_on from settled queue l S E) | simpl; lia].
Qed.

Lemma search_begins from : Searching from [] (expand i known c a from).
Proof.
  split; simpl; auto; try tauto.
  - intros l L. exists from. split; [constructor | exact (expansion_is_moved from l L)].
  - intros l e [->|[]] E. exists e. repeat split; auto. lia.
  - constructor.
Qed.

(** Every label of the search is reached by moves. *)
Theorem labels_are_reached from l : In l (labels i known c a from) -> l = from \/ Entered from l.
Proof.
  intros [<-|L]; [auto|]. right. pose proof (settled_windows_are_covered from _ _ _ (search_begins from)
    ltac:(simpl; rewrite Nat.add_0_r; apply le_n)) as S.
  apply (are_entered _ _ _ S). rewrite app_nil_r. exact L.
Qed.

(** From every label every move leads into a window that has a label, with an entry that is no later. *)
Theorem labels_are_closed from l e : In l (labels i known c a from) -> In e (expand i known c a l) ->
  exists again, In again (labels i known c a from) /\ Entered from again /\ cell again = cell e /\
  entry again <= entry e.
Proof.
  intros L E. pose proof (settled_windows_are_covered from _ _ _ (search_begins from)
    ltac:(simpl; rewrite Nat.add_0_r; apply le_n)) as S.
  assert (C : Covered (settle i known c a (number_of_windows i c) [] (expand i known c a from) ++ []) e).
  { apply (are_covered _ _ _ S l); auto. destruct L as [<-|L]; auto. }
  destruct C as (x & X & F & M). exists x. repeat split; auto.
  - right. rewrite app_nil_r in X. exact X.
  - apply (are_entered _ _ _ S). exact X.
Qed.

Lemma move_is_labelled from l again e : In again (labels i known c a from) -> cell again = cell l ->
  ready_from again <= ready_from l -> Moved l e ->
  exists settled, In settled (labels i known c a from) /\ Entered from settled /\ cell settled = cell e /\
  entry settled <= entry e.
Proof.
  intros L C T M. injection C as C D.
  destruct (allowed_entry_is_found again (target e) (room e) (entry e)) as (x & X & E & F & N); rewrite ?C, ?D.
  - exact (has_resource l e M).
  - exact (has_window l e M).
  - exact (makes_move l e M).
  - exact (is_no_exchange l e M).
  - pose proof (is_ready l e M). lia.
  - exact (was_in_room l e M).
  - rewrite <- (stays_least l e M). exact (fits l e M).
  - destruct (labels_are_closed from again x L X) as (settled & S & Y & Z & O). exists settled.
    repeat split; auto; [|lia]. rewrite Z. unfold cell. congruence.
Qed.

(** The entry at which the search settles a window is final: no moves lead into the window earlier, wherever the robot
    waits on its way. *)
Theorem settled_entry_is_final from e : Entered from e ->
  exists l, In l (labels i known c a from) /\ Entered from l /\ cell l = cell e /\ entry l <= entry e.
Proof.
  intros (l & R & M). revert e M. induction R as [|before l R IH B]; intros e M.
  - apply (move_is_labelled from from from e); auto; [left; reflexivity | lia].
  - destruct (IH l B) as (again & L & (x & _ & X) & C & T). apply (move_is_labelled from l again e); auto.
    rewrite (stays_least _ _ X), (stays_least _ _ B). injection C as C _.
    rewrite (ids_are_unique _ _ (has_resource _ _ X) (has_resource _ _ B) C). lia.
Qed.
End Search.
