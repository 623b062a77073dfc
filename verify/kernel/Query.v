(** The CARP query: the plan of one robot against committed plans that arrives earliest, by Dijkstra's algorithm over
    free windows. It is a model to read of carp_reference.query; QueryOptimal.v proves it right. *)
Require Import ZArith List Bool.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context Past.
Import ListNotations.
Open Scope Z_scope.

(** A label: the robot has made the visits [behind], enters the window [room] of a resource at the tick [entry], and
    may leave it from [ready_from] on. *)
Record label := Label { target : resource; room : window; entry : Z; ready_from : Z; behind : list visit }.

(** The visit to the label's resource, left at the tick ([None]: never). *)
Definition visit_until (l : label) (tick : option Z) : visit := Visit (resource_id (target l)) (entry l) tick.

(** Both labels are of the same window. *)
Definition same_window (one other : label) : bool :=
  (resource_id (target one) =? resource_id (target other)) && (opens (room one) =? opens (room other))
  && same_end (closes (room one)) (closes (room other)).

(** The label entered first; among equals the first of the list. *)
Fixpoint earliest (ls : list label) : option label :=
  match ls with
  | [] => None
  | l :: later =>
    match earliest later with
    | Some e => if entry e <? entry l then Some e else Some l
    | None => Some l
    end
  end.

Section Query.
(** The robot [a] is planned at the tick [now] in the context of the committed plans. *)
Variables (i : instance) (known : lookup) (c : context) (a : robot) (now : Z).

(** * One step *)

(** joint/exchange: the first tick from [tick] on at which no committed robot makes the opposite move. As many ticks
    as [moves_left] may be skipped. *)
Fixpoint first_allowed (from to : Z) (moves_left : nat) (tick : Z) : Z :=
  match moves_left with
  | S fewer => if is_exchange known c from to tick then first_allowed from to fewer (tick + 1) else tick
  | O => tick
  end.

(** The first tick at which the robot may leave where it is, the window is open, and the move is no exchange. *)
Definition first_entry (l : label) (r : resource) (w : window) : Z :=
  first_allowed (resource_id (target l)) (resource_id r) (Triples.S.cardinal (moves_made c))
    (Z.max (ready_from l) (opens w)).

(** window/fits: move into the window at that tick. The robot must still be in its own window then, and the least that
    it stays must fit into the new one. *)
Definition move_into (l : label) (r : resource) (w : window) : list label :=
  let least := least_stay a r in
  let tick := first_entry l r w in
  if lasts (room l) (Some tick) && holds_stay w tick (Some (tick + least))
  then [Label r w tick (tick + least) (behind l ++ [visit_until l (Some tick)])] else [].

(** Every window that one move leads to, entered as early as it can be. *)
Definition expand (l : label) : list label :=
  flat_map (fun r => flat_map (move_into l r) (windows_in c r))
    (filter (fun r => has_move known (resource_id (target l)) (resource_id r)) (resources i)).

(** * The search *)

(** Settle the window that is entered first, until none is left. The queue has labels of windows that are not settled.
    An earlier entry is never worse, as waiting in a window is free; so each window needs one label. *)
Fixpoint settle (windows_left : nat) (settled queue : list label) : list label :=
  match windows_left, earliest queue with
  | S fewer, Some l =>
    let settled := l :: settled in
    settle fewer settled (filter (fun e => negb (existsb (same_window e) settled)) (queue ++ expand l))
  | _, _ => settled
  end.

Definition number_of_windows : nat := length (flat_map (windows_in c) (resources i)).

(** The start and every window that the robot can enter. The start is not among the windows entered: a robot that has
    stayed at its goal too long to end there may come back to the same window. *)
Definition labels (from : label) : list label := from :: settle number_of_windows [] (expand from).

(** plan/goal: the plan can end with the label, for ever ([Park]) or one duration that is not over ([Vanish]). *)
Definition can_end (l : label) : bool :=
  (resource_id (target l) =? goal a) &&
  match after_goal i with Park => lasts (room l) None | Vanish => now <=? entry l + least_stay a (target l) end.

Definition plan_of (l : label) : plan :=
  let leave := match after_goal i with Park => None | Vanish => Some (entry l + least_stay a (target l)) end in
  Plan (robot_id a) (behind l ++ [visit_until l leave]).

(** fleet/history: the label of where the robot is, which it leaves as early as it may. Nothing if a committed plan
    stands in the way of what the robot has done. *)
Definition start_label (s : standing) : option label :=
  let stay := Visit (place s) (since s) (Some (ready s)) in
  match Map.find (place s) (resource_of known) with
  | None => None
  | Some r =>
    if allows known c (past s ++ [stay]) then
      option_map (fun w => Label r w (since s) (ready s) (past s))
        (find (fun w => holds_stay w (since s) (Some (ready s))) (windows_in c r))
    else None
  end.

(** The plan of least arrival from where the robot is, if it has one. *)
Definition plan_from (s : standing) : option plan :=
  match start_label s with
  | None => None
  | Some from => option_map plan_of (earliest (filter can_end (labels from)))
  end.

(** The plan of least arrival of a robot that has followed a plan until now, or none. A plan that has ended is kept. *)
Definition query_in_context (followed : option plan) : option plan :=
  let plan_on := plan_from (standing_of known a now followed) in
  match followed with
  | Some p => if has_ended p now then if allows known c (visits p) then Some p else None else plan_on
  | None => plan_on
  end.
End Query.

(** The query against committed plans. *)
Definition query (i : instance) (committed : list plan) (a : robot) (now : Z) (followed : option plan) : option plan :=
  let known := lookup_of i in query_in_context i known (context_of known committed) a now followed.
