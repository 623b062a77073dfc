(* Builds the formula of plans of some robots that cost less than a total, or keep deadlines, clause for clause as
   carp_verify.encoding does, with the meaning of each variable and the reason of each clause. Nothing here is trusted:
   the kernel checks every reason. *)

open Formula

(* The horizon of each robot, and the order of the robots' positions in which delays are added up. *)
type evidence = { horizons : int list; order : int list }

exception Too_large
exception No_way of Law.robot
exception Too_early of Law.robot * Z.t

(* The most clauses of a formula, and of all formulas of a bound together, as in carp_verify. *)
let most_clauses = 5_000_000

module Ticks = Set.Make (Z)

(* Clauses and variables in the order in which they were added, the last one first. *)
type draft = {
  most : int;
  mutable clauses : Z.t list list;
  mutable reasons : reason list;
  mutable count : int;
  mutable meanings : meaning Refutation.Numbered.t;
  mutable variables : int;
}

let require draft more = if draft.count + more > draft.most then raise Too_large

let add draft reason literals =
  require draft 1;
  draft.count <- draft.count + 1;
  draft.reasons <- reason :: draft.reasons;
  draft.clauses <- List.map Z.of_int literals :: draft.clauses

let variable draft meaning =
  draft.variables <- draft.variables + 1;
  draft.meanings <- Refutation.Numbered.add (Z.of_int draft.variables) meaning draft.meanings;
  draft.variables

(* ---- One robot ---- *)

(* The robot's horizon, its variables of nodes (resource, tick) and of costs, and the ticks of its nodes by resource. *)
type clerk = {
  robot : Law.robot;
  guide : guide;
  takes : Z.t -> Z.t;
  parks : bool;
  seen : Bound.sight option;
  onwards : Z.t -> Z.t list;
  backwards : Z.t -> Z.t list;
  node : (Z.t * Z.t, int) Hashtbl.t;
  mutable nodes : (Z.t * Z.t) list; (* the last one first *)
  ticks : (Z.t, Ticks.t) Hashtbl.t;
  late : (int, int) Hashtbl.t;
  mutable horizon : int;
  mutable unfinished : (Z.t * Z.t) list;
}

let rest clerk place = Collections.Map.find place clerk.guide.rests
let earliest clerk = Z.add clerk.robot.release clerk.guide.shortest
let least_delay clerk (place, tick) = Z.sub (Z.add tick (Option.get (rest clerk place))) (earliest clerk)
let later_than clerk delay = Hashtbl.find clerk.late (Z.to_int (Z.min delay (Z.of_int clerk.horizon)))
let drives_on clerk = clerk.parks || clerk.seen <> None
let stands_still clerk = Z.equal clerk.robot.start (Law.goal clerk.robot) && not (drives_on clerk)

(* The robot was seen before, and is not described. *)
let is_after clerk tick = match clerk.seen with Some sight -> Z.gt tick sight.seen_at | None -> false
let first_node clerk = (clerk.robot.start, Z.add clerk.robot.release (clerk.takes clerk.robot.start))

let leads_to clerk (place, tick) =
  let is_open target = rest clerk target <> None && (drives_on clerk || not (Z.equal target (Law.goal clerk.robot))) in
  let entered target = (target, Z.add tick (clerk.takes target)) in
  if is_after clerk tick then []
  else (place, Z.succ tick) :: List.map entered (List.filter is_open (clerk.onwards place))

let known_nodes clerk = List.filter_map (Hashtbl.find_opt clerk.node)

let ticks_in clerk place = Option.value ~default:Ticks.empty (Hashtbl.find_opt clerk.ticks place)

let add_variable_of_node draft clerk (place, tick) meaning =
  Hashtbl.add clerk.node (place, tick) (variable draft meaning);
  clerk.nodes <- (place, tick) :: clerk.nodes;
  Hashtbl.replace clerk.ticks place (Ticks.add tick (ticks_in clerk place))

(* Add the nodes whose least delay is the horizon, and give them in order. *)
let add_nodes draft clerk =
  let id = clerk.robot.robot_id and added = Queue.create () in
  let add_node ((place, tick) as node) =
    if not (Hashtbl.mem clerk.node node) then (
      add_variable_of_node draft clerk node (Free (id, place, tick));
      Queue.add node added)
  in
  let is_near node = Z.leq (least_delay clerk node) (Z.of_int clerk.horizon) in
  let add_following node = List.iter add_node (List.filter is_near (leads_to clerk node)) in
  let first = first_node clerk in
  if rest clerk clerk.robot.start <> None && Z.equal (least_delay clerk first) (Z.of_int clerk.horizon) then (
    add_node first;
    let at_goal = if Z.equal clerk.robot.start (Law.goal clerk.robot) then [ -Hashtbl.find clerk.late 0 ] else [] in
    add draft (Starts id) (at_goal @ [ Hashtbl.find clerk.node first ]));
  List.iter add_following clerk.unfinished;
  let rec follow done_ =
    match Queue.take_opt added with
    | None -> List.rev done_
    | Some node -> add_following node; follow (node :: done_)
  in
  follow []

let pass draft clerk ((place, tick) as node) =
  let delay = least_delay clerk node in
  if Z.sign delay > 0 then
    add draft
      (Passes (clerk.robot.robot_id, place, tick))
      [ -Hashtbl.find clerk.node node; Hashtbl.find clerk.late (Z.to_int delay - 1) ]

let come_from draft clerk ((place, tick) as node) =
  if node <> first_node clerk then
    let entered = Z.sub tick (clerk.takes place) in
    let sources = (place, Z.pred tick) :: List.map (fun source -> (source, entered)) (clerk.backwards place) in
    add draft
      (Waited_or_moved (clerk.robot.robot_id, place, tick))
      (-Hashtbl.find clerk.node node :: known_nodes clerk sources)

(* Whether all nodes that follow exist. *)
let go_on draft clerk ((place, tick) as node) =
  is_after clerk tick ||
  let following = leads_to clerk node in
  let ways = known_nodes clerk following in
  let complete = List.length ways = List.length following in
  let arrives = List.exists (Z.equal (Law.goal clerk.robot)) (clerk.onwards place) in
  let arrival = if arrives then [ -later_than clerk (Z.sub tick (earliest clerk)) ] else [] in
  let beyond = if complete then [] else [ Hashtbl.find clerk.late clerk.horizon ] in
  add draft
    (Waits_moves_or_arrives (clerk.robot.robot_id, place, tick))
    ((-Hashtbl.find clerk.node node :: ways) @ arrival @ beyond);
  complete

let arrive_at_horizon draft clerk =
  let cost = Z.add clerk.guide.shortest (Z.of_int clerk.horizon) in
  let tick = Z.add clerk.robot.release cost in
  if not (is_after clerk tick || (Z.equal clerk.robot.start (Law.goal clerk.robot) && clerk.horizon = 0)) then
    let earlier = if clerk.horizon > 0 then [ -Hashtbl.find clerk.late (clerk.horizon - 1) ] else [] in
    let sources = List.map (fun source -> (source, tick)) (clerk.backwards (Law.goal clerk.robot)) in
    let sources = known_nodes clerk sources in
    add draft (Arrives (clerk.robot.robot_id, cost)) (earlier @ (Hashtbl.find clerk.late clerk.horizon :: sources))

(* Raise the horizon by a tick of delay. *)
let grow draft clerk =
  let id = clerk.robot.robot_id in
  clerk.horizon <- clerk.horizon + 1;
  let cost = Z.add clerk.guide.shortest (Z.of_int clerk.horizon) in
  Hashtbl.add clerk.late clerk.horizon (variable draft (Costs (id, Z.succ cost)));
  if clerk.horizon > 0 then
    add draft (Costs_one_way (id, cost))
      [ -Hashtbl.find clerk.late clerk.horizon; Hashtbl.find clerk.late (clerk.horizon - 1) ];
  if stands_still clerk then (
    if clerk.horizon = 0 then (
      let first = first_node clerk in
      add_variable_of_node draft clerk first (Stands id);
      add draft Stands_there [ Hashtbl.find clerk.node first ];
      add draft (Starts id) [ -Hashtbl.find clerk.late 0 ]))
  else (
    let added = add_nodes draft clerk in
    List.iter (fun node -> pass draft clerk node; come_from draft clerk node) added;
    clerk.unfinished <- List.filter (fun node -> not (go_on draft clerk node)) (clerk.unfinished @ added);
    arrive_at_horizon draft clerk)

(* At most as many nodes as the robot has at a horizon: those that follow the first one in each resource, if the robot
   can be there before it was seen. *)
let nodes_within clerk horizon =
  let is_described place first =
    match clerk.seen with
    | Some sight when not (Z.equal place clerk.robot.start) -> Z.leq (Z.sub first (clerk.takes place)) sight.seen_at
    | _ -> true
  in
  let within place first =
    match rest clerk place with
    | Some _ when is_described place first ->
        Z.max Z.zero (Z.sub (Z.of_int (horizon + 1)) (least_delay clerk (place, first)))
    | _ -> Z.zero
  in
  if stands_still clerk then Z.zero
  else Collections.Map.fold (fun place first sum -> Z.add sum (within place first)) clerk.guide.firsts Z.zero

(* Refuse horizons whose nodes alone need too many clauses. *)
let require_nodes draft clerks horizons =
  let needed clerk horizon = Z.add (Z.of_int horizon) (nodes_within clerk horizon) in
  let all = List.fold_left2 (fun sum clerk horizon -> Z.add sum (needed clerk horizon)) Z.zero clerks horizons in
  if Z.gt all (Z.of_int draft.most) then raise Too_large

(* The nodes of a stay in the resource at the tick that is not the last one. *)
let nodes_of clerk place tick =
  let rec held ticks () =
    match ticks () with
    | Seq.Cons (each, later) when Z.leq each (Z.add tick (clerk.takes place)) ->
        Seq.Cons (Hashtbl.find clerk.node (place, each), held later)
    | _ -> Seq.Nil
  in
  held (Ticks.to_seq_from (Z.succ tick) (ticks_in clerk place))

(* The alternatives that put the robot into the resource at the tick: each is literals that hold together. *)
let stays clerk place tick =
  let duration = clerk.takes place in
  let nodes = Seq.map (fun node -> [ node ]) (nodes_of clerk place tick) in
  let delay = Z.sub tick (earliest clerk) in
  if is_after clerk tick then Seq.empty
  else if Z.equal place (Law.goal clerk.robot) && Z.sign delay >= 0 && not (stands_still clerk) then
    let left = Z.sub delay duration in
    if clerk.parks || Z.sign left < 0 then Seq.append nodes (Seq.return [ -later_than clerk delay ])
    else if Z.lt left (Z.of_int clerk.horizon) then
      Seq.append nodes (Seq.return [ -later_than clerk delay; later_than clerk left ])
    else nodes
  else nodes

(* ---- Sums of unary numbers: the range of the robots that are counted, and a literal for each least number ---- *)

type number = { first : Z.t; end_ : Z.t; least : int list }

let rec up_to most = function x :: rest when most > 0 -> x :: up_to (most - 1) rest | _ -> []

(* [meaning first end_ least] is that of a variable. *)
let sum draft reason meaning most left right =
  let lefts = Array.of_list left.least and rights = Array.of_list right.least in
  let wide = Array.length lefts + Array.length rights in
  require draft (Array.length lefts * Array.length rights);
  let first = left.first and end_ = right.end_ in
  let total = Array.init (min wide most) (fun k -> variable draft (meaning first end_ (Z.of_int (k + 1)))) in
  Array.iteri (fun k larger -> if k > 0 then add draft reason [ -larger; total.(k - 1) ]) total;
  for i = 0 to Array.length lefts do
    for j = 0 to Array.length rights do
      if i + j > 0 then
        let premise numbers k = if k > 0 then [ -numbers.(k - 1) ] else [] in
        add draft reason (premise lefts i @ premise rights j @ [ total.(min (i + j) most - 1) ])
    done
  done;
  { first; end_; least = Array.to_list total }

let at_least draft reason meaning addends most =
  let rec halve = function
    | left :: right :: rest -> let both = sum draft reason meaning most left right in both :: halve rest
    | rest -> rest
  in
  let rec all = function [] -> [] | [ number ] -> number.least | numbers -> all (halve numbers) in
  all (List.map (fun number -> { number with least = up_to most number.least }) addends)

(* ---- All robots ---- *)

let without_repetition items =
  let met = Hashtbl.create 1024 in
  let is_new item = if Hashtbl.mem met item then false else (Hashtbl.add met item (); true) in
  List.filter is_new items

(* What limits the robots: a resource by itself, or a group; at most this many may count in its places at a tick. *)
type constraint_ = { key : Z.t; places : Z.t list; most_inside : Z.t; is_resource : bool }

(* Robots by their positions, which are their seats; the constraints on a place, its own first; and for how many ticks
   a robot still counts that has left. *)
type encoding = {
  draft : draft;
  clerks : clerk array;
  presences : (int * Z.t * Z.t * int, int) Hashtbl.t;
  constraints_on : Z.t -> constraint_ list;
  longer : int;
}

let constraints_of (instance : Law.instance) =
  let table = Hashtbl.create 1024 in
  let on place = Option.value ~default:[] (Hashtbl.find_opt table place) in
  let enlist constraint_ =
    List.iter (fun place -> Hashtbl.replace table place (constraint_ :: on place)) constraint_.places
  in
  let constraint_ is_resource (key, (limit : Law.limit)) =
    { key; places = limit.limit_places; most_inside = limit.limit_capacity; is_resource }
  in
  List.iter (fun each -> enlist (constraint_ true each)) (Checker.resource_limits instance);
  List.iter (fun each -> enlist (constraint_ false each)) (Checker.group_limits instance.groups);
  fun place -> List.rev (on place)

let id_of { clerks; _ } position = clerks.(position).robot.robot_id

(* A literal that holds if the constraint counts the robot at the tick, if it can do so; the robot counts for [longer]
   ticks after it has left. *)
let presence ({ draft; clerks; presences; _ } as encoding) position { key; places; is_resource; _ } longer tick =
  let stays_in place back = List.of_seq (stays clerks.(position) place (Z.sub tick (Z.of_int back))) in
  let stays_at place = List.concat_map (stays_in place) (List.init (longer + 1) Fun.id) in
  match without_repetition (List.concat_map stays_at places) with
  | [] -> None
  | [ [ literal ] ] -> Some literal
  | alternatives -> (
      let name = (position, key, tick, longer) in
      match Hashtbl.find_opt presences name with
      | Some literal -> Some literal
      | None ->
          let id = id_of encoding position in
          let meaning, reason =
            match places with
            | [ place ] when is_resource && longer = 0 -> (Present (id, place, tick), Is_there (id, place, tick))
            | _ -> (Counted (id, key, tick), Is_counted (id, key, tick))
          in
          let literal = variable draft meaning in
          Hashtbl.add presences name literal;
          List.iter (fun stay -> add draft reason (List.map ( ~- ) stay @ [ literal ])) alternatives;
          Some literal)

let visitors { clerks; _ } places =
  let may_visit position place =
    Z.equal place (Law.goal clerks.(position).robot) || Hashtbl.mem clerks.(position).ticks place
  in
  List.filter (fun position -> List.exists (may_visit position) places) (List.init (Array.length clerks) Fun.id)

let forbid_crowd ({ draft; longer; _ } as encoding) ({ key; places; most_inside = capacity; _ } as constraint_, tick) =
  let present position =
    Option.map (fun literal -> (position, literal)) (presence encoding position constraint_ longer tick)
  in
  let literals = List.filter_map present (visitors encoding places) in
  if Z.equal capacity Z.one then
    let rec pairs before = function
      | [] -> ()
      | (position, literal) :: rest ->
          let pair (other, known) =
            add draft (Are_two (id_of encoding other, id_of encoding position, key, tick)) [ -known; -literal ]
          in
          List.iter pair (List.rev before);
          pairs ((position, literal) :: before) rest
    in
    pairs [] literals
  else if Z.gt (Z.of_int (List.length literals)) capacity then
    let one (position, literal) =
      { first = Z.of_int position; end_ = Z.of_int (position + 1); least = [ literal ] }
    in
    let meaning first end_ least = Crowded (first, end_, key, tick, least) in
    let counted = at_least draft (Adds_robots (key, tick)) meaning (List.map one literals) (Z.to_int capacity + 1) in
    add draft Is_full [ -List.nth counted (Z.to_int capacity) ]

(* Two moves that robots must not both make at the tick. *)
let forbid_exchange ({ draft; clerks; constraints_on; _ } as encoding) (source, target) (from, to_) tick =
  let moves source target position =
    match Hashtbl.find_opt clerks.(position).node (source, tick) with
    | None -> None
    | Some leaves ->
        let enters = presence encoding position (List.hd (constraints_on target)) 0 tick in
        Option.map (fun enters -> (position, [ leaves; enters ])) enters
  in
  let there = List.filter_map (moves source target) (visitors encoding [ source ]) in
  let back = List.filter_map (moves from to_) (visitors encoding [ from ]) in
  let clash (one, first) (other, second) =
    if one <> other then
      add draft
        (Exchange (id_of encoding one, id_of encoding other, source, target, from, to_, tick))
        (List.map ( ~- ) (first @ second))
  in
  List.iter (fun mover -> List.iter (clash mover) back) there

(* The resources and ticks at which the robot may enter, in the order of its nodes. *)
let entries clerk =
  let entered (place, tick) = (place, Z.sub tick (clerk.takes place)) in
  let arrival delay = (Law.goal clerk.robot, Z.add (earliest clerk) (Z.of_int delay)) in
  let arrivals = if stands_still clerk then [] else List.init (clerk.horizon + 1) arrival in
  List.rev_append (List.rev_map entered (List.rev clerk.nodes)) arrivals

let forbid_all ({ clerks; constraints_on; _ } as encoding) =
  let all = Array.to_list clerks in
  let entered (place, tick) = List.map (fun constraint_ -> (constraint_, tick)) (constraints_on place) in
  let crowds = without_repetition (List.concat_map entered (without_repetition (List.concat_map entries all))) in
  let movers = Hashtbl.create 1024 and moves = ref [] in
  let note position clerk (source, tick) =
    let try_move target =
      if stays clerk target tick () <> Seq.Nil then (
        let key = (tick, source, target) in
        if not (Hashtbl.mem movers key) then moves := key :: !moves;
        Hashtbl.replace movers key (position :: Option.value ~default:[] (Hashtbl.find_opt movers key)))
    in
    List.iter try_move (clerk.onwards source)
  in
  Array.iteri (fun position clerk -> List.iter (note position clerk) (List.rev clerk.nodes)) clerks;
  List.iter (forbid_crowd encoding) crowds;
  let areas place =
    let is_area { is_resource; most_inside; _ } = is_resource || Z.equal most_inside Z.one in
    List.map (fun { key; _ } -> key) (List.filter is_area (constraints_on place))
  in
  let crossed (tick, source, target) =
    List.concat_map (fun left -> List.map (fun entered -> (tick, left, entered)) (areas target)) (areas source)
  in
  let leading = Hashtbl.create 1024 in
  let known crossing = Option.value ~default:[] (Hashtbl.find_opt leading crossing) in
  let lead move = List.iter (fun crossing -> Hashtbl.replace leading crossing (move :: known crossing)) (crossed move) in
  List.iter lead (List.rev !moves);
  let exchange ((tick, source, target) as move) =
    let back = List.concat_map (fun crossing -> List.rev (known crossing)) (crossed (tick, target, source)) in
    let forbid ((_, from, to_) as other) =
      let movers = List.sort_uniq compare (Hashtbl.find movers move @ Hashtbl.find movers other) in
      let is_first = match Z.compare source from with 0 -> Z.lt target to_ | order -> order < 0 in
      if is_first && List.length movers > 1 then forbid_exchange encoding (source, target) (from, to_) tick
    in
    List.iter forbid (without_repetition back)
  in
  List.iter exchange (List.rev !moves)

let bound_delays { draft; clerks; _ } total order =
  let shortest = Array.fold_left (fun sum clerk -> Z.add sum clerk.guide.shortest) Z.zero clerks in
  let bound = Z.sub total shortest in
  if Z.sign bound <= 0 then add draft Is_cheaper []
  else
    let most = if Z.fits_int bound then Z.to_int bound else max_int in
    let late position =
      let { guide; late; horizon; _ } = clerks.(position) in
      { first = guide.rank; end_ = Z.succ guide.rank; least = List.init (horizon + 1) (Hashtbl.find late) }
    in
    let meaning first end_ least = Delayed (first, end_, least) in
    let delays = at_least draft Adds_delays meaning (List.map late order) most in
    if List.length delays >= most then add draft Is_cheaper [ -List.nth delays (most - 1) ]

(* ---- Deadlines ---- *)

(* The largest delay with which the robot keeps its deadline. *)
let horizon_by clerk (d : Bound.deadline) =
  let delay = Z.sub (Bound.last_arrival d) (earliest clerk) in
  let largest =
    match d.seen with
    | None -> if Z.sign delay < 0 then raise (Too_early (clerk.robot, earliest clerk)) else delay
    | Some { seen_at; spots } ->
        let spots = List.filter (fun place -> rest clerk place <> None) spots in
        let last place = least_delay clerk (place, Z.add seen_at (clerk.takes place)) in
        List.fold_left Z.max Z.zero (delay :: List.map last spots)
  in
  if Z.fits_int largest then Z.to_int largest else raise Too_large

let close draft clerk = add draft (Is_in_time clerk.robot.robot_id) [ -Hashtbl.find clerk.late clerk.horizon ]

(* Demand that the robot is in one of the spots when it is seen, or has arrived by its deadline; and in no other place
   where it is seen again later, as its clauses would let it be in two places. *)
let see draft clerk (d : Bound.deadline) =
  let look ({ seen_at; spots } : Bound.sight) =
    let nodes = List.concat_map (fun place -> List.of_seq (nodes_of clerk place seen_at)) spots in
    let delay = Z.sub (Bound.last_arrival d) (earliest clerk) in
    let arrived = if Z.sign delay < 0 then [] else [ -later_than clerk delay ] in
    let is_elsewhere (place, tick) =
      Z.lt seen_at tick && Z.leq tick (Z.add seen_at (clerk.takes place)) && not (List.exists (Z.equal place) spots)
    in
    let forbid ((place, tick) as node) =
      add draft (Is_seen_elsewhere (clerk.robot.robot_id, place, tick)) [ -Hashtbl.find clerk.node node ]
    in
    add draft (Is_seen clerk.robot.robot_id) (nodes @ arrived);
    match clerk.seen with
    | Some last when Z.lt seen_at last.seen_at -> List.iter forbid (List.filter is_elsewhere (List.rev clerk.nodes))
    | _ -> ()
  in
  Option.iter look d.seen

(* ---- Guides ---- *)

(* The least tick at which the robot is free to leave a resource from which it can get to its goal: Dijkstra. *)
let first_ticks (a : Law.robot) takes onwards is_open =
  let rec settle firsts queue =
    match Search.Queue.min_elt_opt queue with
    | None -> firsts
    | Some ((tick, place) as first) ->
        let queue = Search.Queue.remove first queue in
        if Collections.Map.mem place firsts then settle firsts queue
        else
          let enter queue s = if is_open s then Search.Queue.add (Z.add tick (takes s), s) queue else queue in
          settle (Collections.Map.add place tick firsts) (List.fold_left enter queue (onwards place))
  in
  settle Collections.Map.empty (Search.Queue.singleton (Z.add a.release (takes a.start), a.start))

let clerk_of (instance : Law.instance) table (onward, backward) ranks position (a : Law.robot) seen =
  let takes = Tables.takes_in table a and parks = instance.after_goal = Law.Park in
  let onwards place = List.sort Z.compare (Search.resources_to onward place) in
  let backwards place = List.sort Z.compare (Search.resources_to backward place) in
  let rests = Search.ticks_after takes backward (Law.goal a) in
  let is_open s = Hashtbl.mem rests s && (parks || seen <> None || not (Z.equal s (Law.goal a))) in
  let shortest =
    if Z.equal a.start (Law.goal a) then Z.zero
    else match Hashtbl.find_opt rests a.start with Some rest -> Z.add (takes a.start) rest | None -> raise (No_way a)
  in
  let guide =
    { rank = Z.of_int (Option.value ~default:0 (Hashtbl.find_opt ranks position)); seat = Z.of_int position; shortest;
      rests = Hashtbl.fold Collections.Map.add rests Collections.Map.empty;
      firsts = first_ticks a takes onwards is_open;
      leads = Search.way_on takes onward rests (Law.goal a) a.start }
  in
  { robot = a; guide; takes; parks; seen; onwards; backwards; node = Hashtbl.create 1024; nodes = [];
    ticks = Hashtbl.create 64; late = Hashtbl.create 64; horizon = -1; unfinished = [] }

(* The deadlines of the robot, the last one first. *)
let dues_of due (a : Law.robot) = List.filter (fun (d : Bound.deadline) -> Z.equal d.who a.robot_id) (List.rev due)

(* The blueprint and the number of its variables; deadlines need no horizons. Raises [No_way] where no way leads to a
   goal, [Too_early] if a robot cannot be at its goal so early, and [Too_large] beyond [most] clauses. *)
let blueprint (instance : Law.instance) group asked { horizons; order } most =
  let draft =
    { most; clauses = []; reasons = []; count = 0; meanings = Refutation.Numbered.empty; variables = 0 }
  in
  let table = Tables.resource_table instance and moves = Search.moves_of instance and ranks = Hashtbl.create 64 in
  List.iteri (fun rank position -> Hashtbl.replace ranks position rank) order;
  let sights =
    match asked with
    | In_time due -> List.map (fun a -> (List.hd (dues_of due a)).seen) group
    | _ -> List.map (fun _ -> None) group
  in
  let clerk position (a, seen) = clerk_of instance table moves ranks position a seen in
  let clerks = Array.of_list (List.mapi clerk (List.combine group sights)) in
  let grow_to clerk horizon = while clerk.horizon < horizon do grow draft clerk done in
  let all = Array.to_list clerks in
  let horizon_in due clerk = List.fold_left max 0 (List.map (horizon_by clerk) (dues_of due clerk.robot)) in
  let horizons = match asked with In_time due -> List.map (horizon_in due) all | _ -> horizons in
  require_nodes draft all horizons;
  List.iter2 grow_to all horizons;
  let constraints_on = constraints_of instance and longer = if instance.following_is_forbidden then 1 else 0 in
  let encoding = { draft; clerks; presences = Hashtbl.create 1024; constraints_on; longer } in
  forbid_all encoding;
  (match asked with
  | Lawful_plans -> ()
  | Cheaper_than total -> bound_delays encoding total order
  | In_time due ->
      let clerk_named id = List.find (fun clerk -> Z.equal clerk.robot.robot_id id) all in
      List.iter (close draft) all;
      List.iter (fun (d : Bound.deadline) -> see draft (clerk_named d.who) d) due);
  ( { guides = List.map (fun clerk -> clerk.guide) all; meanings = draft.meanings;
      reasons = List.rev draft.reasons; formula = List.rev draft.clauses },
    draft.variables )
