"""How far it is to the goals of a crowd: measured, or estimated by landmarks where there is no time to measure.

If a landmark is so many steps nearer to the goal than to a place, the goal is at least so far from that place
(Goldberg and Harrelson 2005); where all moves lead both ways, the same holds the other way round. The greatest of these
bounds is what A* needs of a distance: it never says too much, and differs by at most one between neighbours. On a full
grid it is right. In a warehouse it is too low for 1 % of the places, in towns and rooms by 0.5 to 4 % on average, and
robots that follow it get stuck where no neighbour seems nearer to the goal.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import FAR, Crowd, crowd_at
from carp_optimized.jit.compiling import entry
from carp_optimized.jit.kinds import Ints, ShortTable
from carp_optimized.jit.references import Native, dereference

LANDMARKS = 8  # places far apart: the distances to them bound all others from below
RIGHT = 0.999
"""The share of estimates that are right where they serve as well as distances."""
PART = 32
"""The robots whose distances are measured or estimated before a clock is looked at."""


@entry
def measure(native: Native[Crowd], order: Ints, begin: int, end: int) -> None:
    """Measure the distances of the robots `order[begin:end]`, by breadth-first search from their goals."""
    crowd = crowd_at(native)
    queue = crowd.queue
    for number in range(begin, end):
        robot = int(order[number])
        distance = crowd.distance[robot]
        for resource in range(queue.size):
            distance[resource] = FAR
        queue[0] = crowd.goal[robot]
        distance[int(crowd.goal[robot])] = 0
        size = 1
        k = 0
        while k < size:
            place = int(queue[k])
            k += 1
            further = int(distance[place]) + 1
            if further == FAR:
                break
            for edge in range(int(crowd.backward_first[place]), int(crowd.backward_first[place + 1])):
                source = int(crowd.source[edge])
                if distance[source] == FAR:
                    distance[source] = further
                    queue[size] = source
                    size += 1


class Landmarks(NamedTuple):
    """The distances to some places; `back` is 1 where all moves lead both ways, else 0."""

    remote: ShortTable
    back: int


landmarks_at = dereference(Landmarks)


@entry
def estimate(landmarks: Native[Landmarks], native: Native[Crowd], order: Ints, begin: int, end: int) -> None:
    """Estimate the distances of the robots `order[begin:end]`.

    Nothing is known of places that are not connected to the first landmark: they count as too far away.
    """
    crowd = crowd_at(native)
    marks = landmarks_at(landmarks)
    back = marks.back
    size = crowd.queue.size
    outside = marks.remote[0]
    for number in range(begin, end):
        robot = int(order[number])
        goal = int(crowd.goal[robot])
        distance = crowd.distance[robot]
        for resource in range(size):
            distance[resource] = 0
        for mark in range(LANDMARKS):
            remote = marks.remote[mark]
            for resource in range(size):  # in numbers of 16 bits, of which a processor handles many at once
                nearer = np.int16(remote[resource] - remote[goal])
                distance[resource] = max(np.int16(distance[resource]), nearer, np.int16(-back * nearer))
        for resource in range(size):
            if outside[resource] == FAR or outside[goal] == FAR:
                distance[resource] = FAR


def are_right(crowd: Crowd, landmarks: Landmarks) -> bool:
    """Whether estimates are right for nearly all places and the first robots, whose distances are measured."""
    first = crowd.distance[:PART]
    measured = first.copy()
    robots = np.arange(len(first), dtype=np.int32)
    estimate(Native(landmarks), Native(crowd), robots, 0, robots.size)
    share = np.mean(first == measured)
    first[:] = measured
    return bool(share >= RIGHT)


def near(crowd: Crowd, landmarks: Landmarks) -> Ints:
    """About how far each robot has to go: the most by which its places differ in the distance to some landmark."""
    remote = landmarks.remote.astype(np.int32)
    found: Ints = np.abs(remote[:, crowd.start] - remote[:, crowd.goal]).max(axis=0)
    return found


def landmarks_of(crowd: Crowd) -> Landmarks:
    """Places that are far from each other, and from the goal of the first robot."""
    goal = np.zeros(1 + LANDMARKS, np.int32)
    if crowd.goal.size > 0:
        goal[0] = crowd.goal[0]
    found = crowd._replace(start=0 * goal, goal=goal, distance=np.empty((goal.size, crowd.queue.size), np.int16))
    native, order = Native(found), np.arange(goal.size, dtype=np.int32)
    measure(native, order, 0, 1)
    for mark in range(1, goal.size):
        least = found.distance[min(1, mark - 1) : mark].min(axis=0)
        goal[mark] = np.argmax(np.where(least < FAR, least, -1))
        measure(native, order, mark, mark + 1)
    leads_back = np.array_equal(crowd.first, crowd.backward_first) and np.array_equal(crowd.target, crowd.source)
    return Landmarks(found.distance[1:], int(leads_back))
