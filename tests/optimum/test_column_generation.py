"""The linear programme of ways: what its prices prove, and the solver behind it."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from tests.profiles import draws
from tests.verify.optimum.tiny import TINY

from carp_optimum.bound import SCALE
from carp_optimum.lagrangian.column_generation import CLOSE, ColumnGeneration
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.lagrangian.linear_programme import LinearProgramme
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carp_verify.optimum.joint_search import least_total_cost
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import instances

NONE = np.zeros(0, np.int64)
ONE = np.ones(1, np.int64)


def nothing() -> None:
    """Look at no clock."""


@settings(max_examples=draws(60))
@given(instances(replace(TINY, groups=2), least_robots=2))
def test_prices_prove_what_the_programme_costs(instance: Instance) -> None:
    search = PriceSearch(instance, SCALE)
    columns = ColumnGeneration(search)
    columns.climb(nothing)
    assert columns.programme.objective - search.restore() / SCALE <= CLOSE + len(instance.robots) / 100
    best = least_total_cost(instance)
    if best is not None:
        assert columns.programme.objective <= best + CLOSE


@pytest.mark.parametrize("seed", range(4))
def test_no_prices_prove_more(seed: int) -> None:
    instance = grid_instance(Grid(width=5, height=5, map=5, map_seed=seed), Fleet(robots=8, seed=seed))
    columns = ColumnGeneration(PriceSearch(instance, SCALE))
    columns.climb(nothing)
    steps = PriceSearch(instance, SCALE)
    left = iter(range(400))

    def step() -> None:
        next(left)

    with suppress(StopIteration):
        steps.climb(4 * SCALE, SCALE >> 6, step)
    assert steps.best / SCALE <= columns.programme.objective + CLOSE


def test_deadlines_that_are_dropped_prove_nothing() -> None:
    graph = ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "c"), ("b", "d")), directed=False)
    search = PriceSearch(Instance(graph, (Robot("one", "a", "c"), Robot("other", "d", "a"))), SCALE)
    columns = ColumnGeneration(search)
    columns.climb(nothing)
    bound = search.best
    search.add_deadlines([Deadlines([Member(0, 8, 0, ()), Member(1, 8, 0, ())])])
    columns.add_deadlines()
    columns.climb(nothing)
    assert search.best > bound + 4 * SCALE
    search.keep_deadlines([])
    columns.keep_deadlines()
    columns.climb(nothing)
    assert search.best == columns.best == bound
    assert columns.programme.objective == pytest.approx(bound / SCALE, abs=CLOSE)


def test_a_check_that_raises_ends_a_solution_which_can_go_on() -> None:
    programme = LinearProgramme()
    programme.add_rows(-np.inf, [9.0] * 300, [NONE] * 300, [NONE] * 300)
    for number in range(2000):
        rows = np.unique([number % 300, number * 7919 % 293, number * 104729 % 289])
        programme.add_column(-1.0 - number * 1299709 % 1009, rows, np.ones_like(rows))

    def over() -> None:
        raise TimeoutError

    with pytest.raises(TimeoutError):
        programme.solve(over)
    programme.solve(nothing)
    assert programme.shares.sum() > 0


def test_a_row_that_is_dropped_allows_anything() -> None:
    programme = LinearProgramme()
    programme.add_rows(1, [1.0], [NONE], [NONE])
    for cost in (5, 3):
        programme.add_column(cost, 0 * ONE, ONE)
    row = programme.add_rows(-np.inf, [0.5], [ONE], [ONE])
    programme.solve(nothing)
    assert (programme.objective, *programme.duals) == pytest.approx((4, -5, 2))
    programme.drop_row(row)
    programme.solve(nothing)
    assert programme.objective == pytest.approx(3)
