"""The checker as a whole: silent on correct plans, and exactly right about each planted violation."""

from collections import Counter
from dataclasses import replace
from itertools import combinations_with_replacement, pairwise
from time import process_time

from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import SOLVED, VANISHING, plan_of, solution_of
from tests.spec.naive import HORIZON, broken_plan_rules, crowds, exchanges, groups_of, places_of
from tests.spec.strategies import FEWER, SIZES, instances_with_plans

import carp_reference
from carp_spec import (
    Carp,
    Greedy,
    Instance,
    LongestFirst,
    Move,
    Neighbourhood,
    Plan,
    Planner,
    Resource,
    ResourceGraph,
    Robot,
    Shuffled,
    Solution,
    TimeExpanded,
    check_update,
    judge,
    violations_of,
)
from carp_spec.check import MOST_LISTED
from carproof.testing.strategies import instances

FEW = replace(SIZES, robots=3, groups=2)
PLANNERS: tuple[Planner, ...] = (
    Carp(),
    Shuffled(attempts=2),
    LongestFirst(),
    Greedy(),
    Neighbourhood(m=3),
    Neighbourhood(m=3, baseline=False),
    TimeExpanded(),
)


def rules_broken(instance: Instance, plans: tuple[Plan, ...]) -> list[str]:
    return [violation.rule for violation in violations_of(instance, plans)]


@FEWER
@given(instance=instances(FEW), planner=st.sampled_from(PLANNERS))
def test_what_the_planners_plan_breaks_no_rule(instance: Instance, planner: Planner) -> None:
    verdict = judge(instance, carp_reference.plan(instance, planner))
    assert verdict.violations == ()


def test_violations_come_rule_by_rule_then_plan_by_plan_and_in_order_of_time() -> None:
    wrong = (
        plan_of("r1", ("b", 0, 0), ("f", 3, 4), ("d", 4, 5)),
        plan_of("r2", ("b", 1, 2), ("c", 2, 3), ("a", 3, None)),
        plan_of("r3", ("f", 0, 9)),
    )
    reported = [(violation.rule, violation.robots, violation.start) for violation in violations_of(VANISHING, wrong)]
    assert reported == [
        ("plan/start", ("r1",), 0),
        ("plan/start", ("r2",), 1),
        ("plan/goal", ("r2",), 3),
        ("plan/goal", ("r3",), 0),
        ("plan/move", ("r1",), 3),
        ("plan/move", ("r1",), 4),
        ("plan/move", ("r2",), 3),
        ("plan/contiguous", ("r1",), 3),
        ("plan/duration", ("r1",), 0),
        ("plan/duration", ("r2",), 2),
        ("joint/capacity", ("r1", "r3"), 3),
    ]


@FEWER
@given(case=instances_with_plans())
def test_the_checker_agrees_with_the_rules_spelt_out_plan_by_plan(case: tuple[Instance, tuple[Plan, ...]]) -> None:
    instance, plans = case
    reported = Counter(
        (each.rule, each.robots, each.resource, each.start, each.end)
        for each in violations_of(instance, plans, most=None)
        if each.rule.startswith("plan/")
    )
    spelt_out = Counter(
        (rule, (plan.robot,), visit and visit.resource, visit and visit.enter, visit and visit.leave)
        for each in plans
        for rule, plan, visit in broken_plan_rules(instance, each)
    )
    assert reported == spelt_out


@FEWER
@given(case=instances_with_plans())
def test_the_checker_agrees_with_the_rules_spelt_out_tick_by_tick(case: tuple[Instance, tuple[Plan, ...]]) -> None:
    instance, plans = case
    violations = violations_of(instance, plans, most=None)
    reported = [
        (each, range(each.start, HORIZON if each.end is None else each.end))
        for each in violations
        if each.rule == "joint/capacity" and each.start is not None
    ]
    crowded: dict[tuple[object, int], frozenset[object]] = {
        (resource, tick): robots for resource, tick, robots in crowds(places_of(instance.graph), plans)
    }
    assert Counter((each.resource, tick) for each, ticks in reported for tick in ticks) == Counter(crowded.keys())
    for each, ticks in reported:
        assert (each.resource, ticks.start - 1) not in crowded
        assert (each.resource, ticks.stop) not in crowded
        assert set(each.robots) == frozenset[object]().union(*(crowded[each.resource, tick] for tick in ticks))
    exchanged = [
        (each.start, frozenset({one, other}))
        for each in violations
        if each.rule == "joint/exchange"
        for one, other in combinations_with_replacement(sorted(instance.graph.moves | steps(plans), key=repr), 2)
        if each.reason in (said(one, other, each.start), said(other, one, each.start))
    ]
    assert Counter(exchanged) == Counter({*exchanges(instance, plans)})


def steps(plans: tuple[Plan, ...]) -> set[Move]:
    """All pairs of resources visited one after the other."""
    return {(at.resource, to.resource) for plan in plans for at, to in pairwise(plan.visits)}


def said(one: Move, other: Move, tick: int | None) -> str:
    """What is said of two moves in that order."""
    ways = f"{one[0]} and {one[1]}" if one == other[::-1] else f"{one} and {other}"
    return f"they exchange {ways} at tick {tick}"


@FEWER
@given(case=instances_with_plans())
def test_the_checker_agrees_with_groups_spelt_out_tick_by_tick(case: tuple[Instance, tuple[Plan, ...]]) -> None:
    instance, plans = case
    found = {
        (each.reason, tick): frozenset(each.robots)
        for each in violations_of(instance, plans, most=None)
        if each.rule == "joint/group"
        for tick in range(each.start or 0, HORIZON if each.end is None else each.end)
    }
    spelt_out = {(group, tick): robots for group, tick, robots in crowds(groups_of(instance.graph), plans)}
    capacity = {group.id: group.capacity for group in instance.graph.groups}
    assert found.keys() == {(f"capacity {capacity[id]} of group {id}", tick) for id, tick in spelt_out}
    for (id, tick), robots in spelt_out.items():
        assert robots <= found[f"capacity {capacity[id]} of group {id}", tick]


MANY = 3_000


def robots_in_one_cell(count: int, capacity: int = 1) -> Instance:
    graph = ResourceGraph((Resource("a", capacity), Resource("b")), (("a", "b"),))
    return Instance(graph, tuple(Robot(name, "a", "a", name) for name in range(count)), "park")


def test_very_many_robots_in_one_cell_are_one_violation_in_a_short_message() -> None:
    instance = robots_in_one_cell(MANY)
    (violation,) = violations_of(instance, [plan_of(name, ("a", name, None)) for name in range(MANY)])
    assert violation.robots == tuple(range(MANY))
    assert violation.message == "resource a in [1,for ever): robots 0, 1, 2, 3, 4 and 2995 more (capacity 1)"


def test_a_robot_that_overfills_a_full_cell_again_and_again_is_reported_a_bounded_number_of_times() -> None:
    instance = robots_in_one_cell(MANY, MANY - 1)
    parked = [plan_of(name, ("a", name, None)) for name in range(MANY - 1)]
    visits = [
        visit for tick in range(MANY - 1, 3 * MANY, 2) for visit in (("a", tick, tick + 1), ("b", tick + 1, tick + 2))
    ]
    violations = violations_of(instance, [*parked, plan_of(MANY - 1, *visits)])
    assert Counter(each.rule for each in violations) == {"plan/goal": 1, "joint/capacity": MOST_LISTED}


def test_at_most_so_many_violations_of_each_rule_are_listed_and_all_on_demand() -> None:
    broken = plan_of("r1", *(("x", 3 * tick, 3 * tick - 1) for tick in range(MANY)))
    rules = {"plan/resource": MANY, "plan/contiguous": MANY - 1, "plan/start": 1, "plan/goal": 1}
    assert Counter(rules_broken(VANISHING, (broken,))) == {rule: min(n, MOST_LISTED) for rule, n in rules.items()}
    assert Counter(each.rule for each in violations_of(VANISHING, [broken], most=None)) == rules
    assert Counter(each.rule for each in violations_of(VANISHING, [broken], most=2))["plan/contiguous"] == 2
    few = judge(VANISHING, solution_of([broken]), most=2).violations
    assert Counter(each.rule for each in few)["plan/contiguous"] == 2
    strangers = Solution((), tuple(range(MANY)), tuple(range(MANY)))
    listed = Counter(each.rule for each in judge(VANISHING, strangers).violations)
    assert listed == {"solution/covers": MOST_LISTED, "solution/order": MOST_LISTED}
    everything = Counter(each.rule for each in judge(VANISHING, strangers, most=None).violations)
    assert everything == {"solution/covers": MANY + 3, "solution/order": MANY}


def test_a_plan_through_a_hub_of_very_many_moves_is_checked_in_time() -> None:
    spokes = 10 * MANY
    graph = ResourceGraph(
        (Resource("hub"), *map(Resource, range(spokes))), tuple(("hub", spoke) for spoke in range(spokes))
    )
    instance = Instance(graph, (Robot("r1", "hub", spokes - 1),))
    there = [
        visit
        for tick in range(spokes)
        for visit in (("hub", 2 * tick, 2 * tick + 1), (tick, 2 * tick + 1, 2 * tick + 2))
    ]
    started = process_time()
    assert violations_of(instance, [plan_of("r1", *there)]) == ()
    assert process_time() - started < 2


def test_a_verdict_sums_the_costs_and_counts_the_unplanned() -> None:
    """A plan without visits adds no cost, and counts as a plan."""
    for solution, expected in (
        (solution_of(SOLVED[:2], unplanned=("r3",)), (True, 5 + 3, 1)),
        (solution_of((*SOLVED[:2], plan_of("r3"))), (False, 5 + 3, 0)),
    ):
        verdict = judge(VANISHING, solution)
        assert (verdict.valid, verdict.cost, verdict.unplanned) == expected


def test_an_update_is_checked_robot_by_robot() -> None:
    again = plan_of("r2", ("e", 1, 3), ("b", 3, 5), ("a", 5, 6))
    assert check_update(SOLVED, (SOLVED[0], again), now=1) == ()
    told = [(each.robots, each.resource, each.start) for each in check_update(SOLVED, (SOLVED[0], again), now=2)]
    assert told == [(("r2",), "e", 1), (("r2",), "b", 3)]
    assert check_update(SOLVED, (), now=2) == ()
