"""The nearest robot (`neighbourhood/distance`, `neighbourhood/nearest`), exactly and without summing all distances.

The mean distance of two robots is a sum of terms divided by a number of ticks. To fit in 64 bits, each term is split
into `term >> split` and the rest, and the two are summed apart; `split` is 0 for all but huge coordinates.
"""

import math
from typing import NamedTuple

from carp_optimized.arrays import NEVER, NONE, State, Work
from carp_optimized.compiling import compiled, inlined


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
def difference(state: State, one: int, other: int, first: int, end: int) -> tuple[int, int]:
    """The sum of the differences of two plans' places, in x and in y, at all ticks from `first` to before `end`.

    Neither plan begins before the first, nor arrives at the end or later.
    """
    a = state.records.spots[one]
    b = state.records.spots[other]
    x = int(a[2]) - int(b[2]) + (int(a[6]) - int(b[6])) * end - (int(a[4]) - int(b[4])) * first
    y = int(a[3]) - int(b[3]) + (int(a[7]) - int(b[7])) * end - (int(a[5]) - int(b[5])) * first
    return x, y


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
    x, y = difference(state, one, other, first, end)
    limit = ((whole + 2) * (end - first) >> 16) + 1
    if max(abs(x), abs(y), limit) >= 1 << 31:
        return False
    return x * x + y * y >= limit * limit


@compiled
def least_sum(x: int, y: int, ticks: int) -> int:
    """The least sum of the terms of that many ticks whose differences have the sum (x, y).

    By the triangle inequality 2^16 times the length of (x, y) is no more than the sum of what the terms round, and each
    is less than 1 below that. The length is at least |x|, |y|, and (|x| + |y|) * 181 / 256, as that is below the root
    of 1/2. Where terms are not split, |x| and |y| together are below 2^45.
    """
    length = max(abs(x), abs(y), (abs(x) + abs(y)) * 181 >> 8)
    return max((length << 16) - ticks, 0)


@compiled
def distance_below(state: State, one: int, other: int, best: Mean) -> Mean:
    """The distance of two plans, or any larger one than the best if theirs is.

    Walks over both plans' visits, not over ticks, and stops as soon as the sum of the first terms, with the least sum
    of the others, is too large.
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
    x, y = difference(state, one, other, first, end)  # from the tick on
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
        x -= (until - tick) * dx
        y -= (until - tick) * dy
        if high + (least_sum(x, y, end - until) if split == 0 else 0) >= limit:
            return Mean(best.whole + 1, 0, 1)
        tick = until
        if i < i_end and records.enter[i] == tick:
            here = int(records.resource[i])
            i += 1
        if j < j_end and records.enter[j] == tick:
            there = int(records.resource[j])
            j += 1
    remainder = ((high % ticks) << split) + low
    return Mean(((high // ticks) << split) + remainder // ticks, remainder % ticks, ticks)


@compiled
def nearest(state: State, work: Work, size: int, count: int) -> int:
    """The position in `outside` of the robot least distant from the members, the first of such; `NONE`: none is left.

    A robot whose plan had ended by now before any was replanned is left alone. The distance of one that is likely to be
    near comes first, which saves most walks.
    """
    likely = likely_nearest(state, work, size, count)
    if likely == NONE:
        return NONE
    best = distance_to_members(state, work, likely, count, Mean(1 << (31 + state.split), 0, 1))
    chosen = likely
    for position in range(size):
        if position == likely or work.ended[work.outside[position]]:
            continue
        mean = distance_to_members(state, work, position, count, best)
        if is_less(mean, best) or (position < chosen and not is_less(best, mean)):
            best = mean
            chosen = position
    return chosen


@inlined
def distance_to_members(state: State, work: Work, position: int, count: int, best: Mean) -> Mean:
    """The distance of the robot at that position outside from the nearest member, or a larger one than the best."""
    own = int(work.trajectories[work.outside[position]])
    least = Mean(best.whole + 1, 0, 1)
    for member in range(count):
        other = int(work.trajectories[work.members[member]])
        if not is_apart(state, own, other, best.whole):
            mean = distance_below(state, own, other, best)
            if is_less(mean, least):
                least = mean
    return least


@compiled
def likely_nearest(state: State, work: Work, size: int, count: int) -> int:
    """The position of the robot that is nearest to the newest member by start, goal and first tick; `NONE`: none."""
    likely = NONE
    least = NEVER << 3
    b = state.records.spots[int(work.trajectories[work.members[count - 1]])]
    for position in range(size):
        robot = int(work.outside[position])
        if work.ended[robot]:
            continue
        a = state.records.spots[int(work.trajectories[robot])]
        away = abs(int(a[4]) - int(b[4])) + abs(int(a[5]) - int(b[5]))
        away += abs(int(a[6]) - int(b[6])) + abs(int(a[7]) - int(b[7])) + abs(int(a[0]) - int(b[0]))
        if away < least:
            least = away
            likely = position
    return likely
