(** What committed plans leave to one more robot, and what the robot has done before it is planned. *)
Require Import ZArith List Bool Lia SetoidList OrderedTypeEx.
From Carproof Require Import Law Collections Timeline Journey Checker Windows.
Import ListNotations.
Open Scope Z_scope.

(** * The context of a query *)

(** The stays of the committed plans in each limit, when it is full, the free windows and the moves. A resource without
    an entry in [windows_known] is free from tick 0 on. *)
Record context := Context {
  stays_of : Map.t (list stay);
  full_of : Map.t (list stay);
  windows_known : Map.t (list window);
  moves_made : Triples.S.t
}.

Definition empty_context : context :=
  Context (Map.empty (list stay)) (Map.empty (list stay)) (Map.empty (list window)) Triples.S.empty.

Definition windows_in (c : context) (r : resource) : list window :=
  match Map.find (resource_id r) (windows_known c) with Some l => l | None => [Window 0 None] end.

(** The elements of a list, each once. *)
Definition each_once (l : list Z) : list Z := Ids.S.elements (Ids.of_list l).

(** The limits that the plan visits, and the resources in a limit. *)
Definition keys_visited (known : lookup) (p : plan) : list Z :=
  each_once (flat_map (fun v => keys_at known (visit_resource v)) (visits p)).
Definition places_of (known : lookup) (key : Z) : list Z :=
  match Map.find key (limit_of known) with Some (_, l) => limit_places l | None => [] end.

Definition renew_full (known : lookup) (stays m : Map.t (list stay)) (key : Z) :=
  Map.add key (full_in_timetable known stays key) m.
Definition renew_windows (known : lookup) (full : Map.t (list stay)) (m : Map.t (list window)) (place : Z) :=
  Map.add place (windows_between (counts_longer known) (full_at known (listed full) place)) m.

(** Commit one more plan: only the windows of resources in the limits that it visits are computed again. *)
Definition commit (known : lookup) (c : context) (p : plan) : context :=
  let stays := add_visits (keys_at known) (counts_longer known) (stays_of c) p in
  let keys := keys_visited known p in
  let full := fold_left (renew_full known stays) keys (full_of c) in
  Context stays full
    (fold_left (renew_windows known full) (each_once (flat_map (places_of known) keys)) (windows_known c))
    (fold_left (fun made m => Triples.S.add m made) (flat_map (crossings known) (add_moves [] p)) (moves_made c)).

Definition context_of (known : lookup) (ps : list plan) : context := fold_left (commit known) ps empty_context.

(** A committed robot makes the opposite move at the tick, or one between close resources. *)
Definition is_exchange (known : lookup) (c : context) (source target tick : Z) : bool :=
  existsb (fun m => Triples.contains (moves_made c) (opposite m)) (crossings known (tick, (source, target))).

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
          if is_exchange known c (visit_resource v) (visit_resource x) (enter x) then false else allows known c later
        end
      else false
    end
  end.

(** The context is that of the committed plans. *)
Record Represents (i : instance) (c : context) (committed : list plan) : Prop := {
  has_stays : stays_of c = stays_in_limits (lookup_of i) (gap i) committed;
  has_full : forall key, listed (full_of c) key = full_in_timetable (lookup_of i) (stays_of c) key;
  has_windows : forall r, windows_in c r = windows_of (lookup_of i) committed r;
  has_moves : forall m, Triples.contains (moves_made c) m = true <->
    exists p n, In p committed /\ Moves p n /\ In m (crossings (lookup_of i) n)
}.

Lemma in_each_once x l : In x (each_once l) <-> In x l.
Proof.
  unfold each_once. rewrite <- (Ids.contains_of_list l x). unfold Ids.contains. rewrite <- Ids.F.mem_iff, Ids.F.elements_iff.
  rewrite InA_alt. split.
  - intros H. exists x. split; [reflexivity | exact H].
  - intros (y & E & H). unfold Z_as_OT.eq in E. congruence.
Qed.

Lemma contains_added_all l made m :
  Triples.contains (fold_left (fun made m => Triples.S.add m made) l made) m = true
  <-> In m l \/ Triples.contains made m = true.
Proof.
  revert made. induction l as [|x l IH]; intros made; simpl; [tauto|].
  rewrite IH, Triples.contains_added. intuition.
Qed.

Section Instance.
Variable i : instance.
Hypothesis well_formed : Well_formed i.
Local Notation known := (lookup_of i).

Lemma free_limits_are_not_full key : full_in_timetable known (Map.empty (list stay)) key = [].
Proof.
  unfold full_in_timetable. destruct (Map.find key (limit_of known)) as [[k l]|] eqn:L; auto.
  apply (find_in_index fst) in L as [L _]; [|exact (keys_are_unique i well_formed)].
  pose proof (limit_capacity_is_positive i well_formed k l L). rewrite listed_empty.
  unfold full_stays. change (changes []) with [(0, 0)]. cbn [map fst snd sweep].
  cbv zeta. change (0 + - 0) with 0. destruct (Z.ltb_spec 0 (1 - limit_capacity l)); [lia | reflexivity].
Qed.

Lemma empty_context_represents : Represents i empty_context [].
Proof.
  split.
  - reflexivity.
  - intros key. simpl. rewrite free_limits_are_not_full. apply listed_empty.
  - intros r. unfold windows_of, full_at. cbv zeta. change (stays_in_limits known (counts_longer known) []) with
      (Map.empty (list stay)).
    replace (flat_map (full_in_timetable known (Map.empty (list stay))) (keys_at known (resource_id r)))
      with (@nil stay); [reflexivity|].
    induction (keys_at known (resource_id r)) as [|key keys IH]; simpl; auto.
    rewrite free_limits_are_not_full. exact IH.
  - intros m. split; [discriminate|]. intros (p & n & [] & _).
Qed.

Lemma listed_of_unvisited p key : ~ In key (keys_visited known p) ->
  forall m, listed (add_visits (keys_at known) (gap i) m p) key = listed m key.
Proof.
  unfold keys_visited. rewrite in_each_once, in_flat_map. intros N m. unfold add_visits.
  destruct (visits p) as [|v later]; auto.
  assert (H : forall x, In x (v :: later) -> existsb (Z.eqb key) (keys_at known (visit_resource x)) = false).
  { intros x X. apply not_true_iff_false. intros H. apply existsb_exists in H as (k & K & E).
    apply Z.eqb_eq in E. subst k. eauto. }
  clear N. revert v m H. induction later as [|w rest IH]; intros v m H; cbn [add_from]; cbv zeta.
  - rewrite (listed_by_keys (fun k => (enter v, _))) by exact (keys_are_different i well_formed _).
    rewrite H by (left; reflexivity). reflexivity.
  - rewrite IH by (intros x X; apply H; right; exact X).
    rewrite (listed_by_keys (fun k => (enter v, _))) by exact (keys_are_different i well_formed _).
    rewrite H by (left; reflexivity). reflexivity.
Qed.

Lemma find_renewed {A} (f : Z -> A) k l : forall m,
  Map.find k (fold_left (fun m x => Map.add x (f x) m) l m) = if existsb (Z.eqb k) l then Some (f k) else Map.find k m.
Proof.
  induction l as [|x l IH]; intros m; simpl; auto. rewrite IH. destruct (existsb (Z.eqb k) l); [rewrite orb_true_r; auto|].
  rewrite orb_false_r. destruct (Z.eqb_spec k x) as [->|N].
  - rewrite Map_facts.add_eq_o by reflexivity. reflexivity.
  - rewrite Map_facts.add_neq_o by congruence. reflexivity.
Qed.

Lemma is_listed k l : existsb (Z.eqb k) l = true <-> In k l.
Proof.
  rewrite existsb_exists. split; [intros (x & X & E); apply Z.eqb_eq in E; congruence|].
  intros H. exists k. split; auto. apply Z.eqb_refl.
Qed.

Lemma commit_represents c committed p : Represents i c committed -> Represents i (commit known c p) (committed ++ [p]).
Proof.
  intros [S Fu W M].
  assert (S' : stays_of (commit known c p) = stays_in_limits known (gap i) (committed ++ [p])).
  { unfold commit, stays_in_limits, timetable. cbv zeta. cbn [stays_of]. rewrite fold_left_app. simpl. rewrite S.
    reflexivity. }
  assert (F' : forall key, listed (full_of (commit known c p)) key = full_in_timetable known (stays_of (commit known c p)) key).
  { intros key. unfold commit. cbv zeta. cbn [full_of stays_of]. unfold listed at 1. unfold renew_full.
    rewrite (find_renewed (full_in_timetable known _)).
    destruct (existsb (Z.eqb key) (keys_visited known p)) eqn:E; auto.
    change (listed (full_of c) key = full_in_timetable known (add_visits (keys_at known) (gap i) (stays_of c) p) key).
    rewrite Fu. unfold full_in_timetable. rewrite listed_of_unvisited; auto.
    rewrite <- is_listed. congruence. }
  split; [exact S' | exact F' | |].
  - intros r. unfold windows_in, windows_of. cbv zeta. change (counts_longer known) with (gap i). rewrite <- S'.
    assert (E : full_at known (full_in_timetable known (stays_of (commit known c p))) (resource_id r)
      = full_at known (listed (full_of (commit known c p))) (resource_id r)).
    { unfold full_at. apply flat_map_ext. intros key. symmetry. apply F'. }
    rewrite E. unfold commit at 1. cbv zeta. cbn [windows_known]. unfold renew_windows.
    rewrite (find_renewed (fun place => windows_between (counts_longer known) (full_at known (listed _) place))).
    destruct (existsb (Z.eqb (resource_id r)) (each_once (flat_map (places_of known) (keys_visited known p)))) eqn:R.
    + reflexivity.
    + change (windows_in c r = windows_between (gap i) (full_at known (listed (full_of (commit known c p))) (resource_id r))).
      rewrite W. unfold windows_of. cbv zeta. change (counts_longer known) with (gap i). rewrite <- S. f_equal.
      unfold full_at. rewrite !flat_map_concat_map. f_equal. apply map_ext_in. intros key K. rewrite F'. unfold full_in_timetable.
      unfold commit. cbv zeta. cbn [stays_of]. rewrite listed_of_unvisited; auto.
      intros V. apply not_true_iff_false in R. apply R. apply is_listed, in_each_once, in_flat_map.
      exists key. split; auto. apply in_keys_at in K as (l & L & P). unfold places_of.
      rewrite (proj2 (find_limit i well_formed key l) L). exact P.
  - intros m. unfold commit. cbv zeta. cbn [moves_made]. rewrite contains_added_all, in_flat_map, M.
    setoid_rewrite in_add_moves. setoid_rewrite in_app_iff. simpl. split.
    + intros [(n & [[]|H] & K)|(q & n & Q & H)]; [exists p, n | exists q, n]; tauto.
    + intros (q & n & [Q|[<-|[]]] & H & K); [right; exists q, n; auto | left; exists n; auto].
Qed.

Lemma context_of_represents committed : Represents i (context_of known committed) committed.
Proof.
  unfold context_of. assert (H : forall ps c before, Represents i c before ->
    Represents i (fold_left (commit known) ps c) (before ++ ps)).
  - induction ps as [|p ps IH]; intros c before R; simpl; [rewrite app_nil_r; exact R|].
    change (before ++ p :: ps) with (before ++ [p] ++ ps). rewrite app_assoc. apply IH. apply commit_represents.
    exact R.
  - apply (H committed empty_context []). exact empty_context_represents.
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
  keeps_limits : Limits_are_kept i (committed ++ [p]);
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
  intros V. pose proof (is_lawful _ _ _ sound) as L. apply lawful_plan_is_a_chain in L as (u & later & E & _ & T & C).
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

(** What counts among plans counts among more of them. *)
Lemma counts_among_more ps qs id l tick : Counts i ps id l tick -> Counts i (ps ++ qs) id l tick.
Proof.
  intros (place & back & L & B & q & v & Q & H). exists place, back. repeat split; auto; try lia.
  exists q, v. split; [apply in_or_app; auto | exact H].
Qed.

(** The ticks of a visit of a sound plan have room for it. *)
Lemma sound_visit_has_room v r tick : In v (visits p) -> visit_resource v = resource_id r -> Holds v tick -> 0 <= tick ->
  Room_for_one_more i committed r tick.
Proof.
  intros V E H T. split; auto. intros longer G l ids L P N C.
  enough (Z.of_nat (length (robot_id a :: ids)) <= limit_capacity l) by (simpl in *; lia).
  apply (keeps_limits _ _ _ sound l (tick + longer)); auto.
  - constructor; auto. intros I. destruct (C _ I) as (place & back & _ & _ & q & w & Q & F & _).
    apply (are_of_others _ _ others). rewrite <- F. apply in_map. exact Q.
  - intros id [<-|I]; [|apply counts_among_more, C, I]. exists (resource_id r), longer. repeat split; auto; try lia.
    exists p, v. replace (tick + longer - longer) with tick by lia.
    repeat split; auto; try apply H; [apply in_or_app; right; left; auto | exact (is_of_robot _ _ _ sound)].
Qed.

(** Each visit of a sound plan lies in a free window. *)
Theorem sound_visit_is_free v : In v (visits p) ->
  exists r w, In r (resources i) /\ resource_id r = visit_resource v /\ In w (windows_in c r) /\ Lies_in v w.
Proof.
  intros V. destruct (sound_visit v V) as (_ & _ & _ & _ & [K _] & N & B).
  apply in_map_iff in K as (r & E & R). exists r.
  destruct (free_stays_are_in_windows (map (fun s => (fst s - gap i, snd s)) (full_at known (full_in_timetable known
    (stays_in_limits known (gap i) committed)) (resource_id r))) 1 (enter v) (leave v) B) as (w & W & L).
  - intros tick T U. apply (windows_are_of_room i committed well_formed (are_of_robots _ _ others) (are_lawful _ _ others)
      (are_distinct _ _ others) r tick R).
    apply (sound_visit_has_room v); auto; [split; auto | lia].
  - exists w. split; auto. split; auto. split; auto. rewrite (has_windows _ _ _ represents r). exact W.
Qed.

(** No move of a sound plan is an exchange with a committed one. *)
Theorem sound_move_is_free v w : Consecutive p v w ->
  is_exchange known c (visit_resource v) (visit_resource w) (enter w) = false.
Proof.
  intros C. apply not_true_iff_false. intros E. unfold is_exchange in E. apply existsb_exists in E as (m & M & E).
  apply (has_moves _ _ _ represents) in E as (q & n & Q & (x & y & D & ->) & O).
  assert (T : enter y = enter w).
  { apply in_crossings in M as (k & l & -> & _). apply in_crossings in O as (k' & l' & E & _).
    unfold opposite in E. simpl in E. congruence. }
  rewrite T in O. destruct (crossing_moves_are_close i well_formed _ _ _ _ _ m M O) as [Cr Cs].
  assert (A : forall u z u', In u committed \/ u = p -> Consecutive u z u' ->
    In (visit_resource z) (resource_ids i) /\ In (visit_resource u') (resource_ids i)).
  { intros u z u' U X. assert (I : In z (visits u) /\ In u' (visits u)).
    { destruct X as (b & l & ->). split; apply in_or_app; simpl; auto. }
    assert (L : exists b, Plan_lawful i b u).
    { destruct U as [U| ->]; [|exists a; exact (is_lawful _ _ _ sound)].
      destruct (are_of_robots _ _ others u U) as (b & B & F). exists b. exact (are_lawful _ _ others u b U B F). }
    destruct L as [b L]. split; apply (visits_resources _ _ _ L); tauto. }
  destruct (A p v w (or_intror eq_refl) C) as [Rv Rw]. destruct (A q x y (or_introl Q) D) as [Rx Ry].
  apply (avoids_exchanges _ _ _ sound (plan_robot p) (plan_robot q) (visit_resource v) (visit_resource w)
    (visit_resource x) (visit_resource y) (enter w)); auto.
  - rewrite (is_of_robot _ _ _ sound). intros F. apply (are_of_others _ _ others). rewrite F. apply in_map. exact Q.
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
