(** The plans that the query makes are sound: they keep all rules, alone and with the committed plans. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops Collections Timeline Journey Checker Windows Context Past Query QuerySearch.
Import ListNotations.
Open Scope Z_scope.

(** * Lists of visits that grow at their end *)

(** The first visit is followed at once by the second in the list. *)
Definition Adjacent (vs : list visit) (v w : visit) : Prop := exists before later, vs = before ++ v :: w :: later.

Lemma adjacent_at_end b v w x y : Adjacent ((b ++ [v]) ++ [w]) x y <-> Adjacent (b ++ [v]) x y \/ x = v /\ y = w.
Proof.
  unfold Adjacent. split.
  - intros (p & l & E). destruct l as [|z l] using rev_ind.
    + change (p ++ [x; y]) with (p ++ [x] ++ [y]) in E. rewrite app_assoc in E.
      apply app_inj_tail in E as [E <-]. apply app_inj_tail in E as [_ <-]. auto.
    + change (x :: y :: l ++ [z]) with ((x :: y :: l) ++ [z]) in E. rewrite app_assoc in E.
      apply app_inj_tail in E as [E _]. eauto.
  - intros [(p & l & E)|[-> ->]].
    + exists p, (l ++ [w]). rewrite E, <- app_assoc. reflexivity.
    + exists b, []. rewrite <- app_assoc. reflexivity.
Qed.

Lemma not_adjacent_in_one v x y : ~ Adjacent ([] ++ [v]) x y.
Proof. intros ([|p [|q b]] & l & E); discriminate. Qed.

(** Another visit in the place of the last one has the same neighbour. *)
Lemma adjacent_with_another_end b v w x y : Adjacent (b ++ [w]) x y ->
  Adjacent (b ++ [v]) x y \/ y = w /\ Adjacent (b ++ [v]) x v.
Proof.
  destruct b as [|u b] using rev_ind; intros H.
  - destruct (not_adjacent_in_one w x y H).
  - clear IHb. rewrite !adjacent_at_end in *. destruct H as [H|[-> ->]]; auto.
Qed.

Section Robot.
Variables (i : instance) (a : robot).
Hypothesis well_formed : Well_formed i.
Hypothesis of_instance : In a (robots i).
Local Notation known := (lookup_of i).

(** * What keeps the rules so far *)

(** The visits keep the rules plan/..., but that the last one need not be to the goal. *)
Record Course (vs : list visit) : Prop := {
  begins : exists first later, vs = first :: later /\ visit_resource first = start a /\ enter first = release a;
  stays : forall v, In v vs -> Stay_lawful i a v;
  steps : forall v w, Adjacent vs v w -> leave v = Some (enter w) /\ Move i (visit_resource v) (visit_resource w)
}.

Lemma lawful_plan_is_a_course p :
  Plan_lawful i a p <-> Course (visits p) /\ (exists before last, visits p = before ++ [last] /\ Ends i a last) /\
  Serves_stops (stops a) (visits p).
Proof.
  rewrite plan_lawful_iff. split.
  - intros (v & later & E & R & T & C & O). apply chain_iff in C as (G & S & A). rewrite E. split; [|auto].
    split; auto. exists v, later. auto.
  - intros [[(v & later & E & R & T) S A] [G O]]. exists v, later. rewrite E in *. repeat (split; auto).
    apply chain_iff. auto.
Qed.

Lemma course_of_front vs later : vs <> [] -> Course (vs ++ later) -> Course vs.
Proof.
  intros N [(f & l & E & B) S A]. split.
  - destruct vs as [|v vs]; [destruct N; auto|]. injection E as -> _. exists f, vs. auto.
  - intros v V. apply S, in_or_app. auto.
  - intros v w (b & r & ->). apply A. exists b, (r ++ later). rewrite <- app_assoc. reflexivity.
Qed.

Definition Same_entry (v w : visit) : Prop := visit_resource w = visit_resource v /\ enter w = enter v.

Lemma course_with_another_end b v w : Course (b ++ [v]) -> Same_entry v w -> Stay_lawful i a w -> Course (b ++ [w]).
Proof.
  intros [(f & l & E & B) S A] [R T] K. split.
  - destruct b as [|u b]; simpl in *; injection E as -> _.
    + exists w, []. destruct B. repeat split; congruence.
    + exists f, (b ++ [w]). auto.
  - intros x X. apply in_app_or in X as [X|[<-|[]]]; auto. apply S, in_or_app. auto.
  - intros x y X. apply (adjacent_with_another_end b v w) in X as [X|[-> X]]; auto. rewrite T, R. auto.
Qed.

Lemma course_goes_on b v w : Course (b ++ [v]) -> leave v = Some (enter w) ->
  Move i (visit_resource v) (visit_resource w) -> Stay_lawful i a w -> Course ((b ++ [v]) ++ [w]).
Proof.
  intros [(f & l & E & B) S A] L M K. split.
  - rewrite E. exists f, (l ++ [w]). auto.
  - intros x X. apply in_app_or in X as [X|[<-|[]]]; auto.
  - intros x y X. apply adjacent_at_end in X as [X|[-> ->]]; auto.
Qed.

(** * What is free so far *)

Variable c : context.

Definition Has_room (v : visit) : Prop := exists r w, In r (resources i) /\ resource_id r = visit_resource v /\
  In w (windows_in c r) /\ holds_stay w (enter v) (leave v) = true.

(** The visits keep the rules joint/... with the committed plans. *)
Record Free (vs : list visit) : Prop := {
  has_room : forall v, In v vs -> Has_room v;
  makes_no_exchange : forall v w, Adjacent vs v w ->
    is_exchange known c (visit_resource v) (visit_resource w) (enter w) = false
}.

Lemma allows_iff vs : allows known c vs = true <-> Free vs.
Proof.
  assert (R : forall v, match Map.find (visit_resource v) (resource_of known) with
    | Some r => existsb (fun w => holds_stay w (enter v) (leave v)) (windows_in c r)
    | None => false
    end = true <-> Has_room v).
  { intros v. unfold Has_room. destruct (Map.find (visit_resource v) (resource_of known)) as [r|] eqn:E.
    - apply (find_resource i well_formed) in E as [R E]. rewrite existsb_exists. split.
      + intros (w & W & H). exists r, w. auto.
      + intros (s & w & S & F & W & H). exists w. rewrite (resource_is_unique i well_formed r s) by congruence. auto.
    - split; [discriminate|]. intros (s & w & S & F & _).
      rewrite (proj2 (find_resource i well_formed (visit_resource v) s)) in E by auto. discriminate. }
  induction vs as [|v later IH]; cbn [allows].
  - split; auto. intros _. split; [intros v []|]. intros v w ([|p b] & l & E); discriminate.
  - specialize (R v). destruct (Map.find (visit_resource v) (resource_of known)) as [r|].
    2:{ split; [discriminate|]. intros [H _]. apply R, H. left. auto. }
    destruct (existsb (fun w => holds_stay w (enter v) (leave v)) (windows_in c r)).
    2:{ split; [discriminate|]. intros [H _]. apply R, H. left. auto. }
    destruct later as [|x rest].
    + split; auto. intros _. split; [intros w [<-|[]]; tauto|]. intros y z Y. destruct (not_adjacent_in_one v y z Y).
    + destruct (is_exchange known c (visit_resource v) (visit_resource x) (enter x)) eqn:X.
      * split; [discriminate|]. intros [_ H]. rewrite H in X; [discriminate|]. exists [], rest. reflexivity.
      * rewrite IH. split; intros [H K]; split.
        -- intros w [<-|W]; auto. tauto.
        -- intros y z Y. apply consecutive_cons in Y as [[-> ->]|Y]; auto.
        -- intros w W. apply H. right. exact W.
        -- intros y z Y. apply K. apply consecutive_cons. auto.
Qed.

Lemma free_with_another_end b v w : Free (b ++ [v]) -> Same_entry v w -> Has_room w -> Free (b ++ [w]).
Proof.
  intros [H K] [R T] N. split.
  - intros x X. apply in_app_or in X as [X|[<-|[]]]; auto. apply H, in_or_app. auto.
  - intros x y X. apply (adjacent_with_another_end b v w) in X as [X|[-> X]]; auto. rewrite T, R. auto.
Qed.

Lemma free_goes_on b v w : Free (b ++ [v]) -> is_exchange known c (visit_resource v) (visit_resource w) (enter w) = false ->
  Has_room w -> Free ((b ++ [v]) ++ [w]).
Proof.
  intros [H K] X N. split.
  - intros x Y. apply in_app_or in Y as [Y|[<-|[]]]; auto.
  - intros x y Y. apply adjacent_at_end in Y as [Y|[-> ->]]; auto.
Qed.

(** * Sound plans are those that are lawful and free *)

Variable committed : list plan.
Hypothesis others : Committed i a committed.
Hypothesis represents : Represents i c committed.
Hypothesis limits_are_kept : Limits_are_kept i committed.
Hypothesis exchanges_are_avoided : Exchanges_are_avoided i committed.

(** Where a visit has room, there is room for one robot more than those committed. *)
Lemma stays_that_fit_have_room v r tick : Has_room v -> In r (resources i) -> resource_id r = visit_resource v ->
  Holds v tick -> Room_for_one_more i committed r tick.
Proof.
  intros (s & w & S & E & W & H) R F [T U]. rewrite (resource_is_unique i well_formed s r) in * by congruence.
  rewrite (has_windows _ _ _ represents r) in W.
  apply (free_windows_are_maximal i committed well_formed (are_of_robots _ _ _ others) (are_lawful _ _ _ others)
    (are_distinct _ _ _ others) r w R) in W.
  unfold holds_stay, lasts in H. apply andb_true_iff in H as [O H].
  apply (holds_inside _ _ W tick). split; [lia|]. destruct (closes w) as [last|]; simpl; auto.
  destruct (leave v) as [l|]; [|discriminate]. simpl in U. lia.
Qed.

Lemma distinct_with_the_robot p : plan_robot p = robot_id a -> NoDup (map plan_robot (committed ++ [p])).
Proof.
  intros E. rewrite map_app. simpl. rewrite E. apply (NoDup_Add (Add_app (robot_id a) (map plan_robot committed) [])).
  rewrite app_nil_r. split; [exact (are_distinct _ _ _ others) | exact (are_of_others _ _ _ others)].
Qed.

Section Free_plan.
Variable p : plan.
Hypothesis of_robot : plan_robot p = robot_id a.
Hypothesis lawful : Plan_lawful i a p.
Hypothesis free : Free (visits p).

Lemma free_plan_keeps_limits : Limits_are_kept i (committed ++ [p]).
Proof.
  assert (A : forall id l tick, id <> robot_id a -> Counts i (committed ++ [p]) id l tick -> Counts i committed id l tick).
  { intros id l tick N (place & back & L & B & q & v & Q & E & H). exists place, back. repeat split; auto; try lia.
    exists q, v. apply in_app_or in Q as [Q|[<-|[]]]; [auto|]. congruence. }
  intros l tick ids L N C. destruct (in_dec Z.eq_dec (robot_id a) ids) as [I|I].
  2:{ apply (limits_are_kept l tick ids L N). intros id J. apply A; auto. intros ->. tauto. }
  apply in_split in I as (b & r & ->).
  assert (D : forall id, In id (b ++ r) -> Counts i committed id l tick).
  { intros id J. apply A.
    - intros ->. exact (NoDup_remove_2 _ _ _ N J).
    - apply C. apply in_app_or in J. apply in_or_app. simpl. tauto. }
  destruct (C (robot_id a)) as (place & back & P & B & q & v & Q & E & V & F & T); [apply in_or_app; simpl; auto|].
  apply in_app_or in Q as [Q|[<-|[]]].
  { destruct (are_of_others _ _ _ others). rewrite <- E. apply in_map. exact Q. }
  pose proof (visits_resources _ _ _ lawful v V) as R. apply in_map_iff in R as (x & G & R).
  destruct (stays_that_fit_have_room v x _ (has_room _ free v V) R G T) as [_ M].
  specialize (M back B l (b ++ r) L). replace (tick - back + back) with tick in M by lia.
  rewrite app_length in *. simpl. enough (Z.of_nat (length b + length r) < limit_capacity l) by lia.
  apply M; auto; [congruence | exact (NoDup_remove_1 _ _ _ N)].
Qed.

Lemma free_plan_crosses_no_other q v w x y : In q committed -> Consecutive p v w -> Consecutive q x y ->
  enter w = enter y -> Close i (visit_resource v) (visit_resource y) -> Close i (visit_resource w) (visit_resource x) ->
  False.
Proof.
  intros Q C D T Cv Cw. destruct (close_moves_cross i well_formed (committed ++ [p])) with (p := p) (v := v) (w := w)
    (q := q) (x := x) (y := y) as (m & M & O); auto.
  - intros z Z0. apply in_app_or in Z0 as [Z0|[<-|[]]]; [exact (are_of_robots _ _ _ others z Z0)|].
    exists a. auto.
  - intros z b Z0 B E. apply in_app_or in Z0 as [Z0|[<-|[]]]; [exact (are_lawful _ _ _ others z b Z0 B E)|].
    enough (b = a) as -> by exact lawful. apply (robot_is_unique i well_formed); congruence.
  - exact free_plan_keeps_limits.
  - apply in_or_app. simpl. auto.
  - apply in_or_app. auto.
  - intros E. apply (are_of_others _ _ _ others). rewrite <- of_robot, E. apply in_map. exact Q.
  - pose proof (makes_no_exchange _ free v w C) as X. apply not_true_iff_false in X. apply X.
    unfold is_exchange. apply existsb_exists. exists m. split; auto. apply (has_moves _ _ _ represents).
    exists q. eexists. split; [exact Q|]. split; [exists x, y; auto | exact O].
Qed.

Theorem free_plan_is_sound : Sound i a committed p.
Proof.
  split; auto; [exact free_plan_keeps_limits|].
  assert (S : forall r s, Close i r s -> Close i s r).
  { intros r s [<-|(g & G & K & R & S)]; [left | right; exists g]; auto. }
  intros one other r s s' r' tick N R Rs Rs' Rr' (q & v & w & Q & I & C & E & F & T) (z & x & y & Z0 & J & D & G & H & U) Cr Cs.
  subst. apply in_app_or in Q as [Q|[<-|[]]]; apply in_app_or in Z0 as [Z0|[<-|[]]].
  - apply (exchanges_are_avoided (plan_robot q) (plan_robot z) (visit_resource v) (visit_resource w) (visit_resource x)
      (visit_resource y) (enter w)); auto; [exists q, v, w | exists z, x, y]; auto 10.
  - apply (free_plan_crosses_no_other q x y v w Q D C); auto.
  - apply (free_plan_crosses_no_other z v w x y Z0 C D); auto.
  - apply N. reflexivity.
Qed.
End Free_plan.

(** * The labels of the search *)

(** The way to a label keeps all rules so far. *)
Record Right_way (l : label) : Prop := {
  is_a_course : Course (behind l ++ [visit_until l (Some (ready_from l))]);
  is_free : Free (behind l ++ [visit_until l (Some (ready_from l))]);
  is_of_graph : In (target l) (resources i);
  is_window : In (room l) (windows_in c (target l));
  is_in_room : holds_stay (room l) (entry l) (Some (ready_from l)) = true;
  stays_long_enough : entry l + least_stay a (target l) <= ready_from l
}.

Lemma stay_lawful_iff l tick : In (target l) (resources i) ->
  Stay_lawful i a (visit_until l tick) <-> No_earlier tick (entry l + least_stay a (target l)).
Proof.
  intros R. unfold Stay_lawful, visit_until. simpl. split.
  - intros [_ H]. destruct tick as [t|]; simpl; auto. specialize (H (target l) t R eq_refl eq_refl). lia.
  - intros H. split; [apply in_map; exact R|]. intros r t S E ->. simpl in H.
    rewrite (resource_is_unique i well_formed r (target l)) by auto. lia.
Qed.

Lemma moved_way_is_right l e : Right_way l -> Moved i known c a l e -> Right_way e.
Proof.
  intros [C F R W H S] M.
  pose proof (has_resource _ _ _ _ _ _ M) as R'. pose proof (has_window _ _ _ _ _ _ M) as W'.
  pose proof (is_ready _ _ _ _ _ _ M) as T. pose proof (stays_least _ _ _ _ _ _ M) as D.
  assert (I : Stay_lawful i a (visit_until l (Some (entry e)))) by (apply stay_lawful_iff; simpl; [auto | lia]).
  assert (J : Stay_lawful i a (visit_until e (Some (ready_from e)))) by (apply stay_lawful_iff; simpl; [auto | lia]).
  assert (P : Has_room (visit_until l (Some (entry e)))).
  { exists (target l), (room l). repeat split; auto. simpl. unfold holds_stay in *. apply andb_true_iff in H as [H _].
    rewrite H. exact (was_in_room _ _ _ _ _ _ M). }
  assert (Q : Has_room (visit_until e (Some (ready_from e)))).
  { exists (target e), (room e). repeat split; auto. exact (fits _ _ _ _ _ _ M). }
  split; auto; [| | exact (fits _ _ _ _ _ _ M) | lia]; rewrite (comes_from _ _ _ _ _ _ M).
  - apply course_goes_on; auto.
    + eapply course_with_another_end; [exact C | split; reflexivity | exact I].
    + apply (has_move_iff i). exact (makes_move _ _ _ _ _ _ M).
  - apply free_goes_on; auto; [|exact (is_no_exchange _ _ _ _ _ _ M)].
    eapply free_with_another_end; [exact F | split; reflexivity | exact P].
Qed.

(** A right way on which the plan of a robot with a goal alone can end is a sound plan. *)
Theorem right_way_is_sound now l : Has_goal_alone a -> Right_way l -> can_end i a now l = true ->
  Sound i a committed (plan_of i a l).
Proof.
  intros O [C F R W H S] E. unfold can_end in E. apply andb_true_iff in E as [G E]. apply Z.eqb_eq in G.
  pose proof (least_stay_is_positive i a well_formed of_instance (target l) R) as D.
  set (leave := match after_goal i with Park => None | Vanish => Some (entry l + least_stay a (target l)) end).
  assert (L : Stay_lawful i a (visit_until l leave)).
  { apply stay_lawful_iff; auto. unfold leave. destruct (after_goal i); simpl; auto. lia. }
  assert (P : Has_room (visit_until l leave)).
  { exists (target l), (room l). repeat split; auto. unfold holds_stay, lasts, visit_until, leave in *. simpl.
    apply andb_true_iff in H as [-> H]. destruct (after_goal i), (closes (room l)); auto. simpl. lia. }
  apply free_plan_is_sound; unfold plan_of; fold leave; simpl; auto.
  - apply lawful_plan_is_a_course. simpl. split.
    + eapply course_with_another_end; [exact C | split; reflexivity | exact L].
    + split.
      * exists (behind l), (visit_until l leave). split; auto. split; [exact G|]. unfold leave.
        destruct (after_goal i); auto. intros r Q X. simpl.
        rewrite (resource_is_unique i well_formed r (target l)), goal_alone_needs_its_duration by (congruence || lia || auto).
        reflexivity.
      * apply goal_alone_is_served; auto. unfold leave. destruct (after_goal i); simpl; auto. lia.
  - eapply free_with_another_end; [exact F | split; reflexivity | exact P].
Qed.
End Robot.
