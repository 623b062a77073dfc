(** The least weighted cost of one robot with its prices: labels show that no way of it costs less than is claimed.

    A label (resource, tick, amount) means: a robot that is free to leave the resource at the tick has paid at least the
    amount. Labels that are closed under waiting and moving, as far as the claim goes, prove the claim. Who made the
    labels does not matter. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Ways Prices.
Import ListNotations.
Open Scope Z_scope.

(** * Sums over ticks *)

(** The sum of f from the tick [first] up to, not including, [end_]. *)
Definition span (f : Z -> Z) (first end_ : Z) : Z :=
  match end_ - first with
  | Zpos n => snd (Pos.iter (fun s => (fst s + 1, snd s + f (fst s))) (first, 0) n)
  | _ => 0
  end.

Lemma span_is_empty f first end_ : end_ <= first -> span f first end_ = 0.
Proof. intros H. unfold span. destruct (end_ - first) eqn:E; lia. Qed.

Lemma iteration_counts f first n :
  fst (Pos.iter (fun s => (fst s + 1, snd s + f (fst s))) (first, 0) n) = first + Zpos n.
Proof. induction n as [| n IH] using Pos.peano_ind; [reflexivity |]. rewrite Pos.iter_succ. simpl. lia. Qed.

Lemma span_to_the_next_tick f first end_ : first <= end_ -> span f first (end_ + 1) = span f first end_ + f end_.
Proof.
  intros H. unfold span. destruct (end_ - first) as [| n | n] eqn:E; [| | lia].
  - replace (end_ + 1 - first) with 1 by lia. simpl. f_equal. lia.
  - replace (end_ + 1 - first) with (Zpos (Pos.succ n)) by lia. rewrite Pos.iter_succ. simpl.
    rewrite iteration_counts. do 2 f_equal. lia.
Qed.

(** Induction over the end of a span. *)
Lemma by_the_end (P : Z -> Prop) first : (forall end_, end_ <= first -> P end_) ->
  (forall end_, first <= end_ -> P end_ -> P (end_ + 1)) -> forall end_, P end_.
Proof.
  intros H0 H1 end_. destruct (Z_le_gt_dec end_ first) as [L | G]; auto.
  replace end_ with (first + (end_ - first)) by lia. apply (natlike_ind (fun n => P (first + n))); [| | lia].
  - apply H0. lia.
  - intros n Hn IH. replace (first + Z.succ n) with (first + n + 1) by lia. apply H1; auto. lia.
Qed.

Lemma span_of_equal f g first end_ : (forall t, f t = g t) -> span f first end_ = span g first end_.
Proof.
  intros E. pattern end_. apply (by_the_end _ first); clear end_; intros end_ H.
  - rewrite !span_is_empty by lia. reflexivity.
  - intros IH. rewrite !span_to_the_next_tick, IH, E by lia. reflexivity.
Qed.

Lemma span_of_one_tick k c first end_ :
  span (fun t => k * Z.b2z (c =? t)) first end_ = k * Z.b2z ((first <=? c) && (c <? end_)).
Proof.
  pattern end_. apply (by_the_end _ first); clear end_; intros end_ H.
  - rewrite span_is_empty by lia. destruct (Z.leb_spec first c), (Z.ltb_spec c end_); simpl; lia.
  - intros IH. rewrite span_to_the_next_tick, IH by lia.
    destruct (Z.leb_spec first c), (Z.ltb_spec c end_), (Z.ltb_spec c (end_ + 1)), (Z.eqb_spec c end_); simpl; lia.
Qed.

Lemma span_of_sums {A} (f : A -> Z -> Z) l first end_ :
  span (fun t => sum (fun x => f x t) l) first end_ = sum (fun x => span (f x) first end_) l.
Proof.
  pattern end_. apply (by_the_end _ first); clear end_; intros end_ H.
  - rewrite span_is_empty by lia. symmetry. erewrite sum_of_equal; [apply (sum_of_zeros l) |].
    intros x _. apply span_is_empty. lia.
  - intros IH. rewrite span_to_the_next_tick, IH, <- sum_of_sums by lia. apply sum_of_equal.
    intros x _. rewrite span_to_the_next_tick by lia. reflexivity.
Qed.

(** * Prices by place and tick *)

(** [here] and [across]: prices of being in a resource, and of exchanges from it, at a tick; [exchange]: of the exchange
    of two resources. All ticks with a price are before [horizon]. *)
Record tariff := Tariff { here : Z -> Z -> Z; across : Z -> Z -> Z; exchange : Z -> Z -> Z -> Z; horizon : Z }.

Definition is_here (r t : Z) (x : price) : bool :=
  match other x with None => (place x =? r) && (tick x =? t) | Some _ => false end.
Definition is_across (r t : Z) (x : price) : bool :=
  match other x with Some _ => (place x =? r) && (tick x =? t) | None => false end.
Definition is_exchange (r s t : Z) (x : price) : bool :=
  match other x with Some o => (place x =? r) && (o =? s) && (tick x =? t) | None => false end.

(** The sum of the prices that are chosen. *)
Definition priced (xs : list price) (chosen : price -> bool) : Z := sum (fun x => amount x * Z.b2z (chosen x)) xs.

(** The tables hold the prices. *)
Record Holds_prices (tf : tariff) (xs : list price) : Prop := {
  here_is_right : forall r t, here tf r t = priced xs (is_here r t);
  across_is_right : forall r t, across tf r t = priced xs (is_across r t);
  exchange_is_right : forall r s t, exchange tf r s t = priced xs (is_exchange r s t);
  horizon_is_right : forall x, In x xs -> tick x < horizon tf;
  amounts_are_prices : forall x, In x xs -> 0 <= amount x
}.

(** What a stay from [first] up to [end_] pays. *)
Definition stay_price (tf : tariff) (r first end_ : Z) : Z :=
  span (here tf r) first (Z.min end_ (horizon tf)) + span (across tf r) (first + 1) (Z.min end_ (horizon tf)).

(** What a tick of waiting pays. *)
Definition wait_price (tf : tariff) (r t : Z) : Z := here tf r t + across tf r t.

(** What a move pays. *)
Definition move_price (tf : tariff) (r s t : Z) : Z := exchange tf r s t + exchange tf s r t.

Section Tables.
Variables (tf : tariff) (xs : list price).
Hypothesis tables : Holds_prices tf xs.

Lemma span_of_a_price x r first end_ (chosen : Z -> price -> bool) (of_kind : bool) :
  (forall t, chosen t x = of_kind && (place x =? r) && (tick x =? t)) ->
  span (fun t => amount x * Z.b2z (chosen t x)) first end_ =
  amount x * Z.b2z (of_kind && (place x =? r) && (first <=? tick x) && (tick x <? end_)).
Proof.
  intros C.
  transitivity (span (fun t => amount x * Z.b2z (of_kind && (place x =? r)) * Z.b2z (tick x =? t)) first end_).
  - apply span_of_equal. intros t. rewrite C. destruct (of_kind && (place x =? r)); simpl; lia.
  - rewrite span_of_one_tick. destruct (of_kind && (place x =? r)), (first <=? tick x), (tick x <? end_); simpl; lia.
Qed.

Lemma stay_price_is_paid r first end_ : visit_paid xs (Visit r first (Some end_)) = stay_price tf r first end_.
Proof.
  unfold stay_price, visit_paid.
  rewrite (span_of_equal (here tf r) _ _ _ (fun t => here_is_right tf xs tables r t)).
  rewrite (span_of_equal (across tf r) _ _ _ (fun t => across_is_right tf xs tables r t)).
  unfold priced. rewrite !(span_of_sums (fun x t => amount x * Z.b2z (_ t x))), <- sum_of_sums.
  apply sum_of_equal. intros x Hx. pose proof (horizon_is_right tf xs tables x Hx).
  rewrite (span_of_a_price x r first _ (is_here r) (match other x with None => true | _ => false end)),
    (span_of_a_price x r (first + 1) _ (is_across r) (match other x with None => false | _ => true end))
    by (intros; unfold is_here, is_across; destruct (other x); reflexivity).
  unfold visit_pays. simpl. rewrite (Z.eqb_sym r).
  destruct (other x), (place x =? r), (Z.ltb_spec (tick x) end_), (Z.leb_spec first (tick x)),
    (Z.ltb_spec first (tick x)), (Z.leb_spec (first + 1) (tick x)), (Z.ltb_spec (tick x) (Z.min end_ (horizon tf)));
    simpl; lia.
Qed.

Lemma endless_stay_pays r first : visit_paid xs (Visit r first None) = stay_price tf r first (horizon tf).
Proof.
  rewrite <- stay_price_is_paid. apply sum_of_equal. intros x Hx. pose proof (horizon_is_right tf xs tables x Hx).
  unfold visit_pays. simpl. destruct (Z.ltb_spec (tick x) (horizon tf)); [reflexivity | lia].
Qed.

Lemma stay_pays_a_tick_more r first end_ : first < end_ ->
  visit_paid xs (Visit r first (Some (end_ + 1))) = visit_paid xs (Visit r first (Some end_)) + wait_price tf r end_.
Proof.
  intros L. unfold wait_price, visit_paid.
  rewrite (here_is_right tf xs tables), (across_is_right tf xs tables). unfold priced. rewrite <- !sum_of_sums.
  apply sum_of_equal. intros x _. unfold visit_pays, is_here, is_across. simpl. rewrite (Z.eqb_sym r).
  destruct (other x), (place x =? r), (Z.ltb_spec (tick x) end_), (Z.ltb_spec (tick x) (end_ + 1)),
    (Z.leb_spec first (tick x)), (Z.ltb_spec first (tick x)), (Z.eqb_spec (tick x) end_); simpl; lia.
Qed.

Lemma longer_stay_pays_more r first end_ later : end_ <= later ->
  visit_paid xs (Visit r first (Some end_)) <= visit_paid xs (Visit r first (Some later)).
Proof.
  intros L. apply sum_is_monotone. intros x Hx. pose proof (amounts_are_prices tf xs tables x Hx).
  unfold visit_pays. simpl. destruct (r =? place x), (Z.ltb_spec (tick x) end_), (Z.ltb_spec (tick x) later),
    (match other x with None => first <=? tick x | Some _ => first <? tick x end); simpl; lia.
Qed.

Lemma move_price_is_paid v w : visit_resource v <> visit_resource w ->
  move_paid xs v w = move_price tf (visit_resource v) (visit_resource w) (enter w).
Proof.
  intros N. unfold move_price, move_paid. rewrite !(exchange_is_right tf xs tables). unfold priced.
  rewrite <- sum_of_sums. apply sum_of_equal. intros x _. unfold move_pays, moves_at, is_exchange.
  destruct (other x) as [o |]; [| simpl; lia]. rewrite (Z.eqb_sym (enter w)).
  rewrite (Z.eqb_sym (visit_resource v)), (Z.eqb_sym (visit_resource w)).
  rewrite (Z.eqb_sym (visit_resource v)), (Z.eqb_sym (visit_resource w)).
  destruct (Z.eqb_spec (place x) (visit_resource v)), (Z.eqb_spec o (visit_resource w)),
    (Z.eqb_spec (place x) (visit_resource w)), (Z.eqb_spec o (visit_resource v)), (tick x =? enter w);
    try congruence; simpl; lia.
Qed.

Lemma nothing_is_paid_below_0 vs : 0 <= paid xs vs.
Proof.
  rewrite paid_is_by_price. apply sum_is_not_negative. intros x Hx.
  pose proof (amounts_are_prices tf xs tables x Hx). pose proof (times_is_not_negative x vs). nia.
Qed.

Lemma no_visit_pays_below_0 v : 0 <= visit_paid xs v.
Proof.
  apply sum_is_not_negative. intros x Hx. pose proof (amounts_are_prices tf xs tables x Hx).
  destruct (visit_pays x v); simpl; lia.
Qed.

Lemma no_move_pays_below_0 v w : 0 <= move_paid xs v w.
Proof.
  apply sum_is_not_negative. intros x Hx. pose proof (amounts_are_prices tf xs tables x Hx).
  destruct (move_pays x v w); simpl; lia.
Qed.

End Tables.

(** * The claim of one robot *)

(** The evidence that a robot has no way of less weighted cost and prices than [claimed]: for resources that lead to its
    goal, least ticks from leaving them to entering it; labels; and a way through the graph. For the deadlines that it
    keeps, it pays [early] at the tick at which it arrives, and [passing] for being in a resource, on its way, from one
    tick up to another. *)
Record claim := Claim {
  claimed : Z;
  weight : Z;
  rest_of : Z -> option Z;
  label_at : Z -> Z -> option Z;
  early : Z -> Z;
  passing : Z -> Z -> Z -> Z
}.

(** What a robot pays on its way: in each visit but the last. *)
Fixpoint passed (pay : Z -> Z -> Z -> Z) (vs : list visit) : Z :=
  match vs with
  | [] => 0
  | v :: rest =>
      match rest with [] => 0 | w :: _ => pay (visit_resource v) (enter v) (enter w) end + passed pay rest
  end.

Section Claim.
Variables (i : instance) (tf : tariff) (successors : Z -> list Z) (takes : Z -> Z) (a : robot) (c : claim).

(** Who is free to leave the resource at the tick and has paid the amount comes to the claim by the least ticks that
    remain; or a label says so. *)
Definition covered (amount r t : Z) : bool :=
  match rest_of c r with
  | None => true
  | Some ticks =>
      (claimed c <=? amount + weight c * (t + ticks - release a)) ||
      match label_at c r t with Some label => label <=? amount | None => false end
  end.

(** Who enters the goal for the last time at the tick, and has paid the amount, comes to the claim. *)
Definition arrives_covered (amount t : Z) : bool :=
  let end_ :=
    match after_goal i with Vanish => t + Z.max (takes (goal a)) (service (last_stop a)) | Park => horizon tf end in
  claimed c <=? amount + stay_price tf (goal a) t end_ + weight c * (t - release a) + early c t.

(** Who enters the resource at the tick, and has paid the amount: it may be there for the last time, or go on. *)
Definition entry_covered (amount r t : Z) : bool :=
  (negb (r =? goal a) || arrives_covered amount t) &&
  (let ready := t + takes r in covered (amount + stay_price tf r t ready + passing c r t ready) r ready).

(** All that may follow a label is covered: waiting for a tick, and each move. *)
Definition label_is_closed (r t label : Z) : bool :=
  covered (label + wait_price tf r t + passing c r t (t + 1)) r (t + 1) &&
  forallb (fun s => entry_covered (label + move_price tf r s t) s t) (successors r).

(** The remaining ticks are no more than along each move. *)
Definition rests_are_least (r : Z) : bool :=
  forallb (fun s =>
    match rest_of c r with
    | Some ticks =>
        (negb (s =? goal a) || (ticks <=? 0)) &&
        match rest_of c s with Some later => ticks <=? takes s + later | None => true end
    | None => negb (s =? goal a) && match rest_of c s with Some _ => false | None => true end
    end) (successors r).

Record Claim_holds : Prop := {
  start_is_covered : entry_covered 0 (start a) (release a) = true;
  labels_are_closed : forall r t label, label_at c r t = Some label -> label_is_closed r t label = true;
  all_rests_are_least : forall r, In r (resource_ids i) -> rests_are_least r = true;
  weight_is_not_negative : 0 <= weight c;
  early_is_not_negative : forall t, 0 <= early c t;
  passing_is_not_negative : forall r first end_, 0 <= passing c r first end_;
  passing_adds_up : forall r first middle end_, first <= middle <= end_ ->
    passing c r first end_ = passing c r first middle + passing c r middle end_
}.

Variable xs : list price.
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).
Hypothesis tables : Holds_prices tf xs.
Hypothesis all_moves : forall r s, Move i r s -> In s (successors r).
Hypothesis durations : forall r, takes r = need i a r.
Hypothesis least : forall r, In r (resource_ids i) -> rests_are_least r = true.

(** The tick at which the last visit is entered. *)
Definition arrives (vs : list visit) : Z := fold_left (fun _ v => enter v) vs 0.

Lemma rests_are_not_more_than_what_remains vs : Way i a vs -> forall v w rest, vs = v :: w :: rest ->
  exists ticks, rest_of c (visit_resource v) = Some ticks /\ enter w + ticks <= arrives vs.
Proof.
  intros H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH]; intros v' w' rest E; [discriminate |].
  injection E as <- <- <-. change (arrives (v :: w :: later)) with (arrives (w :: later)).
  destruct (moves_join_resources i right _ _ Hm) as (_ & Hr & _).
  pose proof (proj1 (forallb_forall _ _) (least _ Hr) _ (all_moves _ _ Hm)) as L. cbv beta in L.
  inversion Hw as [w' Hg' Hl' | w' u rest Hl' Hn' Hm' Hu]; subst.
  - rewrite Hg', Z.eqb_refl in L. destruct (rest_of c (visit_resource v)) as [ticks |]; [| discriminate].
    exists ticks. split; auto. split_bools. simpl in *. unfold arrives. simpl. split_bools. lia.
  - destruct (IH w u rest eq_refl) as (later & R & A). rewrite R in L.
    destruct (rest_of c (visit_resource v)) as [ticks |]; [| rewrite andb_false_r in L; discriminate].
    exists ticks. split; auto. split_bools. rewrite durations in *. lia.
Qed.

Hypothesis closed : forall r t label, label_at c r t = Some label -> label_is_closed r t label = true.
Hypothesis weighted : 0 <= weight c.
Hypothesis charged : forall t, 0 <= early c t.
Hypothesis tolled : forall r first end_, 0 <= passing c r first end_.
Hypothesis tolls_add_up : forall r first middle end_, first <= middle <= end_ ->
  passing c r first end_ = passing c r first middle + passing c r middle end_.

Lemma who_pays_more_is_covered amount more r t : amount <= more -> covered amount r t = true -> covered more r t = true.
Proof.
  unfold covered. destruct (rest_of c r); auto. rewrite !orb_true_iff, !Z.leb_le.
  intros L [H | H]; [left; lia | right]. destruct (label_at c r t); auto. split_bools. apply Z.leb_le. lia.
Qed.

(** What a way costs from its first visit on, after the amount was paid before it. *)
Definition priced_cost (vs : list visit) : Z :=
  paid xs vs + weight c * (arrives vs - release a) + early c (arrives vs) + passed (passing c) vs.

Lemma paid_from_the_second_visit_on v w rest :
  paid xs (v :: w :: rest) = visit_paid xs v + move_paid xs v w + paid xs (w :: rest).
Proof. reflexivity. Qed.

Lemma passed_from_the_second_visit_on v w rest :
  passed (passing c) (v :: w :: rest) =
  passing c (visit_resource v) (enter v) (enter w) + passed (passing c) (w :: rest).
Proof. reflexivity. Qed.

Lemma nothing_is_passed_below_0 vs : 0 <= passed (passing c) vs.
Proof.
  induction vs as [| v [| w rest] IH]; [simpl; lia | simpl; lia |]. rewrite passed_from_the_second_visit_on.
  pose proof (tolled (visit_resource v) (enter v) (enter w)). lia.
Qed.

Lemma covered_entry_is_claimed v before : Way i a [v] -> 
  arrives_covered before (enter v) = true -> claimed c <= before + priced_cost [v].
Proof.
  intros H C. inversion H as [v' Hg Hl |]; subst. apply Z.leb_le in C. unfold priced_cost, arrives. simpl.
  destruct v as [r first end_]. simpl in *. subst r end_.
  unfold last_need. rewrite durations in C. destruct (after_goal i).
  - rewrite stay_price_is_paid with (tf := tf) by auto. lia.
  - rewrite endless_stay_pays with (tf := tf) by auto. lia.
Qed.

(** Who is covered when free to leave the first visit comes to the claim. *)
Lemma covered_way_is_claimed vs : Way i a vs -> forall v w rest, vs = v :: w :: rest -> forall before t,
  enter v + need i a (visit_resource v) <= t <= enter w ->
  covered (before + visit_paid xs (Visit (visit_resource v) (enter v) (Some t)) +
    passing c (visit_resource v) (enter v) t) (visit_resource v) t = true ->
  claimed c <= before + priced_cost vs.
Proof.
  intros H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH]; intros v' w' rest E; [discriminate |].
  injection E as <- <- <-. intros before t.
  pose proof (rests_are_not_more_than_what_remains _ (Way_goes_on i a v w later Hl Hn Hm Hw) v w later eq_refl)
    as (ticks & R & A).
  pose proof (need_is_positive i a right known (visit_resource v)) as Need.
  destruct v as [r first end_]. simpl in *. subst end_.
  remember (Z.to_nat (enter w - t)) as n eqn:N. revert t N. induction n as [| n IHn]; intros t N T C.
  - assert (t = enter w) by lia. subst t. clear N T. unfold covered in C. rewrite R in C.
    apply orb_true_iff in C as [C | C].
    { split_bools. unfold priced_cost. rewrite paid_from_the_second_visit_on, passed_from_the_second_visit_on.
      pose proof (nothing_is_paid_below_0 tf xs tables (w :: later)).
      pose proof (nothing_is_passed_below_0 (w :: later)).
      pose proof (no_move_pays_below_0 tf xs tables (Visit r first (Some (enter w))) w).
      cbn [visit_resource enter] in *.
      match goal with |- context [early c ?at_] => pose proof (charged at_) end. nia. }
    destruct (label_at c r (enter w)) as [label |] eqn:Label; [| discriminate]. split_bools.
    pose proof (closed _ _ _ Label) as K. apply andb_true_iff in K as [_ K].
    pose proof (proj1 (forallb_forall _ _) K _ (all_moves _ _ Hm)) as M. cbv beta in M.
    apply andb_true_iff in M as [Last On].
    destruct (moves_join_resources i right _ _ Hm) as (Different & _).
    pose proof (move_price_is_paid tf xs tables (Visit r first (Some (enter w))) w Different) as Move. simpl in Move.
    set (v := Visit r first (Some (enter w))).
    set (before' := before + visit_paid xs v + passing c r first (enter w) + move_paid xs v w).
    assert (Goal : claimed c <= before' + priced_cost (w :: later)).
    { destruct later as [| u rest].
      - inversion Hw as [w' Hg |]; subst. rewrite Hg, Z.eqb_refl in Last. simpl in Last.
        apply covered_entry_is_claimed; auto. apply Z.leb_le in Last. apply Z.leb_le. rewrite Hg in Move.
        unfold before', v.
        lia.
      - inversion Hw; subst. apply (IH w u rest eq_refl before' (enter w + need i a (visit_resource w))); [lia |].
        rewrite durations in On. eapply who_pays_more_is_covered; [| exact On].
        rewrite stay_price_is_paid with (tf := tf) by auto.
        unfold before', v. lia. }
    unfold before', v, priced_cost in *. rewrite paid_from_the_second_visit_on, passed_from_the_second_visit_on.
    cbn [visit_resource enter].
    change (arrives (Visit r first (Some (enter w)) :: w :: later)) with (arrives (w :: later)). lia.
  - unfold covered in C. rewrite R in C. apply orb_true_iff in C as [C | C].
    { split_bools. unfold priced_cost. rewrite paid_from_the_second_visit_on, passed_from_the_second_visit_on.
      pose proof (nothing_is_paid_below_0 tf xs tables (w :: later)).
      pose proof (nothing_is_passed_below_0 (w :: later)).
      pose proof (no_move_pays_below_0 tf xs tables (Visit r first (Some (enter w))) w).
      pose proof (tolls_add_up r first t (enter w) ltac:(lia)). pose proof (tolled r t (enter w)).
      cbn [visit_resource enter] in *.
      pose proof (longer_stay_pays_more tf xs tables r first t (enter w)).
      match goal with |- context [early c ?at_] => pose proof (charged at_) end. nia. }
    destruct (label_at c r t) as [label |] eqn:Label; [| discriminate]. split_bools.
    pose proof (closed _ _ _ Label) as K. apply andb_true_iff in K as [K _].
    apply (IHn (t + 1)); [lia | lia |]. eapply who_pays_more_is_covered; [| exact K].
    rewrite (stay_pays_a_tick_more tf xs tables), (tolls_add_up r first t (t + 1)) by lia. lia.
Qed.

End Claim.

(** No lawful plan of the robot alone costs less, weighted and together with its prices, than the claim. *)
Theorem claim_is_below_every_plan i tf successors takes a c xs p : Well_formed i -> In a (robots i) ->
  Holds_prices tf xs -> (forall r s, Move i r s -> In s (successors r)) -> (forall r, takes r = need i a r) ->
  Claim_holds i tf successors takes a c -> Plan_lawful i a p ->
  claimed c <= paid xs (visits p) + weight c * cost a p + early c (arrives (visits p)) + passed (passing c) (visits p).
Proof.
  intros right known tables moves durations [Start Closed Least Weight Early Passing Adds] lawful.
  pose proof (lawful_plan_is_a_way i a right known p lawful) as W.
  destruct (starts_at_release i a p lawful) as (v & rest & E & R & T). unfold cost, arrival. rewrite E in *.
  change (fold_left (fun _ v => enter v) (v :: rest) (release a)) with (arrives (v :: rest)).
  apply andb_true_iff in Start as [Last On]. rewrite <- R, <- T in *.
  destruct rest as [| w later].
  - inversion W as [v' Hg |]; subst. rewrite Hg, Z.eqb_refl in Last. simpl in Last.
    rewrite T. pose proof (covered_entry_is_claimed i tf takes a c xs tables durations v 0 W) as P.
    unfold priced_cost in P. apply P in Last. lia.
  - inversion W; subst.
    pose proof (covered_way_is_claimed i tf successors takes a c xs right known tables moves durations Least Closed
      Weight Early Passing Adds (v :: w :: later) W v w later eq_refl 0 (enter v + need i a (visit_resource v))) as P.
    unfold priced_cost in P. rewrite T in *. apply P; [lia |].
    rewrite stay_price_is_paid with (tf := tf), <- durations by auto. exact On.
Qed.
