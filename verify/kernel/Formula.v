(** The formula of plans of a group of robots that cost less than a total together, or that all keep their deadlines:
    each clause comes with a reason, and a clause whose reason holds is kept by every lawful solution with such plans of
    the group. So if the formula has no model, no solution has them.

    Who wrote the clauses, and in which order, does not matter. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Checker Ways Prices Labels Tables Bound Refutation Routes.
Import ListNotations.
Open Scope Z_scope.

(** What a variable says of a solution. *)
Inductive meaning :=
(** The robot is free to leave the resource at the tick. *)
| Free (id place tick : Z)
(** The robot costs at least [least]. *)
| Costs (id least : Z)
(** The robot is in the resource at the tick. *)
| Present (id place tick : Z)
(** True; the clauses use it of a robot that vanishes at its start, where it is for its duration. *)
| Stands (id : Z)
(** The robots with ranks in [first, end_) are at least [least] ticks late together. *)
| Delayed (first end_ least : Z)
(** The robot counts at the tick in the limit of the key: in a resource, or in a group. *)
| Counted (id key tick : Z)
(** At least [least] robots with seats in [first, end_) count at the tick in the limit of the key. *)
| Crowded (first end_ key tick least : Z).

(** The plans of the group that a formula asks for: any lawful ones, those that cost less than a total together, or
    those that keep deadlines. *)
Inductive demand :=
| Lawful_plans
| Cheaper_than (total : Z)
| In_time (due : list deadline).

(** Why a clause holds. *)
Inductive reason :=
| Starts (id : Z)
| Waits_moves_or_arrives (id place tick : Z)
| Waited_or_moved (id place tick : Z)
| Passes (id place tick : Z)
| Arrives (id cost : Z)
| Costs_one_way (id cost : Z)
| Is_there (id place tick : Z)
| Stands_there
| Adds_delays
| Is_counted (id key tick : Z)
| Adds_robots (key tick : Z)
| Is_full
| Are_two (one other key tick : Z)
| Exchange (one other source target from to tick : Z)
| Is_cheaper
| Is_in_time (id : Z)
| Is_seen (id : Z)
| Is_seen_elsewhere (id place tick : Z).

(** What the clauses of a robot rest on: its rank among the delays that are added up, its seat among the robots that are
    counted, its least cost, the least ticks from leaving a resource to entering the goal, the least tick at which it is
    free to leave a resource, and resources that lead from its start to its goal. *)
Record guide := Guide { rank : Z; seat : Z; shortest : Z; rests : Map.t Z; firsts : Map.t Z; leads : list Z }.

(** A formula with the guides of the robots in the group's order, the meanings of its variables and the reasons of
    its clauses. *)
Record blueprint := Blueprint {
  guides : list guide;
  meanings : Numbered.t meaning;
  reasons : list reason;
  formula : list clause
}.

(** * The checker *)

Definition member := (robot * guide)%type.

(** What the checker looks up. *)
Record tables := Tables {
  policy : after;
  places : Map.t resource;
  onwards : Z -> list Z;
  backwards : Z -> list Z;
  crew : list member;
  member_of : Map.t member;
  demanded : list deadline;
  dues : Map.t deadline;
  limit_at : Map.t (Z * limit);
  keys_of_close : Map.t (list Z);
  longer : Z
}.

Definition predecessor_table (i : instance) : Map.t (list Z) :=
  fold_left (fun m e => enlist (snd e) (fst e) m) (moves_of_graph i) (Map.empty (list Z)).

Definition tables_of (i : instance) (group : list robot) (asked : demand) (b : blueprint) : tables :=
  let all := combine group (guides b) in
  let moves := successor_table i in
  let back := predecessor_table i in
  let demanded := match asked with In_time due => due | _ => [] end in
  let known := lookup_of i in
  Tables (after_goal i) (resource_table i) (listed moves) (listed back) all (index (fun m => robot_id (fst m)) all)
    demanded (index who demanded) (limit_of known) (swap_keys known) (gap i).

Section Checker.
Variable w : tables.

(** The tick at which the robot is seen, if it is: of more than one, that of its last deadline. *)
Definition seen_tick (id : Z) : option Z :=
  match Map.find id (dues w) with
  | Some d => match seen d with Some s => Some (seen_at s) | None => None end
  | None => None
  end.

(** A robot that is seen is described up to then. *)
Definition is_described (id t : Z) : bool := match seen_tick id with Some last => t <=? last | None => true end.

(** A robot may go on from its goal if it parks, or is seen. *)
Definition goes_through (a : robot) : bool :=
  match policy w, seen_tick (robot_id a) with Vanish, None => false | _, _ => true end.

Definition is_passable (a : robot) (r : Z) : bool := passable (goes_through a) a r.

(** ** Guides *)

Definition at_most (x : option Z) (y : Z) : bool := match x with Some n => n <=? y | None => false end.

(** Along the moves from a resource the rests fall, and the firsts rise, by no more than the durations. *)
Definition guides_moves (m : member) (r : Z) : bool :=
  let (a, g) := m in
  let rest := Map.find r (rests g) in
  let first := Map.find r (firsts g) in
  forallb (fun s =>
    let ticks := takes_in (places w) a s in
    (negb (s =? goal a) || at_most rest 0) &&
    match Map.find s (rests g) with
    | None => true
    | Some after =>
        at_most rest (ticks + after) &&
        match first with
        | Some ready => negb (is_passable a s) || at_most (Map.find s (firsts g)) (ready + ticks)
        | None => true
        end
    end) (onwards w r).

Definition guide_accepted (ids : list Z) (m : member) : bool :=
  let (a, g) := m in
  let ticks := takes_in (places w) a (start a) in
  leads_on (onwards w) (start a) (leads g) (goal a) &&
  forallb (guides_moves m) ids &&
  at_most (Map.find (start a) (firsts g)) (release a + ticks) &&
  (if start a =? goal a then shortest g <=? 0
   else match Map.find (start a) (rests g) with Some rest => shortest g <=? ticks + rest | None => false end).

(** ** Clauses *)

(** A literal: whether the variable's meaning must be true. *)
Definition signed := (bool * meaning)%type.

Definition of_robot (id : Z) (f : robot -> guide -> bool) : bool :=
  match Map.find id (member_of w) with Some (a, g) => f a g | None => false end.

(** The clause holds if the robot is not free to leave the resource at the tick. *)
Definition unless_free (c : list signed) (id r t : Z) : bool :=
  existsb (fun l => match l with (false, Free id' r' t') => (id' =? id) && (r' =? r) && (t' =? t) | _ => false end) c.

(** The clause holds if the robot costs at least x. *)
Definition if_costs (c : list signed) (id x : Z) : bool :=
  existsb (fun l => match l with (true, Costs id' y) => (id' =? id) && (y <=? x) | _ => false end) c.

(** The clause holds if the robot costs less than x. *)
Definition if_cheaper (c : list signed) (id x : Z) : bool :=
  existsb (fun l => match l with (false, Costs id' y) => (id' =? id) && (x <=? y) | _ => false end) c ||
  of_robot id (fun _ g => x <=? shortest g).

(** The clause holds if the robot is free to leave the resource at the tick, or it cannot be so. *)
Definition if_free (c : list signed) (id r t : Z) : bool :=
  existsb (fun l => match l with (true, Free id' r' t') => (id' =? id) && (r' =? r) && (t' =? t) | _ => false end) c ||
  of_robot id (fun a g =>
    negb (is_passable a r) ||
    match Map.find r (firsts g) with Some ready => t <? ready | None => true end ||
    match Map.find r (rests g) with Some rest => if_costs c id (t + rest - release a) | None => true end).

(** The clause holds if the robot is not in the resource at the tick. *)
Definition unless_present (c : list signed) (id r t : Z) : bool :=
  is_described id t &&
  of_robot id (fun a g =>
    let ticks := takes_in (places w) a r in
    existsb (fun l =>
      match l with
      | (false, Present id' r' t') => (id' =? id) && (r' =? r) && (t' =? t)
      | (false, Free id' r' u) => (id' =? id) && (r' =? r) && (t <? u) && (u <=? t + ticks)
      | (false, Stands id') =>
          (id' =? id) && negb (is_passable a r) && (start a =? r) && (release a <=? t) && (t <? release a + ticks)
      | _ => false
      end) c ||
    (r =? goal a) && if_costs c id (t + 1 - release a) &&
      match policy w with Park => true | Vanish => if_cheaper c id (t + 1 - release a - ticks) end).

(** The clause holds if the robot does not count in the limit at the tick. *)
Definition unless_counted (c : list signed) (id key t : Z) : bool :=
  (existsb (fun l => match l with (false, Counted id' key' t') => (id' =? id) && (key' =? key) && (t' =? t) | _ => false end)
     c ||
   match Map.find key (limit_at w) with
   | Some (_, l) =>
       existsb (fun place =>
         unless_present c id place t || (0 <? longer w) && unless_present c id place (t - longer w)) (limit_places l)
   | None => false
   end) && of_robot id (fun _ _ => true).

(** The resources are the same, or share a group of capacity 1. *)
Definition are_close (r s : Z) : bool :=
  existsb (fun key => existsb (Z.eqb key) (listed (keys_of_close w) s)) (listed (keys_of_close w) r).

(** The clause holds if the robot is free to leave the resource at the tick: it waited there, as far as it is described,
    or moved there, and did not start there. *)
Definition if_came (c : list signed) (id r t : Z) : bool :=
  of_robot id (fun a _ =>
    let ticks := takes_in (places w) a r in
    (negb (is_described id (t - 1)) || if_free c id r (t - 1)) &&
    forallb (fun s => if_free c id s (t - ticks)) (backwards w r) &&
    negb ((r =? start a) && (t =? release a + ticks))).

(** ** Sums: what a false literal says of robots in a range, and what makes a literal true *)

Definition delays_if_false (l : signed) : option (Z * Z * Z) :=
  match l with
  | (false, Delayed first end_ least) => Some (first, end_, least)
  | (false, Costs id least) =>
      match Map.find id (member_of w) with
      | Some (_, g) => Some (rank g, rank g + 1, least - shortest g)
      | None => None
      end
  | _ => None
  end.

Definition true_if_delays (l : signed) : option (Z * Z * Z) :=
  match l with (true, Delayed first end_ least) => Some (first, end_, least) | _ => None end.

Definition robot_of_meaning (m : meaning) : Z :=
  match m with
  | Free id _ _ | Costs id _ | Present id _ _ | Stands id | Counted id _ _ => id
  | Delayed _ _ _ | Crowded _ _ _ _ _ => 0
  end.

Definition robots_if_false (key t : Z) (l : signed) : option (Z * Z * Z) :=
  let id := robot_of_meaning (snd l) in
  match l with
  | (false, Crowded first end_ key' t' least) => if (key' =? key) && (t' =? t) then Some (first, end_, least) else None
  | _ =>
      match Map.find id (member_of w) with
      | Some (_, g) => if unless_counted [l] id key t then Some (seat g, seat g + 1, 1) else None
      | None => None
      end
  end.

Definition true_if_robots (key t : Z) (l : signed) : option (Z * Z * Z) :=
  match l with
  | (true, Crowded first end_ key' t' least) => if (key' =? key) && (t' =? t) then Some (first, end_, least) else None
  | _ => None
  end.

(** The clause adds up one or two numbers: if its other literals are false, its last one is true. *)
Definition adds (if_false true_if : signed -> option (Z * Z * Z)) (c : list signed) : bool :=
  match c with
  | [l; total] =>
      match if_false l, true_if total with
      | Some (first, end_, n), Some (first', end', least) => (first' <=? first) && (end_ <=? end') && (least <=? n)
      | _, _ => false
      end
  | [l; k; total] =>
      match if_false l, if_false k, true_if total with
      | Some (first, middle, n), Some (middle', end_, m), Some (first', end', least) =>
          (first' <=? Z.min first middle') && (middle <=? middle') && (Z.max middle end_ <=? end') && (least <=? n + m)
      | _, _, _ => false
      end
  | _ => false
  end.

Definition room_below (key n : Z) : bool :=
  match Map.find key (limit_at w) with Some (_, l) => limit_capacity l <? n | None => false end.

(** ** What is demanded *)

(** The delays of the group's robots together are below this, if the solution costs less than the total. *)
Definition delays_below (total : Z) : Z := total - sum (fun m : member => shortest (snd m)) (crew w).

Definition too_late (asked : demand) (c : list signed) : bool :=
  match asked with
  | Cheaper_than total =>
      let most := delays_below total in
      (most <=? 0) ||
      existsb (fun l => match delays_if_false l with Some (_, _, n) => most <=? n | None => false end) c
  | _ => false
  end.

(** f holds at each tick from [first] up to, not including, [end_]. *)
Definition always (f : Z -> bool) (first end_ : Z) : bool := span (fun t => Z.b2z (negb (f t))) first end_ =? 0.

(** The clause holds if the robot comes no later than it must: by its deadline, or on a shortest way from a spot where
    it is seen. *)
Definition if_in_time (c : list signed) (id : Z) : bool :=
  of_robot id (fun a g =>
    match Map.find id (dues w) with
    | Some d =>
        if_cheaper c id (last_arrival d + 1 - release a) &&
        match seen d with
        | Some s =>
            forallb (fun r =>
              match Map.find r (rests g) with
              | Some rest =>
                  if_cheaper c id (seen_at s + takes_in (places w) a r + Z.max 0 rest + 1 - release a)
              | None => true
              end) (spots s)
        | None => true
        end
    | None => false
    end).

Definition is_free_at (r : Z) (l : signed) : bool := match snd l with Free _ r' _ => r' =? r | _ => false end.

(** The clause holds if the robot arrives by the deadline or is seen in a spot. A robot that is in a resource is free to
    leave it at the next tick, or later, first within the resource's duration. *)
Definition if_seen_by (c : list signed) (a : robot) (d : deadline) : bool :=
  let id := robot_id a in
  (who d =? id) && if_cheaper c id (last_arrival d + 1 - release a) &&
  match seen d, seen_tick id with
  | Some s, Some last =>
      (seen_at s <=? last) &&
      forallb (fun r =>
        let here := filter (is_free_at r) c in
        always (fun t => if_free here id r t || if_came here id r t)
          (seen_at s + 1) (seen_at s + takes_in (places w) a r + 1)) (spots s)
  | _, _ => false
  end.

(** The clause holds because of one of the robot's deadlines. *)
Definition if_seen (c : list signed) (id : Z) : bool := of_robot id (fun a _ => existsb (if_seen_by c a) (demanded w)).

(** The robot is not free to leave the resource at the tick, as it is seen elsewhere just before. *)
Definition is_seen_elsewhere (id r t : Z) : bool :=
  of_robot id (fun a _ =>
    existsb (fun d =>
      (who d =? id) &&
      match seen d, seen_tick id with
      | Some s, Some last =>
          (seen_at s <=? last) && (seen_at s <? t) && (t <=? seen_at s + takes_in (places w) a r) &&
          negb (existsb (Z.eqb r) (spots s))
      | _, _ => false
      end) (demanded w)).

(** The reason holds for the clause. *)
Definition justified (asked : demand) (c : list signed) (why : reason) : bool :=
  match why with
  | Starts id =>
      of_robot id (fun a _ =>
        if_free c id (start a) (release a + takes_in (places w) a (start a)) &&
        (negb (start a =? goal a) || if_cheaper c id 1))
  | Waits_moves_or_arrives id r t =>
      of_robot id (fun a _ =>
        is_described id t && unless_free c id r t && if_free c id r (t + 1) &&
        forallb (fun s =>
          if_free c id s (t + takes_in (places w) a s) &&
          (negb (s =? goal a) || if_cheaper c id (t + 1 - release a))) (onwards w r))
  | Waited_or_moved id r t => unless_free c id r t && if_came c id r t
  | Passes id r t => of_robot id (fun _ _ => unless_free c id r t && if_free c id r t)
  | Arrives id cost =>
      of_robot id (fun a _ =>
        is_described id (release a + cost) && if_costs c id (cost + 1) && if_cheaper c id cost &&
        forallb (fun s => if_free c id s (release a + cost)) (backwards w (goal a)) &&
        negb ((start a =? goal a) && (cost =? 0)))
  | Costs_one_way id cost => of_robot id (fun _ _ => if_costs c id cost && if_cheaper c id cost)
  | Is_there id r t =>
      unless_present c id r t &&
      existsb (fun l =>
        match l with (true, Present id' r' t') => (id' =? id) && (r' =? r) && (t' =? t) | _ => false end) c
  | Is_counted id key t =>
      unless_counted c id key t &&
      existsb (fun l =>
        match l with (true, Counted id' key' t') => (id' =? id) && (key' =? key) && (t' =? t) | _ => false end) c
  | Stands_there => existsb (fun l => match l with (true, Stands _) => true | _ => false end) c
  | Adds_delays => adds delays_if_false true_if_delays c
  | Adds_robots key t => adds (robots_if_false key t) (true_if_robots key t) c
  | Is_full => existsb (fun l => match l with (false, Crowded _ _ key _ n) => room_below key n | _ => false end) c
  | Are_two one other key t =>
      negb (one =? other) && room_below key 2 && unless_counted c one key t && unless_counted c other key t
  | Exchange one other r s from to t =>
      negb (one =? other) && negb (r =? s) && negb (from =? to) && are_close r to && are_close s from &&
      unless_free c one r t && unless_free c other from t && unless_present c one s t && unless_present c other to t
  | Is_cheaper => too_late asked c
  | Is_in_time id => if_in_time c id
  | Is_seen id => if_seen c id
  | Is_seen_elsewhere id r t => unless_free c id r t && is_seen_elsewhere id r t
  end.

(** A literal as its variable's meaning has it; one without a meaning is left out. *)
Definition read_literal (known : Numbered.t meaning) (l : literal) : option signed :=
  match Numbered.find (Z.abs l) known with
  | Some m => if l =? 0 then None else Some (0 <? l, m)
  | None => None
  end.

Fixpoint read_clause (known : Numbered.t meaning) (c : clause) : list signed :=
  match c with
  | [] => []
  | l :: rest =>
      match read_literal known l with Some s => s :: read_clause known rest | None => read_clause known rest end
  end.

Fixpoint all_justified (asked : demand) (known : Numbered.t meaning) (f : list clause) (why : list reason) : bool :=
  match f, why with
  | [], _ => true
  | c :: f', r :: why' =>
      if justified asked (read_clause known c) r then all_justified asked known f' why' else false
  | _ :: _, [] => false
  end.

End Checker.

(** Every clause of the formula is kept by every lawful solution that plans every robot and in which the group does what
    is demanded. *)
Definition blueprint_accepted (i : instance) (group : list robot) (asked : demand) (b : blueprint) : bool :=
  let w := tables_of i group asked b in
  (length (guides b) =? length group)%nat &&
  forallb (guide_accepted w (resource_ids i)) (crew w) &&
  all_justified w asked (meanings b) (formula b) (reasons b).

Definition refuted (i : instance) (asked : demand) (b : blueprint) (lines : list (list word)) : bool :=
  blueprint_accepted i (robots i) asked b && refutes (formula b) lines.

(** The robots with these ids. *)
Definition group_of (i : instance) (ids : list Z) : list robot :=
  let known := index robot_id (robots i) in
  flat_map (fun id : Z => match Map.find id known with Some a => [a] | None => [] end) ids.

(** The same for the robots with these ids. *)
Definition group_refuted (i : instance) (ids : list Z) (asked : demand) (b : blueprint)
    (lines : list (list word)) : bool :=
  let group := group_of i ids in
  Ids.distinct ids && (length group =? length ids)%nat &&
  blueprint_accepted i group asked b && refutes (formula b) lines.

Definition cut_refuted (i : instance) (k : cut) : blueprint -> list (list word) -> bool :=
  group_refuted i (members k) (Cheaper_than (least_total k)).

(** The first of equal ids. *)
Fixpoint once (known ids : list Z) : list Z :=
  match ids with
  | [] => []
  | id :: rest => if existsb (Z.eqb id) known then once known rest else id :: once (id :: known) rest
  end.

(** A robot that is seen more than once has more than one deadline. *)
Definition deadlines_refuted (i : instance) (g : group) : blueprint -> list (list word) -> bool :=
  group_refuted i (once [] (map who (deadlines g))) (In_time (deadlines g)).

(** Each claim has a proof, which is made when the claim is checked. *)
Fixpoint all_refuted {A} (claim_refuted : A -> blueprint -> list (list word) -> bool) (claimed : list A)
    (proofs : list (unit -> blueprint * list (list word))) : bool :=
  match claimed, proofs with
  | [], _ => true
  | k :: claimed', proof :: proofs' =>
      let (b, lines) := proof tt in
      if claim_refuted k b lines then all_refuted claim_refuted claimed' proofs' else false
  | _ :: _, [] => false
  end.

(** All cuts and deadlines of the certificate. *)
Definition groups_refuted (i : instance) (c : certificate)
    (of_cuts of_deadlines : list (unit -> blueprint * list (list word))) : bool :=
  all_refuted (cut_refuted i) (cuts c) of_cuts && all_refuted (deadlines_refuted i) (groups c) of_deadlines.

(** * From the documents on *)

(** The instance is well-formed, and the certificate proves its bound. *)
Definition bound_proved (i : instance) (c : certificate) (all : list (unit -> evidence))
    (of_cuts of_deadlines : list (unit -> blueprint * list (list word))) : bool :=
  instance_accepted i && groups_refuted i c of_cuts of_deadlines && bound_accepted i c all.

(** The claim of a proof is that no plans cost less, or, without a cost, that there are none. *)
Definition demand_of (cost : option Z) : demand :=
  match cost with Some total => Cheaper_than total | None => Lawful_plans end.

(** The instance is well-formed, and the claim is proved. *)
Definition claim_proved (i : instance) (cost : option Z) (b : blueprint) (lines : list (list word)) : bool :=
  instance_accepted i && refuted i (demand_of cost) b lines.
