(** Certificates together with the documents that they are about: one query, and the audit of a solution, in which every
    plan, of whatever planner, is certified optimal against those before it in the planning order. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Timeline Journey Checker Windows Context Past QueryCertificate.
Import ListNotations.
Open Scope Z_scope.

(** The certificate is accepted, and its bound is no earlier than the plan's arrival. *)
Definition plan_is_certified (i : instance) (g : world) (c : context) (a : robot) (p : plan) (cert : certificate)
  : bool :=
  match bound cert with
  | Some tick => (arrival (release a) p <=? tick) && certificate_accepted i g c a 0 None cert
  | None => false
  end.

(** The first robot of the order whose plan is not certified, if there is one. *)
Fixpoint audit_from (i : instance) (g : world) (planned : Map.t plan) (certificates : Map.t (Z * certificate))
  (c : context) (order : list Z) : option Z :=
  match order with
  | [] => None
  | id :: later =>
    match Map.find id planned, Map.find id (robot_of (looked_up g)), Map.find id certificates with
    | Some p, Some a, Some (_, cert) =>
      if plan_is_certified i g c a p cert
      then audit_from i g planned certificates (commit (looked_up g) c p) later else Some id
    | _, _, _ => Some id
    end
  end.

(** Audit a lawful solution with a certificate for each robot that has a plan. *)
Definition audit (i : instance) (s : solution) (certificates : list (Z * certificate)) : option Z :=
  audit_from i (world_of i) (index plan_robot (plans s)) (index fst certificates) empty_context (order s).

(** The plans of the robots, in their order. *)
Definition In_planning_order (s : solution) (ids : list Z) (ps : list plan) : Prop :=
  Forall2 (fun id p => In p (plans s) /\ plan_robot p = id) ids ps.

(** The plans of the other robots, and the plan that the robot has followed, if it has one. *)
Definition others (s : solution) (id : Z) : list plan := filter (fun p => negb (plan_robot p =? id)) (plans s).
Definition own (s : solution) (id : Z) : option plan := find (fun p => plan_robot p =? id) (plans s).

(** The plans are lawful, each by itself, and of different robots of the instance. *)
Definition plans_accepted (i : instance) (known : lookup) (ps : list plan) : bool :=
  Ids.distinct (map plan_robot ps)
  && forallb (fun p => Map.mem (plan_robot p) (robot_of known)) ps
  && forallb (plan_of_robot_accepted i known) ps.

(** Verify the certificate of a query at the tick [now] for one robot against the plans of the others. *)
Definition query_accepted (i : instance) (s : solution) (id now : Z) (cert : certificate) : bool :=
  let g := world_of i in
  let known := looked_up g in
  instance_accepted i && plans_accepted i known (plans s) &&
  match Map.find id (robot_of known) with
  | Some a => certificate_accepted i g (context_of known (others s id)) a now (own s id) cert
  | None => false
  end.

(** Audit a solution: the instance is well-formed, the solution lawful, and each of its plans certified. *)
Definition audit_accepted (i : instance) (s : solution) (certificates : list (Z * certificate)) : bool :=
  solution_accepted i s && match audit i s certificates with None => true | Some _ => false end.

Section Instance.
Variable i : instance.
Hypothesis well_formed : Well_formed i.
Variable s : solution.
Hypothesis lawful : Lawful i s.

Lemma plans_are_distinct : NoDup (map plan_robot (plans s)).
Proof. destruct (covers_robots _ _ lawful) as [N _]. exact (distinct_in_front _ _ N). Qed.

Lemma robots_of_plans p : In p (plans s) -> exists a, In a (robots i) /\ robot_id a = plan_robot p.
Proof.
  intros P. destruct (covers_robots _ _ lawful) as [_ C].
  assert (I : In (plan_robot p) (robot_ids i)) by (apply C, in_or_app; left; apply in_map; exact P).
  apply in_map_iff in I as (a & E & A). eauto.
Qed.

Lemma in_planning_order_robots ids ps : In_planning_order s ids ps -> map plan_robot ps = ids.
Proof. intros H. induction H as [|id p ids ps [_ E] H IH]; simpl; congruence. Qed.

Lemma in_planning_order_plans ids ps : In_planning_order s ids ps -> forall p, In p ps -> In p (plans s).
Proof.
  intros H. induction H as [|id p ids ps [P _] H IH]; intros q Q; [destruct Q|]. destruct Q as [<-|Q]; auto.
Qed.

Lemma committed_before a ids later ps : In a (robots i) -> order s = ids ++ robot_id a :: later ->
  In_planning_order s ids ps -> Committed i a ps.
Proof.
  intros A E H. destruct (orders_plans _ _ lawful) as [N _]. rewrite E in N.
  assert (K : ~ In (robot_id a) ids).
  { apply NoDup_remove_2 in N. intros H'. apply N, in_or_app. auto. }
  pose proof (in_planning_order_plans _ _ H) as P. split.
  - intros p Q. apply robots_of_plans. auto.
  - intros p b Q. apply (plans_lawful _ _ lawful). auto.
  - rewrite (in_planning_order_robots _ _ H). exact (distinct_in_front _ _ N).
  - rewrite (in_planning_order_robots _ _ H). exact K.
Qed.

Lemma audit_from_is_right certificates ids : forall before committed c,
  order s = before ++ ids -> In_planning_order s before committed -> Represents i c committed ->
  audit_from i (world_of i) (index plan_robot (plans s)) certificates c ids = None ->
  forall front id later ps p a rival, ids = front ++ id :: later -> In_planning_order s (before ++ front) ps ->
  In p (plans s) -> plan_robot p = id -> In a (robots i) -> robot_id a = id -> Sound i a ps rival ->
  arrival (release a) p <= arrival (release a) rival.
Proof.
  induction ids as [|id ids IH]; intros before committed c E H R K; [intros [|x front]; discriminate|].
  cbn [audit_from] in K. cbn [looked_up world_of] in K.
  destruct (Map.find id (index plan_robot (plans s))) as [q|] eqn:Q; [|discriminate].
  apply find_in_index in Q as [Q F]; [|exact plans_are_distinct].
  destruct (Map.find id (robot_of (lookup_of i))) as [b|] eqn:B; [|discriminate].
  apply find_robot in B as [B G]; [|exact well_formed].
  destruct (Map.find id certificates) as [[x cert]|]; [|discriminate].
  destruct (plan_is_certified i (world_of i) c b q cert) eqn:D; [|discriminate].
  intros front id' later ps p a rival I O P J A L S. destruct front as [|y front]; injection I as <- I.
  - rewrite app_nil_r in O. subst id.
    assert (a = b) as <-.
    { assert (X : Map.find (robot_id a) (robot_of (lookup_of i)) = Some a) by (apply find_robot; auto).
      assert (Y : Map.find (robot_id a) (robot_of (lookup_of i)) = Some b) by (apply find_robot; auto; split;
        [exact B | congruence]).
      congruence. }
    assert (p = q) as <-.
    { apply (plan_of_robot_is_unique (plans s) plans_are_distinct p q P Q). congruence. }
    assert (ps = committed) as ->.
    { clear -O H lawful well_formed. revert committed H. induction O as [|z u zs us [U V] O IH]; intros committed H;
        inversion H as [|? w ? ws [W X] H']; subst; auto. f_equal; auto.
      apply (plan_of_robot_is_unique (plans s)); auto using plans_are_distinct. }
    unfold plan_is_certified in D. destruct (bound cert) as [tick|] eqn:T; [|discriminate].
    apply andb_true_iff in D as [D D']. apply Z.leb_le in D.
    pose proof (accepted_query_is_optimal i well_formed a committed c 0 None cert rival A) as Y.
    rewrite T in Y. simpl in Y. enough (tick <= arrival (release a) rival) by lia. apply Y; auto.
    + apply (committed_before a before ids); auto. congruence.
    + discriminate.
    + intros first rest V. destruct (leave first) as [l|] eqn:M; simpl; auto.
      destruct (sound_visit i well_formed a committed B rival S first) as (_ & _ & _ & _ & _ & X & Z).
      * rewrite V. left. auto.
      * rewrite M in Z. simpl in Z. lia.
  - apply (IH (before ++ [id]) (committed ++ [q]) (commit (lookup_of i) c q))
      with (front := front) (id := id') (later := later)
      (ps := ps); auto.
    + rewrite <- app_assoc. exact E.
    + apply Forall2_app; [exact H|]. constructor; auto.
    + apply commit_represents; auto.
    + rewrite <- app_assoc. exact O.
Qed.

(** In an audited solution no robot has a sound plan that arrives earlier, against the plans before it in the order. *)
Theorem audited_plans_are_optimal certificates : audit i s certificates = None ->
  forall before id later committed p a rival, order s = before ++ id :: later -> In_planning_order s before committed ->
  In p (plans s) -> plan_robot p = id -> In a (robots i) -> robot_id a = id -> Sound i a committed rival ->
  arrival (release a) p <= arrival (release a) rival.
Proof.
  intros H before id later committed p a rival O C.
  exact (audit_from_is_right (index fst certificates) (order s) [] [] empty_context eq_refl (Forall2_nil _)
    (empty_context_represents i well_formed) H before id later committed p a rival O C).
Qed.
End Instance.

(** query/optimal and query/complete, from the documents on: an accepted certificate leaves the robot no plan that
    breaks no rule, alone or together with the plans of the others, fits what it has done by [now], and arrives before
    the bound. *)
Theorem accepted_query_of_a_solution_is_optimal i s id now cert : query_accepted i s id now cert = true ->
  Well_formed i /\ forall a p, In a (robots i) -> robot_id a = id -> Sound i a (others s id) p ->
  Fits_the_past (own s id) p now -> Reaches (bound cert) (arrival (release a) p).
Proof.
  unfold query_accepted, plans_accepted. cbv zeta. cbn [looked_up world_of].
  rewrite !andb_true_iff, Ids.distinct_iff, !forallb_forall.
  intros [[W [[N K] L]] C]. apply instance_is_well_formed_exactly_when_accepted in W as V. split; [exact V|].
  rewrite <- forallb_forall in L. apply (plans_accepted_iff i V) in L.
  intros a p A E S F. destruct (Map.find id (robot_of (lookup_of i))) as [b|] eqn:B; [|discriminate].
  assert (b = a) as ->.
  { assert (X : Map.find id (robot_of (lookup_of i)) = Some a) by (apply find_robot; auto). congruence. }
  assert (R : forall q, In q (plans s) -> exists x, In x (robots i) /\ robot_id x = plan_robot q).
  { intros q Q. specialize (K q Q). apply Map_facts.mem_in_iff in K as [x X]. apply Map.find_1 in X.
    apply find_robot in X; [|exact V]. eauto. }
  apply (accepted_query_is_optimal i V a (others s id) (context_of (lookup_of i) (others s id)) now (own s id)
    cert p); auto.
  - unfold others. split.
    + intros q Q. apply filter_In in Q as [Q _]. auto.
    + intros q x Q. apply filter_In in Q as [Q _]. apply L. exact Q.
    + clear -N. induction (plans s) as [|q ps IH]; simpl in *; [constructor|]. inversion N as [|? ? Q M]; subst.
      destruct (negb (plan_robot q =? id)); simpl; auto. constructor; auto. intros H. apply Q.
      apply in_map_iff in H as (x & <- & X). apply filter_In in X as [X _]. apply in_map. exact X.
    + intros H. apply in_map_iff in H as (q & Q & H). apply filter_In in H as [_ H]. rewrite Q, E, Z.eqb_refl in H.
      discriminate.
  - apply context_of_represents. exact V.
  - intros before O. unfold own in O. apply find_some in O as [O P]. apply Z.eqb_eq in P. split; [congruence|].
    apply L; auto. congruence.
Qed.

(** In an audited solution, from the documents on, no robot has a sound plan that arrives earlier. *)
Theorem plans_of_an_accepted_audit_are_optimal i s certificates : audit_accepted i s certificates = true ->
  Well_formed i /\ Lawful i s /\
  forall before id later committed p a rival, order s = before ++ id :: later -> In_planning_order s before committed ->
  In p (plans s) -> plan_robot p = id -> In a (robots i) -> robot_id a = id -> Sound i a committed rival ->
  arrival (release a) p <= arrival (release a) rival.
Proof.
  unfold audit_accepted. rewrite andb_true_iff, accepted_solutions_are_exactly_the_lawful_ones. intros [[W L] A].
  destruct (audit i s certificates) eqn:E; [discriminate|]. split; [exact W|]. split; [exact L|].
  exact (audited_plans_are_optimal i W s L certificates E).
Qed.
