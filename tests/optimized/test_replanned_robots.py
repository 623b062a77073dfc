"""A robot behind the one taken out is asked again where it has to be: see towns.py."""

import pytest
from tests.optimized.towns import TOWNS

import carp_reference
from carp_optimized.fleet import Fleet
from carp_spec import Neighbourhood, Solution

ALONE = Neighbourhood(m=1)


@pytest.mark.parametrize("name", TOWNS)
def test_the_robots_behind_get_the_plans_of_the_reference(name: str) -> None:
    town = TOWNS[name]
    instance = town.instance
    solution = Solution((), (), ())
    fleet = Fleet(instance)
    last = len(instance.robots) - 1
    for robot in range(last + 1):
        now, options = (0, ALONE) if robot < last else (town.now, Neighbourhood(m=town.m, baseline=False))
        solution = carp_reference.add(instance, solution, robot, now, options)
        fleet.add(robot, now, options)
        assert fleet.plans == solution.plans
