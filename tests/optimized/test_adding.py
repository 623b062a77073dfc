"""Shortcuts of adding a robot return the same as without them, and as the law: see test_uncompiled.py."""

import os
from fractions import Fraction

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.optimized.arrivals import CROWDED, ROOMS, arrivals
from tests.profiles import draws

from carp_optimized import distances, neighbourhood
from carp_optimized.arrays import NEVER, NONE, Records, Work
from carp_optimized.distances import Mean, distance_below, nearest
from carp_optimized.encoding import no_work
from carp_optimized.fleet import PlannedFleet
from carp_optimized.search import find_plan, find_plan_alone
from carp_spec import neighbourhood_rules
from carproof.generate import Fleet, Grid, Range, grid_instance
from carproof.strategies import FleetUnderWay, Sizes, fleets_under_way

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")

SIZES = Sizes(resources=6, robots=5)


@st.composite
def planned_fleets(draw: st.DrawFn) -> PlannedFleet:
    """Fleets planned by CARP on grids so small that many distances are alike."""
    grid = Grid(5, 5, map=draw(st.sampled_from([0, 5, 20])))
    robots = Fleet(draw(st.integers(3, 9)), draw(st.integers(0, 999)), release=Range(0, draw(st.sampled_from([0, 9]))))
    fleet = PlannedFleet(grid_instance(grid, robots))
    fleet.carp(range(robots.robots))
    assume(len(fleet.order) > 1)
    return fleet


def exact(mean: Mean) -> Fraction:
    return mean.whole + Fraction(mean.rest, mean.ticks)


def by_law(fleet: PlannedFleet, one: int, other: int) -> Fraction:
    """The distance of two plans by the law."""
    plans = fleet.plans
    return neighbourhood_rules.distance(fleet.instance, plans[one], plans[other])


@settings(max_examples=draws(100))
@given(planned_fleets(), st.integers(0, 3 << 16))
def test_a_distance_is_that_of_the_law_or_larger_than_the_best_as_it_should_be(fleet: PlannedFleet, best: int) -> None:
    records = fleet._records[fleet._order]
    for other in range(1, len(records)):
        found = distance_below(fleet._state, int(records[0]), int(records[other]), Mean(best, 1, 2))
        expected = by_law(fleet, 0, other)
        assert (exact(found) == expected) if expected <= best + Fraction(1, 2) else (exact(found) > best)


def split(fleet: PlannedFleet, members: int) -> Work:
    """The last robots are members, and the others outside."""
    work = no_work(len(fleet._records), members, 0)
    work.trajectories[:] = fleet._records
    outside = len(fleet.order) - members
    work.outside[:outside] = fleet._order[:outside]
    work.members[:] = fleet._order[outside:]
    work.ended[:] = 0
    return work


@settings(max_examples=draws(100))
@given(planned_fleets(), st.data())
def test_the_nearest_robot_is_that_of_the_law(fleet: PlannedFleet, data: st.DataObject) -> None:
    """Whether or not sums bound distances from below."""
    robots = len(fleet.order)
    members = data.draw(st.integers(1, min(3, robots - 1)))
    outside = robots - members
    work = split(fleet, members)
    rows = [[by_law(fleet, robot, member) for member in range(outside, robots)] for robot in range(outside)]
    expected = neighbourhood_rules.nearest(rows)
    assert nearest(fleet._state, work, outside, members) == expected
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distances, "least_sum", lambda _x, _y, _ticks: 0)
        patch.setattr(distances, "is_apart", lambda *_: False)
        assert nearest(fleet._state, work, outside, members) == expected
    work.ended[work.outside[expected]] = 1
    if outside == 1:
        assert nearest(fleet._state, work, outside, members) == NONE
    else:
        others = [each for each in range(outside) if each != expected]
        left = neighbourhood_rules.nearest([rows[each] for each in others])
        assert nearest(fleet._state, work, outside, members) == others[left]


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


@settings(max_examples=draws(200))
@given(fleets_under_way(SIZES))
def test_a_plan_where_nothing_is_reserved_is_made_as_by_a_search(under_way: FleetUnderWay) -> None:
    fleet = PlannedFleet(under_way.instance)
    robot = fleet.index(under_way.robot)
    state = fleet._empty.fields
    one = find_plan_alone(state, robot, under_way.now)
    other = find_plan(state, robot, NONE, under_way.now, NEVER)
    assert (one == NONE) == (other == NONE)
    if one != NONE:
        assert what_was_read(state.records, one) == what_was_read(state.records, other)
    assert fleet.queries.asked == 2


def test_plans_that_are_exchanged_whole_at_the_end_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not only where they differ."""
    fleets = [arrivals(number, mix) for number in range(draws(20)) for mix in (CROWDED, ROOMS)]
    found = [fleet.by_fleet() for fleet in fleets]
    for name in ("alike_at_start", "alike_at_end"):
        monkeypatch.setattr(neighbourhood, name, lambda *_: 0)
    assert [fleet.by_fleet() for fleet in fleets] == found
