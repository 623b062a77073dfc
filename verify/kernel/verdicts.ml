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
          | [] -> "plan/goal"
          | w :: _ when not (Checker.same_end v.leave (Some w.enter)) -> "plan/contiguous"
          | w :: _ when Collections.Map.find w.visit_resource known.Checker.resource_of <> None
                        && not (Checker.has_move known v.visit_resource w.visit_resource) -> "plan/move"
          | _ -> chain later)
  in
  match p.visits with
  | v :: _ when Z.equal v.visit_resource a.start && Z.equal v.enter a.release -> chain p.visits
  | _ -> "plan/start"

let check (read : Reading.instance) (solution : Law.solution) =
  let instance = read.instance in
  if Checker.accepted instance solution then
    Accepted
      [ ("cost", whole (Law.total_cost instance solution)); ("unplanned", `Int (List.length solution.unplanned)) ]
  else
    let known = Checker.lookup_of instance in
    let robot_of (p : Law.plan) = Collections.Map.find p.plan_robot known.robot_of in
    let broken p = not (Checker.plan_of_robot_accepted instance known p) in
    if not (Checker.covers_accepted instance solution) then
      Refused ("solution/covers", "each robot must have one plan or be unplanned once")
    else if not (Checker.order_accepted solution) then
      Refused ("solution/order", "the order must name each robot that has a plan once")
    else
      match List.find_opt broken solution.plans with
      | Some p ->
          let rule = match robot_of p with Some a -> broken_plan_rule instance known a p | None -> "solution/covers" in
          Refused (rule, "the plan of robot " ^ named read p.plan_robot)
      | None ->
          if not (Checker.capacity_accepted instance solution.plans) then
            Refused ("joint/capacity", "more robots occupy a resource than its capacity")
          else Refused ("joint/exchange", "two robots exchange two resources")

(* ---- verify-query and audit ---- *)

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
      | Some Goal_potential -> ("query-certificate/potential", "the potential of the goal must be 0")
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
  if Audit.query_accepted read.instance solution query_robot now query_certificate then
    Accepted [ ("bound", Option.fold ~none:`Null ~some:whole query_certificate.bound) ]
  else if not (Audit.plans_accepted read.instance (Checker.lookup_of read.instance) solution.plans) then
    Refused ("query-certificate/plans", "each plan must be lawful by itself, and of a robot of its own")
  else
    let rule, message = query_fault read solution query in
    Refused (rule, message)

let audit (read : Reading.instance) (solution : Law.solution) (queries : Reading.query list) =
  match check read solution with
  | Accepted more -> (
      let certificate (query : Reading.query) = (query.query_robot, query.query_certificate) in
      match Audit.audit read.instance solution (List.map certificate queries) with
      | None -> Accepted more
      | Some robot -> Refused ("query/optimal", "the plan of robot " ^ named read robot ^ " is not certified"))
  | other -> other

(* ---- refute ---- *)

let refute formula proof =
  if Refutation.refutes formula proof then Accepted []
  else Refused ("refutation", "the proof does not derive the empty clause by its hints")

(* ---- verify-proof ---- *)

(* The formula of plans of the robots that do what is demanded, with the number of its variables, or why none is made. *)
let blueprint (read : Reading.instance) group asked evidence =
  match Encoder.blueprint read.instance group asked evidence with
  | made -> Ok made
  | exception Encoder.No_way a ->
      Error (Refused ("proof/way", "no way leads to the goal of robot " ^ named read a.robot_id))
  | exception Encoder.Too_early (a, earliest) ->
      let robot = named read a.robot_id and tick = Z.to_string earliest in
      Error (Refused ("bound/deadline", Printf.sprintf "robot %s can be at its goal at %s, not earlier" robot tick))
  | exception Encoder.Too_large ->
      Error (Undecided (Printf.sprintf "the formula would have more than %d clauses, the limit" Encoder.most_clauses))

let demand_of_claim { Reading.cost; _ } =
  Option.fold ~none:Formula.Lawful_plans ~some:(fun cost -> Formula.Cheaper_than cost) cost

let blueprint_of_claim (read : Reading.instance) (claim : Reading.claim) =
  blueprint read read.instance.robots (demand_of_claim claim) claim.evidence

let verify_proof (read : Reading.instance) (claim : Reading.claim) proof =
  match blueprint_of_claim read claim with
  | Error verdict -> verdict
  | Ok (blueprint, _) ->
      let asked = demand_of_claim claim in
      if Formula.refuted read.instance asked blueprint proof then
        Accepted [ ("bound", Option.fold ~none:`Null ~some:whole claim.cost) ]
      else if Formula.blueprint_accepted read.instance read.instance.robots asked blueprint then
        refute blueprint.formula proof
      else Undecided "the kernel has made a clause for which it has no reason"

(* ---- verify-bound ---- *)

let no_refutation = Refused ("refutation", "the refutation does not derive the empty clause by its hints")

let in_proof rule group number = function
  | Refused (_, why) -> Refused (rule, Printf.sprintf "the proof of %s %d does not hold: %s" group number why)
  | other -> other

let in_proof_of_cut = in_proof "bound/cut" "cut"
let in_proof_of_deadlines = in_proof "bound/deadline" "deadlines"

(* The formula of a group and its refutation, which is not checked yet. *)
let proof_of_group read group asked evidence refutation =
  match Reading.proof_of_text refutation with
  | lines -> Result.map (fun (blueprint, _) -> (blueprint, lines)) (blueprint read group asked evidence)
  | exception Reading.Refused { rule; message; _ } -> Error (Refused (rule, message))

let proof_of_cut (read : Reading.instance) (k : Bound.cut) (horizons, order, refutation) =
  let group = Formula.group_of read.instance k.members in
  let is_natural n = Z.sign n >= 0 && Z.fits_int n in
  if List.length group <> List.length k.members || List.length horizons <> List.length group
     || not (List.for_all is_natural horizons)
     || List.sort Z.compare order <> List.init (List.length group) Z.of_int then
    Error (Refused ("bound/cut", "it must have a horizon of each of its robots, and an order of them"))
  else
    let evidence = { Encoder.horizons = List.map Z.to_int horizons; order = List.map Z.to_int order } in
    proof_of_group read group (Formula.Cheaper_than k.least_total) evidence refutation

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

let proof_of_deadlines (read : Reading.instance) (g : Bound.group) refutation =
  let ids = Formula.once [] (List.map (fun (d : Bound.deadline) -> d.who) g.deadlines) in
  let group = Formula.group_of read.instance ids in
  if group = [] || List.length group <> List.length ids || not (are_named_rightly g.deadlines) then
    Error (Refused ("bound/deadline", "it must name robots of the instance, each once, or again where it is seen later"))
  else if List.exists (is_never read) g.deadlines then
    Error (Refused ("bound/deadline", "a robot must be seen at a tick of at least 0, in resources of the graph"))
  else proof_of_group read group (Formula.In_time g.deadlines) { horizons = []; order = [] } refutation

(* The proofs of all claims, or what is wrong with the first one that cannot be made. *)
let rec proofs_of proof_of in_proof number claimed proofs =
  match (claimed, proofs) with
  | claim :: claimed, proof :: proofs -> (
      match proof_of claim proof with
      | Error verdict -> Error (in_proof number verdict)
      | Ok first -> Result.map (List.cons first) (proofs_of proof_of in_proof (number + 1) claimed proofs))
  | _ -> Ok []

(* The number of the first claim that its proof does not refute. *)
let rec first_unrefuted refuted number claimed proofs =
  match (claimed, proofs) with
  | claim :: claimed, (blueprint, lines) :: proofs when refuted claim blueprint lines ->
      first_unrefuted refuted (number + 1) claimed proofs
  | [], _ -> None
  | _ -> Some number

let verify_groups (read : Reading.instance) (certificate : Bound.certificate) of_cuts of_deadlines =
  let ( let* ) = Result.bind in
  let made =
    let* of_cuts = proofs_of (proof_of_cut read) in_proof_of_cut 0 certificate.cuts of_cuts in
    let* of_deadlines = proofs_of (proof_of_deadlines read) in_proof_of_deadlines 0 certificate.groups of_deadlines in
    Ok (of_cuts, of_deadlines)
  in
  match made with
  | Error verdict -> verdict
  | Ok (of_cuts, of_deadlines) when Formula.groups_refuted read.instance certificate of_cuts of_deadlines ->
      Accepted [ ("bound", whole certificate.bound) ]
  | Ok (of_cuts, of_deadlines) -> (
      let cut = first_unrefuted (Formula.cut_refuted read.instance) 0 certificate.cuts of_cuts in
      let deadlines = first_unrefuted (Formula.deadlines_refuted read.instance) 0 certificate.groups of_deadlines in
      match (cut, deadlines) with
      | Some number, _ -> in_proof_of_cut number no_refutation
      | None, Some number -> in_proof_of_deadlines number no_refutation
      | None, None -> Undecided "the kernel has lost the proof of a group")

let verify_bound (read : Reading.instance) (bound : Reading.bound) =
  let { Reading.certificate; of_cuts; of_deadlines; _ } = bound in
  match Bound.broken_rule read.instance certificate (Search.evidence read.instance certificate) with
  | Some Bound.Scale -> Refused ("bound/scale", "the scale must be a power of two")
  | Some Bound.Price_rule ->
      Refused ("bound/price", "a price must be at least 0, at a place of the graph and a tick before the horizon")
  | Some Bound.Once -> Refused ("bound/once", "a place must have one price at a tick")
  | Some Bound.Size -> Refused ("bound/size", "the prices would not fit into a table")
  | Some Bound.Cut_rule ->
      Refused ("bound/cut", "multipliers must be at least 0 and a robot's no more than the scale together")
  | Some Bound.Deadline_rule -> Refused ("bound/deadline", "the price of deadlines must be at least 0")
  | Some (Bound.Robots (a :: _)) ->
      let claim = "the claim of robot " ^ named read a.robot_id in
      Refused ("bound/robots", claim ^ " must be no more than its least priced cost")
  | Some (Bound.Robots []) -> Refused ("bound/robots", "each robot must be named once, in the instance's order")
  | Some Bound.Total -> Refused ("bound/total", "the bound must be the sum of all parts, rounded up")
  | None -> verify_groups read certificate of_cuts of_deadlines
