(** The query answers published vectors (spec/carp_spec/vectors/query-*.json). Resources and robots have their positions
    in the instance as ids. *)
Require Import ZArith List.
From Carproof Require Import Law Query.
Import ListNotations.
Open Scope Z_scope.

(** The least cost of a plan of the robot. *)
Definition least_cost (i : instance) (committed : list plan) (a : robot) (now : Z) (followed : option plan) :=
  option_map (cost a) (query i committed a now followed).

(** query-sound.lets-pass: both stand in one place of capacity two and leave it by turns. *)
Example lets_pass :
  least_cost (Instance [Resource 0 2 1; Resource 1 2 1]
      [(0, 1)] false [] Vanish false [Robot 0 0 (only 1) 0 1; Robot 1 1 (only 0) 0 1])
    [Plan 1 [Visit 1 0 (Some 1); Visit 0 1 (Some 2)]] (Robot 0 0 (only 1) 0 1) 0 None
  = (Some 2).
Proof. vm_compute. reflexivity. Qed.

(** query-sound.appears-at-now: it stood at its start before, where r2 went through. *)
Example appears_at_now :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1; Resource 4 1 1]
      [(0, 1); (1, 2); (3, 0); (0, 4)] false [] Vanish false [Robot 0 0 (only 2) 0 1; Robot 1 3 (only 4) 0 1])
    [Plan 1 [Visit 3 0 (Some 1); Visit 0 1 (Some 2); Visit 4 2 (Some 3)]] (Robot 0 0 (only 2) 0 1) 6 None
  = None.
Proof. vm_compute. reflexivity. Qed.

(** query-optimal.uses-a-gap: x is free for just as long as it needs. *)
Example uses_a_gap :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 3; Resource 2 1 1; Resource 3 1 1; Resource 4 1 1]
      [(0, 1); (1, 2); (3, 1); (1, 4)] false [] Vanish false [Robot 0 0 (only 2) 0 1; Robot 1 3 (only 4) 1 1])
    [Plan 1 [Visit 3 1 (Some 4); Visit 1 4 (Some 7); Visit 4 7 (Some 8)]] (Robot 0 0 (only 2) 0 1) 0 None
  = (Some 4).
Proof. vm_compute. reflexivity. Qed.

(** query-optimal.moves-aside-and-comes-back: it arrives, makes room, and arrives for good. *)
Example moves_aside_and_comes_back :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1; Resource 4 1 1]
      [(0, 1); (1, 2); (3, 2); (2, 4)] false [] Park false [Robot 0 0 (only 2) 0 1; Robot 1 3 (only 4) 4 1])
    [Plan 1 [Visit 3 4 (Some 5); Visit 2 5 (Some 6); Visit 4 6 None]] (Robot 0 0 (only 2) 0 1) 0 None
  = (Some 6).
Proof. vm_compute. reflexivity. Qed.

(** query-optimal.slow-robot: its pace lengthens every stay, and the gap in x is too short for it. *)
Example slow_robot :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1; Resource 4 1 1]
      [(0, 1); (1, 2); (3, 1); (1, 4)] false [] Vanish false [Robot 0 0 (only 2) 0 2; Robot 1 3 (only 4) 2 1])
    [Plan 1 [Visit 3 2 (Some 3); Visit 1 3 (Some 4); Visit 4 4 (Some 5)]] (Robot 0 0 (only 2) 0 2) 0 None
  = (Some 6).
Proof. vm_compute. reflexivity. Qed.

(** query-optimal.stay-at-the-goal-too-short: the goal is free for one tick of the two that it needs. *)
Example stay_at_the_goal_too_short :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 2; Resource 3 1 1]
      [(0, 1); (1, 2); (3, 2)] false [] Vanish false [Robot 0 0 (only 2) 0 1; Robot 1 3 (only 2) 2 1])
    [Plan 1 [Visit 3 2 (Some 3); Visit 2 3 (Some 5)]] (Robot 0 0 (only 2) 0 1) 0 None
  = (Some 5).
Proof. vm_compute. reflexivity. Qed.

(** query-complete.head-on-in-a-lane: there is no place to pass. *)
Example head_on_in_a_lane :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1]
      [(0, 1); (1, 2)] false [] Vanish false [Robot 0 0 (only 2) 0 1; Robot 1 2 (only 0) 0 1])
    [Plan 1 [Visit 2 0 (Some 1); Visit 1 1 (Some 2); Visit 0 2 (Some 3)]] (Robot 0 0 (only 2) 0 1) 0 None
  = None.
Proof. vm_compute. reflexivity. Qed.

(** query-complete.way-back-over-the-start: it must return to where it was to let the other pass. *)
Example way_back_over_the_start :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1]
      [(0, 1); (1, 2); (1, 3)] false [] Park false [Robot 0 1 (only 1) 0 1; Robot 1 0 (only 2) 0 1])
    [Plan 1 [Visit 0 0 (Some 1); Visit 1 1 (Some 2); Visit 2 2 None]] (Robot 0 1 (only 1) 0 1) 0 None
  = (Some 2).
Proof. vm_compute. reflexivity. Qed.

(** query-complete.own-plan-taken-for-another-s: it avoids its own reservations. *)
Example own_plan_taken_for_another_s :
  least_cost (Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1; Resource 3 1 1]
      [(0, 1); (1, 2); (1, 3)] false [] Vanish false [Robot 0 0 (only 2) 0 1; Robot 1 1 (only 3) 0 1])
    [Plan 1 [Visit 1 0 (Some 6); Visit 3 6 (Some 7)]] (Robot 0 0 (only 2) 0 1) 3
    (Some (Plan 0 [Visit 0 0 (Some 6); Visit 1 6 (Some 7); Visit 2 7 (Some 8)]))
  = (Some 7).
Proof. vm_compute. reflexivity. Qed.
