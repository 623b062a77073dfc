"""The planner of the experiment on conventions obeys the law where its rules are those of the law."""

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from carp_experiments.paper import space_time
from carp_experiments.paper.conventions import (
    DIVISORS,
    Convention,
    add_robot,
    ints,
    meetings_of,
    one_pass,
    remaining_row,
    world_of,
)
from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.recomputed import plans_of
from carp_optimized import query
from carp_spec import Neighbourhood, violations_of
from carp_spec.permutations import splitmix64

if TYPE_CHECKING:
    from collections.abc import Sequence

CASE = MapCase(remaining_row, 15, 3, 30)
LAWFUL: dict[str, tuple[Convention, dict[str, Any]]] = {
    "carproof": (Convention(), {}),
    "robots park": (Convention(stay=-1), {"after_goal": "park"}),
    "following forbidden": (Convention(following=False), {"following": "forbidden"}),
    "first nodes first": (Convention(ties="shallow"), {}),
}


@pytest.mark.parametrize("name", LAWFUL)
def test_one_robot_after_the_other_arrives_as_early_as_the_compiled_planner_lets_it(name: str) -> None:
    convention, law = LAWFUL[name]
    instance = replace(instance_of(CASE), **law)
    world = world_of(CASE, convention)
    planned, _ = one_pass(world, range(CASE.robots))
    plans = plans_of(world, instance, range(planned))
    assert not list(violations_of(instance, plans))
    for number, plan in enumerate(plans):
        best = query(instance, plans[:number], plan.robot)
        assert best is not None
        assert best.visits[-1].enter == plan.visits[-1].enter
    if planned < CASE.robots:
        assert query(instance, plans, instance.robots[planned].id) is None


@pytest.mark.parametrize("options", [Neighbourhood(4, baseline=False), Neighbourhood(5), Neighbourhood(6, sample=40)])
def test_the_neighbourhood_planner_makes_lawful_plans(options: Neighbourhood) -> None:
    instance = instance_of(CASE)
    world = world_of(CASE, Convention())
    order: Sequence[int] = []
    for robot in range(CASE.robots):
        updated = add_robot(world, Convention(), options, order, robot, splitmix64(robot))
        if updated is None:
            break
        order = updated
        assert not list(violations_of(instance, plans_of(world, instance, order)))
    assert len(order) > 1


def test_robots_that_stay_keep_their_goals_free_of_others() -> None:
    world = world_of(CASE, Convention(stay=5))
    planned, _ = one_pass(world, range(CASE.robots))
    for robot in range(planned):
        arrival = int(world.arrival[robot])
        assert all(world.occupant[arrival : arrival + 6, world.goal[robot]] == robot)


def test_a_robot_that_finds_no_plan_keeps_its_own_and_meets_another() -> None:
    """Planned again in the opposite order, some find no plan; what they keep is in the way of somebody before them."""
    kept_in_all = 0
    for assignment in range(4):
        world = world_of(replace(CASE, map=0, assignment=assignment), Convention())
        planned, _ = one_pass(world, range(CASE.robots))
        before = world._replace(path=world.path.copy(), arrival=world.arrival.copy())
        order = range(planned)[::-1]
        assert meetings_of(world, order) == 0
        space_time.lay(world, ints(order), 0, True)
        after, met, kept = world.arrival.copy(), meetings_of(world, order), 0
        for place, robot in enumerate(order):
            if space_time.lay(world, ints(order[: place + 1]), place) == place:  # none beside those before it
                kept += 1
                assert after[robot] == before.arrival[robot]
                assert np.array_equal(world.path[robot], before.path[robot])
            assert after[robot] in (before.arrival[robot], world.arrival[robot])
            world.arrival[robot] = after[robot]
        assert (met > 0) == (kept > 0)
        kept_in_all += kept
    assert kept_in_all > 0


@pytest.mark.parametrize("divisor", DIVISORS)
def test_the_nearest_robot_is_that_of_the_divisor(divisor: str) -> None:
    world = world_of(CASE, Convention())
    planned, _ = one_pass(world, range(CASE.robots))

    def distance(one: int, other: int) -> Fraction:
        last = int(max(world.arrival[one], world.arrival[other]))
        places = [
            [world.path[each, min(tick, world.arrival[each])] for tick in range(last + 1)] for each in (one, other)
        ]
        total = sum(int(world.apart[at, there]) for at, there in zip(*places, strict=True))
        return Fraction(total, {"ticks": last + 1, "difference": last, "none": 1}[divisor])

    for member in range(planned):
        outside = [each for each in range(planned) if each != member]
        near = space_time.nearest(world, world, ints(outside), ints([member]), False, DIVISORS.index(divisor))
        assert outside[near] == min(outside, key=lambda each: distance(each, member))
