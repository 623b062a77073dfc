"""Sums of shortest paths come from the compiled planner, and are those of the reference."""

import pytest
from hypothesis import given, settings
from tests.profiles import draws

from carp_reference import query
from carp_spec import Instance, Resource, ResourceGraph, Robot, plan_cost
from carproof.engines import sum_of_shortest_paths
from carproof.strategies import instances


@settings(max_examples=draws(200))
@given(instance=instances())
def test_the_sum_of_shortest_paths_is_that_of_robots_alone(instance: Instance) -> None:
    alone = {robot: query(instance, (), robot) for robot in instance.robot}
    costs = {robot: 0 if plan is None else plan_cost(instance, plan) for robot, plan in alone.items()}
    assert sum_of_shortest_paths(instance, instance.robot) == sum(costs.values())
    assert sum_of_shortest_paths(instance, [*instance.robot][:1]) == sum([*costs.values()][:1])


def test_numbers_too_large_for_the_compiled_planner_are_added_up_too() -> None:
    graph = ResourceGraph((Resource("a", 1, 10**30), Resource("b")), (("a", "b"),))
    instance = Instance(graph, (Robot("r", "a", "b"), Robot("s", "b", "a")))
    assert sum_of_shortest_paths(instance, instance.robot) == 10**30 + 1


def test_the_reference_is_not_asked_robot_by_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carproof.engines.engine_named", lambda _: pytest.fail("asked"))
    instance = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b"),))
    assert sum_of_shortest_paths(instance, instance.robot) == 1
