(** What is extracted to OCaml: whole numbers of any size become those of zarith. *)
Require Import ExtrOcamlBasic ExtrOcamlZBigInt ZArith.
From Carproof Require Import Refutation.

(** Comparisons without a detour; the library maps only [Z.compare] and [Z.eqb]. *)
Extract Constant Z.leb => "Big_int_Z.le_big_int".
Extract Constant Z.ltb => "Big_int_Z.lt_big_int".

Extraction Language OCaml.
Extraction "kernel.ml" refutes.
