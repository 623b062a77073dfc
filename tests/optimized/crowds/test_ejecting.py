"""Rounds that clear the way of a robot: the sum never grows without a raise, and stays are those of the paths."""

import numpy as np
import pytest
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.ejecting import eject
from carp_optimized.crowds.improving import Improving, total_of
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.sipp import EFFORT, GREED, UNTIL_FOUND
from carp_optimized.crowds.state import CHANCE, SIZE, TOTAL, Rounds, begin_round, rounds_at
from carp_optimized.crowds.stays import no_paths, solution_along
from carp_optimized.draws import SURE
from carp_optimized.improve.planning import plan_crowd
from carp_optimized.jit.compiling import entry
from carp_optimized.jit.references import Native
from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot, judge

ROBOTS, CROWDED, TRIES = 24, 60, 40


@entry
def ejects(native: Native[Rounds]) -> bool:
    state = rounds_at(native)
    begin_round(state)
    return eject(state)


def stays_of(state: Rounds) -> list[list[tuple[int, int, int]]]:
    """The stays in each place."""
    stays = state.stays
    rows = [slice(first, first + size) for first, size in zip(stays.first, stays.size, strict=False)]
    return [list(zip(stays.enter[row], stays.leave[row], stays.robot[row], strict=True)) for row in rows]


@pytest.mark.parametrize("greed", [0, GREEDY])
@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_without_a_raise_the_sum_never_grows(after_goal: AfterGoal, greed: int) -> None:
    fallen = chains = 0
    for seed in range(8):
        instance = on_grid(9, ROBOTS, after_goal, seed, map=seed % 2 * 20)
        crowd = measured(instance)
        first = Improving(crowd, no_paths(ROBOTS, 300), seed)
        first.plan_first(np.arange(ROBOTS, dtype=np.int32), lambda: True, GREEDY, UNTIL_FOUND)
        paths = first.make_way(lambda _: True)
        improving = Improving(crowd, paths, seed)
        improving.begin(lambda: True)
        state = improving.rounds
        for _ in range(TRIES):
            state.query.counts[GREED] = state.soft.labels.counts[GREED] = greed
            before = improving.total
            if not ejects(improving._native):
                improving._make_room()
                state = improving.rounds
            found = solution_along(instance, instance.robots, paths)
            assert judge(instance, found).valid
            assert improving.total == total_of(paths)
            assert improving.total <= before
            again = Improving(crowd, paths)
            assert again.begin(lambda: True)
            assert stays_of(again.rounds) == stays_of(state)
            assert not state.soft.met.any()
            assert state.query.counts[EFFORT] == state.soft.labels.counts[EFFORT] == UNTIL_FOUND
            fallen += improving.total < before
            chains += improving.total < before and state.counts[SIZE] > 2
        assert improving.best == improving.total == state.counts[TOTAL]
    assert fallen > 20
    assert chains > 5


def test_a_raise_lets_the_sum_grow_and_the_best_paths_stay() -> None:
    instance = on_grid(9, CROWDED)
    crowd = measured(instance)
    first = Improving(crowd, no_paths(CROWDED, 300))
    first.plan_first(np.arange(CROWDED, dtype=np.int32), lambda: True, 0, UNTIL_FOUND)
    improving = Improving(crowd, first.make_way(lambda _: True))
    improving.begin(lambda: True)
    totals = [improving.total]
    for _ in range(300):
        improving.rounds.counts[CHANCE] = SURE // 2
        if not ejects(improving._native):
            improving._make_room()
        totals.append(improving.total)
        assert improving.total == total_of(improving.rounds.paths)
        assert judge(instance, solution_along(instance, instance.robots, improving.rounds.paths)).valid
    assert totals != sorted(totals, reverse=True)
    assert improving.best == total_of(improving.rounds.best) == min(totals)


def test_a_robot_gives_way_where_both_are_late_in_the_best_plans() -> None:
    edges = (("aside", "a"), ("a", "b"), ("b", "c"), ("b", "bay"), ("c", "d"))
    graph = ResourceGraph(tuple(map(Resource, ("aside", "a", "b", "c", "d", "bay"))), edges)
    instance = Instance(graph, (Robot("past", "a", "d"), Robot("stops", "c", "b")), after_goal="park")
    found = plan_crowd(instance, iterations=400, seconds=None)
    assert found is not None
    assert [each.visits[-1].enter for each in found.solution.plans] == [4, 3]
