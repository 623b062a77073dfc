(** The law of carproof: the rules of spec/README.md, over all ticks, without a way to check them.

    Ticks and ids are whole numbers. Every interval is half-open: [enter, leave), and [None] as its end means for ever.
    The data may hold nonsense; [Well_formed] says which instances are right, [Lawful] which solutions. *)
Require Import ZArith List.
Import ListNotations.
Open Scope Z_scope.

(** * The model *)

(** A place that robots occupy: [capacity] robots fit in at a time, each needs [duration] ticks, times its pace. *)
Record resource := Resource { resource_id : Z; capacity : Z; duration : Z }.

(** Resources in which, all together, at most [group_capacity] robots fit at a time. *)
Record group := Group { group_id : Z; group_resources : list Z; group_capacity : Z }.

(** A place where a robot is served, for so many ticks at least, whatever its pace. *)
Record stop := Stop { stop_resource : Z; service : Z }.

(** A request: serve the stops in order, from [start], not before the tick [release]. *)
Record robot := Robot { robot_id : Z; start : Z; stops : list stop; release : Z; pace : Z }.

(** What robots do after their last stop: leave the system once it is served, or stay for ever. *)
Inductive after := Vanish | Park.

(** An edge is the move from its first resource to its second; in an undirected graph also the move back. *)
Record instance := Instance {
  resources : list resource;
  edges : list (Z * Z);
  directed : bool;
  groups : list group;
  after_goal : after;
  following_is_forbidden : bool;
  robots : list robot
}.

(** A stay in a resource from the tick [enter] up to, not including, the tick [leave]. *)
Record visit := Visit { visit_resource : Z; enter : Z; leave : option Z }.

(** A robot's visits in order. *)
Record plan := Plan { plan_robot : Z; visits : list visit }.

(** Plans, the order in which they were made, and the robots without one. *)
Record solution := Solution { plans : list plan; order : list Z; unplanned : list Z }.

Definition resource_ids (i : instance) : list Z := map resource_id (resources i).
Definition robot_ids (i : instance) : list Z := map robot_id (robots i).
Definition planned (s : solution) : list Z := map plan_robot (plans s).

(** The graph has the move from one resource to another. *)
Definition Move (i : instance) (source target : Z) : Prop :=
  In (source, target) (edges i) \/ directed i = false /\ In (target, source) (edges i).

(** The least ticks that the robot needs in the resource. *)
Definition least_stay (a : robot) (r : resource) : Z := pace a * duration r.

(** A goal is short for one stop without service. *)
Definition only (place : Z) : list stop := [Stop place 0].

(** The last stop, and its resource: the robot's goal. *)
Definition last_stop (a : robot) : stop := last (stops a) (Stop (start a) 0).
Definition goal (a : robot) : Z := stop_resource (last_stop a).

(** The ticks for which a robot that vanishes stays in the resource of its last stop. *)
Definition last_stay (a : robot) (r : resource) : Z := Z.max (least_stay a r) (service (last_stop a)).

(** A tick lies before an end. *)
Definition Before (tick : Z) (end_ : option Z) : Prop :=
  match end_ with Some l => tick < l | None => True end.

(** An end lies at a tick or later. *)
Definition No_earlier (end_ : option Z) (tick : Z) : Prop :=
  match end_ with Some l => tick <= l | None => True end.

(** The visit holds the tick. *)
Definition Holds (v : visit) (tick : Z) : Prop := enter v <= tick /\ Before tick (leave v).

(** The first visit is followed at once by the second. *)
Definition Consecutive (p : plan) (v w : visit) : Prop := exists before later, visits p = before ++ v :: w :: later.

(** * The rules of an instance *)

Record Well_formed (i : instance) : Prop := {
  (** instance/resource-id: no two resources have the same id. *)
  resource_ids_are_unique : NoDup (resource_ids i);
  (** instance/capacity: at least 1. *)
  capacities_are_positive : forall r, In r (resources i) -> 1 <= capacity r;
  (** instance/duration: at least 1. *)
  durations_are_positive : forall r, In r (resources i) -> 1 <= duration r;
  (** instance/edge: an edge joins two different resources of the graph ... *)
  edges_join_resources : forall r s, In (r, s) (edges i) -> r <> s /\ In r (resource_ids i) /\ In s (resource_ids i);
  (** ... and no edge is listed twice, in an undirected graph not in the other direction either. *)
  edges_are_unique : NoDup (edges i);
  edges_have_one_direction : directed i = false -> forall r s, In (r, s) (edges i) -> ~ In (s, r) (edges i);
  (** instance/group: no two groups have the same id, a group names at least one resource, each of the graph and each
      once, and its capacity is at least 1. *)
  group_ids_are_unique : NoDup (map group_id (groups i));
  groups_name_resources : forall g, In g (groups i) -> group_resources g <> [];
  groups_are_of_the_graph : forall g r, In g (groups i) -> In r (group_resources g) -> In r (resource_ids i);
  groups_name_resources_once : forall g, In g (groups i) -> NoDup (group_resources g);
  group_capacities_are_positive : forall g, In g (groups i) -> 1 <= group_capacity g;
  (** instance/robot-id: no two robots have the same id. *)
  robot_ids_are_unique : NoDup (robot_ids i);
  (** instance/endpoint: the start is a resource of the graph. *)
  starts_are_resources : forall a, In a (robots i) -> In (start a) (resource_ids i);
  (** instance/stops: there is at least one stop; each is at a resource of the graph, for at least 0 ticks ... *)
  robots_have_stops : forall a, In a (robots i) -> stops a <> [];
  stops_are_resources : forall a s, In a (robots i) -> In s (stops a) -> In (stop_resource s) (resource_ids i);
  services_are_ticks : forall a s, In a (robots i) -> In s (stops a) -> 0 <= service s;
  (** ... and at another resource than the stop before. *)
  neighbouring_stops_differ : forall a before s t later, In a (robots i) -> stops a = before ++ s :: t :: later ->
    stop_resource s <> stop_resource t;
  (** instance/release: a tick, at least 0. *)
  releases_are_ticks : forall a, In a (robots i) -> 0 <= release a;
  (** instance/pace: at least 1. *)
  paces_are_positive : forall a, In a (robots i) -> 1 <= pace a
}.

(** * The rules of one plan *)

(** plan/start: the first visit is to the robot's start and enters at its release tick. *)
Definition Starts_at_release (a : robot) (p : plan) : Prop :=
  exists first later, visits p = first :: later /\ visit_resource first = start a /\ enter first = release a.

(** A visit lasts at least so many ticks. *)
Definition Lasts (v : visit) (ticks : Z) : Prop := No_earlier (leave v) (enter v + ticks).

(** The visit serves the stop. *)
Definition Serves (v : visit) (s : stop) : Prop := visit_resource v = stop_resource s /\ Lasts v (service s).

(** plan/stops: one visit serves each stop, [visit_of], each later in the plan than the one before; the last visit
    serves the last stop. *)
Definition Serves_stops (ss : list stop) (vs : list visit) : Prop := exists visit_of : nat -> nat,
  (forall j k, (j < k < length ss)%nat -> (visit_of j < visit_of k)%nat) /\
  (forall j s, nth_error ss j = Some s -> exists v, nth_error vs (visit_of j) = Some v /\ Serves v s) /\
  (1 <= length ss)%nat /\ S (visit_of (length ss - 1)%nat) = length vs.

(** plan/goal: the last visit is to the resource of the last stop. With [Vanish] it is left exactly one duration (times
    the pace) after it was entered, or the last stop's service if that is longer; with [Park] it is never left. *)
Definition Ends_at_goal (i : instance) (a : robot) (p : plan) : Prop :=
  exists before last, visits p = before ++ [last] /\ visit_resource last = goal a /\
  match after_goal i with
  | Park => leave last = None
  | Vanish => forall r, In r (resources i) -> resource_id r = goal a -> leave last = Some (enter last + last_stay a r)
  end.

(** plan/resource: every visit is to a resource of the graph. *)
Definition Visits_resources (i : instance) (p : plan) : Prop :=
  forall v, In v (visits p) -> In (visit_resource v) (resource_ids i).

(** plan/move: consecutive visits (to resources of the graph) are joined by a move. *)
Definition Follows_moves (i : instance) (p : plan) : Prop :=
  forall v w, Consecutive p v w ->
  In (visit_resource v) (resource_ids i) -> In (visit_resource w) (resource_ids i) ->
  Move i (visit_resource v) (visit_resource w).

(** plan/contiguous: each visit enters at the tick at which the one before leaves. *)
Definition Is_contiguous (p : plan) : Prop := forall v w, Consecutive p v w -> leave v = Some (enter w).

(** plan/duration: a visit lasts at least the resource's duration times the robot's pace. *)
Definition Respects_durations (i : instance) (a : robot) (p : plan) : Prop :=
  forall v r l, In v (visits p) -> In r (resources i) -> resource_id r = visit_resource v -> leave v = Some l ->
  least_stay a r <= l - enter v.

(** All rules [plan/...] for a plan of the robot. *)
Record Plan_lawful (i : instance) (a : robot) (p : plan) : Prop := {
  starts_at_release : Starts_at_release a p;
  ends_at_goal : Ends_at_goal i a p;
  serves_stops : Serves_stops (stops a) (visits p);
  visits_resources : Visits_resources i p;
  follows_moves : Follows_moves i p;
  is_contiguous : Is_contiguous p;
  respects_durations : Respects_durations i a p
}.

(** All rules [plan/...] for every plan of a robot of the instance. *)
Definition Plans_lawful (i : instance) (ps : list plan) : Prop :=
  forall p a, In p ps -> In a (robots i) -> robot_id a = plan_robot p -> Plan_lawful i a p.

(** * The rules of plans together *)

(** A robot occupies a resource from the tick at which it enters up to, not including, the tick at which it leaves. *)
Definition Occupies (ps : list plan) (id place tick : Z) : Prop :=
  exists p v, In p ps /\ plan_robot p = id /\ In v (visits p) /\ visit_resource v = place /\ Holds v tick.

(** Resources that robots share: a resource by itself, or a group. *)
Record limit := Limit { limit_places : list Z; limit_capacity : Z }.

Definition limits (i : instance) : list limit :=
  map (fun r => Limit [resource_id r] (capacity r)) (resources i)
  ++ map (fun g => Limit (group_resources g) (group_capacity g)) (groups i).

(** joint/following: where following is forbidden, a robot that leaves at a tick still counts at that tick. *)
Definition gap (i : instance) : Z := if following_is_forbidden i then 1 else 0.

(** A robot counts at the ticks at which it occupies one of the resources, and for the gap after them. *)
Definition Counts (i : instance) (ps : list plan) (id : Z) (l : limit) (tick : Z) : Prop :=
  exists place back, In place (limit_places l) /\ 0 <= back <= gap i /\ Occupies ps id place (tick - back).

(** joint/capacity of a resource, joint/group of a group, and joint/following of both: at no tick do more robots count
    than the capacity. A robot counts once, also while it moves within a group. *)
Definition Limits_are_kept (i : instance) (ps : list plan) : Prop :=
  forall l tick ids, In l (limits i) -> NoDup ids ->
  (forall id, In id ids -> Counts i ps id l tick) -> Z.of_nat (length ids) <= limit_capacity l.

(** A robot makes the move (source, target) at the tick at which it leaves the source and enters the target. *)
Definition Makes_move (ps : list plan) (id source target tick : Z) : Prop :=
  exists p v w, In p ps /\ plan_robot p = id /\ Consecutive p v w /\
  visit_resource v = source /\ visit_resource w = target /\ enter w = tick.

(** Two resources are close if they are the same or lie in one group of capacity 1. *)
Definition Close (i : instance) (r s : Z) : Prop :=
  r = s \/ exists g, In g (groups i) /\ group_capacity g = 1 /\ In r (group_resources g) /\ In s (group_resources g).

(** joint/exchange: no two robots make moves (r, s) and (s', r') at the same tick where r is close to r' and s to s',
    whatever the capacities. *)
Definition Exchanges_are_avoided (i : instance) (ps : list plan) : Prop :=
  forall one other r s s' r' tick, one <> other ->
  In r (resource_ids i) -> In s (resource_ids i) -> In s' (resource_ids i) -> In r' (resource_ids i) ->
  Makes_move ps one r s tick -> Makes_move ps other s' r' tick -> Close i r r' -> Close i s s' -> False.

(** * The rules of a solution *)

(** solution/covers: each robot of the instance has exactly one plan or is listed once as unplanned, not both, and no
    robot that the instance does not have is named. *)
Definition Covers_robots (i : instance) (s : solution) : Prop :=
  NoDup (planned s ++ unplanned s) /\ forall id, In id (planned s ++ unplanned s) <-> In id (robot_ids i).

(** solution/order: the planning order names each robot that has a plan exactly once, and no other robot. *)
Definition Orders_plans (s : solution) : Prop := NoDup (order s) /\ forall id, In id (order s) <-> In id (planned s).

(** The law. *)
Record Lawful (i : instance) (s : solution) : Prop := {
  covers_robots : Covers_robots i s;
  orders_plans : Orders_plans s;
  plans_lawful : Plans_lawful i (plans s);
  limits_are_kept : Limits_are_kept i (plans s);
  exchanges_are_avoided : Exchanges_are_avoided i (plans s)
}.

(** * Cost *)

(** The tick at which a plan enters its last visit; [default] for a plan without visits. *)
Definition arrival (default : Z) (p : plan) : Z := fold_left (fun _ v => enter v) (visits p) default.

(** cost/robot: the tick at which a plan enters its last visit, minus the robot's release tick. *)
Definition cost (a : robot) (p : plan) : Z := arrival (release a) p - release a.

(** cost/total: the sum of the costs of the plans; a robot without a plan adds nothing. *)
Definition cost_of_plan (i : instance) (p : plan) : Z :=
  match find (fun a => robot_id a =? plan_robot p) (robots i) with Some a => cost a p | None => 0 end.
Definition total_cost (i : instance) (s : solution) : Z :=
  fold_left (fun total p => total + cost_of_plan i p) (plans s) 0.

(** * Robots under way *)

(** The visits that a plan has entered by the tick [now]. *)
Definition history (p : plan) (now : Z) : list visit := filter (fun v => enter v <=? now) (visits p).

(** A visit has ended by the tick [now]. *)
Definition Ended (v : visit) (now : Z) : Prop := exists l, leave v = Some l /\ l <= now.

(** The robot has left the system by the tick [now]. *)
Definition Has_ended (p : plan) (now : Z) : Prop :=
  exists before last, visits p = before ++ [last] /\ Ended last now.

(** fleet/history: a plan made at the tick [now] keeps every visit that the plan followed until then had entered: the
    last of them is entered at the same tick and left no earlier than now, those before it are unchanged. A plan whose
    last visit is left by now is unchanged. *)
Record Keeps_history (followed made : plan) (now : Z) : Prop := {
  keeps_visits : forall n v, nth_error (history followed now) n = Some v ->
    exists again, nth_error (visits made) n = Some again /\
    visit_resource again = visit_resource v /\ enter again = enter v /\
    (Ended v now -> leave again = leave v) /\ (~ Ended v now -> No_earlier (leave again) now);
  adds_nothing_after_the_end : Has_ended followed now -> (length (visits made) <= length (history followed now))%nat
}.

(** A robot without a plan has been standing at its start since its release: its plan leaves there no earlier than
    now. *)
Definition Stood_at_start (made : plan) (now : Z) : Prop :=
  forall first later, visits made = first :: later -> No_earlier (leave first) now.

(** What a robot has done until now restricts the plan made for it now. *)
Definition Fits_the_past (followed : option plan) (made : plan) (now : Z) : Prop :=
  match followed with Some before => Keeps_history before made now | None => Stood_at_start made now end.
