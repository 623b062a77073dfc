(* carproof-kernel: reads documents, asks the kernel, and prints one line of JSON.

   Exit codes: 0 accepted, 1 refused, 2 bad input, 3 undecided. *)

let version = "1"

let usage =
  "usage: carproof-kernel check INSTANCE SOLUTION\n\
  \       carproof-kernel verify-bound INSTANCE CERTIFICATE\n\
  \       carproof-kernel verify-query INSTANCE SOLUTION CERTIFICATE\n\
  \       carproof-kernel audit INSTANCE SOLUTION CERTIFICATES\n\
  \       carproof-kernel verify-proof DIRECTORY\n\
  \       carproof-kernel formula DIRECTORY\n\
  \       carproof-kernel refute FORMULA.cnf PROOF.lrat\n\
  \       carproof-kernel serve\n\
  \       carproof-kernel --version\n"

(* What is printed on standard output and on standard error, and the exit code. *)
let answer : Verdicts.verdict -> Yojson.Safe.t * string option * int =
  let document verdict more = `Assoc ([ ("kernel", `String version); ("verdict", `String verdict) ] @ more) in
  let refused rule message = [ ("rule", `String rule); ("message", `String message) ] in
  function
  | Accepted more -> (document "accepted" more, None, 0)
  | Refused (rule, message) ->
      (document "refused" (refused rule message), Some (Printf.sprintf "%s [%s]" message rule), 1)
  | Undecided message -> (document "undecided" [ ("message", `String message) ], Some message, 3)

let bad_input path rule message : Yojson.Safe.t * string option * int =
  ( `Assoc [ ("kernel", `String version); ("verdict", `String "bad input"); ("path", `String path);
             ("rule", `String rule); ("message", `String message) ],
    Some (Printf.sprintf "%s: %s [%s]" path message rule), 2 )

(* Ask, and turn what may go wrong into an answer. *)
let answered ask =
  match answer (ask ()) with
  | result -> result
  | exception Reading.Refused { path; rule; message } -> bad_input path rule message
  | exception (Stack_overflow | Out_of_memory) -> answer (Undecided "the question is too large for the memory")

let contents file =
  let channel = try open_in_bin file with Sys_error reason -> Reading.refuse "$" "document/json" reason in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () ->
      try
        if in_channel_length channel > Reading.largest_document then
          Reading.refuse "$" "document/json"
            (Printf.sprintf "%s must have at most %d bytes" file Reading.largest_document);
        really_input_string channel (in_channel_length channel)
      with Sys_error reason | Failure reason -> Reading.refuse "$" "document/json" reason)

let json_of_file file = Reading.json_of_text (contents file)
let instance_of_file file = Reading.instance_of_json "$" (json_of_file file)

(* The instance and the claim of a proof directory. *)
let claim_of_directory directory =
  let instance = instance_of_file (Filename.concat directory "instance.json") in
  (instance, Reading.claim_of_json instance "$" (json_of_file (Filename.concat directory "manifest.json")))

let print_formula ((blueprint : Formula.blueprint), variables) =
  Printf.printf "p cnf %d %d\n" variables (List.length blueprint.formula);
  let print_clause literals = print_string (String.concat " " (List.map Z.to_string literals @ [ "0\n" ])) in
  List.iter print_clause blueprint.formula

(* One request a line: the op, and its documents by their names. *)
let requested line () =
  let json = Reading.json_of_text line in
  let optional = [ "solution"; "certificate"; "certificates" ] in
  let field = Reading.fields "$" ~required:[ "op"; "instance" ] ~optional json in
  let instance = Reading.required field "instance" Reading.instance_of_json in
  let solution = Reading.present field "solution" (Reading.solution_of_json instance) in
  let certificates = Reading.present field "certificates" (Reading.elements (Reading.query_of_json instance)) in
  match (Reading.required field "op" Reading.text, solution, field "certificate", certificates) with
  | "check", Some solution, None, None -> Verdicts.check instance solution
  | "verify-bound", None, Some (path, json), None ->
      Verdicts.verify_bound instance (Reading.bound_of_json instance path json)
  | "verify-query", Some solution, Some (path, json), None ->
      Verdicts.verify_query instance solution (Reading.query_of_json instance path json)
  | "audit", Some solution, None, Some certificates -> Verdicts.audit instance solution certificates
  | _ -> Reading.shape "$" "a request that the kernel knows, with its documents"

let rec serve () =
  match input_line stdin with
  | line ->
      let document, _, _ = answered (requested line) in
      print_endline (Yojson.Safe.to_string document);
      serve ()
  | exception End_of_file -> exit 0

let () =
  let print (document, sentence, code) =
    print_endline (Yojson.Safe.to_string document);
    Option.iter prerr_endline sentence;
    exit code
  in
  match List.tl (Array.to_list Sys.argv) with
  | [ "--version" ] -> print_endline ("carproof-kernel " ^ version)
  | [ "serve" ] -> serve ()
  | [ "check"; instance; solution ] ->
      print (answered (fun () ->
          let instance = instance_of_file instance in
          Verdicts.check instance (Reading.solution_of_json instance "$" (json_of_file solution))))
  | [ "verify-query"; instance; solution; certificate ] ->
      print (answered (fun () ->
          let instance = instance_of_file instance in
          let solution = Reading.solution_of_json instance "$" (json_of_file solution) in
          Verdicts.verify_query instance solution (Reading.query_of_json instance "$" (json_of_file certificate))))
  | [ "audit"; instance; solution; certificates ] ->
      print (answered (fun () ->
          let instance = instance_of_file instance in
          let solution = Reading.solution_of_json instance "$" (json_of_file solution) in
          let query = Reading.query_of_json instance in
          Verdicts.audit instance solution (Reading.elements query "$" (json_of_file certificates))))
  | [ "verify-bound"; instance; certificate ] ->
      print (answered (fun () ->
          let instance = instance_of_file instance in
          Verdicts.verify_bound instance (Reading.bound_of_json instance "$" (json_of_file certificate))))
  | [ "verify-proof"; directory ] ->
      print (answered (fun () ->
          let instance, claim = claim_of_directory directory in
          let proof = Reading.proof_of_text (contents (Filename.concat directory "beat.lrat")) in
          Verdicts.verify_proof instance claim proof))
  | [ "formula"; directory ] ->
      let made = ref None in
      let ask () =
        let instance, claim = claim_of_directory directory in
        match Verdicts.blueprint_of_claim instance claim with
        | Error verdict -> verdict
        | Ok formula -> made := Some formula; Verdicts.Accepted []
      in
      let answer = answered ask in
      (match !made with Some formula -> print_formula formula | None -> print answer)
  | [ "refute"; formula; proof ] ->
      print (answered (fun () ->
          Verdicts.refute (Reading.formula_of_text (contents formula)) (Reading.proof_of_text (contents proof))))
  | _ -> prerr_string usage; exit 2
