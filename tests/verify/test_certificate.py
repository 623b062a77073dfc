"""The capacity certificate: it agrees with the checker, and names what it refuses."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.running import Run
from tests.profiles import draws
from tests.spec.making import plan_of

from carp_reference import plan
from carp_spec import Carp, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Violation, Visit, violations_of
from carp_spec.documents.instances import write_instance
from carp_spec.documents.solutions import write_solution
from carp_spec.model import Group
from carp_spec.permutations import splitmix64
from carp_verify import certificate
from carp_verify.certificate import Breach, certify, certify_together
from carp_verify.lemmas.smt import Solver, Undecided
from carproof.testing.random_instances import Draw, Mix, draw_instance
from carproof.testing.strategies import BrokenSolution, PlannedInstance, Sizes, broken_solutions, planned_instances

CROWDED = Mix(robots=(3, 4), paces=(1,), groups=(1, 2), followings=("allowed", "allowed", "forbidden"), stops=2)
LINE = ResourceGraph((Resource("a"), Resource("b", capacity=2), Resource("c")), (("a", "b"), ("b", "c")))
INSTANCE = Instance(LINE, (Robot("r1", "a", "c"), Robot("r2", "c", "a"), Robot("r3", "b", "b", 1)), "vanish")
EASTWARD = plan_of("r1", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))
WESTWARD = plan_of("r2", ("c", 0, 1), ("b", 1, 2), ("a", 2, 3))
STANDING = plan_of("r3", ("b", 1, 2))


def agree(instance: Instance, plans: tuple[Plan, ...]) -> None:
    """Both find fault with the same resources and groups; the certificate's tick and robots are among the checker's."""
    certified = certify_together(instance, plans)
    reported = [violation for violation in violations_of(instance, plans) if violation.rule.startswith("joint/")]
    assert {blamed(instance, each) for each in certified.breaches} == {blamed(instance, each) for each in reported}
    for breach in certified.breaches:
        assert any(
            blamed(instance, violation) == blamed(instance, breach)
            and (set(violation.robots) >= set(breach.robots) or exchange_among_more(instance, violation, breach))
            and (violation.start or 0) <= breach.tick
            and (violation.end is None or breach.tick < violation.end)
            for violation in reported
        )


def exchange_among_more(instance: Instance, violation: Violation, breach: Breach) -> bool:
    """Whether two of the robots exchange areas: the checker blames each two moves, the certificate all of them."""
    shared = set(violation.robots) & set(breach.robots)
    return bool(instance.graph.groups) and breach.rule == "joint/exchange" and len(shared) > 1


def blamed(instance: Instance, found: Breach | Violation) -> tuple[object, ...]:
    """The rule with the group, or else the resource; where there are groups, of an exchange the rule alone."""
    group = re.search(r" of group [^,]*", found.reason)
    alone = instance.graph.groups and found.rule == "joint/exchange"
    return (found.rule,) if alone else (found.rule, group[0] if group else found.resource)


@given(st.one_of(planned_instances(), planned_instances(Sizes(groups=3))))
@settings(max_examples=draws(200))
def test_sound_solutions_are_certified(planned: PlannedInstance) -> None:
    assert certify(planned.instance, planned.solution).accepted


@given(st.one_of(broken_solutions(), broken_solutions(Sizes(groups=3))))
def test_no_broken_solution_is_certified(broken: BrokenSolution) -> None:
    assert not certify(broken.instance, broken.solution).accepted


@pytest.mark.parametrize("capacity", [2, 2**31 - 2, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 10**99])
def test_a_capacity_of_any_size_is_never_exceeded_by_two_robots(capacity: int) -> None:
    graph = ResourceGraph((Resource("a", capacity),), ())
    pair = (plan_of("r1", ("a", 0, 1)), plan_of("r2", ("a", 0, 1)))
    instance = Instance(graph, (Robot("r1", "a", "a"), Robot("r2", "a", "a")))
    assert certify(instance, Solution(pair, ("r1", "r2"))).accepted


@pytest.mark.parametrize(
    ("plans", "breaches"),
    [
        ((EASTWARD, WESTWARD, STANDING), []),
        ((EASTWARD, STANDING), [Breach("joint/capacity", ("r1", "r3"), "b", 1, "capacity 2")]),
    ],
)
def test_a_checker_and_z3_that_contradict_each_other_are_a_fault(
    plans: tuple[Plan, ...], breaches: list[Breach], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(certificate, "overfull", lambda *_: breaches)
    with pytest.raises(RuntimeError, match=r"the checker and z3 differ: \[joint/capacity\] resource b "):
        certify(INSTANCE, Solution.of(INSTANCE, plans))


@given(st.one_of(broken_solutions(), broken_solutions(Sizes(groups=3))))
@settings(max_examples=draws(500))
def test_certificate_and_checker_agree_on_broken_solutions(broken: BrokenSolution) -> None:
    agree(broken.instance, broken.solution.plans)


def test_certificate_and_checker_agree_on_robots_that_know_nothing_of_each_other_among_groups() -> None:
    for number in range(draws(2500)):
        instance = draw_instance(Draw(splitmix64(number)), CROWDED)
        alone = [plan(replace(instance, robots=(robot,)), Carp()).plans for robot in instance.robots]
        agree(instance, tuple(each for plans in alone for each in plans))


PAIR = ResourceGraph((Resource("a", 2), Resource("b", 2)), (("a", "b"),))
BLOCK = ResourceGraph(
    tuple(Resource(name) for name in ("a", "left", "right", "b")),
    (("a", "left"), ("left", "right"), ("right", "b"), ("a", "right")),
    groups=(Group("g", ("left", "right")),),
)


@pytest.mark.parametrize(
    ("graph", "plans", "tick", "shown"),
    [
        (LINE, (EASTWARD, WESTWARD, STANDING), 1, "resource b at tick 1: robots r1, r2, r3 (capacity 2)"),
        (LINE, (EASTWARD, plan_of("r2", ("c", 2, None))), 2, "[joint/capacity] resource c at tick 2: robots r1, r2 "),
        (
            LINE,
            (plan_of("r2", ("c", 0, None)), plan_of("r1", ("c", 10**12, 10**12 + 1))),
            10**12,
            "[joint/capacity] resource c at tick ",
        ),
        (LINE, (EASTWARD, plan_of("r2", ("b", 0, 1), ("a", 1, 2))), 1, "they exchange a and b"),
        # one of two that exchange the only resources goes back later
        (
            PAIR,
            (plan_of("r1", ("a", 0, 1), ("b", 1, 5), ("a", 5, 6)), plan_of("r2", ("b", 0, 1), ("a", 1, 2))),
            1,
            "[joint/exchange] ",
        ),
        # robots in a group are named with a resource of it in which one is at the tick
        (
            BLOCK,
            (plan_of("r1", ("left", 0, 2), ("right", 2, 5)), plan_of("r2", ("left", 4, 6))),
            4,
            "[joint/group] resource right at tick 4: robots r1, r2 (capacity 1 of group g)",
        ),
    ],
)
def test_a_breach_is_told_with_rule_robots_and_tick(
    graph: ResourceGraph, plans: tuple[Plan, ...], tick: int, shown: str
) -> None:
    (breach,) = certify_together(Instance(graph, (), "vanish"), plans).breaches
    assert ({*breach.robots}, breach.tick) == ({plan.robot for plan in plans}, tick)
    assert shown in str(breach)


@pytest.mark.parametrize(
    ("plans", "rule"),
    [
        ((plan_of("r1", ("a", 0, 1), ("c", 1, 2)),), "plan/move"),
        ((EASTWARD, EASTWARD), "solution/covers"),
        ((EASTWARD, plan_of("r9", ("a", 7, 8))), "solution/covers"),
    ],
)
def test_teleports_second_plans_and_strangers_are_refused(plans: tuple[Plan, ...], rule: str) -> None:
    others = tuple(robot for robot in ("r1", "r2", "r3") if robot not in {plan.robot for plan in plans})
    order = tuple(dict.fromkeys(plan.robot for plan in plans))
    certified = certify(INSTANCE, Solution(plans, order, others))
    assert not certified.accepted
    assert [violation.rule for violation in certified.violations] == [rule]
    assert (certified.resources, certified.pairs, certified.breaches) == (0, 0, ())


@pytest.mark.parametrize(
    ("enter", "rules"), [(3, {"joint/capacity", "joint/following"}), (4, {"joint/following"}), (5, set())]
)
def test_who_comes_within_the_gap_is_refused_where_following_is_forbidden(enter: int, rules: set[str]) -> None:
    instance = Instance(LINE, INSTANCE.robots, "vanish", following="forbidden")
    plans = plan_of("r1", ("a", 0, 4)), plan_of("r2", ("a", enter, 9))
    assert {each.rule for each in certify_together(instance, plans).breaches} == rules
    agree(instance, plans)


def test_robots_that_exchange_a_group_of_capacity_one_are_refused_wherever_in_it_they_are() -> None:
    plans = plan_of("r1", ("left", 0, 1), ("a", 1, 2)), plan_of("r2", ("a", 0, 1), ("right", 1, 2))
    robots = (Robot("r1", "left", "a"), Robot("r2", "a", "right"))
    for groups, refused in (
        ((), False),
        ((Group("block", ("left", "right")),), True),
        ((Group("block", ("left", "right"), 2),), False),
        ((Group("other", ("b",)), Group("block", ("left", "right"))), True),
    ):
        instance = Instance(replace(BLOCK, groups=groups), robots, "vanish")
        breaches = certify_together(instance, plans).breaches
        assert [(each.rule, each.tick) for each in breaches] == [("joint/exchange", 1)] * refused
        agree(instance, plans)


def test_a_robot_that_moves_both_ways_at_a_tick_exchanges_with_nobody() -> None:
    alone = plan_of("r1", ("a", 0, 1), ("b", 1, 1), ("a", 1, 2))
    agree(INSTANCE, (alone,))


def test_visits_to_no_resource_of_the_graph_are_none_of_its_business() -> None:
    visits = (Visit("elsewhere", 0, 1), Visit("a", 1, 2), Visit("elsewhere", 2, 3), Visit("beyond", 3, 4))
    certified = certify_together(INSTANCE, (Plan("r1", visits), Plan("r2", visits[::-1])))
    assert (certified.resources, certified.pairs) == (1, 0)


def write(folder: Path, *plans: Plan) -> tuple[Path, Path]:
    files = folder / "instance.json", folder / "solution.json"
    files[0].write_bytes(write_instance(INSTANCE))
    files[1].write_bytes(write_solution(Solution.of(INSTANCE, plans)))
    return files


def test_the_command_certifies_and_refuses(carproof: Run, tmp_path: Path) -> None:
    for plans, code, said in (
        ((EASTWARD, STANDING), 0, "certified: "),
        ((EASTWARD, WESTWARD, STANDING), 1, "[joint/capacity] resource b at tick 1"),
        ((plan_of("r1", ("a", 0, 1), ("c", 1, 2)),), 1, "[plan/move] resource c in [1,2)"),
    ):
        outcome = carproof("check", "--z3", *write(tmp_path, *plans))
        assert (outcome.code, outcome.stdout.startswith(said)) == (code, True), outcome


def test_what_z3_cannot_tell_is_undecided(carproof: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Puzzled(Solver):
        def find_model(self, formulas: object) -> None:
            raise Undecided(f"z3 answers unknown to {formulas}")

    monkeypatch.setattr(certificate, "Solver", Puzzled)
    outcome = carproof("check", "--z3", *write(tmp_path, EASTWARD))
    assert outcome.code == 3
    assert outcome.stderr.startswith("Undecided: z3 answers unknown")
