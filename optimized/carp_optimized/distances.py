"""The nearest robot (`neighbourhood/distance`, `neighbourhood/nearest`), exactly and without summing all distances.

The mean distance of two robots is a sum of terms divided by a number of ticks. To fit in 64 bits, each term is split
into `term >> split` and the rest, and the two are summed apart; `split` is 0 for all but huge coordinates.
"""

import math
from typing import NamedTuple

from carp_optimized.arrays import NEVER, NONE, State, Work
from carp_optimized.compiling import compiled


class Mean(NamedTuple):
    """The fraction whole + rest / ticks, with rest < ticks."""

    whole: int
    rest: int
    ticks: int


@compiled
def is_less(one: Mean, other: Mean) -> bool:
    """Compare two fractions; rest and ticks are below 2^31, so the products fit."""
    if one.whole != other.whole:
        return one.whole < other.whole
    return one.rest * other.ticks < other.rest * one.ticks


@compiled
def term(dx: int, dy: int) -> int:
    """floor(2^16 * sqrt(dx^2 + dy^2)): the float is that or one more, which whole numbers put right.

    It is never less: 2^-16 times the result is a float, and rounding, of the squares too, moves their root by less than
    half the way to the next one. Squares of whole numbers beyond 64 bits wrap around when compiled, and their small
    difference comes out right.
    """
    squared = dx * dx + dy * dy
    root = int(math.sqrt(squared) * 65536.0)
    return root - 1 if (squared << 32) - root * root < 0 else root


@compiled
def is_apart(state: State, one: int, other: int, whole: int) -> bool:
    """Whether the mean positions of two plans alone show that their distance is at least whole + 1.

    The mean of distances is no less than the distance of the means, and each term is less than 1 below what it rounds.
    Both sides are multiplied by the ticks, and not compared where their squares might not fit.
    """
    if state.split > 0:
        return False
    a = state.records.spots[one]
    b = state.records.spots[other]
    first = min(int(a[0]), int(b[0]))
    end = max(int(a[1]), int(b[1])) + 1
    x = int(a[2]) - int(b[2]) + (int(a[6]) - int(b[6])) * end - (int(a[4]) - int(b[4])) * first
    y = int(a[3]) - int(b[3]) + (int(a[7]) - int(b[7])) * end - (int(a[5]) - int(b[5])) * first
    limit = ((whole + 2) * (end - first) >> 16) + 1
    if max(abs(x), abs(y), limit) >= 1 << 31:
        return False
    return x * x + y * y >= limit * limit


@compiled
def distance_below(state: State, one: int, other: int, best: Mean) -> Mean:
    """The distance of two plans if it is less than the best, else the best.

    Walks over both plans' visits, not over ticks, and stops as soon as the sum of the first terms is too large.
    """
    records = state.records
    split = state.split
    end = max(int(records.arrival[one]), int(records.arrival[other])) + 1
    i = int(records.visits_at[one])
    j = int(records.visits_at[other])
    first = min(int(records.enter[i]), int(records.enter[j]))
    ticks = end - first
    limit = ((best.whole >> split) + 1) * ticks
    i_end = i + int(records.visits[one])
    j_end = j + int(records.visits[other])
    here = int(records.resource[i])
    there = int(records.resource[j])
    i += 1
    j += 1
    high = 0
    low = 0
    tick = first
    while tick < end:
        until = end
        if i < i_end:
            until = min(until, int(records.enter[i]))
        if j < j_end:
            until = min(until, int(records.enter[j]))
        dx = int(state.graph.x[here]) - int(state.graph.x[there])
        dy = int(state.graph.y[here]) - int(state.graph.y[there])
        is_small = max(abs(dx), abs(dy)) < 1 << 16 and dx * dx + dy * dy < state.roots.size
        each = int(state.roots[dx * dx + dy * dy]) if is_small else term(dx, dy)
        high += (until - tick) * (each >> split)
        low += (until - tick) * (each & ((1 << split) - 1))
        if high >= limit:
            return best
        tick = until
        if i < i_end and records.enter[i] == tick:
            here = int(records.resource[i])
            i += 1
        if j < j_end and records.enter[j] == tick:
            there = int(records.resource[j])
            j += 1
    remainder = ((high % ticks) << split) + low
    mean = Mean(((high // ticks) << split) + remainder // ticks, remainder % ticks, ticks)
    return mean if is_less(mean, best) else best


@compiled
def nearest(state: State, work: Work, size: int, count: int) -> int:
    """The position in `outside` of the robot least distant from the members, the first of such; `NONE`: none is left.

    A robot whose plan had ended by now before any was replanned is left alone.
    """
    best = guess(state, work, size, count)
    chosen = NONE
    for position in range(size):
        robot = int(work.outside[position])
        if work.ended[robot]:
            continue
        own = int(work.trajectories[robot])
        for member in range(count):
            other = int(work.trajectories[work.members[member]])
            if is_apart(state, own, other, best.whole):
                continue
            mean = distance_below(state, own, other, best)
            if is_less(mean, best):
                best = mean
                chosen = position
    return chosen


@compiled
def guess(state: State, work: Work, size: int, count: int) -> Mean:
    """A little more than the distance of a robot that is likely to be near the newest member, by start and goal.

    Starting with it saves most walks. The robot itself is nearer than that, so it is found if no other is.
    """
    most = Mean(1 << (31 + state.split), 0, 1)  # more than any term
    likely = NONE
    least = NEVER << 3
    b = state.records.spots[int(work.trajectories[work.members[count - 1]])]
    for position in range(size):
        robot = int(work.outside[position])
        if work.ended[robot]:
            continue
        own = int(work.trajectories[robot])
        a = state.records.spots[own]
        away = abs(int(a[4]) - int(b[4])) + abs(int(a[5]) - int(b[5]))
        away += abs(int(a[6]) - int(b[6])) + abs(int(a[7]) - int(b[7])) + abs(int(a[0]) - int(b[0]))
        if away < least:
            least = away
            likely = own
    if likely == NONE:
        return most
    best = most
    for member in range(count):
        best = distance_below(state, likely, int(work.trajectories[work.members[member]]), best)
    return Mean(best.whole + 1, 0, 1)
