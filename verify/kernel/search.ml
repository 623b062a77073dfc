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

(* Labels for all that costs less than is claimed, tick by tick; none once the claim is seen to be too high. *)
let labels_below budget claimed weight (tariff : Labels.tariff) dues horizon takes onwards ticks (a : Law.robot) =
  let amounts = Hashtbl.create 1024 and queue = ref Queue.empty and too_high = ref false in
  let reach amount r t =
    match Hashtbl.find_opt ticks r with
    | None -> ()
    | Some rest ->
        if Z.lt (Z.add amount (Z.mul weight (Z.sub (Z.add t rest) a.release))) claimed then
          if Z.geq t horizon then too_high := true
          else (
            queue := Queue.add (t, r) !queue;
            match Hashtbl.find_opt amounts (r, t) with
            | Some known when Z.leq known amount -> ()
            | _ -> Hashtbl.replace amounts (r, t) amount)
  in
  let count_of_dues = List.length dues in
  let enter amount r t =
    let ready = Z.add t (takes r) in
    spend budget t (Z.min ready tariff.horizon) count_of_dues;
    let paid = Z.add (Labels.stay_price tariff r t ready) (Bound.fees_on_the_way dues r t ready) in
    reach (Z.add amount paid) r ready
  in
  enter Z.zero a.start a.release;
  let rec settle () =
    match Queue.min_elt_opt !queue with
    | Some ((t, r) as first) when not !too_high ->
        queue := Queue.remove first !queue;
        budget.steps <- budget.steps - 1;
        if budget.steps < 0 then raise Too_many_steps;
        let amount = Hashtbl.find amounts (r, t) in
        let later = Z.succ t in
        let paid = Z.add (Labels.wait_price tariff r t) (Bound.fees_on_the_way dues r t later) in
        reach (Z.add amount paid) r later;
        List.iter (fun s -> enter (Z.add amount (Labels.move_price tariff r s t)) s t) (resources_to onwards r);
        settle ()
    | _ -> ()
  in
  settle ();
  Hashtbl.fold (fun place amount labels -> (place, amount) :: labels) amounts []

(* The evidence of each robot's claim, looked for when it is asked for. Raises [Too_many_steps] and [Too_much_work]. *)
let evidence (instance : Law.instance) (certificate : Bound.certificate) =
  let onwards, backwards = moves_of instance in
  let tariff = Tables.tariff_of certificate.prices and table = Tables.resource_table instance in
  let claims = Hashtbl.of_seq (List.to_seq certificate.claims) in
  (* Nothing is paid after the last price, the last deadline, and the last tick at which a robot is seen. *)
  let after last (d : Bound.deadline) =
    let tick = match d.seen with Some sight -> sight.seen_at | None -> d.due in
    Z.max last (Z.succ tick)
  in
  let deadlines = List.concat_map (fun (g : Bound.group) -> g.deadlines) certificate.groups in
  let horizon = List.fold_left after tariff.horizon deadlines in
  let known = Hashtbl.create 64 and budget = { steps = most_steps; work = most_work } in
  let of_robot (a : Law.robot) () =
    let takes = Tables.takes_in table a in
    let ticks =
      match Hashtbl.find_opt known (a.goal, a.pace) with
      | Some ticks -> ticks
      | None -> let ticks = ticks_after takes backwards a.goal in Hashtbl.add known (a.goal, a.pace) ticks; ticks
    in
    let labels =
      match Hashtbl.find_opt claims a.robot_id with
      | Some (Some claimed) ->
          let weight = Bound.weight_of certificate a.robot_id and dues = Bound.dues_of certificate a.robot_id in
          labels_below budget claimed weight tariff dues horizon takes onwards ticks a
      | _ -> []
    in
    { Bound.ticks_after = Hashtbl.fold (fun r rest all -> (r, rest) :: all) ticks []; labels;
      way = way_on takes onwards ticks a.goal a.start }
  in
  List.map of_robot instance.robots
