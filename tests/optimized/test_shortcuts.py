"""Queries that leave out what their plans do not depend on find the plans of those that leave out nothing."""

import pytest

from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Plan
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


def planned(instance: Instance, *, shortcuts: bool) -> tuple[tuple[Plan, ...], tuple[Plan, ...]]:
    """The plans of a pass, and what a polish makes of them."""
    fleet = PlannedFleet(instance, shortcuts=shortcuts)
    fleet.carp(range(len(instance.robots)))
    first = fleet.plans
    fleet.polish(fleet.polishing(seed=0), 400)
    return first, fleet.plans


@pytest.mark.parametrize("crowd", CROWDS)
def test_shortcuts_change_no_plan(crowd: str) -> None:
    instance = CROWDS[crowd]
    assert planned(instance, shortcuts=True) == planned(instance, shortcuts=False)


def entered_in_vain(crowd: str, *, shortcuts: bool) -> int:
    """The windows that the queries of the robots that a pass leaves without a plan enter, asked again behind it."""
    instance = CROWDS[crowd]
    fleet = PlannedFleet(instance, shortcuts=shortcuts)
    fleet.carp(range(len(instance.robots)))
    count = 0
    for robot in sorted({*range(len(instance.robots))} - {*fleet.order}):
        before = fleet.state.search.generation << 32
        assert fleet.find(robot, None, 0) is None
        count += int((fleet.state.search.reached > before).sum())
    return count


@pytest.mark.parametrize("crowd", ["open", "dead ends"])
def test_a_query_ends_soon_where_robots_cut_its_goal_off(crowd: str) -> None:
    assert 0 < 2 * entered_in_vain(crowd, shortcuts=True) < entered_in_vain(crowd, shortcuts=False)


def expanded(*, shortcuts: bool) -> int:
    """The windows that the queries of some robots expand, each against the plans of all others."""
    fleet = PlannedFleet(CROWDS["open"], shortcuts=shortcuts)
    fleet.carp(range(250))
    count = 0
    for asked in range(0, 250, 25):
        beside = PlannedFleet(CROWDS["open"], shortcuts=shortcuts)
        beside.commit([plan for robot, plan in zip(fleet.order, fleet.plans, strict=True) if robot != asked])
        beside.find(asked, None, 0)
        count += int(beside.state.search.expansions[0])
    return count


def test_shortcuts_leave_out_windows() -> None:
    assert 4 * expanded(shortcuts=True) < 3 * expanded(shortcuts=False)
