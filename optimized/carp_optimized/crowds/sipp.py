"""The earliest path of one robot between the stays of others: SIPP (Phillips and Likhachev 2011).

A gap between two stays of a resource is a safe interval. Gap k of a resource comes before its stay k, so it is known by
the place of that stay in the arrays. A robot that reaches a gap earlier can do all that one who comes later can, so the
earliest arrival in each gap is enough. Arrivals are looked at in the order of the ticks at which they could reach the
goal, and the latest found first among equals: with steps of one tick these bounds are small whole numbers, so they have
buckets. A greedy query adds a share of the way that is left (weighted A*, Pohl 1970). Its paths are later, but it looks
at far fewer gaps where robots wait for each other, as no bound knows of waits.

Of paths that arrive equally early, the order of the edges chooses one. A turn of that order chooses another.

Parked robots never leave. So no arrival is earlier than the last stay in the goal ends, which is known at the start.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.cut_off import Back, is_cut_off, no_back
from carp_optimized.crowds.stays import Paths, Stays, end_of, later_than
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, IntTable, Longs
from carp_optimized.state.arrays import NEVER, NONE

BUCKETS = 1 << 15
"""Paths that arrive later than the first bound by more ticks than this are not found."""
PLACES = 7
"""Places that differ in these bits have their edges turned by other bits of the turn."""
GENERATION, LABELS, LEAST, TOP, EXPANDED, TURN, GREED, EFFORT = range(8)  # the counts
MARK, ARRIVE, BEFORE, PAID = range(4)
"""What is known of a gap that is reached, side by side: on large maps it takes longer to fetch it than to use it."""
MANY = 256
"""The gaps after which a query asks whether its goal is cut off."""
WHOLE = 16
"""The greed of a query that adds the whole way that is left."""
UNTIL_FOUND = 1 << 60
"""The gaps that a query looks at if it gives up only when there are no more."""


class Query(NamedTuple):
    """The scratch of a query: for each gap the arrival and the gap before, if it is marked; and the labels by bound.

    The buckets with labels are among those from `counts[LEAST]` to `counts[TOP]`. `PAID` is for soft queries alone.
    """

    reached: IntTable
    head: Ints
    gap: Ints
    tick: Ints
    later: Ints
    back: Back
    counts: Longs


def no_query(stays: Stays) -> Query:
    """The scratch for these rows."""
    return query_of(stays.enter.size, 4 * stays.enter.size)


def query_of(gaps: int, labels: int) -> Query:
    """The scratch for so many gaps and labels."""
    return Query(
        reached=np.zeros((gaps, 4), np.int32),
        head=np.full(BUCKETS, NONE, np.int32),
        gap=np.empty(labels, np.int32),
        tick=np.empty(labels, np.int32),
        later=np.empty(labels, np.int32),
        back=no_back(),
        counts=np.array([0, 0, 0, 0, 0, 0, 0, UNTIL_FOUND], np.int64),
    )


@compiled
def find_path(crowd: Crowd, stays: Stays, query: Query, robot: int, latest: int, paths: Paths, row: int) -> bool:
    """Write a path into the row, without greed the earliest one; `False` if none by the tick `latest` is found."""
    start = int(crowd.start[robot])
    goal = int(crowd.goal[robot])
    first = int(stays.first[start])
    if stays.size[start] > 0 and stays.enter[first] == 0:
        return False
    least = int(crowd.distance[robot][start])
    if crowd.parks and stays.size[goal] > 0:
        least = max(least, int(stays.leave[int(stays.first[goal]) + int(stays.size[goal]) - 1]))
    if least > latest:
        return False
    latest = min(latest, least + BUCKETS - 1)
    begin(query)
    reach(query, first, 0, NONE, bucket_of(query, 0, int(crowd.distance[robot][start])))
    found = NONE
    asks = query.counts[EXPANDED] + MANY
    most = query.counts[EXPANDED] + query.counts[EFFORT] + crowd.distance[robot][start]
    while True:
        label = next_label(query)
        if label == NONE:
            break
        gap = int(query.gap[label])
        if query.reached[gap][ARRIVE] != query.tick[label]:
            continue
        if stays.place[gap] == goal and (not crowd.parks or end_of(stays, gap) == NEVER):
            found = gap
            break
        query.counts[EXPANDED] += 1
        if query.counts[EXPANDED] > most or not expand(crowd, stays, query, robot, gap, least, latest):
            break
        if crowd.parks and query.counts[EXPANDED] == asks and is_cut_off(crowd, stays, query.back, robot, latest):
            break
    clear(query)
    return found != NONE and write_path(stays, query, found, paths, row)


@compiled
def begin(query: Query) -> None:
    """Begin a query without labels."""
    query.counts[GENERATION] += 1
    query.counts[LABELS] = 0
    query.counts[LEAST] = BUCKETS
    query.counts[TOP] = 0


@compiled
def next_label(query: Query) -> int:
    """Take a label out of the first bucket that has one: the one put in last; `NONE` if there is none."""
    while query.counts[LEAST] <= query.counts[TOP]:
        bucket = int(query.counts[LEAST])
        label = int(query.head[bucket])
        if label != NONE:
            query.head[bucket] = query.later[label]
            return label
        query.counts[LEAST] += 1
    return NONE


@compiled
def clear(query: Query) -> None:
    """Leave no labels in the buckets."""
    for k in range(int(query.counts[LEAST]), int(query.counts[TOP]) + 1):
        query.head[k] = NONE


@compiled
def expand(crowd: Crowd, stays: Stays, query: Query, robot: int, gap: int, least: int, latest: int) -> bool:
    """Reach all gaps that one move leads to from this one; `False` if there is no room for that many labels."""
    place = int(stays.place[gap])
    soon = int(query.reached[gap][ARRIVE]) + 1
    until = end_of(stays, gap)
    distance = crowd.distance[robot]
    begin = int(crowd.first[place])
    choices = int(crowd.first[place + 1]) - begin
    turn = turn_at(query, place, choices)
    for k in range(turn, turn + choices):
        target = int(crowd.target[begin + k if k < choices else begin + k - choices])
        rest = int(distance[target])
        if max(soon + rest, least) > latest:
            continue
        first = int(stays.first[target])
        last = first + int(stays.size[target])
        into = first + later_than(stays, target, soon)
        while into <= last:
            free = int(stays.leave[into - 1]) if into > first else 0
            tick = max(soon, free)
            bound = max(tick + rest, least)
            if tick > until or bound > latest:
                break
            end = int(stays.enter[into]) if into < last else NEVER
            # whoever left the target at this tick, and enters the place at it, would swap with the robot
            swaps = into > first and tick == free and tick == until and stays.robot[into - 1] == stays.robot[gap]
            is_marked = query.reached[into][MARK] == query.counts[GENERATION]
            if tick < end and not swaps and (not is_marked or tick < query.reached[into][ARRIVE]):
                if query.counts[LABELS] == query.gap.size:
                    return False
                reach(query, into, tick, gap, bucket_of(query, bound - least, rest))
            into += 1
    return True


@compiled
def turn_at(query: Query, place: int, choices: int) -> int:
    """The edge that comes first in a place from which so many lead."""
    turn = int(query.counts[TURN])
    return 0 if turn == 0 else (turn >> (place & PLACES)) % choices


@compiled
def bucket_of(query: Query, late: int, rest: int) -> int:
    """The bucket of a label whose bound is that late, with so much left of the way; the last one if it is too large."""
    return min(late + int(query.counts[GREED]) * rest // WHOLE, BUCKETS - 1)


@compiled
def reach(query: Query, gap: int, tick: int, before: int, bucket: int) -> None:
    """Note an arrival in a gap."""
    reached = query.reached[gap]
    reached[MARK] = query.counts[GENERATION]
    reached[ARRIVE] = tick
    reached[BEFORE] = before
    label = int(query.counts[LABELS])
    query.counts[LABELS] += 1
    query.gap[label] = gap
    query.tick[label] = tick
    query.later[label] = query.head[bucket]
    query.head[bucket] = label
    query.counts[LEAST] = min(int(query.counts[LEAST]), bucket)
    query.counts[TOP] = max(int(query.counts[TOP]), bucket)


@compiled
def write_path(stays: Stays, query: Query, found: int, paths: Paths, row: int) -> bool:
    """Write the visits that lead to a gap; `False` if they are too many for the row."""
    visits = 0
    gap = found
    while gap != NONE:
        visits += 1
        gap = int(query.reached[gap][BEFORE])
    if visits > paths.place[row].size:
        return False
    paths.size[row] = visits
    gap = found
    while gap != NONE:
        visits -= 1
        paths.place[row][visits] = stays.place[gap]
        paths.enter[row][visits] = query.reached[gap][ARRIVE]
        gap = int(query.reached[gap][BEFORE])
    return True
