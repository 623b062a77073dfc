"""The nearest robot (`neighbourhood/distance`, `neighbourhood/nearest`), exactly and without summing all distances.

The mean distance of two robots is a sum of terms divided by a number of ticks. To fit in 64 bits, each term is split
into `term >> split` and the rest, and the two are summed apart; `split` is 0 for all but huge coordinates.
"""

import math
from typing import NamedTuple

from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.state.arrays import NEVER, NONE, State, Work


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


@inlined
def summed(first: int, end: int, sums: int, starts: int, goals: int) -> int:
    """The sum of the differences of two plans' places in x, or in y, at all ticks from `first` to before `end`.

    Given are the differences of what `Records.spots` holds of them. Neither plan begins before the first, nor arrives
    at the end or later.
    """
    return sums + goals * end - starts * first


@compiled
def difference(state: State, one: int, other: int, first: int, end: int) -> tuple[int, int]:
    """That sum in x, and in y."""
    a = state.records.spots[one]
    b = state.records.spots[other]
    x = summed(first, end, int(a[2]) - int(b[2]), int(a[4]) - int(b[4]), int(a[6]) - int(b[6]))
    y = summed(first, end, int(a[3]) - int(b[3]), int(a[5]) - int(b[5]), int(a[7]) - int(b[7]))
    return x, y


@inlined
def are_apart(x: int, y: int, ticks: int, whole: int) -> bool:
    """Whether the mean positions of two plans alone show that their distance is at least whole + 1.

    The mean of distances is no less than the distance of the means, and each term is less than 1 below what it rounds.
    Both sides are multiplied by the ticks, and do not count where their squares might not fit.
    """
    limit = ((whole + 2) * ticks >> 16) + 1
    return (max(abs(x), abs(y), limit) < 1 << 31) & (x * x + y * y >= limit * limit)


@compiled
def is_apart(state: State, one: int, other: int, whole: int) -> bool:
    """The same of two plans; never where terms are split."""
    a = state.records.spots[one]
    b = state.records.spots[other]
    first = min(int(a[0]), int(b[0]))
    end = max(int(a[1]), int(b[1])) + 1
    x, y = difference(state, one, other, first, end)
    return state.split == 0 and are_apart(x, y, end - first, whole)


@compiled
def mark_near(state: State, work: Work, record: int, whole: int) -> None:
    """Mark as near the robots whose trajectories are not apart from a plan; without a branch, for several at once."""
    b = state.records.spots[record]
    first_tick = int(b[0])
    arrival = int(b[1])
    sum_x, sum_y, start_x, start_y, goal_x, goal_y = int(b[2]), int(b[3]), int(b[4]), int(b[5]), int(b[6]), int(b[7])
    spots = work.spots
    first_ticks, arrivals = spots[0], spots[1]
    sums_x, sums_y, starts_x, starts_y, goals_x, goals_y = spots[2], spots[3], spots[4], spots[5], spots[6], spots[7]
    near = work.near
    for robot in range(near.size):
        first = min(int(first_ticks[robot]), first_tick)
        end = max(int(arrivals[robot]), arrival) + 1
        start = int(starts_x[robot]) - start_x
        x = summed(first, end, int(sums_x[robot]) - sum_x, start, int(goals_x[robot]) - goal_x)
        start = int(starts_y[robot]) - start_y
        y = summed(first, end, int(sums_y[robot]) - sum_y, start, int(goals_y[robot]) - goal_y)
        near[robot] |= 1 - int(are_apart(x, y, end - first, whole))


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
    near comes first. Those of most others need no walk: what is apart by more than that distance is so by more than any
    smaller one. Where terms are split, all count as near.
    """
    likely = likely_nearest(state, work, size, count)
    if likely == NONE:
        return NONE
    best = distance_to_members(state, work, likely, count, Mean(1 << (31 + state.split), 0, 1))
    chosen = likely
    for robot in range(work.near.size):
        work.near[robot] = state.split
    if state.split == 0:
        for member in range(count):
            mark_near(state, work, int(work.trajectories[work.members[member]]), best.whole)
    for position in range(size):
        robot = int(work.outside[position])
        if work.near[robot] == 0 or work.ended[robot] or position == likely:
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
    b = state.records.spots[int(work.trajectories[work.members[count - 1]])]
    first_tick, start_x, start_y, goal_x, goal_y = int(b[0]), int(b[4]), int(b[5]), int(b[6]), int(b[7])
    spots = work.spots
    first_ticks, starts_x, starts_y, goals_x, goals_y = spots[0], spots[4], spots[5], spots[6], spots[7]
    away = work.away
    for robot in range(away.size):
        start = abs(int(starts_x[robot]) - start_x) + abs(int(starts_y[robot]) - start_y)
        goal = abs(int(goals_x[robot]) - goal_x) + abs(int(goals_y[robot]) - goal_y)
        away[robot] = start + goal + abs(int(first_ticks[robot]) - first_tick)
    likely = NONE
    least = NEVER << 3
    for position in range(size):
        robot = int(work.outside[position])
        if away[robot] < least and not work.ended[robot]:
            least = int(away[robot])
            likely = position
    return likely


@compiled
def follow(state: State, work: Work, robot: int, record: int) -> None:
    """Make a plan the robot's trajectory, by which distances are measured."""
    if work.trajectories[robot] != record:
        work.trajectories[robot] = record
        for k in range(8):
            work.spots[k][robot] = state.records.spots[record][k]
