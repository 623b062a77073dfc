(** Certificates that no plan of a robot arrives earlier than a tick, or that it has none: carproof-query/1.

    A certificate has the tick [bound] before which no plan arrives ([None]: there is no plan at all), labels and a
    potential.

    - A label (resource, tick) stands for the free window of the resource that holds the tick: the robot enters it no
      earlier than at the tick. Windows are half-open, and no window is named: the tick does that.
    - The potential (resource, ticks) is a lower bound of the ticks from entering the resource to entering the goal.
      From a resource that is not listed the goal cannot be reached.

    It is accepted if the potential is 0 at the goal and grows along no move backwards by more than the ticks that the
    robot needs in the resource that it leaves; if from the start, and from each label, every window that can be entered
    at a tick t with t + potential < bound has a label no later than t; and if neither the start nor a label before
    the bound lets the robot end its plan. The start is not in the certificate: it is computed. The labels are the
    windows that A* has expanded before it found the plan, with their earliest entries. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context Past.
Import ListNotations.
Open Scope Z_scope.

Record certificate := Certificate { bound : option Z; labels : list (Z * Z); potential : list (Z * Z) }.

(** The resources that one move leads to, by resource. *)
Definition successors_of (i : instance) : Map.t (list Z) :=
  fold_left (fun m move => enlist (fst move) (snd move) m) (moves_of_graph i) (Map.empty (list Z)).

(** The stays in the limits that a robot enters that makes an opposite move: there are no more of these than stays. *)
Definition stays_before_exchanges (known : lookup) (c : context) (source : Z) : list stay :=
  flat_map (listed (stays_of c)) (listed (swap_keys known) source).

(** The first tick from [tick] on at which no committed robot makes the opposite move; looked for as often as there
    are [entries]. *)
Fixpoint wait_for_room (known : lookup) (c : context) (source target : Z) (entries : list stay) (tick : Z) : Z :=
  match entries with
  | [] => tick
  | _ :: later =>
    if is_exchange known c source target tick then wait_for_room known c source target later (tick + 1) else tick
  end.

Section Checker.
Variables (i : instance) (known : lookup) (successors : Map.t (list Z)).
Variables (c : context) (a : robot) (now : Z).
Variables (bound : option Z) (label_map : Map.t (list Z)) (potential : Map.t (Z * Z)).

(** The tick is not before the bound. *)
Definition reaches (tick : Z) : bool := match bound with Some t => t <=? tick | None => false end.

(** A robot that enters the resource at the tick enters the goal no earlier than the bound. *)
Definition is_late (id tick : Z) : bool :=
  match Map.find id potential with Some (_, ticks) => reaches (tick + ticks) | None => true end.

Definition goal_is_0 : bool := match Map.find (goal a) potential with Some (_, ticks) => ticks =? 0 | None => false end.

Definition move_is_consistent (move : Z * Z) : bool :=
  match Map.find (snd move) potential, Map.find (fst move) potential with
  | None, _ => true
  | Some _, None => false
  | Some (_, behind), Some (_, ticks) => ticks <=? least_ticks known a (fst move) + behind
  end.

(** A label of the window no later than the tick. *)
Definition has_label (id : Z) (w : window) (tick : Z) : bool :=
  existsb (fun entry => (opens w <=? entry) && (entry <=? tick)) (listed label_map id).

(** Every window of the target that the robot can enter early enough, if it is in the window [w] of the source and may
    leave at [ready], has a label. *)
Definition move_is_closed (source : Z) (entries : list stay) (w : window) (ready target : Z) : bool :=
  match Map.find target (resource_of known) with
  | None => true
  | Some r =>
    forallb (fun x =>
      if lasts w (Some (opens x)) && lasts x (Some (Z.max ready (opens x) + least_stay a r)) then
        let tick := wait_for_room known c source target entries (Z.max ready (opens x)) in
        if lasts w (Some tick) && lasts x (Some (tick + least_stay a r)) && negb (is_late target tick)
        then has_label target x tick else true
      else true) (windows_in c r)
  end.

Definition is_closed (source : Z) (w : window) (ready : Z) : bool :=
  let entries := stays_before_exchanges known c source in
  forallb (move_is_closed source entries w ready) (listed successors source).

(** The robot can end its plan in the window of the resource, if it may. *)
Definition ends_in (id : Z) (w : window) (may_vanish : bool) : bool :=
  (id =? goal a) && match after_goal i with Park => lasts w None | Vanish => may_vanish end.

Definition label_accepted (label : Z * Z) : bool :=
  let (id, entry) := label in
  if is_late id entry then true
  else match Map.find id (resource_of known) with
  | None => true
  | Some r =>
    forallb (fun w =>
      if (opens w <=? entry) && lasts w (Some (entry + 1))
      then negb (ends_in id w true) && is_closed id w (entry + least_stay a r) else true) (windows_in c r)
  end.

Definition start_accepted (s : standing) : bool :=
  if is_late (place s) (since s) then true
  else match Map.find (place s) (resource_of known) with
  | None => true
  | Some r =>
    forallb (fun w =>
      if holds_stay w (since s) (Some (ready s))
      then negb (ends_in (place s) w (now <=? since s + last_stay a r)) && is_closed (place s) w (ready s)
      else true) (windows_in c r)
  end.
End Checker.

Definition labels_by_resource (l : list (Z * Z)) : Map.t (list Z) :=
  fold_left (fun m label => enlist (fst label) (snd label) m) l (Map.empty (list Z)).

(** What does not depend on the robot: the moves of the graph, and look-ups. *)
Record world := World { looked_up : lookup; all_moves : list (Z * Z); successors : Map.t (list Z) }.
Definition world_of (i : instance) : world := World (lookup_of i) (moves_of_graph i) (successors_of i).

(** The certificate of a robot that is planned at the tick [now] against the plans of the context, and has followed
    a plan until then, or none. A robot whose plan has ended keeps it. *)
Definition certificate_accepted (i : instance) (g : world) (c : context) (a : robot) (now : Z) (followed : option plan)
  (cert : certificate) : bool :=
  let known := looked_up g in
  let search :=
    let s := standing_of known a now followed in
    if allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))]) then
      let label_map := labels_by_resource (labels cert) in
      let pot := index fst (potential cert) in
      goal_is_0 a pot
      && forallb (move_is_consistent known a pot) (all_moves g)
      && start_accepted i known (successors g) c a now (bound cert) label_map pot s
      && forallb (label_accepted i known (successors g) c a (bound cert) label_map pot) (labels cert)
    else true in
  match followed with
  | Some before =>
    if has_ended before now then
      if allows known c (visits before) then reaches (bound cert) (arrival (release a) before) else true
    else search
  | None => search
  end.

(** * Why a certificate is refused *)

(** Details for a message, with the ids of the resources; only [certificate_accepted] decides. *)
Inductive fault :=
| Earlier_arrival (tick : Z)              (** the robot's plan has ended, and arrived at the tick *)
| Goal_potential                          (** the potential of the goal must be 0 *)
| Move_potential (source target : Z)      (** along this move the potential falls by more than the robot needs *)
| Open_start                              (** from the start a window without a label, or the end, is in reach *)
| Open_label (id entry : Z).              (** the same from this label *)

Definition certificate_fault (i : instance) (g : world) (c : context) (a : robot) (now : Z) (followed : option plan)
  (cert : certificate) : option fault :=
  let known := looked_up g in
  let label_map := labels_by_resource (labels cert) in
  let pot := index fst (potential cert) in
  let refused := fun label => negb (label_accepted i known (successors g) c a (bound cert) label_map pot label) in
  let inconsistent := fun move => negb (move_is_consistent known a pot move) in
  let search :=
    if negb (goal_is_0 a pot) then Goal_potential
    else match find inconsistent (all_moves g), find refused (labels cert) with
    | Some (source, target), _ => Move_potential source target
    | None, Some (id, entry) => Open_label id entry
    | None, None => Open_start
    end in
  if certificate_accepted i g c a now followed cert then None
  else match followed with
  | Some before => Some (if has_ended before now then Earlier_arrival (arrival (release a) before) else search)
  | None => Some search
  end.

(** * Proofs *)

(** The tick is not before the bound. Without a bound this holds for no tick. *)
Definition Reaches (bound : option Z) (tick : Z) : Prop := match bound with Some t => t <= tick | None => False end.

Lemma reaches_iff bound tick : reaches bound tick = true <-> Reaches bound tick.
Proof. unfold reaches, Reaches. destruct bound; [apply Z.leb_le | split; [discriminate | tauto]]. Qed.

Lemma is_late_later bound pot id tick later : tick <= later ->
  is_late bound pot id tick = true -> is_late bound pot id later = true.
Proof.
  unfold is_late. destruct (Map.find id pot) as [[x ticks]|]; auto. rewrite !reaches_iff.
  unfold Reaches. destruct bound; auto. lia.
Qed.

Lemma in_labels_by_resource l id entry : In entry (listed (labels_by_resource l) id) <-> In (id, entry) l.
Proof.
  unfold labels_by_resource.
  assert (H : forall m, In entry (listed (fold_left (fun m label => enlist (fst label) (snd label) m) l m) id)
    <-> In (id, entry) l \/ In entry (listed m id)).
  - induction l as [|[x y] l IH]; intros m; simpl; [tauto|]. rewrite IH, listed_enlist. simpl.
    destruct (Z.eqb_spec x id) as [->|N]; simpl; split; intros H.
    + destruct H as [H|[->|H]]; auto.
    + destruct H as [[E|H]|H]; auto. injection E as ->. auto.
    + tauto.
    + destruct H as [[E|H]|H]; auto. congruence.
  - rewrite H, listed_empty. simpl. tauto.
Qed.

(** No tick is passed over at which the robot may move. *)
Lemma wait_for_room_is_least known c source target entries later : forall tick, tick <= later ->
  is_exchange known c source target later = false -> wait_for_room known c source target entries tick <= later.
Proof.
  induction entries as [|e entries IH]; intros tick T E; simpl; auto.
  destruct (is_exchange known c source target tick) eqn:F; auto. apply IH; auto.
  enough (tick <> later) by lia. congruence.
Qed.

Lemma wait_for_room_waits known c source target entries : forall tick, tick <= wait_for_room known c source target entries tick.
Proof.
  induction entries as [|e entries IH]; intros tick; simpl; [lia|].
  destruct (is_exchange known c source target tick); [|lia]. specialize (IH (tick + 1)). lia.
Qed.

Section Instance.
Variable i : instance.
Hypothesis well_formed : Well_formed i.
Local Notation known := (lookup_of i).

Lemma in_moves_of_graph r s : In (r, s) (moves_of_graph i) <-> Move i r s.
Proof.
  rewrite <- (has_move_iff i r s). unfold has_move, lookup_of, move_set. symmetry. apply Pairs.contains_of_list.
Qed.

Lemma in_successors r s : In s (listed (successors_of i) r) <-> Move i r s.
Proof. rewrite <- in_moves_of_graph. apply (in_labels_by_resource (moves_of_graph i)). Qed.

Lemma least_ticks_of a r : In r (resources i) -> least_ticks known a (resource_id r) = least_stay a r.
Proof.
  intros R. unfold least_ticks. rewrite (proj2 (find_resource i well_formed (resource_id r) r)) by auto. reflexivity.
Qed.

Lemma find_own r id : In r (resources i) -> resource_id r = id -> Map.find id (resource_of known) = Some r.
Proof. intros R E. apply find_resource; auto. Qed.

Section Certificate.
Variables (a : robot) (committed : list plan) (c : context) (now : Z) (bound : option Z).
Variables (label_list : list (Z * Z)) (pot : Map.t (Z * Z)).
Hypothesis of_instance : In a (robots i).
Hypothesis others : Committed i a committed.
Hypothesis represents : Represents i c committed.

Local Notation label_map := (labels_by_resource label_list).
Local Notation late := (is_late bound pot).
Local Notation closed := (is_closed known (successors_of i) c a bound label_map pot).

Hypothesis goal_ok : goal_is_0 a pot = true.
Hypothesis potential_ok : forall move, In move (moves_of_graph i) -> move_is_consistent known a pot move = true.
Hypothesis labels_ok : forall label, In label label_list ->
  label_accepted i known (successors_of i) c a bound label_map pot label = true.

Lemma late_at_goal tick : late (goal a) tick = true <-> Reaches bound tick.
Proof.
  pose proof goal_ok as G. unfold goal_is_0 in G. unfold is_late.
  destruct (Map.find (goal a) pot) as [[x t]|]; [|discriminate].
  apply Z.eqb_eq in G. subst t. rewrite reaches_iff, Z.add_0_r. tauto.
Qed.

Lemma late_after_move r s tick later : Move i r s -> tick + least_ticks known a r <= later ->
  late r tick = true -> late s later = true.
Proof.
  intros M T L. apply in_moves_of_graph in M. pose proof (potential_ok _ M) as P.
  unfold move_is_consistent in P. simpl in P. unfold is_late in *.
  destruct (Map.find s pot) as [[y behind]|]; auto. destruct (Map.find r pot) as [[x ticks]|]; [|discriminate].
  rewrite reaches_iff in *. unfold Reaches in *. destruct bound; auto. lia.
Qed.

(** A plan has been followed as far as the visit: it is late, or a label of its window is no later. *)
Definition Followed (v : visit) (w : window) : Prop :=
  late (visit_resource v) (enter v) = true \/
  exists entry, In (visit_resource v, entry) label_list /\ opens w <= entry <= enter v.

Section Plan.
Variable p : plan.
Hypothesis sound : Sound i a committed p.

(** The window of a visit. *)
Definition Visited (v : visit) (r : resource) (w : window) : Prop :=
  In r (resources i) /\ resource_id r = visit_resource v /\ In w (windows_in c r) /\ Lies_in v w.

Lemma closed_step source w ready v x : Consecutive p v x -> visit_resource v = source -> Lies_in v w ->
  leave v = Some (enter x) -> ready <= enter x -> Move i source (visit_resource x) -> Stay_lawful i a x ->
  closed source w ready = true -> forall r wx, Visited x r wx -> Followed x wx.
Proof.
  intros C E L X T M [_ D] H r wx (R & F & W & O & U). unfold is_closed in H. cbv zeta in H. rewrite forallb_forall in H.
  apply in_successors in M. specialize (H _ M). unfold move_is_closed in H.
  rewrite (find_own r (visit_resource x) R F) in H. rewrite forallb_forall in H. specialize (H wx W). cbv zeta in H.
  set (tick := wait_for_room known c source (visit_resource x) (stays_before_exchanges known c source)
    (Z.max ready (opens wx))) in H.
  assert (T' : Z.max ready (opens wx) <= tick) by apply wait_for_room_waits.
  assert (K : tick <= enter x).
  { apply wait_for_room_is_least; [lia|]. rewrite <- E.
    apply (sound_move_is_free i well_formed a committed c others represents p sound). exact C. }
  assert (A : forall t, t <= enter x -> lasts w (Some t) = true).
  { intros t Q. destruct L as [_ L]. unfold lasts. destruct (closes w) as [last|]; auto.
    destruct (L last eq_refl) as (l & G & N). rewrite X in G. injection G as <-. apply Z.leb_le. lia. }
  assert (B : forall t, t <= enter x -> lasts wx (Some (t + least_stay a r)) = true).
  { intros t Q. unfold lasts. destruct (closes wx) as [last|]; auto.
    destruct (U last eq_refl) as (l & G & N). specialize (D r l R F G). apply Z.leb_le. lia. }
  rewrite (A (opens wx)), (B (Z.max ready (opens wx))), (A tick), (B tick) in H by lia. simpl in H.
  destruct (late (visit_resource x) tick) eqn:I; simpl in H.
  - left. exact (is_late_later bound pot _ tick (enter x) K I).
  - right. unfold has_label in H. apply existsb_exists in H as (entry & J & H).
    apply in_labels_by_resource in J. exists entry. split; auto. lia.
Qed.

Lemma label_step v r w : Visited v r w -> Stay_lawful i a v -> Followed v w ->
  late (visit_resource v) (enter v) = true \/
  (ends_in i a (visit_resource v) w true = false /\
   exists ready, ready <= enter v + least_stay a r /\ closed (visit_resource v) w ready = true).
Proof.
  intros (R & F & W & O & U) [_ D] [H|(entry & I & J)]; auto.
  pose proof (labels_ok _ I) as H. unfold label_accepted in H.
  destruct (late (visit_resource v) entry) eqn:L; [left; apply (is_late_later bound pot _ entry); auto; lia|].
  rewrite (find_own r (visit_resource v) R F) in H. rewrite forallb_forall in H. specialize (H w W).
  assert (K : lasts w (Some (entry + 1)) = true).
  { unfold lasts. destruct (closes w) as [last|]; auto. destruct (U last eq_refl) as (l & G & N).
    specialize (D r l R F G). pose proof (least_stay_is_positive i a well_formed of_instance r R). apply Z.leb_le.
    lia. }
  rewrite K in H. destruct (Z.leb_spec (opens w) entry); [|lia]. simpl in H.
  apply andb_true_iff in H as [H H']. apply negb_true_iff in H. right. split; auto.
  exists (entry + least_stay a r). split; auto. lia.
Qed.

(** The tick at which the last visit is entered. *)
Definition last_entry (v : visit) (later : list visit) : Z := fold_left (fun _ x => enter x) later (enter v).

Lemma end_is_late v w : Ends i a v -> Lies_in v w -> ends_in i a (visit_resource v) w true = false -> False.
Proof.
  intros [G H] [_ U] E. unfold ends_in in E. rewrite G, Z.eqb_refl in E. simpl in E.
  destruct (after_goal i); [discriminate|]. unfold lasts in E. destruct (closes w) as [last|]; [|discriminate].
  destruct (U last eq_refl) as (l & L & _). congruence.
Qed.

Lemma followed_to_the_end later : forall v r w b, visits p = b ++ v :: later -> Chain i a v later ->
  Visited v r w -> Followed v w -> Reaches bound (last_entry v later).
Proof.
  induction later as [|x rest IH]; intros v r w b E C V F.
  - destruct C as [S G]. destruct (label_step v r w V S F) as [L|[N _]].
    + apply late_at_goal. destruct G as [G _]. rewrite <- G. exact L.
    + destruct (end_is_late v w G (proj2 (proj2 (proj2 V))) N).
  - destruct C as (S & X & M & C).
    assert (K : Consecutive p v x) by (exists b, rest; exact E).
    assert (E' : visits p = (b ++ [v]) ++ x :: rest) by (rewrite <- app_assoc; exact E).
    assert (I : In x (visits p)) by (rewrite E'; apply in_or_app; right; left; auto).
    destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound x I)
      as (rx & wx & Q).
    assert (Sx : Stay_lawful i a x) by (destruct rest; apply C).
    pose proof V as (R & G & W & O).
    assert (D : enter v + least_stay a r <= enter x) by (destruct S as [_ D]; specialize (D r _ R G X); lia).
    apply (IH x rx wx (b ++ [v]) E' C Q).
    destruct (label_step v r w V S F) as [L|[_ (ready & T & H)]].
    + left. apply (late_after_move (visit_resource v) (visit_resource x) (enter v)); auto.
      rewrite <- G, least_ticks_of by exact R. exact D.
    + apply (closed_step (visit_resource v) w ready v x K eq_refl O X) with (r := rx); auto. lia.
Qed.

Lemma start_is_followed s current later :
  start_accepted i known (successors_of i) c a now bound label_map pot s = true ->
  visits p = past s ++ current :: later -> visit_resource current = place s -> enter current = since s ->
  No_earlier (leave current) now -> ready s = Z.max (since s + least_ticks known a (place s)) now ->
  Reaches bound (last_entry current later).
Proof.
  intros H E P T N Y.
  assert (I : In current (visits p)) by (rewrite E; apply in_or_app; right; left; auto).
  destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound current I)
    as (r & w & V).
  pose proof (is_lawful _ _ _ _ sound) as L. apply lawful_plan_is_a_chain in L as (u & rest & F & _ & _ & C).
  assert (K : Chain i a current later) by (apply (chain_behind i a (past s) u rest); [exact C | congruence]).
  clear u rest F C. unfold start_accepted in H. rewrite <- P, <- T in H.
  destruct (late (visit_resource current) (enter current)) eqn:A.
  - apply (followed_to_the_end later current r w (past s) E K V). left. exact A.
  - pose proof V as (R & G & W & O). pose proof O as [O1 O2].
    rewrite (find_own r (visit_resource current) R G) in H.
    rewrite forallb_forall in H. specialize (H w W). rewrite <- P, <- T, <- G, least_ticks_of in Y by exact R.
    assert (S : Stay_lawful i a current) by (destruct later; apply K).
    assert (B : forall l, leave current = Some l -> ready s <= l).
    { intros l M. rewrite M in N. simpl in N. destruct S as [_ D]. specialize (D r l R G M). lia. }
    replace (holds_stay w (enter current) (Some (ready s))) with true in H.
    + apply andb_true_iff in H as [H J]. apply negb_true_iff in H. destruct later as [|x rest].
      * destruct K as [_ Q]. exfalso. apply (end_is_late current w Q O). unfold ends_in in *.
        destruct (visit_resource current =? goal a); auto. simpl in *. destruct (after_goal i) eqn:Z; auto.
        destruct Q as [Q Q']. rewrite Z in Q'. rewrite (Q' r R (eq_trans G Q)) in N. simpl in N.
        destruct (Z.leb_spec now (enter current + last_stay a r)); [discriminate | lia].
      * destruct K as (_ & X & M & K).
        assert (E' : visits p = (past s ++ [current]) ++ x :: rest) by (rewrite <- app_assoc; exact E).
        assert (I' : In x (visits p)) by (rewrite E'; apply in_or_app; right; left; auto).
        destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound x I')
          as (rx & wx & Q).
        apply (followed_to_the_end rest x rx wx _ E' K Q).
        apply (closed_step (visit_resource current) w (ready s) current x) with (r := rx); auto.
        -- exists (past s), rest. exact E.
        -- destruct rest; apply K.
    + symmetry. unfold holds_stay, lasts. apply andb_true_iff. split; [apply Z.leb_le; lia|].
      destruct (closes w) as [last|]; auto. destruct (O2 last eq_refl) as (l & M & Q). specialize (B l M).
      apply Z.leb_le. lia.
Qed.
End Plan.
End Certificate.

Lemma standing_is_ready a now followed :
  let s := standing_of known a now followed in ready s = Z.max (since s + least_ticks known a (place s)) now.
Proof. unfold standing_of. cbv zeta. destruct (rev _); reflexivity. Qed.

(** A stay that ends earlier is allowed as well. *)
Lemma allows_shorter c vs v w : visit_resource w = visit_resource v -> enter w = enter v ->
  (forall x, lasts x (leave v) = true -> lasts x (leave w) = true) ->
  allows known c (vs ++ [v]) = true -> allows known c (vs ++ [w]) = true.
Proof.
  intros P T L. induction vs as [|u vs IH]; cbn [app allows].
  - rewrite P, T. destruct (Map.find (visit_resource v) (resource_of known)) as [r|]; auto.
    destruct (existsb (fun x => holds_stay x (enter v) (leave v)) (windows_in c r)) eqn:E; [|discriminate].
    intros _. replace (existsb (fun x => holds_stay x (enter v) (leave w)) (windows_in c r)) with true; auto.
    symmetry. apply existsb_exists in E as (x & X & E). apply existsb_exists. exists x. split; auto.
    unfold holds_stay in *. apply andb_true_iff in E as [E F]. rewrite E, (L x F). reflexivity.
  - destruct (Map.find (visit_resource u) (resource_of known)) as [r|]; auto.
    destruct (existsb (fun x => holds_stay x (enter u) (leave u)) (windows_in c r)); auto.
    destruct vs as [|x vs]; cbn [app] in *.
    + rewrite P, T. destruct (is_exchange known c (visit_resource u) (visit_resource v) (enter v)); auto.
    + destruct (is_exchange known c (visit_resource u) (visit_resource x) (enter x)); auto.
Qed.

(** What the robot has done does not collide with the committed plans if it has a sound plan. *)
Lemma start_is_allowed a committed c p s current later now :
  In a (robots i) -> Committed i a committed -> Represents i c committed -> Sound i a committed p ->
  visits p = past s ++ current :: later -> visit_resource current = place s -> enter current = since s ->
  No_earlier (leave current) now -> ready s = Z.max (since s + least_ticks known a (place s)) now ->
  allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))]) <> false.
Proof.
  intros A O R S V P T N Y. apply not_false_iff_true. apply (allows_shorter c (past s) current); auto.
  - intros x L. unfold lasts in *. simpl. destruct (closes x) as [last|]; auto.
    destruct (leave current) as [l|] eqn:M; [|discriminate]. apply Z.leb_le in L. apply Z.leb_le.
    pose proof (is_lawful _ _ _ _ S) as Q. simpl in N.
    assert (I : In current (visits p)) by (rewrite V; apply in_or_app; right; left; auto).
    pose proof (visits_resources _ _ _ Q current I) as K. apply in_map_iff in K as (r & E & K).
    pose proof (respects_durations _ _ _ Q current r l I K E M) as D.
    rewrite <- P, <- E, least_ticks_of in Y by exact K. lia.
  - apply (sound_visits_are_allowed i well_formed a committed c A O R p S). exists [], later.
    rewrite <- app_assoc. exact V.
Qed.

Lemma arrival_behind default b v later p : visits p = b ++ v :: later -> arrival default p = last_entry v later.
Proof. intros E. unfold arrival, last_entry. rewrite E, fold_left_app. reflexivity. Qed.

(** query/optimal and query/complete: no plan of the robot that breaks no rule, alone or together with the committed
    plans, and fits what it has done by now, arrives before the bound; without one there is no such plan. *)
Theorem accepted_query_is_optimal a committed c now followed cert p :
  In a (robots i) -> Committed i a committed -> Represents i c committed ->
  (forall before, followed = Some before -> plan_robot before = robot_id a /\ Plan_lawful i a before) ->
  certificate_accepted i (world_of i) c a now followed cert = true ->
  Sound i a committed p -> Fits_the_past followed p now ->
  Reaches (bound cert) (arrival (release a) p).
Proof.
  intros A O R B H S F. unfold certificate_accepted in H. cbv zeta in H.
  cbn [looked_up all_moves successors world_of] in H.
  assert (N : forall s, s = standing_of known a now followed ->
    (forall before, followed = Some before -> ~ Has_ended before now) ->
    (if allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))])
     then goal_is_0 a (index fst (potential cert))
       && forallb (move_is_consistent known a (index fst (potential cert))) (moves_of_graph i)
       && start_accepted i known (successors_of i) c a now (bound cert) (labels_by_resource (labels cert))
            (index fst (potential cert)) s
       && forallb (label_accepted i known (successors_of i) c a (bound cert) (labels_by_resource (labels cert))
            (index fst (potential cert))) (labels cert)
     else true) = true -> Reaches (bound cert) (arrival (release a) p)).
  - intros s E N K.
    destruct (plan_begins_with_the_past i a well_formed A followed p now) as (current & later & V & P & T & L).
    + intros before Q. split; [apply (B before Q) | apply N; exact Q].
    + exact (is_lawful _ _ _ _ S).
    + exact F.
    + rewrite <- E in V, P, T. rewrite (arrival_behind _ _ _ _ _ V).
      destruct (allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))])) eqn:G.
      * rewrite !andb_true_iff, !forallb_forall in K. destruct K as [[[K1 K2] K3] K4].
        apply (start_is_followed a committed c now (bound cert) (labels cert) (index fst (potential cert))
          A O R K1 K2 K4 p S s current later K3 V P T L).
        rewrite E. apply standing_is_ready.
      * destruct (start_is_allowed a committed c p s current later now A O R S V P T L); [|exact G].
        rewrite E. apply standing_is_ready.
  - destruct followed as [before|].
    + destruct (has_ended before now) eqn:E.
      * apply has_ended_iff in E. destruct (B before eq_refl) as [_ Q].
        pose proof (ended_plan_is_unchanged i a well_formed A before p now Q E F) as G.
        rewrite (sound_visits_are_allowed i well_formed a committed c A O R p S) in H.
        -- apply reaches_iff in H. unfold arrival in *. rewrite G. exact H.
        -- exists [], []. rewrite app_nil_r. exact G.
      * apply (N _ eq_refl); auto. intros b Q. injection Q as <-. rewrite <- has_ended_iff. congruence.
    + apply (N _ eq_refl); auto. discriminate.
Qed.
End Instance.
