"""The optimised planner answers every enumerated small query like the reference, visit for visit."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, product

import pytest
from tests.enumeration import ASKED, PATTERNS, Pattern, SmallCase, small_cases
from tests.profiles import rest_in

from carp_optimized.fleet import PlannedFleet
from carp_reference.problem import Problem, ticks_to_goal
from carp_reference.query import find_plan
from carp_spec import Instance, Plan, ResourceGraph, ResourceId, Robot, RobotId, Stop

SMALL_CASES_OF_A_PATTERN = 52_198
RICHEST = 3


def fleet_of_all(instance: Instance) -> PlannedFleet:
    """A fleet with, for each robot of the instance, one on every way; ids are (id, start, goal)."""
    nodes = [resource.id for resource in instance.graph.resources]
    everyone = (
        replace(robot, id=f"{robot.id} {start} {goal}", start=start, stops=(Stop(goal),))
        for robot in instance.robots
        for start, goal in product(nodes, repeat=2)
    )
    return PlannedFleet(Instance(instance.graph, tuple(everyone), instance.after_goal))


def name(robot: Robot) -> RobotId:
    return f"{robot.id} {robot.start} {robot.goal}"


def answers(pattern: Pattern) -> Iterator[tuple[SmallCase, Plan | None]]:
    """Every small query, and the optimised planner's answer."""
    for _, alike in groupby(small_cases(pattern), key=lambda case: (id(case.instance.graph), case.instance.after_goal)):
        fleet: PlannedFleet | None = None
        committed: tuple[Plan, ...] | None = None
        for case in alike:
            fleet = fleet or fleet_of_all(case.instance)
            if case.committed is not committed:
                committed = case.committed
                fleet.clear()
                fleet.commit([replace(plan, robot=name(case.instance.robot[plan.robot])) for plan in committed])
            robot = case.instance.robot[ASKED]
            plan = fleet.find(fleet.index(name(robot)), None, 0)
            yield case, plan and replace(plan, robot=ASKED)


@pytest.mark.ci
@pytest.mark.parametrize("pattern", rest_in("nightly", PATTERNS, RICHEST), ids=str)
def test_every_small_query_has_the_same_answer(pattern: Pattern) -> None:
    asked = 0
    graph: ResourceGraph | None = None
    to_goal: dict[ResourceId, Sequence[Mapping[ResourceId, int]]] = {}
    for case, plan in answers(pattern):
        asked += 1
        robot = case.instance.robot[ASKED]
        if case.instance.graph is not graph:
            graph, to_goal = case.instance.graph, {}
        if robot.goal not in to_goal:
            to_goal[robot.goal] = ticks_to_goal(case.instance, robot)
        problem = Problem(case.instance, {ASKED: to_goal[robot.goal]}, 0)
        assert plan == find_plan(problem, case.committed, ASKED), case
    assert asked == SMALL_CASES_OF_A_PATTERN
