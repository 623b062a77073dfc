"""Plans within a time, for instances of every kind."""

from itertools import count
from time import process_time

import pytest
from hypothesis import given

from carp_spec import AfterGoal, Instance, ResourceGraph, Solution, judge
from carproof import plan_within
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.generate.options import Orders
from carproof.testing.strategies import instances


@given(instances())
def test_plans_break_no_rule_and_are_the_same_again(instance: Instance) -> None:
    found = plan_within(instance, iterations=5, seed=1)
    assert found == plan_within(instance, iterations=5, seed=1)
    assert judge(instance, found).valid


def test_robots_with_slow_places_are_planned_in_time() -> None:
    instance = grid_instance(Grid(width=20, height=20), Fleet(robots=60), Traits(duration=Range(1, 3)))
    plan_within(instance, iterations=1)
    seen: list[tuple[int, int]] = []
    started = process_time()
    found = plan_within(
        instance, seconds=0.5, clock=process_time, advance=lambda _, unplanned, total: seen.append((unplanned, total))
    )
    assert process_time() - started < 2
    assert judge(instance, found).valid
    assert seen == sorted(seen, reverse=True)


def test_nobody_is_planned_where_there_is_nothing() -> None:
    nothing = Instance(ResourceGraph((), ()), ())
    assert plan_within(nothing, seconds=1) == plan_within(nothing, iterations=1) == Solution((), ())


def test_robots_for_which_there_is_no_time_are_unplanned() -> None:
    instance = grid_instance(Grid(width=5, height=5), Fleet(robots=6), Traits(duration=Range(2, 2)))
    ticks = iter(range(10**9))
    found = plan_within(instance, seconds=24, clock=lambda: float(next(ticks)))
    assert 0 < len(found.unplanned) < 6
    assert judge(instance, found).valid


@pytest.mark.parametrize("seed", range(6))
def test_robots_left_out_are_planned_again_in_the_rest_of_the_time(seed: int) -> None:
    """First plans take more than a third of the time here, and leave out one to four."""
    fleet = Fleet(robots=12, seed=seed, after_goal="park")
    instance = grid_instance(Grid(width=5, height=5, map_seed=seed), fleet, Traits(duration=Range(1, 2)))
    ticks = count()
    assert not plan_within(instance, seconds=150, clock=lambda: float(next(ticks))).unplanned


@pytest.mark.parametrize("orders", ["goals", "pick-and-drop"])
@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_all_robots_get_plans_though_there_is_no_time_for_the_best(orders: Orders, after_goal: AfterGoal) -> None:
    fleet = Fleet(robots=60, seed=2, after_goal=after_goal, orders=orders)
    instance = grid_instance(Grid(width=12, height=12), fleet, Traits(duration=Range(1, 3)))
    ticks = count()
    found = plan_within(instance, seconds=900, clock=lambda: float(next(ticks)))
    assert judge(instance, found).valid
    assert not found.unplanned
