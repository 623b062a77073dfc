"""Robots that hold their starts until they are planned: nobody in a bay is walled in."""

import pytest
from tests.profiles import draws

import carp_optimized
from carp_experiments.measuring.tiled_plant import tiled_instance
from carp_optimized.improve.holding import plan_holding_starts
from carp_spec import Carp, Solution, judge
from carp_spec.permutations import splitmix64
from carproof import plan_within
from carproof.testing.random_instances import Draw, Mix, draw_instance

MIX = Mix(robots=(3, 4, 5), groups=(0, 1, 2), followings=("allowed", "allowed", "forbidden"), stops=2, services=(0, 2))


@pytest.mark.parametrize(("robots", "tiles"), [(28, 2), (60, 3)])
def test_all_robots_of_a_plant_get_plans_where_carp_walls_some_in(robots: int, tiles: int) -> None:
    instance = tiled_instance(robots, tiles)
    assert carp_optimized.plan(instance, Carp()).unplanned
    solution = plan_within(instance, iterations=0)
    assert judge(instance, solution).valid
    assert not solution.unplanned


def test_plans_are_lawful_whatever_robots_share_at_their_starts() -> None:
    planned: list[int] = []
    for number in range(draws(5000)):
        instance = draw_instance(Draw(splitmix64(number)), MIX)
        solution = Solution.of(
            instance, plan_holding_starts(instance, range(len(instance.robots)), lambda _: True).plans
        )
        assert judge(instance, solution).valid
        planned.append(len(solution.plans))
    assert sum(planned) > len(planned)


def test_a_pass_that_is_broken_off_leaves_no_robot_at_its_start() -> None:
    instance = tiled_instance(20, 2)
    visits: list[int] = []

    def goes_on(made: int) -> bool:
        visits.append(made)
        return len(visits) <= 5

    solution = Solution.of(instance, plan_holding_starts(instance, range(20), goes_on).plans)
    assert judge(instance, solution).valid
    assert len(solution.plans) <= 5
