(** Graphs of dependencies: ticks that keep their edges, and cycles, in which everybody waits for ever.

    The functions are there for their proofs: none is faster than it must be to be right. *)
Require Import ZArith List Bool Lia Relations.
Import ListNotations.
Open Scope Z_scope.

(** A robot and the number of a visit of its plan; the first has number 0. *)
Definition node := (Z * nat)%type.
Definition next (n : node) : node := (fst n, S (snd n)).
Definition same (m n : node) : bool := (fst m =? fst n) && (snd m =? snd n)%nat.

(** The visit [later] is entered no earlier than [ticks] after [earlier] has been entered. Where [by_staying] holds,
    these are the ticks for which the robot stays where [earlier] enters. *)
Record dependency := Dependency { earlier : node; later : node; ticks : Z; by_staying : bool }.

(** When each visit is entered. *)
Definition times := node -> Z.

Definition Keeps (t : times) (e : dependency) : Prop := t (earlier e) + ticks e <= t (later e).

Lemma same_iff m n : same m n = true <-> m = n.
Proof.
  unfold same. destruct m as [a b], n as [c d]. simpl. rewrite andb_true_iff, Z.eqb_eq, Nat.eqb_eq.
  split; [intros []; congruence | intros E; injection E; auto].
Qed.

(** * The earliest ticks *)

Definition is_kept (t : times) (e : dependency) : bool := t (earlier e) + ticks e <=? t (later e).

(** Enter the visit [later] as early as the edge allows. *)
Definition postponed (t : times) (e : dependency) : times :=
  fun n => if same n (later e) then t (earlier e) + ticks e else t n.

(** Postpone visits until all edges are kept, in at most that number of steps. *)
Fixpoint settled (edges : list dependency) (steps : nat) (t : times) : times :=
  match find (fun e => negb (is_kept t e)) edges with
  | None => t
  | Some e => match steps with O => t | S fewer => settled edges fewer (postponed t e) end
  end.

(** How far the ticks are from others, all together. *)
Definition distance (t other : times) (ns : list node) : Z := fold_right (fun n sum => other n - t n + sum) 0 ns.

Section Earliest.
Variable edges : list dependency.

Lemma found_is_not_kept t e : find (fun e => negb (is_kept t e)) edges = Some e ->
  In e edges /\ t (later e) < t (earlier e) + ticks e.
Proof.
  intros F. apply find_some in F as [I F]. split; [exact I|]. unfold is_kept in F.
  destruct (Z.leb_spec (t (earlier e) + ticks e) (t (later e))); [discriminate | lia].
Qed.

(** Ticks that keep all edges are nowhere earlier than the settled ones, if they were not before. *)
Lemma settled_is_least steps : forall t other, (forall e, In e edges -> Keeps other e) ->
  (forall n, t n <= other n) -> forall n, settled edges steps t n <= other n.
Proof.
  induction steps as [|steps IH]; intros t other K L; simpl; destruct (find _ edges) as [e|] eqn:F; auto.
  apply IH; auto. apply found_is_not_kept in F as [I _]. intros n. unfold postponed.
  destruct (same n (later e)) eqn:S0; auto. apply same_iff in S0 as ->.
  specialize (K e I). specialize (L (earlier e)). unfold Keeps in K. lia.
Qed.

Lemma settled_is_no_earlier steps : forall t n, t n <= settled edges steps t n.
Proof.
  induction steps as [|steps IH]; intros t n; simpl; destruct (find _ edges) as [e|] eqn:F; try lia.
  apply found_is_not_kept in F as [_ F]. specialize (IH (postponed t e) n). unfold postponed at 1 in IH.
  destruct (same n (later e)) eqn:S0; [|exact IH]. apply same_iff in S0 as ->. lia.
Qed.

Lemma distance_is_positive t other ns : (forall n, t n <= other n) -> 0 <= distance t other ns /\
  forall n, In n ns -> t n < other n -> 0 < distance t other ns.
Proof.
  intros L. induction ns as [|m ns [IH IK]]; simpl; [split; [lia | tauto]|]. pose proof (L m).
  split; [lia|]. intros n [<-|N] M; [lia|]. specialize (IK n N M). lia.
Qed.

Lemma postponed_is_closer t other e ns : t (later e) < t (earlier e) + ticks e ->
  distance (postponed t e) other ns <= distance t other ns /\
  (In (later e) ns -> distance (postponed t e) other ns < distance t other ns).
Proof.
  intros L. induction ns as [|m ns [IH IK]]; simpl; [split; [lia | tauto]|].
  assert (P : postponed t e m = if same m (later e) then t (earlier e) + ticks e else t m) by reflexivity.
  destruct (same m (later e)) eqn:S0.
  - apply same_iff in S0 as ->. split; [lia|]. intros _. lia.
  - split; [lia|]. intros [E|H]; [|specialize (IK H); lia].
    assert (same m (later e) = true) by (apply same_iff; exact E). congruence.
Qed.

(** With as many steps as the ticks are from ticks that keep all edges, all edges are kept. *)
Lemma settled_keeps_edges other ns steps : (forall e, In e edges -> Keeps other e /\ In (later e) ns) ->
  forall t, (forall n, t n <= other n) -> distance t other ns <= Z.of_nat steps ->
  forall e, In e edges -> Keeps (settled edges steps t) e.
Proof.
  intros K. induction steps as [|steps IH]; intros t L D; simpl; destruct (find _ edges) as [f|] eqn:F.
  - exfalso. apply found_is_not_kept in F as [I F]. destruct (K f I) as [G H].
    enough (0 < distance t other ns) by lia. apply (distance_is_positive t other ns L) with (later f); auto.
    specialize (L (earlier f)). unfold Keeps in G. lia.
  - intros e I. apply (find_none _ _ F) in I. apply negb_false_iff, Z.leb_le in I. exact I.
  - apply found_is_not_kept in F as [I F]. destruct (K f I) as [G H]. apply IH.
    + intros n. unfold postponed. destruct (same n (later f)) eqn:S0; auto. apply same_iff in S0 as ->.
      specialize (L (earlier f)). unfold Keeps in G. lia.
    + destruct (postponed_is_closer t other f ns F) as [_ C]. specialize (C H). lia.
  - intros e I. apply (find_none _ _ F) in I. apply negb_false_iff, Z.leb_le in I. exact I.
Qed.
End Earliest.

(** * Cycles *)

(** The second visit waits for the first. *)
Definition Waits (edges : list dependency) (m n : node) : Prop :=
  exists e, In e edges /\ earlier e = m /\ later e = n.

(** execution/acyclic: no visit waits for itself, by way of whatever others. *)
Definition Acyclic (edges : list dependency) : Prop := forall n, ~ clos_trans node (Waits edges) n n.

(** The visit waits for none of these. *)
Definition is_ready (edges : list dependency) (waiting : list node) (n : node) : bool :=
  forallb (fun e => negb (same (later e) n) || negb (existsb (same (earlier e)) waiting)) edges.

(** A way along edges, and how many ticks it takes at least. *)
Inductive Way (edges : list dependency) : node -> node -> Z -> Prop :=
  | Way_edge e : In e edges -> Way edges (earlier e) (later e) (ticks e)
  | Way_on m k n a b : Way edges m k a -> Way edges k n b -> Way edges m n (a + b).

Lemma ways_are_kept edges t m n k : (forall e, In e edges -> Keeps t e) -> Way edges m n k -> t m + k <= t n.
Proof. intros K W. induction W as [e E|m k n a b _ A _ B]; [apply K; exact E | lia]. Qed.

(** The visits that are never entered if each is entered when those have been that it waits for. *)
Fixpoint stuck (edges : list dependency) (steps : nat) (waiting : list node) : list node :=
  match find (is_ready edges waiting) waiting with
  | None => waiting
  | Some n =>
    match steps with O => waiting | S fewer => stuck edges fewer (filter (fun m => negb (same n m)) waiting) end
  end.
Definition is_acyclic (edges : list dependency) (ns : list node) : bool :=
  match stuck edges (length ns) ns with [] => true | _ => false end.

Lemma filter_is_no_longer {A} (f : A -> bool) l : (length (filter f l) <= length l)%nat.
Proof. induction l as [|x l IH]; simpl; [lia|]. destruct (f x); simpl; lia. Qed.

Lemma way_of_steps (R S : relation node) : (forall m n, R m n -> clos_trans node S m n) ->
  forall m n, clos_trans node R m n -> clos_trans node S m n.
Proof. intros H m n C. induction C as [m n K|]; [exact (H m n K) | eapply t_trans; eauto]. Qed.

Lemma way_waits edges m n k : Way edges m n k -> clos_trans node (Waits edges) m n.
Proof. intros W. induction W as [e E|]; [apply t_step; exists e; auto | eapply t_trans; eauto]. Qed.

(** Where everybody waits for another of finitely many, there is a cycle. *)
Lemma waiting_for_each_other_is_a_cycle (size : nat) : forall (R : relation node) (ns : list node),
  (length ns <= size)%nat -> ns <> [] -> (forall n, In n ns -> exists m, In m ns /\ R m n) ->
  exists n, clos_trans node R n n.
Proof.
  induction size as [|size IH]; intros R [|x ns] L N W; simpl in L; try congruence; try lia.
  set (others := filter (fun m => negb (same x m)) ns).
  assert (O : forall n, In n others <-> In n ns /\ n <> x).
  { intros n. unfold others. rewrite filter_In, negb_true_iff. destruct (same x n) eqn:S0.
    - apply same_iff in S0 as ->. intuition congruence.
    - split; [|tauto]. intros [I _]. split; [exact I|]. intros ->.
      assert (same x x = true) by (apply same_iff; reflexivity). congruence. }
  assert (D : forall m, In m (x :: ns) -> m = x \/ In m others).
  { intros m M. destruct (same m x) eqn:S0; [left; apply same_iff; exact S0|]. right. apply O.
    assert (m <> x) by (intros ->; assert (same x x = true) by (apply same_iff; reflexivity); congruence).
    destruct M; [congruence | tauto]. }
  destruct (W x (or_introl eq_refl)) as (y & Y & XY). destruct (D y Y) as [->|Y'].
  { exists x. apply t_step. exact XY. }
  destruct (IH (fun m n => R m n \/ R m x /\ R x n) others) as (z & Z0).
  - unfold others. pose proof (filter_is_no_longer (fun m => negb (same x m)) ns). lia.
  - intros E. rewrite E in Y'. destruct Y'.
  - intros n I. destruct (W n (or_intror (proj1 (proj1 (O n) I)))) as (m & M & MN).
    destruct (D m M) as [->|M']; [exists y | exists m]; auto.
  - exists z. eapply way_of_steps; [|exact Z0]. intros m n [H|[H K]]; [apply t_step; exact H|].
    apply t_trans with x; apply t_step; assumption.
Qed.

Section Graph.
Variables (edges : list dependency) (ns : list node).
Hypothesis edges_join_nodes : forall e, In e edges -> In (earlier e) ns /\ In (later e) ns.

Lemma is_ready_iff waiting n : is_ready edges waiting n = true <-> forall m, Waits edges m n -> ~ In m waiting.
Proof.
  unfold is_ready. rewrite forallb_forall. split.
  - intros H m (e & E & <- & <-) M. specialize (H e E). apply orb_true_iff in H as [H|H]; apply negb_true_iff in H.
    + assert (same (later e) (later e) = true) by (apply same_iff; reflexivity). congruence.
    + assert (existsb (same (earlier e)) waiting = true); [|congruence].
      apply existsb_exists. exists (earlier e). split; [exact M | apply same_iff; reflexivity].
  - intros H e E. apply orb_true_iff. destruct (same (later e) n) eqn:S0; [right | left; reflexivity].
    apply same_iff in S0. apply negb_true_iff. destruct (existsb (same (earlier e)) waiting) eqn:X; auto.
    apply existsb_exists in X as (m & M & X). apply same_iff in X. subst m.
    destruct (H (earlier e)); auto. exists e. auto.
Qed.

Lemma not_ready waiting n : is_ready edges waiting n = false -> exists m, In m waiting /\ Waits edges m n.
Proof.
  unfold is_ready. intros H. induction edges as [|e l IH] in H |- *; [discriminate|]. simpl in H.
  apply andb_false_iff in H as [H|H].
  - apply orb_false_iff in H as [H K]. apply negb_false_iff, same_iff in H. apply negb_false_iff, existsb_exists in K.
    destruct K as (m & M & K). apply same_iff in K. exists m. split; [exact M|]. exists e. simpl. auto.
  - destruct (IH H) as (m & M & f & F & E). exists m. split; [exact M|]. exists f. simpl. tauto.
Qed.

(** While somebody waits, and no cycle is in the graph, somebody can enter. *)
Theorem no_deadlock waiting : Acyclic edges -> waiting <> [] ->
  exists n, In n waiting /\ forall m, Waits edges m n -> ~ In m waiting.
Proof.
  intros A W. destruct (find (is_ready edges waiting) waiting) as [n|] eqn:F.
  - apply find_some in F as [N R]. exists n. split; [exact N|]. apply is_ready_iff. exact R.
  - exfalso. destruct (waiting_for_each_other_is_a_cycle (length waiting) (Waits edges) waiting) as (n & C);
      [lia | exact W | | exact (A n C)].
    intros n N. apply not_ready. exact (find_none _ _ F n N).
Qed.

Lemma waits_in_a_cycle n : clos_trans node (Waits edges) n n ->
  exists m, Waits edges m n /\ clos_trans node (Waits edges) m m.
Proof.
  intros C. apply clos_trans_tn1 in C. inversion C as [? H|m ? H K]; subst.
  - exists n. split; [exact H | apply t_step; exact H].
  - exists m. split; [exact H|]. apply clos_tn1_trans in K. eapply t_trans; [apply t_step; exact H | exact K].
Qed.

(** Nobody who is in a cycle ever enters. *)
Lemma cycles_are_stuck steps n : clos_trans node (Waits edges) n n -> forall waiting,
  (forall m, clos_trans node (Waits edges) m m -> In m waiting) -> In n (stuck edges steps waiting).
Proof.
  intros C. induction steps as [|steps IH]; intros waiting W; simpl; destruct (find _ waiting) as [r|] eqn:F; auto.
  apply IH. intros m M. apply filter_In. split; [apply W; exact M|]. apply negb_true_iff.
  destruct (same r m) eqn:S0; auto. apply same_iff in S0. subst m. exfalso.
  apply find_some in F as [_ R]. destruct (waits_in_a_cycle r M) as (k & K & D).
  exact (proj1 (is_ready_iff waiting r) R k K (W k D)).
Qed.

Lemma nobody_waits_in_the_end steps : Acyclic edges -> forall waiting, (length waiting <= steps)%nat ->
  stuck edges steps waiting = [].
Proof.
  intros A. induction steps as [|steps IH]; intros waiting L; simpl.
  - destruct waiting; [reflexivity | simpl in L; lia].
  - destruct waiting as [|w waiting]; [reflexivity|].
    destruct (find _ (w :: waiting)) as [n|] eqn:F.
    + apply find_some in F as [N _]. apply IH.
      assert (H : forall l, In n l -> (length (filter (fun m => negb (same n m)) l) < length l)%nat).
      { clear. induction l as [|x l IH]; [intros []|]. intros H. simpl.
        pose proof (filter_is_no_longer (fun m => negb (same n m)) l). destruct (same n x) eqn:S0; simpl; [lia|].
        destruct H as [->|H]; [|specialize (IH H); lia].
        assert (same n n = true) by (apply same_iff; reflexivity). congruence. }
      specialize (H _ N). lia.
    + exfalso. destruct (no_deadlock (w :: waiting) A) as (n & N & R); [discriminate|].
      apply is_ready_iff in R. rewrite (find_none _ _ F n N) in R. discriminate.
Qed.

(** Everybody enters in the end if and only if the graph has no cycle. *)
Theorem nobody_is_stuck_exactly_when_acyclic : is_acyclic edges ns = true <-> Acyclic edges.
Proof.
  unfold is_acyclic. split.
  - intros H n C. destruct (stuck edges (length ns) ns) as [|x l] eqn:E; [|discriminate].
    enough (In n []) by auto. rewrite <- E. apply cycles_are_stuck; auto. intros m M.
    destruct (waits_in_a_cycle m M) as (k & (e & I & _ & <-) & _). apply edges_join_nodes. exact I.
  - intros A. rewrite nobody_waits_in_the_end; auto.
Qed.
End Graph.

(** * Switching *)

(** The second visit is entered no earlier than the first in each execution that keeps the edges. *)
Definition Reaches (edges : list dependency) : relation node := clos_refl_trans node (Waits edges).

Lemma way_reaches edges m n : clos_trans node (Waits edges) m n -> Reaches edges m n.
Proof. intros C. induction C as [m n H|]; [apply rt_step; exact H | eapply rt_trans; eauto]. Qed.

Lemma way_over_an_edge e edges m n : clos_trans node (Waits (e :: edges)) m n ->
  clos_trans node (Waits edges) m n \/ Reaches edges m (earlier e) /\ Reaches edges (later e) n.
Proof.
  intros C. induction C as [m n (f & [<-|F] & <- & <-)|m n k _ [H|[H K]] _ [L|[L M]]].
  - right. split; apply rt_refl.
  - left. apply t_step. exists f. auto.
  - left. eapply t_trans; eauto.
  - right. split; [|exact M]. eapply rt_trans; [|exact L]. apply way_reaches. exact H.
  - right. split; [exact H|]. eapply rt_trans; [exact K|]. apply way_reaches. exact L.
  - right. split; [exact H | exact M].
Qed.

(** A switch takes edges out of a graph without a cycle and puts one in: the graph then has no cycle if and only if no
    way leads back from where the new edge leads. *)
Theorem safe_switching_keeps_acyclicity edges kept e : Acyclic edges -> (forall f, In f kept -> In f edges) ->
  Acyclic (e :: kept) <-> ~ Reaches kept (later e) (earlier e).
Proof.
  intros A K. assert (A' : Acyclic kept).
  { intros n C. apply (A n). eapply way_of_steps; [|exact C]. intros m k (f & F & E).
    apply t_step. exists f. split; [apply K, F | exact E]. }
  split.
  - intros N R. apply (N (later e)). assert (S0 : Waits (e :: kept) (earlier e) (later e)) by (exists e; simpl; auto).
    assert (R' : Reaches (e :: kept) (later e) (earlier e)).
    { clear - R. induction R as [m n (f & F & E)|m|m n k _ H _ J]; [|apply rt_refl | eapply rt_trans; eauto].
      apply rt_step. exists f. simpl. tauto. }
    apply clos_rt_t with (earlier e); [exact R' | apply t_step; exact S0].
  - intros N n C. apply way_over_an_edge in C as [C|[C D]]; [exact (A' n C)|]. apply N. eapply rt_trans; eauto.
Qed.
