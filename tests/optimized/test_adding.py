"""Shortcuts of adding a robot return the same as without them, and as the law: see test_uncompiled.py."""

import os
from fractions import Fraction

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.profiles import draws

import carp_reference
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood import adding as neighbourhood
from carp_optimized.neighbourhood import distances
from carp_optimized.neighbourhood.adding import plan_alone
from carp_optimized.neighbourhood.answers import learn, start_answers
from carp_optimized.neighbourhood.distances import (
    Mean,
    distance_below,
    follow,
    least_sum,
    likely_nearest,
    nearest,
    term,
)
from carp_optimized.neighbourhood.order_search import spare_for
from carp_optimized.passes import withdraw_all
from carp_optimized.queries.guides import guide_slot, toll_of
from carp_optimized.queries.search import find_plan, find_plan_alone
from carp_optimized.state import encoding
from carp_optimized.state.arrays import LATE, NEVER, NO_LIMIT, NONE, Records, Work
from carp_optimized.state.encoding import no_answers, no_work
from carp_optimized.state.records import cost_of
from carp_spec import Instance, Neighbourhood, Resource, ResourceGraph, Robot, neighbourhood_rules
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

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


@settings(max_examples=draws(40))
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
    for robot in fleet._order:
        follow(fleet._state, work, int(robot), int(fleet._records[robot]))
    outside = len(fleet.order) - members
    work.outside[:outside] = fleet._order[:outside]
    work.members[:] = fleet._order[outside:]
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
    assert nearest(fleet._state, work, outside, members) == expected
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distances, "least_sum", lambda _x, _y, _ticks: 0)
        patch.setattr(distances, "are_apart", lambda *_: False)
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


@settings(max_examples=draws(60))
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


@pytest.mark.parametrize("more", [0, 1])
def test_members_are_planned_alone_as_long_as_they_cost_less_than_the_limit(more: int) -> None:
    """No plan is found that makes them cost as much, though their shortest paths leave room for a query."""
    late = 0
    for seed in range(40):
        fleet = PlannedFleet(grid_instance(Grid(5, 5, map=5), Fleet(9, seed)))
        fleet.carp(range(9))
        members = 2
        work = split(fleet, members)
        withdraw_all(fleet._native, work.members)
        work.before[:] = NONE
        if not plan_alone(fleet._state, work, members, NO_LIMIT, 0, False):
            continue
        cost = sum(cost_of(fleet._state, int(record)) for record in work.alone)
        late += cost > sum(fleet.ticks_to_goal(int(robot)) for robot in work.members)
        work.alone[:] = NONE
        assert plan_alone(fleet._state, work, members, cost + more, 0, False) == (more > 0)
        assert (work.alone != NONE).all() if more > 0 else (work.alone == NONE).all()
    assert late > 2


def rows(fleet: PlannedFleet) -> list[list[tuple[int, ...]]]:
    """The windows of each resource, with the robots that end them and where these came from."""
    windows = fleet._state.windows
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
            fleet.add(robot, 0, Neighbourhood(m=4))
            fresh = PlannedFleet(instance)
            fresh.commit(fleet.plans)
            assert rows(fleet) == rows(fresh)
    assert fleet.plans == carp_reference.plan(instance, Neighbourhood(m=4)).plans


def test_of_two_robots_equally_near_the_earlier_is_taken_though_the_other_is_the_likelier() -> None:
    """Both are 5 away, at (3, 4) and at (5, 0)."""
    places = (Resource("a", x=3, y=4), Resource("b", x=5, y=0), Resource("c", x=0, y=0))
    robots = tuple(Robot(each.id, each.id, each.id) for each in places)
    fleet = PlannedFleet(Instance(ResourceGraph(places, ()), robots))
    fleet.carp(range(3))
    work = split(fleet, 1)
    assert likely_nearest(fleet._state, work, 2, 1) == 1
    assert nearest(fleet._state, work, 2, 1) == 0


@settings(max_examples=draws(200))
@given(st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=1, max_size=8))
def test_the_least_sum_is_no_larger_than_the_sum_of_the_terms(differences: list[tuple[int, int]]) -> None:
    x, y = (sum(each) for each in zip(*differences, strict=True))
    assert least_sum(x, y, len(differences)) <= sum(term(*each) for each in differences)


def test_a_plan_must_cost_less_than_what_is_known_of_the_members_behind_leaves() -> None:
    """In the order 2, 0, 1: alone each costs 10; beside plan 5, 0 costs 12 and 1 costs 13; beside 6 too, 1 costs 17."""
    work = no_work(3, 3, 0)
    work.order[:], work.least[:], work.given[:] = (2, 0, 1), 10, (1 << 5, 1 << 5 | 1 << 6, 0, 0)
    answers = no_answers(3, 1)
    start_answers(answers, 3)
    known = ((0, 1 << 5, 12), (1, 1 << 5, 13), (1, 1 << 5 | 1 << 6, 17), (2, 0, 19))
    for member, beside, least in (*((member, 0, 10) for member in range(3)), *known):
        learn(answers, member, beside, LATE, NONE, least)
    assert [spare_for(work, answers, place, 3, 100, 0) for place in range(3)] == [95, 93, 100]
    assert spare_for(work, answers, 0, 3, 100, 98) == 98


@pytest.mark.parametrize("ranked", [False, True])
@pytest.mark.parametrize("durations", [Range(1, 1), Range(1, 3)], ids=["levels", "durations"])
def test_tolls_are_in_the_order_of_the_ticks_to_the_goal_and_then_of_the_indices(
    monkeypatch: pytest.MonkeyPatch, durations: Range, ranked: bool
) -> None:
    if ranked:
        monkeypatch.setattr(encoding, "scale_of_tolls", lambda *_: 0)
    state = PlannedFleet(grid_instance(Grid(5, 5, 10), Fleet(1), Traits(duration=durations)))._state
    slot = guide_slot(state, 0, 0)
    ticks = [int(each) for each in state.guides.ticks[slot]]
    tolls = [toll_of(state, slot, resource) for resource in range(len(ticks))]
    able = [resource for resource, each in enumerate(ticks) if each >= 0]
    assert sorted(able, key=tolls.__getitem__) == sorted(able, key=lambda resource: (ticks[resource], resource))
    assert len({tolls[resource] for resource in able}) == len(able) > 9
    assert (state.guides.rank.size > 0) == ranked


def test_a_plan_where_nothing_is_reserved_passes_by_places_that_do_not_lead_to_the_goal() -> None:
    cells = tuple(Resource(cell) for cell in "abcd")
    edges = (("a", "b"), ("a", "d"), ("b", "c"))
    fleet = PlannedFleet(Instance(ResourceGraph(cells, edges, directed=True), (Robot("r", "a", "c"),)))
    state = fleet._empty.fields
    one, other = find_plan_alone(state, 0, 0), find_plan(state, 0, NONE, 0, NEVER)
    assert what_was_read(state.records, one) == what_was_read(state.records, other)
