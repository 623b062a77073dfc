"""The formulas of deadlines of robots that are seen: a model just where their plans keep them."""

from collections.abc import Sequence
from itertools import product
from operator import itemgetter

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.verify.bound.examples import HORIZON, left, plans_of
from tests.verify.optimum.models import has_model

from carp_spec import AfterGoal, Instance, Plan, Resource, ResourceGraph, ResourceId, Robot
from carp_spec.documents.bounds import DeadlinesDocument
from carp_verify.bound.cuts import formula_of_deadlines
from carp_verify.optimum.encoding import violated
from carp_verify.optimum.refutation import NotRefutedError
from carproof.testing.strategies import Sizes, instances


def keeps(plan: Plan, deadline: int, seen: int, places: frozenset[ResourceId]) -> bool:
    """Whether the plan keeps the deadline of a robot that is seen, word for word as the document has it."""
    arrival = plan.visits[-1].enter
    at = {visit.resource for visit in plan.visits[:-1] if visit.enter <= seen < left(visit)}
    return (arrival <= deadline and arrival <= seen) or bool(at & places)


@settings(max_examples=draws(400))
@given(
    st.data(),
    instances(Sizes(resources=4, robots=2, capacity=1, duration=2, release=2, pace=1), least_robots=2),
)
def test_no_plans_that_break_no_rule_keep_all_deadlines_whose_formula_has_no_model(
    data: st.DataObject, instance: Instance
) -> None:
    ticks = st.integers(0, HORIZON - 1)
    places = st.frozensets(st.sampled_from([resource.id for resource in instance.graph.resources]))
    sights = st.lists(st.tuples(ticks, ticks, places), min_size=1, max_size=2, unique_by=itemgetter(1))
    drawn = [(robot, sorted(data.draw(sights), key=itemgetter(1))) for robot in instance.robots]
    members = [(robot.id, *sight) for robot, each in drawn for sight in each]
    seen = tuple((tick, tuple(sorted(at, key=str))) for _, _, tick, at in members)
    deadlines = DeadlinesDocument(
        tuple(robot for robot, *_ in members), tuple(tick for _, tick, *_ in members), 0, "", seen
    )
    try:
        formula = formula_of_deadlines(instance, deadlines, 10**6)
    except NotRefutedError:
        return  # a robot has no way
    keeping = [
        [plan for plan in plans_of(instance, robot) if all(keeps(plan, *sight) for sight in each)]
        for robot, each in drawn
    ]
    is_possible = any(not violated(instance, plans) for plans in product(*keeping))
    is_open = has_model(formula)
    assert is_open or not is_possible
    event("possible" if is_possible else "refuted" if not is_open else "not refuted")


def lane_of(slow: str, *robots: Robot, after_goal: AfterGoal = "vanish") -> Instance:
    """Three cells in a row; one takes two ticks."""
    cells = tuple(Resource(cell, duration=1 + (cell == slow)) for cell in "abc")
    return Instance(ResourceGraph(cells, (("a", "b"), ("b", "c"))), robots, after_goal)


def may_keep(instance: Instance, members: Sequence[tuple[int, int, str]]) -> bool:
    """Whether the formula of the robots, each with its deadline, the tick at which it is seen and places, has one.

    With more deadlines than robots, all robots are seen again.
    """
    seen = tuple((tick, tuple(places)) for _, tick, places in members)
    names = tuple(robot.id for robot in instance.robots) * (len(members) // len(instance.robots))
    deadlines = DeadlinesDocument(names, tuple(deadline for deadline, _, _ in members), 0, "", seen)
    return has_model(formula_of_deadlines(instance, deadlines, 10**6))


ONCE = [[sight] for sight in product(range(5), range(5), ("", "a", "b", "c", "ab", "ac", "bc", "abc"))]
TWICE = [
    [(deadline, first, places), (2, first + later, others)]
    for deadline, first, later in product((0, 3, 5), range(3), (1, 2))
    for places, others in product(("", "a", "b", "ac"), ("", "b", "c", "ab"))
]


@pytest.mark.parametrize("after_goal", ["vanish", "park"])
@pytest.mark.parametrize(("goal", "slow"), [*product("abc", " bc")])
@pytest.mark.parametrize("sights", [ONCE, TWICE], ids=["once", "twice"])
def test_the_formula_of_a_robot_that_is_seen_has_a_model_just_where_one_of_its_plans_keeps_all_deadlines(
    sights: Sequence[Sequence[tuple[int, int, str]]], goal: str, slow: str, after_goal: AfterGoal
) -> None:
    instance = lane_of(slow, Robot("r", "a", goal, 1), after_goal=after_goal)
    plans = [*plans_of(instance, instance.robots[0])]
    for members in sights:
        is_kept = any(all(keeps(plan, due, seen, frozenset(at)) for due, seen, at in members) for plan in plans)
        assert may_keep(instance, members) == is_kept
