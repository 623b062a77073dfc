"""A query does the same without the plans that are no reasons for its answer: see test_uncompiled.py."""

import os
from collections.abc import Sequence

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from tests.optimized.neighbourhood.test_replanning import fleet_of
from tests.profiles import draws

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.answers import number_plan, start_answers
from carp_optimized.queries.relevant_plans import reasons
from carp_optimized.queries.search import find_plan_by
from carp_optimized.state.arrays import ALONE, NEVER, NONE, PLANS
from carp_optimized.state.room import no_answers
from carproof import Following, Instance, Plan, Resource, ResourceGraph, Robot, Visit
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")

SIZES = Sizes(resources=6, robots=5, groups=2)


def asked(fleet: PlannedFleet, robot: int, before: Plan | None, now: int, latest: int) -> tuple[int, list[list[int]]]:
    """The record found by then, and what the query has expanded."""
    state = fleet.state
    state.search.expansions[0] = 0
    record = find_plan_by(state, robot, NONE if before is None else fleet.record(before), now, NEVER, latest)
    count = int(state.search.expansions[0])
    return record, [each[:count].tolist() for each in (state.search.expanded, state.search.ready, state.search.popped)]


def reasons_among(fleet: PlannedFleet, robot: int, record: int, latest: int, plans: Sequence[Plan]) -> list[Plan]:
    """The reasons for the answer that the last query of the fleet found."""
    answers = no_answers(len(plans), fleet.state.graph.duration.size)
    start_answers(answers, len(plans))
    for member, plan in enumerate(plans):
        held = int(fleet.held[fleet.index(plan.robot)])
        assert number_plan(fleet.state, answers, member, held) == member
    all_plans = (1 << len(plans)) - 1 | 1 << PLANS
    found = reasons(fleet.state, answers, robot, record, latest, all_plans)
    assert found >> PLANS == 1
    return [plan for member, plan in enumerate(plans) if found >> member & 1 == 1]


@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.filter_too_much])
@given(fleets_under_way(SIZES), st.data())
def test_a_query_does_the_same_without_plans_that_are_no_reasons(under_way: FleetUnderWay, data: st.DataObject) -> None:
    instance, plans = under_way.instance, under_way.solution.plans
    name = data.draw(st.sampled_from([under_way.robot, *under_way.solution.order]))
    followed = {plan.robot: plan for plan in plans}.get(name)
    others = [plan for plan in plans if plan.robot != name]
    assume(others)
    fleet = fleet_of(instance, others)
    robot = fleet.index(name)
    before = NONE if followed is None else fleet.record(followed)
    best = passes.find_one(fleet.native, robot, before, under_way.now, ALONE)
    assume(best != NONE)
    latest = data.draw(st.sampled_from([NEVER, int(fleet.state.records.arrival[best]) - 1]))
    record, expanded = asked(fleet, robot, followed, under_way.now, latest)
    assume(expanded[0])
    given_plans = data.draw(st.lists(st.sampled_from(others), min_size=1, unique_by=lambda plan: plan.robot))
    kept = reasons_among(fleet, robot, record, latest, given_plans)
    again = fleet_of(instance, [plan for plan in others if plan in kept or plan not in given_plans])
    repeated, expanded_again = asked(again, robot, followed, under_way.now, latest)
    assert expanded_again == expanded
    assert (record == NONE) == (repeated == NONE)
    assert record == NONE or again.plan_of(repeated) == fleet.plan_of(record)


@pytest.mark.parametrize(("following", "waits"), [("allowed", 0), ("forbidden", 1)])
def test_a_plan_that_leaves_as_the_robot_comes_is_a_reason_where_following_is_forbidden(
    following: Following, waits: int
) -> None:
    graph = ResourceGraph(tuple(Resource(cell) for cell in "abcx"), (("a", "b"), ("b", "c"), ("c", "x")))
    instance = Instance(graph, (Robot("r", "a", "c"), Robot("ahead", "c", "x")), following=following)
    plan = Plan("ahead", (Visit("c", 0, 2), Visit("x", 2, 3)))
    fleet = fleet_of(instance, [plan])
    record, _ = asked(fleet, 0, None, 0, NEVER)
    assert fleet.plan_of(record).visits[-1].enter == 2 + waits
    assert reasons_among(fleet, 0, record, NEVER, [plan]) == [plan] * waits


def test_a_plan_that_comes_as_the_robot_leaves_is_a_reason_where_following_is_forbidden() -> None:
    graph = ResourceGraph(tuple(Resource(cell) for cell in "abcxy"), (("a", "b"), ("b", "c"), ("b", "x"), ("b", "y")))
    instance = Instance(graph, (Robot("r", "a", "c"), Robot("behind", "x", "y")), following="forbidden")
    plan = Plan("behind", (Visit("x", 0, 2), Visit("b", 2, 3), Visit("y", 3, 4)))
    fleet = fleet_of(instance, [plan])
    for latest in (NEVER, 2):
        record, _ = asked(fleet, 0, None, 0, latest)
        assert (record == NONE) == (latest < NEVER)
        assert reasons_among(fleet, 0, record, latest, [plan]) == [plan]
