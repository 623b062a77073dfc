"""Shortcuts of adding a robot return the same as without them, and as the law: see test_uncompiled.py.

Compiled code has the sizes in it that some tests change.
"""

import os
from fractions import Fraction

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.optimized.neighbourhood.arrivals import ROOMS, arrivals
from tests.profiles import draws

import carp_reference
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood import adding as neighbourhood
from carp_optimized.neighbourhood import answers, distances
from carp_optimized.neighbourhood.distances import follow, nearest
from carp_optimized.orderings import carp
from carp_optimized.queries.search import find_plan_alone, find_plan_by
from carp_optimized.state.arrays import NEVER, NONE, Records, Work
from carp_optimized.state.room import no_work
from carp_spec import Neighbourhood, neighbourhood_rules
from carproof.generate import Fleet, Grid, Range, grid_instance
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")

SIZES = Sizes(resources=6, robots=5)


@st.composite
def planned_fleets(draw: st.DrawFn) -> PlannedFleet:
    """Fleets planned by CARP on grids so small that many distances are alike."""
    grid = Grid(5, 5, map=draw(st.sampled_from([0, 5, 20])))
    robots = Fleet(draw(st.integers(3, 9)), draw(st.integers(0, 999)), release=Range(0, draw(st.sampled_from([0, 9]))))
    fleet = PlannedFleet(grid_instance(grid, robots))
    carp(fleet, range(robots.robots))
    assume(len(fleet.order) > 1)
    return fleet


def by_law(fleet: PlannedFleet, one: int, other: int) -> Fraction:
    """The distance of two plans by the law."""
    plans = fleet.plans
    return neighbourhood_rules.distance(fleet.instance, plans[one], plans[other])


def split(fleet: PlannedFleet, members: int) -> Work:
    """The last robots are members, and the others outside."""
    work = no_work(len(fleet.held), members, 0)
    for robot in fleet.planned:
        follow(fleet.state, work, int(robot), int(fleet.held[robot]))
    outside = len(fleet.order) - members
    work.outside[:outside] = fleet.planned[:outside]
    work.members[:] = fleet.planned[outside:]
    work.ended[:] = 0
    return work


@settings(max_examples=draws(40))
@given(planned_fleets(), st.data())
def test_the_nearest_robot_is_that_of_the_law(fleet: PlannedFleet, data: st.DataObject) -> None:
    """Whether or not sums bound distances from below."""
    robots = len(fleet.order)
    members = data.draw(st.integers(1, min(3, robots - 1)))
    outside = robots - members
    work = split(fleet, members)
    rows = [[by_law(fleet, robot, member) for member in range(outside, robots)] for robot in range(outside)]
    expected = neighbourhood_rules.nearest(rows)
    assert nearest(fleet.state, work, outside, members) == expected
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distances, "least_sum", lambda _x, _y, _ticks: 0)
        patch.setattr(distances, "are_apart", lambda *_: False)
        assert nearest(fleet.state, work, outside, members) == expected
    work.ended[work.outside[expected]] = 1
    if outside == 1:
        assert nearest(fleet.state, work, outside, members) == NONE
    else:
        others = [each for each in range(outside) if each != expected]
        left = neighbourhood_rules.nearest([rows[each] for each in others])
        assert nearest(fleet.state, work, outside, members) == others[left]


def what_was_read(records: Records, record: int) -> list[list[int]]:
    """The visits and expansions of a record."""
    visits = slice(int(records.visits_at[record]), int(records.visits_at[record] + records.visits[record]))
    read = slice(int(records.expansions_at[record]), int(records.expansions_at[record] + records.expansions[record]))
    fields = (
        records.resource[visits],
        records.enter[visits],
        records.spots[record],
        records.leave[record : record + 1],
    )
    readings = (records.expanded[read], records.ready[read], records.until[read], records.largest[read])
    return [each.tolist() for each in (*fields, *readings, records.regions[record : record + 1])]


@settings(max_examples=draws(60))
@given(fleets_under_way(SIZES))
def test_a_plan_where_nothing_is_reserved_is_made_as_by_a_search(under_way: FleetUnderWay) -> None:
    fleet = PlannedFleet(under_way.instance)
    robot = fleet.index(under_way.robot)
    state = fleet.empty.fields
    one = find_plan_alone(state, robot, NONE, under_way.now)
    other = find_plan_by(state, robot, NONE, under_way.now, NEVER, NEVER)
    assert (one == NONE) == (other == NONE)
    if one != NONE:
        assert what_was_read(state.records, one) == what_was_read(state.records, other)
    assert fleet.queries.asked == 2


def rows(fleet: PlannedFleet) -> list[list[tuple[int, ...]]]:
    """The windows of each resource, with the robots that end them and where these came from."""
    windows = fleet.state.windows
    fields = (windows.start, windows.end, windows.source, windows.robot)
    slots = [slice(int(at), int(at + size)) for at, size in zip(windows.offset, windows.size, strict=True)]
    return [list(zip(*(each[row].tolist() for each in fields), strict=True)) for row in slots]


@settings(max_examples=draws(20))
@given(st.integers(0, 999), st.sampled_from(["alike_at_start", "alike_at_end", ""]))
def test_the_windows_hold_just_the_plans_whether_exchanged_whole_or_where_they_differ(seed: int, whole: str) -> None:
    instance = grid_instance(Grid(6, 6, map=10, map_seed=seed), Fleet(14, seed=seed))
    fleet = PlannedFleet(instance)
    with pytest.MonkeyPatch.context() as patch:
        if whole:
            patch.setattr(neighbourhood, whole, lambda *_: 0)
        for robot in range(14):
            add(fleet, robot, 0, Neighbourhood(m=4))
            fresh = PlannedFleet(instance)
            fresh.commit(fleet.plans)
            assert rows(fleet) == rows(fresh)
    assert fleet.plans == carp_reference.plan(instance, Neighbourhood(m=4)).plans


def test_what_does_not_fit_into_the_memory_of_a_round_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compiled code has the numbers in it."""
    monkeypatch.setattr(answers, "PLANS", 3)
    monkeypatch.setattr(answers, "ANSWERS", 4)
    for number in range(60):
        question = arrivals(number, ROOMS)
        assert question.by_fleet()[0] == question.by_reference(), number
