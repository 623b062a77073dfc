(** Certificates that no plan of a robot arrives earlier than a tick, or that it has none: carproof-query/1.

    A certificate has the tick [bound] before which no plan arrives ([None]: there is no plan at all), and labels and a
    potential for each number of stops that the robot can have served before the last one, of those left to it.

    - A label (resource, tick) stands for the free window of the resource that holds the tick: the robot may leave it no
      earlier than one duration after the tick. That is the entry; behind a stop that was served in the window, it is
      later by what the service takes longer than the duration. Windows are half-open, and no window is named: the tick
      does that.
    - The potential (resource, ticks) is a lower bound of the ticks from entering the resource to entering the goal.
      From a resource that is not listed the goal cannot be reached.

    It is accepted if the last potential is 0 at the goal, and each grows along no move backwards by more than the ticks
    that the robot needs in the resource that it leaves, and before a stop by no more than its service takes longer; if
    from the start, and from each label, every window that can be entered at a tick t with t + potential < bound has a
    label no later than t, and so has the window itself once the next stop is served in it; and if neither the start nor
    a label before the bound lets the robot end its plan. The start is not in the certificate: it is computed. The
    labels are the windows that A* has expanded before it found the plan, with their earliest entries. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops Collections Timeline Journey Checker Windows Context Past.
Import ListNotations.
Open Scope Z_scope.

Record layer := Layer { labels : list (Z * Z); potential : list (Z * Z) }.
Record certificate := Certificate { bound : option Z; layers : list layer }.

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

Definition labels_by_resource (l : list (Z * Z)) : Map.t (list Z) :=
  fold_left (fun m label => enlist (fst label) (snd label) m) l (Map.empty (list Z)).

(** A layer with its look-ups, and the stop that the robot serves next. *)
Record stage := Stage {
  next_stop : stop; label_list : list (Z * Z); label_map : Map.t (list Z); potential_of : Map.t (Z * Z)
}.
Definition stage_of (s : stop) (l : layer) : stage :=
  Stage s (labels l) (labels_by_resource (labels l)) (index fst (potential l)).

(** The stages before each of the stops that are left. *)
Definition stages_of (left : list stop) (ls : list layer) : list stage :=
  map (fun both => stage_of (fst both) (snd both)) (combine left ls).

Section Checker.
Variables (i : instance) (known : lookup) (all_moves : list (Z * Z)) (successors : Map.t (list Z)).
Variables (c : context) (a : robot) (now : Z) (bound : option Z).

(** The tick is not before the bound. *)
Definition reaches (tick : Z) : bool := match bound with Some t => t <=? tick | None => false end.

(** The ticks for which the robot stays in a resource in which it needs so many, to serve the stop. *)
Definition stay_for (s : stop) (ticks : Z) : Z := Z.max ticks (service s).

Section Stage.
(** A stage, and those behind it. *)
Variables (g : stage) (behind : list stage).

(** A robot that enters the resource at the tick enters the goal no earlier than the bound. *)
Definition is_late (id tick : Z) : bool :=
  match Map.find id (potential_of g) with Some (_, ticks) => reaches (tick + ticks) | None => true end.

Definition goal_is_0 : bool :=
  match Map.find (stop_resource (next_stop g)) (potential_of g) with Some (_, ticks) => ticks =? 0 | None => false end.

Definition move_is_consistent (move : Z * Z) : bool :=
  match Map.find (snd move) (potential_of g), Map.find (fst move) (potential_of g) with
  | None, _ => true
  | Some _, None => false
  | Some (_, behind), Some (_, ticks) => ticks <=? least_ticks known a (fst move) + behind
  end.

Definition stop_is_consistent (h : stage) : bool :=
  let id := stop_resource (next_stop g) in
  let least := least_ticks known a id in
  match Map.find id (potential_of h), Map.find id (potential_of g) with
  | None, _ => true
  | Some _, None => false
  | Some (_, behind), Some (_, ticks) => ticks <=? stay_for (next_stop g) least - least + behind
  end.

Definition potential_accepted : bool :=
  match behind with [] => goal_is_0 | h :: _ => stop_is_consistent h end && forallb move_is_consistent all_moves.

(** A label of the window no later than the tick. *)
Definition has_label (id : Z) (w : window) (tick : Z) : bool :=
  existsb (fun entry => (opens w <=? entry) && (entry <=? tick)) (listed (label_map g) id).

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
Definition ends_in (r : resource) (w : window) (entry : Z) (may_vanish : bool) : bool :=
  (resource_id r =? stop_resource (next_stop g)) &&
  match after_goal i with
  | Park => lasts w None
  | Vanish => may_vanish && lasts w (Some (entry + stay_for (next_stop g) (least_stay a r)))
  end.
End Stage.

(** Once the next stop is served in the window of the resource, if it can be, there is a label behind it. *)
Definition serving_is_closed (g h : stage) (r : resource) (w : window) (entry ready : Z) : bool :=
  let served := Z.max ready (entry + stay_for (next_stop g) (least_stay a r)) in
  if (resource_id r =? stop_resource (next_stop g)) && lasts w (Some served) then
    is_late h (resource_id r) (served - least_stay a r) || has_label h (resource_id r) w (served - least_stay a r)
  else true.

(** All that can follow is labelled if the robot enters the window at [entry] and may leave it at [ready]. *)
Definition place_accepted (g : stage) (behind : list stage) (r : resource) (w : window) (entry ready : Z)
  (may_vanish : bool) : bool :=
  match behind with
  | [] => negb (ends_in g r w entry may_vanish)
  | h :: _ => serving_is_closed g h r w entry ready
  end
  && is_closed g (resource_id r) w ready.

Definition label_accepted (g : stage) (behind : list stage) (label : Z * Z) : bool :=
  let (id, entry) := label in
  if is_late g id entry then true
  else match Map.find id (resource_of known) with
  | None => true
  | Some r =>
    forallb (fun w =>
      if (opens w <=? entry) && lasts w (Some (entry + 1))
      then place_accepted g behind r w entry (entry + least_stay a r) true else true) (windows_in c r)
  end.

Definition start_accepted (g : stage) (behind : list stage) (s : standing) : bool :=
  if is_late g (place s) (since s) then true
  else match Map.find (place s) (resource_of known) with
  | None => true
  | Some r =>
    forallb (fun w =>
      if holds_stay w (since s) (Some (ready s))
      then place_accepted g behind r w (since s) (ready s) (now <=? since s + last_stay a r)
      else true) (windows_in c r)
  end.

Fixpoint stages_accepted (gs : list stage) : bool :=
  match gs with
  | [] => true
  | g :: behind =>
    potential_accepted g behind && forallb (label_accepted g behind) (label_list g) && stages_accepted behind
  end.
End Checker.

(** What does not depend on the robot: the moves of the graph, and look-ups. *)
Record world := World { looked_up : lookup; all_moves : list (Z * Z); successors : Map.t (list Z) }.
Definition world_of (i : instance) : world := World (lookup_of i) (moves_of_graph i) (successors_of i).

(** The stops that what the robot has done has left to it; the visit that it is in does not count yet. *)
Definition stops_left (a : robot) (s : standing) : list stop := fold_left next_stops (past s) (stops a).

(** The certificate of a robot with what it has done, if that leaves it a plan. *)
Definition search_accepted (i : instance) (g : world) (c : context) (a : robot) (now : Z) (s : standing)
  (cert : certificate) : bool :=
  let known := looked_up g in
  if allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))]) then
    let left := stops_left a s in
    let stages := stages_of left (layers cert) in
    (length (layers cert) =? length left)%nat
    && match stages with
       | [] => false
       | first :: behind => start_accepted i known (successors g) c a now (bound cert) first behind s
       end
    && stages_accepted i known (all_moves g) (successors g) c a (bound cert) stages
  else true.

(** The certificate of a robot that is planned at the tick [now] against the plans of the context, and has followed
    a plan until then, or none. A robot whose plan has ended keeps it. *)
Definition certificate_accepted (i : instance) (g : world) (c : context) (a : robot) (now : Z) (followed : option plan)
  (cert : certificate) : bool :=
  let known := looked_up g in
  let search := search_accepted i g c a now (standing_of known a now followed) cert in
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
| Number_of_layers (stops_left : nat)     (** there must be labels and a potential before each stop that is left *)
| Goal_potential                          (** the last potential of the goal must be 0 *)
| Stop_potential (id : Z)                 (** before the stop in this resource the potential is too high *)
| Move_potential (source target : Z)      (** along this move the potential falls by more than the robot needs *)
| Open_start                              (** from the start a window without a label, or the end, is in reach *)
| Open_label (id entry : Z).              (** the same from this label *)

Section Fault.
Variables (i : instance) (g : world) (c : context) (a : robot) (bound : option Z).
Local Notation known := (looked_up g).

Fixpoint potential_fault (gs : list stage) : option fault :=
  match gs with
  | [] => None
  | first :: behind =>
    if potential_accepted known (all_moves g) a first behind then potential_fault behind
    else match find (fun move => negb (move_is_consistent known a first move)) (all_moves g), behind with
    | Some (source, target), _ => Some (Move_potential source target)
    | None, [] => Some Goal_potential
    | None, _ => Some (Stop_potential (stop_resource (next_stop first)))
    end
  end.

Fixpoint label_fault (gs : list stage) : option fault :=
  match gs with
  | [] => None
  | first :: behind =>
    match find (fun l => negb (label_accepted i known (successors g) c a bound first behind l)) (label_list first) with
    | Some (id, entry) => Some (Open_label id entry)
    | None => label_fault behind
    end
  end.
End Fault.

Definition certificate_fault (i : instance) (g : world) (c : context) (a : robot) (now : Z) (followed : option plan)
  (cert : certificate) : option fault :=
  let left := stops_left a (standing_of (looked_up g) a now followed) in
  let stages := stages_of left (layers cert) in
  let search :=
    if negb (length (layers cert) =? length left)%nat then Number_of_layers (length left)
    else match potential_fault g a stages, label_fault i g c a (bound cert) stages with
    | Some potential, _ => potential
    | None, Some label => label
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

Lemma is_late_later bound g id tick later : tick <= later ->
  is_late bound g id tick = true -> is_late bound g id later = true.
Proof.
  unfold is_late. destruct (Map.find id (potential_of g)) as [[x ticks]|]; auto. rewrite !reaches_iff.
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
Hypothesis of_instance : In a (robots i).
Hypothesis others : Committed i a committed.
Hypothesis represents : Represents i c committed.

Local Notation late := (is_late bound).
Local Notation closed := (is_closed known (successors_of i) c a bound).

(** The stage and those behind it are accepted, and made of layers. *)
Record Accepted (g : stage) (behind : list stage) : Prop := {
  has_potential : potential_accepted known (moves_of_graph i) a g behind = true;
  has_labels : forall label, In label (label_list g) ->
    label_accepted i known (successors_of i) c a bound g behind label = true;
  is_looked_up : label_map g = labels_by_resource (label_list g)
}.

Lemma late_at_goal g tick : Accepted g [] -> late g (stop_resource (next_stop g)) tick = true <-> Reaches bound tick.
Proof.
  intros [P _ _]. unfold potential_accepted, goal_is_0 in P. apply andb_true_iff in P as [G _]. unfold is_late.
  destruct (Map.find (stop_resource (next_stop g)) (potential_of g)) as [[x t]|]; [|discriminate].
  apply Z.eqb_eq in G. subst t. rewrite reaches_iff, Z.add_0_r. tauto.
Qed.

Lemma late_after_move g behind r s tick later : Accepted g behind -> Move i r s ->
  tick + least_ticks known a r <= later -> late g r tick = true -> late g s later = true.
Proof.
  intros [P _ _] M T L. unfold potential_accepted in P. apply andb_true_iff in P as [_ P]. rewrite forallb_forall in P.
  apply in_moves_of_graph in M. specialize (P _ M).
  unfold move_is_consistent in P. simpl in P. unfold is_late in *.
  destruct (Map.find s (potential_of g)) as [[y behind_]|]; auto.
  destruct (Map.find r (potential_of g)) as [[x ticks]|]; [|discriminate].
  rewrite reaches_iff in *. unfold Reaches in *. destruct bound; auto. lia.
Qed.

Lemma late_after_stop g h behind tick : Accepted g (h :: behind) ->
  let id := stop_resource (next_stop g) in let least := least_ticks known a id in
  late g id tick = true -> late h id (tick + stay_for (next_stop g) least - least) = true.
Proof.
  cbv zeta. intros [P _ _] L. unfold potential_accepted in P. apply andb_true_iff in P as [P _].
  unfold stop_is_consistent in P. cbv zeta in P. unfold is_late in *.
  destruct (Map.find (stop_resource (next_stop g)) (potential_of h)) as [[y behind_]|]; auto.
  destruct (Map.find (stop_resource (next_stop g)) (potential_of g)) as [[x ticks]|]; [|discriminate].
  rewrite reaches_iff in *. unfold Reaches in *. destruct bound; auto. lia.
Qed.

(** A plan has been followed as far as the window of the visit, which it may leave one duration after the tick at the
    earliest: it is late, or a label of the window is no later. *)
Definition Followed (g : stage) (v : visit) (w : window) (tick : Z) : Prop :=
  late g (visit_resource v) tick = true \/
  exists entry, In (visit_resource v, entry) (label_list g) /\ opens w <= entry <= tick.

Lemma label_is_listed g behind id w tick : Accepted g behind -> has_label g id w tick = true ->
  exists entry, In (id, entry) (label_list g) /\ opens w <= entry <= tick.
Proof.
  intros A H. unfold has_label in H. rewrite (is_looked_up _ _ A) in H. apply existsb_exists in H as (entry & J & H).
  apply in_labels_by_resource in J. exists entry. split; auto. lia.
Qed.

(** The property of every stage together with those behind it. *)
Fixpoint Forall_stages (P : stage -> list stage -> Prop) (gs : list stage) : Prop :=
  match gs with [] => True | g :: behind => P g behind /\ Forall_stages P behind end.

(** The tick at which the last visit is entered. *)
Definition last_entry (v : visit) (later : list visit) : Z := fold_left (fun _ x => enter x) later (enter v).

Section Plan.
Variable p : plan.
Hypothesis sound : Sound i a committed p.

(** The window of a visit. *)
Definition Visited (v : visit) (r : resource) (w : window) : Prop :=
  In r (resources i) /\ resource_id r = visit_resource v /\ In w (windows_in c r) /\ Lies_in v w.

Lemma closed_step g behind w ready v x : Accepted g behind -> Consecutive p v x -> Lies_in v w ->
  leave v = Some (enter x) -> ready <= enter x -> Move i (visit_resource v) (visit_resource x) -> Stay_lawful i a x ->
  closed g (visit_resource v) w ready = true -> forall r wx, Visited x r wx -> Followed g x wx (enter x).
Proof.
  intros Ac C L X T M [_ D] H r wx (R & F & W & O & U). unfold is_closed in H. cbv zeta in H.
  rewrite forallb_forall in H.
  apply in_successors in M. specialize (H _ M). unfold move_is_closed in H.
  rewrite (find_own r (visit_resource x) R F) in H. rewrite forallb_forall in H. specialize (H wx W). cbv zeta in H.
  set (tick := wait_for_room known c (visit_resource v) (visit_resource x)
    (stays_before_exchanges known c (visit_resource v)) (Z.max ready (opens wx))) in H.
  assert (T' : Z.max ready (opens wx) <= tick) by apply wait_for_room_waits.
  assert (K : tick <= enter x).
  { apply wait_for_room_is_least; [lia|].
    apply (sound_move_is_free i well_formed a committed c others represents p sound). exact C. }
  assert (A : forall t, t <= enter x -> lasts w (Some t) = true).
  { intros t Q. destruct L as [_ L]. unfold lasts. destruct (closes w) as [last|]; auto.
    destruct (L last eq_refl) as (l & G & N). rewrite X in G. injection G as <-. apply Z.leb_le. lia. }
  assert (B : forall t, t <= enter x -> lasts wx (Some (t + least_stay a r)) = true).
  { intros t Q. unfold lasts. destruct (closes wx) as [last|]; auto.
    destruct (U last eq_refl) as (l & G & N). specialize (D r l R F G). apply Z.leb_le. lia. }
  rewrite (A (opens wx)), (B (Z.max ready (opens wx))), (A tick), (B tick) in H by lia. simpl in H.
  destruct (late g (visit_resource x) tick) eqn:I; simpl in H.
  - left. exact (is_late_later bound g _ tick (enter x) K I).
  - right. destruct (label_is_listed g behind _ _ _ Ac H) as (entry & J & E). exists entry. split; auto. lia.
Qed.

(** From where the plan has been followed to, all that follows is labelled. *)
Lemma label_step g behind v r w tick : Accepted g behind -> Visited v r w -> Stay_lawful i a v -> Followed g v w tick ->
  No_earlier (leave v) (tick + least_stay a r) ->
  late g (visit_resource v) tick = true \/
  exists entry, entry <= tick /\
    place_accepted i known (successors_of i) c a bound g behind r w entry (entry + least_stay a r) true = true.
Proof.
  intros Ac (R & F & W & O & U) [_ D] [H|(entry & I & J)] N; auto.
  pose proof (has_labels _ _ Ac _ I) as H. unfold label_accepted in H.
  destruct (late g (visit_resource v) entry) eqn:L; [left; apply (is_late_later bound g _ entry); auto; lia|].
  rewrite (find_own r (visit_resource v) R F) in H. rewrite forallb_forall in H. specialize (H w W).
  assert (K : lasts w (Some (entry + 1)) = true).
  { unfold lasts. destruct (closes w) as [last|]; auto. destruct (U last eq_refl) as (l & G & M).
    rewrite G in N. simpl in N. pose proof (least_stay_is_positive i a well_formed of_instance r R). apply Z.leb_le.
    lia. }
  rewrite K in H. destruct (Z.leb_spec (opens w) entry); [|lia]. simpl in H. right. exists entry. split; [lia | exact H].
Qed.

(** The plan goes on to the next visit. *)
Lemma leaving_step g behind v x r w tick : Accepted g behind -> Consecutive p v x -> Visited v r w ->
  leave v = Some (enter x) -> Move i (visit_resource v) (visit_resource x) -> Stay_lawful i a v -> Stay_lawful i a x ->
  tick + least_stay a r <= enter x -> Followed g v w tick ->
  forall rx wx, Visited x rx wx -> Followed g x wx (enter x).
Proof.
  intros Ac C V X M Sv Sx T F rx wx Q. pose proof V as (R & G & W & O).
  assert (N : No_earlier (leave v) (tick + least_stay a r)) by (rewrite X; exact T).
  destruct (label_step g behind v r w tick Ac V Sv F N) as [L|(entry & E & H)].
  - left. apply (late_after_move g behind (visit_resource v) (visit_resource x) tick); auto.
    rewrite <- G, least_ticks_of by exact R. exact T.
  - unfold place_accepted in H. apply andb_true_iff in H as [_ H]. rewrite G in H.
    apply (closed_step g behind w (entry + least_stay a r) v x Ac C O X) with (r := rx); auto. lia.
Qed.

(** The stay of a visit that serves a stop. *)
Lemma serving_takes v r l s : In r (resources i) -> resource_id r = visit_resource v -> Stay_lawful i a v ->
  Serves v s -> leave v = Some l -> enter v + stay_for s (least_stay a r) <= l.
Proof.
  intros R G [_ D] [_ S] L. specialize (D r l R G L). unfold Lasts, stay_for in *. rewrite L in S. simpl in S. lia.
Qed.

Lemma lies_long_enough v w l tick : Lies_in v w -> leave v = Some l -> tick <= l -> lasts w (Some tick) = true.
Proof.
  intros [_ U] L T. unfold lasts. destruct (closes w) as [last|]; auto. destruct (U last eq_refl) as (x & X & Y).
  apply Z.leb_le. assert (x = l) by congruence. lia.
Qed.

(** In the window, the plan serves a stop that is not the last. *)
Lemma served_place g h behind v r w entry ready l : Accepted h behind -> Visited v r w -> Stay_lawful i a v ->
  Serves v (next_stop g) -> leave v = Some l -> entry <= enter v -> ready <= l ->
  serving_is_closed a bound g h r w entry ready = true ->
  Followed h v w (Z.max ready (entry + stay_for (next_stop g) (least_stay a r)) - least_stay a r).
Proof.
  intros Ac (R & G & W & O) S Y L E N H. unfold serving_is_closed in H. cbv zeta in H.
  pose proof (serving_takes v r l (next_stop g) R G S Y L) as K.
  rewrite (proj2 (Z.eqb_eq _ _)) in H by (rewrite G; apply Y).
  rewrite (lies_long_enough v w l) in H by (auto; lia). simpl in H. rewrite G in H.
  apply orb_true_iff in H as [H|H]; [left; exact H|]. right. exact (label_is_listed h behind _ _ _ Ac H).
Qed.

Lemma serving_step g h behind v r w l : Accepted g (h :: behind) -> Accepted h behind -> Visited v r w ->
  Stay_lawful i a v -> Serves v (next_stop g) -> leave v = Some l -> Followed g v w (enter v) ->
  Followed h v w (enter v + stay_for (next_stop g) (least_stay a r) - least_stay a r).
Proof.
  intros Ag Ah V S Y L F. pose proof V as (R & G & W & O).
  assert (N : No_earlier (leave v) (enter v + least_stay a r)).
  { rewrite L. destruct S as [_ D]. specialize (D r l R G L). simpl. lia. }
  destruct (label_step g (h :: behind) v r w (enter v) Ag V S F N) as [K|(entry & E & H)].
  - left. destruct Y as [P _]. rewrite P in *.
    pose proof (late_after_stop g h behind (enter v) Ag K) as H. rewrite <- G, least_ticks_of in H by exact R.
    rewrite <- G. exact H.
  - unfold place_accepted in H. apply andb_true_iff in H as [H _]. rewrite L in N. simpl in N.
    destruct (served_place g h behind v r w entry (entry + least_stay a r) l Ah V S Y L E ltac:(lia) H)
      as [K|(e & I & J)].
    + left. apply (is_late_later bound h _ _ _) with (2 := K). unfold stay_for in *. lia.
    + right. exists e. split; auto. unfold stay_for in *. lia.
Qed.

(** The plan cannot end where no label lets it. *)
Lemma end_is_late g v r w entry may_vanish : Visited v r w -> Stay_lawful i a v -> Ends i a v ->
  Serves v (next_stop g) -> entry <= enter v -> (after_goal i = Vanish -> may_vanish = true) ->
  ends_in i a g r w entry may_vanish = false -> False.
Proof.
  intros (R & G & _ & O) S [_ H] Y E M N. unfold ends_in in N.
  rewrite (proj2 (Z.eqb_eq _ _)) in N by (rewrite G; apply Y). simpl in N.
  destruct (after_goal i).
  - rewrite M in N by reflexivity. simpl in N. destruct (leave v) as [l|] eqn:L.
    + pose proof (serving_takes v r l (next_stop g) R G S Y L) as K.
      rewrite (lies_long_enough v w l) in N by (auto; lia). discriminate.
    + pose proof (goal_is_a_resource i a well_formed of_instance) as K. apply in_map_iff in K as (q & Q & K).
      specialize (H q K Q). discriminate.
  - destruct O as [_ U]. unfold lasts in N. destruct (closes w) as [last|]; [|discriminate].
    destruct (U last eq_refl) as (l & L & _). congruence.
Qed.

Lemma followed_to_the_end later : forall v r w b g behind, visits p = b ++ v :: later -> Chain i a v later ->
  Visited v r w -> Forall_stages Accepted (g :: behind) -> Served (map next_stop (g :: behind)) v later ->
  Followed g v w (enter v) -> Reaches bound (last_entry v later).
Proof.
  induction later as [|x rest IH]; intros v r w b g behind E C V Ac Y F.
  - destruct C as [S G]. destruct Y as (s & Y & Z0). simpl in Y. injection Y as <- B.
    apply map_eq_nil in B. subst behind. destruct Ac as [Ac _].
    pose proof V as (R & Q & W & O).
    destruct (late g (visit_resource v) (enter v)) eqn:L.
    { apply (late_at_goal g _ Ac). destruct Z0 as [<- _]. exact L. }
    exfalso. assert (N : No_earlier (leave v) (enter v + least_stay a r)).
    { destruct S as [_ D]. destruct (leave v) as [l|]; simpl; auto. specialize (D r l R Q eq_refl). lia. }
    destruct (label_step g [] v r w (enter v) Ac V S F N) as [K|(entry & K & H)]; [congruence|].
    unfold place_accepted in H. apply andb_true_iff in H as [H _]. apply negb_true_iff in H.
    exact (end_is_late g v r w entry true V S G Z0 K (fun _ => eq_refl) H).
  - destruct C as (S & X & M & C).
    assert (K : Consecutive p v x) by (exists b, rest; exact E).
    assert (E' : visits p = (b ++ [v]) ++ x :: rest) by (rewrite <- app_assoc; exact E).
    assert (I : In x (visits p)) by (rewrite E'; apply in_or_app; right; left; auto).
    destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound x I)
      as (rx & wx & Q).
    assert (Sx : Stay_lawful i a x) by (destruct rest; apply C).
    pose proof V as (R & G & W & O). destruct Ac as [Ag Ac].
    assert (D : enter v + least_stay a r <= enter x) by (destruct S as [_ D]; specialize (D r _ R G X); lia).
    destruct Y as [Y|(s & ss & Y & Z0 & T)].
    + apply (IH x rx wx (b ++ [v]) g behind E' C Q (conj Ag Ac) Y).
      exact (leaving_step g behind v x r w (enter v) Ag K V X M S Sx D F rx wx Q).
    + simpl in Y. injection Y as <- <-. destruct behind as [|h behind]; [destruct (served_has_stops rest x T)|].
      destruct Ac as [Ah Ac].
      apply (IH x rx wx (b ++ [v]) h behind E' C Q (conj Ah Ac) T).
      pose proof (serving_step g h behind v r w _ Ag Ah V S Z0 X F) as J.
      refine (leaving_step h behind v x r w _ Ah K V X M S Sx _ J rx wx Q).
      pose proof (serving_takes v r _ (next_stop g) R G S Z0 X). lia.
Qed.

Lemma start_is_followed s current later g behind :
  start_accepted i known (successors_of i) c a now bound g behind s = true ->
  visits p = past s ++ current :: later -> visit_resource current = place s -> enter current = since s ->
  No_earlier (leave current) now -> ready s = Z.max (since s + least_ticks known a (place s)) now ->
  Forall_stages Accepted (g :: behind) -> Served (map next_stop (g :: behind)) current later ->
  Reaches bound (last_entry current later).
Proof.
  intros H E P T N Y Ac Sv.
  assert (I : In current (visits p)) by (rewrite E; apply in_or_app; right; left; auto).
  destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound current I)
    as (r & w & V).
  pose proof (is_lawful _ _ _ _ sound) as L. apply lawful_plan_is_a_chain in L as (u & rest & F & _ & _ & C).
  assert (K : Chain i a current later) by (apply (chain_behind i a (past s) u rest); [exact C | congruence]).
  clear u rest F C. unfold start_accepted in H. rewrite <- P, <- T in H.
  destruct (late g (visit_resource current) (enter current)) eqn:A.
  { apply (followed_to_the_end later current r w (past s) g behind E K V Ac Sv). left. exact A. }
  pose proof V as (R & G & W & O). pose proof O as [O1 O2].
  rewrite (find_own r (visit_resource current) R G) in H.
  rewrite forallb_forall in H. specialize (H w W). rewrite <- P, <- T, <- G, least_ticks_of in Y by exact R.
  assert (S : Stay_lawful i a current) by (destruct later; apply K).
  assert (B : forall l, leave current = Some l -> ready s <= l).
  { intros l M. rewrite M in N. simpl in N. destruct S as [_ D]. specialize (D r l R G M). lia. }
  replace (holds_stay w (enter current) (Some (ready s))) with true in H.
  2:{ symmetry. unfold holds_stay, lasts. apply andb_true_iff. split; [apply Z.leb_le; lia|].
      destruct (closes w) as [last|]; auto. destruct (O2 last eq_refl) as (l & M & Q). specialize (B l M).
      apply Z.leb_le. lia. }
  unfold place_accepted in H. apply andb_true_iff in H as [H J]. destruct later as [|x rest].
  - destruct K as [_ Q]. destruct Sv as (s0 & Sv & Z0). simpl in Sv. injection Sv as <- Bh.
    apply map_eq_nil in Bh. subst behind. apply negb_true_iff in H. exfalso.
    apply (end_is_late g current r w (enter current) _ V S Q Z0 (Z.le_refl _)) with (2 := H). intros X.
    destruct Q as [Q Q']. rewrite X in Q'. rewrite (Q' r R (eq_trans G Q)) in N. simpl in N. apply Z.leb_le. exact N.
  - destruct K as (_ & X & M & K).
    assert (E' : visits p = (past s ++ [current]) ++ x :: rest) by (rewrite <- app_assoc; exact E).
    assert (I' : In x (visits p)) by (rewrite E'; apply in_or_app; right; left; auto).
    destruct (sound_visit_is_free i well_formed a committed c of_instance others represents p sound x I')
      as (rx & wx & Q).
    assert (Co : Consecutive p current x) by (exists (past s), rest; exact E).
    assert (Sx : Stay_lawful i a x) by (destruct rest; apply K).
    destruct Ac as [Ag Ac]. destruct Sv as [Sv|(s0 & ss & Sv & Z0 & Sv')].
    + apply (followed_to_the_end rest x rx wx _ g behind E' K Q (conj Ag Ac) Sv). rewrite G in J.
      apply (closed_step g behind w (ready s) current x) with (r := rx); auto.
    + simpl in Sv. injection Sv as <- <-. destruct behind as [|h behind]; [destruct (served_has_stops rest x Sv')|].
      destruct Ac as [Ah Ac].
      apply (followed_to_the_end rest x rx wx _ h behind E' K Q (conj Ah Ac) Sv').
      pose proof (served_place g h behind current r w (enter current) (ready s) _ Ah V S Z0 X (Z.le_refl _) (B _ X) H)
        as F.
      refine (leaving_step h behind current x r w _ Ah Co V X M S Sx _ F rx wx Q).
      pose proof (serving_takes current r _ (next_stop g) R G S Z0 X). specialize (B _ X). lia.
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

Lemma stages_of_stops left ls : length ls = length left -> map next_stop (stages_of left ls) = left.
Proof.
  revert ls. induction left as [|s left IH]; intros [|l ls] L; simpl in *; try discriminate; auto.
  f_equal. apply IH. lia.
Qed.

Lemma stages_are_looked_up left ls g : In g (stages_of left ls) -> label_map g = labels_by_resource (label_list g).
Proof. intros H. apply in_map_iff in H as ([s l] & <- & _). reflexivity. Qed.

Lemma stages_are_accepted a c bound gs :
  stages_accepted i known (moves_of_graph i) (successors_of i) c a bound gs = true ->
  (forall g, In g gs -> label_map g = labels_by_resource (label_list g)) -> Forall_stages (Accepted a c bound) gs.
Proof.
  induction gs as [|g behind IH]; cbn [stages_accepted Forall_stages]; auto.
  rewrite !andb_true_iff, forallb_forall. intros [[P L] S] M. split.
  - split; auto. apply M. left. reflexivity.
  - apply IH; auto. intros h H. apply M. right. exact H.
Qed.

(** query/optimal and query/complete: no plan of the robot that breaks no rule, alone or together with the committed
    plans, and fits what it has done by now, arrives before the bound; without one there is no such plan. *)
Theorem accepted_query_is_optimal a committed c now followed cert p :
  In a (robots i) -> Committed i a committed -> Represents i c committed ->
  (forall before, followed = Some before -> plan_robot before = robot_id a /\ Plan_lawful i a before) ->
  certificate_accepted i (world_of i) c a now followed cert = true ->
  Sound i a committed p -> Fits_the_past followed p now ->
  Reaches (bound cert) (arrival (release a) p).
Proof.
  intros A O R B H S F. unfold certificate_accepted in H. cbv zeta in H. cbn [looked_up world_of] in H.
  assert (N : forall s, s = standing_of known a now followed ->
    (forall before, followed = Some before -> ~ Has_ended before now) ->
    search_accepted i (world_of i) c a now s cert = true -> Reaches (bound cert) (arrival (release a) p)).
  - intros s E N K.
    destruct (plan_begins_with_the_past i a well_formed A followed p now) as (current & later & V & P & T & L).
    + intros before Q. split; [apply (B before Q) | apply N; exact Q].
    + exact (is_lawful _ _ _ _ S).
    + exact F.
    + rewrite <- E in V, P, T. rewrite (arrival_behind _ _ _ _ _ V). unfold search_accepted in K. cbv zeta in K.
      cbn [looked_up all_moves successors world_of] in K.
      destruct (allows known c (past s ++ [Visit (place s) (since s) (Some (ready s))])) eqn:G.
      * rewrite !andb_true_iff, Nat.eqb_eq in K. destruct K as [[K1 K2] K3].
        pose proof (stages_are_accepted a c (bound cert) _ K3 (stages_are_looked_up _ _)) as Q.
        pose proof (stages_of_stops _ _ K1) as M.
        pose proof (serves_stops _ _ _ (is_lawful _ _ _ _ S)) as Y. rewrite V in Y.
        apply stops_served_so_far_count, served_iff in Y. fold (stops_left a s) in Y. rewrite <- M in Y.
        destruct (stages_of (stops_left a s) (layers cert)) as [|g behind]; [discriminate|].
        apply (start_is_followed a committed c now (bound cert) A O R p S s current later g behind K2 V P T L); auto.
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
