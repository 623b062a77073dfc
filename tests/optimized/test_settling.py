"""Plans that no robot can better by itself, in an order in which none is late, if there is one."""

from collections.abc import Callable

import pytest

import carp_optimized
from carp_experiments.measuring.tiled_plant import tiled_instance
from carp_optimized.improve.repair import repair
from carproof import Carp, Instance, Solution, audit, plan_within
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

WAYS: dict[str, Callable[[Instance], Solution]] = {
    "rounds": lambda instance: plan_within(instance, iterations=20, seed=1),
    "repair": lambda instance: repair(instance, carp_optimized.plan(instance, Carp())),
}


def town(side: int, map: int, robots: int, seed: int) -> Instance:
    fleet = Fleet(robots=robots, seed=seed, after_goal="park")
    return grid_instance(Grid(width=side, height=side, map=map), fleet, Traits(duration=Range(1, 3)))


@pytest.mark.parametrize(
    ("instance", "way"),
    [
        (town(10, 5, 30, 1), "rounds"),
        (town(10, 5, 30, 1), "repair"),
        (town(8, 8, 24, 3), "repair"),
    ],
)
def test_no_robot_could_arrive_earlier_while_all_others_keep_their_plans(instance: Instance, way: str) -> None:
    found = WAYS[way](instance)
    for plan in found.plans:
        others = [each for each in found.plans if each is not plan]
        best = carp_optimized.query(instance, others, plan.robot)
        assert best is not None
        assert best.visits[-1].enter >= plan.visits[-1].enter, plan.robot


@pytest.mark.parametrize(("instance", "way"), [(tiled_instance(28, 2), "rounds"), (town(10, 10, 30, 1), "repair")])
def test_no_plan_is_late_in_the_planning_order_if_there_is_one_in_which_none_is(instance: Instance, way: str) -> None:
    solution = WAYS[way](instance)
    assert audit(instance, solution, find_order=True).holds
    assert audit(instance, solution).holds
