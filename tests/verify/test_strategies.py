"""The strategies draw what they promise, and enough of it."""

from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot, has_ended, judge
from carp_spec.instance_rules import instance_faults
from carp_spec.joint_rules import JOINT_RULES, SOLUTION_RULES
from carp_spec.plan_rules import PLAN_RULES
from carproof.testing.mutations import MUTATIONS, BrokenSolution, Mutation
from carproof.testing.strategies import (
    FleetUnderWay,
    PlannedInstance,
    Sizes,
    broken_solutions,
    fleets_under_way,
    instances,
    planned_instances,
    resource_graphs,
    solutions,
)

SHRINK = settings(max_examples=20_000, derandomize=True, database=None, suppress_health_check=list(HealthCheck))
SEARCH = settings(SHRINK, phases=[Phase.generate])
WITH_ALL = Sizes(groups=2, stops=2, service=3)


@given(instances())
def test_instances_have_no_faults(instance: Instance) -> None:
    assert instance_faults(instance) == ()


@given(planned_instances() | planned_instances(WITH_ALL))
def test_planned_instances_break_no_rule(planned: PlannedInstance) -> None:
    assert judge(planned.instance, planned.solution).violations == ()


@given(broken_solutions() | broken_solutions(WITH_ALL))
def test_broken_solutions_break_the_rules_they_name(broken: BrokenSolution) -> None:
    reported = {violation.rule for violation in judge(broken.instance, broken.solution).violations}
    assert broken.rules
    assert reported >= set(broken.rules)


@given(fleets_under_way() | fleets_under_way(WITH_ALL))
def test_fleets_under_way_are_sound_and_lack_the_robot_to_add(fleet: FleetUnderWay) -> None:
    assert judge(fleet.instance, fleet.solution).violations == ()
    assert fleet.robot in fleet.solution.unplanned
    assert fleet.now >= 0


@given(resource_graphs(Sizes(resources=2, capacity=1, duration=1)))
def test_sizes_bound_what_is_drawn(graph: ResourceGraph) -> None:
    assert len(graph.resources) <= 2
    assert all((resource.capacity, resource.duration) == (1, 1) for resource in graph.resources)


RULE_IDS = [
    *(rule.id for rule in SOLUTION_RULES),
    *(rule.id for rule in PLAN_RULES),
    *(rule.id for rule in JOINT_RULES if rule.id != "joint/following"),
]
"""No mutation breaks `joint/following`: the instances drawn allow it."""


@pytest.mark.parametrize("rule", RULE_IDS)
def test_every_rule_of_a_solution_is_broken_by_some_mutation(rule: str) -> None:
    find(broken_solutions(WITH_ALL), lambda broken: rule in broken.rules, settings=SEARCH)


@pytest.mark.parametrize("mutation", MUTATIONS)
def test_every_mutation_finds_a_place(mutation: Mutation) -> None:
    find(planned_instances(WITH_ALL), lambda each: any(mutation(each.instance, each.solution)), settings=SEARCH)


def _shares_starts(instance: Instance) -> bool:
    starts = [robot.start for robot in instance.robots]
    return len(starts) > len(set(starts))


@pytest.mark.parametrize(
    "wanted",
    [
        lambda each: each.graph.directed and len(each.graph.edges) > 1,
        lambda each: len({type(resource.id) for resource in each.graph.resources}) > 1,
        lambda each: len({resource.x is None for resource in each.graph.resources}) > 1,
        lambda each: any(robot.start == robot.goal for robot in each.robots),
        lambda each: any(not each.graph.successors[robot.start] and robot.goal != robot.start for robot in each.robots),
        _shares_starts,
        lambda each: each.after_goal == "park" and len({robot.pace for robot in each.robots}) > 1,
    ],
)
def test_instances_of_every_kind_are_drawn(wanted: Callable[[Instance], bool]) -> None:
    find(instances(), wanted, settings=SEARCH)


def test_fleets_are_drawn_with_ended_and_unended_plans_and_unreleased_robots() -> None:
    def all_three(fleet: FleetUnderWay) -> bool:
        ended = [has_ended(plan, fleet.now) for plan in fleet.solution.plans]
        unreleased = any(robot.release > fleet.now for robot in fleet.instance.robots)
        return True in ended and False in ended and unreleased

    find(fleets_under_way(), all_three, settings=SEARCH)


def test_a_failure_shrinks_to_the_smallest_instance() -> None:
    shrunk = find(planned_instances(), lambda planned: bool(planned.solution.plans), settings=SHRINK)
    graph = ResourceGraph((Resource(0),), ())
    assert shrunk.instance == Instance(graph, (Robot(0, 0, 0),))


@pytest.mark.parametrize("after_goal", ["vanish", "park"])
def test_another_project_tests_its_own_map_with_them(after_goal: AfterGoal) -> None:
    """How somebody else's test uses the strategies: their graph and robots, our plans."""
    aisle = ResourceGraph(tuple(Resource(x, x=x, y=0) for x in range(4)), ((0, 1), (1, 2), (2, 3)))
    fleet = Instance(aisle, (Robot("picker", 0, 3), Robot("sweeper", 3, 0, release=5)), after_goal)

    @given(st.data())
    @settings(max_examples=draws(50))
    def arrivals_are_no_earlier_than_the_way_is_long(data: st.DataObject) -> None:
        solution = data.draw(solutions(fleet, Sizes(wait=3)))
        for plan in solution.plans:
            assert plan.visits[-1].enter >= fleet.robot[plan.robot].release + 3

    arrivals_are_no_earlier_than_the_way_is_long()
