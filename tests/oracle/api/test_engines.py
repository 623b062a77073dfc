"""Sums of shortest paths, and who has a plan beside others: the compiled planner answers as the reference does."""

from hypothesis import given, settings
from tests.profiles import draws

from carp_reference import query
from carp_spec import Carp, Instance, Resource, ResourceGraph, Robot, plan_cost
from carproof.engines import have_plans_beside, plan_showing, sum_of_shortest_paths
from carproof.testing.strategies import instances

LONG = ResourceGraph((Resource("a", 1, 10**30), Resource("b")), (("a", "b"),))


@settings(max_examples=draws(200))
@given(instance=instances())
def test_the_sum_of_shortest_paths_is_that_of_robots_alone(instance: Instance) -> None:
    alone = {robot: query(instance, (), robot) for robot in instance.robot}
    costs = {robot: 0 if plan is None else plan_cost(instance, plan) for robot, plan in alone.items()}
    _, fleet = plan_showing("", None, instance, Carp())
    for known in (None, fleet):
        assert sum_of_shortest_paths(instance, instance.robot, known) == sum(costs.values())
        assert sum_of_shortest_paths(instance, [*instance.robot][:1], known) == sum([*costs.values()][:1])


@settings(max_examples=draws(200))
@given(instance=instances())
def test_robots_with_a_plan_beside_others_are_those_of_the_reference(instance: Instance) -> None:
    solution, fleet = plan_showing("", None, instance, Carp())
    expected = [query(instance, solution.plans, robot) is not None for robot in solution.unplanned]
    for known in (None, fleet):
        assert have_plans_beside(instance, solution.plans, solution.unplanned, 0, known) == expected


def test_numbers_too_large_for_the_compiled_planner_are_added_up_too() -> None:
    instance = Instance(LONG, (Robot("r", "a", "b"), Robot("s", "b", "a")))
    assert sum_of_shortest_paths(instance, instance.robot) == 10**30 + 1
    assert have_plans_beside(instance, (), ["r", "s"], 0) == [True, True]
