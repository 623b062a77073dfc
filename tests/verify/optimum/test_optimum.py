import time
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import pytest
from tests.spec.making import grid, row

from carp_optimum.bound import lower_bound
from carp_optimum.optimum import optimum
from carp_optimum.sat.proving import write_proof
from carp_spec import AfterGoal, Instance, Refusal, Resource, ResourceGraph, Robot, judge
from carp_verify.optimum.proof import verify_proof
from carp_verify.optimum.unsolvable import describe
from carproof.generate import Fleet, Grid, grid_instance

LONG = 60


def on_grid(size: int, *robots: Robot, after_goal: AfterGoal = "vanish") -> Instance:
    return Instance(grid(size, size), robots, after_goal)


def turned_ring(size: int, after_goal: AfterGoal = "vanish") -> Instance:
    """Every cell has a robot that wants to the opposite cell, all of them crossing at the middle."""
    cells = [(x, y) for y in range(size) for x in range(size) if (x, y) != (size // 2, size // 2)]
    robots = (Robot(i, f"{x},{y}", f"{size - 1 - x},{size - 1 - y}") for i, (x, y) in enumerate(cells))
    return on_grid(size, *robots, after_goal=after_goal)


@pytest.mark.parametrize(
    ("instance", "reason"),
    [
        (
            Instance(ResourceGraph((Resource(0), Resource(1)), ()), (Robot("a", 0, 1),)),
            "no way leads from 0 to 1, the goal of robot a",
        ),
        (
            on_grid(2, Robot("a", "0,0", "1,1"), Robot("b", "1,0", "1,1"), after_goal="park"),
            "2 robots are to park in 1,1, which has a capacity of 1",
        ),
        (
            on_grid(3, Robot("a", "0,0", "1,1"), Robot("b", "0,0", "2,2")),
            "robots are in one place, or exchange places, however late they are",
        ),
        (
            Instance(
                row(*[1] * 12),
                (Robot("a", 0, 11), Robot("b", 11, 0)),
            ),
            "a search over all states of the robots together finds no plan set",
        ),
    ],
)
def test_an_unsolvable_instance_is_found_with_its_obstacle(instance: Instance, reason: str) -> None:
    best = optimum(instance, LONG)
    assert (best.cost, best.decided, best.solution) == (None, True, None)
    assert best.obstacle is not None
    assert describe(instance, best.obstacle) == reason


def clock_of(seconds_a_look: float) -> Iterator[int]:
    """The nanoseconds of a clock that advances only when it is read."""
    return (round(look * seconds_a_look * 1_000_000_000) for look in count())


def test_the_search_ends_with_the_first_look_at_the_clock_behind_the_limit() -> None:
    instance = turned_ring(9)
    reported: list[int] = []

    def clock() -> int:
        reported.append(next(ticks))
        return reported[-1]

    ticks = clock_of(0.005)
    best = optimum(instance, 3, clock)
    assert not best.decided
    assert [tick >= 3_000_000_000 for tick in reported].count(True) <= 2
    shortest = sum(abs(8 - 2 * x) + abs(8 - 2 * y) for x in range(9) for y in range(9))
    assert best.lower >= shortest


@pytest.mark.parametrize("engine", ["reference", "optimized"])
def test_an_undecided_search_leaves_the_best_plans_found_and_a_bound(
    engine: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("carp_optimized.jit.compiling.is_cached", lambda _: engine == "optimized")
    instance = grid_instance(Grid(8, 8, 20, map_seed=1), Fleet(32, 1, "park"))
    ticks = clock_of(0.1)
    best = optimum(instance, 20, lambda: next(ticks))
    assert (best.decided, best.obstacle) == (False, None)
    assert best.solution is not None
    assert best.cost is not None
    verdict = judge(instance, best.solution)
    assert (verdict.violations, verdict.unplanned, verdict.cost) == ((), 0, best.cost)
    assert best.cost > best.lower > (best.shortest or 0)


def test_a_fleet_whose_formula_takes_too_long_is_planned_in_the_rest_of_the_time() -> None:
    ticks = clock_of(0.1)
    instance = grid_instance(Grid(12, 12), Fleet(60, after_goal="park"))
    best = optimum(instance, 20, lambda: next(ticks))
    assert best.solution is not None
    assert judge(instance, best.solution).cost == best.cost
    assert best.lower == best.shortest == lower_bound(instance, steps=0).bound
    assert not best.decided


def test_shortest_paths_that_break_no_rule_are_an_optimum_without_a_formula(tmp_path: Path) -> None:
    ticks = clock_of(0.1)
    instance = on_grid(16, *(Robot(y, f"0,{y}", f"1,{y}") for y in range(16)))
    best = optimum(instance, 6, lambda: next(ticks))
    assert (best.decided, best.cost, best.lower) == (True, 16, 16)
    write_proof(instance, best, tmp_path / "proof", LONG)
    assert verify_proof(tmp_path / "proof").cost == 16


@pytest.mark.parametrize("limit", [0, 1])
def test_the_limit_is_kept_on_a_large_map_with_many_robots(limit: int) -> None:
    """Counted in processor time, so that a busy machine does not matter."""
    robots = (Robot(i, f"{i},{7 * i % 60}", f"{11 * i % 60},{59 - i}") for i in range(50))
    instance = on_grid(60, *robots)
    started = time.process_time()
    best = optimum(instance, limit)
    assert time.process_time() - started < 2 * limit + 0.5
    assert best.decided == (best.cost == best.lower)


def test_far_releases_do_not_make_the_search_over_all_states_endless() -> None:
    """The states would be looked at tick by tick until the release."""
    instance = Instance(row(*[1] * 12), (Robot("a", 0, 11, 3_000_000), Robot("b", 11, 0, 3_000_000)))
    started = time.process_time()
    assert not optimum(instance, 1).decided
    assert time.process_time() - started < 2


def test_a_search_over_too_many_states_leaves_the_search_for_an_optimum_going(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_verify.optimum.unsolvable.FEW_STATES", 10**9)
    monkeypatch.setattr("carp_verify.optimum.joint_search.refuse_size", refuse_anything)
    monkeypatch.setattr("carp_optimum.sat.core_guided.DELAY_OF_DOUBT", 1)
    instance = on_grid(
        3, Robot("a", "0,1", "2,1"), Robot("b", "2,1", "0,1"), Robot("c", "1,0", "1,2"), after_goal="park"
    )
    best = optimum(instance, LONG)
    assert (best.cost, best.shortest) == (9, 6)


def refuse_anything(what: str, size: int, limit: int) -> None:
    raise Refusal("limit", "$.robots", "optimum/size", f"{what} must be at most {limit}, not {size}")
