(** Lawful plans up to their arrival, or to the tick at which the robot is seen, as a formula speaks of them: where a
    robot is free to leave, where it is, and when it arrives. *)
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

(** The visits that count. A robot that may not go on from its goal has arrived where it first enters it: of one that
    vanishes this is enough if it is not seen, because going on only costs more. *)
Definition counted (through : bool) (a : robot) (vs : list visit) : list visit :=
  if through then vs else until (goal a) vs.

(** A robot can go on from the resource. *)
Definition passable (through : bool) (a : robot) (r : Z) : bool := through || negb (r =? goal a).

(** A robot that is seen is described up to the tick at which it is. *)
Definition Described (last : option Z) (t : Z) : Prop := match last with Some l => t <= l | None => True end.

(** Visits that lead to the robot's goal, which it enters at a tick. If the robot is seen before, they end with the
    visit in which it is seen, and with a mark at the first tick after that at which it is free to leave; it enters its
    goal no earlier than the rest of the way takes. *)
Inductive Route (i : instance) (a : robot) (through : bool) (last : option Z) (rest_of : Z -> option Z)
  : list visit -> Z -> Prop :=
| Route_ends v : visit_resource v = goal a -> Route i a through last rest_of [v] (enter v)
| Route_is_cut v mark seen_at rest end_ : last = Some seen_at -> passable through a (visit_resource v) = true ->
    enter mark = Z.max (seen_at + 1) (enter v + need i a (visit_resource v)) ->
    rest_of (visit_resource v) = Some rest -> enter mark <= end_ -> enter mark + rest <= end_ ->
    Route i a through last rest_of [v; mark] end_
| Route_goes_on v w rest end_ : passable through a (visit_resource v) = true -> Described last (enter w) ->
    enter v + need i a (visit_resource v) <= enter w -> Move i (visit_resource v) (visit_resource w) ->
    Route i a through last rest_of (w :: rest) end_ -> Route i a through last rest_of (v :: w :: rest) end_.

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

(** * From plans to routes *)

Section Plan.
Variables (i : instance) (a : robot) (through : bool).
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).

Let inside := is_in i a.

Lemma counted_begins_alike v rest : exists later, counted through a (v :: rest) = v :: later.
Proof. unfold counted. simpl. destruct through; eauto. destruct (_ =? _); eauto. Qed.

Lemma until_is_a_prefix to vs : exists later, vs = until to vs ++ later.
Proof.
  induction vs as [| v rest [later IH]]; simpl; [exists []; auto |].
  destruct (_ =? _); [exists rest; auto |]. exists later. simpl. congruence.
Qed.

Lemma counted_is_a_prefix vs : exists later, vs = counted through a vs ++ later.
Proof. unfold counted. destruct through; [exists []; rewrite app_nil_r; auto | apply until_is_a_prefix]. Qed.

Lemma arrives_later v w rest : arrives (v :: w :: rest) = arrives (w :: rest).
Proof. reflexivity. Qed.

Lemma entered_before_the_arrival vs : Way i a vs -> forall v rest, vs = v :: rest -> enter v <= arrives vs.
Proof. apply way_does_not_arrive_before_it_starts; auto. Qed.

Lemma counted_arrives_no_later vs : Way i a vs -> arrives (counted through a vs) <= arrives vs.
Proof.
  unfold counted. destruct through; [lia |]. intros H.
  induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH].
  - simpl. rewrite Hg, Z.eqb_refl. lia.
  - pose proof (entered_before_the_arrival _ Hw w rest eq_refl).
    pose proof (need_is_positive i a right known (visit_resource v)).
    rewrite arrives_later. cbn [until] in *.
    destruct (visit_resource v =? goal a); [unfold arrives at 1; simpl; lia |].
    destruct (visit_resource w =? goal a); rewrite arrives_later; exact IH.
Qed.

(** Where the robot is on its route, it is in its plan. *)
Lemma counted_visits_hold vs r t : Way i a vs -> (after_goal i = Park -> through = true) ->
  inside (counted through a vs) r t = true -> exists v, In v vs /\ visit_resource v = r /\ Holds v t.
Proof.
  intros H Parks. unfold counted, inside, Holds.
  induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros K.
  - exists v. rewrite Hl. destruct through; cbn [until is_in] in K; rewrite ?Hg, ?Z.eqb_refl in K; cbn [is_in] in K;
      rewrite orb_false_r, ?Hg in K; destruct (after_goal i); decided; simpl; unfold last_need; intuition;
      subst; auto; lia.
  - destruct through.
    + cbn [is_in] in K. apply orb_true_iff in K as [K | K].
      * exists v. decided. rewrite Hl. simpl. auto.
      * destruct IH as (u & Hu & R); [exact K |]. exists u. simpl in *. tauto.
    + rewrite until_the_goal in K. destruct (Z.eqb_spec (visit_resource v) (goal a)) as [E | D].
      * exists v. cbn [is_in] in K. rewrite orb_false_r in K. destruct (after_goal i); [| discriminate (Parks eq_refl)].
        decided. rewrite Hl. simpl. repeat split; auto. subst. lia.
      * assert (E : exists later, until (goal a) (w :: rest) = w :: later) by (simpl; destruct (_ =? _); eauto).
        destruct E as [later E]. rewrite E in *. cbn [is_in] in K. apply orb_true_iff in K as [K | K].
        -- exists v. decided. rewrite Hl. simpl. auto.
        -- destruct IH as (u & Hu & R); [exact K |]. exists u. simpl in *. tauto.
Qed.

(** The same of a way that ends where the robot is seen, up to then. *)
Lemma seen_visits_hold before v w later mark r t l : Way i a (before ++ v :: w :: later) -> l < enter w ->
  l < enter mark -> t <= l -> inside (before ++ [v; mark]) r t = true ->
  exists u, In u (before ++ v :: w :: later) /\ visit_resource u = r /\ Holds u t.
Proof.
  intros H Lw Lm Lt. unfold inside, Holds. induction before as [| u before IH]; simpl app in *; intros K.
  - cbn [is_in] in K. apply orb_true_iff in K as [K | K].
    + exists v. inversion H as [| ? ? ? Hl]; subst. rewrite Hl. decided. simpl. repeat split; auto. lia.
    + apply orb_true_iff in K as [K | K]; [decided; lia | discriminate].
  - assert (Next : exists x rest' rest'', before ++ v :: w :: later = x :: rest' /\ before ++ [v; mark] = x :: rest'')
      by (destruct before; simpl; eauto).
    destruct Next as (x & rest' & rest'' & E & E'). rewrite E, E' in *. cbn [is_in] in K.
    inversion H as [| ? ? ? Hl Hn Hm Hw]; subst. apply orb_true_iff in K as [K | K].
    + exists u. rewrite Hl. decided. simpl. auto.
    + destruct (IH Hw K) as (y & Hy & R). exists y. simpl in *. tauto.
Qed.

(** A move of a route that ends where the robot is seen is one of its way, up to then. *)
Lemma seen_moves_are_made before v w later mark l first x y rest : l < enter mark -> enter y <= l ->
  before ++ [v; mark] = first ++ x :: y :: rest ->
  exists rest', before ++ v :: w :: later = first ++ x :: y :: rest'.
Proof.
  intros Lm Ly E. destruct (rev rest) as [| z front] eqn:R.
  - apply (f_equal (@rev visit)) in R. rewrite rev_involutive in R. simpl in R. subst rest.
    change (before ++ [v] ++ [mark] = first ++ [x] ++ [y]) in E. rewrite !app_assoc in E.
    apply app_inj_tail in E as [_ ->]. lia.
  - apply (f_equal (@rev visit)) in R. rewrite rev_involutive in R. simpl in R. subst rest.
    change (before ++ [v] ++ [mark] = first ++ (x :: y :: rev front) ++ [z]) in E. rewrite !app_assoc in E.
    apply app_inj_tail in E as [E _]. exists (rev front ++ w :: later).
    change (before ++ [v] ++ w :: later = first ++ (x :: y :: rev front) ++ w :: later). rewrite !app_assoc, E.
    reflexivity.
Qed.

(** The visits of a way are entered one after the other. *)
Lemma later_visit_is_entered_later v rest u : Way i a (v :: rest) -> In u rest -> enter v < enter u.
Proof.
  intros H. remember (v :: rest) as vs eqn:E. revert v rest E.
  induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros x later E; injection E as <- <-; [intros [] |].
  pose proof (need_is_positive i a right known (visit_resource v)).
  intros [<- | Hu]; [lia |]. specialize (IH w rest eq_refl Hu). lia.
Qed.

(** A robot that is free to leave a resource has been in a visit there for its duration, and leaves it then or later. *)
Lemma free_robot_leaves_later vs r t : is_free i a vs r t = true -> exists before v w later,
  vs = before ++ v :: w :: later /\ visit_resource v = r /\ enter v + need i a r <= t <= enter w.
Proof.
  induction vs as [| v [| w rest] IH]; try discriminate. intros F. cbn [is_free] in F.
  apply orb_true_iff in F as [F | F].
  - decided. exists [], v, w, rest. auto.
  - destruct (IH F) as (before & x & y & later & E & R). exists (v :: before), x, y, later. rewrite E. auto.
Qed.

(** Who leaves a visit of a route that ends where the robot is seen leaves it in its way. *)
Lemma left_visit_is_of_the_way (before : list visit) v x later mark first u y rest :
  before ++ [v; mark] = first ++ u :: y :: rest ->
  exists z rest', before ++ v :: x :: later = first ++ u :: z :: rest' /\ (z = y \/ z = x).
Proof.
  revert first. induction before as [| b before IH]; intros [| f first] E; simpl app in *.
  - injection E as -> _ _. exists x, later. auto.
  - injection E as _ E. destruct first as [| c [| d first]]; discriminate.
  - injection E as -> E. destruct before as [| c before]; simpl app in *; injection E as -> _;
      [exists y, (x :: later) | exists y, (before ++ v :: x :: later)]; auto.
  - injection E as -> E. destruct (IH first E) as (z & rest' & E' & R). exists z, rest'. rewrite E'. auto.
Qed.

(** A robot is in one visit at a tick. *)
Lemma visit_at_a_tick_is_unique first v w later first' v' w' later' t : Way i a (first ++ v :: w :: later) ->
  first ++ v :: w :: later = first' ++ v' :: w' :: later' -> enter v <= t < enter w -> enter v' <= t < enter w' ->
  v = v'.
Proof.
  intros H E L L'. revert first' E. induction first as [| b first IH]; intros [| b' first'] E; simpl app in *.
  - injection E as E _ _. exact E.
  - injection E as _ E. exfalso. apply (way_has_ways i a [v] (w :: later)) in H; [| discriminate].
    destruct first' as [| c first']; simpl app in E; injection E as E1 E2.
    + subst. lia.
    + pose proof (later_visit_is_entered_later w later v' H) as N. rewrite E2 in N.
      assert (enter w < enter v') by (apply N, in_or_app; right; left; reflexivity). lia.
  - injection E as _ E. exfalso. apply (way_has_ways i a [b] (first ++ v :: w :: later)) in H; [| destruct first; discriminate].
    destruct first as [| c first]; simpl app in *; injection E as E1 E2.
    + subst. lia.
    + pose proof (later_visit_is_entered_later c (first ++ v :: w :: later) v H) as N.
      assert (enter c < enter v) by (apply N, in_or_app; right; left; reflexivity). subst. lia.
  - injection E as _ E. apply (IH) with (first' := first'); auto.
    apply (way_has_ways i a [b] (first ++ v :: w :: later)) in H; auto. destruct first; discriminate.
Qed.

End Plan.

Section Robot.
Variables (i : instance) (a : robot) (through : bool) (last : option Z) (rest_of : Z -> option Z).
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).

Let free := is_free i a.
Let inside := is_in i a.
Let takes := need i a.
Let Routed := Route i a through last rest_of.

Lemma way_is_a_route vs : Way i a vs -> Described last (arrives vs) ->
  Routed (counted through a vs) (arrives (counted through a vs)).
Proof.
  unfold counted, Routed. intros H. induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros D.
  - destruct through; simpl; rewrite ?Hg, ?Z.eqb_refl; apply Route_ends; auto.
  - assert (Before : Described last (enter w)).
    { pose proof (entered_before_the_arrival i a right known _ Hw w rest eq_refl). rewrite arrives_later in D.
      unfold Described in *. destruct last; auto. lia. }
    specialize (IH D). destruct through eqn:Through.
    + rewrite arrives_later. apply Route_goes_on; auto.
    + cbn [until]. destruct (Z.eqb_spec (visit_resource v) (goal a)) as [E | F]; [apply Route_ends; auto |].
      cbn [until] in IH. destruct (visit_resource w =? goal a); rewrite arrives_later; apply Route_goes_on; auto;
        apply orb_true_iff; right; apply negb_true_iff, Z.eqb_neq; auto.
Qed.

(** A robot that is seen in a visit has a route that ends there. *)
Lemma seen_way_is_a_route before v w later l rest mark : Way i a (before ++ v :: w :: later) -> through = true ->
  last = Some l -> enter v <= l < enter w -> rest_of (visit_resource v) = Some rest ->
  enter mark = Z.max (l + 1) (enter v + takes (visit_resource v)) ->
  Routed (before ++ [v; mark]) (enter mark + Z.max 0 rest).
Proof.
  intros H Through Last Seen Rest Mark. unfold Routed.
  assert (Passes : forall r, passable through a r = true) by (intros; unfold passable; rewrite Through; auto).
  induction before as [| u before IH]; simpl in H.
  - eapply Route_is_cut; eauto; lia.
  - assert (Next : exists x rest', before ++ v :: w :: later = x :: rest' /\ enter x <= enter v /\
      exists rest'', before ++ [v; mark] = x :: rest'').
    { destruct before as [| x before]; simpl; [exists v; eexists; repeat split; eauto; lia |].
      exists x, (before ++ v :: w :: later). repeat split; eauto. simpl in *.
      inversion H as [| ? ? ? _ _ _ Hw]; subst. clear - Hw right known.
      revert x Hw. induction before as [| y before IH]; intros x Hw; simpl in Hw;
        inversion Hw as [| ? ? ? Hl Hn Hm Hr]; subst; pose proof (need_is_positive i a right known (visit_resource x));
        [lia |]. specialize (IH y Hr). lia. }
    destruct Next as (x & rest' & E & Earlier & rest'' & E'). rewrite E in *.
    inversion H as [| ? ? ? Hl Hn Hm Hw]; subst. specialize (IH Hw). simpl. rewrite E' in *.
    apply Route_goes_on; auto. unfold Described. lia.
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

Lemma leaver_is_free before v w later t : enter v + takes (visit_resource v) <= t -> t <= enter w ->
  free (before ++ v :: w :: later) (visit_resource v) t = true.
Proof.
  intros Ready Leaves. induction before as [| u before IH]; [apply mover_is_free; auto |].
  apply free_is_free_after, IH.
Qed.

(** A robot that is seen again was in the same visits before. *)
Lemma leaver_is_free_before_it_is_seen before v x later mark first u y rest l t :
  Way i a (before ++ v :: x :: later) -> before ++ v :: x :: later = first ++ u :: y :: rest ->
  enter u <= l < enter x -> enter u + takes (visit_resource u) <= t <= enter y -> (u = v -> t <= enter mark) ->
  free (before ++ [v; mark]) (visit_resource u) t = true.
Proof.
  intros H E L T Mark. revert first E. induction before as [| b before IH]; intros first E; simpl app in *.
  - destruct first as [| f first]; simpl app in E.
    + injection E as -> _ _. apply mover_is_free; [lia | auto].
    + injection E as _ E. inversion H as [| ? ? ? _ _ _ Hx]; subst.
      assert (enter x <= enter u); [| lia].
      destruct first as [| f' first]; simpl app in E; injection E as -> E; [lia |].
      apply Z.lt_le_incl, (later_visit_is_entered_later i a right known f' later u Hx).
      rewrite E. apply in_or_app. right. left. reflexivity.
  - destruct first as [| f first]; simpl app in E.
    + injection E as -> E. destruct before as [| c before]; simpl app in *; injection E as -> _;
        apply mover_is_free; lia.
    + injection E as -> E. apply free_is_free_after, (IH) with (first := first); auto.
      apply (way_has_ways i a [f] (before ++ v :: x :: later)); auto. destruct before; discriminate.
Qed.

Lemma route_arrives_after_its_start vs end_ : Routed vs end_ -> forall v rest, vs = v :: rest -> enter v <= end_.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    intros u later E; injection E as <- <-; [lia | |];
    pose proof (need_is_positive i a right known (visit_resource v)); [lia |]. specialize (IH w rest eq_refl). lia.
Qed.

(** A robot that is free waits, or moves on and is free again a duration later, or arrives. *)
Lemma free_robot_goes_on vs end_ r t : Routed vs end_ -> Described last t -> free vs r t = true ->
  free vs r (t + 1) = true \/
  (exists s, Move i r s /\ free vs s (t + takes s) = true) \/
  (Move i r (goal a) /\ end_ = t).
Proof.
  intros H D. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F; unfold free in F; cbn [is_free] in F; apply orb_true_iff in F as [F | F].
  - decided. subst r. left. apply mover_is_free; unfold takes; [lia |]. unfold Described in D. rewrite Hs in D. lia.
  - discriminate.
  - decided. subst r. destruct (Z.eq_dec t (enter w)) as [-> | N].
    + inversion Hw as [u Hg | u mark l x ? Hs' Hp' Hn' Hx' Hm' Hr' | u x later ? Hp' Hd' Hn' Hm' Hw']; subst.
      * right. right. split; [congruence | reflexivity].
      * right. left. exists (visit_resource w). split; auto. apply free_is_free_after, mover_is_free; unfold takes; lia.
      * right. left. exists (visit_resource w). split; auto. apply free_is_free_after, mover_is_free; unfold takes; lia.
    + left. apply mover_is_free; unfold takes; lia.
  - destruct (IH F) as [W | [(s & Hs & W) | (Hs & W)]].
    + left. apply free_is_free_after, W.
    + right. left. exists s. split; auto. apply free_is_free_after, W.
    + right. right. auto.
Qed.

(** A robot that is free was so one tick before, or moved here from where it was free, or is at its start. *)
Lemma free_robot_comes_from vs end_ r t : Routed vs end_ -> free vs r t = true ->
  (Described last (t - 1) /\ free vs r (t - 1) = true) \/
  (exists s, Move i s r /\ free vs s (t - takes r) = true) \/
  (exists v rest, vs = v :: rest /\ r = visit_resource v /\ t = enter v + takes r).
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F; unfold free in F; cbn [is_free] in F; apply orb_true_iff in F as [F | F];
    try discriminate.
  - decided. subst r. destruct (Z.eq_dec t (enter v + takes (visit_resource v))) as [-> | D].
    + right. right. eauto.
    + left. unfold takes in *. split; [unfold Described; rewrite Hs; lia |]. apply mover_is_free; unfold takes; lia.
  - decided. subst r. destruct (Z.eq_dec t (enter v + takes (visit_resource v))) as [-> | D].
    + right. right. eauto.
    + left. split; [| apply mover_is_free; unfold takes in *; lia]. unfold Described in *. destruct last; auto. lia.
  - destruct (IH F) as [(D & W) | [(s & Hs & W) | (u & later & E & -> & ->)]].
    + left. split; auto. apply free_is_free_after, W.
    + right. left. exists s. split; auto. apply free_is_free_after, W.
    + injection E as <- <-. right. left. exists (visit_resource v). split; auto. apply mover_is_free; unfold takes; lia.
Qed.

(** A robot is free just before it arrives, unless it starts at its goal and stays there. *)
Lemma arrival_comes_from vs end_ : Routed vs end_ -> Described last end_ ->
  (exists s, Move i s (goal a) /\ free vs s end_ = true) \/
  (exists v, vs = [v] /\ visit_resource v = goal a /\ end_ = enter v).
Proof.
  intros H D. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH].
  - right. eauto.
  - unfold Described in D. rewrite Hs in D. lia.
  - left. destruct (IH D) as [(s & Hs & F) | (u & E & Hg & Hu)].
    + exists s. split; auto. apply free_is_free_after, F.
    + injection E as -> ->. exists (visit_resource v). split; [congruence |]. apply mover_is_free; unfold takes; lia.
Qed.

Lemma inside_is_after_the_start vs end_ r t : Routed vs end_ -> inside vs r t = true ->
  forall v rest, vs = v :: rest -> enter v <= t.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    intros K u later E; injection E as <- <-; unfold inside in K; cbn [is_in] in K; apply orb_true_iff in K as [K | K];
    decided; auto; try discriminate; pose proof (need_is_positive i a right known (visit_resource v)).
  - apply orb_true_iff in K as [K | K]; [decided; lia | discriminate].
  - specialize (IH K w rest eq_refl). lia.
Qed.

Lemma free_is_after_the_start vs end_ r t : Routed vs end_ -> free vs r t = true ->
  forall v rest, vs = v :: rest -> enter v < t.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    intros K u later E; injection E as <- <-; [discriminate | |];
    unfold free in K; cbn [is_free] in K; apply orb_true_iff in K as [K | K]; try discriminate;
    pose proof (need_is_positive i a right known (visit_resource v)).
  - decided. pose proof (need_is_positive i a right known r). lia.
  - decided. pose proof (need_is_positive i a right known r). lia.
  - specialize (IH K w rest eq_refl). lia.
Qed.

Lemma free_robot_can_pass vs end_ r t : Routed vs end_ -> free vs r t = true -> passable through a r = true.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F; unfold free in F; cbn [is_free] in F; apply orb_true_iff in F as [F | F]; auto;
    try discriminate; decided; congruence.
Qed.

(** A robot that is free to leave a resource has been in it for its duration. *)
Lemma free_robot_is_inside vs end_ r t u : Routed vs end_ -> free vs r t = true -> u < t -> t <= u + takes r ->
  inside vs r u = true.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F L K; unfold free in F; cbn [is_free] in F; unfold inside; cbn [is_in];
    apply orb_true_iff; apply orb_true_iff in F as [F | F]; try discriminate; auto; left; decided; unfold takes in K;
    rewrite !andb_true_iff, Z.eqb_eq, Z.leb_le, Z.ltb_lt; repeat split; auto; lia.
Qed.

Lemma arrived_robot_is_inside vs end_ u : Routed vs end_ -> Described last u -> end_ <= u ->
  match after_goal i with Park => True | Vanish => u < end_ + takes (goal a) end -> inside vs (goal a) u = true.
Proof.
  intros H D. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH]; intros L K;
    unfold inside; cbn [is_in].
  - rewrite orb_false_r, Hg, Z.eqb_refl. rewrite (proj2 (Z.leb_le _ _) L).
    destruct (after_goal i); auto. apply Z.ltb_lt in K. exact K.
  - unfold Described in D. rewrite Hs in D. lia.
  - apply orb_true_iff. right. apply IH; auto.
Qed.

(** Where a robot cannot go on, it stays for its duration. *)
Lemma standing_robot_is_inside v rest end_ u : Routed (v :: rest) end_ ->
  passable through a (visit_resource v) = false ->
  enter v <= u -> u < enter v + takes (visit_resource v) -> inside (v :: rest) (visit_resource v) u = true.
Proof.
  intros H P L K. inversion H as [x Hg | | x y later ? Hp Hd Hn Hm Hw]; subst; [| congruence | congruence].
  unfold takes in K. unfold inside. cbn [is_in]. rewrite Z.eqb_refl, (proj2 (Z.leb_le _ _) L), (proj2 (Z.ltb_lt _ _) K).
  destruct (after_goal i); reflexivity.
Qed.

(** A robot that is free to leave one resource and in another at the same tick moves then. *)
Lemma free_robot_elsewhere_moves vs end_ r s t : Routed vs end_ -> Described last t -> free vs r t = true ->
  inside vs s t = true -> r <> s ->
  exists before v w later, vs = before ++ v :: w :: later /\
  visit_resource v = r /\ visit_resource w = s /\ enter w = t.
Proof.
  intros H Early. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F K D; unfold free in F; cbn [is_free] in F; unfold inside in K; cbn [is_in] in K.
  - unfold Described in Early. rewrite Hs in Early. exfalso.
    apply orb_true_iff in F as [F | F]; [| discriminate]. apply orb_true_iff in K as [K | K]; [decided; congruence |].
    apply orb_true_iff in K as [K | K]; [decided; lia | discriminate].
  - assert (Later : free (w :: rest) r t = true -> inside (w :: rest) s t = true -> exists before v0 w0 later,
      v :: w :: rest = before ++ v0 :: w0 :: later /\ visit_resource v0 = r /\ visit_resource w0 = s /\ enter w0 = t).
    { intros F' K'. destruct (IH F' K' D) as (before & x & y & later & E & R). exists (v :: before), x, y, later.
      rewrite E. auto. }
    apply orb_true_iff in F as [F | F]; apply orb_true_iff in K as [K | K]; auto.
    + decided. congruence.
    + decided. exists [], v, w, rest. simpl. pose proof (inside_is_after_the_start _ _ _ _ Hw K w rest eq_refl).
      assert (t = enter w) by lia. subst t. repeat split; auto.
      pose proof (need_is_positive i a right known (visit_resource w)).
      inversion Hw as [u Hg | u mark l x ? Hs' Hp' Hn' Hx' Hm' Hr' | u x later ? Hp' Hd' Hn' Hm' Hw']; subst;
        cbn [is_in] in K; apply orb_true_iff in K as [K | K]; decided; try discriminate; auto.
      * apply orb_true_iff in K as [K | K]; [decided; lia | discriminate].
      * pose proof (inside_is_after_the_start _ _ _ _ Hw' K x later eq_refl). lia.
    + decided. pose proof (free_is_after_the_start _ _ _ _ Hw F w rest eq_refl). lia.
Qed.

(** * Ticks to the goal and from the start *)

(** From a resource it takes at least as long to the goal as over any move. *)
Hypothesis rests_are_least : forall r s, Move i r s ->
  (s = goal a -> exists x, rest_of r = Some x /\ x <= 0) /\
  (forall y, rest_of s = Some y -> exists x, rest_of r = Some x /\ x <= takes s + y).

Lemma mover_has_a_rest vs end_ : Routed vs end_ -> forall v w rest, vs = v :: w :: rest ->
  exists x, rest_of (visit_resource v) = Some x /\ enter w + x <= end_.
Proof.
  intros H. induction H as [v Hg | v mark l z end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    intros u x later E; [discriminate | |]; injection E as <- <- <-; [eauto |].
  destruct (rests_are_least _ _ Hm) as [Last On].
  assert (Next : (exists y rest', rest = y :: rest') \/ visit_resource w = goal a /\ enter w = end_)
    by (inversion Hw; subst; eauto).
  destruct Next as [(y & rest' & ->) | (Hg & <-)].
  - destruct (IH w y rest' eq_refl) as (z & R & L). destruct (On z R) as (x & R' & L'). exists x. split; auto.
    assert (enter w + takes (visit_resource w) <= enter y) by (inversion Hw; subst; unfold takes; lia). lia.
  - destruct (Last Hg) as (x & R & L). exists x. split; auto. lia.
Qed.

(** So it does on the whole way. *)
Lemma way_has_a_rest vs : Way i a vs -> forall v w rest, vs = v :: w :: rest ->
  exists x, rest_of (visit_resource v) = Some x /\ enter w + x <= arrives vs.
Proof.
  intros H. induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros u x later E; [discriminate |].
  injection E as <- <- <-. destruct (rests_are_least _ _ Hm) as [Last On]. rewrite arrives_later.
  inversion Hw as [u Hg' Hl' | u y rest' Hl' Hn' Hm' Hw']; subst.
  - destruct (Last Hg') as (x & R & L). exists x. split; auto. unfold arrives. simpl. lia.
  - destruct (IH w y rest' eq_refl) as (z & R & L). destruct (On z R) as (x & R' & L'). exists x. split; auto.
    rewrite arrives_later in *. unfold takes in *. lia.
Qed.

Lemma free_robot_has_a_rest vs end_ r t : Routed vs end_ -> free vs r t = true ->
  exists x, rest_of r = Some x /\ t + x <= end_.
Proof.
  intros H. induction H as [v Hg | v mark l x end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros F; unfold free in F; cbn [is_free] in F; apply orb_true_iff in F as [F | F];
    try discriminate.
  - decided. subst r. exists x. split; auto. lia.
  - decided. subst r. destruct (mover_has_a_rest (v :: w :: rest) end_) with (v := v) (w := w) (rest := rest)
      as (x & R & L); auto; [apply Route_goes_on; auto |]. exists x. split; auto. lia.
  - exact (IH F).
Qed.

Variable first_of : Z -> option Z.
(** To a resource it takes at most as long from the start as over any move. *)
Hypothesis firsts_are_least : forall r s x, Move i r s -> first_of r = Some x -> passable through a s = true ->
  rest_of s <> None -> exists y, first_of s = Some y /\ y <= x + takes s.

Lemma free_robot_is_not_too_early vs end_ r t : Routed vs end_ ->
  (forall v w rest, vs = v :: w :: rest ->
    exists x, first_of (visit_resource v) = Some x /\ x <= enter v + takes (visit_resource v)) ->
  free vs r t = true -> exists x, first_of r = Some x /\ x <= t.
Proof.
  intros H. induction H as [v Hg | v mark l z end_ Hs Hp Hn Hx Hm Hr | v w rest end_ Hp Hd Hn Hm Hw IH];
    [discriminate | |]; intros First F; unfold free in F; cbn [is_free] in F; apply orb_true_iff in F as [F | F];
    try discriminate.
  - destruct (First v mark [] eq_refl) as (x & Fx & Lx). decided. subst r. exists x. split; auto. unfold takes in *.
    lia.
  - destruct (First v w rest eq_refl) as (x & Fx & Lx). decided. subst r. exists x. split; auto. unfold takes in *. lia.
  - destruct (First v w rest eq_refl) as (x & Fx & Lx).
    apply IH; auto. intros u y later E.
    destruct (mover_has_a_rest _ _ Hw u y later E) as (z & R & _). injection E as -> ->.
    assert (Hp' : passable through a (visit_resource u) = true) by (inversion Hw; subst; auto).
    destruct (firsts_are_least _ _ x Hm Fx Hp') as (f & Ff & Lf); [congruence |].
    exists f. split; auto. unfold takes in *. lia.
Qed.

End Robot.
