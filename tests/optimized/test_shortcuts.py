"""Queries that leave out what their plans do not depend on find the plans of those that leave out nothing."""

import pytest

from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Plan
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

CROWDS = {
    "open": grid_instance(Grid(24, 24), Fleet(robots=250, seed=1, after_goal="park")),
    "obstacles": grid_instance(Grid(16, 16, map=20), Fleet(robots=60, seed=2, after_goal="park")),
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


def expanded(*, shortcuts: bool) -> int:
    """The windows that the queries of some robots expand, each against the plans of all others."""
    fleet = PlannedFleet(CROWDS["open"], shortcuts=shortcuts)
    fleet.carp(range(250))
    count = 0
    for asked in range(0, 250, 25):
        beside = PlannedFleet(CROWDS["open"], shortcuts=shortcuts)
        beside.commit([plan for robot, plan in zip(fleet.order, fleet.plans, strict=True) if robot != asked])
        beside.find(asked, None, 0)
        count += int(beside._state.search.expansions[0])
    return count


def test_shortcuts_leave_out_windows() -> None:
    assert 4 * expanded(shortcuts=True) < 3 * expanded(shortcuts=False)
