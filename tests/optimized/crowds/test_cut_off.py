"""Goals that are cut off: who is left out has no path, says a search of all places and ticks, which is soon known."""

from collections import Counter

import numpy as np
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.cut_off import is_cut_off
from carp_optimized.crowds.improving import Improving
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.sipp import EXPANDED, MANY, UNTIL_FOUND
from carp_optimized.crowds.state import Rounds, rounds_at
from carp_optimized.crowds.stays import Paths, no_paths
from carp_optimized.jit.compiling import entry
from carp_optimized.jit.references import Native

SIDE, ROBOTS = 40, 533
LAST = 600
"""A tick after which all robots stand still, and a robot that can come to its goal has done so."""


@entry
def asks(native: Native[Rounds], robot: int) -> bool:
    state = rounds_at(native)
    return is_cut_off(state.crowd, state.stays, state.query.back, robot, LAST)


def has_path(crowd: Crowd, paths: Paths, robot: int) -> bool:
    """Whether the robot can come to its goal and stay there: all places that it can be in, tick by tick."""
    at = np.full((LAST, crowd.first.size - 1), -1, np.int32)
    for other in np.flatnonzero(paths.size):
        visits = range(int(paths.size[other]))
        enters = [*paths.enter[other, : len(visits)].tolist(), LAST]
        for visit in visits:
            at[enters[visit] : enters[visit + 1], paths.place[other, visit]] = other
    source = np.repeat(np.arange(at.shape[1]), np.diff(crowd.first))
    here = np.zeros(at.shape[1], np.bool_)
    here[crowd.start[robot]] = True
    for tick in range(1, LAST):
        swaps = (at[tick - 1, crowd.target] >= 0) & (at[tick - 1, crowd.target] == at[tick, source])
        here[crowd.target[here[source] & ~swaps]] = True
        here &= at[tick] < 0
    return bool(here[crowd.goal[robot]])


def test_who_is_cut_off_has_no_path() -> None:
    counts = Counter[tuple[bool, bool]]()
    for seed in range(150):
        crowd = measured(on_grid(4, 9, "park", seed, map=0))
        order = np.arange(9, dtype=np.int32)
        improving = Improving(crowd, no_paths(9, 50))
        improving.plan_first(order[:8], lambda: True, 0, UNTIL_FOUND)
        state = improving.rounds
        is_free = state.stays.size[crowd.start[8]] == 0 or state.stays.enter[state.stays.first[crowd.start[8]]] > 0
        if is_free:
            counts[asks(improving._native, 8), has_path(crowd, state.paths, 8)] += 1
    assert counts[True, True] == 0
    assert counts[True, False] > counts[False, False]
    assert counts[False, True] > 10


def test_it_is_soon_known_in_a_large_crowd() -> None:
    crowd = measured(on_grid(SIDE, ROBOTS, map=0))
    order = np.random.default_rng(0).permutation(ROBOTS).astype(np.int32)
    improving = Improving(crowd, no_paths(ROBOTS, 400))
    soon = 0
    for k in range(ROBOTS):
        before = int(improving.rounds.query.counts[EXPANDED])
        improving.plan_first(order[k : k + 1], lambda: True, GREEDY, UNTIL_FOUND)
        if int(improving.rounds.query.counts[EXPANDED]) - before == MANY and not improving.rounds.paths.size[order[k]]:
            soon += 1
            assert not has_path(crowd, improving.rounds.paths, int(order[k]))
    assert soon > 10
