"""The strategies draw what they promise, and enough of it."""

from collections.abc import Callable

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings

import carp_reference
from carp_spec import Carp, Instance, Resource, ResourceGraph, Robot, judge
from carp_spec.joint_rules import JOINT_RULES, SOLUTION_RULES
from carp_spec.permutations import splitmix64
from carp_spec.plan_rules import PLAN_RULES
from carproof.testing.mutations import MUTATIONS, BrokenSolution, Mutation
from carproof.testing.random_instances import Draw, Mix, draw_instance
from carproof.testing.strategies import (
    FleetUnderWay,
    Sizes,
    broken_solutions,
    fleets_under_way,
    instances,
    planned_instances,
)

SHRINK = settings(max_examples=20_000, derandomize=True, database=None, suppress_health_check=list(HealthCheck))
SEARCH = settings(SHRINK, phases=[Phase.generate])
WITH_ALL = Sizes(groups=2, stops=2, service=3)
MIX = Mix(groups=(0, 1, 2), stops=3, services=(0, 3))


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


def test_every_mutation_finds_a_place_and_every_rule_of_a_solution_is_broken_by_one() -> None:
    """But `joint/following`: the instances drawn allow it."""
    placed: set[Mutation] = set()
    broken: set[str] = set()
    for number in range(200):
        instance = draw_instance(Draw(splitmix64(number)), MIX)
        solution = carp_reference.plan(instance, Carp())
        mutants = [(mutation, each) for mutation in MUTATIONS for each in mutation(instance, solution)]
        placed.update(mutation for mutation, _ in mutants)
        broken.update(*(each.rules for _, each in mutants))
    assert placed == set(MUTATIONS)
    rules = {rule.id for rule in SOLUTION_RULES} | {rule.id for rule in PLAN_RULES} | {rule.id for rule in JOINT_RULES}
    assert broken == rules - {"joint/following"}


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


def test_a_failure_shrinks_to_the_smallest_instance() -> None:
    shrunk = find(planned_instances(), lambda planned: bool(planned.solution.plans), settings=SHRINK)
    graph = ResourceGraph((Resource(0),), ())
    assert shrunk.instance == Instance(graph, (Robot(0, 0, 0),))
