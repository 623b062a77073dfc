"""A robot behind the one taken out is asked again where it has to be: see towns.py."""

import pytest
from tests.optimized.towns import TOWNS

import carp_optimized
import carp_reference
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_spec import Neighbourhood, Solution
from carproof.generate import Fleet, Grid, grid_instance

ALONE = Neighbourhood(m=1)


@pytest.mark.parametrize("name", TOWNS)
def test_the_robots_behind_get_the_plans_of_the_reference(name: str) -> None:
    town = TOWNS[name]
    instance = town.instance
    solution = Solution((), (), ())
    fleet = PlannedFleet(instance)
    last = len(instance.robots) - 1
    for robot in range(last + 1):
        now, options = (0, ALONE) if robot < last else (town.now, Neighbourhood(m=town.m, baseline=town.baseline))
        solution = carp_reference.add(instance, solution, robot, now, options)
        add(fleet, robot, now, options)
        assert fleet.plans == solution.plans


def test_a_plan_alone_is_not_taken_over_from_before_a_round_that_left_a_robot_outside_without_a_plan() -> None:
    """The stays freed in that round are forgotten; otherwise 1 of 3,000 fleets like this one has another plan."""
    instance = grid_instance(Grid(5, 4, map=1, map_seed=244), Fleet(9, seed=244))
    planner = Neighbourhood(m=5)
    assert carp_optimized.plan(instance, planner) == carp_reference.plan(instance, planner)


def test_orders_are_drawn_in_a_round_too_in_which_a_member_has_no_plan() -> None:
    """The next round draws the numbers that follow."""
    instance = grid_instance(Grid(5, 4, map=2, map_seed=11), Fleet(8, seed=11))
    planner = Neighbourhood(m=5, sample=9, baseline=False, seed=11)
    assert carp_optimized.plan(instance, planner) == carp_reference.plan(instance, planner)
