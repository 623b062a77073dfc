"""Bounds and plans meet at the optimum, whatever runs beside whatever and on however many cores."""

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from itertools import islice, pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from tests.optimum.test_branching import nothing
from tests.optimum.test_priced_formula import town
from tests.profiles import draws
from tests.spec.making import grid
from tests.verify.optimum.tiny import TINY

import carproof
from carp_optimized.improve.repair import repair
from carp_optimum.background import BackgroundSearch
from carp_optimum.narrowing import half_narrowed, narrowed
from carp_optimum.optimum import optimum
from carp_optimum.sat.between import Between
from carp_optimum.sat.core_guided import core_guided
from carp_optimum.sat.proving import write_proof
from carp_spec import AfterGoal, Carp, Instance, Plan, Robot, judge, total_cost
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.proof import solution_of
from carproof import TimeOver, verify_proof
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import instances

SECONDS = 60


@pytest.fixture
def beside_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimum.sat.core_guided.CONFLICTS_BEFORE_BESIDE", -1)
    monkeypatch.setattr("carp_optimum.narrowing.PRICE_STEPS", 5)
    monkeypatch.setattr("carp_optimum.sat.heuristics.ROUNDS", 40)
    monkeypatch.setattr("carp_optimized.jit.compiling.is_cached", lambda _: True)


def crowd_with_plans() -> tuple[Instance, tuple[Plan, ...], tuple[Plan, ...]]:
    """A crowd with its cheapest plans, in an order of their own, and with dearer ones."""
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, 2))
    cheap = core_guided(instance, SECONDS).solution
    assert cheap is not None
    dear = repair(instance, carproof.plan(instance, Carp())).plans
    assert len(dear) == len(cheap.plans)
    assert total_cost(instance, dear) > total_cost(instance, cheap.plans)
    return instance, cheap.plans[::-1], dear


def results(instance: Instance) -> list[Between]:
    """The first results, whose works must not fall: all up to an optimum, but for those that only try to get there."""
    steps = list(islice(narrowed(instance, nothing), 1000))
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
@pytest.mark.parametrize("in_thread", [False, True])
def test_the_optimum_is_the_same_in_one_process_and_in_two_and_in_a_thread(in_thread: bool) -> None:
    instance = town(7, "park")
    alone = optimum(instance, SECONDS)
    with ThreadPoolExecutor(1) as pool:
        together = pool.submit(optimum, instance, SECONDS, processes=2).result() if in_thread else None
    assert alone == (together or optimum(instance, SECONDS, processes=2))
    assert alone.decided


@pytest.mark.usefixtures("beside_at_once")
@pytest.mark.parametrize(("seed", "after_goal"), [(7, "park"), (10, "vanish")])
def test_formulas_lead_up_from_a_weak_bound(seed: int, after_goal: AfterGoal, monkeypatch: pytest.MonkeyPatch) -> None:
    instance = town(seed, after_goal)
    least = core_guided(instance, SECONDS).cost
    monkeypatch.setattr("carp_optimum.sat.heuristics.ever_better", lambda *_: iter(()))
    found = results(instance)
    assert len({known.lower for known in found}) > 2
    assert (found[-1].lower, found[-1].total) == (least, least)


@pytest.mark.usefixtures("beside_at_once")
@pytest.mark.parametrize("parts", [1, 2, 64])
@pytest.mark.parametrize("seed", range(4))
def test_the_halves_of_a_crowd_meet_at_the_optimum(seed: int, parts: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimum.branching.branching.PARTS_TO_SHARE", parts)
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, seed))
    least = core_guided(instance, SECONDS).cost
    assert least is not None
    one, other = (list(half_narrowed(instance, nothing, half)) for half in (0, 1))
    assert all(work <= later and known.lower <= next.lower for (work, known), (later, next) in pairwise(one))
    assert len({known.lower for _, known in one}) > 1
    for _, known in one:
        for _, beside in other:
            together = known.of_all(beside)
            assert together.total is None or together.lower <= least <= together.total
    together = one[-1][1].of_all(other[-1][1])
    assert (together.lower, together.total) == (least, least)


@pytest.mark.usefixtures("beside_at_once")
@pytest.mark.parametrize("seed", range(2))
def test_a_dense_instance_has_the_same_optimum_in_one_process_and_in_two(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(BackgroundSearch, "latest", None)  # depends on the clock
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, seed))
    found = [optimum(instance, SECONDS, processes=processes) for processes in (1, 2)]
    assert found[0] == found[1]
    assert found[0].decided
    assert found[0].cost == core_guided(instance, SECONDS).cost


def found_in_halves(
    monkeypatch: pytest.MonkeyPatch, here: Iterable[tuple[int, Between]], beside: Iterable[tuple[int, Between]]
) -> None:
    """Have the two halves of a crowd give these results."""
    halves = {0: here, 1: beside}
    monkeypatch.setattr("carp_optimum.optimum.half_narrowed", lambda _, __, half: iter(halves.pop(half)))


@pytest.mark.usefixtures("beside_at_once")
def test_one_half_of_a_crowd_waits_for_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimum.optimum.narrowed", None)
    instance, cheap, dear = crowd_with_plans()
    cost, more = total_cost(instance, cheap), total_cost(instance, dear)
    met_beside = (9_000_000, Between(instance, cost, cheap))
    found_in_halves(monkeypatch, [(0, Between(instance, more, dear))], [(0, Between(instance)), met_beside])
    best = optimum(instance, SECONDS)
    assert best.solution is not None
    assert (best.decided, best.cost, best.solution.plans) == (True, cost, cheap)


@pytest.mark.usefixtures("beside_at_once")
@pytest.mark.parametrize("half", [0, 1])
def test_a_bound_of_one_half_is_none_of_all_plans(half: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The time is over before the other half gives a bound."""
    instance, _, dear = crowd_with_plans()

    def over() -> tuple[int, Between]:
        raise TimeOver

    late = (over() for _ in range(1))
    ahead = [(100, Between(instance, total_cost(instance, dear), dear))]
    found_in_halves(monkeypatch, *([ahead, []] if half == 0 else [late, ahead]))
    monkeypatch.setattr("carp_optimum.optimum.narrowed", lambda *_: late)
    monkeypatch.setattr(BackgroundSearch, "latest", lambda _: ahead[0][1] if half else None)
    best = optimum(instance, SECONDS)
    assert best.lower < total_cost(instance, dear)


@pytest.mark.usefixtures("beside_at_once")
def test_robots_on_every_cell_are_proved_to_need_their_total(tmp_path: Path) -> None:
    """The opposite corners of a full grid change places; the proof does without prices."""
    cells = [(x, y) for y in range(3) for x in range(3)]
    robots = (Robot(i, f"{x},{y}", f"{2 - x},{2 - y}") for i, (x, y) in enumerate(cells) if (x, y) != (1, 1))
    instance = Instance(grid(3, 3), tuple(robots), "vanish")
    best = optimum(instance, SECONDS)
    assert (best.decided, best.cost) == (True, core_guided(instance, SECONDS).cost)
    write_proof(instance, best, tmp_path, SECONDS)
    assert verify_proof(tmp_path).cost == best.cost
