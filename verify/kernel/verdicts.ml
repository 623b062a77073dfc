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

(* The formula of plans of the robots below the total, with the number of its variables, or why none is made. *)
let blueprint (read : Reading.instance) group total evidence =
  match Encoder.blueprint read.instance group total evidence with
  | made -> Ok made
  | exception Encoder.No_way a ->
      Error (Refused ("proof/way", "no way leads to the goal of robot " ^ named read a.robot_id))
  | exception Encoder.Too_large ->
      Error (Undecided (Printf.sprintf "the formula would have more than %d clauses, the limit" Encoder.most_clauses))

let blueprint_of_claim (read : Reading.instance) { Reading.cost; evidence } =
  blueprint read read.instance.robots cost evidence

let verify_proof (read : Reading.instance) (claim : Reading.claim) proof =
  match blueprint_of_claim read claim with
  | Error verdict -> verdict
  | Ok (blueprint, _) ->
      if Formula.total_refuted read.instance claim.cost blueprint proof then
        Accepted [ ("bound", Option.fold ~none:`Null ~some:whole claim.cost) ]
      else if Formula.blueprint_accepted read.instance read.instance.robots claim.cost blueprint then
        refute blueprint.formula proof
      else Undecided "the kernel has made a clause for which it has no reason"

(* ---- verify-bound ---- *)

(* Deadlines are decided by a formula of the caller's, which must say that all are kept: the kernel checks the refutation of
   it. Without a formula, or with a refutation that does not hold, the bound is undecided. *)
let why_undecided formulas number refutation =
  match List.assoc_opt number formulas with
  | None -> Some (Printf.sprintf "deadline %d needs its formula: --deadline-formula %d FILE" number number)
  | Some formula ->
      if Refutation.refutes formula (Reading.proof_of_text refutation) then None
      else Some (Printf.sprintf "the refutation of deadline %d does not hold" number)

(* The formula of a cut and its refutation, or why the cut is not accepted. *)
let proof_of_cut (read : Reading.instance) number (k : Bound.cut) (horizons, order, refutation) =
  let refused why = Error (Refused ("bound/cut", Printf.sprintf "the proof of cut %d does not hold: %s" number why)) in
  let group = Formula.group_of read.instance k.members in
  let is_natural n = Z.sign n >= 0 && Z.fits_int n in
  if List.length group <> List.length k.members || List.length horizons <> List.length group
     || not (List.for_all is_natural horizons)
     || List.sort Z.compare order <> List.init (List.length group) Z.of_int then
    refused "it must have a horizon of each of its robots, and an order of them"
  else
    let evidence = { Encoder.horizons = List.map Z.to_int horizons; order = List.map Z.to_int order } in
    match (blueprint read group (Some k.least_total) evidence, Reading.proof_of_text refutation) with
    | Error (Refused (_, why)), _ -> refused why
    | Error verdict, _ -> Error verdict
    | Ok (blueprint, _), lines when Formula.cut_refuted read.instance k blueprint lines -> Ok (blueprint, lines)
    | Ok _, _ -> refused "the refutation does not derive the empty clause by its hints"
    | exception Reading.Refused { message; _ } -> refused message

let rec proofs_of_cuts read number cuts proofs =
  match (cuts, proofs) with
  | k :: cuts, proof :: proofs ->
      Result.bind (proof_of_cut read number k proof) (fun first ->
          Result.map (fun rest -> first :: rest) (proofs_of_cuts read (number + 1) cuts proofs))
  | _ -> Ok []

let verify_bound formulas (read : Reading.instance) (bound : Reading.bound) =
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
  | None -> (
      match proofs_of_cuts read 0 certificate.cuts of_cuts with
      | Error verdict -> verdict
      | Ok proofs when Formula.cuts_refuted read.instance certificate.cuts proofs -> (
          match List.find_map Fun.id (List.mapi (why_undecided formulas) of_deadlines) with
          | Some why -> Undecided why
          | None ->
              let group number _ : Yojson.Safe.t =
                `String (Printf.sprintf "the formula given says that the robots of deadline %d keep all of theirs" number)
              in
              Accepted [ ("bound", whole certificate.bound); ("assumed", `List (List.mapi group certificate.groups)) ])
      | Ok _ -> Undecided "the kernel has lost the proof of a cut")
