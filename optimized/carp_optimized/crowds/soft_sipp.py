"""A path of one robot through the stays of others, where it meets few of them (SIPPS, Li et al. 2022).

A robot may be where another one is, and swap with it, at a price in ticks. So a place's time has parts, gaps and stays
in turn, and a path leads through both. Of the arrivals in a part the one is kept that comes earliest if its price is
added. The search is greedy, as it would look far and wide for a way to meet nobody. All that may miss the best path,
which does no harm: whoever is met is planned again.
"""

from typing import NamedTuple

from carp_optimized.crowds.crowd import FAR, Crowd
from carp_optimized.crowds.sipp import (
    ARRIVE,
    BEFORE,
    EFFORT,
    EXPANDED,
    GENERATION,
    LABELS,
    MARK,
    PAID,
    Query,
    begin,
    bucket_of,
    clear,
    next_label,
    query_of,
    reach,
    turn_at,
)
from carp_optimized.crowds.stays import Paths, Stays, end_of, later_than, robot_at, start_of
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import NEVER, NONE

PRICE = 16
"""The ticks that a robot met is worth, once more for each time that it was met before."""


class SoftQuery(NamedTuple):
    """The scratch of a query: gap 2 k of `labels` is gap k of a place's time, and gap 2 k + 1 is stay k: its parts.

    What is paid are the ticks and prices until the arrival in a part. `met` says how often each robot was met.
    """

    labels: Query
    met: Ints


def no_soft_query(stays: Stays, met: Ints) -> SoftQuery:
    """The scratch for these rows."""
    parts = 2 * stays.enter.size
    return SoftQuery(query_of(parts, 2 * parts), met)


@compiled
def find_soft_path(
    crowd: Crowd, stays: Stays, query: SoftQuery, robot: int, latest: int, paths: Paths, row: int
) -> bool:
    """Write a path that arrives by the tick `latest`; `False` if none is found, or it has too many visits."""
    start = int(crowd.start[robot])
    goal = int(crowd.goal[robot])
    labels = query.labels
    begin(labels)
    most = labels.counts[EXPANDED] + labels.counts[EFFORT]
    least = int(crowd.distance[robot][start])
    reach_part(query, 2 * int(stays.first[start]), 0, 0, NONE, least, least)
    found = NONE
    while True:
        label = next_label(labels)
        if label == NONE:
            break
        part = int(labels.gap[label])
        if labels.reached[part][MARK] < 0:
            continue
        if stays.place[part // 2] == goal and (not crowd.parks or part == last_part(stays, goal)):
            found = part
            break
        labels.counts[EXPANDED] += 1
        reached = labels.reached[part]
        reached[MARK] = -reached[MARK]  # a later arrival of less price would come after those that follow
        if labels.counts[EXPANDED] > most or not expand_part(crowd, stays, query, robot, part, least, latest):
            break
    clear(labels)
    return found != NONE and write_soft_path(stays, query, found, paths, row)


@compiled
def last_part(stays: Stays, place: int) -> int:
    """The gap after all stays."""
    return 2 * (int(stays.first[place]) + int(stays.size[place]))


@compiled
def start_of_part(stays: Stays, part: int) -> int:
    """The tick at which a part of a place's time begins."""
    return int(stays.enter[part // 2]) if part % 2 == 1 else start_of(stays, part // 2)


@compiled
def end_of_part(stays: Stays, part: int) -> int:
    """The tick at which a part of a place's time ends."""
    return int(stays.leave[part // 2]) if part % 2 == 1 else end_of(stays, part // 2)


@compiled
def price_of(stays: Stays, query: SoftQuery, part: int) -> int:
    """What it costs to be there."""
    return worth_of(query, int(stays.robot[part // 2])) if part % 2 == 1 else 0


@compiled
def price_of_move(stays: Stays, query: SoftQuery, place: int, target: int, tick: int) -> int:
    """What it costs to meet whoever makes the opposite move at the tick."""
    other = robot_at(stays, target, tick - 1)
    return worth_of(query, other) if other != NONE and robot_at(stays, place, tick) == other else 0


@compiled
def worth_of(query: SoftQuery, robot: int) -> int:
    """What it costs to meet a robot."""
    return PRICE * (1 + int(query.met[robot]))


@compiled
def expand_part(crowd: Crowd, stays: Stays, query: SoftQuery, robot: int, part: int, least: int, latest: int) -> bool:
    """Reach the next part, and all those to which a move leads; `False` if there is no room for that many labels."""
    place = int(stays.place[part // 2])
    distance = crowd.distance[robot]
    reached = query.labels.reached[part]
    soon = int(reached[ARRIVE]) + 1
    price = int(reached[PAID]) - int(reached[ARRIVE])
    until = end_of_part(stays, part)
    if until < NEVER and (until + int(distance[place]) <= latest or distance[place] == 0):
        paid = until + price + price_of(stays, query, part + 1)
        reach_part(query, part + 1, until, paid, part, int(distance[place]), least)
    first = int(crowd.first[place])
    choices = int(crowd.first[place + 1]) - first
    turn = turn_at(query.labels, place, choices)
    for k in range(turn, turn + choices):
        target = int(crowd.target[first + k if k < choices else first + k - choices])
        rest = int(distance[target])
        if soon + rest > latest:
            continue
        into = part_at(stays, target, soon)
        last = last_part(stays, target) if rest < FAR else NONE
        while into <= last:
            tick = max(soon, start_of_part(stays, into))
            if tick > until or tick + rest > latest:
                break
            if query.labels.counts[LABELS] + 1 >= query.labels.gap.size:
                return False
            if tick < end_of_part(stays, into):
                paid = tick + price + price_of(stays, query, into)
                if tick == until:  # only then can another enter the place
                    paid += price_of_move(stays, query, place, target, tick)
                reach_part(query, into, tick, paid, part, rest, least)
            into += 1
    return True


@compiled
def part_at(stays: Stays, place: int, tick: int) -> int:
    """The part of a place's time in which the tick is."""
    k = int(stays.first[place]) + later_than(stays, place, tick)
    return 2 * k - 1 if k > stays.first[place] and stays.leave[k - 1] > tick else 2 * k


@compiled
def reach_part(query: SoftQuery, part: int, tick: int, paid: int, before: int, rest: int, least: int) -> None:
    """Note an arrival in a part, unless that was left, or has one that is as good."""
    reached = query.labels.reached[part]
    mark = int(reached[MARK])
    now = int(query.labels.counts[GENERATION])
    if mark != -now and (mark != now or paid < reached[PAID]):
        reached[PAID] = paid
        bucket = bucket_of(query.labels, paid + rest - least, rest)
        reach(query.labels, part, tick, before, bucket)


@compiled
def write_soft_path(stays: Stays, query: SoftQuery, found: int, paths: Paths, row: int) -> bool:
    """Write the visits that lead to a part; `False` if they are too many for the row."""
    visits = 0
    part = found
    while part != NONE:
        before = int(query.labels.reached[part][BEFORE])
        visits += before == NONE or stays.place[before // 2] != stays.place[part // 2]
        part = before
    if visits > paths.place[row].size:
        return False
    paths.size[row] = visits
    part = found
    while part != NONE:
        before = int(query.labels.reached[part][BEFORE])
        if before == NONE or stays.place[before // 2] != stays.place[part // 2]:
            visits -= 1
            paths.place[row][visits] = stays.place[part // 2]
            paths.enter[row][visits] = query.labels.reached[part][ARRIVE]
        part = before
    return True
