(** The example of docs/explanation/execution.md, with a, b, c as 0, 1, 2, and a rotation. *)
Require Import ZArith List.
From Carproof Require Import Law Execution Dependencies Order Retiming Lateness.
Import ListNotations.
Open Scope Z_scope.

Definition triangle : instance :=
  Instance [Resource 0 1 1; Resource 1 1 1; Resource 2 1 1] [(0, 1); (1, 2); (2, 0)] false [] Vanish false
    [Robot 1 0 (only 1) 0 1; Robot 2 1 (only 0) 0 1].
Definition round : list plan :=
  [Plan 1 [Visit 0 0 (Some 1); Visit 1 1 (Some 2)];
   Plan 2 [Visit 1 0 (Some 1); Visit 2 1 (Some 2); Visit 0 2 (Some 3)]].
Definition trace : list plan :=
  [Plan 1 [Visit 0 0 (Some 2); Visit 1 2 None]; Plan 2 [Visit 1 0 (Some 1); Visit 2 1 None]].

Example dependencies_of_the_triangle :
  map (fun e => (earlier e, later e, ticks e)) (direct_dependencies triangle round)
  = [((1, 0%nat), (1, 1%nat), 1); ((2, 0%nat), (2, 1%nat), 1); ((2, 1%nat), (2, 2%nat), 1);
     ((1, 1%nat), (2, 2%nat), 0); ((2, 1%nat), (1, 1%nat), 0)].
Proof. vm_compute. reflexivity. Qed.

(** At tick 2, r1 is a tick late: r2 can enter a at tick 3. *)
Example retimed_triangle :
  retimed triangle round trace 2
  = [Plan 1 [Visit 0 0 (Some 2); Visit 1 2 (Some 3)];
     Plan 2 [Visit 1 0 (Some 1); Visit 2 1 (Some 3); Visit 0 3 (Some 4)]].
Proof. vm_compute. reflexivity. Qed.

(** A delay of 5 ticks at r1's start makes it 5 ticks late, and r2, which waits for it in a, 4. *)
Example delayed_triangle :
  map (entry_in_order triangle round (fun n => if same n (1, 0%nat) then 5 else 0)) (nodes round)
  = [0; 6; 0; 1; 6].
Proof. vm_compute. reflexivity. Qed.

(** Three robots that enter each other's places at tick 1 wait for each other. *)
Example rotation :
  let turn r s := Plan r [Visit r 0 (Some 1); Visit s 1 (Some 2)] in
  let plans := [turn 0 1; turn 1 2; turn 2 0] in
  is_acyclic (dependencies triangle plans) (nodes plans) = false
  /\ is_acyclic (dependencies triangle round) (nodes round) = true.
Proof. vm_compute. split; reflexivity. Qed.
