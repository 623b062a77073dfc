(** A refuted total is impossible, and refuted deadlines are not all kept: the clauses of an accepted blueprint are kept
    by every lawful solution that plans every robot and in which those of the group do what is demanded. *)
Require Import ZArith List Bool Lia.
From Carproof Require Import Law Collections Checker Ways Prices Labels Tables Bound Refutation Routes Formula.
Import ListNotations.
Open Scope Z_scope.

(** The tables are those of the instance, and all guides are accepted. *)
Record Right_tables (i : instance) (asked : demand) (w : tables) : Prop := {
  policy_is_right : policy w = after_goal i;
  takes_are_right : forall a r, takes_in (places w) a r = need i a r;
  places_are_right : forall r x, Map.find r (places w) = Some x -> In x (resources i) /\ resource_id x = r;
  onwards_are_moves : forall r s, In s (onwards w r) <-> Move i r s;
  backwards_are_moves : forall r s, In s (backwards w r) <-> Move i s r;
  crew_is_known : forall m, In m (crew w) -> In (fst m) (robots i);
  crew_is_distinct : NoDup (map (fun m : member => robot_id (fst m)) (crew w));
  members_are_found : forall id m, Map.find id (member_of w) = Some m <-> In m (crew w) /\ robot_id (fst m) = id;
  demanded_is_asked : forall d, In d (demanded w) -> exists all, asked = In_time all /\ In d all;
  dues_are_demanded : forall id d, Map.find id (dues w) = Some d ->
    who d = id /\ exists all, asked = In_time all /\ In d all;
  guides_are_accepted : forall m, In m (crew w) -> guide_accepted w (resource_ids i) m = true;
  limits_are_right : forall key k l, Map.find key (limit_at w) = Some (k, l) -> In l (limits i);
  close_is_right : forall r t, are_close w r t = true -> Close i r t;
  longer_is_right : longer w = gap i
}.

Lemma predecessors_are_moves i r s : Well_formed i -> In s (listed (predecessor_table i) r) <-> Move i s r.
Proof.
  intros right. rewrite <- (has_move_iff i). unfold has_move. simpl. rewrite Pairs.contains_of_list.
  unfold predecessor_table.
  assert (H : forall l m, In s (listed (fold_left (fun m e => enlist (snd e) (fst e) m) l m) r) <->
    In (s, r) l \/ In s (listed m r)).
  { induction l as [| [x y] l IH]; intros m; simpl; [tauto |]. rewrite IH, listed_enlist. simpl.
    destruct (Z.eqb_spec y r) as [-> | N]; simpl; intuition congruence. }
  rewrite H, listed_empty. simpl. tauto.
Qed.

Lemma combined_with_as_many {A B} (l : list A) (m : list B) : length m = length l -> map fst (combine l m) = l.
Proof. revert m. induction l as [| x l IH]; intros [| y m] E; try discriminate; auto. simpl. rewrite IH; auto. Qed.

Lemma found_in_index_is_listed {A} (key : A -> Z) l k x : Map.find k (index key l) = Some x -> In x l /\ key x = k.
Proof.
  unfold index.
  assert (H : forall l m, Map.find k (fold_left (fun m x => Map.add (key x) x m) l m) = Some x ->
    In x l /\ key x = k \/ Map.find k m = Some x).
  { clear l. induction l as [| y l IH]; intros m; simpl; auto. intros F. apply IH in F as [F | F]; [tauto |].
    rewrite Map_facts.add_o in F. destruct (OrderedTypeEx.Z_as_OT.eq_dec (key y) k) as [E | E]; auto.
    injection F as ->. auto. }
  intros F. apply H in F as [F | F]; auto. rewrite Map_facts.empty_o in F. discriminate.
Qed.

Lemma tables_are_right i group asked b : Well_formed i -> (forall a, In a group -> In a (robots i)) ->
  NoDup (map robot_id group) -> (length (guides b) =? length group)%nat = true ->
  forallb (guide_accepted (tables_of i group asked b) (resource_ids i)) (crew (tables_of i group asked b)) = true ->
  Right_tables i asked (tables_of i group asked b).
Proof.
  intros right Known Distinct Length Guides. apply Nat.eqb_eq in Length.
  assert (All : map fst (crew (tables_of i group asked b)) = group) by (apply combined_with_as_many, Length).
  assert (N : NoDup (map (fun m : member => robot_id (fst m)) (crew (tables_of i group asked b)))).
  { rewrite <- All, map_map in Distinct. exact Distinct. }
  constructor; auto.
  - intros a r. apply takes_what_is_needed, right.
  - intros r x H. apply find_in_index in H; auto. apply (resource_ids_are_unique i right).
  - intros r s. apply successors_are_moves, right.
  - intros r s. apply predecessors_are_moves, right.
  - intros m H. apply Known. rewrite <- All. apply in_map, H.
  - intros id m. apply (find_in_index (fun m : member => robot_id (fst m))), N.
  - intros d Hd. destruct asked; [destruct Hd.. |]. eauto.
  - intros id d F. apply (found_in_index_is_listed who) in F as [F E]. destruct asked; [destruct F.. |]. eauto.
  - apply forallb_forall, Guides.
  - intros key k l F. apply (found_in_index_is_listed fst) in F as [F _]. apply (in_limits i). eauto.
  - intros r t F. unfold are_close in F. apply existsb_exists in F as (key & R & F).
    apply existsb_exists in F as (k & T & E). apply Z.eqb_eq in E. subst k.
    exact (sharing_keys_are_close i right key r t R T).
Qed.

(** The robots of the group do what is demanded. *)
Definition Meets (i : instance) (s : solution) (group : list robot) (asked : demand) : Prop :=
  match asked with
  | Lawful_plans => True
  | Cheaper_than total => sum (fun a => cost_of_robot i s (robot_id a)) group < total
  | In_time due => forall d p, In d due -> In p (plans s) -> plan_robot p = who d -> Keeps d p
  end.

Lemma sum_over_images {A B} (f : B -> Z) (g : A -> B) l : sum f (map g l) = sum (fun x => f (g x)) l.
Proof. induction l as [| x l IH]; simpl; auto. rewrite IH. reflexivity. Qed.

Lemma always_holds f first end_ : always f first end_ = true -> forall t, first <= t < end_ -> f t = true.
Proof.
  unfold always. intros H. apply Z.eqb_eq in H. revert H.
  assert (P : forall n, 0 <= span (fun t => Z.b2z (negb (f t))) first n).
  { intros n. pattern n. apply (by_the_end _ first); clear n; intros n Hn.
    - rewrite span_is_empty by lia. lia.
    - intros IH. rewrite span_to_the_next_tick by lia. destruct (f n); simpl; lia. }
  pattern end_. apply (by_the_end _ first); clear end_; intros end_ L; [intros; lia |].
  intros IH H t Ht. rewrite span_to_the_next_tick in H by lia. specialize (P end_).
  destruct (Z.eq_dec t end_) as [-> | N]; [| apply IH; [| lia]]; destruct (f end_); auto; simpl in H; lia.
Qed.

Section Solution.
Variables (i : instance) (asked : demand) (w : tables) (s : solution).
Hypothesis right : Well_formed i.
Hypothesis tabled : Right_tables i asked w.
Hypothesis lawful : Lawful i s.
Hypothesis complete : Plans_every_plannable_robot i s.

(** * Members *)

Lemma member_is_a_robot m : In m (crew w) -> In (fst m) (robots i).
Proof. apply (crew_is_known i asked w tabled). Qed.

Lemma member_has_a_plan m : In m (crew w) -> exists p v rest, In p (plans s) /\ plan_robot p = robot_id (fst m) /\
  Way i (fst m) (visits p) /\ visits p = v :: rest /\ visit_resource v = start (fst m) /\ enter v = release (fst m).
Proof.
  intros H. pose proof (guides_are_accepted i asked w tabled m H) as G. pose proof (member_is_a_robot m H) as Ha.
  destruct m as [a g]. simpl in *. decided.
  assert (P : In (robot_id a) (planned s)).
  { apply complete; auto. apply (leads_on_leads (onwards w) i _ (leads g)); auto.
    intros r t. apply (onwards_are_moves i asked w tabled). }
  apply in_map_iff in P as (p & E & Hp). pose proof (plans_lawful i s lawful p a Hp Ha (eq_sym E)) as L.
  destruct (starts_at_release i a p L) as (v & rest & V & R & T). exists p, v, rest.
  repeat split; auto. apply lawful_plan_is_a_way; auto.
Qed.

(** ** What accepted guides say *)

Lemma guides_are_right a g r t : In (a, g) (crew w) -> Move i r t -> guides_moves w (a, g) r = true.
Proof.
  intros H M. pose proof (guides_are_accepted i asked w tabled _ H) as G. cbn [guide_accepted] in G. decided.
  match goal with K : forallb _ _ = true |- _ => apply (proj1 (forallb_forall _ _) K) end.
  apply (moves_join_resources i right r t M).
Qed.

Lemma at_most_iff x y : at_most x y = true <-> exists n, x = Some n /\ n <= y.
Proof.
  destruct x as [n |]; simpl; [rewrite Z.leb_le |]; split; try discriminate; eauto.
  - intros (m & E & L). injection E as ->. auto.
  - intros (m & E & _). discriminate.
Qed.

Lemma guided_rests_are_least a g : In (a, g) (crew w) -> forall r t, Move i r t ->
  (t = goal a -> exists x, Map.find r (rests g) = Some x /\ x <= 0) /\
  (forall y, Map.find t (rests g) = Some y -> exists x, Map.find r (rests g) = Some x /\ x <= need i a t + y).
Proof.
  intros H r t M. pose proof (guides_are_right a g r t H M) as G. unfold guides_moves in G.
  pose proof (proj1 (forallb_forall _ _) G t (proj2 (onwards_are_moves i asked w tabled r t) M)) as K.
  cbv zeta beta in K.
  rewrite (takes_are_right i asked w tabled) in K. apply andb_true_iff in K as [K L]. split.
  - intros ->. rewrite Z.eqb_refl in K. apply at_most_iff, K.
  - intros y E. rewrite E in L. apply andb_true_iff in L as [L _]. apply at_most_iff, L.
Qed.

Lemma guided_firsts_are_least a g : In (a, g) (crew w) -> forall r t x, Move i r t ->
  Map.find r (firsts g) = Some x -> is_passable w a t = true -> Map.find t (rests g) <> None ->
  exists y, Map.find t (firsts g) = Some y /\ y <= x + need i a t.
Proof.
  intros H r t x M F P N. pose proof (guides_are_right a g r t H M) as G. unfold guides_moves in G.
  pose proof (proj1 (forallb_forall _ _) G t (proj2 (onwards_are_moves i asked w tabled r t) M)) as K.
  cbv zeta beta in K.
  rewrite (takes_are_right i asked w tabled), F, P in K. apply andb_true_iff in K as [_ K].
  destruct (Map.find t (rests g)); [| congruence]. apply andb_true_iff in K as [_ K]. apply at_most_iff, K.
Qed.

Lemma described_up_to id t : is_described w id t = true -> Described (seen_tick w id) t.
Proof. unfold is_described, Described. destruct (seen_tick w id); auto. apply Z.leb_le. Qed.

(** * Routes of robots that do what is demanded *)

(** The visits and the arrival are as the robot's clauses have them: those of its plan, up to where it is seen. *)
Definition Comes_in_time (m : member) (vs : list visit) (end_ : Z) (d : deadline) : Prop :=
  end_ <= last_arrival d \/
  exists sight r rest t, seen d = Some sight /\ In r (spots sight) /\ Map.find r (rests (snd m)) = Some rest /\
    seen_at sight < t <= seen_at sight + need i (fst m) r /\
    end_ <= t + Z.max 0 rest /\ is_free i (fst m) vs r t = true.

(** It comes by the deadline, or is free to leave one of the spots after it was seen there. *)
Definition Sighted (m : member) (vs : list visit) (end_ : Z) (d : deadline) (sight : sight) : Prop :=
  end_ <= last_arrival d \/
  exists r t, In r (spots sight) /\ seen_at sight < t <= seen_at sight + need i (fst m) r /\
    is_free i (fst m) vs r t = true.

Record Describes (m : member) (vs : list visit) (end_ : Z) : Prop := {
  is_a_route : Route i (fst m) (goes_through w (fst m)) (seen_tick w (robot_id (fst m)))
    (fun r => Map.find r (rests (snd m))) vs end_;
  begins_at_release : exists v later, vs = v :: later /\ visit_resource v = start (fst m) /\ enter v = release (fst m);
  holds_what_it_visits : forall r t, Described (seen_tick w (robot_id (fst m))) t -> is_in i (fst m) vs r t = true ->
    Occupies (plans s) (robot_id (fst m)) r t;
  makes_its_moves : forall r x t, Described (seen_tick w (robot_id (fst m))) t -> is_free i (fst m) vs r t = true ->
    is_in i (fst m) vs x t = true -> r <> x -> Makes_move (plans s) (robot_id (fst m)) r x t;
  costs_no_more : end_ - release (fst m) <= cost_of_robot i s (robot_id (fst m));
  comes_in_time : forall d, Map.find (robot_id (fst m)) (dues w) = Some d -> Comes_in_time m vs end_ d;
  is_sighted : forall d sight last, In d (demanded w) -> who d = robot_id (fst m) -> seen d = Some sight ->
    seen_tick w (robot_id (fst m)) = Some last -> seen_at sight <= last -> Sighted m vs end_ d sight;
  is_seen_in_spots : forall d sight last r t, In d (demanded w) -> who d = robot_id (fst m) -> seen d = Some sight ->
    seen_tick w (robot_id (fst m)) = Some last -> seen_at sight <= last -> is_free i (fst m) vs r t = true ->
    seen_at sight < t <= seen_at sight + need i (fst m) r -> In r (spots sight)
}.

Lemma seen_robots_go_through a last : seen_tick w (robot_id a) = Some last -> goes_through w a = true.
Proof. intros Tick. unfold goes_through. rewrite Tick. destruct (policy w); reflexivity. Qed.

Lemma stay_is_long_enough m before v x later : In m (crew w) -> Way i (fst m) (before ++ v :: x :: later) ->
  1 <= need i (fst m) (visit_resource v) /\ enter v + need i (fst m) (visit_resource v) <= enter x.
Proof.
  intros H W. split; [apply need_is_positive; auto; apply member_is_a_robot, H |].
  apply (way_has_ways i (fst m) before (v :: x :: later)) in W; [| discriminate].
  inversion W as [| ? ? ? _ Hn]; subst. exact Hn.
Qed.

Lemma parking_robots_go_through a : after_goal i = Park -> goes_through w a = true.
Proof. intros P. unfold goes_through. rewrite (policy_is_right i asked w tabled), P. reflexivity. Qed.

Lemma cost_is_of_the_plan m p : In m (crew w) -> In p (plans s) -> plan_robot p = robot_id (fst m) ->
  arrives (visits p) - release (fst m) <= cost_of_robot i s (robot_id (fst m)).
Proof.
  intros H Hp E. pose proof (member_is_a_robot m H) as Ha.
  assert (C : forall q, In q (plans s) -> 0 <= cost_of_plan i q).
  { intros q Hq. destruct (plan_is_a_way i s right lawful q Hq) as (a & Hb & F & Wq).
    rewrite (cost_is_of_robot i right a q Hb (eq_sym F)).
    destruct (starts_at_release i a q (plans_lawful i s lawful q a Hq Hb F)) as (u & later & U & _ & T).
    pose proof (way_does_not_arrive_before_it_starts i right a _ Hb Wq u later U) as A.
    unfold cost, arrival. rewrite U in *. unfold arrives in A. simpl in *. lia. }
  unfold cost_of_robot.
  pose proof (sum_is_above_each (fun q => if plan_robot q =? robot_id (fst m) then cost_of_plan i q else 0) (plans s) p)
    as S. cbv beta in S. rewrite E, Z.eqb_refl in S. rewrite (cost_is_of_robot i right (fst m) p Ha E) in S.
  assert (K : cost (fst m) p = arrives (visits p) - release (fst m)).
  { destruct (starts_at_release i (fst m) p (plans_lawful i s lawful p (fst m) Hp Ha (eq_sym E))) as (v & rest & V & _).
    unfold cost, arrival, arrives. rewrite V. reflexivity. }
  rewrite K in S. apply S; auto. intros q Hq. destruct (_ =? _); auto; lia.
Qed.

(** Who keeps a deadline is in one of its spots when it is seen on its way. *)
Lemma keeper_is_in_a_spot m p d sight before v x later : In m (crew w) -> Keeps d p -> seen d = Some sight ->
  Way i (fst m) (visits p) -> visits p = before ++ v :: x :: later -> enter v <= seen_at sight < enter x ->
  In (visit_resource v) (spots sight).
Proof.
  intros H K Sight W E L. pose proof (member_is_a_robot m H) as Ha. unfold Keeps in K. rewrite Sight in K.
  destruct K as [[_ K] | (u & y & (first & rest & C) & Spot & Seen)]; rewrite E in *.
  - exfalso. assert (Arrival : arrives (before ++ v :: x :: later) = arrives (x :: later)).
    { unfold arrives. rewrite fold_left_app. reflexivity. }
    rewrite Arrival in K.
    apply (way_has_ways i (fst m) before (v :: x :: later)) in W; [| discriminate].
    inversion W as [| ? ? ? _ _ _ Wx]; subst.
    pose proof (entered_before_the_arrival i (fst m) right Ha (x :: later) Wx x later eq_refl). lia.
  - rewrite (visit_at_a_tick_is_unique i (fst m) right Ha before v x later first u y rest (seen_at sight) W C L Seen).
    exact Spot.
Qed.

(** A robot that arrives before it is seen, or is not seen, is described by the visits that count. *)
Lemma arrived_member_is_described m p : In m (crew w) -> In p (plans s) -> plan_robot p = robot_id (fst m) ->
  Way i (fst m) (visits p) ->
  (exists v rest, visits p = v :: rest /\ visit_resource v = start (fst m) /\ enter v = release (fst m)) ->
  Described (seen_tick w (robot_id (fst m))) (arrives (visits p)) ->
  (forall d, Map.find (robot_id (fst m)) (dues w) = Some d -> arrives (visits p) <= last_arrival d) ->
  (forall d, In d (demanded w) -> who d = robot_id (fst m) -> Keeps d p) ->
  let vs := counted (goes_through w (fst m)) (fst m) (visits p) in Describes m vs (arrives vs).
Proof.
  intros H Hp E W (v & rest & V & S & T) D Due Kept vs. pose proof (member_is_a_robot m H) as Ha.
  pose proof (counted_arrives_no_later i (fst m) (goes_through w (fst m)) right Ha (visits p) W) as L. fold vs in L.
  assert (Routed : Route i (fst m) (goes_through w (fst m)) (seen_tick w (robot_id (fst m)))
    (fun r => Map.find r (rests (snd m))) vs (arrives vs)) by (apply way_is_a_route; auto).
  constructor; auto.
  - destruct (counted_begins_alike (fst m) (goes_through w (fst m)) v rest) as [later C]. unfold vs. rewrite V, C.
    eauto.
  - intros r t _ K.
    destruct (counted_visits_hold i (fst m) (goes_through w (fst m)) (visits p) r t W
      (parking_robots_go_through (fst m)) K) as (u & Hu & R). exists p, u. tauto.
  - intros r x t Dt F K N.
    destruct (free_robot_elsewhere_moves i (fst m) _ _ _ right Ha vs _ r x t Routed Dt F K N)
      as (before & u & u' & later & U & Hu & Hu' & Ht).
    destruct (counted_is_a_prefix (fst m) (goes_through w (fst m)) (visits p)) as [end_ P].
    exists p, u, u'. repeat split; auto. exists before, (later ++ end_). fold vs in P. rewrite P, U, <- app_assoc.
    reflexivity.
  - pose proof (cost_is_of_the_plan m p H Hp E). lia.
  - intros d F. left. specialize (Due d F). lia.
  - intros d sight last Hd Who Sight Tick _. specialize (Kept d Hd Who). unfold Keeps in Kept. rewrite Sight in Kept.
    destruct Kept as [[K K'] | (u & x & (before & later & C) & Spot & Seen)].
    + left. unfold last_arrival. rewrite Sight. lia.
    + right. exists (visit_resource u), (Z.max (seen_at sight + 1) (enter u + need i (fst m) (visit_resource u))).
      rewrite C in W. pose proof (stay_is_long_enough m before u x later H W). repeat split; auto; try lia.
      unfold vs, counted. rewrite (seen_robots_go_through _ _ Tick), C. apply leaver_is_free; lia.
  - intros d sight last r t Hd Who Sight Tick _ Fr R. unfold vs, counted in Fr.
    rewrite (seen_robots_go_through _ _ Tick) in Fr.
    destruct (free_robot_leaves_later i (fst m) _ r t Fr) as (before & u & x & later & C & <- & Left).
    apply (keeper_is_in_a_spot m p d sight before u x later); auto. lia.
Qed.

(** One that is seen in a spot is described up to its visit there. *)
Lemma seen_member_is_described m p d sight v x : In m (crew w) -> In p (plans s) -> plan_robot p = robot_id (fst m) ->
  Way i (fst m) (visits p) ->
  (exists v rest, visits p = v :: rest /\ visit_resource v = start (fst m) /\ enter v = release (fst m)) ->
  Map.find (robot_id (fst m)) (dues w) = Some d -> seen d = Some sight -> Consecutive p v x ->
  In (visit_resource v) (spots sight) -> enter v <= seen_at sight < enter x ->
  (forall d, In d (demanded w) -> who d = robot_id (fst m) -> Keeps d p) ->
  exists vs end_, Describes m vs end_.
Proof.
  intros H Hp E W (f & all & V & S & T) F Sight (before & later & C) Spot Seen Kept.
  pose proof (member_is_a_robot m H) as Ha.
  assert (Tick : seen_tick w (robot_id (fst m)) = Some (seen_at sight)) by (unfold seen_tick; rewrite F, Sight; auto).
  pose proof (seen_robots_go_through _ _ Tick) as Through.
  rewrite C in W.
  destruct m as [a g]. cbn [fst snd] in *.
  destruct (way_has_a_rest i a (fun r => Map.find r (rests g)) (guided_rests_are_least a g H) (v :: x :: later)) with
    (v := v) (w := x) (rest := later) as (rest & Rest & Least); auto.
  { apply (way_has_ways i a before (v :: x :: later)); auto. discriminate. }
  set (mark := Visit (goal a) (Z.max (seen_at sight + 1) (enter v + need i a (visit_resource v))) None).
  assert (Arrival : arrives (visits p) = arrives (v :: x :: later)).
  { rewrite C. unfold arrives. rewrite fold_left_app. reflexivity. }
  assert (Later : enter v + need i a (visit_resource v) <= enter x /\ enter x <= arrives (v :: x :: later)).
  { assert (W' : Way i a (v :: x :: later)) by (apply (way_has_ways i a before); auto; discriminate).
    inversion W' as [| ? ? ? Hl Hn Hm Hw]; subst. split; auto.
    apply (entered_before_the_arrival i a right Ha (x :: later) Hw x later eq_refl). }
  pose proof (need_is_positive i a right Ha (visit_resource v)).
  assert (Routed : Route i a (goes_through w a) (seen_tick w (robot_id a)) (fun r => Map.find r (rests g))
    (before ++ [v; mark]) (enter mark + Z.max 0 rest)) by (eapply seen_way_is_a_route; eauto).
  exists (before ++ [v; mark]), (enter mark + Z.max 0 rest). constructor; cbn [fst snd]; auto.
  - rewrite C in V. destruct before; simpl in *; injection V as -> _; eauto.
  - intros r t D K. unfold Described in D. rewrite Tick in D.
    destruct (seen_visits_hold i a before v x later mark r t (seen_at sight) W) as (u & Hu & R); auto;
      [lia | simpl; lia |]. exists p, u. rewrite C. tauto.
  - intros r y t D Fr K N. pose proof (free_robot_elsewhere_moves i a _ _ _ right Ha _ _ r y t Routed D Fr K N)
      as (first & u & u' & after & U & Hu & Hu' & Ht).
    unfold Described in D. rewrite Tick in D.
    destruct (seen_moves_are_made before v x later mark (seen_at sight) first u u' after) as [rest' M]; auto;
      [simpl; lia | lia |]. exists p, u, u'. repeat split; auto. exists first, rest'. rewrite C. exact M.
  - pose proof (cost_is_of_the_plan (a, g) p H Hp E) as K. cbn [fst] in K. rewrite Arrival in K. simpl enter. lia.
  - intros d' F'. rewrite F in F'. injection F' as <-. right.
    exists sight, (visit_resource v), rest, (enter mark). repeat split; auto; try (simpl; lia).
    assert (M : enter v + need i a (visit_resource v) <= enter mark) by (simpl; lia).
    apply (leaver_is_free i a before v mark []); [exact M | lia].
  - intros d' sight' last Hd Who Sight' Tick' L. rewrite Tick in Tick'. injection Tick' as <-.
    specialize (Kept d' Hd Who). unfold Keeps in Kept. rewrite Sight' in Kept.
    destruct Kept as [[K K'] | (u & y & (first & rest' & C') & Spot' & Seen')].
    + left. unfold last_arrival. rewrite Sight'. rewrite Arrival in K, K'. simpl enter. lia.
    + right. exists (visit_resource u), (Z.max (seen_at sight' + 1) (enter u + need i a (visit_resource u))).
      cbn [fst snd]. rewrite C in C'. pose proof W as W'. rewrite C' in W'.
      pose proof (stay_is_long_enough (a, g) first u y rest' H W') as Stay. cbn [fst] in Stay.
      repeat split; auto; try lia.
      apply (leaver_is_free_before_it_is_seen i a right Ha before v x later mark first u y rest' (seen_at sight)); auto;
        try lia. intros ->. simpl enter. lia.
  - intros d' sight' last r t Hd Who Sight' Tick' L Fr R. rewrite Tick in Tick'. injection Tick' as <-.
    destruct (free_robot_leaves_later i a _ r t Fr) as (first & u & y & rest' & C' & <- & Left).
    destruct (left_visit_is_of_the_way before v x later mark first u y rest' C') as (z & others & C'' & Z).
    apply (keeper_is_in_a_spot (a, g) p d' sight' first u z others); auto; cbn [fst]; try congruence.
    destruct Z as [-> | ->]; lia.
Qed.

Lemma member_is_described m : In m (crew w) -> Meets i s (map fst (crew w)) asked ->
  exists vs end_, Describes m vs end_.
Proof.
  intros H L. destruct (member_has_a_plan m H) as (p & v & rest & Hp & E & W & V & S & T).
  assert (Begins : exists v rest, visits p = v :: rest /\ visit_resource v = start (fst m) /\ enter v = release (fst m))
    by eauto.
  assert (Kept : forall d, In d (demanded w) -> who d = robot_id (fst m) -> Keeps d p).
  { intros d Hd Who. destruct (demanded_is_asked i asked w tabled d Hd) as (all & Asked & Hd').
    rewrite Asked in L. apply (L d p); congruence. }
  destruct (Map.find (robot_id (fst m)) (dues w)) as [d |] eqn:F.
  - destruct (dues_are_demanded i asked w tabled _ d F) as (Who & all & Asked & Hd).
    assert (K : Keeps d p) by (rewrite Asked in L; apply (L d p); congruence). unfold Keeps in K.
    destruct (seen d) as [sight |] eqn:Sight.
    + destruct K as [[K K'] | (u & x & C & Spot & Seen)]; [| eapply seen_member_is_described; eauto].
      eexists _, _. eapply (arrived_member_is_described m p); eauto.
      * unfold seen_tick. rewrite F, Sight. exact K'.
      * intros d' F'. rewrite F in F'. injection F' as <-. unfold last_arrival. rewrite Sight. lia.
    + eexists _, _. eapply (arrived_member_is_described m p); eauto.
      * unfold seen_tick. rewrite F, Sight. exact I.
      * intros d' F'. rewrite F in F'. injection F' as <-. unfold last_arrival. rewrite Sight. exact K.
  - eexists _, _. eapply (arrived_member_is_described m p); eauto.
    + unfold seen_tick. rewrite F. exact I.
    + intros d' F'. rewrite F in F'. discriminate.
Qed.

(** Each member has what some member of its id has. *)
Lemma all_have_one {A} (P : member -> A -> Prop) (default : A) l : NoDup (map (fun m : member => robot_id (fst m)) l) ->
  (forall m, In m l -> exists x, P m x) -> exists f, forall m, In m l -> P m (f (robot_id (fst m))).
Proof.
  induction l as [| m l IH]; simpl; intros N H; [exists (fun _ => default); tauto |].
  inversion N as [| ? ? Hm Hl]; subst.
  destruct (IH Hl) as [f F]; auto. destruct (H m (or_introl eq_refl)) as [x X].
  exists (fun id => if id =? robot_id (fst m) then x else f id). intros n [<- | Hn]; [rewrite Z.eqb_refl; auto |].
  destruct (Z.eqb_spec (robot_id (fst n)) (robot_id (fst m))) as [E |]; auto. destruct Hm. rewrite <- E.
  apply (in_map (fun m : member => robot_id (fst m))), Hn.
Qed.

Lemma crew_is_described : Meets i s (map fst (crew w)) asked -> exists routes ends,
  forall m, In m (crew w) -> Describes m (routes (robot_id (fst m))) (ends (robot_id (fst m))).
Proof.
  intros L. destruct (all_have_one (fun m x => Describes m (fst x) (snd x)) ([], 0) (crew w)) as [f F].
  - apply (crew_is_distinct i asked w tabled).
  - intros m H. destruct (member_is_described m H L) as (vs & end_ & D). exists (vs, end_). exact D.
  - exists (fun id => fst (f id)), (fun id => snd (f id)). exact F.
Qed.

(** * What the variables mean *)

Variable routes : Z -> list visit.
Variable ends : Z -> Z.
Hypothesis described : forall m, In m (crew w) -> Describes m (routes (robot_id (fst m))) (ends (robot_id (fst m))).

Definition route (a : robot) : list visit := routes (robot_id a).
Definition route_cost (a : robot) : Z := ends (robot_id a) - release a.
Definition delay (m : member) : Z := route_cost (fst m) - shortest (snd m).
(** The robot counts on its route: it is in a place of the limit at the tick, or was so the gap before, as far as it is
    described. *)
Definition is_there (a : robot) (place t : Z) : bool := is_described w (robot_id a) t && is_in i a (route a) place t.
Definition counts_on_route (key t : Z) (a : robot) : bool :=
  match Map.find key (limit_at w) with
  | Some (_, l) => existsb (fun place => is_there a place t || is_there a place (t - gap i)) (limit_places l)
  | None => false
  end.
Definition is_present (key t : Z) (m : member) : bool := counts_on_route key t (fst m).
Definition presence (key t : Z) (m : member) : Z := Z.b2z (is_present key t m).

(** The sum over the robots whose keys are in a range. *)
Definition ranged (key f : member -> Z) (first end_ : Z) : Z :=
  sum (fun m => if (first <=? key m) && (key m <? end_) then f m else 0) (crew w).
Definition delays := ranged (fun m => rank (snd m)) delay.
Definition presences (key t : Z) := ranged (fun m => seat (snd m)) (presence key t).

Definition is_true (m : meaning) : bool :=
  match m with
  | Free id r t => of_robot w id (fun a _ => is_free i a (route a) r t)
  | Costs id x => of_robot w id (fun a _ => x <=? route_cost a)
  | Present id r t => of_robot w id (fun a _ => is_in i a (route a) r t)
  | Stands _ => true
  | Delayed first end_ least => least <=? delays first end_
  | Counted id key t => of_robot w id (fun a _ => counts_on_route key t a)
  | Crowded first end_ key t least => least <=? presences key t first end_
  end.

(** One of the literals is true. *)
Definition Kept (c : list signed) : Prop := exists l, In l c /\ is_true (snd l) = fst l.

Lemma route_costs_no_more m : In m (crew w) -> route_cost (fst m) <= cost_of_robot i s (robot_id (fst m)).
Proof. intros H. apply (costs_no_more m _ _ (described m H)). Qed.

(** * Clauses of one robot *)

Section Member.
Variables (a : robot) (g : guide) (id : Z).
Hypothesis found : Map.find id (member_of w) = Some (a, g).

Lemma found_member : In (a, g) (crew w) /\ robot_id a = id.
Proof. apply (members_are_found i asked w tabled id (a, g)), found. Qed.

Lemma listed_member : In (a, g) (crew w).
Proof. apply found_member. Qed.

Lemma known : In a (robots i).
Proof. apply (member_is_a_robot (a, g) listed_member). Qed.

Let end_ := ends (robot_id a).

Lemma routed : Route i a (goes_through w a) (seen_tick w (robot_id a)) (fun r => Map.find r (rests g)) (route a) end_.
Proof. apply (is_a_route (a, g) _ _ (described (a, g) listed_member)). Qed.

Lemma begins : exists v later, route a = v :: later /\ visit_resource v = start a /\ enter v = release a.
Proof. apply (begins_at_release (a, g) _ _ (described (a, g) listed_member)). Qed.

Lemma described_tick t : is_described w id t = true -> Described (seen_tick w (robot_id a)) t.
Proof. rewrite (proj2 found_member). apply described_up_to. Qed.

Lemma of_found_robot f : of_robot w id f = f a g.
Proof. unfold of_robot. rewrite found. reflexivity. Qed.

Lemma free_robot_is_guided r t : is_free i a (route a) r t = true ->
  (exists rest, Map.find r (rests g) = Some rest /\ t + rest - release a <= route_cost a) /\
  (exists first, Map.find r (firsts g) = Some first /\ first <= t) /\
  is_passable w a r = true.
Proof.
  intros F. pose proof (guides_are_accepted i asked w tabled _ listed_member) as G. cbn [guide_accepted] in G.
  rewrite (takes_are_right i asked w tabled) in G. decided.
  destruct (free_robot_has_a_rest i a _ _ _ (guided_rests_are_least a g listed_member) _ _ r t routed F)
    as (rest & R & L).
  split; [exists rest; unfold route_cost; split; [auto | unfold end_ in L; lia] |]. split.
  - apply (free_robot_is_not_too_early i a _ _ _ (guided_rests_are_least a g listed_member)
      (fun r => Map.find r (firsts g)) (guided_firsts_are_least a g listed_member) _ _ r t routed); auto.
    intros v x later E. destruct begins as (u & later' & E' & S & T). rewrite E in E'. injection E' as <- _.
    rewrite S, T. apply at_most_iff. auto.
  - apply (free_robot_can_pass i a _ _ _ _ _ r t routed F).
Qed.

Lemma shortest_is_least : shortest g <= route_cost a.
Proof.
  pose proof (guides_are_accepted i asked w tabled _ listed_member) as G. cbn [guide_accepted] in G.
  rewrite (takes_are_right i asked w tabled) in G. decided. unfold route_cost. fold end_.
  destruct begins as (v & later & E & S & T). pose proof routed as R. rewrite E in *.
  pose proof (route_arrives_after_its_start i a _ _ _ right known _ _ R v later eq_refl) as A.
  destruct (Z.eqb_spec (start a) (goal a)) as [Same | Other]; [decided; lia |].
  destruct later as [| x rest]; [inversion R; congruence |].
  destruct (mover_has_a_rest i a _ _ _ (guided_rests_are_least a g listed_member) _ _ R v x rest eq_refl)
    as (n & F & L).
  assert (enter v + need i a (visit_resource v) <= enter x) by (inversion R; lia).
  rewrite S, T, F in *. decided. lia.
Qed.

Section Clause.
Variable c : list signed.

(** Look for the literal that makes a clause hold. *)
Ltac look H l := apply existsb_exists in H as (l & ? & H); destruct l as [[|] []]; try discriminate; decided; subst.
Ltac shown := eexists; split; [eassumption |]; cbn [is_true fst snd]; rewrite ?of_found_robot.

Lemma kept_unless_free r t : unless_free c id r t = true -> is_free i a (route a) r t = false -> Kept c.
Proof. unfold unless_free. intros H F. look H l. shown. exact F. Qed.

Lemma kept_if_costs x : if_costs c id x = true -> x <= route_cost a -> Kept c.
Proof. unfold if_costs. intros H L. look H l. shown. apply Z.leb_le. lia. Qed.

Lemma kept_if_cheaper x : if_cheaper w c id x = true -> route_cost a < x -> Kept c.
Proof.
  unfold if_cheaper. rewrite of_found_robot. intros H L. apply orb_true_iff in H as [H | H].
  - look H l. shown. apply Z.leb_gt. lia.
  - pose proof shortest_is_least. decided. lia.
Qed.

Lemma kept_if_free r t : if_free w c id r t = true -> is_free i a (route a) r t = true -> Kept c.
Proof.
  unfold if_free. rewrite of_found_robot. intros H F. apply orb_true_iff in H as [H | H]; [look H l; shown; exact F |].
  destruct (free_robot_is_guided r t F) as ((rest & R & L) & (first & S & M) & P). rewrite R, S, P in H. simpl in H.
  apply orb_true_iff in H as [H | H]; [decided; lia |]. apply (kept_if_costs _ H L).
Qed.

Lemma kept_unless_present r t : unless_present w c id r t = true -> is_in i a (route a) r t = false -> Kept c.
Proof.
  unfold unless_present. rewrite of_found_robot, (takes_are_right i asked w tabled). intros H F.
  apply andb_true_iff in H as [D H]. apply described_tick in D. apply orb_true_iff in H as [H | H].
  - look H l.
    + shown. destruct (is_free i a (route a) r tick) eqn:E; auto.
      rewrite (free_robot_is_inside i a _ _ _ _ _ r tick t routed E) in F; auto; discriminate.
    + shown. exact F.
    + destruct begins as (v & later & E & S & T). pose proof routed as R. rewrite E in *. rewrite <- S in *.
      rewrite (standing_robot_is_inside i a _ _ _ v later _ t R) in F; [discriminate | | |]; auto; lia.
  - decided. subst r. destruct (Z_lt_le_dec (route_cost a) (t + 1 - release a)) as [L | L].
    + destruct (after_goal i) eqn:Policy; rewrite (policy_is_right i asked w tabled), Policy in *.
      * destruct (Z_lt_le_dec (route_cost a) (t + 1 - release a - need i a (goal a))) as [M | M].
        -- eapply kept_if_cheaper; eauto.
        -- rewrite (arrived_robot_is_inside i a _ _ _ _ _ t routed D) in F; [discriminate | |]; unfold route_cost in *;
             rewrite ?Policy; unfold end_; lia.
      * rewrite (arrived_robot_is_inside i a _ _ _ _ _ t routed D) in F; [discriminate | |]; unfold route_cost in *;
             rewrite ?Policy; unfold end_; auto; lia.
    + eapply kept_if_costs; eauto.
Qed.

Lemma kept_unless_counted key t : unless_counted w c id key t = true -> counts_on_route key t a = false -> Kept c.
Proof.
  unfold unless_counted. intros H F. apply andb_true_iff in H as [H _].
  apply orb_true_iff in H as [H | H]; [look H l; shown; exact F |].
  unfold counts_on_route in F. destruct (Map.find key (limit_at w)) as [[k l] |]; [| discriminate].
  apply existsb_exists in H as (place & P & H).
  assert (N : is_there a place t || is_there a place (t - gap i) = false).
  { apply not_true_iff_false. intros T. apply not_true_iff_false in F. apply F. apply existsb_exists. eauto. }
  assert (Away : forall u, unless_present w c id place u = true -> is_there a place u = false -> Kept c).
  { intros u U V. apply (kept_unless_present _ _ U). unfold is_there in V. unfold unless_present in U.
    apply andb_true_iff in U as [U _]. rewrite (proj2 found_member), U in V. exact V. }
  apply orb_false_iff in N as [N M]. apply orb_true_iff in H as [H | H]; [exact (Away _ H N) |].
  apply andb_true_iff in H as [_ H]. rewrite (longer_is_right i asked w tabled) in H. exact (Away _ H M).
Qed.

Lemma kept_at_the_start : if_free w c id (start a) (release a + need i a (start a)) = true ->
  start a <> goal a \/ if_cheaper w c id 1 = true -> Kept c.
Proof.
  intros F C. destruct begins as (v & later & E & S & T). pose proof routed as R. rewrite E in R.
  destruct later as [| x rest].
  - inversion R as [u Hg K K' | |]; subst. destruct C as [C | C]; [congruence |]. apply (kept_if_cheaper _ C).
    unfold route_cost. fold end_. lia.
  - apply (kept_if_free _ _ F). rewrite E, <- S, <- T. apply mover_is_free; [lia |]. inversion R; lia.
Qed.

Lemma kept_by_going_on r t : is_described w id t = true -> unless_free c id r t = true ->
  if_free w c id r (t + 1) = true ->
  (forall x, Move i r x -> if_free w c id x (t + need i a x) = true) ->
  (Move i r (goal a) -> if_cheaper w c id (t + 1 - release a) = true) -> Kept c.
Proof.
  intros D U W M G. destruct (is_free i a (route a) r t) eqn:F; [| eapply kept_unless_free; eauto].
  destruct (free_robot_goes_on i a _ _ _ _ _ r t routed (described_tick t D) F) as [K | [(x & Hx & K) | (Hx & K)]].
  - exact (kept_if_free _ _ W K).
  - exact (kept_if_free _ _ (M _ Hx) K).
  - apply (kept_if_cheaper _ (G Hx)). unfold route_cost. unfold end_ in K. lia.
Qed.

Lemma kept_by_coming_from r t : if_came w c id r t = true -> is_free i a (route a) r t = true -> Kept c.
Proof.
  unfold if_came. rewrite of_found_robot, (takes_are_right i asked w tabled). intros H F.
  apply andb_true_iff in H as [H N]. apply andb_true_iff in H as [W M]. rewrite forallb_forall in M.
  destruct (free_robot_comes_from i a _ _ _ _ _ r t routed F) as [(D & K) | [(x & Hx & K) | (v & rest & E & Hr & Ht)]].
  - apply orb_true_iff in W as [W | W]; [| exact (kept_if_free _ _ W K)]. exfalso. unfold is_described in W.
    rewrite (proj2 found_member) in D. unfold Described in D. destruct (seen_tick w id); decided; [lia | discriminate].
  - exact (kept_if_free _ _ (M _ (proj2 (backwards_are_moves i asked w tabled r x) Hx)) K).
  - destruct begins as (u & later & E' & S & T). rewrite E in E'. injection E' as <- <-. rewrite Hr, S, Ht, T in N.
    rewrite !Z.eqb_refl in N. exfalso. rewrite Hr, S, Z.eqb_refl in N. discriminate.
Qed.

Lemma kept_by_arriving x : is_described w id (release a + x) = true -> if_costs c id (x + 1) = true ->
  if_cheaper w c id x = true ->
  (forall r, Move i r (goal a) -> if_free w c id r (release a + x) = true) ->
  start a <> goal a \/ x <> 0 -> Kept c.
Proof.
  intros Early C D M N. destruct (Z_lt_le_dec (route_cost a) x) as [L | L]; [eapply kept_if_cheaper; eauto |].
  destruct (Z_lt_le_dec x (route_cost a)) as [L' | L']; [eapply kept_if_costs; eauto; lia |].
  assert (A : end_ = release a + x) by (unfold route_cost in *; fold end_ in L, L'; lia).
  apply described_tick in Early. rewrite <- A in Early.
  destruct (arrival_comes_from i a _ _ _ _ _ routed Early) as [(r & Hr & F) | (v & E & Hg & Hv)].
  - rewrite A in F. exact (kept_if_free _ _ (M _ Hr) F).
  - destruct begins as (u & later & E' & S & T). rewrite E in *. injection E' as <- _.
    exfalso. destruct N; [congruence | lia].
Qed.

(** ** Clauses of a deadline *)

Lemma kept_if_in_time : if_in_time w c id = true -> Kept c.
Proof.
  unfold if_in_time. rewrite of_found_robot. destruct (Map.find id (dues w)) as [d |] eqn:F; [| discriminate].
  intros H. apply andb_true_iff in H as [H K]. pose proof (described (a, g) listed_member) as Desc.
  assert (F' : Map.find (robot_id a) (dues w) = Some d) by (rewrite (proj2 found_member); exact F).
  destruct (comes_in_time _ _ _ Desc d F') as [L | (sight & r & rest & t & S & Spot & R & T & L & _)];
    cbn [fst snd] in *.
  - apply (kept_if_cheaper _ H). unfold route_cost. lia.
  - rewrite S in K. pose proof (proj1 (forallb_forall _ _) K r Spot) as J. cbv beta in J.
    rewrite R, (takes_are_right i asked w tabled) in J. apply (kept_if_cheaper _ J). unfold route_cost. lia.
Qed.
End Clause.

Lemma kept_if_seen c : if_seen w c id = true -> Kept c.
Proof.
  unfold if_seen. rewrite of_found_robot. intros H. apply existsb_exists in H as (d & Hd & H).
  unfold if_seen_by in H. cbv zeta in H. rewrite (proj2 found_member) in H.
  destruct (seen d) as [sight |] eqn:Sight; [| rewrite andb_false_r in H; discriminate].
  destruct (seen_tick w id) as [last |] eqn:Tick; [| rewrite andb_false_r in H; discriminate].
  apply andb_true_iff in H as [H K]. apply andb_true_iff in H as [Who H]. apply andb_true_iff in K as [L K].
  apply Z.eqb_eq in Who. apply Z.leb_le in L. pose proof (described (a, g) listed_member) as Desc.
  destruct (is_sighted _ _ _ Desc d sight last) as [E | (r & t & Spot & T & Free)]; cbn [fst snd] in *; auto;
    try (rewrite (proj2 found_member); auto).
  - apply (kept_if_cheaper c _ H). unfold route_cost. lia.
  - pose proof (proj1 (forallb_forall _ _) K r Spot) as J. cbv beta zeta in J.
    rewrite (takes_are_right i asked w tabled) in J. apply always_holds with (t := t) in J; [| lia].
    assert (Here : Kept (filter (is_free_at r) c)).
    { apply orb_true_iff in J as [J | J];
        [exact (kept_if_free _ _ _ J Free) | exact (kept_by_coming_from _ _ _ J Free)]. }
    destruct Here as (l & Hl & True_l). apply filter_In in Hl as [Hl _]. exists l. auto.
Qed.

Lemma kept_if_seen_elsewhere c r t : unless_free c id r t = true -> is_seen_elsewhere w id r t = true -> Kept c.
Proof.
  unfold is_seen_elsewhere. rewrite of_found_robot. intros U H.
  destruct (is_free i a (route a) r t) eqn:F; [exfalso | eapply kept_unless_free; eauto].
  apply existsb_exists in H as (d & Hd & H). apply andb_true_iff in H as [Who H]. apply Z.eqb_eq in Who.
  destruct (seen d) as [sight |] eqn:Sight; [| discriminate].
  destruct (seen_tick w id) as [last |] eqn:Tick; [| discriminate].
  rewrite (takes_are_right i asked w tabled) in H. apply andb_true_iff in H as [H N]. decided.
  apply not_true_iff_false in N. apply N, existsb_exists. exists r. rewrite Z.eqb_refl. split; auto.
  apply (is_seen_in_spots _ _ _ (described (a, g) listed_member) d sight last r t); cbn [fst snd]; auto;
    rewrite ?(proj2 found_member); auto.
Qed.
End Member.

(** The robot of a condition that holds is a member. *)
Lemma some_robot id f : of_robot w id f = true -> exists a g, Map.find id (member_of w) = Some (a, g) /\ f a g = true.
Proof. unfold of_robot. destruct (Map.find id (member_of w)) as [[a g] |]; [eauto | discriminate]. Qed.

Lemma presence_is_of_a_robot c id r t : unless_present w c id r t = true ->
  exists a g, Map.find id (member_of w) = Some (a, g) /\ is_described w (robot_id a) t = true /\
  (is_in i a (route a) r t = false -> Kept c).
Proof.
  intros H. pose proof H as K. unfold unless_present in K. apply andb_true_iff in K as [D K].
  pose proof (some_robot _ _ K) as (a & g & F & _). exists a, g. split; auto. split.
  - rewrite (proj2 (found_member a g id F)). exact D.
  - apply (kept_unless_present a g id F c r t H).
Qed.

(** * Clauses of robots together *)

(** A robot that is in a resource on its route occupies it. *)
Lemma robot_inside_occupies m r t : In m (crew w) -> is_described w (robot_id (fst m)) t = true ->
  is_in i (fst m) (route (fst m)) r t = true -> Occupies (plans s) (robot_id (fst m)) r t.
Proof.
  intros H D. apply (holds_what_it_visits m _ _ (described m H)), described_up_to, D.
Qed.

Lemma robot_free_elsewhere_makes_the_move m r x t : In m (crew w) -> is_described w (robot_id (fst m)) t = true ->
  is_free i (fst m) (route (fst m)) r t = true -> is_in i (fst m) (route (fst m)) x t = true -> r <> x ->
  Makes_move (plans s) (robot_id (fst m)) r x t.
Proof.
  intros H D. apply (makes_its_moves m _ _ (described m H)), described_up_to, D.
Qed.

(** ** Sums over ranges *)

Lemma range_is_widened key f first end_ first' end' : (forall m, In m (crew w) -> 0 <= f m) ->
  first' <= first -> end_ <= end' -> ranged key f first end_ <= ranged key f first' end'.
Proof.
  intros P L K. unfold ranged. apply sum_is_monotone. intros m H. specialize (P m H).
  destruct (Z.leb_spec first (key m)), (Z.ltb_spec (key m) end_), (Z.leb_spec first' (key m)),
    (Z.ltb_spec (key m) end'); simpl; lia.
Qed.

Lemma ranges_are_joined key f first middle middle' end_ first' end' : (forall m, In m (crew w) -> 0 <= f m) ->
  first' <= Z.min first middle' -> middle <= middle' -> Z.max middle end_ <= end' ->
  ranged key f first middle + ranged key f middle' end_ <= ranged key f first' end'.
Proof.
  intros P L M K. unfold ranged. rewrite <- sum_of_sums. apply sum_is_monotone. intros m H. specialize (P m H).
  destruct (Z.leb_spec first (key m)), (Z.ltb_spec (key m) middle), (Z.leb_spec middle' (key m)),
    (Z.ltb_spec (key m) end_), (Z.leb_spec first' (key m)), (Z.ltb_spec (key m) end'); simpl; lia.
Qed.

Lemma one_is_in_its_range key f m : (forall m, In m (crew w) -> 0 <= f m) -> In m (crew w) ->
  f m <= ranged key f (key m) (key m + 1).
Proof.
  intros P H. unfold ranged.
  pose proof (sum_is_above_each
    (fun x => if (key m <=? key x) && (key x <? key m + 1) then f x else 0) (crew w) m) as S.
  cbv beta in S. rewrite Z.leb_refl, (proj2 (Z.ltb_lt (key m) (key m + 1))) in S by lia. simpl in S. apply S; auto.
  intros x Hx. specialize (P x Hx). destruct (_ && _); lia.
Qed.

Lemma delays_are_not_negative m : In m (crew w) -> 0 <= delay m.
Proof.
  intros H. destruct m as [a g]. unfold delay. pose proof (shortest_is_least a g (robot_id a)) as L. simpl.
  rewrite (members_are_found i asked w tabled) in L. simpl in L. specialize (L (conj H eq_refl)). lia.
Qed.

Lemma presences_are_not_negative r t m : 0 <= presence r t m.
Proof. unfold presence. destruct (is_present _ _ _); simpl; lia. Qed.

(** A clause that adds up is kept. *)
Lemma kept_by_adding if_false true_if value c key f : value = ranged key f -> (forall m, In m (crew w) -> 0 <= f m) ->
  (forall l first end_ n, if_false l = Some (first, end_, n) -> is_true (snd l) = fst l \/ n <= value first end_) ->
  (forall l first end_ n, true_if l = Some (first, end_, n) -> n <= value first end_ -> is_true (snd l) = fst l) ->
  adds if_false true_if c = true -> Kept c.
Proof.
  intros -> P F T H. unfold adds in H. destruct c as [| l [| k [| total [| ? ?]]]]; try discriminate.
  - destruct (if_false l) as [[[first end_] n] |] eqn:Fl; [| discriminate].
    destruct (true_if k) as [[[first' end'] least] |] eqn:Tk; [| discriminate]. decided.
    destruct (F _ _ _ _ Fl) as [K | K]; [exists l; simpl; auto |]. exists k. split; [simpl; auto |].
    apply (T _ _ _ _ Tk). pose proof (range_is_widened key f first end_ first' end' P ltac:(lia) ltac:(lia)). lia.
  - destruct (if_false l) as [[[first middle] n] |] eqn:Fl; [| discriminate].
    destruct (if_false k) as [[[middle' end_] m] |] eqn:Fk; [| discriminate].
    destruct (true_if total) as [[[first' end'] least] |] eqn:Tk; [| discriminate]. decided.
    destruct (F _ _ _ _ Fl) as [K | K]; [exists l; simpl; auto |].
    destruct (F _ _ _ _ Fk) as [K' | K']; [exists k; simpl; auto |]. exists total. split; [simpl; auto |].
    apply (T _ _ _ _ Tk). 
    pose proof (ranges_are_joined key f first middle middle' end_ first' end' P ltac:(lia) ltac:(lia) ltac:(lia)). lia.
Qed.

Lemma kept_by_adding_delays c : adds (delays_if_false w) true_if_delays c = true -> Kept c.
Proof.
  apply (kept_by_adding _ _ delays c (fun m => rank (snd m)) delay); auto using delays_are_not_negative.
  - intros [[|] []] from upto n E; try discriminate; simpl in E.
    + destruct (Map.find id (member_of w)) as [[a g] |] eqn:Found; [| discriminate]. injection E as <- <- <-.
      cbn [is_true fst snd]. rewrite (of_found_robot a g id Found).
      destruct (least <=? route_cost a) eqn:L; auto. decided. right.
      pose proof (one_is_in_its_range (fun m => rank (snd m)) delay (a, g) delays_are_not_negative) as K.
      specialize (K (listed_member a g id Found)). unfold delays. simpl in *. unfold delay at 1 in K. simpl in K. lia.
    + injection E as <- <- <-. cbn [is_true fst snd]. destruct (least <=? delays first end_) eqn:L; auto. decided. auto.
  - intros [[|] []] from upto n E L; try discriminate; simpl in E. injection E as <- <- <-.
    apply Z.leb_le. exact L.
Qed.

(** Who counts in a limit that a clause speaks of. *)
Lemma count_is_of_a_robot c id key t : unless_counted w c id key t = true -> exists a g,
  Map.find id (member_of w) = Some (a, g) /\ (counts_on_route key t a = false -> Kept c).
Proof.
  intros H. pose proof H as K. unfold unless_counted in K. apply andb_true_iff in K as [_ F].
  apply some_robot in F as (a & g & F & _). exists a, g. split; auto.
  apply (kept_unless_counted a g id F c key t H).
Qed.

Lemma kept_by_adding_robots c key t : adds (robots_if_false w key t) (true_if_robots key t) c = true -> Kept c.
Proof.
  apply (kept_by_adding _ _ (presences key t) c (fun m => seat (snd m)) (presence key t));
    auto using presences_are_not_negative.
  - intros l from upto n E.
    assert (One : match Map.find (robot_of_meaning (snd l)) (member_of w) with
      | Some (_, g) =>
          if unless_counted w [l] (robot_of_meaning (snd l)) key t then Some (seat g, seat g + 1, 1) else None
      | None => None
      end = Some (from, upto, n) -> is_true (snd l) = fst l \/ n <= presences key t from upto).
    { intros H. destruct (unless_counted w [l] (robot_of_meaning (snd l)) key t) eqn:U;
        [| destruct (Map.find _ _) as [[? ?] |]; discriminate].
      destruct (count_is_of_a_robot _ _ _ _ U) as (a & g & Found & K). rewrite Found in H.
      injection H as <- <- <-.
      destruct (counts_on_route key t a) eqn:In_it.
      - right. pose proof (found_member a g _ Found) as [M E'].
        pose proof (one_is_in_its_range (fun m => seat (snd m)) (presence key t) (a, g)
          (fun m _ => presences_are_not_negative key t m) M) as L.
        unfold presence at 1, is_present in L. cbn [fst snd] in L. rewrite In_it in L. exact L.
      - left. destruct (K eq_refl) as (l' & [<- | []] & T). exact T. }
    unfold robots_if_false in E. destruct l as [[|] []];
      try (apply One, E).
    destruct ((key0 =? key) && (tick =? t)) eqn:Same; [| discriminate]. decided. subst. injection E as <- <- <-.
    cbn [is_true fst snd]. destruct (least <=? presences key t first end_) eqn:L; auto. decided. auto.
  - intros [[|] []] from upto n E L; try discriminate; simpl in E.
    destruct ((key0 =? key) && (tick =? t)) eqn:Same; [| discriminate]. decided. subst. injection E as <- <- <-.
    apply Z.leb_le. exact L.
Qed.

(** ** Capacity *)

Lemma room_is_not_exceeded key k l t ids : Map.find key (limit_at w) = Some (k, l) -> NoDup ids ->
  (forall id, In id ids -> Counts i (plans s) id l t) -> Z.of_nat (length ids) <= limit_capacity l.
Proof.
  intros F N H. apply (limits_are_kept i s lawful l t ids); auto. exact (limits_are_right i asked w tabled key k l F).
Qed.

(** A robot that counts on its route counts. *)
Lemma robot_on_route_counts m key k l t : In m (crew w) ->
  Map.find key (limit_at w) = Some (k, l) -> counts_on_route key t (fst m) = true ->
  Counts i (plans s) (robot_id (fst m)) l t.
Proof.
  intros M F C. unfold counts_on_route in C. rewrite F in C. apply existsb_exists in C as (place & P & C).
  assert (G : 0 <= gap i) by (unfold gap; destruct (following_is_forbidden i); lia).
  apply orb_true_iff in C as [C | C]; apply andb_true_iff in C as [D C].
  - exists place, 0. rewrite Z.sub_0_r. repeat split; auto; [lia |]. apply robot_inside_occupies; auto.
  - exists place, (gap i). repeat split; auto; [lia |]. apply robot_inside_occupies; auto.
Qed.

Lemma presences_keep_capacity key k l t first end_ : Map.find key (limit_at w) = Some (k, l) ->
  presences key t first end_ <= limit_capacity l.
Proof.
  intros F. set (here := filter (is_present key t) (crew w)).
  assert (L : presences key t first end_ <= Z.of_nat (length here)).
  { unfold presences, ranged, here. clear. induction (crew w) as [| m ms IH]; simpl; [lia |].
    unfold presence at 1. destruct (_ && (_ <? _)), (is_present key t m); simpl length; simpl Z.b2z; lia. }
  rewrite <- (map_length (fun m : member => robot_id (fst m))) in L. etransitivity; [exact L |].
  apply (room_is_not_exceeded key k l t); auto.
  - pose proof (crew_is_distinct i asked w tabled) as N. unfold here. clear - N.
    induction (crew w) as [| m ms IH]; simpl in *; auto. inversion N as [| ? ? Hn Hd]; subst.
    destruct (is_present key t m); simpl; auto. constructor; auto. intros H. apply Hn.
    apply in_map_iff in H as (x & E & H). apply filter_In in H as [H _]. apply in_map_iff. eauto.
  - intros id H. apply in_map_iff in H as (m & <- & H). apply filter_In in H as [H K].
    apply (robot_on_route_counts m key k l t); auto.
Qed.

Lemma kept_by_capacity c :
  existsb (fun l => match l with (false, Crowded _ _ key _ n) => room_below w key n | _ => false end) c = true -> Kept c.
Proof.
  intros H. apply existsb_exists in H as (l & Hl & H). destruct l as [[|] []]; try discriminate.
  exists (false, Crowded first end_ key tick least). split; auto. simpl. apply Z.leb_gt.
  unfold room_below in H. destruct (Map.find key (limit_at w)) as [[k x] |] eqn:F; [| discriminate]. decided.
  pose proof (presences_keep_capacity key k x tick first end_ F). lia.
Qed.

Lemma kept_by_room_for_one c one other key t : one <> other -> room_below w key 2 = true ->
  unless_counted w c one key t = true -> unless_counted w c other key t = true -> Kept c.
Proof.
  intros D R U V. destruct (count_is_of_a_robot _ _ _ _ U) as (a & g & F & K).
  destruct (count_is_of_a_robot _ _ _ _ V) as (b & h & G & L).
  destruct (counts_on_route key t a) eqn:A; [| auto]. destruct (counts_on_route key t b) eqn:B; [| auto]. exfalso.
  destruct (found_member a g one F) as [Ma Ea]. destruct (found_member b h other G) as [Mb Eb].
  unfold room_below in R. destruct (Map.find key (limit_at w)) as [[k x] |] eqn:X; [| discriminate]. decided.
  pose proof (room_is_not_exceeded key k x t [one; other] X) as C. simpl length in C.
  assert (Z.of_nat 2 <= limit_capacity x); [apply C | lia].
  - repeat constructor; simpl; intuition congruence.
  - intros id [<- | [<- | []]]; [rewrite <- Ea | rewrite <- Eb].
    + apply (robot_on_route_counts (a, g) key k x); auto.
    + apply (robot_on_route_counts (b, h) key k x); auto.
Qed.

(** ** Exchange *)

Lemma kept_by_exchange c one other r x from to t : one <> other -> r <> x -> from <> to ->
  are_close w r to = true -> are_close w x from = true ->
  unless_free c one r t = true -> unless_free c other from t = true ->
  unless_present w c one x t = true -> unless_present w c other to t = true -> Kept c.
Proof.
  intros D E E' Cr Cx Fr Fx U V. destruct (presence_is_of_a_robot _ _ _ _ U) as (a & g & F & Da & K).
  destruct (presence_is_of_a_robot _ _ _ _ V) as (b & h & G & Db & L).
  destruct (is_in i a (route a) x t) eqn:A; [| auto]. destruct (is_in i b (route b) to t) eqn:B; [| auto].
  destruct (is_free i a (route a) r t) eqn:A'; [| exact (kept_unless_free a g one F c _ _ Fr A')].
  destruct (is_free i b (route b) from t) eqn:B'; [| exact (kept_unless_free b h other G c _ _ Fx B')]. exfalso.
  destruct (found_member a g one F) as [Ma <-]. destruct (found_member b h other G) as [Mb <-].
  pose proof (robot_free_elsewhere_makes_the_move (a, g) r x t Ma Da A' A E) as M.
  pose proof (robot_free_elsewhere_makes_the_move (b, h) from to t Mb Db B' B E') as N.
  assert (Known : forall id y z, Makes_move (plans s) id y z t -> In y (resource_ids i) /\ In z (resource_ids i)).
  { intros id y z (p & u & v & Hp & _ & C & <- & <- & _).
    destruct (planned_robot_is_known i s lawful p Hp) as (a' & Ha' & I).
    assert (J : In u (visits p) /\ In v (visits p)).
    { destruct C as (before & later & ->). split; apply in_or_app; simpl; auto. }
    pose proof (visits_resources i a' p (plans_lawful i s lawful p a' Hp Ha' I)) as Q. split; apply Q; tauto. }
  destruct (Known _ _ _ M), (Known _ _ _ N).
  apply (exchanges_are_avoided i s lawful (robot_id a) (robot_id b) r x from to t);
    auto using (close_is_right i asked w tabled).
Qed.

(** ** What is demanded *)

Hypothesis met : Meets i s (map fst (crew w)) asked.

Lemma all_delays_are_below total first end_ : asked = Cheaper_than total -> delays first end_ < delays_below w total.
Proof.
  intros Asked. pose proof met as H. rewrite Asked in H. unfold Meets in H.
  rewrite (sum_over_images (A := member)) in H.
  unfold delays, ranged, delays_below.
  assert (L : forall l, (forall m, In m l -> In m (crew w)) ->
    sum (fun m : member => if (first <=? rank (snd m)) && (rank (snd m) <? end_) then delay m else 0) l +
    sum (fun m : member => shortest (snd m)) l <= sum (fun m : member => cost_of_robot i s (robot_id (fst m))) l).
  { unfold sum. induction l as [| m l IH]; cbn [fold_right]; intros Hl; [lia |].
    specialize (IH (fun x Hx => Hl x (or_intror Hx))). pose proof (Hl m (or_introl eq_refl)) as M.
    pose proof (route_costs_no_more m M). pose proof (delays_are_not_negative m M).
    assert (delay m + shortest (snd m) <= cost_of_robot i s (robot_id (fst m))) by (unfold delay; lia).
    destruct (_ && _); lia. }
  specialize (L (crew w) (fun _ H => H)). lia.
Qed.

Lemma kept_by_costing_less c : too_late w asked c = true -> Kept c.
Proof.
  unfold too_late. intros H.
  assert (A : exists k, asked = Cheaper_than k) by (destruct asked; try discriminate; eauto).
  destruct A as [k L]. rewrite L in H. apply orb_true_iff in H as [H | H].
  - decided. pose proof (all_delays_are_below k 0 0 L) as D. unfold delays in D.
    assert (0 <= ranged (fun m => rank (snd m)) delay 0 0); [| lia].
    apply sum_is_not_negative. intros m Hm. pose proof (delays_are_not_negative m Hm). destruct (_ && _); lia.
  - apply existsb_exists in H as (l & Hl & H). exists l. split; auto.
    destruct l as [[|] []]; try discriminate; cbn [delays_if_false] in H.
    + destruct (Map.find id (member_of w)) as [[a g] |] eqn:Found; [| discriminate]. decided.
      cbn [is_true fst snd]. rewrite (of_found_robot a g id Found). apply Z.leb_gt.
      pose proof (one_is_in_its_range (fun m => rank (snd m)) delay (a, g) delays_are_not_negative
        (listed_member a g id Found)) as D.
      pose proof (all_delays_are_below k (rank g) (rank g + 1) L) as B. unfold delays in B. cbn [snd] in D.
      unfold delay at 1 in D. simpl in D. lia.
    + decided. cbn [is_true fst snd]. apply Z.leb_gt. pose proof (all_delays_are_below k first end_ L). lia.
Qed.

(** * All clauses *)

Theorem justified_clause_is_kept c why : justified w asked c why = true -> Kept c.
Proof.
  intros H. destruct why; cbn [justified] in H.
  - apply some_robot in H as (a & g & Found & H). rewrite (takes_are_right i asked w tabled) in H. decided.
    apply (kept_at_the_start a g id Found); auto.
    match goal with K : _ || _ = true |- _ => apply orb_true_iff in K as [K | K] end; decided; auto.
  - apply some_robot in H as (a & g & Found & H). decided.
    match goal with K : forallb _ _ = true |- _ => rename K into All end.
    assert (Each : forall x, Move i place x -> if_free w c id x (tick + need i a x) = true /\
      (x = goal a -> if_cheaper w c id (tick + 1 - release a) = true)).
    { intros x M. apply (onwards_are_moves i asked w tabled) in M. apply (proj1 (forallb_forall _ _) All) in M.
      rewrite (takes_are_right i asked w tabled) in M. apply andb_true_iff in M as [M N]. split; auto. intros ->.
      rewrite Z.eqb_refl in N. exact N. }
    apply (kept_by_going_on a g id Found c place tick); auto; intros; eapply Each; eauto.
  - apply andb_true_iff in H as [U H]. pose proof H as Came. apply some_robot in Came as (a & g & Found & _).
    destruct (is_free i a (route a) place tick) eqn:Is_free; [| exact (kept_unless_free a g id Found c _ _ U Is_free)].
    exact (kept_by_coming_from a g id Found c _ _ H Is_free).
  - apply some_robot in H as (a & g & Found & H). apply andb_true_iff in H as [U F].
    destruct (is_free i a (route a) place tick) eqn:Is_free; [| exact (kept_unless_free a g id Found c _ _ U Is_free)].
    exact (kept_if_free a g id Found c _ _ F Is_free).
  - apply some_robot in H as (a & g & Found & H). decided.
    match goal with K : forallb _ _ = true |- _ => rename K into All end.
    match goal with K : _ && _ = false |- _ => rename K into Not_first end.
    apply (kept_by_arriving a g id Found c cost); auto.
    + intros x M. apply (backwards_are_moves i asked w tabled) in M. apply (proj1 (forallb_forall _ _) All) in M.
      exact M.
    + apply andb_false_iff in Not_first as [N | N]; decided; auto.
  - apply some_robot in H as (a & g & Found & H). apply andb_true_iff in H as [C D].
    destruct (Z_lt_le_dec (route_cost a) cost) as [K | K]; [exact (kept_if_cheaper a g id Found c _ D K) |].
    exact (kept_if_costs a g id Found c _ C K).
  - decided. match goal with K : unless_present _ _ _ _ _ = true |- _ => rename K into Unless end.
    destruct (presence_is_of_a_robot _ _ _ _ Unless) as (a & g & Found & _ & K).
    destruct (is_in i a (route a) place tick) eqn:Inside; auto.
    match goal with E : existsb _ _ = true |- _ => apply existsb_exists in E as (l & Hl & E) end.
    destruct l as [[|] []]; try discriminate. decided. subst. eexists. split; [eassumption |].
    cbn [is_true fst snd]. rewrite (of_found_robot a g id Found). exact Inside.
  - apply existsb_exists in H as (l & Hl & H). destruct l as [[|] []]; try discriminate. eexists. eauto.
  - apply kept_by_adding_delays, H.
  - decided. match goal with K : unless_counted _ _ _ _ _ = true |- _ => rename K into Unless end.
    destruct (count_is_of_a_robot _ _ _ _ Unless) as (a & g & Found & K).
    destruct (counts_on_route key tick a) eqn:Inside; auto.
    match goal with E : existsb _ _ = true |- _ => apply existsb_exists in E as (l & Hl & E) end.
    destruct l as [[|] []]; try discriminate. decided. subst. eexists. split; [eassumption |].
    cbn [is_true fst snd]. rewrite (of_found_robot a g id Found). exact Inside.
  - apply (kept_by_adding_robots c key tick), H.
  - apply kept_by_capacity, H.
  - decided. apply (kept_by_room_for_one c one other key tick); auto.
  - decided. apply (kept_by_exchange c one other source target from to tick); auto.
  - apply kept_by_costing_less, H.
  - pose proof H as Due. apply some_robot in Due as (a & g & Found & _). apply (kept_if_in_time a g id Found c H).
  - pose proof H as Due. apply some_robot in Due as (a & g & Found & _). apply (kept_if_seen a g id Found c H).
  - apply andb_true_iff in H as [U H]. pose proof H as Due. apply some_robot in Due as (a & g & Found & _).
    apply (kept_if_seen_elsewhere a g id Found c _ _ U H).
Qed.

(** The valuation that a solution gives the variables. *)
Definition valuation (known : Numbered.t meaning) (n : Z) : bool :=
  match Numbered.find n known with Some m => is_true m | None => false end.

Lemma read_literal_is_true known l r : read_literal known l = Some r -> is_true (snd r) = fst r ->
  True_in (valuation known) l.
Proof.
  unfold read_literal, True_in, valuation. intros H T.
  destruct (Numbered.find (Z.abs l) known) as [m |] eqn:F; [| discriminate].
  destruct (Z.eqb_spec l 0) as [-> | N]; [discriminate |]. injection H as <-. simpl in T.
  destruct (Z.ltb_spec 0 l).
  - left. rewrite Z.abs_eq in F by lia. rewrite F. auto.
  - right. rewrite Z.abs_neq in F by lia. rewrite F. split; [lia | auto].
Qed.

Lemma kept_clause_is_satisfied known c : Kept (read_clause known c) -> Satisfies (valuation known) c.
Proof.
  intros (r & H & T). unfold Satisfies. induction c as [| l rest IH]; simpl in H; [destruct H |].
  destruct (read_literal known l) as [r' |] eqn:E.
  - destruct H as [-> | H].
    + exists l. split; [left; auto | apply (read_literal_is_true known l r E T)].
    + destruct (IH H) as (k & Hk & K). exists k. simpl. auto.
  - destruct (IH H) as (k & Hk & K). exists k. simpl. auto.
Qed.

Lemma justified_clauses_are_satisfied known f : forall why,
  all_justified w asked known f why = true -> forall c, In c f -> Satisfies (valuation known) c.
Proof.
  induction f as [| c f IH]; simpl; intros why H d Hd; [destruct Hd |].
  destruct why as [| r why]; [discriminate |].
  destruct (justified w asked (read_clause known c) r) eqn:J; [| discriminate].
  destruct Hd as [<- | Hd]; [| apply (IH why H d Hd)].
  apply kept_clause_is_satisfied, (justified_clause_is_kept _ r J).
Qed.
End Solution.

Lemma refuted_blueprint_has_no_solution i group asked b lines s : Well_formed i ->
  (forall a, In a group -> In a (robots i)) -> NoDup (map robot_id group) ->
  blueprint_accepted i group asked b && refutes (formula b) lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s -> ~ Meets i s group asked.
Proof.
  intros right Known Distinct H lawful complete L. unfold blueprint_accepted in H.
  apply andb_true_iff in H as [H R]. apply andb_true_iff in H as [H J]. apply andb_true_iff in H as [N G].
  assert (All : map fst (crew (tables_of i group asked b)) = group) by (apply combined_with_as_many, Nat.eqb_eq, N).
  pose proof (tables_are_right i group asked b right Known Distinct N G) as Right. rewrite <- All in L.
  destruct (crew_is_described i asked _ s right Right lawful complete L) as (routes & ends & Described_crew).
  apply (accepted_refutation_means_unsatisfiable _ _ R
    (valuation i (tables_of i group asked b) routes ends (meanings b))).
  apply (justified_clauses_are_satisfied i asked _ s right Right lawful routes ends Described_crew L _ _ (reasons b) J).
Qed.

Lemma costs_add_up i s : Well_formed i -> Lawful i s ->
  sum (fun a => cost_of_robot i s (robot_id a)) (robots i) = total_cost i s.
Proof.
  intros right lawful. rewrite total_is_the_sum. unfold cost_of_robot. rewrite sums_are_exchanged.
  apply sum_of_equal. intros p Hp.
  rewrite (sum_of_equal _ (fun a => cost_of_plan i p * Z.b2z (robot_id a =? plan_robot p))).
  - rewrite sum_of_multiples, one_of_different_ids; [lia | apply (robot_ids_are_unique i right) |].
    apply (covers_robots i s lawful), in_or_app. left. apply in_map, Hp.
  - intros a _. rewrite Z.eqb_sym. destruct (_ =? _); simpl; lia.
Qed.

(** If the formula of an accepted blueprint of a total is refuted, no lawful solution that plans every robot with a way
    to its goal costs less. *)
Theorem refuted_total_is_impossible i total b lines s : Well_formed i ->
  refuted i (Cheaper_than total) b lines = true -> Lawful i s -> Plans_every_plannable_robot i s ->
  total <= total_cost i s.
Proof.
  intros right H lawful complete. apply Z.le_ngt. rewrite <- costs_add_up by auto.
  apply (refuted_blueprint_has_no_solution i (robots i) (Cheaper_than total) b lines s right); auto.
  apply (robot_ids_are_unique i right).
Qed.

(** If the formula of an accepted blueprint without a total is refuted, no lawful solution plans every robot with a way
    to its goal. *)
Theorem refuted_instance_has_no_solution i b lines s : Well_formed i -> refuted i Lawful_plans b lines = true ->
  Lawful i s -> ~ Plans_every_plannable_robot i s.
Proof.
  intros right H lawful complete.
  apply (refuted_blueprint_has_no_solution i (robots i) Lawful_plans b lines s right); simpl; auto.
  apply (robot_ids_are_unique i right).
Qed.

(** The same from the documents on: no lawful solution that plans every robot with a way to its goal costs less than the
    claim, or no such solution exists. *)
Theorem proved_claim_holds_of_every_solution i cost b lines : claim_proved i cost b lines = true -> Well_formed i /\
  forall s, Lawful i s -> Plans_every_plannable_robot i s ->
  match cost with Some total => total <= total_cost i s | None => False end.
Proof.
  unfold claim_proved. rewrite andb_true_iff. intros [right H].
  apply instance_is_well_formed_exactly_when_accepted in right. split; [exact right |].
  intros s lawful complete. destruct cost as [total |].
  - exact (refuted_total_is_impossible i total b lines s right H lawful complete).
  - exact (refuted_instance_has_no_solution i b lines s right H lawful complete).
Qed.

(** * Cuts and deadlines *)

Lemma group_is_known i ids a : Well_formed i -> In a (group_of i ids) -> In a (robots i).
Proof.
  intros right H. unfold group_of in H. apply in_flat_map in H as (id & Hid & H).
  destruct (Map.find id (index robot_id (robots i))) as [b |] eqn:F; [| destruct H].
  destruct H as [<- | []]. apply find_in_index in F as [F <-]; auto. apply (robot_ids_are_unique i right).
Qed.

Lemma group_has_the_ids i ids : Well_formed i -> length (group_of i ids) = length ids ->
  map robot_id (group_of i ids) = ids.
Proof.
  intros right. unfold group_of.
  assert (Short : forall l, (length (flat_map (fun id : Z => match Map.find id (index robot_id (robots i)) with
    | Some a => [a] | None => [] end) l) <= length l)%nat).
  { induction l as [| id l IH]; simpl; auto. rewrite app_length.
    destruct (Map.find id (index robot_id (robots i))); simpl; lia. }
  induction ids as [| id ids IH]; simpl; auto. intros L. rewrite app_length in L. specialize (Short ids).
  destruct (Map.find id (index robot_id (robots i))) as [a |] eqn:F; cbn [app map length] in *; [| lia].
  apply find_in_index in F as [_ E]; [| apply (robot_ids_are_unique i right)]. rewrite IH by lia. congruence.
Qed.

Lemma refuted_group_does_not_meet i ids asked b lines s : Well_formed i -> group_refuted i ids asked b lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s ->
  map robot_id (group_of i ids) = ids /\ ~ Meets i s (group_of i ids) asked.
Proof.
  intros right H lawful complete. unfold group_refuted in H. rewrite <- andb_assoc in H.
  apply andb_true_iff in H as [H R]. apply andb_true_iff in H as [D L].
  apply Ids.distinct_iff in D. apply Nat.eqb_eq in L. apply (group_has_the_ids i _ right) in L. split; auto.
  apply (refuted_blueprint_has_no_solution i _ asked b lines s right); auto.
  - intros a Ha. apply (group_is_known i ids); auto.
  - rewrite L. exact D.
Qed.

(** The robots of a refuted cut cost at least its least total together. *)
Theorem refuted_cut_holds i k b lines s : Well_formed i -> cut_refuted i k b lines = true -> Lawful i s ->
  Plans_every_plannable_robot i s -> Cut_holds i s k.
Proof.
  intros right H lawful complete.
  destruct (refuted_group_does_not_meet i _ _ b lines s right H lawful complete) as [E N].
  unfold Cut_holds. apply Z.le_ngt. rewrite <- E, sum_over_images. exact N.
Qed.

(** ** How often a deadline is kept *)

Section Deadline.
Variable d : deadline.
Let sighted (r first end_ : Z) : Z := Z.b2z (is_seen d r first end_).

Lemma is_seen_in_a_spot r first end_ : is_seen d r first end_ = true <->
  exists sight, seen d = Some sight /\ first <= seen_at sight < end_ /\ In r (spots sight).
Proof.
  unfold is_seen. destruct (seen d) as [sight |]; [| split; [discriminate | intros (x & E & _); discriminate]].
  rewrite !andb_true_iff, Z.leb_le, Z.ltb_lt, existsb_exists. split.
  - intros [L (x & Hx & E)]. apply Z.eqb_eq in E. subst x. eauto.
  - intros (x & E & L & Hr). injection E as <-. split; auto. exists r. rewrite Z.eqb_refl. auto.
Qed.

Lemma sightings_are_not_negative vs : 0 <= passed sighted vs.
Proof.
  induction vs as [| v rest IH]; cbn [passed]; [lia |]. apply Z.add_nonneg_nonneg; auto.
  destruct rest as [| w later]; [lia |]. unfold sighted. destruct (is_seen _ _ _ _); simpl; lia.
Qed.

Lemma sightings_from_the_second_visit_on v w rest :
  passed sighted (v :: w :: rest) = sighted (visit_resource v) (enter v) (enter w) + passed sighted (w :: rest).
Proof. reflexivity. Qed.

Lemma sighting_is_counted before v w later : is_seen d (visit_resource v) (enter v) (enter w) = true ->
  1 <= passed sighted (before ++ v :: w :: later).
Proof.
  intros H. induction before as [| u before IH]; simpl app.
  - rewrite sightings_from_the_second_visit_on. pose proof (sightings_are_not_negative (w :: later)).
    unfold sighted at 1. rewrite H. simpl Z.b2z. lia.
  - destruct (before ++ v :: w :: later) as [| x rest]; [simpl in IH; lia |].
    rewrite sightings_from_the_second_visit_on. unfold sighted at 1. clear H.
    destruct (is_seen d _ _ _); simpl Z.b2z; lia.
Qed.

Lemma counted_sighting_is_one vs : 1 <= passed sighted vs -> exists before v w later,
  vs = before ++ v :: w :: later /\ is_seen d (visit_resource v) (enter v) (enter w) = true.
Proof.
  induction vs as [| v [| w rest] IH]; [simpl; lia | simpl; lia |]. rewrite sightings_from_the_second_visit_on.
  intros H. destruct (is_seen d (visit_resource v) (enter v) (enter w)) eqn:Seen.
  - exists [], v, w, rest. auto.
  - unfold sighted at 1 in H. rewrite Seen in H. simpl Z.b2z in H.
    destruct IH as (before & x & y & later & E & R); [lia |]. exists (v :: before), x, y, later. rewrite E. auto.
Qed.

Lemma kept_deadline_is_counted p : Keeps d p <-> 1 <= times_kept d (visits p).
Proof.
  unfold Keeps, times_kept, last_arrival. fold sighted. pose proof (sightings_are_not_negative (visits p)) as P.
  assert (Spot : 1 <= passed sighted (visits p) <-> exists v w sight, Consecutive p v w /\ seen d = Some sight /\
    enter v <= seen_at sight < enter w /\ In (visit_resource v) (spots sight)).
  { split.
    - intros H. destruct (counted_sighting_is_one _ H) as (before & v & w & later & E & K).
      apply is_seen_in_a_spot in K as (sight & K). exists v, w, sight. split; [exists before, later; auto | tauto].
    - intros (v & w & sight & (before & later & E) & K). rewrite E. apply sighting_is_counted, is_seen_in_a_spot.
      eauto. }
  destruct (seen d) as [sight |].
  - split.
    + intros [[K L] | (v & w & C & Hr & L)].
      * rewrite (proj2 (Z.leb_le _ _)) by lia. cbn [Z.b2z]. lia.
      * assert (1 <= passed sighted (visits p)) by (apply Spot; exists v, w, sight; auto).
        destruct (_ <=? _); cbn [Z.b2z]; lia.
    + intros K. destruct (Z.leb_spec (arrives (visits p)) (Z.min (due d) (seen_at sight))) as [L | L]; [left; lia |].
      right. cbn [Z.b2z] in K. rewrite Z.add_0_l in K. apply Spot in K as (v & w & x & C & E & L' & Hr).
      injection E as <-. eauto.
  - assert (Z0 : ~ 1 <= passed sighted (visits p)) by (rewrite Spot; intros (v & w & x & _ & E & _); discriminate).
    destruct (Z.leb_spec (arrives (visits p)) (due d)); cbn [Z.b2z]; lia.
Qed.

(** A deadline is kept once: nobody is in two places at a tick, or has arrived and is on its way. *)
Lemma deadline_is_kept_once i a vs : Well_formed i -> In a (robots i) -> Way i a vs -> times_kept d vs <= 1.
Proof.
  intros right known H. unfold times_kept. fold sighted.
  destruct (seen d) as [sight |] eqn:Sight.
  - assert (L : forall v rest, vs = v :: rest ->
      passed sighted vs <= Z.b2z ((enter v <=? seen_at sight) && (seen_at sight <? arrives vs))).
    { induction H as [v Hg Hl | v w rest Hl Hn Hm Hw IH]; intros u later E; injection E as <- <-.
      - simpl. destruct (_ && _); simpl; lia.
      - rewrite sightings_from_the_second_visit_on. specialize (IH w rest eq_refl).
        pose proof (entered_before_the_arrival i a right known _ Hw w rest eq_refl).
        pose proof (need_is_positive i a right known (visit_resource v)).
        rewrite arrives_later. unfold sighted at 1. destruct (is_seen d _ _ _) eqn:Seen.
        + apply is_seen_in_a_spot in Seen as (x & E & Seen & _). rewrite Sight in E. injection E as <-.
          destruct (Z.leb_spec (enter v) (seen_at sight)), (Z.ltb_spec (seen_at sight) (arrives (w :: rest))),
            (Z.leb_spec (enter w) (seen_at sight)); cbn [Z.b2z andb] in *; lia.
        + destruct (Z.leb_spec (enter v) (seen_at sight)), (Z.ltb_spec (seen_at sight) (arrives (w :: rest))),
            (Z.leb_spec (enter w) (seen_at sight)); cbn [Z.b2z andb] in *; lia. }
    unfold last_arrival. rewrite Sight. destruct vs as [| v rest]; [inversion H |]. specialize (L v rest eq_refl).
    destruct (Z.leb_spec (arrives (v :: rest)) (Z.min (due d) (seen_at sight))),
      (Z.leb_spec (enter v) (seen_at sight)), (Z.ltb_spec (seen_at sight) (arrives (v :: rest)));
        cbn [Z.b2z andb] in *; lia.
  - assert (None_seen : passed sighted vs = 0); [| rewrite None_seen; destruct (_ <=? _); cbn [Z.b2z]; lia].
    clear H. induction vs as [| v rest IH]; cbn [passed]; auto. rewrite IH. destruct rest; auto.
    unfold sighted, is_seen. rewrite Sight. reflexivity.
Qed.

End Deadline.

(** In every lawful solution that plans every robot with a way to its goal, one of the robots with refuted deadlines
    does not keep its own: it enters its goal for the last time later, and is not seen on its way in a place that
    counts. *)
Theorem refuted_deadlines_are_not_all_kept i g b lines s : Well_formed i -> deadlines_refuted i g b lines = true ->
  Lawful i s -> Plans_every_plannable_robot i s ->
  exists d p, In d (deadlines g) /\ In p (plans s) /\ plan_robot p = who d /\ ~ Keeps d p.
Proof.
  intros right H lawful complete.
  destruct (refuted_group_does_not_meet i _ _ b lines s right H lawful complete) as [_ N].
  set (broken := fun d p => (plan_robot p =? who d) && (times_kept d (visits p) <? 1)).
  destruct (existsb (fun d => existsb (broken d) (plans s)) (deadlines g)) eqn:Broken.
  - apply existsb_exists in Broken as (d & Hd & Broken). apply existsb_exists in Broken as (p & Hp & Broken).
    unfold broken in Broken. decided. exists d, p. repeat split; auto. rewrite kept_deadline_is_counted. lia.
  - destruct N. intros d p Hd Hp E. apply kept_deadline_is_counted, Z.le_ngt. intros L.
    apply not_true_iff_false in Broken. apply Broken.
    apply existsb_exists. exists d. split; auto. apply existsb_exists. exists p. split; auto.
    unfold broken. apply andb_true_iff. split; [apply Z.eqb_eq, E | apply Z.ltb_lt, L].
Qed.

Lemma robot_has_one_plan_at_most i s id : Lawful i s -> sum (fun p => Z.b2z (plan_robot p =? id)) (plans s) <= 1.
Proof.
  intros lawful. destruct (in_dec Z.eq_dec id (planned s)) as [H | H].
  - rewrite one_of_different_ids; [lia | | exact H]. apply (robots_have_one_plan i s lawful).
  - rewrite (sum_of_equal _ (fun _ => 0)), sum_of_zeros; [lia |]. intros p Hp.
    destruct (Z.eqb_spec (plan_robot p) id) as [<- |]; auto. destruct H. apply in_map, Hp.
Qed.

Lemma refuted_deadlines_hold i g b lines s : Well_formed i -> deadlines_refuted i g b lines = true -> Lawful i s ->
  Plans_every_plannable_robot i s -> Group_holds s g.
Proof.
  intros right H lawful complete.
  destruct (refuted_deadlines_are_not_all_kept i g b lines s right H lawful complete) as (d & p & Hd & Hp & E & K).
  rewrite kept_deadline_is_counted in K.
  set (broken := fun q d => Z.b2z (who d =? plan_robot q) * (1 - times_kept d (visits q))).
  set (all := sum (fun q => sum (broken q) (deadlines g)) (plans s)).
  assert (Once : forall q d, In q (plans s) -> 0 <= broken q d).
  { intros q c Hq. unfold broken. destruct (plan_is_a_way i s right lawful q Hq) as (a & Ha & _ & W).
    pose proof (deadline_is_kept_once c i a (visits q) right Ha W). destruct (_ =? _); simpl Z.b2z; lia. }
  assert (One : 1 <= all).
  { assert (S : 1 <= broken p d).
    { unfold broken. rewrite E, Z.eqb_refl. simpl Z.b2z. lia. }
    etransitivity; [exact S |].
    etransitivity; [apply (sum_is_above_each (broken p) (deadlines g)); auto |].
    apply (sum_is_above_each (fun q => sum (broken q) (deadlines g)) (plans s)); auto.
    intros q Hq. apply sum_is_not_negative. auto. }
  unfold Group_holds. set (kept := fun q d => Z.b2z (who d =? plan_robot q) * times_kept d (visits q)).
  assert (All : sum (fun q => sum (kept q) (deadlines g)) (plans s) + all <= Z.of_nat (length (deadlines g)));
    [| unfold kept in All; lia].
  unfold all. rewrite <- sum_of_sums.
  rewrite (sum_of_equal _ (fun q => sum (fun d => Z.b2z (plan_robot q =? who d)) (deadlines g))).
  - rewrite sums_are_exchanged. clear - lawful. induction (deadlines g) as [| d l IH]; simpl; [lia |].
    pose proof (robot_has_one_plan_at_most i s (who d) lawful). lia.
  - intros q _. rewrite <- sum_of_sums. apply sum_of_equal. intros c _. unfold broken, kept. rewrite Z.eqb_sym.
    destruct (_ =? _); simpl Z.b2z; lia.
Qed.

Lemma all_refuted_claims_hold {A} refuted (Holds : A -> Prop) claimed :
  (forall k b lines, refuted k b lines = true -> Holds k) ->
  forall proofs, all_refuted refuted claimed proofs = true -> forall k, In k claimed -> Holds k.
Proof.
  intros R. induction claimed as [| k claimed IH]; intros proofs H j Hj; [destruct Hj |].
  destruct proofs as [| proof proofs]; [discriminate |]. simpl in H. destruct (proof tt) as [b lines].
  destruct (refuted k b lines) eqn:K; [| discriminate].
  destruct Hj as [<- | Hj]; [apply (R _ _ _ K) | apply (IH proofs H j Hj)].
Qed.

(** No lawful solution that plans every robot with a way to its goal costs less than a bound that a certificate proves,
    whose cuts and deadlines are refuted. *)
Theorem bound_with_refuted_groups_is_below_every_solution i c all of_cuts of_deadlines :
  bound_proved i c all of_cuts of_deadlines = true -> Well_formed i /\
  forall s, Lawful i s -> Plans_every_plannable_robot i s -> bound c <= total_cost i s.
Proof.
  unfold bound_proved. rewrite !andb_true_iff. intros [[right R] H].
  apply instance_is_well_formed_exactly_when_accepted in right. split; [exact right |].
  intros s lawful complete. apply andb_true_iff in R as [Cuts Deadlines].
  apply (accepted_bound_is_below_every_solution i s c all); auto.
  - apply (all_refuted_claims_hold (cut_refuted i) _ _ (fun k b lines K =>
      refuted_cut_holds i k b lines s right K lawful complete) _ Cuts).
  - apply (all_refuted_claims_hold (deadlines_refuted i) _ _ (fun g b lines K =>
      refuted_deadlines_hold i g b lines s right K lawful complete) _ Deadlines).
Qed.
