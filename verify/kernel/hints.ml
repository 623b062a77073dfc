(* Finds the hints of a refutation that has none (DRAT without RAT steps). Nothing here is trusted.

   Deletions are passed over. Each added clause is shown by unit propagation with two watched literals a clause. *)

exception Refuted of int list
exception Not_found_out of string

type clauses = {
  mutable all : int array array; (* by number, from 1 *)
  mutable count : int;
  watched : (int, int list) Hashtbl.t; (* the clauses that watch a literal *)
  values : (int, bool) Hashtbl.t; (* of literals *)
  reasons : (int, int) Hashtbl.t; (* the clause that made a literal true *)
  mutable trail : int list; (* true literals, the last first *)
}

let is_false state literal = Hashtbl.find_opt state.values literal = Some false
let is_true state literal = Hashtbl.find_opt state.values literal = Some true
let watching state literal = Option.value ~default:[] (Hashtbl.find_opt state.watched literal)

let assign state literal =
  Hashtbl.replace state.values literal true;
  Hashtbl.replace state.values (-literal) false;
  state.trail <- literal :: state.trail

(* A clause after a literal became false: move its watch, make its other watched literal true, or find it all false. *)
let visit state false_literal number =
  let clause = state.all.(number) in
  let swap i j = let kept = clause.(i) in clause.(i) <- clause.(j); clause.(j) <- kept in
  if clause.(0) = false_literal then swap 0 1;
  if is_true state clause.(0) then `Keep
  else
    let rec free k =
      if k = Array.length clause then None else if is_false state clause.(k) then free (k + 1) else Some k
    in
    match free 2 with
    | Some k -> swap 1 k; Hashtbl.replace state.watched clause.(1) (number :: watching state clause.(1)); `Move
    | None when is_false state clause.(0) -> `Conflict
    | None -> assign state clause.(0); Hashtbl.replace state.reasons clause.(0) number; `Keep

(* Make true what follows from the literals given; the clause that is all false, if there is one. *)
let rec propagate state = function
  | [] -> None
  | literal :: rest ->
      let before = state.trail in
      let rec each kept = function
        | [] -> Hashtbl.replace state.watched (-literal) kept; None
        | number :: others -> (
            match visit state (-literal) number with
            | `Keep -> each (number :: kept) others
            | `Move -> each kept others
            | `Conflict -> Hashtbl.replace state.watched (-literal) (List.rev_append kept (number :: others));
              Some number)
      in
      (match each [] (watching state (-literal)) with
      | Some number -> Some number
      | None ->
          let rec fresh trail = if trail == before then [] else List.hd trail :: fresh (List.tl trail) in
          propagate state (List.rev_append (List.rev rest) (List.rev (fresh state.trail))))

let back_to state trail =
  while state.trail != trail do
    let literal = List.hd state.trail in
    List.iter (Hashtbl.remove state.values) [ literal; -literal ];
    Hashtbl.remove state.reasons literal;
    state.trail <- List.tl state.trail
  done

(* The clauses that made a clause all false, in the order of propagation, and that clause. *)
let hints_of state conflict =
  let needed = Hashtbl.create 64 in
  let need number = Array.iter (fun literal -> Hashtbl.replace needed (-literal) ()) state.all.(number) in
  need conflict;
  let add hints literal =
    match Hashtbl.find_opt state.reasons literal with
    | Some number when Hashtbl.mem needed literal -> need number; number :: hints
    | _ -> hints
  in
  List.fold_left add [ conflict ] state.trail

(* Keep a clause; what follows from it alone stays true. *)
let keep state clause =
  let clause = Array.of_list (List.sort_uniq compare clause) in
  let free, others = List.partition (fun literal -> not (is_false state literal)) (Array.to_list clause) in
  let clause = Array.of_list (free @ others) in
  state.count <- state.count + 1;
  if state.count >= Array.length state.all then
    state.all <- Array.append state.all (Array.make (Array.length state.all) [||]);
  let number = state.count in
  state.all.(number) <- clause;
  if Array.length clause > 1 then
    List.iter (fun k -> Hashtbl.replace state.watched clause.(k) (number :: watching state clause.(k))) [ 0; 1 ];
  match free with
  | [] -> raise (Refuted (hints_of state number))
  | [ literal ] when not (is_true state literal) -> (
      assign state literal;
      Hashtbl.replace state.reasons literal number;
      match propagate state [ literal ] with
      | Some conflict -> raise (Refuted (hints_of state conflict))
      | None -> ())
  | _ -> ()

let words numbers = List.map (fun n -> Refutation.Number (Z.of_int n)) numbers

(* The lines of a proof with hints, from a formula and the clauses that a proof adds. *)
let with_hints formula added =
  let state =
    { all = Array.make 1024 [||]; count = 0; watched = Hashtbl.create 1024; values = Hashtbl.create 1024;
      reasons = Hashtbl.create 1024; trail = [] }
  in
  let lines = ref [] in
  let line number clause hints = lines := words ((number :: clause) @ (0 :: hints) @ [ 0 ]) :: !lines in
  let add clause =
    if not (List.exists (is_true state) clause) then (
      let trail = state.trail in
      let free = List.filter (fun literal -> not (is_false state literal)) (List.sort_uniq compare clause) in
      let denied = List.map Int.neg free in
      List.iter (assign state) denied;
      match propagate state denied with
      | None -> raise (Not_found_out "a clause of the refutation does not follow by unit propagation")
      | Some conflict ->
          let hints = hints_of state conflict in
          back_to state trail;
          line (state.count + 1) clause hints;
          keep state clause)
  in
  try
    List.iter (keep state) formula;
    List.iter add added;
    raise (Not_found_out "the refutation does not come to the empty clause")
  with Refuted hints -> line (state.count + 1) [] hints; List.rev !lines

(* The clauses that a DRAT proof adds. *)
let added_clauses contents =
  let clause words =
    match List.rev_map Z.to_int (List.map Reading.whole_of_word words) with
    | 0 :: literals -> List.rev literals
    | _ -> raise (Not_found_out "each line of the refutation must end with 0")
  in
  List.filter_map (function "d" :: _ -> None | words -> Some (clause words)) (Reading.lines_of_words contents)

let lines formula refutation =
  with_hints (List.map (List.map Z.to_int) formula) (added_clauses refutation)
