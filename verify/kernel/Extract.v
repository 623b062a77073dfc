(** What is extracted to OCaml: whole numbers of any size become those of zarith. *)
Require Import ExtrOcamlBasic ExtrOcamlZBigInt ZArith.
From Carproof Require Import Law Collections Checker QueryCertificate Audit Refutation Labels Tables Bound Formula.

(** Comparisons without a detour; the library maps only [Z.compare] and [Z.eqb]. *)
Extract Constant Z.leb => "Big_int_Z.le_big_int".
Extract Constant Z.ltb => "Big_int_Z.lt_big_int".

Extraction Language OCaml.
Extraction Blacklist Bool Int List Nat Option String.
Separate Extraction only goal instance_accepted solution_accepted solution_cost lookup_of covers_accepted order_accepted
  moves_of_graph plan_of_robot_accepted stay_accepted end_accepted same_end has_move limits_accepted
  resource_limits group_limits exchanges_accepted plans_accepted query_accepted others own certificate_fault audit_accepted audit world_of
  refutes Map.find all_prices broken_rule stay_price wait_price move_price tariff_of resource_table takes_in room_in weight_of
  claim_proved demand_of bound_proved read_step cut_refuted deadlines_refuted blueprint_accepted Numbered.add Map.mem
  Map.add.
