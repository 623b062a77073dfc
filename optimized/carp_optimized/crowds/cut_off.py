"""Whether a goal is cut off: parked robots enclose it before the robot can be there.

A query without a path looks at all gaps that the robot can reach, which are many where there is much room. The gaps
from which it could still reach its goal are often few then. So a search goes back from the goal. Of each gap it keeps
the latest tick at which the robot may be there. If it ends before it comes to the start, no path leads to the goal.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.stays import Stays, end_of, start_of
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints

FEW = 64
"""The gaps after which the search gives up."""


class Back(NamedTuple):
    """The scratch of a search: gaps, the latest tick in each, and whether it is still to be looked at."""

    gap: Ints
    latest: Ints
    waits: Ints


def no_back() -> Back:
    """The scratch of a search."""
    return Back(*(np.empty(FEW, np.int32) for _ in range(3)))


@compiled
def is_cut_off(crowd: Crowd, stays: Stays, back: Back, robot: int, latest: int) -> bool:
    """Whether few gaps lead to the parking place by the tick `latest`, and the start is not among them."""
    start = int(stays.first[int(crowd.start[robot])])
    goal = int(crowd.goal[robot])
    size = note(back, 0, int(stays.first[goal]) + int(stays.size[goal]), latest)
    at = 0
    while at < size:
        if back.waits[at] == 0:
            at += 1
            continue
        back.waits[at] = 0
        place = int(stays.place[back.gap[at]])
        for edge in range(int(crowd.backward_first[place]), int(crowd.backward_first[place + 1])):
            size = go_back(crowd, stays, back, size, at, robot, int(crowd.source[edge]))
            if size == FEW:
                return False
        at = 0
    return note(back, size, start, latest) > size


@compiled
def go_back(crowd: Crowd, stays: Stays, back: Back, size: int, at: int, robot: int, source: int) -> int:
    """Note the gaps of a place from which the robot can come into the gap `at` in time; how many are noted then.

    Its way to any place is at least what its whole way is longer than that from there to its goal.
    """
    into = int(back.gap[at])
    begins = start_of(stays, into)
    way = int(crowd.distance[robot][int(crowd.start[robot])]) - int(crowd.distance[robot][source])
    gap = int(stays.first[source]) + int(stays.size[source])
    while gap >= stays.first[source] and end_of(stays, gap) >= begins and size < FEW:
        moves = min(end_of(stays, gap), int(back.latest[at]))
        if moves >= begins and moves > max(start_of(stays, gap), way):
            size = note(back, size, gap, moves - 1)
        gap -= 1
    return size


@compiled
def note(back: Back, size: int, gap: int, latest: int) -> int:
    """Note that the robot may be in the gap at the tick, unless a later one is noted; how many gaps are noted then."""
    k = 0
    while k < size and back.gap[k] != gap:
        k += 1
    if k == size or latest > back.latest[k]:
        back.gap[k] = gap
        back.latest[k] = latest
        back.waits[k] = 1
    return max(size, k + 1)
