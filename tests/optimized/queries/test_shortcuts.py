"""Queries for a plan alone look at few windows, and arrive when those do that look at all that matter."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_optimized.state.arrays import ALONE, GREEDY, SOON, WHOLE
from carp_spec import Plan, Solution, Stop, Visit, judge
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

CROWDS = {
    "open": grid_instance(Grid(24, 24), Fleet(robots=250, seed=1, after_goal="park")),
    "obstacles": grid_instance(Grid(16, 16, map=20), Fleet(robots=60, seed=2, after_goal="park")),
    "dead ends": grid_instance(Grid(20, 20, map=2), Fleet(robots=80, seed=5, after_goal="park")),
    "entered before": grid_instance(  # a window may be entered sooner than any that is entered from now on
        Grid(15, 13, map=3, map_seed=5),
        Fleet(robots=91, seed=910093, after_goal="park", release=Range(0, 20), pace=Range(1, 2)),
    ),
    "orders": grid_instance(
        Grid(16, 16, map=4),
        Fleet(robots=50, seed=6, after_goal="park", orders="pick-and-drop", service=Range(0, 3)),
    ),
    "durations": grid_instance(
        Grid(14, 14, map=10),
        Fleet(robots=50, seed=3, after_goal="park", release=Range(0, 9), pace=Range(1, 2)),
        Traits(duration=Range(1, 3)),
    ),
    "capacities": grid_instance(
        Grid(10, 10), Fleet(robots=50, seed=4, after_goal="park"), Traits(capacity=Range(1, 2))
    ),
}


def beside_others(crowd: str) -> Iterator[tuple[PlannedFleet, int]]:
    """Robots of a crowd, each with the fleet of all others that have plans."""
    instance = CROWDS[crowd]
    fleet = PlannedFleet(instance)
    carp(fleet, range(len(instance.robots)))
    for asked in range(0, len(instance.robots), 5):
        others = PlannedFleet(instance)
        others.commit([plan for robot, plan in zip(fleet.order, fleet.plans, strict=True) if robot != asked])
        yield others, asked


@pytest.mark.parametrize("crowd", CROWDS)
def test_a_plan_alone_arrives_when_the_whole_search_does(crowd: str) -> None:
    for fleet, robot in beside_others(crowd):
        alone, whole = fleet.find(robot, None, 0), fleet.find(robot, None, 0, WHOLE)
        assert (alone is None) == (whole is None)
        assert alone is None or whole is None or alone.visits[-1].enter == whole.visits[-1].enter


def entered_in_vain(crowd: str, asked: int) -> int:
    """The windows that the queries of the robots that a pass leaves without a plan enter, asked again behind it."""
    instance = CROWDS[crowd]
    fleet = PlannedFleet(instance)
    carp(fleet, range(len(instance.robots)))
    count = 0
    for robot in sorted({*range(len(instance.robots))} - {*fleet.order}):
        before = fleet.state.search.generation << 32
        assert fleet.find(robot, None, 0, asked) is None
        count += int((fleet.state.search.reached > before).sum())
    return count


@pytest.mark.parametrize("crowd", ["open", "dead ends"])
def test_a_query_ends_soon_where_robots_cut_its_goal_off(crowd: str) -> None:
    assert 4 * entered_in_vain(crowd, ALONE) < 3 * entered_in_vain(crowd, WHOLE)


def test_a_goal_that_is_free_late_costs_few_windows() -> None:
    counts = {ALONE: 0, WHOLE: 0}
    for fleet, robot in beside_others("open"):
        for asked in counts:
            fleet.find(robot, None, 0, asked)
            counts[asked] += int(fleet.state.search.expansions[0])
    assert 4 * counts[ALONE] < 3 * counts[WHOLE]


@pytest.mark.parametrize("crowd", CROWDS)
def test_a_greedy_plan_breaks_no_rule_and_arrives_no_earlier(crowd: str) -> None:
    instance, missed = CROWDS[crowd], 0
    for fleet, robot in beside_others(crowd):
        alone, greedy = fleet.find(robot, None, 0), fleet.find(robot, None, 0, GREEDY)
        assert fleet.find(robot, None, 0, SOON) == alone
        missed += alone is not None and greedy is None
        if greedy is not None:
            assert alone is not None
            assert alone.visits[-1].enter <= greedy.visits[-1].enter
            assert judge(instance, Solution.of(instance, [*fleet.plans, greedy])).valid
    assert missed <= 1


@pytest.mark.parametrize("stops", [0, 1])
def test_a_query_for_what_is_found_soon_gives_up(stops: int) -> None:
    """The goal is free late, so the query waits in all cells of the map."""
    instance = grid_instance(Grid(60, 60), Fleet(robots=2, seed=1))
    one, other = instance.robots
    asked = replace(other, stops=(*(Stop(each.start) for each in (one,) * stops), Stop(one.goal)))
    fleet = PlannedFleet(replace(instance, robots=(replace(one, start=one.goal), asked)))
    fleet.commit([Plan(one.id, (Visit(one.goal, 0, 5000),))])
    assert fleet.find(1, None, 0) is not None
    assert fleet.find(1, None, 0, SOON) is None
    assert fleet.find(1, None, 0, GREEDY) is None
