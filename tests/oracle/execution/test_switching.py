"""Executions in which robots change places: as safe as executions in order, and on the whole earlier."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TypeAlias

import pytest

from carp_reference import plan
from carp_reference.execution import order_of
from carp_spec import Carp, Group, Instance, Solution, judge, violations_of
from carp_spec.execution.execution_rules import trace_violations
from carproof import Delay, Resource, ResourceGraph, Robot, execute
from carproof.execution import switching
from carproof.execution.delays import stuck
from carproof.execution.simulation import random_delays
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

TOGETHER = {"joint/capacity", "joint/group", "joint/exchange", "joint/following"}
Case: TypeAlias = tuple[Instance, Solution, tuple[Delay, ...]]


def cases() -> Iterator[Case]:
    """Crowds on small maps with many delays; robots can follow their plans in order."""
    small = [(seed, 12, 7, Traits()) for seed in range(12)]
    wide = [(seed, 20, 11, Traits(capacity=Range(1, 2))) for seed in (1964, 2017)]  # a switch of 1964 is a circle
    for seed, map, robots, traits in small + wide:
        fleet = Fleet(robots, seed, ("vanish", "park")[seed % 2])
        instance = grid_instance(Grid(4, 4, map=map, map_seed=seed), fleet, traits)
        solution = plan(instance, Carp())
        if not stuck(order_of(instance, solution)):
            yield instance, solution, random_delays(solution, 300_000, 5, seed)


def grouped_cases() -> Iterator[Case]:
    """Crowds where parts of rows of cells have room for one robot, or for two, and overlap."""
    for seed in range(24):
        fleet = Fleet(8, seed, ("vanish", "park")[seed % 2])
        drawn = grid_instance(Grid(5, 4, map=20, map_seed=seed), fleet)
        rows = [
            tuple(f"{x},{y}" for x in range(start, start + 2 + int(start == 1)))
            for y in range(4)
            for start in (0, 1, 3)
        ]
        groups = tuple(Group(number, row, 1 + number % 3 // 2) for number, row in enumerate(rows))
        instance = replace(
            drawn, graph=replace(drawn.graph, groups=groups), following=("allowed", "forbidden")[seed % 3 == 2]
        )
        solution = plan(instance, Carp())
        if not stuck(order_of(instance, solution)):
            yield instance, solution, random_delays(solution, 300_000, 5, seed)


@pytest.mark.parametrize(("tried", "cases"), [(1, cases), (20, cases), (20, grouped_cases)])
def test_robots_that_change_places_are_safe_and_mostly_earlier(
    tried: int, cases: Callable[[], Iterator[Case]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(switching, "MOST_TRIED", tried)
    earlier = 0
    for instance, solution, delays in cases():
        run, in_order = (execute(instance, solution, driver, delays) for driver in ("switching", "order"))
        assert judge(instance, run.followed).valid
        assert not trace_violations(instance, run.followed, run.trace)
        assert not {each.rule for each in violations_of(instance, run.trace.plans)} & TOGETHER
        assert run.switches > 0 or run.trace == in_order.trace
        earlier += sum(in_order.late.values()) - sum(run.late.values())
    assert earlier > 0


def test_who_stays_longer_at_its_goal_is_waited_for() -> None:
    cells = (Resource("a"), Resource("b"), Resource("c", duration=2))
    robots = (Robot("r", "a", "b"), Robot("s", "c", "b"))
    instance = Instance(ResourceGraph(cells, (("a", "b"), ("c", "b"))), robots, "vanish")
    found = execute(instance, plan(instance, Carp()), "switching", [Delay("r", 1, 3)])
    assert not found.collisions
    assert [each.visits[-1].enter for each in found.trace.plans] == [1, 5]
