(* Searches for the evidence of a bound's claims. Nothing here is trusted: the kernel checks what is found. *)

module Queue = Set.Make (struct
  type t = Z.t * Z.t

  let compare (a, b) (c, d) = match Z.compare a c with 0 -> Z.compare b d | order -> order
end)

let resources_to table r = Option.value ~default:[] (Hashtbl.find_opt table r)

(* For each resource those that one move leads to, and those from which one move leads to it. *)
let moves_of (instance : Law.instance) =
  let onwards = Hashtbl.create 1024 and backwards = Hashtbl.create 1024 in
  let add table source target = Hashtbl.replace table source (target :: resources_to table source) in
  let move (source, target) = add onwards source target; add backwards target source in
  List.iter move (Checker.moves_of_graph instance);
  (onwards, backwards)

(* The least ticks from leaving a resource to entering the goal, for those that lead there: Dijkstra. *)
let ticks_after takes backwards goal =
  let ticks = Hashtbl.create 1024 in
  let rec settle queue =
    match Queue.min_elt_opt queue with
    | None -> ()
    | Some ((rest, r) as first) ->
        let queue = Queue.remove first queue in
        if Hashtbl.mem ticks r then settle queue
        else (
          Hashtbl.add ticks r rest;
          let later = Z.add rest (takes r) in
          settle (List.fold_left (fun queue s -> Queue.add (later, s) queue) queue (resources_to backwards r)))
  in
  settle (Queue.of_list (List.map (fun r -> (Z.zero, r)) (resources_to backwards goal)));
  ticks

(* A way from the start to the goal, without the start. *)
let rec way_on takes onwards ticks goal r =
  let next = resources_to onwards r in
  if Z.equal r goal then []
  else if List.exists (Z.equal goal) next then [ goal ]
  else
    let is_shortest s =
      match (Hashtbl.find_opt ticks r, Hashtbl.find_opt ticks s) with
      | Some here, Some there -> Z.equal here (Z.add (takes s) there)
      | _ -> false
    in
    match List.find_opt is_shortest next with None -> [] | Some s -> s :: way_on takes onwards ticks goal s

(* The steps that carp_verify allows the searches of all robots together, and what the kernel looks at besides: a step
   goes through the ticks of a stay up to the last price, and through a robot's deadlines. *)
exception Too_many_steps
exception Too_much_work

let most_steps = 5_000_000
let most_work = 100_000_000

type budget = { mutable steps : int; mutable work : int }

let spend budget first until dues =
  let ticks = Z.max Z.zero (Z.sub until first) in
  if Z.gt ticks (Z.of_int budget.work) then raise Too_much_work;
  budget.work <- budget.work - Z.to_int ticks - dues - 1;
  if budget.work < 0 then raise Too_much_work

(* Entries of a queue: the estimate of what is paid at the goal, and a resource with the tick of leaving it. *)
module Estimates = Set.Make (struct
  type t = Z.t * Z.t * Z.t

  let compare (estimate, t, r) (other, u, s) =
    match Z.compare estimate other with 0 -> (match Z.compare u t with 0 -> Z.compare r s | order -> order) | order -> order
end)

module Ticks = Map.Make (Z)

(* What a robot pays from a tick on that parks in a resource with these prices. *)
let paid_by_parking prices =
  let last (x : Prices.price) = if x.other = None then x.tick else Z.pred x.tick in
  let add (sum, sums) (x : Prices.price) =
    let sum = Z.add sum x.amount in
    (sum, Ticks.add (last x) sum sums)
  in
  let _, sums = List.fold_left add (Z.zero, Ticks.empty) (List.sort (fun x y -> Z.compare (last y) (last x)) prices) in
  fun t -> Option.fold ~none:Z.zero ~some:snd (Ticks.find_first_opt (Z.leq t) sums)

(* Labels for all that costs less than is claimed, the least estimate first (A star); none once the claim is seen to be
   too high. *)
let labels_below budget claimed weight (tariff : Labels.tariff) dues horizon takes onwards ticks parked (a : Law.robot) =
  let amounts = Hashtbl.create 1024 and settled = Hashtbl.create 1024 in
  let queue = ref Estimates.empty and too_high = ref false in
  let reach amount r t =
    match Hashtbl.find_opt ticks r with
    | None -> ()
    | Some rest ->
        let estimate = Z.add amount (Z.mul weight (Z.sub (Z.add t rest) a.release)) in
        if Z.lt estimate claimed then
          if Z.geq t horizon then too_high := true
          else
            match Hashtbl.find_opt amounts (r, t) with
            | Some known when Z.leq known amount -> ()
            | _ -> Hashtbl.replace amounts (r, t) amount; queue := Estimates.add (estimate, t, r) !queue
  in
  let count_of_dues = List.length dues in
  let enter amount r t =
    let ready = Z.add t (takes r) in
    spend budget t (Z.min ready tariff.horizon) count_of_dues;
    let stayed = Z.add amount (Labels.stay_price tariff r t ready) in
    if Z.equal r (Law.goal a) then (
      let paid = match parked with None -> stayed | Some paid_from -> Z.add amount (paid_from t) in
      let total = Z.add paid (Z.add (Bound.fees_at_arrival dues t) (Z.mul weight (Z.sub t a.release))) in
      if Z.lt total claimed then too_high := true);
    reach (Z.add stayed (Bound.fees_on_the_way dues r t ready)) r ready
  in
  let leave r t =
    budget.steps <- budget.steps - 1;
    if budget.steps < 0 then raise Too_many_steps;
    let amount = Hashtbl.find amounts (r, t) and later = Z.succ t in
    let paid = Z.add (Labels.wait_price tariff r t) (Bound.fees_on_the_way dues r t later) in
    reach (Z.add amount paid) r later;
    List.iter (fun s -> enter (Z.add amount (Labels.move_price tariff r s t)) s t) (resources_to onwards r)
  in
  let rec settle () =
    match Estimates.min_elt_opt !queue with
    | Some ((_, t, r) as first) when not !too_high ->
        queue := Estimates.remove first !queue;
        if not (Hashtbl.mem settled (r, t)) then (Hashtbl.add settled (r, t) (); leave r t);
        settle ()
    | _ -> ()
  in
  enter Z.zero a.start a.release;
  settle ();
  if !too_high then [] else Hashtbl.fold (fun place amount labels -> (place, amount) :: labels) amounts []

(* The evidence of each robot's claim, looked for when it is asked for. Raises [Too_many_steps] and [Too_much_work]. *)
let evidence (instance : Law.instance) (certificate : Bound.certificate) =
  let onwards, backwards = moves_of instance in
  let prices = Bound.all_prices instance certificate in
  let tariff = Tables.tariff_of prices and table = Tables.resource_table instance in
  let claims = Hashtbl.of_seq (List.to_seq certificate.claims) in
  (* Nothing is paid after the last price, the last deadline, and the last tick at which a robot is seen. *)
  let after last (d : Bound.deadline) =
    let tick = match d.seen with Some sight -> sight.seen_at | None -> d.due in
    Z.max last (Z.succ tick)
  in
  let deadlines = List.concat_map (fun (g : Bound.group) -> g.deadlines) certificate.groups in
  let horizon = List.fold_left after tariff.horizon deadlines in
  let priced = Hashtbl.create 1024 in
  List.iter (fun (x : Prices.price) -> Hashtbl.add priced x.place x) prices;
  let known = Hashtbl.create 64 and budget = { steps = most_steps; work = most_work } in
  let of_robot (a : Law.robot) () =
    let takes = Tables.takes_in table a in
    let ticks =
      let key = (Law.goal a, a.pace) in
      match Hashtbl.find_opt known key with
      | Some ticks -> ticks
      | None -> let ticks = ticks_after takes backwards (Law.goal a) in Hashtbl.add known key ticks; ticks
    in
    let labels =
      match Hashtbl.find_opt claims a.robot_id with
      | Some (Some claimed) ->
          let weight = Bound.weight_of certificate a.robot_id and dues = Bound.dues_of certificate a.robot_id in
          let parks = instance.after_goal = Law.Park in
          let parked = if parks then Some (paid_by_parking (Hashtbl.find_all priced (Law.goal a))) else None in
          labels_below budget claimed weight tariff dues horizon takes onwards ticks parked a
      | _ -> []
    in
    { Bound.ticks_after = Hashtbl.fold (fun r rest all -> (r, rest) :: all) ticks []; labels;
      way = way_on takes onwards ticks (Law.goal a) a.start }
  in
  List.map of_robot instance.robots
