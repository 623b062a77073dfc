"""The nearest robot, `neighbourhood/distance` and `neighbourhood/nearest`, exactly and without looking at all of all.

The mean distance of two robots is a sum of terms divided by a number of ticks. To fit in 64 bits, each term is split
into `term >> split` and the rest, and the two are summed apart; `split` is 0 for all but huge coordinates.
"""

import math
from typing import NamedTuple

from carp_optimized.arrays import NONE, Records, State, Work
from carp_optimized.compiling import compiled
from carp_optimized.records import arrival


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
    """floor(2^16 * sqrt(dx^2 + dy^2)): the float is a guess, at most one off, that whole numbers put right.

    Squares of whole numbers beyond 64 bits wrap around when compiled, and their small difference comes out right.
    """
    squared = dx * dx + dy * dy
    root = int(math.sqrt(squared) * 65536.0)
    while (squared << 32) - root * root < 0:
        root -= 1
    while (squared << 32) - (root + 1) * (root + 1) >= 0:
        root += 1
    return root


@compiled
def apart(records: Records, one: int, other: int) -> int:
    """A lower bound of the terms of two plans: that of the boxes that hold their positions."""
    dx = max(int(records.left[one] - records.right[other]), int(records.left[other] - records.right[one]), 0)
    dy = max(int(records.low[one] - records.high[other]), int(records.low[other] - records.high[one]), 0)
    if dx == 0 and dy == 0:
        return 0
    return term(dx, dy)


@compiled
def distance_below(state: State, one: int, other: int, best: Mean) -> Mean:
    """The distance of two plans if it is less than the best, else the best.

    Walks over both plans' visits, not over ticks, and stops as soon as the sum of the first terms is too large.
    """
    records = state.records
    split = state.split
    if apart(records, one, other) > best.whole:
        return best
    first = min(int(state.robots.release[records.robot[one]]), int(state.robots.release[records.robot[other]]))
    end = max(arrival(records, one), arrival(records, other)) + 1
    ticks = end - first
    limit = ((best.whole >> split) + 1) * ticks
    i = int(records.visits_at[one])
    j = int(records.visits_at[other])
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
        each = term(
            int(state.graph.x[here]) - int(state.graph.x[there]), int(state.graph.y[here]) - int(state.graph.y[there])
        )
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
def nearest(state: State, work: Work, size: int, count: int, now: int) -> int:
    """The position in `outside` of the robot least distant from the members, the first of such; `NONE`: none is left.

    A robot whose plan has ended by now is left alone.
    """
    best = Mean(1 << (31 + state.split), 0, 1)  # more than any term
    chosen = NONE
    for position in range(size):
        own = int(work.trajectories[work.outside[position]])
        if state.records.leave[own] <= now:
            continue
        for member in range(count):
            mean = distance_below(state, own, int(work.trajectories[work.members[member]]), best)
            if is_less(mean, best):
                best = mean
                chosen = position
    return chosen
