(** Planted errors: certificates with stops that claim too much, or say too little, are refused. The robot goes from the
    first of four places in a row to the third, is served there for three ticks, and comes back: it arrives at 6. *)
Require Import ZArith List.
From Carproof Require Import Law Checker QueryCertificate Audit StopsExamples.
Import ListNotations.
Open Scope Z_scope.

Definition verified (bound : Z) (ls : list layer) : bool :=
  query_accepted (row Vanish (Robot 1 0 pick_and_drop 0 1)) (Solution [] [] [1]) 1 0 (Certificate (Some bound) ls).

(** * Potentials *)

(** With potentials that count all that is left to do, nothing needs a label. *)
Definition before_the_pick : list (Z * Z) := [(0, 6); (1, 5); (2, 4); (3, 5)].
Definition behind_the_pick : list (Z * Z) := [(0, 0); (1, 1); (2, 2); (3, 3)].

Example potentials_prove_the_arrival : verified 6 [Layer [] before_the_pick; Layer [] behind_the_pick] = true.
Proof. vm_compute. reflexivity. Qed.
Example service_counted_too_long :
  verified 7 [Layer [] (map (fun each => (fst each, snd each + 1)) before_the_pick); Layer [] behind_the_pick] = false.
Proof. vm_compute. reflexivity. Qed.
Example layers_left_out :
  map (verified 6) [[Layer [] before_the_pick]; [Layer [] behind_the_pick]; []] = [false; false; false].
Proof. vm_compute. reflexivity. Qed.

(** * Labels *)

(** With potentials that leave out the service and the way back, labels tell of them. *)
Definition labelled (bound : Z) (before behind : list (Z * Z)) : bool :=
  verified bound [Layer before [(0, 2); (1, 1); (2, 0); (3, 1)]; Layer behind [(0, 0); (1, 0); (2, 0); (3, 0)]].
Definition on_the_way : list (Z * Z) := [(0, 2); (1, 1); (2, 2); (3, 3)].

Example labels_prove_the_arrival : labelled 6 on_the_way [(2, 4); (1, 5); (3, 5)] = true.
Proof. vm_compute. reflexivity. Qed.
Example no_labels_prove_more : labelled 7 on_the_way [(2, 4); (1, 5); (3, 5); (0, 6)] = false.
Proof. vm_compute. reflexivity. Qed.

(** Behind the stop, the window that it was served in has a label: from it the robot may leave at 5. *)
Example labels_behind_the_stop :
  map (labelled 6 on_the_way) [[(1, 5); (3, 5)]; [(2, 5); (1, 5); (3, 5)]; [(2, 3); (1, 5); (3, 5)]; [(2, 4); (3, 5)]]
  = [false; false; false; false].
Proof. vm_compute. reflexivity. Qed.
