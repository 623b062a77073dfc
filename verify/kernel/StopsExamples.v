(** Planted errors: plans that pass a stop, cut it short or serve stops in another order are refused. The cases are
    those of spec/carp_spec/vectors/plan-stops.json and instance-stops.json, with a, b, c, d as 0, 1, 2, 3. *)
Require Import ZArith List.
From Carproof Require Import Law Checker.
Import ListNotations.
Open Scope Z_scope.

(** Four places in a row, and a robot. *)
Definition row (after_ : after) (a : robot) : instance :=
  Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1] [(0, 1); (1, 2); (2, 3)] false []
    after_ false [a].

(** Visits without a pause: each place, with its ticks. *)
Fixpoint visits_from (tick : Z) (places : list (Z * Z)) : list visit :=
  match places with
  | [] => []
  | (place, ticks) :: later => Visit place tick (Some (tick + ticks)) :: visits_from (tick + ticks) later
  end.

Definition keeps_the_law (i : instance) (vs : list visit) : bool := solution_accepted i (Solution [Plan 1 vs] [1] []).
Definition serves_in_row (from : Z) (ss : list stop) (pace_ : Z) (places : list (Z * Z)) : bool :=
  keeps_the_law (row Vanish (Robot 1 from ss 0 pace_)) (visits_from 0 places).

(** * plan/stops *)

Definition pick_and_drop : list stop := [Stop 2 3; Stop 0 0].

Example picks_and_drops : serves_in_row 0 pick_and_drop 1 [(0, 1); (1, 1); (2, 3); (1, 1); (0, 1)] = true.
Proof. vm_compute. reflexivity. Qed.
Example stop_left_out : serves_in_row 0 pick_and_drop 1 [(0, 1)] = false.
Proof. vm_compute. reflexivity. Qed.
Example service_cut_short : serves_in_row 0 pick_and_drop 1 [(0, 1); (1, 1); (2, 2); (1, 1); (0, 1)] = false.
Proof. vm_compute. reflexivity. Qed.
Example service_in_two_visits :
  serves_in_row 0 pick_and_drop 1 [(0, 1); (1, 1); (2, 2); (3, 1); (2, 1); (1, 1); (0, 1)] = false.
Proof. vm_compute. reflexivity. Qed.

Example wrong_order : serves_in_row 0 [Stop 2 0; Stop 1 0; Stop 3 0] 1 [(0, 1); (1, 1); (2, 1); (3, 1)] = false.
Proof. vm_compute. reflexivity. Qed.
Example right_order :
  serves_in_row 0 [Stop 2 0; Stop 1 0; Stop 3 0] 1 [(0, 1); (1, 1); (2, 1); (1, 1); (2, 1); (3, 1)] = true.
Proof. vm_compute. reflexivity. Qed.

(** One visit serves one stop. *)
Example last_visit_serves_one : serves_in_row 0 [Stop 1 0; Stop 0 0; Stop 1 0] 1 [(0, 1); (1, 1)] = false.
Proof. vm_compute. reflexivity. Qed.
Example same_place_twice :
  serves_in_row 0 [Stop 1 0; Stop 0 0; Stop 1 0] 1 [(0, 1); (1, 1); (0, 1); (1, 1)] = true.
Proof. vm_compute. reflexivity. Qed.

Example serves_at_the_start : serves_in_row 0 [Stop 0 2; Stop 2 0] 1 [(0, 2); (1, 1); (2, 1)] = true.
Proof. vm_compute. reflexivity. Qed.
Example passes_first : serves_in_row 1 [Stop 1 4; Stop 3 0] 1 [(1, 1); (0, 1); (1, 4); (2, 1); (3, 1)] = true.
Proof. vm_compute. reflexivity. Qed.
Example service_is_not_paced : serves_in_row 0 [Stop 1 2; Stop 2 0] 3 [(0, 3); (1, 3); (2, 3)] = true.
Proof. vm_compute. reflexivity. Qed.

(** * plan/goal *)

(** The last visit of a robot that vanishes takes exactly as long as the last stop. *)
Example last_service :
  map (fun ticks => serves_in_row 0 [Stop 1 4] 3 [(0, 3); (1, ticks)]) [3; 4; 5] = [false; true; false].
Proof. vm_compute. reflexivity. Qed.
Example last_duration :
  map (fun ticks => serves_in_row 0 [Stop 1 2] 3 [(0, 3); (1, ticks)]) [2; 3; 4] = [false; true; false].
Proof. vm_compute. reflexivity. Qed.
Example parks :
  map (fun last =>
      keeps_the_law (row Park (Robot 1 0 [Stop 2 2; Stop 1 5] 0 1)) (visits_from 0 [(0, 1); (1, 1); (2, 2)] ++ [last]))
    [Visit 1 4 None; Visit 1 4 (Some 9); Visit 3 4 None]
  = [true; false; false].
Proof. vm_compute. reflexivity. Qed.

(** * instance/stops *)

Example stops_of_instances :
  map (fun ss => instance_accepted (row Vanish (Robot 1 0 ss 0 1)))
    [[Stop 0 0; Stop 2 0; Stop 0 2]; []; [Stop 4 0; Stop 2 0]; [Stop 1 0; Stop 4 0]; [Stop 1 (-1); Stop 2 0];
     [Stop 1 0; Stop 2 3; Stop 2 0]]
  = [true; false; false; false; false; false].
Proof. vm_compute. reflexivity. Qed.
