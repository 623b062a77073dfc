(** What committed plans leave to one more robot, and what the robot has done before it is planned. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey Checker Windows.
Import ListNotations.
Open Scope Z_scope.

(** * The context of a query *)

(** The stays, the free windows and the moves of the committed plans. A resource without an entry in [windows_known]
    has the windows that its stays leave. *)
Record context := Context {
  stays_of : Map.t (list stay);
  windows_known : Map.t (list window);
  moves_made : Triples.S.t
}.

Definition empty_context : context := Context (Map.empty (list stay)) (Map.empty (list window)) Triples.S.empty.

Definition windows_in (c : context) (r : resource) : list window :=
  match Map.find (resource_id r) (windows_known c) with
  | Some l => l
  | None => free_windows (listed (stays_of c) (resource_id r)) (capacity r)
  end.

Definition renew_windows (known : lookup) (stays : Map.t (list stay)) (m : Map.t (list window)) (v : visit) :=
  match Map.find (visit_resource v) (resource_of known) with
  | Some r => Map.add (visit_resource v) (free_windows (listed stays (visit_resource v)) (capacity r)) m
  | None => m
  end.

(** Commit one more plan: only the windows of the resources that it visits are computed again. *)
Definition commit (known : lookup) (c : context) (p : plan) : context :=
  let stays := add_visits (stays_of c) p in
  Context stays
    (fold_left (renew_windows known stays) (visits p) (windows_known c))
    (fold_left (fun made m => Triples.S.add m made) (add_moves [] p) (moves_made c)).

Definition context_of (known : lookup) (ps : list plan) : context := fold_left (commit known) ps empty_context.

(** A committed robot makes the opposite move at the tick. *)
Definition is_exchange (c : context) (source target tick : Z) : bool :=
  Triples.contains (moves_made c) (tick, (target, source)).

(** The stay [since, until) lies in the window. *)
Definition lasts (w : window) (until : option Z) : bool :=
  match closes w, until with
  | None, _ => true
  | Some _, None => false
  | Some last, Some tick => tick <=? last
  end.
Definition holds_stay (w : window) (since : Z) (until : option Z) : bool := (opens w <=? since) && lasts w until.

(** The visits can be made together with the committed plans: each is in a free window, and no move is an exchange. *)
Fixpoint allows (known : lookup) (c : context) (vs : list visit) : bool :=
  match vs with
  | [] => true
  | v :: later =>
    match Map.find (visit_resource v) (resource_of known) with
    | None => false
    | Some r =>
      if existsb (fun w => holds_stay w (enter v) (leave v)) (windows_in c r) then
        match later with
        | [] => true
        | x :: _ =>
          if is_exchange c (visit_resource v) (visit_resource x) (enter x) then false else allows known c later
        end
      else false
    end
  end.

(** The context is that of the committed plans. *)
Record Represents (i : instance) (c : context) (committed : list plan) : Prop := {
  has_stays : stays_of c = timetable committed;
  has_windows : forall r, In r (resources i) -> windows_in c r = windows_of committed r;
  has_moves : forall m, Triples.contains (moves_made c) m = true <-> exists p, In p committed /\ Moves p m
}.

Lemma empty_context_represents i : Represents i empty_context [].
Proof.
  split.
  - reflexivity.
  - intros r _. reflexivity.
  - intros m. split; [discriminate|]. intros (p & [] & _).
Qed.

Lemma contains_added_all l made m :
  Triples.contains (fold_left (fun made m => Triples.S.add m made) l made) m = true
  <-> In m l \/ Triples.contains made m = true.
Proof.
  revert made. induction l as [|x l IH]; intros made; simpl; [tauto|].
  rewrite IH, Triples.contains_added. intuition.
Qed.

Lemma listed_of_unvisited p place m : existsb (fun v => visit_resource v =? place) (visits p) = false ->
  listed (add_visits m p) place = listed m place.
Proof.
  unfold add_visits. revert m. induction (visits p) as [|v vs IH]; intros m; simpl; auto.
  destruct (visit_resource v =? place) eqn:E; [discriminate|]. intros H.
  rewrite IH by exact H. rewrite listed_enlist, E. reflexivity.
Qed.

Section Instance.
Variable i : instance.
Hypothesis well_formed : Well_formed i.
Local Notation known := (lookup_of i).

Lemma find_renewed stays r vs : In r (resources i) -> forall m,
  Map.find (resource_id r) (fold_left (renew_windows known stays) vs m)
  = if existsb (fun v => visit_resource v =? resource_id r) vs
    then Some (free_windows (listed stays (resource_id r)) (capacity r)) else Map.find (resource_id r) m.
Proof.
  intros R. induction vs as [|v vs IH]; intros m; simpl; auto. rewrite IH.
  destruct (existsb (fun v => visit_resource v =? resource_id r) vs); [rewrite orb_true_r; reflexivity|].
  rewrite orb_false_r. unfold renew_windows. destruct (Z.eqb_spec (visit_resource v) (resource_id r)) as [E|N].
  - rewrite E. rewrite (proj2 (find_resource i well_formed (resource_id r) r)) by auto.
    rewrite Map_facts.add_eq_o by reflexivity. reflexivity.
  - destruct (Map.find (visit_resource v) (resource_of known)); auto.
    rewrite Map_facts.add_neq_o by exact N. reflexivity.
Qed.

Lemma commit_represents c committed p : Represents i c committed -> Represents i (commit known c p) (committed ++ [p]).
Proof.
  intros [S W M]. split.
  - unfold timetable. rewrite fold_left_app. simpl. rewrite S. reflexivity.
  - intros r R. specialize (W r R). unfold windows_in in *. unfold commit. cbn [windows_known stays_of].
    rewrite find_renewed by exact R. unfold windows_of, timetable. rewrite fold_left_app. simpl.
    fold (timetable committed). rewrite <- S.
    destruct (existsb (fun v => visit_resource v =? resource_id r) (visits p)) eqn:E; auto.
    rewrite (listed_of_unvisited p (resource_id r) (stays_of c) E). rewrite W. unfold windows_of. rewrite S.
    reflexivity.
  - intros m. unfold commit. cbn [moves_made]. rewrite contains_added_all, in_add_moves, M. simpl.
    setoid_rewrite in_app_iff. simpl. split.
    + intros [[[]|H]|(q & Q & H)]; [exists p | exists q]; auto.
    + intros (q & [Q|[<-|[]]] & H); eauto.
Qed.

Lemma context_of_represents committed : Represents i (context_of known committed) committed.
Proof.
  unfold context_of. assert (H : forall ps c before, Represents i c before ->
    Represents i (fold_left (commit known) ps c) (before ++ ps)).
  - induction ps as [|p ps IH]; intros c before R; simpl; [rewrite app_nil_r; exact R|].
    change (before ++ p :: ps) with (before ++ [p] ++ ps). rewrite app_assoc. apply IH. apply commit_represents.
    exact R.
  - apply (H committed empty_context []). apply empty_context_represents.
Qed.

(** * A robot that is planned against committed plans *)

(** The committed plans are lawful plans of different robots, not of the robot itself. *)
Record Committed (a : robot) (committed : list plan) : Prop := {
  are_of_robots : forall p, In p committed -> exists b, In b (robots i) /\ robot_id b = plan_robot p;
  are_lawful : Plans_lawful i committed;
  are_distinct : NoDup (map plan_robot committed);
  are_of_others : ~ In (robot_id a) (map plan_robot committed)
}.

(** The plan breaks no rule, alone or together with the committed plans. *)
Record Sound (a : robot) (committed : list plan) (p : plan) : Prop := {
  is_of_robot : plan_robot p = robot_id a;
  is_lawful : Plan_lawful i a p;
  keeps_capacity : Capacity_is_kept i (committed ++ [p]);
  avoids_exchanges : Exchanges_are_avoided i (committed ++ [p])
}.

(** The visit lies in the window. *)
Definition Lies_in (v : visit) (w : window) : Prop :=
  opens w <= enter v /\ forall last, closes w = Some last -> exists l, leave v = Some l /\ l <= last.

Lemma lies_in_iff v w : holds_stay w (enter v) (leave v) = true <-> Lies_in v w.
Proof.
  unfold holds_stay, lasts, Lies_in. rewrite andb_true_iff, Z.leb_le.
  destruct (closes w) as [last|], (leave v) as [l|].
  - rewrite Z.leb_le. split; intros [O H]; split; auto.
    + intros x E. injection E as <-. eauto.
    + destruct (H last eq_refl) as (x & E & L). injection E as ->. exact L.
  - split; intros [O H]; split; auto; [discriminate|]. destruct (H last eq_refl) as (x & E & _). discriminate.
  - split; intros [O H]; split; auto. discriminate.
  - split; intros [O H]; split; auto. discriminate.
Qed.

Section Committed_plans.
Variables (a : robot) (committed : list plan) (c : context).
Hypothesis of_instance : In a (robots i).
Hypothesis others : Committed a committed.
Hypothesis represents : Represents i c committed.

Section Sound_plan.
Variable p : plan.
Hypothesis sound : Sound a committed p.

Lemma all_are_distinct : NoDup (map plan_robot (committed ++ [p])).
Proof.
  rewrite map_app. simpl. rewrite (is_of_robot _ _ _ sound).
  pose proof (are_distinct _ _ others) as N. pose proof (are_of_others _ _ others) as O.
  induction (map plan_robot committed) as [|x l IH]; simpl.
  - constructor; [tauto | constructor].
  - inversion N; subst. constructor.
    + rewrite in_app_iff. simpl. intros [H|[H|[]]]; [tauto|]. apply O. left. auto.
    + apply IH; auto. intros H. apply O. right. exact H.
Qed.

Lemma sound_visit v : In v (visits p) -> exists b l, visits p = b ++ v :: l /\ Chain i a v l /\
  Stay_lawful i a v /\ 0 <= enter v /\ Before (enter v) (leave v).
Proof.
  intros V. pose proof (is_lawful _ _ _ sound) as L. apply plan_lawful_iff in L as (u & later & E & _ & T & C).
  pose proof (releases_are_ticks i well_formed a of_instance) as R. rewrite E in V |- *.
  assert (F : forall x, In x (u :: later) -> enter u <= enter x).
  { intros x [<-|X]; [lia|]. destruct (chain_later i a well_formed of_instance u later C x X) as (_ & _ & _ & H). lia. }
  specialize (F v V). clear E. assert (N : 0 <= enter v) by lia. clear F T R.
  assert (B : forall x, Stay_lawful i a x -> Before (enter x) (leave x)).
  { intros x S. destruct (leave x) as [l|] eqn:L; simpl; auto.
    exact (stay_is_positive i a well_formed of_instance x l S L). }
  revert u C V. induction later as [|w rest IH]; intros u C V.
  - destruct V as [->|[]]. exists [], []. exact (conj eq_refl (conj C (conj (proj1 C) (conj N (B v (proj1 C)))))).
  - destruct V as [->|V].
    + exists [], (w :: rest). exact (conj eq_refl (conj C (conj (proj1 C) (conj N (B v (proj1 C)))))).
    + destruct C as (_ & _ & _ & C). destruct (IH w C V) as (b & l & E & H). exists (u :: b), l.
      rewrite E. auto.
Qed.

(** Each visit of a sound plan lies in a free window. *)
Theorem sound_visit_is_free v : In v (visits p) ->
  exists r w, In r (resources i) /\ resource_id r = visit_resource v /\ In w (windows_in c r) /\ Lies_in v w.
Proof.
  intros V. destruct (sound_visit v V) as (_ & _ & _ & _ & [K _] & N & B).
  apply in_map_iff in K as (r & E & R). exists r.
  destruct (free_stays_are_in_windows (listed (timetable committed) (resource_id r)) (capacity r) (enter v) (leave v) B)
    as (w & W & L).
  - intros tick T U. split; [lia|].
    rewrite occupancy_of_timetable
      by exact (plan_holds_once i well_formed committed (are_of_robots _ _ others) (are_lawful _ _ others)).
    assert (O : occupants (committed ++ [p]) (resource_id r) tick <= capacity r).
    { apply occupants_iff; [exact all_are_distinct|]. intros ids. apply (keeps_capacity _ _ _ sound). exact R. }
    unfold occupants in *. rewrite filter_app, app_length in O. simpl in O.
    replace (occupies p (resource_id r) tick) with true in O; [simpl in O; lia|].
    symmetry. apply occupies_iff. exists v. repeat split; auto.
  - exists w. split; auto. split; auto. split; auto. rewrite (has_windows _ _ _ represents r R). exact W.
Qed.

(** No move of a sound plan is an exchange with a committed one. *)
Theorem sound_move_is_free v w : Consecutive p v w ->
  is_exchange c (visit_resource v) (visit_resource w) (enter w) = false.
Proof.
  intros C. destruct (is_exchange c (visit_resource v) (visit_resource w) (enter w)) eqn:E; auto. exfalso.
  unfold is_exchange in E. apply (has_moves _ _ _ represents) in E as (q & Q & x & y & D & M).
  injection M as T R S. pose proof (is_lawful _ _ _ sound) as L.
  assert (V : In v (visits p) /\ In w (visits p)).
  { destruct C as (b & l & ->). split; apply in_or_app; simpl; auto. }
  apply (avoids_exchanges _ _ _ sound (plan_robot p) (plan_robot q) (visit_resource v) (visit_resource w) (enter w)).
  - rewrite (is_of_robot _ _ _ sound). intros F. apply (are_of_others _ _ others). rewrite F. apply in_map. exact Q.
  - apply (visits_resources _ _ _ L). tauto.
  - apply (visits_resources _ _ _ L). tauto.
  - exists p, v, w. repeat split; auto. apply in_or_app. simpl. auto.
  - exists q, x, y. repeat split; auto. apply in_or_app. auto.
Qed.

Lemma sound_visits_are_allowed vs : (exists b l, visits p = b ++ vs ++ l) -> allows known c vs = true.
Proof.
  induction vs as [|v later IH]; intros (b & l & E); cbn [allows]; auto.
  assert (V : In v (visits p)) by (rewrite E; apply in_or_app; right; left; auto).
  destruct (sound_visit_is_free v V) as (r & w & R & F & W & L). rewrite <- F.
  rewrite (proj2 (find_resource i well_formed (resource_id r) r)) by auto.
  replace (existsb (fun w => holds_stay w (enter v) (leave v)) (windows_in c r)) with true.
  - destruct later as [|x rest]; auto. rewrite F.
    rewrite sound_move_is_free by (exists b, (rest ++ l); exact E).
    apply IH. exists (b ++ [v]), l. rewrite E, <- app_assoc. reflexivity.
  - symmetry. apply existsb_exists. exists w. split; auto. apply lies_in_iff. exact L.
Qed.
End Sound_plan.
End Committed_plans.
End Instance.
