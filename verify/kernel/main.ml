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
  | exception failure -> answer (Undecided ("the program fails: " ^ Printexc.to_string failure))

(* The text of a plain file; it is opened without waiting, and looked at before it is read. *)
let contents file =
  let refuse reason = Reading.refuse "$" "document/json" (Printf.sprintf "%s %s" file reason) in
  match Unix.openfile file [ O_RDONLY; O_NONBLOCK; O_CLOEXEC ] 0 with
  | exception Unix.Unix_error (reason, _, _) -> refuse ("cannot be read: " ^ Unix.error_message reason)
  | descriptor ->
      Fun.protect ~finally:(fun () -> Unix.close descriptor) (fun () ->
          let { Unix.st_kind; st_size; _ } = Unix.fstat descriptor in
          if st_kind <> Unix.S_REG then refuse "must be a plain file";
          if st_size > Reading.largest_document then
            refuse (Printf.sprintf "must have at most %d bytes" Reading.largest_document);
          try really_input_string (Unix.in_channel_of_descr descriptor) st_size
          with Sys_error reason -> refuse reason | End_of_file -> refuse "ends too early")

(* The text of a file of a proof directory, which no link leads out of. *)
let contents_in directory name =
  let file = Filename.concat directory name in
  match (Unix.lstat file).st_kind with
  | Unix.S_LNK -> Reading.refuse "$" "document/json" (file ^ " must be a plain file, not a link")
  | _ -> contents file
  | exception Unix.Unix_error _ -> contents file

let json_of_file file = Reading.json_of_text (contents file)
let instance_of_file file = Reading.instance_of_json "$" (json_of_file file)

(* The instance and the claim of a proof directory. *)
let claim_of_directory directory =
  let json name = Reading.json_of_text (contents_in directory name) in
  let instance = Reading.instance_of_json "$" (json "instance.json") in
  (instance, Reading.claim_of_json instance "$" (json "manifest.json"))

let print_formula ((blueprint : Formula.blueprint), variables) =
  Printf.printf "p cnf %d %d\n" variables (List.length blueprint.formula);
  let print_clause literals = print_string (String.concat " " (List.map Z.to_string literals @ [ "0\n" ])) in
  List.iter print_clause blueprint.formula

(* One request a line: the op, and its documents by their names. *)
let requested line =
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

(* The next line of a channel: none at its end, an error if it is longer than a document may be. *)
let next_line channel =
  let line = Buffer.create 4096 and is_long = ref false in
  let ended () = Some (if !is_long then Error () else Ok (Buffer.contents line)) in
  let rec read () =
    match input_char channel with
    | '\n' -> ended ()
    | byte ->
        if Buffer.length line < Reading.largest_document then Buffer.add_char line byte else is_long := true;
        read ()
    | exception End_of_file -> if Buffer.length line = 0 then None else ended ()
  in
  read ()

let rec serve () =
  match next_line stdin with
  | None -> exit 0
  | Some line ->
      let ask () =
        match line with
        | Ok line -> requested line
        | Error () -> Reading.malformed (Printf.sprintf "it must have at most %d bytes" Reading.largest_document)
      in
      let document, _, _ = answered ask in
      print_endline (Yojson.Safe.to_string document);
      serve ()

let () =
  let print (document, sentence, code) =
    print_endline (Yojson.Safe.to_string document);
    Option.iter prerr_endline sentence;
    exit code
  in
  try match List.tl (Array.to_list Sys.argv) with
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
          let proof = Reading.proof_of_text (contents_in directory "beat.lrat") in
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
  with Sys_error reason -> prerr_endline ("the answer cannot be written: " ^ reason); Unix._exit 2
