(* Reads the documents strictly: JSON text to the data that the law speaks of. Trusted, so it is plain.

   Ids become numbers: each resource of the graph and each robot its position, any other id a number after those. *)

(* A document that is refused: where, by which rule, and what would be right. *)
exception Refused of { path : string; rule : string; message : string }

let refuse path rule message = raise (Refused { path; rule; message })
let largest_document = 1 lsl 28
let most_digits = 100
let deepest = 100

(* ---- document/json: the text ---- *)

let malformed what = refuse "$" "document/json" ("the document must be JSON in UTF-8: " ^ what)

(* The number of bytes of the character in UTF-8 at a place of the text; 0 if none exists. *)
let character_length text at =
  let byte k = if at + k < String.length text then Char.code text.[at + k] else 0 in
  let continued k = byte k land 0xC0 = 0x80 in
  let first = byte 0 and second = byte 1 in
  if first < 0x80 then 1
  else if first >= 0xC2 && first <= 0xDF && continued 1 then 2
  else if first land 0xF0 = 0xE0 && continued 1 && continued 2
          && (first <> 0xE0 || second >= 0xA0) && (first <> 0xED || second < 0xA0) then 3
  else if first >= 0xF0 && first <= 0xF4 && continued 1 && continued 2 && continued 3
          && (first <> 0xF0 || second >= 0x90) && (first <> 0xF4 || second < 0x90) then 4
  else 0

(* The number of bytes of the escape at a place of the text; 0 for half a pair of surrogates. *)
let escape_length text at =
  let code at =
    if at + 6 > String.length text || text.[at] <> '\\' || text.[at + 1] <> 'u' then None
    else int_of_string_opt ("0x" ^ String.sub text (at + 2) 4)
  in
  let is_first c = c >= 0xD800 && c < 0xDC00 and is_second c = c >= 0xDC00 && c < 0xE000 in
  match (code at, code (at + 6)) with
  | Some first, Some second when is_first first && is_second second -> 12
  | Some half, _ when is_first half || is_second half -> 0
  | Some _, _ -> 6
  | None, _ -> 2

(* The word is a number as JSON has it. *)
let is_number word =
  let digit at = at < String.length word && word.[at] >= '0' && word.[at] <= '9' in
  let is at letters = at < String.length word && String.contains letters word.[at] in
  let rec digits at = if digit at then digits (at + 1) else at in
  let first = if is 0 "-" then 1 else 0 in
  let after_whole = if is first "0" then first + 1 else digits first in
  let after_fraction = if is after_whole "." then digits (after_whole + 1) else after_whole in
  let exponent = if is (after_fraction + 1) "+-" then after_fraction + 2 else after_fraction + 1 in
  digit first
  && (after_fraction = after_whole || digit (after_whole + 1))
  && if is after_fraction "eE" then digit exponent && digits exponent = String.length word
     else after_fraction = String.length word

(* Refuse what the JSON library would read beyond JSON (comments, names without quotes, NaN, raw control characters),
   bad UTF-8, and deep nesting. *)
let require_plain text =
  if String.length text > largest_document then
    malformed (Printf.sprintf "it must have at most %d bytes" largest_document);
  let is_of_word = function '-' | '+' | '.' | '0' .. '9' | 'a' .. 'z' | 'A' .. 'Z' -> true | _ -> false in
  let rec end_of_word at = if at < String.length text && is_of_word text.[at] then end_of_word (at + 1) else at in
  let rec outside at depth =
    if at < String.length text then
      match text.[at] with
      | '"' -> inside (at + 1) depth
      | '[' | '{' when depth = deepest -> malformed (Printf.sprintf "it must be nested at most %d deep" deepest)
      | '[' | '{' -> outside (at + 1) (depth + 1)
      | ']' | '}' -> outside (at + 1) (depth - 1)
      | ' ' | '\t' | '\n' | '\r' | ',' | ':' -> outside (at + 1) depth
      | first when is_of_word first ->
          let word = String.sub text at (end_of_word at - at) in
          if is_number word || List.mem word [ "true"; "false"; "null" ] then outside (end_of_word at) depth
          else malformed (Printf.sprintf "it has a word that is no JSON at byte %d" at)
      | found -> malformed (Printf.sprintf "it has %C at byte %d" found at)
  and inside at depth =
    if at < String.length text then
      match text.[at] with
      | '"' -> outside (at + 1) depth
      | '\\' when escape_length text at = 0 -> malformed (Printf.sprintf "half a pair of surrogates at byte %d" at)
      | '\\' -> inside (at + escape_length text at) depth
      | control when control < ' ' -> malformed (Printf.sprintf "a string has a control character at byte %d" at)
      | _ ->
          let length = character_length text at in
          if length = 0 then malformed (Printf.sprintf "byte %d is no UTF-8" at) else inside (at + length) depth
  in
  outside 0 0

(* Refuse names that are twice in an object, numbers with too many digits, and what is no JSON. *)
let rec require_json (json : Yojson.Safe.t) =
  match json with
  | `Assoc members ->
      let names = Hashtbl.create (List.length members) in
      List.iter
        (fun (name, value) ->
          if Hashtbl.mem names name then malformed (Printf.sprintf "an object has the name %S twice" name);
          Hashtbl.add names name ();
          require_json value)
        members
  | `List values -> List.iter require_json values
  | `Intlit digits ->
      let sign = if digits.[0] = '-' then 1 else 0 in
      if String.length digits - sign > most_digits then
        malformed (Printf.sprintf "a whole number has more than %d digits" most_digits)
  | `Null | `Bool _ | `Int _ | `Float _ | `String _ -> ()
  | `Tuple _ | `Variant _ -> malformed "it has a tuple or a variant"

let json_of_text text =
  require_plain text;
  match Yojson.Safe.from_string text with
  | json -> require_json json; json
  | exception Yojson.Json_error message -> malformed (String.map (fun c -> if c = '\n' then ' ' else c) message)

(* ---- document/shape: fields and types ---- *)

let shape path what = refuse path "document/shape" ("expected " ^ what)

(* The fields of an object, which has all that are required and no others: each with its path, by its name. *)
let fields path ~required ~optional (json : Yojson.Safe.t) =
  match json with
  | `Assoc members ->
      List.iter
        (fun (name, _) ->
          if not (List.mem name required || List.mem name optional) then shape path (Printf.sprintf "no field %S" name))
        members;
      let missing name = not (List.mem_assoc name members) in
      Option.iter (fun name -> shape path (Printf.sprintf "a field %S" name)) (List.find_opt missing required);
      fun name -> Option.map (fun value -> (path ^ "." ^ name, value)) (List.assoc_opt name members)
  | _ -> shape path "an object"

let present field name read = Option.map (fun (path, json) -> read path json) (field name)
let required field name read = Option.get (present field name read)
let optional default field name read = Option.value ~default (present field name read)

let elements read path (json : Yojson.Safe.t) =
  let rec each position before = function
    | [] -> List.rev before
    | value :: rest -> each (position + 1) (read (Printf.sprintf "%s[%d]" path position) value :: before) rest
  in
  match json with `List values -> each 0 [] values | _ -> shape path "an array"

let whole path (json : Yojson.Safe.t) =
  match json with `Int n -> Z.of_int n | `Intlit digits -> Z.of_string digits | _ -> shape path "a whole number"

let natural path json =
  let n = whole path json in
  if Z.sign n < 0 then shape path "a whole number of at least 0" else n

let whole_or_null path (json : Yojson.Safe.t) = match json with `Null -> None | _ -> Some (whole path json)
let text path (json : Yojson.Safe.t) = match json with `String s -> s | _ -> shape path "a string"
let truth path (json : Yojson.Safe.t) = match json with `Bool b -> b | _ -> shape path "true or false"

(* An id: a string or a whole number, and 1 is not "1". *)
type id = Text of string | Whole of string

let id path (json : Yojson.Safe.t) =
  match json with
  | `String s -> Text s
  | `Int _ | `Intlit _ -> Whole (Z.to_string (whole path json))
  | _ -> shape path "a string or a whole number"

let shown = function Text s -> s | Whole digits -> digits

(* Numbers for ids, in the order in which they are first met. *)
type numbers = { known : (id, Z.t) Hashtbl.t; mutable names : id list; mutable count : int }

let no_numbers () = { known = Hashtbl.create 1024; names = []; count = 0 }

let number numbers id =
  match Hashtbl.find_opt numbers.known id with
  | Some n -> n
  | None ->
      let n = Z.of_int numbers.count in
      Hashtbl.add numbers.known id n;
      numbers.names <- id :: numbers.names;
      numbers.count <- numbers.count + 1;
      n

(* The ids by their numbers. *)
let names numbers = Array.of_list (List.rev numbers.names)

let require_format path format json =
  match json with
  | `Assoc members when List.assoc_opt "format" members = Some (`String format) -> ()
  | `Assoc members ->
      let found = match List.assoc_opt "format" members with Some (`String found) -> ", and is " ^ found | _ -> "" in
      refuse (path ^ ".format") "document/format" ("the format must be " ^ format ^ found)
  | _ -> refuse (path ^ ".format") "document/format" ("the format must be " ^ format)

(* ---- Instances ---- *)

type instance = { instance : Law.instance; resource_numbers : numbers; robot_numbers : numbers; group_numbers : numbers }

(* A robot of one stop, without service. *)
let has_goal_alone (a : Law.robot) =
  match a.stops with [ { service; _ } ] -> Z.equal service Z.zero | _ -> false

(* Refuse an instance that the kernel does not accept, by the first rule that is seen to be broken. *)
let name_fault path { Law.resources; edges; directed; groups; robots; _ } =
  let known id = Z.lt id (Z.of_int (List.length resources)) in
  let at_least_one rule path name value =
    if Z.lt value Z.one then
      refuse (path ^ "." ^ name) rule (Printf.sprintf "the %s must be a whole number of at least 1" name)
  in
  let each field check = List.iteri (fun position x -> check (Printf.sprintf "%s%s[%d]" path field position) x) in
  each ".graph.nodes" (fun path r -> at_least_one "instance/capacity" path "capacity" r.Law.capacity) resources;
  each ".graph.nodes" (fun path r -> at_least_one "instance/duration" path "duration" r.Law.duration) resources;
  let met = Hashtbl.create 1024 in
  let edge path (source, target) =
    if not (known source) then refuse (path ^ ".source") "instance/edge" "it must be the id of a resource, and is not";
    if not (known target) then refuse (path ^ ".target") "instance/edge" "it must be the id of a resource, and is not";
    if Z.equal source target then refuse path "instance/edge" "it must join two different resources";
    if Hashtbl.mem met (source, target) || ((not directed) && Hashtbl.mem met (target, source)) then
      refuse path "instance/edge" "it must be listed once";
    Hashtbl.add met (source, target) ()
  in
  each ".graph.edges" edge edges;
  let ids = Hashtbl.create 16 in
  let group path (g : Law.group) =
    let fault where message = refuse (path ^ where) "instance/group" message in
    if Hashtbl.mem ids g.group_id then fault ".id" "ids must be unique among groups";
    Hashtbl.add ids g.group_id ();
    if g.group_resources = [] then fault ".resources" "it must name at least one resource";
    let members = Hashtbl.create 16 in
    let member position place =
      let fault = fault (Printf.sprintf ".resources[%d]" position) in
      if not (known place) then fault "it must be the id of a resource, and is not";
      if Hashtbl.mem members place then fault "it must be named once";
      Hashtbl.add members place ()
    in
    List.iteri member g.group_resources;
    at_least_one "instance/group" path "capacity" g.group_capacity
  in
  each ".graph.groups" group groups;
  each ".robots" (fun path a -> if not (known a.Law.start) then
    refuse (path ^ ".start") "instance/endpoint" "the start must be the id of a resource") robots;
  each ".robots" (fun path a -> if has_goal_alone a && not (known (Law.goal a)) then
    refuse (path ^ ".goal") "instance/endpoint" "the goal must be the id of a resource") robots;
  let stops path (a : Law.robot) =
    let path = path ^ ".stops" in
    let fault where message = refuse (path ^ where) "instance/stops" message in
    if a.stops = [] then fault "" "there must be at least one stop";
    let stop before position { Law.stop_resource; service } =
      let fault name = fault (Printf.sprintf "[%d].%s" position name) in
      if not (known stop_resource) then fault "resource" "it must be the id of a resource, and is not";
      if Z.sign service < 0 then fault "service" "the service must be a whole number of at least 0";
      if Option.equal Z.equal (Some stop_resource) !before then
        fault "resource" "it must be at another resource than the stop before it";
      before := Some stop_resource
    in
    List.iteri (stop (ref None)) a.stops
  in
  each ".robots" stops robots;
  each ".robots" (fun path a -> if Z.sign a.Law.release < 0 then
    refuse (path ^ ".release") "instance/release" "the release must be a whole number of at least 0") robots;
  each ".robots" (fun path a -> at_least_one "instance/pace" path "pace" a.Law.pace) robots;
  refuse path "instance" "the instance must keep the rules instance/..."

let instance_of_json path json =
  require_format path "carproof-instance/1" json;
  let one = Z.one in
  let resource_numbers = no_numbers () and robot_numbers = no_numbers () and group_numbers = no_numbers () in
  let resource_id path json = number resource_numbers (id path json) in
  let node path json =
    let field = fields path ~required:[ "id" ] ~optional:[ "capacity"; "duration"; "x"; "y" ] json in
    let known = required field "id" id in
    if Hashtbl.mem resource_numbers.known known then
      refuse (path ^ ".id") "instance/resource-id"
        ("ids must be unique, and a resource before it has the id " ^ shown known);
    let x = present field "x" whole in
    let y = present field "y" whole in
    if (x = None) <> (y = None) then
      refuse path "instance/position" "x and y must both be whole numbers or both be absent";
    { Law.resource_id = number resource_numbers known;
      capacity = optional one field "capacity" whole;
      duration = optional one field "duration" whole }
  in
  let edge path json =
    let field = fields path ~required:[ "source"; "target" ] ~optional:[] json in
    (required field "source" resource_id, required field "target" resource_id)
  in
  let group path json =
    let field = fields path ~required:[ "id"; "resources" ] ~optional:[ "capacity" ] json in
    { Law.group_id = number group_numbers (required field "id" id);
      group_resources = required field "resources" (elements resource_id);
      group_capacity = optional one field "capacity" whole }
  in
  let graph path json =
    let field = fields path ~required:[ "nodes"; "edges" ] ~optional:[ "directed"; "multigraph"; "graph"; "groups" ] json in
    let attributes path json = present (fields path ~required:[] ~optional:[ "name" ] json) "name" text in
    ignore (present field "graph" attributes);
    if optional false field "multigraph" truth then shape (path ^ ".multigraph") "false";
    let nodes = required field "nodes" (elements node) in
    let edges = required field "edges" (elements edge) and directed = optional false field "directed" truth in
    (nodes, edges, directed, optional [] field "groups" (elements group))
  in
  let stop path json =
    let field = fields path ~required:[ "resource" ] ~optional:[ "service" ] json in
    { Law.stop_resource = required field "resource" resource_id; service = optional Z.zero field "service" whole }
  in
  let robot path json =
    let field = fields path ~required:[ "id"; "start" ] ~optional:[ "goal"; "stops"; "release"; "pace" ] json in
    let known = required field "id" id in
    let stops =
      match (present field "goal" resource_id, present field "stops" (elements stop)) with
      | Some goal, None -> Law.only goal
      | None, Some stops -> stops
      | _ -> shape path "either a goal or stops"
    in
    if Hashtbl.mem robot_numbers.known known then
      refuse (path ^ ".id") "instance/robot-id" ("ids must be unique, and a robot before it has the id " ^ shown known);
    { Law.robot_id = number robot_numbers known;
      start = required field "start" resource_id;
      stops;
      release = optional Z.zero field "release" whole;
      pace = optional one field "pace" whole }
  in
  let after path json =
    match text path json with
    | "vanish" -> Law.Vanish
    | "park" -> Law.Park
    | _ -> shape path "\"vanish\" or \"park\""
  in
  let is_forbidden path json =
    match text path json with
    | "allowed" -> false
    | "forbidden" -> true
    | _ -> shape path "\"allowed\" or \"forbidden\""
  in
  let required_fields = [ "format"; "graph"; "after_goal"; "robots" ] in
  let field = fields path ~required:required_fields ~optional:[ "following"; "$schema" ] json in
  ignore (present field "$schema" text);
  let following_is_forbidden = optional false field "following" is_forbidden in
  let resources, edges, directed, groups = required field "graph" graph in
  let after_goal = required field "after_goal" after in
  let robots = required field "robots" (elements robot) in
  let instance = { Law.resources; edges; directed; groups; after_goal; following_is_forbidden; robots } in
  if not (Checker.instance_accepted instance) then name_fault path instance;
  { instance; resource_numbers; robot_numbers; group_numbers }

(* Refuse robots with stops where the kernel decides nothing about them. *)
let require_goals { instance; _ } =
  let goal position a =
    if not (has_goal_alone a) then
      refuse (Printf.sprintf "$.robots[%d].stops" position) "limit/stops"
        "each robot must have one stop without service, a goal, here"
  in
  List.iteri goal instance.Law.robots

(* ---- Solutions ---- *)

let solution_of_json { resource_numbers; robot_numbers; _ } path json =
  require_format path "carproof-solution/1" json;
  let robot path json = number robot_numbers (id path json) in
  let visit path (json : Yojson.Safe.t) =
    match json with
    | `List [ resource; enter; leave ] ->
        { Law.visit_resource = number resource_numbers (id (path ^ "[0]") resource);
          enter = whole (path ^ "[1]") enter;
          leave = whole_or_null (path ^ "[2]") leave }
    | _ -> shape path "an array of a resource, a tick and a tick or null"
  in
  let plan path json =
    let field = fields path ~required:[ "robot"; "visits" ] ~optional:[] json in
    { Law.plan_robot = required field "robot" robot; visits = required field "visits" (elements visit) }
  in
  let field = fields path ~required:[ "format"; "plans"; "order"; "unplanned" ] ~optional:[ "$schema" ] json in
  ignore (present field "$schema" text);
  { Law.plans = required field "plans" (elements plan);
    order = required field "order" (elements robot);
    unplanned = required field "unplanned" (elements robot) }

(* ---- Bounds ---- *)

(* The proofs of cuts, which are horizons and an order that need not fit the cut and a refutation, and the refutations of
   deadlines, in the document's order. *)
type bound = {
  certificate : Bound.certificate;
  named_instance : string;
  of_cuts : (Z.t list * Z.t list * string) list;
  of_deadlines : string list;
}

let bound_of_json { resource_numbers; robot_numbers; group_numbers; _ } path json =
  require_format path "carproof-bound/1" json;
  let robot path json = number robot_numbers (id path json) in
  let resource path json = number resource_numbers (id path json) in
  let resource_price path (json : Yojson.Safe.t) =
    match json with
    | `List [ place; tick; amount ] ->
        { Prices.place = resource (path ^ "[0]") place; other = None;
          tick = whole (path ^ "[1]") tick; amount = whole (path ^ "[2]") amount }
    | _ -> shape path "an array of a resource, a tick and a price"
  in
  let exchange_price path (json : Yojson.Safe.t) =
    match json with
    | `List [ place; other; tick; amount ] ->
        { Prices.place = resource (path ^ "[0]") place; other = Some (resource (path ^ "[1]") other);
          tick = whole (path ^ "[2]") tick; amount = whole (path ^ "[3]") amount }
    | _ -> shape path "an array of two resources, a tick and a price"
  in
  let group_price path (json : Yojson.Safe.t) =
    match json with
    | `List [ group; tick; amount ] ->
        { Prices.priced_group = number group_numbers (id (path ^ "[0]") group);
          group_tick = whole (path ^ "[1]") tick; group_amount = whole (path ^ "[2]") amount }
    | _ -> shape path "an array of a group, a tick and a price"
  in
  let cut path json =
    let names = [ "robots"; "least"; "multiplier"; "horizons"; "order"; "refutation" ] in
    let field = fields path ~required:names ~optional:[] json in
    ( { Bound.members = required field "robots" (elements robot);
        least_total = required field "least" whole;
        multiplier = required field "multiplier" whole },
      (required field "horizons" (elements whole), required field "order" (elements whole),
        required field "refutation" text) )
  in
  let sight path (json : Yojson.Safe.t) =
    match json with
    | `List [ tick; places ] ->
        { Bound.seen_at = whole (path ^ "[0]") tick; spots = elements resource (path ^ "[1]") places }
    | _ -> shape path "an array of a tick and an array of resources"
  in
  let group path json =
    let field = fields path ~required:[ "robots"; "ticks"; "price"; "refutation" ] ~optional:[ "seen" ] json in
    let robots = required field "robots" (elements robot) and ticks = required field "ticks" (elements whole) in
    let sights = optional [] field "seen" (elements sight) in
    let seen = if sights = [] then List.map (fun _ -> None) robots else List.map Option.some sights in
    let is_of_each_robot = List.compare_lengths robots ticks = 0 && List.compare_lengths robots seen = 0 in
    let deadline (who, due) seen = { Bound.who; due; seen } in
    (* Without a tick, or a sight, for each robot it is a group of no robots, which bound/deadline refuses. *)
    let deadlines = if is_of_each_robot then List.map2 deadline (List.combine robots ticks) seen else [] in
    ({ Bound.deadlines; fee = required field "price" whole }, required field "refutation" text)
  in
  let claim path (json : Yojson.Safe.t) =
    match json with
    | `List [ named; least ] -> (robot (path ^ "[0]") named, whole_or_null (path ^ "[1]") least)
    | _ -> shape path "an array of a robot and a whole number or null"
  in
  let names = [ "format"; "instance"; "bound"; "scale"; "horizon"; "resources"; "exchanges"; "cuts"; "robots" ] in
  let field = fields path ~required:names ~optional:[ "deadlines"; "groups" ] json in
  let cuts = required field "cuts" (elements cut) in
  let groups = optional [] field "deadlines" (elements group) in
  let resource_prices = required field "resources" (elements resource_price) in
  let exchange_prices = required field "exchanges" (elements exchange_price) in
  { certificate =
      { Bound.bound = required field "bound" whole;
        scale = required field "scale" whole;
        price_horizon = required field "horizon" natural;
        prices = List.rev_append (List.rev resource_prices) exchange_prices;
        cuts = List.map fst cuts;
        claims = required field "robots" (elements claim);
        groups = List.map fst groups;
        group_prices = optional [] field "groups" (elements group_price) };
    named_instance = required field "instance" text;
    of_cuts = List.map snd cuts;
    of_deadlines = List.map snd groups }

(* ---- Queries ---- *)

(* The certificate of a query, its robot, and the tick at which it is planned. *)
type query = { query_robot : Z.t; now : Z.t; query_certificate : QueryCertificate.certificate }

let query_of_json { resource_numbers; robot_numbers; _ } path json =
  require_format path "carproof-query/1" json;
  let place_and_tick path (json : Yojson.Safe.t) =
    match json with
    | `List [ place; tick ] -> (number resource_numbers (id (path ^ "[0]") place), whole (path ^ "[1]") tick)
    | _ -> shape path "an array of a resource and a whole number"
  in
  let layer field =
    { QueryCertificate.labels = required field "labels" (elements place_and_tick);
      potential = required field "potential" (elements place_and_tick) }
  in
  let served path json = layer (fields path ~required:[ "labels"; "potential" ] ~optional:[] json) in
  let names = [ "format"; "robot"; "now"; "bound"; "labels"; "potential" ] in
  let field = fields path ~required:names ~optional:[ "served" ] json in
  { query_robot = number robot_numbers (required field "robot" id);
    now = required field "now" natural;
    query_certificate =
      { QueryCertificate.bound = required field "bound" whole_or_null;
        layers = layer field :: optional [] field "served" (elements served) } }

(* ---- Proofs of optima ---- *)

(* The claim of a manifest: that no plans cost less, or that there are none at all; with what its formula is made of. *)
type claim = { cost : Z.t option; evidence : Encoder.evidence }

let claim_of_json { instance; _ } path json =
  require_format path "carproof-proof/2" json;
  let robots = List.length instance.robots in
  let small path json =
    let n = natural path json in
    if Z.fits_int n then Z.to_int n else shape path "a whole number that fits into memory"
  in
  let horizons path json =
    let found = elements small path json in
    if List.length found <> robots then shape path (Printf.sprintf "a horizon of each of %d robots" robots);
    found
  in
  let order path json =
    let found = elements small path json in
    if List.sort compare found <> List.init robots Fun.id then shape path "each robot's position, from 0, once";
    found
  in
  let digests path = function `Assoc _ -> () | _ -> shape path "an object" in
  let required_fields = [ "format"; "claim"; "sha256" ] in
  let field = fields path ~required:required_fields ~optional:[ "cost"; "horizons"; "order"; "obstacle" ] json in
  required field "sha256" digests;
  match required field "claim" text with
  | "optimum" ->
      let field = fields path ~required:("cost" :: "horizons" :: "order" :: required_fields) ~optional:[] json in
      let evidence = { Encoder.horizons = required field "horizons" horizons; order = required field "order" order } in
      { cost = Some (required field "cost" natural); evidence }
  | "unsolvable" ->
      let obstacle path json =
        let field = fields path ~required:[ "kind" ] ~optional:[ "horizons"; "robot"; "goal" ] json in
        if required field "kind" text <> "clauses" then
          refuse (path ^ ".kind") "limit/obstacle" "the obstacle must be clauses: the kernel decides no other";
        required (fields path ~required:[ "kind"; "horizons" ] ~optional:[] json) "horizons" horizons
      in
      let field = fields path ~required:("obstacle" :: required_fields) ~optional:[] json in
      { cost = None; evidence = { horizons = required field "obstacle" obstacle; order = [] } }
  | _ -> shape (path ^ ".claim") "\"optimum\" or \"unsolvable\""

(* ---- Formulas and refutations ---- *)

(* The words of each line that is neither empty nor a comment. *)
let lines_of_words contents =
  let words line = List.filter (( <> ) "") (String.split_on_char ' ' (String.trim line)) in
  let is_text = function [] -> false | first :: _ -> first.[0] <> 'c' in
  List.filter is_text (List.concat_map (fun line -> [ words line ]) (String.split_on_char '\n' contents))

let whole_of_word word =
  let sign = if String.starts_with ~prefix:"-" word then 1 else 0 in
  let digits = String.length word - sign in
  let is_digit c = c >= '0' && c <= '9' in
  if digits < 1 || digits > most_digits || not (String.for_all is_digit (String.sub word sign digits)) then
    shape "$" (Printf.sprintf "a whole number, not %S" word);
  Z.of_string word

(* The clauses of a formula in DIMACS: its header must count them, and the variables. *)
let formula_of_text contents =
  let rec clauses done_ clause = function
    | [] -> if clause = [] then List.rev done_ else shape "$" "a 0 at the end of the last clause"
    | literal :: rest when Z.equal literal Z.zero -> clauses (List.rev clause :: done_) [] rest
    | literal :: rest -> clauses done_ (literal :: clause) rest
  in
  match lines_of_words contents with
  | [ "p"; "cnf"; variables; count ] :: rest ->
      let variables = whole_of_word variables and literals = List.concat_map (List.map whole_of_word) rest in
      if List.exists (fun literal -> Z.gt (Z.abs literal) variables) literals then
        shape "$" "no variable beyond those counted";
      let formula = clauses [] [] literals in
      if not (Z.equal (whole_of_word count) (Z.of_int (List.length formula))) then
        shape "$" "as many clauses as are counted";
      formula
  | _ -> shape "$" "the header p cnf VARIABLES CLAUSES"

(* The words of a proof's lines, with one space between two; whether they make steps, the kernel decides. *)
let proof_of_text contents =
  let word = function
    | "d" -> Refutation.Letter_d
    | word ->
        let n = whole_of_word word in
        if Z.to_string n <> word || String.length (Z.to_string (Z.abs n)) > 18 then
          shape "$" (Printf.sprintf "a whole number of at most 18 digits, not %S" word);
        Refutation.Number n
  in
  let length = String.length contents in
  let ended = length > 0 && contents.[length - 1] = '\n' in
  let lines = String.split_on_char '\n' (if ended then String.sub contents 0 (length - 1) else contents) in
  if length = 0 then [] else List.rev (List.rev_map (fun line -> List.map word (String.split_on_char ' ' line)) lines)
