(** Lawful plans up to their arrival, as the formula of a total speaks of them: where a robot is free to leave, where it
    is, and when it arrives. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Ways Labels Bound.
Import ListNotations.
Open Scope Z_scope.

(** The visits up to the first one to the goal. *)
Fixpoint until (to : Z) (vs : list visit) : list visit :=
  match vs with
  | [] => []
  | v :: rest => if visit_resource v =? to then [v] else v :: until to rest
  end.

Lemma until_the_goal to v rest : until to (v :: rest) = if visit_resource v =? to then [v] else v :: until to rest.
Proof. reflexivity. Qed.

(** The visits that count. A robot that vanishes has arrived where it first enters its goal; going on only costs
    more. *)
Definition counted (i : instance) (a : robot) (vs : list visit) : list visit :=
  match after_goal i with Vanish => until (goal a) vs | Park => vs end.

(** A robot can go on from the resource. *)
Definition passable (i : instance) (a : robot) (r : Z) : bool :=
  match after_goal i with Vanish => negb (r =? goal a) | Park => true end.

(** Visits that lead to the robot's goal. *)
Inductive Route (i : instance) (a : robot) : list visit -> Prop :=
| Route_ends v : visit_resource v = goal a -> Route i a [v]
| Route_goes_on v w rest : passable i a (visit_resource v) = true -> enter v + need i a (visit_resource v) <= enter w ->
    Move i (visit_resource v) (visit_resource w) -> Route i a (w :: rest) -> Route i a (v :: w :: rest).

(** The robot has been in the resource for its duration by the tick, and moves on then or later. *)
Fixpoint is_free (i : instance) (a : robot) (vs : list visit) (r t : Z) : bool :=
  match vs with
  | v :: rest =>
      match rest with
      | w :: _ => (visit_resource v =? r) && (enter v + need i a r <=? t) && (t <=? enter w) || is_free i a rest r t
      | [] => false
      end
  | [] => false
  end.

(** The robot is in the resource at the tick. *)
Fixpoint is_in (i : instance) (a : robot) (vs : list visit) (r t : Z) : bool :=
  match vs with
  | v :: rest =>
      (visit_resource v =? r) && (enter v <=? t) &&
      match rest, after_goal i with
      | w :: _, _ => t <? enter w
      | [], Vanish => t <? enter v + need i a r
      | [], Park => true
      end || is_in i a rest r t
  | [] => false
  end.

(** Split what is decided: conjunctions, alternatives and comparisons. *)
Ltac decided := repeat match goal with
  | H : _ /\ _ |- _ => destruct H
  | H : _ && _ = true |- _ => apply andb_true_iff in H
  | H : (_ =? _) = true |- _ => apply Z.eqb_eq in H
  | H : (_ <=? _) = true |- _ => apply Z.leb_le in H
  | H : (_ <? _) = true |- _ => apply Z.ltb_lt in H
  | H : negb _ = true |- _ => apply negb_true_iff in H
  | H : (_ =? _) = false |- _ => apply Z.eqb_neq in H
  | H : (_ <=? _) = false |- _ => apply Z.leb_gt in H
  | H : (_ <? _) = false |- _ => apply Z.ltb_ge in H
  end.

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).

Let free := is_free i a.
Let inside := is_in i a.
Let takes := need i a.

(** * From plans to routes *)

Lemma counted_begins_alike v rest : exists later, counted i a (v :: rest) = v :: later.
Proof. unfold counted. simpl. destruct (after_goal i); eauto. destruct (_ =? _); eauto. Qed.

Lemma until_is_a_prefix to vs : exists later, vs = until to vs ++ later.
Proof.
  induction vs as [| v rest [later IH]]; simpl; [exists []; auto |].
  destruct (_ =? _); [exists rest; auto |]. exists later. simpl. congruence.
Qed.

Lemma counted_is_a_prefix vs : exists later, vs = counted i a vs ++ later.
Proof. unfold counted. destruct (after_goal i); [apply until_is_a_prefix | exists []; rewrite app_nil_r; auto]. Qed.

Lemma way_is_a_route vs : Way i a vs -> Route i a (counted i a vs).
Proof.
  unfold counted. intros H. induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH].
  - destruct (after_goal i); simpl; rewrite ?Hg, ?Z.eqb_refl; constructor; auto.
  - destruct (after_goal i) eqn:Policy.
    + cbn [until]. destruct (Z.eqb_spec (visit_resource v) (goal a)) as [E | D]; [constructor; auto |].
      cbn [until] in IH. destruct (visit_resource w =? goal a); apply Route_goes_on; auto;
        unfold passable; rewrite Policy; apply negb_true_iff, Z.eqb_neq; auto.
    + apply Route_goes_on; auto. unfold passable. rewrite Policy. auto.
Qed.

Lemma arrives_later v w rest : arrives (v :: w :: rest) = arrives (w :: rest).
Proof. reflexivity. Qed.

Lemma counted_arrives_no_later vs : Way i a vs -> arrives (counted i a vs) <= arrives vs.
Proof.
  unfold counted. destruct (after_goal i); [| lia]. intros H.
  induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH].
  - simpl. rewrite Hg, Z.eqb_refl. lia.
  - pose proof (way_does_not_arrive_before_it_starts i right a _ known Hw w rest eq_refl).
    pose proof (need_is_positive i a right known (visit_resource v)).
    rewrite arrives_later. cbn [until] in *.
    destruct (visit_resource v =? goal a); [unfold arrives at 1; simpl; lia |].
    destruct (visit_resource w =? goal a); rewrite arrives_later; exact IH.
Qed.

(** Where the robot is on its route, it is in its plan. *)
Lemma counted_visits_hold vs r t : Way i a vs -> inside (counted i a vs) r t = true ->
  exists v, In v vs /\ visit_resource v = r /\ Holds v t.
Proof.
  unfold counted, inside, Holds. intros H.
  induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros K.
  - exists v. destruct (after_goal i) eqn:Policy; cbn [until is_in] in K; rewrite ?Hg, ?Z.eqb_refl in K;
      cbn [is_in] in K; rewrite Policy, orb_false_r, ?Hg in K; decided; rewrite Hl; simpl; intuition; subst; lia.
  - destruct (after_goal i) eqn:Policy.
    + rewrite until_the_goal in K. destruct (Z.eqb_spec (visit_resource v) (goal a)) as [E | D].
      * exists v. cbn [is_in] in K. rewrite Policy, orb_false_r in K. decided. rewrite Hl. simpl.
        repeat split; auto. subst. lia.
      * assert (E : exists later, until (goal a) (w :: rest) = w :: later) by (simpl; destruct (_ =? _); eauto).
        destruct E as [later E]. rewrite E in *. cbn [is_in] in K. apply orb_true_iff in K as [K | K].
        -- exists v. decided. rewrite Hl. simpl. auto.
        -- destruct IH as (u & Hu & R); [exact K |]. exists u. simpl in *. tauto.
    + cbn [is_in] in K. apply orb_true_iff in K as [K | K].
      * exists v. decided. rewrite Hl. simpl. auto.
      * destruct IH as (u & Hu & R); [exact K |]. exists u. simpl in *. tauto.
Qed.

(** * Along a route *)

Lemma free_is_free_after v rest r t : free rest r t = true -> free (v :: rest) r t = true.
Proof. unfold free. destruct rest; [discriminate |]. cbn [is_free]. intros H. rewrite H. apply orb_true_r. Qed.

Lemma mover_is_free v w rest t : enter v + takes (visit_resource v) <= t -> t <= enter w ->
  free (v :: w :: rest) (visit_resource v) t = true.
Proof.
  intros H K. unfold free, takes in *. cbn [is_free]. rewrite Z.eqb_refl.
  rewrite (proj2 (Z.leb_le _ _) H), (proj2 (Z.leb_le _ _) K). reflexivity.
Qed.

Lemma route_arrives_after_its_start vs : Route i a vs -> forall v rest, vs = v :: rest -> enter v <= arrives vs.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; intros u later E; injection E as <- <-.
  - unfold arrives. simpl. lia.
  - pose proof (need_is_positive i a right known (visit_resource v)). specialize (IH w rest eq_refl).
    rewrite arrives_later. lia.
Qed.

(** A robot that is free waits, or moves on and is free again a duration later, or arrives. *)
Lemma free_robot_goes_on vs r t : Route i a vs -> free vs r t = true ->
  free vs r (t + 1) = true \/
  (exists s, Move i r s /\ free vs s (t + takes s) = true) \/
  (Move i r (goal a) /\ arrives vs = t).
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |].
  intros F. unfold free in F. cbn [is_free] in F. apply orb_true_iff in F as [F | F].
  - decided. subst r. destruct (Z.eq_dec t (enter w)) as [-> | D].
    + inversion Hw as [u Hg | u x later Hp' Hn' Hm' Hw']; subst.
      * right. right. split; [congruence | reflexivity].
      * right. left. exists (visit_resource w). split; auto. apply free_is_free_after, mover_is_free; unfold takes; lia.
    + left. apply mover_is_free; unfold takes; lia.
  - destruct (IH F) as [W | [(s & Hs & W) | (Hs & W)]].
    + left. apply free_is_free_after, W.
    + right. left. exists s. split; auto. apply free_is_free_after, W.
    + right. right. auto.
Qed.

(** A robot that is free was so one tick before, or moved here from where it was free, or is at its start. *)
Lemma free_robot_comes_from vs r t : Route i a vs -> free vs r t = true ->
  free vs r (t - 1) = true \/
  (exists s, Move i s r /\ free vs s (t - takes r) = true) \/
  (exists v rest, vs = v :: rest /\ r = visit_resource v /\ t = enter v + takes r).
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |].
  intros F. unfold free in F. cbn [is_free] in F. apply orb_true_iff in F as [F | F].
  - decided. subst r. destruct (Z.eq_dec t (enter v + takes (visit_resource v))) as [-> | D].
    + right. right. eauto.
    + left. apply mover_is_free; unfold takes in *; lia.
  - destruct (IH F) as [W | [(s & Hs & W) | (u & later & E & -> & ->)]].
    + left. apply free_is_free_after, W.
    + right. left. exists s. split; auto. apply free_is_free_after, W.
    + injection E as <- <-. right. left. exists (visit_resource v). split; auto. apply mover_is_free; unfold takes; lia.
Qed.

(** A robot is free just before it arrives, unless it starts at its goal and stays there. *)
Lemma arrival_comes_from vs : Route i a vs ->
  (exists s, Move i s (goal a) /\ free vs s (arrives vs) = true) \/
  (exists v, vs = [v] /\ visit_resource v = goal a).
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [right; eauto |]. left.
  destruct IH as [(s & Hs & F) | (u & E & Hg)].
  - exists s. split; auto. apply free_is_free_after, F.
  - injection E as -> ->. exists (visit_resource v). split; [congruence |]. apply mover_is_free; auto.
    unfold arrives. simpl. lia.
Qed.

Lemma inside_is_after_the_start vs r t : Route i a vs -> inside vs r t = true ->
  forall v rest, vs = v :: rest -> enter v <= t.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; intros K u later E; injection E as <- <-;
    unfold inside in K; cbn [is_in] in K; apply orb_true_iff in K as [K | K]; decided; auto; try discriminate.
  specialize (IH K w rest eq_refl). pose proof (need_is_positive i a right known (visit_resource v)). lia.
Qed.

Lemma free_is_after_the_start vs r t : Route i a vs -> free vs r t = true ->
  forall v rest, vs = v :: rest -> enter v < t.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; intros K u later E; injection E as <- <-; [discriminate |].
  unfold free in K; cbn [is_free] in K; apply orb_true_iff in K as [K | K].
  - decided. pose proof (need_is_positive i a right known r). lia.
  - specialize (IH K w rest eq_refl). pose proof (need_is_positive i a right known (visit_resource v)). lia.
Qed.

Lemma free_robot_can_pass vs r t : Route i a vs -> free vs r t = true -> passable i a r = true.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |]. intros F. unfold free in F.
  cbn [is_free] in F. apply orb_true_iff in F as [F | F]; auto. decided. congruence.
Qed.

(** A robot that is free to leave a resource has been in it for its duration. *)
Lemma free_robot_is_inside vs r t u : Route i a vs -> free vs r t = true -> u < t -> t <= u + takes r ->
  inside vs r u = true.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |].
  intros F L K. unfold free in F. cbn [is_free] in F. unfold inside. cbn [is_in]. apply orb_true_iff.
  apply orb_true_iff in F as [F | F]; [left | right; auto]. decided. unfold takes in K.
  rewrite !andb_true_iff, Z.eqb_eq, Z.leb_le, Z.ltb_lt. repeat split; auto; lia.
Qed.

Lemma arrived_robot_is_inside vs u : Route i a vs -> arrives vs <= u ->
  match after_goal i with Park => True | Vanish => u < arrives vs + takes (goal a) end -> inside vs (goal a) u = true.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; intros L K; unfold inside; cbn [is_in].
  - unfold arrives in *. simpl in *. rewrite orb_false_r, Hg, Z.eqb_refl. rewrite (proj2 (Z.leb_le _ _) L).
    destruct (after_goal i); auto. apply Z.ltb_lt in K. exact K.
  - apply orb_true_iff. right. apply IH; auto.
Qed.

(** Where a robot cannot go on, it stays for its duration. *)
Lemma standing_robot_is_inside v rest u : Route i a (v :: rest) -> passable i a (visit_resource v) = false ->
  enter v <= u -> u < enter v + takes (visit_resource v) -> inside (v :: rest) (visit_resource v) u = true.
Proof.
  intros H P L K. inversion H as [x Hg | x y later Hp Hn Hm Hw]; subst; [| congruence].
  unfold takes in K. unfold inside. cbn [is_in]. rewrite Z.eqb_refl, (proj2 (Z.leb_le _ _) L), (proj2 (Z.ltb_lt _ _) K).
  destruct (after_goal i); reflexivity.
Qed.

(** A robot that is free to leave one resource and in another at the same tick moves then. *)
Lemma free_robot_elsewhere_moves vs r s t : Route i a vs -> free vs r t = true -> inside vs s t = true -> r <> s ->
  exists before v w later, vs = before ++ v :: w :: later /\
  visit_resource v = r /\ visit_resource w = s /\ enter w = t.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |]. intros F K D.
  unfold free in F. cbn [is_free] in F. unfold inside in K. cbn [is_in] in K.
  assert (Later : free (w :: rest) r t = true -> inside (w :: rest) s t = true -> exists before v0 w0 later,
    v :: w :: rest = before ++ v0 :: w0 :: later /\ visit_resource v0 = r /\ visit_resource w0 = s /\ enter w0 = t).
  { intros F' K'. destruct (IH F' K' D) as (before & x & y & later & E & R). exists (v :: before), x, y, later.
    rewrite E. auto. }
  apply orb_true_iff in F as [F | F]; apply orb_true_iff in K as [K | K]; auto.
  - decided. congruence.
  - decided. exists [], v, w, rest. simpl. repeat split; auto.
    + pose proof (inside_is_after_the_start _ _ _ Hw K w rest eq_refl). assert (t = enter w) by lia. subst t.
      unfold inside in *. inversion Hw as [u Hg | u x later Hp' Hn' Hm' Hw']; subst; cbn [is_in] in K;
        apply orb_true_iff in K as [K | K]; decided; try discriminate; auto.
      pose proof (inside_is_after_the_start _ _ _ Hw' K x later eq_refl).
      pose proof (need_is_positive i a right known (visit_resource w)). lia.
    + pose proof (inside_is_after_the_start _ _ _ Hw K w rest eq_refl). lia.
  - decided. pose proof (free_is_after_the_start _ _ _ Hw F w rest eq_refl). lia.
Qed.

(** * Ticks to the goal and from the start *)

Variable rest_of : Z -> option Z.
(** From a resource it takes at least as long to the goal as over any move. *)
Hypothesis rests_are_least : forall r s, Move i r s ->
  (s = goal a -> exists x, rest_of r = Some x /\ x <= 0) /\
  (forall y, rest_of s = Some y -> exists x, rest_of r = Some x /\ x <= takes s + y).

Lemma mover_has_a_rest vs : Route i a vs -> forall v w rest, vs = v :: w :: rest ->
  exists x, rest_of (visit_resource v) = Some x /\ enter w + x <= arrives vs.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; intros u x later E; [discriminate |].
  injection E as <- <- <-.
  destruct (rests_are_least _ _ Hm) as [Last On]. inversion Hw as [u Hg | u y rest' Hp' Hn' Hm' Hw']; subst.
  - destruct (Last Hg) as (x & R & L). exists x. split; auto. unfold arrives. simpl. lia.
  - destruct (IH w y rest' eq_refl) as (z & R & L). destruct (On z R) as (x & R' & L'). exists x. split; auto.
    rewrite arrives_later. unfold takes in *. lia.
Qed.

Lemma free_robot_has_a_rest vs r t : Route i a vs -> free vs r t = true ->
  exists x, rest_of r = Some x /\ t + x <= arrives vs.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |].
  intros F. unfold free in F. cbn [is_free] in F. apply orb_true_iff in F as [F | F]; [| exact (IH F)].
  decided. subst r. destruct (mover_has_a_rest (v :: w :: rest)) with (1 := Route_goes_on i a v w rest Hp Hn Hm Hw)
    (2 := eq_refl (v :: w :: rest)) as (x & R & L). exists x. split; auto. lia.
Qed.

Variable first_of : Z -> option Z.
(** To a resource it takes at most as long from the start as over any move. *)
Hypothesis firsts_are_least : forall r s x, Move i r s -> first_of r = Some x -> passable i a s = true ->
  rest_of s <> None -> exists y, first_of s = Some y /\ y <= x + takes s.

Lemma free_robot_is_not_too_early vs r t : Route i a vs ->
  (forall v w rest, vs = v :: w :: rest ->
    exists x, first_of (visit_resource v) = Some x /\ x <= enter v + takes (visit_resource v)) ->
  free vs r t = true -> exists x, first_of r = Some x /\ x <= t.
Proof.
  intros H. induction H as [v Hg | v w rest Hp Hn Hm Hw IH]; [discriminate |].
  intros First F. destruct (First v w rest eq_refl) as (x & Fx & Lx).
  unfold free in F. cbn [is_free] in F. apply orb_true_iff in F as [F | F].
  - decided. subst r. exists x. split; auto. unfold takes in *. lia.
  - apply IH; auto. intros u y later E.
    destruct (mover_has_a_rest _ Hw u y later E) as (z & R & _). injection E as -> ->.
    inversion Hw as [| u' y' later' Hp' Hn' Hm' Hw']; subst.
    destruct (firsts_are_least _ _ x Hm Fx Hp') as (f & Ff & Lf); [congruence |].
    exists f. split; auto. unfold takes in *. lia.
Qed.

End Robot.
