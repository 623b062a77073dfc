(** Refutations with hints: LRAT without RAT steps, with deletions.

    A formula is a list of clauses, numbered 1, 2, ... in its order. A proof adds clauses, each with the numbers of
    clauses that show it by unit propagation in the order given, until it adds the empty clause. *)
Require Import ZArith List Bool Lia.
Require Import FMapAVL FMapFacts OrderedTypeEx MSetAVL OrdersEx.
Import ListNotations.
Open Scope Z_scope.

Module Numbered := FMapAVL.Make OrderedTypeEx.Z_as_OT.
Module Numbered_facts := FMapFacts.Facts Numbered.
Module Literals := MSetAVL.Make OrdersEx.Z_as_OT.

(** * What a formula means *)

(** A literal as DIMACS writes it: the variable n, or its negation -n. *)
Definition literal := Z.
Definition clause := list literal.

(** The literal is true where [v] says which variables are. 0 is no literal, and never true. *)
Definition True_in (v : Z -> bool) (l : literal) : Prop := (0 < l /\ v l = true) \/ (l < 0 /\ v (- l) = false).

Definition Satisfies (v : Z -> bool) (c : clause) : Prop := exists l, In l c /\ True_in v l.

(** No choice of true variables makes every clause true. *)
Definition Unsatisfiable (formula : list clause) : Prop := forall v, ~ (forall c, In c formula -> Satisfies v c).

(** * The checker *)

(** A line of a proof: a clause with its number and hints, or the numbers of clauses that are not used any more. *)
Inductive step := Add (number : Z) (added : clause) (hints : list Z) | Delete (numbers : list Z).

(** A word of a line: a whole number, or the letter d. *)
Inductive word := Number (n : Z) | Letter_d.

(** The numbers before the first 0, and the words after it. *)
Fixpoint until_zero (words : list word) (before : list Z) : option (list Z * list word) :=
  match words with
  | Number n :: rest => if n =? 0 then Some (rev' before, rest) else until_zero rest (n :: before)
  | _ => None
  end.

(** Read a line: "number literals 0 hints 0" or "number d numbers 0". Clauses have numbers above 0. *)
Definition read_step (line : list word) : option step :=
  match line with
  | Number number :: Letter_d :: rest =>
      match until_zero rest [] with
      | Some (numbers, []) => if forallb (Z.ltb 0) (number :: numbers) then Some (Delete numbers) else None
      | _ => None
      end
  | Number number :: rest =>
      match until_zero rest [] with
      | Some (added, hinted) =>
          match until_zero hinted [] with
          | Some (hints, []) => if forallb (Z.ltb 0) (number :: hints) then Some (Add number added hints) else None
          | _ => None
          end
      | None => None
      end
  | _ => None
  end.

(** A clause where some literals are known: all of them are false, all but one are, or neither. *)
Inductive reduced := All_false | All_but (l : literal) | Open.

(** Reduce a clause by the literals [known] to be true, in one pass; [left] is one that is not known to be false. *)
Fixpoint reduce (known : Literals.t) (left : option literal) (c : clause) : reduced :=
  match c with
  | [] => match left with None => All_false | Some l => All_but l end
  | l :: rest =>
      if Literals.mem (- l) known then reduce known left rest
      else match left with
           | None => reduce known (Some l) rest
           | Some other => if l =? other then reduce known left rest else Open
           end
  end.

(** Follow the hints: each is a clause with one literal that may be true, which so is; the last has none. *)
Fixpoint propagate (clauses : Numbered.t clause) (known : Literals.t) (hints : list Z) : bool :=
  match hints with
  | [] => false
  | hint :: rest =>
      match Numbered.find hint clauses with
      | None => false
      | Some c =>
          match reduce known None c with
          | All_false => true
          | All_but l => propagate clauses (Literals.add l known) rest
          | Open => false
          end
      end
  end.

(** The literals of a clause, all taken to be false. *)
Definition denied (c : clause) : Literals.t := fold_left (fun known l => Literals.add (- l) known) c Literals.empty.

Definition has_no_zero (c : clause) : bool := forallb (fun l => negb (l =? 0)) c.

(** The clauses follow line by line, each with a number above the last one, and the clause of the last line is empty. *)
Fixpoint accepts (last : Z) (clauses : Numbered.t clause) (lines : list (list word)) : bool :=
  match lines with
  | [] => false
  | line :: rest =>
      match read_step line with
      | None => false
      | Some (Delete numbers) => accepts last (fold_left (fun kept n => Numbered.remove n kept) numbers clauses) rest
      | Some (Add number added hints) =>
          if has_no_zero added && (last <? number) && propagate clauses (denied added) hints
          then match added, rest with
               | [], [] => true
               | [], _ => false
               | _, _ => accepts number (Numbered.add number added clauses) rest
               end
          else false
      end
  end.

Fixpoint numbered (formula : list clause) (number : Z) (clauses : Numbered.t clause) : Numbered.t clause :=
  match formula with
  | [] => clauses
  | c :: rest => numbered rest (number + 1) (Numbered.add number c clauses)
  end.

(** The lines are a refutation of the formula. *)
Definition refutes (formula : list clause) (lines : list (list word)) : bool :=
  accepts (fold_left (fun n _ => n + 1) formula 0) (numbered formula 1 (Numbered.empty clause)) lines.

(** * Why it is right *)

Section Valuation.
Variable v : Z -> bool.

Lemma opposites_are_not_both_true l : True_in v l -> True_in v (- l) -> False.
Proof. unfold True_in. rewrite Z.opp_involutive. intuition (try lia; congruence). Qed.

Lemma one_of_opposites_is_true l : l <> 0 -> True_in v l \/ True_in v (- l).
Proof.
  unfold True_in. rewrite Z.opp_involutive. intros H.
  destruct (Z.lt_total l 0) as [L | [L | L]]; [| lia |]; [destruct (v (- l)) eqn:E | destruct (v l) eqn:E];
    intuition (try lia; auto).
Qed.

Definition All_true (known : Literals.t) : Prop := forall l, Literals.mem l known = true -> True_in v l.
Definition All_satisfied (clauses : Numbered.t clause) : Prop :=
  forall n c, Numbered.find n clauses = Some c -> Satisfies v c.

Lemma known_literal_is_added l known : True_in v l -> All_true known -> All_true (Literals.add l known).
Proof.
  intros Hl H k Hk. apply Literals.mem_spec, Literals.add_spec in Hk as [-> | Hk]; auto.
  apply H, Literals.mem_spec, Hk.
Qed.

(** The literals that are left hold a true one. *)
Lemma reduced_clause_is_satisfied known c left : All_true known ->
  (Satisfies v c \/ exists l, left = Some l /\ True_in v l) ->
  match reduce known left c with All_false => False | All_but l => True_in v l | Open => True end.
Proof.
  intros Hk. revert left. induction c as [| l rest IH]; intros left H; simpl.
  - destruct H as [(l & [] & _) | (l & -> & H)]; auto.
  - destruct (Literals.mem (- l) known) eqn:Known.
    + apply IH. destruct H as [(k & [<- | Hin] & Hl) | H]; auto.
      * destruct (opposites_are_not_both_true l Hl (Hk _ Known)).
      * left. exists k. auto.
    + destruct left as [other |]; [destruct (Z.eqb_spec l other) as [-> |]; auto |]; apply IH.
      * destruct H as [(k & [<- | Hin] & Hl) | H]; eauto. left. exists k. auto.
      * destruct H as [(k & [<- | Hin] & Hl) | (k & E & _)]; [eauto | left; exists k; auto | discriminate].
Qed.

Lemma propagation_contradicts clauses hints : All_satisfied clauses ->
  forall known, All_true known -> propagate clauses known hints = true -> False.
Proof.
  intros Hc. induction hints as [| hint rest IH]; simpl; intros known Hk H; [discriminate |].
  destruct (Numbered.find hint clauses) as [c |] eqn:E; [| discriminate].
  pose proof (reduced_clause_is_satisfied known c None Hk (or_introl (Hc _ _ E))) as R.
  destruct (reduce known None c) as [| l |]; [auto | | discriminate].
  apply (IH (Literals.add l known)); auto using known_literal_is_added.
Qed.

Lemma denied_literals_are_true c : has_no_zero c = true -> ~ Satisfies v c ->
  forall known, All_true known -> All_true (fold_left (fun known l => Literals.add (- l) known) c known).
Proof.
  induction c as [| l rest IH]; simpl; intros Hz Hn known Hk; auto.
  apply andb_true_iff in Hz as [H0 Hz]. apply negb_true_iff, Z.eqb_neq in H0. apply IH; auto.
  - intros (k & Hin & Hl). apply Hn. exists k. simpl. auto.
  - apply known_literal_is_added; auto. destruct (one_of_opposites_is_true l H0) as [Hl |]; auto.
    destruct Hn. exists l. simpl. auto.
Qed.

Lemma clause_is_satisfied_or_not c : Satisfies v c \/ ~ Satisfies v c.
Proof.
  induction c as [| l rest [(k & Hin & Hl) | IH]].
  - right. intros (l & [] & _).
  - left. exists k. simpl. auto.
  - assert (D : True_in v l \/ ~ True_in v l).
    { unfold True_in. destruct (Z.lt_total l 0) as [L | [L | L]]; [destruct (v (- l)) | | destruct (v l)];
        intuition (try lia; try congruence). }
    destruct D as [Hl | Hl]; [left; exists l; simpl; auto |].
    right. intros (k & [<- | Hin] & Hk); auto. apply IH. exists k. auto.
Qed.

Lemma propagated_clause_is_satisfied clauses added hints : All_satisfied clauses -> has_no_zero added = true ->
  propagate clauses (denied added) hints = true -> Satisfies v added.
Proof.
  intros Hc Hz Hp. destruct (clause_is_satisfied_or_not added) as [| Hn]; auto.
  destruct (propagation_contradicts clauses hints Hc (denied added)); auto.
  apply denied_literals_are_true; auto. intros l Hl. apply Literals.mem_spec in Hl.
  destruct (Literals.empty_spec Hl).
Qed.

Lemma added_clauses_are_satisfied n c clauses :
  Satisfies v c -> All_satisfied clauses -> All_satisfied (Numbered.add n c clauses).
Proof.
  intros Hc H m d. rewrite Numbered_facts.add_o. destruct (Numbered_facts.eq_dec n m); [congruence | apply H].
Qed.

Lemma kept_clauses_are_satisfied numbers : forall clauses, All_satisfied clauses ->
  All_satisfied (fold_left (fun kept n => Numbered.remove n kept) numbers clauses).
Proof.
  induction numbers as [| n rest IH]; simpl; intros clauses H; auto. apply IH.
  intros m c. rewrite Numbered_facts.remove_o. destruct (Numbered_facts.eq_dec n m); [discriminate | apply H].
Qed.

Lemma accepted_lines_contradict lines : forall last clauses, All_satisfied clauses ->
  accepts last clauses lines = true -> False.
Proof.
  induction lines as [| line rest IH]; cbn [accepts]; intros last clauses Hc H; [discriminate |].
  destruct (read_step line) as [[number added hints | numbers] |]; [| | discriminate].
  - destruct (has_no_zero added) eqn:Hz; [| discriminate].
    destruct (last <? number); [| discriminate].
    destruct (propagate clauses (denied added) hints) eqn:Hp; [| discriminate]. simpl in H.
    pose proof (propagated_clause_is_satisfied clauses added hints Hc Hz Hp) as Ha.
    destruct added as [| l others]; [destruct Ha as (l & [] & _) |].
    apply (IH number (Numbered.add number (l :: others) clauses)); auto using added_clauses_are_satisfied.
  - apply (IH last (fold_left (fun kept n => Numbered.remove n kept) numbers clauses));
    auto using kept_clauses_are_satisfied.
Qed.

Lemma numbered_clauses_are_satisfied formula : forall n clauses, (forall c, In c formula -> Satisfies v c) ->
  All_satisfied clauses -> All_satisfied (numbered formula n clauses).
Proof.
  induction formula as [| c rest IH]; simpl; intros n clauses Hf Hc; auto.
  apply IH; auto using added_clauses_are_satisfied.
Qed.

End Valuation.

Theorem accepted_refutation_means_unsatisfiable formula lines : refutes formula lines = true -> Unsatisfiable formula.
Proof.
  intros H v Hf. unfold refutes in H. apply (accepted_lines_contradict v lines) in H; auto.
  apply numbered_clauses_are_satisfied; auto. intros n c E. rewrite Numbered_facts.empty_o in E. discriminate.
Qed.
