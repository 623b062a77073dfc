(** A lawful plan as a way: visit by visit from any of its visits to its end. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Stops.
Import ListNotations.
Open Scope Z_scope.

(** The least ticks that the robot needs in the resource of the id. *)
Definition need (i : instance) (a : robot) (id : Z) : Z :=
  match find (fun r => resource_id r =? id) (resources i) with Some r => least_stay a r | None => 1 end.

(** The ticks that a robot that vanishes needs for its last visit. *)
Definition last_need (i : instance) (a : robot) : Z := Z.max (need i a (goal a)) (service (last_stop a)).

(** Visits that keep the rules plan/goal, plan/move, plan/contiguous and plan/duration from the first on. *)
Inductive Way (i : instance) (a : robot) : list visit -> Prop :=
| Way_ends v : visit_resource v = goal a ->
    leave v = match after_goal i with Park => None | Vanish => Some (enter v + last_need i a) end -> Way i a [v]
| Way_goes_on v w rest : leave v = Some (enter w) -> enter v + need i a (visit_resource v) <= enter w ->
    Move i (visit_resource v) (visit_resource w) -> Way i a (w :: rest) -> Way i a (v :: w :: rest).

(** Moves lead from one resource to the other. *)
Inductive Leads (i : instance) : Z -> Z -> Prop :=
| Leads_nowhere r : Leads i r r
| Leads_on r s t : Move i r s -> Leads i s t -> Leads i r t.

(** A way leads to the robot's goal. *)
Definition Plannable (i : instance) (a : robot) : Prop := Leads i (start a) (goal a).

(** * What the rules of plans together say of single resources *)

(** No resource has more robots than fit in. *)
Definition Capacity_is_kept (i : instance) (ps : list plan) : Prop :=
  forall r tick ids, In r (resources i) -> NoDup ids ->
  (forall id, In id ids -> Occupies ps id (resource_id r) tick) -> Z.of_nat (length ids) <= capacity r.

Lemma capacity_is_kept i s : Lawful i s -> Capacity_is_kept i (plans s).
Proof.
  intros L r tick ids R N O. change (capacity r) with (limit_capacity (Limit [resource_id r] (capacity r))).
  apply (limits_are_kept i s L _ tick ids).
  - apply in_or_app. left. apply in_map_iff. eauto.
  - exact N.
  - intros id I. exists (resource_id r), 0. rewrite Z.sub_0_r. unfold gap.
    destruct (following_is_forbidden i); simpl; repeat split; auto; lia.
Qed.

(** No two robots swap two resources. *)
Definition Swaps_are_avoided (i : instance) (ps : list plan) : Prop :=
  forall one other r s tick, one <> other -> In r (resource_ids i) -> In s (resource_ids i) ->
  Makes_move ps one r s tick -> Makes_move ps other s r tick -> False.

Lemma swaps_are_avoided i s : Lawful i s -> Swaps_are_avoided i (plans s).
Proof.
  intros L one other r t tick N R T M O. apply (exchanges_are_avoided i s L one other r t t r tick); auto; left;
    reflexivity.
Qed.

Lemma exchanges_without_groups i ps : groups i = [] -> Swaps_are_avoided i ps -> Exchanges_are_avoided i ps.
Proof.
  intros G A one other r s s' r' tick N R S _ _ M O [<-|(g & H & _)] [<-|(h & K & _)]; rewrite ?G in *; try tauto.
  exact (A one other r s tick N R S M O).
Qed.

Section Well_formed_instance.
Variables (i : instance) (a : robot).
Hypothesis right : Well_formed i.
Hypothesis known : In a (robots i).

Lemma resource_is_found r : In r (resources i) -> find (fun x => resource_id x =? resource_id r) (resources i) = Some r.
Proof.
  pose proof (resource_ids_are_unique i right) as U. unfold resource_ids in U.
  induction (resources i) as [| x rest IH]; simpl; [intros [] |]. inversion U as [| ? ? Hx Hu]; subst.
  intros [-> | Hin]; [rewrite Z.eqb_refl; reflexivity |].
  destruct (Z.eqb_spec (resource_id x) (resource_id r)) as [E |]; auto.
  destruct Hx. rewrite E. apply in_map, Hin.
Qed.

Lemma need_is_least_stay r : In r (resources i) -> need i a (resource_id r) = least_stay a r.
Proof. intros H. unfold need. rewrite resource_is_found; auto. Qed.

Lemma need_is_positive id : 1 <= need i a id.
Proof.
  unfold need. destruct (find _ (resources i)) as [r |] eqn:E; [| lia]. apply find_some in E as [Hin _].
  unfold least_stay. pose proof (paces_are_positive i right a known). pose proof (durations_are_positive i right r Hin).
  nia.
Qed.

Lemma moves_join_resources r s :
  Move i r s -> r <> s /\ In r (resource_ids i) /\ In s (resource_ids i).
Proof. intros [H | [_ H]]; apply (edges_join_resources i right) in H; intuition. Qed.

Lemma lawful_plan_is_a_way p : Plan_lawful i a p -> Way i a (visits p).
Proof.
  intros H. destruct (ends_at_goal i a p H) as (before & last & E & G & L).
  assert (Suffix : forall later first, visits p = first ++ later ++ [last] -> Way i a (later ++ [last])).
  { induction later as [| v later IH]; intros first F; simpl.
    - apply Way_ends; auto. destruct (after_goal i); auto.
      destruct (proj1 (in_map_iff _ _ _) (goal_is_a_resource i a right known)) as (r & R & Hr).
      rewrite (L r Hr R). unfold last_need. rewrite <- R, need_is_least_stay; auto.
    - specialize (IH (first ++ [v])). rewrite <- app_assoc in IH. specialize (IH F).
      assert (C : exists w rest, later ++ [last] = w :: rest) by (destruct later; simpl; eauto).
      destruct C as (w & rest & W). simpl in F. rewrite W in *.
      assert (C : Consecutive p v w) by (exists first, rest; auto).
      assert (Hv : In v (visits p)) by (rewrite F; apply in_elt).
      assert (Hw : In w (visits p)) by (rewrite F; apply in_or_app; simpl; auto).
      pose proof (visits_resources i a p H v Hv) as Rv. pose proof (visits_resources i a p H w Hw) as Rw.
      pose proof (is_contiguous i a p H v w C) as Hl.
      apply Way_goes_on; auto; [| apply (follows_moves i a p H v w C); auto].
      apply in_map_iff in Rv as (r & R & Hr). rewrite <- R, need_is_least_stay by auto.
      pose proof (respects_durations i a p H v r (enter w) Hv Hr R Hl). lia. }
  rewrite E. apply (Suffix before []). exact E.
Qed.

Lemma first_visit_holds_its_entry v rest : Way i a (v :: rest) -> Holds v (enter v).
Proof.
  intros H. unfold Holds. split; [lia |]. inversion H as [v' Hg Hl | v' w later Hl Hn Hm Hw]; subst; rewrite Hl; simpl.
  - destruct (after_goal i); simpl; auto. pose proof (need_is_positive (goal a)). unfold last_need. lia.
  - pose proof (need_is_positive (visit_resource v)). lia.
Qed.

Lemma way_has_ways before later : Way i a (before ++ later) -> later <> [] -> Way i a later.
Proof.
  induction before as [| v before IH]; simpl; auto. intros H N. apply IH; auto.
  inversion H as [v' Hg Hl E | v' w rest Hl Hn Hm Hw E]; [| exact Hw].
  destruct before; [| discriminate]. simpl in *. congruence.
Qed.

End Well_formed_instance.
