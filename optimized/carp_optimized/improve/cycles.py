"""Rounds that make the best of the first paths: simulated annealing in cycles.

Rounds may raise the sum for a while (simulated annealing, Kirkpatrick et al. 1983): on average by a share of a robot's
mean delay, which falls to 0 as the cube of what is left of the cycle. There are several cycles, each from the best
paths so far. Where there is time for many rounds, each path is one of those that arrive equally early.

The better start may be a trap: where robots with short ways went first through a narrow place, crowds wait behind them,
and no few robots can change that. Plans by LaCAM have no such order. So they come first if they are the better ones
once each robot has been planned again, and most cycles begin from the worse start, unless there are too few rounds to
come down from it, or so little room that LaCAM moves robots to and fro. The last cycle goes on from the best paths.
"""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from carp_optimized.crowds.crowd import Crowd, ways_of
from carp_optimized.crowds.improving import Improving, arrivals, total_of
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.stays import Paths
from carp_optimized.draws import SURE
from carp_optimized.improve.clock import Clock

Advance = Callable[[int, int, int], None]

WORK = 1 << 15
"""The work of one compiled call: some milliseconds."""
CYCLES, LEAVING, CHOOSING = 8, 1, 7
"""The cycles; the one that leaves the better start for the worse one, and the one that chooses the best paths."""
FEW, SPARSE = 8, 8
"""The worse start is tried if at least so many rounds a robot are expected, and each robot has so many places."""
HEAT, REHEAT = 64, 16
"""The mean raise of the first rounds of the first cycle and of others, in 16ths of the mean delay of a robot.

Cycles from the best paths are not to leave their place altogether.
"""
ENOUGH = 32
"""With fewer rounds a robot than this, raises are smaller: there is no time to make up for them."""
PARTS = 1 << 10
"""What is left of the time is counted in parts of this."""


def improved(
    crowd: Crowd, starts: Sequence[Paths], iterations: int | None, timer: Clock, seed: int, advance: Advance
) -> Paths:
    """The best paths that rounds make of the better start, and in some cycles of the other one, if there is one.

    The first start is the better one, unless the second still is after each robot has been planned again.
    """
    searches, other = _begun(crowd, starts[0], timer, seed), starts[1:2]
    if searches and other and total_of(other[0]) < searches[0].best:
        searches, other = _begun(crowd, other[0], timer, seed) + searches, []
        searches.sort(key=lambda each: each.best, reverse=True)
    if not searches:
        return min(starts, key=total_of)
    robots = crowd.start.size
    least = int(ways_of(crowd).sum())
    current = 0
    for gone, rounds in _parts(iterations, timer, searches):
        cycle, part = divmod(CYCLES * gone, PARTS)
        expected = iterations or PARTS * _played(searches) // max(gone, 1)
        if cycle > current:
            current = cycle
            if cycle == LEAVING and FEW * robots <= expected and SPARSE * robots <= crowd.queue.size:
                searches.reverse()
                for paths in other:
                    searches += _begun(crowd, paths, timer, seed)
            elif cycle == CHOOSING:
                searches.sort(key=lambda each: each.best, reverse=True)
            if searches[-1].total > searches[-1].best and not searches[-1].return_to_best(timer.goes_on):
                break
        improving = searches[-1]
        heat = (REHEAT if cycle else HEAT) * (improving.total - least)
        raising = chance(heat, robots, expected, PARTS - part, power=2)
        improving.play(rounds, WORK, raising, turning=expected >= ENOUGH * robots)
        best = min(each.best for each in searches)
        advance(_played(searches), 0, best)
        if best == least:
            break
    return min(*(each.rounds.best for each in searches), *starts, key=total_of)


def _begun(crowd: Crowd, paths: Paths, timer: Clock, seed: int) -> list[Improving]:
    """A search from these paths in which each robot has been planned again; none if there is no time for it."""
    improving = Improving(crowd, paths, seed)
    if not improving.begin(timer.goes_on):
        return []
    delays = arrivals(paths) - improving.rounds.least
    improving.plan_each(np.argsort(-delays, kind="stable").astype(np.int32), timer.goes_on, GREEDY)
    return [improving]


def _played(searches: Sequence[Improving]) -> int:
    return sum(each.played for each in searches)


def _parts(iterations: int | None, timer: Clock, searches: Sequence[Improving]) -> Iterator[tuple[int, int]]:
    """The parts of the time, or of the rounds, that are gone, and how many rounds to play next at most."""
    started = timer.spent
    while timer.goes_on():
        if iterations is None:
            left = (timer.seconds or 0) - timer.reserved - started
            yield min(int(PARTS * (timer.spent - started) / left), PARTS - 1), SURE
        elif _played(searches) < iterations:
            played = _played(searches)
            yield PARTS * played // iterations, min(iterations - played, 100)
        else:
            break


def chance(heated: int, robots: int, rounds: int, left: int, power: int) -> int:
    """The chance of each further tick of a raise, in parts of `SURE`; it makes the mean raise what it is to be.

    `heated` is the delay of all robots times the heat, and `rounds` are those expected: if too few, raises are smaller
    by that power.
    """
    robots = max(robots, 1)
    enough = ENOUGH * robots
    mean: int = heated * min(rounds, enough) ** power * left**3
    whole: int = mean + 16 * robots * enough**power * PARTS**3
    return SURE * mean // whole
