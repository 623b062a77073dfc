(* The questions that the kernel decides, each with its verdict. *)

module K = Kernel

(* Accepted, refused by a rule, or undecided, each with what else is to be said in JSON. *)
type verdict =
  | Accepted of (string * Yojson.Safe.t) list
  | Refused of string * string
  | Undecided of string

let whole n : Yojson.Safe.t = `Intlit (Z.to_string n)

(* ---- check ---- *)

(* The rule of a plan that is broken first; what is accepted is decided by the kernel alone. *)
let broken_plan_rule instance known (a : K.robot) (p : K.plan) =
  let rec chain = function
    | [] -> "plan/goal"
    | (v : K.visit) :: later -> (
        if K.Map.find v.visit_resource known.K.resource_of = None then "plan/resource"
        else if not (K.stay_accepted known a v) then "plan/duration"
        else
          match later with
          | [] -> "plan/goal"
          | w :: _ when not (K.same_end v.leave (Some w.enter)) -> "plan/contiguous"
          | w :: _ when K.Map.find w.visit_resource known.K.resource_of <> None
                        && not (K.has_move known v.visit_resource w.visit_resource) -> "plan/move"
          | _ -> chain later)
  in
  match p.visits with
  | v :: _ when Z.equal v.visit_resource a.start && Z.equal v.enter a.release -> chain p.visits
  | _ -> "plan/start"

let check (read : Reading.instance) (solution : K.solution) =
  let instance = read.instance in
  if K.accepted instance solution then
    Accepted
      [ ("cost", whole (K.total_cost instance solution)); ("unplanned", `Int (List.length solution.unplanned)) ]
  else
    let known = K.lookup_of instance in
    let robot_of (p : K.plan) = K.Map.find p.plan_robot known.robot_of in
    let names = Reading.names read.robot_numbers in
    let broken p = not (K.plan_of_robot_accepted instance known p) in
    if not (K.covers_accepted instance solution) then
      Refused ("solution/covers", "each robot must have one plan or be unplanned once")
    else if not (K.order_accepted solution) then
      Refused ("solution/order", "the order must name each robot that has a plan once")
    else
      match List.find_opt broken solution.plans with
      | Some p ->
          let rule = match robot_of p with Some a -> broken_plan_rule instance known a p | None -> "solution/covers" in
          Refused (rule, "the plan of robot " ^ Reading.shown names.(Z.to_int p.plan_robot))
      | None ->
          if not (K.capacity_accepted instance solution.plans) then
            Refused ("joint/capacity", "more robots occupy a resource than its capacity")
          else Refused ("joint/exchange", "two robots exchange two resources")

(* ---- refute ---- *)

let refute formula proof =
  if K.refutes formula proof then Accepted []
  else Refused ("refutation", "the proof does not derive the empty clause by its hints")

(* ---- verify-bound ---- *)

let verify_bound (read : Reading.instance) (bound : Reading.bound) =
  let { Reading.certificate; _ } = bound in
  match K.broken_rule read.instance certificate (Search.evidence read.instance certificate) with
  | Some K.Scale -> Refused ("bound/scale", "the scale must be a power of two")
  | Some K.Price_rule -> Refused ("bound/price", "a price must be at least 0, at a place of the graph and a tick before the horizon")
  | Some K.Once -> Refused ("bound/once", "a place must have one price at a tick")
  | Some K.Size -> Refused ("bound/size", "the prices would not fit into a table")
  | Some K.Cut_rule -> Refused ("bound/cut", "multipliers must be at least 0 and a robot's no more than the scale together")
  | Some (K.Robots (a :: _)) ->
      let name = Reading.shown (Reading.names read.robot_numbers).(Z.to_int a.robot_id) in
      Refused ("bound/robots", "the claim of robot " ^ name ^ " must be no more than its least priced cost")
  | Some (K.Robots []) -> Refused ("bound/robots", "each robot must be named once, in the instance's order")
  | Some K.Total -> Refused ("bound/total", "the bound must be the sum of all parts, rounded up")
  | None -> Accepted [ ("bound", whole certificate.bound) ]
