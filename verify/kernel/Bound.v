(** Certificates of a lower bound on the total cost: the rules bound/... but for the digest of the instance, which the
    driver compares. Cuts and deadlines are claims that are proved elsewhere. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Checker Ways Prices Labels Tables.
Import ListNotations.
Open Scope Z_scope.

(** A group of robots that cost at least [least_total] together, and how much it counts, in parts of a tick. *)
Record cut := Cut { members : list Z; least_total : Z; multiplier : Z }.

(** A tick at which a robot is seen, and the places that count for it then. *)
Record sight := Sight { seen_at : Z; spots : list Z }.

(** The robot [who] enters its goal for the last time by the tick [due]. If it is seen, it does so by then, or is in one
    of the spots then, on its way. *)
Record deadline := Deadline { who : Z; due : Z; seen : option sight }.

Definition Keeps (d : deadline) (p : plan) : Prop :=
  match seen d with
  | None => arrives (visits p) <= due d
  | Some s =>
      arrives (visits p) <= due d /\ arrives (visits p) <= seen_at s \/
      exists v w, Consecutive p v w /\ In (visit_resource v) (spots s) /\ enter v <= seen_at s < enter w
  end.

(** Deadlines that cannot all be kept, and what each robot pays that keeps its own, in parts of a tick. *)
Record group := Group { deadlines : list deadline; fee : Z }.

(** The certificate as its document has it: [claims] are the robots with their least priced costs, in parts of a tick,
    or with none where no way leads to the goal. *)
Record certificate := Certificate {
  bound : Z;
  scale : Z;
  price_horizon : Z;
  prices : list price;
  cuts : list cut;
  claims : list (Z * option Z);
  groups : list group;
  group_prices : list group_price
}.

(** The prices of resources and exchanges, and those of groups as their resources have them. *)
Definition all_prices (i : instance) (c : certificate) : list price :=
  prices c ++ flat_map (prices_within i) (group_prices c).

(** What shows a robot's claim: for resources that lead to its goal, the least ticks from leaving them to entering it;
    labels ((resource, tick), amount); and the resources of a way after its start. *)
Record evidence := Evidence { ticks_after : list (Z * Z); labels : list (Z * Z * Z); way : list Z }.

(** * The checker *)

Definition total_of {A} (f : A -> Z) (l : list A) : Z := fold_left (fun total x => total + f x) l 0.

(** bound/scale: a power of two. *)
Definition scale_accepted (c : certificate) : bool := (0 <? scale c) && (Z.land (scale c) (scale c - 1) =? 0).

(** bound/price: at least 0, of a resource or of an exchange with a move each way, at a tick before the horizon. *)
Definition price_accepted (i : instance) (known : Z -> bool) (successors : Z -> list Z) (c : certificate)
  (x : price) : bool :=
  let leads r s := existsb (Z.eqb s) (successors r) in
  (0 <=? amount x) && (0 <=? tick x) && (tick x <? price_horizon c) && known (place x) &&
  match other x with None => true | Some o => known o && leads (place x) o && leads o (place x) end.

(** The same for a price of a group. *)
Definition group_price_accepted (i : instance) (c : certificate) (x : group_price) : bool :=
  (0 <=? group_amount x) && (0 <=? group_tick x) && (group_tick x <? price_horizon c) &&
  match group_of i x with Some _ => true | None => false end.

(** bound/once: no price twice for the same place and tick. *)
Definition prices_are_different (c : certificate) : bool :=
  Pairs.distinct (flat_map (fun x => match key_here x with Some k => [k] | None => [] end) (prices c)) &&
  Triples.distinct (flat_map (fun x => match key_exchange x with Some k => [k] | None => [] end) (prices c)) &&
  Pairs.distinct (map (fun x => (priced_group x, group_tick x)) (group_prices c)).

(** bound/size: robots by resources are 400,000,000 at most. Tables have 20,000,000 entries at most: of the robots of cuts
    and deadlines by resource, of the resources of groups with prices, and of priced resources by tick, up to the last
    price. *)
Definition size_accepted (i : instance) (c : certificate) : bool :=
  let fits n m := n * m <=? 20000000 in
  let count {A} (l : list A) := total_of (fun _ => 1) l in
  let all := count (resources i) in
  (count (robots i) * all <=? 400000000) &&
  fits (total_of (fun k => count (members k)) (cuts c)) all &&
  fits (total_of (fun g => count (deadlines g)) (groups c)) all &&
  fits (total_of (fun x => count (prices_within i x)) (group_prices c)) 1 &&
  let priced := all_prices i c in fits (last_tick priced) (Z.of_nat (Ids.S.cardinal (Ids.of_list (map place priced)))).

(** bound/cut: what a robot's own ticks count, in parts of a tick, where its cuts count the rest. *)
Definition weight_of (c : certificate) (id : Z) : Z :=
  scale c - sum (fun k => multiplier k * sum (fun m => Z.b2z (m =? id)) (members k)) (cuts c).

Definition cuts_accepted (i : instance) (c : certificate) : bool :=
  let ids := Ids.of_list (robot_ids i) in
  forallb (fun k =>
    (0 <=? multiplier k) && (0 <=? least_total k) && negb (match members k with [] => true | _ => false end) &&
    Ids.distinct (members k) && forallb (Ids.contains ids) (members k)) (cuts c) &&
  forallb (fun id => 0 <=? weight_of c id) (robot_ids i).

(** bound/deadline: the deadlines of a robot, each with what it pays if it keeps it. *)
Definition dues_of (c : certificate) (id : Z) : list (Z * deadline) :=
  flat_map (fun g => flat_map (fun d => if who d =? id then [(fee g, d)] else []) (deadlines g)) (groups c).

(** The tick by which a robot that keeps its deadline arrives, if it is not seen on its way. *)
Definition last_arrival (d : deadline) : Z :=
  match seen d with Some s => Z.min (due d) (seen_at s) | None => due d end.

(** A robot that is in the resource from one tick up to another, on its way, is seen there. *)
Definition is_seen (d : deadline) (r first end_ : Z) : bool :=
  match seen d with
  | Some s => (first <=? seen_at s) && (seen_at s <? end_) && existsb (Z.eqb r) (spots s)
  | None => false
  end.

Definition fees_at_arrival (dues : list (Z * deadline)) (t : Z) : Z :=
  sum (fun x : Z * deadline => fst x * Z.b2z (t <=? last_arrival (snd x))) dues.

Definition fees_on_the_way (dues : list (Z * deadline)) (r first end_ : Z) : Z :=
  sum (fun x : Z * deadline => fst x * Z.b2z (is_seen (snd x) r first end_)) dues.

(** The most that the robots of a group pay: all but one. *)
Definition group_worth (g : group) : Z := fee g * (Z.of_nat (length (deadlines g)) - 1).

Definition groups_accepted (c : certificate) : bool := forallb (fun g => 0 <=? fee g) (groups c).

(** The resources lead from one to the next and to the goal. *)
Fixpoint leads_on (successors : Z -> list Z) (r : Z) (later : list Z) (to : Z) : bool :=
  match later with
  | [] => r =? to
  | s :: rest => existsb (Z.eqb s) (successors r) && leads_on successors s rest to
  end.

(** bound/robots, for one robot. *)
Definition claim_accepted (i : instance) (tf : tariff) (successors : Z -> list Z) (takes : Z -> Z) (own : Z) (a : robot)
    (dues : list (Z * deadline)) (claimed_least : option Z) (e : evidence) : bool :=
  let rests := index fst (ticks_after e) in
  let rest_at r := match Map.find r rests with Some x => Some (snd x) | None => None end in
  let label_table := pairs_of (labels e) in
  let label_in r t := Pair_map.find (r, t) label_table in
  let c := Claim match claimed_least with Some n => n | None => 0 end own rest_at label_in
    (fees_at_arrival dues) (fees_on_the_way dues) in
  forallb (rests_are_least successors takes a c) (resource_ids i) &&
  match claimed_least with
  | Some _ =>
      entry_covered i tf takes a c 0 (start a) (release a) &&
      forallb (fun l => label_is_closed i tf successors takes a c (fst (fst l)) (snd (fst l)) (snd l)) (labels e) &&
      leads_on successors (start a) (way e) (goal a)
  | None => negb (start a =? goal a) && match rest_at (start a) with None => true | Some _ => false end
  end.

(** The first robots of the instance that are not named in order, or whose claims do not hold; none if all is right. A
    robot's evidence is looked for when its claim is checked, and so after all that is cheaper to check. *)
Fixpoint refused_claims (i : instance) (tf : tariff) (successors : Z -> list Z) (table : Map.t resource)
    (c : certificate) (robots : list robot) (claims : list (Z * option Z)) (all : list (unit -> evidence))
    : option (list robot) :=
  match robots, claims, all with
  | [], [], _ => None
  | a :: robots', (id, claimed_least) :: claims', e :: all' =>
      if (id =? robot_id a) &&
        claim_accepted i tf successors (takes_in table a) (weight_of c id) a (dues_of c id) claimed_least (e tt)
      then refused_claims i tf successors table c robots' claims' all'
      else Some robots
  | _, _, _ => Some robots
  end.

(** bound/total: all parts together. *)
Definition parts (i : instance) (table : Map.t resource) (c : certificate) : Z :=
  total_of (fun k => match snd k with Some n => n | None => 0 end) (claims c) +
  total_of (fun k => multiplier k * least_total k) (cuts c) -
  total_of group_worth (groups c) -
  total_of (fun x => group_amount x * group_room i x) (group_prices c) -
  total_of (fun x => amount x * room_in table (place x)) (prices c).

Definition total_accepted (i : instance) (table : Map.t resource) (c : certificate) : bool :=
  bound c =? - ((- parts i table c) / scale c).

(** The rules, one after the other: the first that is broken, or none. *)
Inductive bound_rule :=
  Scale | Price_rule | Once | Size | Cut_rule | Deadline_rule | Robots (refused : list robot) | Total.

Definition broken_rule (i : instance) (c : certificate) (all : list (unit -> evidence)) : option bound_rule :=
  let table := resource_table i in
  let moves := successor_table i in
  let successors := listed moves in
  let ids := Ids.of_list (resource_ids i) in
  if negb (scale_accepted c) then Some Scale
  else if negb (forallb (price_accepted i (Ids.contains ids) successors c) (prices c)) then Some Price_rule
  else if negb (forallb (group_price_accepted i c) (group_prices c)) then Some Price_rule
  else if negb (prices_are_different c) then Some Once
  else if negb (size_accepted i c) then Some Size
  else if negb (cuts_accepted i c) then Some Cut_rule
  else if negb (groups_accepted c) then Some Deadline_rule
  else match refused_claims i (tariff_of (all_prices i c)) successors table c (robots i) (claims c) all with
       | Some refused => Some (Robots refused)
       | None => if total_accepted i table c then None else Some Total
       end.

Definition bound_accepted (i : instance) (c : certificate) (all : list (unit -> evidence)) : bool :=
  match broken_rule i c all with None => true | Some _ => false end.

(** * What it proves *)

(** What a robot costs in the solution; 0 if it has no plan. *)
Definition cost_of_robot (i : instance) (s : solution) (id : Z) : Z :=
  sum (fun p => if plan_robot p =? id then cost_of_plan i p else 0) (plans s).

(** The robots of the cut cost at least its least total together. *)
Definition Cut_holds (i : instance) (s : solution) (k : cut) : Prop :=
  least_total k <= sum (cost_of_robot i s) (members k).

(** How often visits keep a deadline: by arriving, and by each visit in which the robot is seen. *)
Definition times_kept (d : deadline) (vs : list visit) : Z :=
  Z.b2z (arrives vs <=? last_arrival d) + passed (fun r first end_ => Z.b2z (is_seen d r first end_)) vs.

(** Not all robots of the group keep their deadlines. *)
Definition Group_holds (s : solution) (g : group) : Prop :=
  sum (fun p => sum (fun d => Z.b2z (who d =? plan_robot p) * times_kept d (visits p)) (deadlines g)) (plans s) <=
  Z.of_nat (length (deadlines g)) - 1.

(** Each robot has a plan if a way leads to its goal. *)
Definition Plans_every_plannable_robot (i : instance) (s : solution) : Prop :=
  forall a, In a (robots i) -> Plannable i a -> In (robot_id a) (planned s).

Lemma total_of_is_the_sum {A} (f : A -> Z) l : total_of f l = sum f l.
Proof.
  unfold total_of. rewrite <- (Z.add_0_l (sum f l)). generalize 0.
  induction l as [| x l IH]; intros n; simpl; [lia |]. rewrite IH. lia.
Qed.

Lemma sum_is_above_each {A} (f : A -> Z) l x : (forall y, In y l -> 0 <= f y) -> In x l -> f x <= sum f l.
Proof.
  induction l as [| y l IH]; simpl; intros H; [intros [] |]. pose proof (H y (or_introl eq_refl)).
  pose proof (sum_is_not_negative f l (fun z Hz => H z (or_intror Hz))).
  intros [-> | Hx]; [lia |]. assert (f x <= sum f l) by auto. lia.
Qed.

Lemma one_of_different_ids {A} (key : A -> Z) l id : NoDup (map key l) -> In id (map key l) ->
  sum (fun x => Z.b2z (key x =? id)) l = 1.
Proof.
  induction l as [| x l IH]; simpl; [intros _ [] |]. intros N. inversion N as [| ? ? Hx Hl]; subst.
  destruct (Z.eqb_spec (key x) id) as [<- | D].
  - intros _. assert (Z0 : sum (fun y => Z.b2z (key y =? key x)) l = 0); [| simpl Z.b2z; lia].
    rewrite <- (sum_of_zeros l). apply sum_of_equal. intros y Hy.
    destruct (Z.eqb_spec (key y) (key x)) as [E |]; auto. destruct Hx. rewrite <- E. apply in_map, Hy.
  - intros [E | Hin]; [congruence |]. simpl Z.b2z. rewrite IH; auto.
Qed.

Lemma sum_of_joined {A} (f : A -> Z) l m : sum f (l ++ m) = sum f l + sum f m.
Proof. induction l as [| x l IH]; simpl; lia. Qed.

Lemma sum_over_all {A B} (f : B -> Z) (g : A -> list B) l : sum f (flat_map g l) = sum (fun x => sum f (g x)) l.
Proof. induction l as [| x l IH]; simpl; auto. rewrite sum_of_joined, IH. reflexivity. Qed.

Lemma leads_on_leads successors i r later to : (forall r s, In s (successors r) -> Move i r s) ->
  leads_on successors r later to = true -> Leads i r to.
Proof.
  intros M. revert r. induction later as [| s rest IH]; simpl; intros r H.
  - apply Z.eqb_eq in H. subst. constructor.
  - apply andb_true_iff in H as [H K]. apply existsb_exists in H as (s' & Hs & E). apply Z.eqb_eq in E. subst s'.
    apply Leads_on with s; auto.
Qed.

Section Instance.
Variables (i : instance) (s : solution) (c : certificate) (all : list (unit -> evidence)).
Hypothesis right : Well_formed i.
Hypothesis lawful : Lawful i s.
Hypothesis complete : Plans_every_plannable_robot i s.
Hypothesis cuts_hold : forall k, In k (cuts c) -> Cut_holds i s k.
Hypothesis groups_hold : forall g, In g (groups c) -> Group_holds s g.

Let successors := listed (successor_table i).
Let table := resource_table i.
Let tf := tariff_of (all_prices i c).

(** What visits pay for deadlines. *)
Let fees (dues : list (Z * deadline)) (vs : list visit) : Z :=
  fees_at_arrival dues (arrives vs) + passed (fees_on_the_way dues) vs.

(** What a plan costs, weighted, together with its prices and those of the deadlines that it keeps. *)
Let own_plan (p : plan) : Z := paid (all_prices i c) (visits p) + weight_of c (plan_robot p) * cost_of_plan i p.
Let priced_plan (p : plan) : Z := own_plan p + fees (dues_of c (plan_robot p)) (visits p).

Hypothesis scaled : 0 < scale c.
Hypothesis own_prices_right : forall x, In x (prices c) -> 0 <= amount x /\ In (place x) (resource_ids i) /\
  match other x with Some o => In o (resource_ids i) | None => True end.
Hypothesis group_prices_right : forall x, In x (group_prices c) -> 0 <= group_amount x.
Hypothesis weights_right : forall id, In id (robot_ids i) -> 0 <= weight_of c id.
Hypothesis multipliers_right : forall k, In k (cuts c) -> 0 <= multiplier k.
Hypothesis fees_right : forall g, In g (groups c) -> 0 <= fee g.

Lemma dues_are_not_negative id x : In x (dues_of c id) -> 0 <= fst x.
Proof.
  intros H. apply in_flat_map in H as (g & Hg & H). apply in_flat_map in H as (d & _ & H).
  destruct (who d =? id); [| destruct H]. destruct H as [<- | []]. apply fees_right, Hg.
Qed.

Lemma fees_at_arrival_are_not_negative id t : 0 <= fees_at_arrival (dues_of c id) t.
Proof.
  apply sum_is_not_negative. intros x Hx. pose proof (dues_are_not_negative id x Hx).
  destruct (_ <=? _); simpl Z.b2z; lia.
Qed.

Lemma fees_on_the_way_are_not_negative id r first end_ : 0 <= fees_on_the_way (dues_of c id) r first end_.
Proof.
  apply sum_is_not_negative. intros x Hx. pose proof (dues_are_not_negative id x Hx).
  destruct (is_seen _ _ _ _); simpl Z.b2z; lia.
Qed.

Lemma fees_on_the_way_add_up dues r first middle end_ : first <= middle <= end_ ->
  fees_on_the_way dues r first end_ = fees_on_the_way dues r first middle + fees_on_the_way dues r middle end_.
Proof.
  intros L. unfold fees_on_the_way. rewrite <- sum_of_sums. apply sum_of_equal. intros x _. unfold is_seen.
  destruct (seen (snd x)) as [[t places] |]; [| simpl; lia]. cbn [seen_at spots].
  destruct (Z.leb_spec first t), (Z.leb_spec middle t), (Z.ltb_spec t middle), (Z.ltb_spec t end_),
    (existsb (Z.eqb r) places); simpl; lia.
Qed.

(** A deadline's price is paid as often as the deadline is kept. *)
Lemma fees_are_paid_as_often_as_kept dues vs : fees dues vs = sum (fun x => fst x * times_kept (snd x) vs) dues.
Proof.
  unfold fees, times_kept.
  assert (E : passed (fees_on_the_way dues) vs =
    sum (fun x => fst x * passed (fun r first end_ => Z.b2z (is_seen (snd x) r first end_)) vs) dues).
  { assert (Z0 : 0 = sum (fun x : Z * deadline => fst x * 0) dues)
      by (rewrite (sum_of_equal _ (fun _ => 0)) by (intros; lia); symmetry; apply sum_of_zeros).
    induction vs as [| v rest IH]; [exact Z0 |]. cbn [passed]. rewrite IH. destruct rest as [| w later].
    - apply sum_of_equal. intros. lia.
    - unfold fees_on_the_way. rewrite <- sum_of_sums. apply sum_of_equal. intros. lia. }
  rewrite E. unfold fees_at_arrival. rewrite <- sum_of_sums. apply sum_of_equal. intros. lia.
Qed.

Lemma no_fees_are_below_0 id vs : 0 <= fees (dues_of c id) vs.
Proof.
  apply Z.add_nonneg_nonneg; [apply fees_at_arrival_are_not_negative |].
  induction vs as [| v rest IH]; cbn [passed]; [lia |]. apply Z.add_nonneg_nonneg; auto.
  destruct rest as [| w later]; [lia | apply fees_on_the_way_are_not_negative].
Qed.

(** All robots together pay no more for deadlines than those of each group but one. *)
Lemma fees_are_no_more_than_their_worth :
  sum (fun p => fees (dues_of c (plan_robot p)) (visits p)) (plans s) <= sum group_worth (groups c).
Proof.
  rewrite (sum_of_equal _ (fun p => sum (fun g => fee g *
    sum (fun d => Z.b2z (who d =? plan_robot p) * times_kept d (visits p)) (deadlines g)) (groups c))).
  - rewrite sums_are_exchanged. apply sum_is_monotone. intros g Hg. rewrite sum_of_multiples.
    apply Z.mul_le_mono_nonneg_l; [apply fees_right, Hg | apply groups_hold, Hg].
  - intros p _. rewrite fees_are_paid_as_often_as_kept. unfold dues_of. rewrite sum_over_all. apply sum_of_equal.
    intros g _. rewrite sum_over_all, <- sum_of_multiples. apply sum_of_equal. intros d _.
    destruct (who d =? plan_robot p); cbn [sum fold_right fst snd Z.b2z]; ring.
Qed.

Lemma prices_are_held : Holds_prices tf (all_prices i c).
Proof.
  apply tariff_holds_prices. intros x Hx. apply in_app_iff in Hx as [Hx | Hx]; [apply (own_prices_right x Hx) |].
  apply in_flat_map in Hx as (y & Hy & Hx). apply (prices_within_are_right i y x right (group_prices_right y Hy) Hx).
Qed.

Lemma cost_is_of_robot a p : In a (robots i) -> plan_robot p = robot_id a -> cost_of_plan i p = cost a p.
Proof.
  intros Ha E. unfold cost_of_plan. rewrite E. pose proof (robot_ids_are_unique i right) as N. unfold robot_ids in N.
  induction (robots i) as [| b l IH]; [destruct Ha |]. inversion N as [| ? ? Hb Hl]; subst. simpl.
  destruct (Z.eqb_spec (robot_id b) (robot_id a)) as [Eq | D].
  - destruct Ha as [-> | Ha]; auto. destruct Hb. rewrite Eq. apply in_map, Ha.
  - destruct Ha as [-> | Ha]; [congruence | auto].
Qed.

Lemma way_does_not_arrive_before_it_starts a vs : In a (robots i) -> Way i a vs -> forall v rest, vs = v :: rest ->
  enter v <= arrives vs.
Proof.
  intros Ha H. induction H as [v Hg Hl | v w later Hl Hn Hm Hw IH]; intros u rest E; injection E as <- <-.
  - unfold arrives. simpl. lia.
  - pose proof (need_is_positive i a right Ha (visit_resource v)). specialize (IH w later eq_refl).
    change (arrives (v :: w :: later)) with (arrives (w :: later)). lia.
Qed.

Lemma priced_plan_is_not_negative p : In p (plans s) -> 0 <= priced_plan p.
Proof.
  intros Hp. destruct (plan_is_a_way i s right lawful p Hp) as (a & Ha & E & W).
  pose proof (nothing_is_paid_below_0 tf (all_prices i c) prices_are_held (visits p)).
  pose proof (plans_lawful i s lawful p a Hp Ha E) as L.
  destruct (starts_at_release i a p L) as (v & rest & V & _ & T).
  pose proof (way_does_not_arrive_before_it_starts a (visits p) Ha W v rest V) as A.
  pose proof (no_fees_are_below_0 (plan_robot p) (visits p)) as Fees.
  unfold priced_plan, own_plan. rewrite (cost_is_of_robot a p) by auto. unfold cost, arrival. rewrite V in *.
  change (fold_left (fun _ v => enter v) (v :: rest) (release a)) with (arrives (v :: rest)).
  assert (0 <= weight_of c (plan_robot p)) by (apply weights_right; rewrite <- E; apply in_map, Ha). nia.
Qed.

(** What an accepted claim says of the robot's plans, if there are any. *)
Lemma accepted_claim_is_below_plans a claimed_least e : In a (robots i) ->
  claim_accepted i tf successors (takes_in table a) (weight_of c (robot_id a)) a (dues_of c (robot_id a))
    claimed_least e = true ->
  match claimed_least with Some n => n | None => 0 end <=
  sum (fun p => Z.b2z (robot_id a =? plan_robot p) * priced_plan p) (plans s).
Proof.
  intros Ha H.
  assert (Positive : forall p, In p (plans s) -> 0 <= Z.b2z (robot_id a =? plan_robot p) * priced_plan p).
  { intros p Hp. pose proof (priced_plan_is_not_negative p Hp). destruct (_ =? _); simpl Z.b2z; lia. }
  destruct claimed_least as [n |]; [| apply sum_is_not_negative, Positive].
  unfold claim_accepted in H. apply andb_true_iff in H as [Rests H]. apply andb_true_iff in H as [H Leads].
  apply andb_true_iff in H as [Start Closed].
  assert (P : In (robot_id a) (planned s)).
  { apply complete; auto. apply (leads_on_leads successors i _ (way e)); auto.
    intros r t Hm. apply successors_are_moves; auto. }
  apply in_map_iff in P as (p & E & Hp).
  apply Z.le_trans with (Z.b2z (robot_id a =? plan_robot p) * priced_plan p);
    [| apply (sum_is_above_each _ _ p Positive Hp)].
  rewrite E, Z.eqb_refl. simpl Z.b2z. rewrite Z.mul_1_l. unfold priced_plan, own_plan, fees.
  rewrite (cost_is_of_robot a p), E, Z.add_assoc by auto.
  eapply (claim_is_below_every_plan i tf successors (takes_in table a) a
    (Claim n (weight_of c (robot_id a)) _ _ (fees_at_arrival (dues_of c (robot_id a)))
      (fees_on_the_way (dues_of c (robot_id a)))) (all_prices i c) p right Ha
    prices_are_held).
  - intros r t. apply successors_are_moves, right.
  - intros r. apply takes_what_is_needed, right.
  - constructor.
    + exact Start.
    + intros r t label L. simpl in L. apply found_pair_is_listed in L.
      apply (proj1 (forallb_forall _ _) Closed _ L).
    + apply forallb_forall, Rests.
    + apply weights_right, in_map, Ha.
    + apply fees_at_arrival_are_not_negative.
    + apply fees_on_the_way_are_not_negative.
    + apply fees_on_the_way_add_up.
  - apply (plans_lawful i s lawful p a); auto.
Qed.

Lemma accepted_claims_are_below_plans robots' : forall claims' all',
  (forall a, In a robots' -> In a (robots i)) -> refused_claims i tf successors table c robots' claims' all' = None ->
  sum (fun k => match snd k with Some n => n | None => 0 end) claims' <=
  sum (fun a => sum (fun p => Z.b2z (robot_id a =? plan_robot p) * priced_plan p) (plans s)) robots'.
Proof.
  induction robots' as [| a robots' IH]; intros [| [id claimed_least] claims'] [| e all'] K H;
    try discriminate; try (simpl; lia). simpl in H.
  destruct (Z.eqb_spec id (robot_id a)) as [-> |]; [| discriminate].
  destruct (claim_accepted i tf successors _ _ a _ claimed_least (e tt)) eqn:C; [| discriminate].
  apply accepted_claim_is_below_plans in C; [| apply K; left; auto].
  assert (IHr := IH claims' all' (fun b Hb => K b (or_intror Hb)) H). simpl in *. lia.
Qed.

Lemma each_plan_counts_once :
  sum (fun a => sum (fun p => Z.b2z (robot_id a =? plan_robot p) * priced_plan p) (plans s)) (robots i) =
  sum priced_plan (plans s).
Proof.
  rewrite sums_are_exchanged. apply sum_of_equal. intros p Hp.
  rewrite (sum_of_equal _ (fun a => priced_plan p * Z.b2z (robot_id a =? plan_robot p))) by (intros; lia).
  rewrite sum_of_multiples, one_of_different_ids; [lia | apply (robot_ids_are_unique i right) |].
  apply (covers_robots i s lawful), in_or_app. left. apply in_map, Hp.
Qed.

Lemma total_is_the_sum : total_cost i s = sum (cost_of_plan i) (plans s).
Proof. apply total_of_is_the_sum. Qed.

(** What the robots' own ticks count is what is left by the cuts. *)
Lemma cuts_count_the_rest :
  sum (fun p => weight_of c (plan_robot p) * cost_of_plan i p) (plans s) =
  scale c * total_cost i s - sum (fun k => multiplier k * sum (cost_of_robot i s) (members k)) (cuts c).
Proof.
  rewrite total_is_the_sum, <- sum_of_multiples.
  assert (E : sum (fun k => multiplier k * sum (cost_of_robot i s) (members k)) (cuts c) =
    sum (fun p => sum (fun k => multiplier k * sum (fun m => Z.b2z (m =? plan_robot p)) (members k)) (cuts c) *
      cost_of_plan i p) (plans s)).
  { rewrite (sum_of_equal _
    (fun k => sum (fun p => multiplier k * sum (fun m => Z.b2z (m =? plan_robot p)) (members k) *
      cost_of_plan i p) (plans s))).
    - rewrite sums_are_exchanged. apply sum_of_equal. intros p _. rewrite Z.mul_comm, <- sum_of_multiples.
      apply sum_of_equal. intros. lia.
    - intros k _. unfold cost_of_robot. rewrite sums_are_exchanged, <- sum_of_multiples. apply sum_of_equal.
      intros p _. rewrite <- Z.mul_assoc. f_equal. rewrite Z.mul_comm, <- sum_of_multiples. apply sum_of_equal.
      intros m _. rewrite Z.eqb_sym. destruct (_ =? _); simpl Z.b2z; lia. }
  rewrite E. assert (S : forall (f g h : plan -> Z) l, (forall p, f p = g p - h p) -> sum f l = sum g l - sum h l).
  { intros f g h l H. induction l as [| p l IH]; simpl; [lia |]. rewrite H. lia. }
  apply S. intros p. unfold weight_of. lia.
Qed.

Lemma all_parts_are_below_the_total : refused_claims i tf successors table c (robots i) (claims c) all = None ->
  parts i table c <= scale c * total_cost i s.
Proof.
  intros H. apply accepted_claims_are_below_plans in H; auto. rewrite each_plan_counts_once in H.
  unfold priced_plan in H. rewrite sum_of_sums in H. unfold own_plan in H.
  rewrite sum_of_sums, cuts_count_the_rest in H.
  pose proof fees_are_no_more_than_their_worth as Fees.
  pose proof (all_pay_no_more_than_prices_times_capacities i s right lawful (prices c) own_prices_right) as Paid.
  pose proof (all_pay_no_more_than_group_prices_times_capacities i s right lawful (group_prices c) group_prices_right)
    as Group_paid.
  rewrite (sum_of_equal (fun p => paid (all_prices i c) (visits p)) (fun p => paid (prices c) (visits p) +
    paid (flat_map (prices_within i) (group_prices c)) (visits p))) in H by (intros; apply paid_of_joined).
  rewrite sum_of_sums in H.
  unfold parts. rewrite !total_of_is_the_sum.
  rewrite (sum_of_equal (fun x => amount x * room_in table (place x)) (fun x => amount x * room i (place x)))
    by (intros; unfold table; rewrite room_is_looked_up; auto).
  assert (sum (fun k => multiplier k * least_total k) (cuts c) <=
    sum (fun k => multiplier k * sum (cost_of_robot i s) (members k)) (cuts c)).
  { apply sum_is_monotone. intros k Hk. apply Z.mul_le_mono_nonneg_l; auto. apply cuts_hold, Hk. }
  unfold worth in Paid. lia.
Qed.

End Instance.

(** bound/robots: a robot has no claim only where no way leads to its goal. *)
Theorem robot_without_a_claim_has_no_way i tf own a dues e : Well_formed i -> In a (robots i) ->
  claim_accepted i tf (listed (successor_table i)) (takes_in (resource_table i) a) own a dues None e = true ->
    ~ Plannable i a.
Proof.
  intros right Ha H. unfold claim_accepted in H. apply andb_true_iff in H as [Least H].
  apply andb_true_iff in H as [Elsewhere Start]. apply negb_true_iff, Z.eqb_neq in Elsewhere.
  unfold Plannable. intros L. remember (goal a) as to eqn:To. revert Elsewhere Start. generalize dependent (start a).
  intros from L. induction L as [r | r s to M L IH]; intros Elsewhere Start; [congruence |]. subst to.
  destruct (moves_join_resources i right r s M) as (_ & Hr & _).
  pose proof (proj1 (forallb_forall _ _) Least r Hr) as N. unfold rests_are_least in N.
  pose proof (proj1 (forallb_forall _ _) N s (proj2 (successors_are_moves i r s right) M)) as K. simpl in K.
  destruct (Map.find r (index fst (ticks_after e))); [discriminate |]. apply andb_true_iff in K as [K1 K2].
  apply negb_true_iff, Z.eqb_neq in K1. apply IH; auto.
Qed.

(** No lawful solution that plans every robot with a way to its goal costs less than an accepted bound, if its cuts and
    its groups with deadlines hold. *)
Theorem accepted_bound_is_below_every_solution i s c all : Well_formed i -> bound_accepted i c all = true ->
  Lawful i s -> Plans_every_plannable_robot i s -> (forall k, In k (cuts c) -> Cut_holds i s k) ->
  (forall g, In g (groups c) -> Group_holds s g) -> bound c <= total_cost i s.
Proof.
  intros right H lawful complete cuts_hold groups_hold. unfold bound_accepted, broken_rule in H.
  destruct (scale_accepted c) eqn:Scaled; [| discriminate]. cbn [negb] in H.
  destruct (forallb (price_accepted _ _ _ c) (prices c)) eqn:Priced; [| discriminate]. cbn [negb] in H.
  destruct (forallb (group_price_accepted i c) (group_prices c)) eqn:Groups_priced; [| discriminate]. cbn [negb] in H.
  destruct (prices_are_different c); [| discriminate]. cbn [negb] in H.
  destruct (size_accepted i c); [| discriminate]. cbn [negb] in H.
  destruct (cuts_accepted i c) eqn:Cutted; [| discriminate]. cbn [negb] in H.
  destruct (groups_accepted c) eqn:Grouped; [| discriminate]. cbn [negb] in H.
  destruct (refused_claims _ _ _ _ c _ _ all) eqn:Claimed; [discriminate |].
  destruct (total_accepted _ _ c) eqn:Totalled; [| discriminate].
  apply andb_true_iff in Scaled as [Scaled _]. apply Z.ltb_lt in Scaled. apply Z.eqb_eq in Totalled.
  apply andb_true_iff in Cutted as [Multipliers Weights]. rewrite forallb_forall in Multipliers, Weights, Priced.
  assert (P : parts i (resource_table i) c <= scale c * total_cost i s).
  { apply (all_parts_are_below_the_total i s c all); auto.
    - intros x Hx. specialize (Priced x Hx). unfold price_accepted in Priced. rewrite !andb_true_iff in Priced.
      destruct Priced as ((((A & _) & _) & K) & O). apply Z.leb_le in A. apply Ids.contains_of_list in K.
      repeat split; auto. destruct (other x) as [o |]; auto. rewrite !andb_true_iff in O. destruct O as ((O & _) & _).
      apply Ids.contains_of_list in O. exact O.
    - intros x Hx. pose proof (proj1 (forallb_forall _ _) Groups_priced x Hx) as A. unfold group_price_accepted in A.
      rewrite !andb_true_iff in A. destruct A as (((A & _) & _) & _). apply Z.leb_le in A. exact A.
    - intros id Hid. apply Z.leb_le, Weights, Hid.
    - intros k Hk. specialize (Multipliers k Hk). rewrite !andb_true_iff in Multipliers.
      destruct Multipliers as ((((M & _) & _) & _) & _). apply Z.leb_le in M. exact M.
    - intros g Hg. apply Z.leb_le, (proj1 (forallb_forall _ _) Grouped g Hg). }
  rewrite Totalled. pose proof (Z.mul_div_le (- parts i (resource_table i) c) (scale c) Scaled).
  pose proof (Z.mod_pos_bound (- parts i (resource_table i) c) (scale c) Scaled).
  pose proof (Z.div_mod (- parts i (resource_table i) c) (scale c)). nia.
Qed.
