(* The questions that the kernel decides, each with its verdict. *)

(* Accepted, refused by a rule, or undecided, each with what else is to be said in JSON. *)
type verdict =
  | Accepted of (string * Yojson.Safe.t) list
  | Refused of string * string
  | Undecided of string

let whole n : Yojson.Safe.t = `Intlit (Z.to_string n)

let named (read : Reading.instance) robot = Reading.shown (Reading.names read.robot_numbers).(Z.to_int robot)

(* ---- check ---- *)

(* The rule of a plan that is broken first; what is accepted is decided by the kernel alone. *)
let broken_plan_rule instance known (a : Law.robot) (p : Law.plan) =
  let rec chain = function
    | [] -> "plan/goal"
    | (v : Law.visit) :: later -> (
        if Collections.Map.find v.visit_resource known.Checker.resource_of = None then "plan/resource"
        else if not (Checker.stay_accepted known a v) then "plan/duration"
        else
          match later with
          | w :: _ when not (Checker.same_end v.leave (Some w.enter)) -> "plan/contiguous"
          | w :: _ when Collections.Map.find w.visit_resource known.Checker.resource_of <> None
                        && not (Checker.has_move known v.visit_resource w.visit_resource) -> "plan/move"
          | _ -> chain later)
  in
  match p.visits with
  | v :: later when Z.equal v.visit_resource a.start && Z.equal v.enter a.release ->
      if Checker.chain_accepted instance known a v later then "plan/stops" else chain p.visits
  | _ -> "plan/start"

let cost_of (read : Reading.instance) (solution : Law.solution) =
  [ ("cost", whole (Checker.solution_cost read.instance solution));
    ("unplanned", `Int (List.length solution.unplanned)) ]

(* Why a solution is refused; that it is, the kernel has decided. *)
let solution_fault (read : Reading.instance) (solution : Law.solution) =
  let instance = read.instance in
  let known = Checker.lookup_of instance in
  let robot_of (p : Law.plan) = Collections.Map.find p.plan_robot known.robot_of in
  let broken p = not (Checker.plan_of_robot_accepted instance known p) in
  if not (Checker.covers_accepted instance solution) then
    Some ("solution/covers", "each robot must have one plan or be unplanned once")
  else if not (Checker.order_accepted solution) then
    Some ("solution/order", "the order must name each robot that has a plan once")
  else
    match List.find_opt broken solution.plans with
    | Some p ->
        let rule = match robot_of p with Some a -> broken_plan_rule instance known a p | None -> "solution/covers" in
        Some (rule, "the plan of robot " ^ named read p.plan_robot)
    | None ->
        let kept longer limits = Checker.limits_accepted known longer limits solution.plans in
        let of_resources = Checker.resource_limits instance and of_groups = Checker.group_limits instance.groups in
        if not (kept Z.zero of_resources) then
          Some ("joint/capacity", "more robots occupy a resource than its capacity")
        else if not (kept Z.zero of_groups) then
          Some ("joint/group", "more robots are in the resources of a group than its capacity")
        else if not (Checker.exchanges_accepted known solution.plans) then
          Some ("joint/exchange", "two robots exchange two resources, or resources close to them")
        else if not (kept known.counts_longer (of_resources @ of_groups)) then
          Some ("joint/following", "a robot enters a resource or a group too soon after another")
        else None

let refused_for = function
  | Some (rule, message) -> Refused (rule, message)
  | None -> Undecided "the kernel accepts each part and not the whole"

let check (read : Reading.instance) (solution : Law.solution) =
  if Checker.solution_accepted read.instance solution then Accepted (cost_of read solution)
  else refused_for (solution_fault read solution)

(* ---- verify-query and audit ---- *)

(* carp_verify's limit of what a certificate makes it look at. The kernel looks at more: it goes through the stays of a
   resource for each of them, and through the labels of a window's resource. *)
let most_looks = 50_000_000
let most_work = 20_000_000_000

module Ticks = Set.Make (Z)

(* What carp_verify would look at for the certificates, and what the kernel would. *)
let looks_and_work (read : Reading.instance) plans (queries : Reading.query list) =
  let onwards, _ = Search.moves_of read.instance in
  let moves = Hashtbl.fold (fun _ targets total -> total + List.length targets) onwards 0 in
  let count table key = Option.value ~default:0 (Hashtbl.find_opt table key) in
  let increase table key = Hashtbl.replace table key (count table key + 1) in
  let stays = Hashtbl.create 1024 and changes = Hashtbl.create 1024 in
  let known = Checker.lookup_of read.instance in
  let keys = Checker.keys_at known in
  let change key tick =
    let before = Option.value ~default:(Ticks.singleton Z.zero) (Hashtbl.find_opt changes key) in
    Hashtbl.replace changes key (Ticks.add tick before)
  in
  let rec visit = function
    | [] -> ()
    | (v : Law.visit) :: later ->
        let next = match later with w :: _ -> keys w.Law.visit_resource | [] -> [] in
        let stay key =
          increase stays key;
          change key v.enter;
          let longer = if List.mem key next then Z.zero else known.counts_longer in
          Option.iter (fun leave -> change key (Z.add leave longer)) v.leave
        in
        List.iter stay (keys v.visit_resource);
        visit later
  in
  List.iter (fun (p : Law.plan) -> visit p.visits) plans;
  let sizes = Hashtbl.create 1024 in
  Hashtbl.iter (fun key ticks -> Hashtbl.replace sizes key (Ticks.cardinal ticks)) changes;
  let sum f keys = List.fold_left (fun total key -> total + f key) 0 keys in
  let size place = sum (fun key -> max 1 (count sizes key)) (keys place) in
  let stays_around place = sum (count stays) (keys place) in
  let is_resource place = Z.lt place (Z.of_int (List.length read.instance.resources)) in
  let of_query (looks, work) (query : Reading.query) =
    let labels = Hashtbl.create 1024 in
    let layers = query.query_certificate.layers in
    let label (place, _) = increase labels place in
    List.iter (fun (layer : QueryCertificate.layer) -> List.iter label layer.labels) layers;
    let looks = looks + (List.length layers * (List.length read.instance.resources + moves)) in
    let work = work + (List.length layers * List.length read.instance.edges * 2) in
    let of_place place number (looks, work) =
      if not (is_resource place) then (looks + number, work)
      else
        let target (looks, work) s =
          (looks + size place + size s, work + size place + (size s * (count labels s + stays_around place + 1)))
        in
        let one_looks, one_work = List.fold_left target (1 + size place, 1) (Search.resources_to onwards place) in
        (looks + (number * one_looks), work + (number * one_work))
    in
    Hashtbl.fold of_place labels (looks, work)
  in
  (* Each stay in a limit has the windows of all its resources computed again. *)
  let renewed key = sum size (Context.places_of known key) in
  let squares = Hashtbl.fold (fun key number total -> total + (number * (number + renewed key))) stays 0 in
  List.fold_left of_query (0, squares) queries

let too_much = Undecided (Printf.sprintf "the kernel would look at more than %d stays and labels" most_work)

let int_of_nat number =
  let rec count sum = function Datatypes.O -> sum | S less -> count (sum + 1) less in
  count 0 number

(* Why a certificate is refused; that it is, the kernel has decided. *)
let query_fault (read : Reading.instance) (solution : Law.solution) (query : Reading.query) =
  let instance = read.instance and { Reading.query_robot = robot; now; query_certificate } = query in
  let world = QueryCertificate.world_of instance in
  let place id = Reading.shown (Reading.names read.resource_numbers).(Z.to_int id) in
  match Collections.Map.find robot world.looked_up.robot_of with
  | None -> ("query-certificate/robot", "the instance must have the robot " ^ named read robot)
  | Some a -> (
      let context = Context.context_of world.looked_up (Audit.others solution robot) in
      let followed = Audit.own solution robot in
      match QueryCertificate.certificate_fault instance world context a now followed query_certificate with
      | Some (QueryCertificate.Earlier_arrival tick) ->
          ("query-certificate/bound", "the robot's plan has ended, and arrived at " ^ Z.to_string tick)
      | Some (Number_of_layers number) ->
          ( "query-certificate/stops",
            Printf.sprintf "there must be labels and potentials before each of %d stops left" (int_of_nat number) )
      | Some Goal_potential -> ("query-certificate/potential", "the potential of the goal must be 0")
      | Some (Stop_potential id) ->
          ( "query-certificate/potential",
            Printf.sprintf "the potential falls by too much where the stop in %s is served" (place id) )
      | Some (Move_potential (source, target)) ->
          ( "query-certificate/potential",
            Printf.sprintf "the potential falls by too much on the move from %s to %s" (place source) (place target) )
      | Some (Open_label (id, entry)) ->
          ( "query-certificate/closed",
            Printf.sprintf "%s, entered at %s, leads to a window without a label or to the end" (place id)
              (Z.to_string entry) )
      | Some Open_start | None ->
          ("query-certificate/closed", "the start leads to a window without a label or to the end"))

let verify_query (read : Reading.instance) (solution : Law.solution) (query : Reading.query) =
  let { Reading.query_robot; now; query_certificate } = query in
  let looks, work = looks_and_work read (Audit.others solution query_robot) [ query ] in
  if looks > most_looks then
    Refused ("query-certificate/size", Printf.sprintf "there would be %d windows and moves to look at" looks)
  else if work > most_work then too_much
  else if Audit.query_accepted read.instance solution query_robot now query_certificate then
    Accepted [ ("bound", Option.fold ~none:`Null ~some:whole query_certificate.bound) ]
  else if not (Audit.plans_accepted read.instance (Checker.lookup_of read.instance) solution.plans) then
    Refused ("query-certificate/plans", "each plan must be lawful by itself, and of a robot of its own")
  else
    let rule, message = query_fault read solution query in
    Refused (rule, message)

let audit (read : Reading.instance) (solution : Law.solution) (queries : Reading.query list) =
  let certificate (query : Reading.query) = (query.query_robot, query.query_certificate) in
  let certificates = List.map certificate queries in
  let _, work = looks_and_work read solution.plans queries in
  if work > most_work then too_much
  else if Audit.audit_accepted read.instance solution certificates then Accepted (cost_of read solution)
  else
    match solution_fault read solution with
    | Some fault -> refused_for (Some fault)
    | None ->
        let uncertified robot = ("query/optimal", "the plan of robot " ^ named read robot ^ " is not certified") in
        refused_for (Option.map uncertified (Audit.audit read.instance solution certificates))

(* ---- refute ---- *)

let most_literals = 50_000_000

(* As carp_verify counts them: the literals that the hints of a refutation look at, and those of its clauses. *)
let literals_looked_at formula lines =
  let lengths = Hashtbl.create 1024 in
  List.iteri (fun before clause -> Hashtbl.replace lengths (Z.of_int (before + 1)) (List.length clause)) formula;
  let length hint = Option.value ~default:0 (Hashtbl.find_opt lengths hint) in
  let look sum line =
    match Refutation.read_step line with
    | Some (Refutation.Add (number, added, hints)) ->
        let sum = List.fold_left (fun sum hint -> sum + length hint) (sum + List.length added) hints in
        Hashtbl.replace lengths number (List.length added);
        sum
    | Some (Delete _) | None -> sum
  in
  List.fold_left look 0 lines

let no_refutation = Refused ("refutation", "the refutation does not derive the empty clause by its hints")

(* Why a refutation is not checked. *)
let too_long formula lines =
  let size = literals_looked_at formula lines in
  if size <= most_literals then None
  else Some (Refused ("refutation", Printf.sprintf "its hints look at %d literals, more than %d" size most_literals))

let refute formula proof =
  match too_long formula proof with
  | Some verdict -> verdict
  | None -> if Refutation.refutes formula proof then Accepted [] else no_refutation

(* ---- verify-proof ---- *)

(* The formula of plans of the robots that do what is demanded, with the number of its variables, or why none is made. *)
let blueprint (read : Reading.instance) group asked evidence most =
  match Encoder.blueprint read.instance group asked evidence most with
  | made -> Ok made
  | exception Encoder.No_way a ->
      Error (Refused ("proof/way", "no way leads to the goal of robot " ^ named read a.robot_id))
  | exception Encoder.Too_early (a, earliest) ->
      let robot = named read a.robot_id and tick = Z.to_string earliest in
      Error (Refused ("bound/deadline", Printf.sprintf "robot %s can be at its goal at %s, not earlier" robot tick))

let blueprint_of_claim (read : Reading.instance) ({ cost; evidence } : Reading.claim) =
  let asked = Formula.demand_of cost in
  Reading.require_goals read;
  try blueprint read read.instance.robots asked evidence Encoder.most_clauses
  with Encoder.Too_large ->
    Error (Undecided (Printf.sprintf "the formula would have more than %d clauses, the limit" Encoder.most_clauses))

let verify_proof (read : Reading.instance) (claim : Reading.claim) proof =
  match blueprint_of_claim read claim with
  | Error verdict -> verdict
  | Ok (blueprint, _) -> (
      match too_long blueprint.formula proof with
      | Some verdict -> verdict
      | None ->
          if Formula.claim_proved read.instance claim.cost blueprint proof then
            Accepted [ ("bound", Option.fold ~none:`Null ~some:whole claim.cost) ]
          else
            let asked = Formula.demand_of claim.cost in
            if Formula.blueprint_accepted read.instance read.instance.robots asked blueprint then no_refutation
            else Undecided "the kernel has made a clause for which it has no reason")

(* ---- verify-bound ---- *)

(* Why a group's proof is refused; a formula that would be too large is so for all groups together. *)
let in_proof rule group number = function
  | Refused ("bound/size", _) as verdict -> verdict
  | Refused (_, why) -> Refused (rule, Printf.sprintf "the proof of %s %d does not hold: %s" group number why)
  | other -> other

let in_proof_of_cut = in_proof "bound/cut" "cut"
let in_proof_of_deadlines = in_proof "bound/deadline" "deadlines"

(* The formula of a group and its refutation, which is not checked yet; [left] clauses are left to all formulas. *)
let proof_of_group read left group asked evidence refutation =
  match (Reading.proof_of_text refutation, blueprint read group asked evidence !left) with
  | exception Reading.Refused { rule; message; _ } -> Error (Refused (rule, message))
  | exception Encoder.Too_large ->
      let most = Encoder.most_clauses in
      Error (Refused ("bound/size", Printf.sprintf "the formulas of all groups would have more than %d clauses" most))
  | _, Error verdict -> Error verdict
  | lines, Ok (blueprint, _) ->
      left := !left - List.length blueprint.formula;
      Option.fold ~none:(Ok (blueprint, lines)) ~some:Result.error (too_long blueprint.formula lines)

let proof_of_cut (read : Reading.instance) left (k : Bound.cut) (horizons, order, refutation) =
  let group = Formula.group_of read.instance k.members in
  let is_horizon n = Z.sign n >= 0 && Z.leq n k.least_total && Z.fits_int n in
  if List.length group <> List.length k.members || List.length horizons <> List.length group
     || not (List.for_all is_horizon horizons)
     || List.sort Z.compare order <> List.init (List.length group) Z.of_int then
    Error
      (Refused ("bound/cut", "it must have a horizon of each robot, no more than its least total, and an order of them"))
  else
    let evidence = { Encoder.horizons = List.map Z.to_int horizons; order = List.map Z.to_int order } in
    proof_of_group read left group (Formula.Cheaper_than k.least_total) evidence refutation

(* The robot has no right tick, or place, for being seen. *)
let is_never (read : Reading.instance) (d : Bound.deadline) =
  let table = Tables.resource_table read.instance in
  let is_unknown place = not (Collections.Map.mem place table) in
  match d.seen with
  | Some { seen_at; spots } -> Z.sign d.due < 0 || Z.sign seen_at < 0 || List.exists is_unknown spots
  | None -> false

(* Each robot is named once, or again where it is seen later. *)
let are_named_rightly deadlines =
  let named = Hashtbl.create 16 in
  let is_right (d : Bound.deadline) =
    let tick = Option.map (fun (s : Bound.sight) -> s.seen_at) d.seen in
    let before = Hashtbl.find_opt named d.who in
    Hashtbl.replace named d.who tick;
    match (before, tick) with None, _ -> true | Some (Some earlier), Some later -> Z.lt earlier later | _ -> false
  in
  List.for_all is_right deadlines

(* Being seen in a place is checked tick by tick of the robot's stay there, and for each literal of them. *)
let longest_sight = Z.of_int 1_000_000_000

let is_long (read : Reading.instance) group (d : Bound.deadline) =
  let table = Tables.resource_table read.instance in
  let robot = List.find (fun (a : Law.robot) -> Z.equal a.robot_id d.who) group in
  let squared place = let ticks = Tables.takes_in table robot place in Z.mul ticks ticks in
  let spots = Option.fold ~none:[] ~some:(fun (s : Bound.sight) -> s.spots) d.seen in
  Z.gt (List.fold_left (fun sum place -> Z.add sum (squared place)) Z.zero spots) longest_sight

let proof_of_deadlines (read : Reading.instance) left (g : Bound.group) refutation =
  let ids = Formula.once [] (List.map (fun (d : Bound.deadline) -> d.who) g.deadlines) in
  let group = Formula.group_of read.instance ids in
  if group = [] || List.length group <> List.length ids || not (are_named_rightly g.deadlines) then
    Error (Refused ("bound/deadline", "it must name robots of the instance, each once, or again where it is seen later"))
  else if List.exists (is_never read) g.deadlines then
    Error (Refused ("bound/deadline", "a robot must be seen at a tick of at least 0, in resources of the graph"))
  else
    match proof_of_group read left group (Formula.In_time g.deadlines) { horizons = []; order = [] } refutation with
    | Ok _ when List.exists (is_long read group) g.deadlines ->
        Error (Undecided "a robot is seen in a place where it takes too many ticks for the kernel")
    | made -> made

(* A group without a proof that can be checked. *)
exception Unproved of verdict

(* The proofs of all claims, made when they are asked for. *)
let proofs_of (read : Reading.instance) { Reading.certificate; of_cuts; of_deadlines; _ } =
  let left = ref Encoder.most_clauses in
  let made proof_of in_proof number claimed proof () =
    match proof_of read left claimed proof with
    | Ok made -> made
    | Error verdict -> raise (Unproved (in_proof number verdict))
  in
  let all proof_of in_proof claims proofs =
    List.mapi (fun number (claim, proof) -> made proof_of in_proof number claim proof) (List.combine claims proofs)
  in
  ( all proof_of_cut in_proof_of_cut certificate.Bound.cuts of_cuts,
    all proof_of_deadlines in_proof_of_deadlines certificate.groups of_deadlines )

(* The number of the first claim that its proof does not refute. *)
let first_unrefuted refuted claims proofs =
  let is_unrefuted (_, (claim, proof)) = let blueprint, lines = proof () in not (refuted claim blueprint lines) in
  let numbered = List.mapi (fun number each -> (number, each)) (List.combine claims proofs) in
  Option.map fst (List.find_opt is_unrefuted numbered)

(* Why the groups of a bound are not refuted, if they are not. *)
let group_fault (read : Reading.instance) (bound : Reading.bound) =
  let instance = read.instance and { Bound.cuts; groups; _ } = bound.certificate in
  let of_cuts, of_deadlines = proofs_of read bound in
  match first_unrefuted (Formula.cut_refuted instance) cuts of_cuts with
  | Some number -> Some (in_proof_of_cut number no_refutation)
  | None ->
      let number = first_unrefuted (Formula.deadlines_refuted instance) groups of_deadlines in
      Option.map (fun number -> in_proof_of_deadlines number no_refutation) number

(* Each robot is looked for in all cuts and deadlines, and each deadline beside all others. *)
let most_pairs = 10_000_000_000

let pairs_of (read : Reading.instance) { Bound.cuts; groups; _ } =
  let robots = List.length read.instance.robots in
  let members = List.fold_left (fun sum (k : Bound.cut) -> sum + List.length k.members) 0 cuts in
  let deadlines = List.fold_left (fun sum (g : Bound.group) -> sum + List.length g.deadlines) 0 groups in
  (robots * (members + deadlines)) + (deadlines * deadlines)

(* Why a bound is refused: by the first rule that is broken. *)
let broken (read : Reading.instance) = function
  | Bound.Scale -> Refused ("bound/scale", "the scale must be a power of two")
  | Price_rule -> Refused ("bound/price", "a price must be at least 0, at a place of the graph and a tick before the horizon")
  | Once -> Refused ("bound/once", "a place must have one price at a tick")
  | Size -> Refused ("bound/size", "robots, cuts, deadlines or prices would not fit into a table")
  | Cut_rule ->
      Refused ("bound/cut", "a cut names robots, its numbers are at least 0, and no robot's exceed the scale together")
  | Deadline_rule -> Refused ("bound/deadline", "the price of deadlines must be at least 0")
  | Robots (a :: _) ->
      Refused ("bound/robots", "the claim of robot " ^ named read a.robot_id ^ " must be no more than its least priced cost")
  | Robots [] -> Refused ("bound/robots", "each robot must be named once, in the instance's order")
  | Total -> Refused ("bound/total", "the bound must be the sum of all parts, rounded up")

let bound_fault (read : Reading.instance) (bound : Reading.bound) =
  match group_fault read bound with
  | Some fault -> fault
  | None ->
      let rule = Bound.broken_rule read.instance bound.certificate (Search.evidence read.instance bound.certificate) in
      Option.fold ~none:(Undecided "the kernel accepts each part and not the whole") ~some:(broken read) rule

(* First what needs no evidence, then the groups, and then the search for the least costs, as in carp_verify. *)
let verify_bound (read : Reading.instance) (bound : Reading.bound) =
  let instance = read.instance and certificate = bound.certificate in
  Reading.require_goals read;
  let of_cuts, of_deadlines = proofs_of read bound in
  if pairs_of read certificate > most_pairs then Undecided "the bound has too many robots and groups for the kernel"
  else
    match Bound.broken_rule instance certificate [] with
    | Some ((Scale | Price_rule | Once | Size | Cut_rule | Deadline_rule) as rule) -> broken read rule
    | Some (Robots _ | Total) | None -> (
        try
          if Formula.bound_proved instance certificate (Search.evidence instance certificate) of_cuts of_deadlines then
            Accepted [ ("bound", whole certificate.bound) ]
          else bound_fault read bound
        with
        | Unproved verdict -> verdict
        | Search.Too_many_steps ->
            Refused ("bound/size", Printf.sprintf "the search for least costs takes more than %d steps" Search.most_steps)
        | Search.Too_much_work ->
            Undecided "the kernel's search goes through stays under prices that are too long for it")
