"""Bounds and plans meet at the optimum, whatever runs beside whatever and on however many cores."""

import os
from collections.abc import Callable
from itertools import islice, pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from tests.optimum.test_priced_formula import town
from tests.profiles import draws
from tests.spec.making import grid
from tests.verify.tiny import TINY

import carproof
from carp_optimum.beside import Beside
from carp_optimum.bound import lower_bound
from carp_optimum.narrowing import Between, narrowed
from carp_optimum.optimum import optimum
from carp_optimum.priced_formula import PricedFormula, priced_formula
from carp_optimum.proving import write_proof
from carp_optimum.reduced_costs import PricedBound
from carp_spec import AfterGoal, Carp, Instance, Robot, judge, total_cost
from carp_verify.joint_search import least_total_cost
from carp_verify.proof import solution_of, verify_proof
from carproof.generate import Fleet, Grid, grid_instance
from carproof.strategies import instances

SECONDS = 60


@pytest.fixture
def beside_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimum.optimum.CONFLICTS_BEFORE_BESIDE", -1)
    monkeypatch.setattr("carp_optimum.narrowing.PRICE_STEPS", 5)
    monkeypatch.setattr("carp_optimum.heuristics.ROUNDS", 40)
    monkeypatch.setattr("carp_optimized.compiling.is_cached", lambda _: True)


def results(instance: Instance) -> list[Between]:
    """The first results, whose works must not fall: all up to an optimum, but for those that only try to get there."""
    steps = list(islice(narrowed(instance, lambda: None), 1000))
    assert all(work <= later for (work, _), (later, _) in pairwise(steps))
    return [known for _, known in steps]


@pytest.mark.usefixtures("beside_at_once")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(TINY, least_robots=2))
def test_the_bound_rises_and_the_plans_get_cheaper_until_they_meet(instance: Instance) -> None:
    least = least_total_cost(instance)
    if least is None:
        return
    found = results(instance)
    for known, later in pairwise(found):
        assert known.lower <= later.lower <= least
        assert later.total is not None or known.total is None
        assert known.total is None or (later.total is not None and least <= later.total <= known.total)
    assert found[-1].is_optimum
    assert found[-1].total == found[-1].lower == least
    assert found[-1].plans is not None
    verdict = judge(instance, solution_of(list(found[-1].plans)))
    assert (verdict.violations, verdict.unplanned) == ((), 0)


@pytest.mark.usefixtures("beside_at_once")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(TINY, least_robots=2))
def test_the_optimum_is_the_same_on_one_core_and_on_two(instance: Instance) -> None:
    found = []
    for cores in (1, 2):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(os, "sched_getaffinity", lambda _, cores=cores: {*range(cores)})
            patched.setattr(Beside, "latest", None)  # depends on the clock
            found.append(optimum(instance, SECONDS))
    assert found[0] == found[1]
    assert found[0].decided
    assert found[0].cost == least_total_cost(instance)


@pytest.mark.usefixtures("beside_at_once")
@pytest.mark.parametrize(("seed", "after_goal"), [(7, "park"), (10, "vanish")])
def test_formulas_lead_up_from_a_weak_bound(seed: int, after_goal: AfterGoal, monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(seed, after_goal)
    least = optimum(instance, SECONDS, priced=False).cost
    monkeypatch.setattr("carp_optimum.heuristics.ever_better", lambda *_: iter(()))
    found = results(instance)
    assert len({known.lower for known in found}) > 2
    assert (found[-1].lower, found[-1].total) == (least, least)


@pytest.mark.usefixtures("beside_at_once")
def test_one_formula_gives_cheaper_and_cheaper_plans_down_to_the_optimum(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(7, "park")
    least = optimum(instance, SECONDS, priced=False).cost
    monkeypatch.setattr("carp_optimum.heuristics.ever_better", lambda *_: iter(()))
    monkeypatch.setattr("carp_optimum.narrowing.STRIDE", 40)
    found = results(instance)
    assert (found[-1].lower, found[-1].total) == (least, least)
    assert len({known.lower for known in found}) == 3
    assert len({known.total for known in found}) > 2


@pytest.mark.usefixtures("beside_at_once")
def test_formulas_end_below_the_total_of_the_best_plans_known(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(7, "park")
    least = optimum(instance, SECONDS, priced=False)
    assert least.cost is not None
    assert least.solution is not None
    plans = least.solution.plans
    searched = []

    def below(instance: Instance, bound: PricedBound, cost: int, look: Callable[[], None]) -> PricedFormula:
        searched.append(cost)
        return priced_formula(instance, bound, cost, look)

    monkeypatch.setattr("carp_optimum.heuristics.ever_better", lambda *_: iter([(0, plans)]))
    monkeypatch.setattr("carp_optimum.narrowing.priced_formula", below)
    assert results(instance)[-1] == Between(instance, least.cost, plans)
    assert searched
    assert max(searched) == least.cost - 1


@pytest.mark.usefixtures("beside_at_once")
def test_a_crowd_is_searched_by_branching(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, 2))
    least = optimum(instance, SECONDS, priced=False).cost
    monkeypatch.setattr("carp_optimum.narrowing.priced_formula", None)
    found = results(instance)
    assert (found[-1].lower, found[-1].total) == (least, least)
    assert len({known.lower for known in found}) > 2


@pytest.mark.usefixtures("beside_at_once")
def test_a_crowd_whose_tables_would_be_too_large_is_searched_by_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, 2))
    least = optimum(instance, SECONDS, priced=False).cost
    prices = PricedBound(instance, lower_bound(instance, steps=100, seen=False))
    monkeypatch.setattr("carp_optimum.narrowing._priced_bound", lambda *_: prices)
    monkeypatch.setattr("carp_optimum.branching.MOST_NODES", 200)
    found = results(instance)
    assert (found[-1].lower, found[-1].total) == (least, least)


@pytest.mark.usefixtures("beside_at_once")
def test_plans_get_better_where_the_bound_is_too_far_for_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(7, "park")
    monkeypatch.setattr("carp_optimum.narrowing.LARGEST_GAP", -1)
    least = optimum(instance, SECONDS, priced=False).cost
    totals = (known.total for _, known in narrowed(instance, lambda: None))
    assert least in islice(totals, 1000)


def test_dearer_plans_do_not_replace_cheaper_ones() -> None:
    instance = town(9, "vanish")
    dear = carproof.plan(instance, Carp()).plans
    cheap = optimum(instance, SECONDS, priced=False).solution
    assert cheap is not None
    assert total_cost(instance, cheap.plans) < total_cost(instance, dear)
    assert Between(instance).with_plans(dear).with_plans(cheap.plans).with_plans(dear).plans == cheap.plans


@pytest.mark.usefixtures("beside_at_once")
def test_a_long_search_ends_where_its_bound_meets_the_plans_found_beside(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(7, "park")
    least = optimum(instance, SECONDS, priced=False)
    assert least.solution is not None
    plans = least.solution.plans[::-1]
    monkeypatch.setattr("carp_optimum.optimum.narrowed", lambda *_: iter([(0, Between(instance, 0, plans))]))
    best = optimum(instance, SECONDS)
    assert best.solution is not None
    assert (best.decided, best.cost, best.solution.plans) == (True, least.cost, plans)


@pytest.mark.usefixtures("beside_at_once")
def test_a_long_search_goes_on_where_the_plans_found_beside_cost_more_than_its_bound(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    instance = town(9, "vanish")
    plans = carproof.plan(instance, Carp()).plans
    monkeypatch.setattr("carp_optimum.optimum.narrowed", lambda *_: iter([(0, Between(instance, 0, plans))]))
    best = optimum(instance, SECONDS)
    assert best.decided
    assert best.cost == optimum(instance, SECONDS, priced=False).cost
    assert best.cost != total_cost(instance, plans)


@pytest.mark.usefixtures("beside_at_once")
def test_robots_on_every_cell_are_proved_to_need_their_total(tmp_path: Path) -> None:
    """The opposite corners of a full grid change places; the proof does without prices."""
    cells = [(x, y) for y in range(3) for x in range(3)]
    robots = (Robot(i, f"{x},{y}", f"{2 - x},{2 - y}") for i, (x, y) in enumerate(cells) if (x, y) != (1, 1))
    instance = Instance(grid(3, 3), tuple(robots), "vanish")
    best = optimum(instance, SECONDS)
    assert (best.decided, best.cost) == (True, optimum(instance, SECONDS, priced=False).cost)
    write_proof(instance, best, tmp_path, SECONDS)
    assert verify_proof(tmp_path).cost == best.cost
