"""When a query need not be repeated: at least where the lemma says, and then it would find the same plan.

The functions are called one by one, so these tests run uncompiled: see test_uncompiled.py.
"""

import os
from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.replanning import could_use_freed, forget_freed, note_freed
from carp_optimized.state.arrays import NEVER, NONE, NOTED, UNKNOWN
from carp_reference.problem import ticks_to_goal
from carp_spec import Instance, Plan, ResourceId, RobotId
from carp_verify.lemmas.freed_stays_come_too_late import least_f
from carp_verify.lemmas.smt import integers, value_of
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")

SIZES = Sizes(resources=6, robots=5, groups=2)
Hulls = dict[ResourceId, tuple[int, int]]


@cache
def least(ready: int, earliest: int, duration: int, h: int) -> int:
    """The bound of the lemma."""
    names = "ready earliest duration h"
    values = dict(zip(names.split(), (ready, earliest, duration, h), strict=True))
    return int(value_of(least_f(*integers(names)), dict(values)))


def hulls(instance: Instance, plan: Plan) -> Hulls:
    """From the first to the last tick that its stays take, in each resource and those of its groups."""
    freed: Hulls = {}
    for visit in plan.visits:
        groups = [group.resources for group in instance.graph.groups if visit.resource in group.resources]
        for resource in {visit.resource}.union(*groups):
            earliest, latest = freed.get(resource, (visit.enter - instance.gap, 0))
            leave = NEVER if visit.leave is None else visit.leave + instance.gap
            freed[resource] = (earliest, max(latest, leave))
    return freed


def may_differ(fleet: PlannedFleet, robot: RobotId, record: int, freed: Hulls) -> bool:
    """The claim of the lemma about a query, by the resources that it has expanded.

    Besides, a stay freed in the goal may change from when on the robot can park there.
    """
    instance, records = fleet.instance, fleet.state.records
    first, count = int(records.expansions_at[record]), int(records.expansions[record])
    if count == UNKNOWN:
        return True
    resources = [instance.graph.resources[k].id for k in records.expanded[first : first + count].tolist()]
    expanded = list(zip(resources, records.ready[first : first + count].tolist(), strict=True))
    to_goal = ticks_to_goal(instance, instance.robot[robot])[0]
    arrival = fleet.plan_of(record).visits[-1].enter

    def in_time(ready: int, target: ResourceId) -> bool:
        return least(ready, freed[target][0], instance.duration(robot, target), to_goal[target]) <= arrival

    start = expanded[0][0]
    parks = instance.after_goal == "park"
    return (
        (parks and instance.robot[robot].goal in freed)
        or (start in freed and in_time(-NEVER, start))
        or any(
            in_time(ready, target)
            for resource, ready in expanded
            for target in instance.graph.successors[resource]
            if target in freed and target in to_goal and freed[target][1] > ready
        )
    )


def fleet_of(instance: Instance, plans: Sequence[Plan]) -> PlannedFleet:
    fleet = PlannedFleet(instance)
    fleet.commit(plans)
    return fleet


@settings(max_examples=draws(100))
@given(fleets_under_way(SIZES), st.data())
def test_a_query_is_repeated_only_where_the_lemma_says_and_else_finds_the_same(
    under_way: FleetUnderWay, data: st.DataObject
) -> None:
    instance, plans = under_way.instance, under_way.solution.plans
    robot = data.draw(st.sampled_from([under_way.robot, *under_way.solution.order]))
    followed = {plan.robot: plan for plan in plans}.get(robot)
    others = tuple(plan for plan in plans if plan.robot != robot)
    assume(others)
    freed = data.draw(st.lists(st.sampled_from(others), min_size=1, unique=True))
    fleet = fleet_of(instance, others)
    state = fleet.state
    before = NONE if followed is None else fleet.record(followed)
    record = passes.find_one(fleet.native, fleet.index(robot), before, under_way.now, NOTED)
    assume(record != NONE)
    forget_freed(state.freed)
    whole: Hulls = {}
    for plan in freed:
        withdrawn = int(fleet.held[fleet.index(plan.robot)])
        passes.withdraw_all(fleet.native, np.array([withdrawn], np.int32))
        note_freed(state, withdrawn, 0, 0)
        for resource, (earliest, latest) in hulls(instance, plan).items():
            known = whole.get(resource, (earliest, latest))
            whole[resource] = (min(earliest, known[0]), max(latest, known[1]))
    is_repeated = could_use_freed(state, record, NEVER)
    assert may_differ(fleet, robot, record, whole) or not is_repeated
    if not is_repeated:
        again = fleet_of(instance, tuple(plan for plan in others if plan not in freed))
        assert again.find(again.index(robot), followed, under_way.now) == fleet.plan_of(record)
