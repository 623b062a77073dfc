"""Robots that all move a step a tick (classical multi-agent path finding), as flat arrays of ints.

Resources and robots are their indices in the instance. The graph is that of `carp_optimized.state.arrays`, reduced to
what a step takes; the distances are the least ticks from each resource to the goal of each robot.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.jit.kinds import Flags, Ints, ShortTable
from carp_optimized.jit.references import dereference
from carp_optimized.state.encoding import encode_graph
from carp_spec import Instance

GONE = -1
"""The place of a robot that has vanished."""
FAR = 2**15 - 1
"""More than any distance that is measured."""


class Crowd(NamedTuple):
    """Moves lead from r to `target[first[r]:first[r + 1]]`, and come to it from `source[backward_first[r]:...]`.

    `distance[robot][r]` is `FAR` where the goal cannot be reached in fewer ticks. `queue` is scratch.
    """

    first: Ints
    target: Ints
    backward_first: Ints
    source: Ints
    start: Ints
    goal: Ints
    distance: ShortTable
    queue: Ints
    parks: bool


crowd_at = dereference(Crowd)


def is_stepwise(instance: Instance) -> bool:
    """Whether all robots are there from tick 0, and each needs one tick and a place of its own."""
    return (
        instance.following == "allowed"
        and not instance.graph.groups
        and all(each.capacity == 1 and each.duration == 1 for each in instance.graph.resources)
        and all(each.release == 0 and each.pace == 1 and each.has_goal_alone for each in instance.robots)
    )


def crowd_of(instance: Instance) -> Crowd:
    """The robots of an instance that `is_stepwise`; their distances are not measured yet."""
    graph = encode_graph(instance)
    index = instance.graph.index
    resources = graph.duration.size
    return Crowd(
        graph.first,
        graph.target,
        graph.backward_first,
        graph.source,
        np.array([index[each.start] for each in instance.robots], np.int32),
        np.array([index[each.goal] for each in instance.robots], np.int32),
        np.empty((len(instance.robots), resources), np.int16),
        np.empty(resources, np.int32),
        instance.after_goal == "park",
    )


def ways_of(crowd: Crowd) -> Ints:
    """The least ticks that each robot needs, after `measure`."""
    return crowd.distance[np.arange(crowd.start.size), crowd.start].astype(np.int32)


def are_apart(crowd: Crowd) -> Flags:
    """Of each robot, whether none before it starts in its place, or parks in its goal."""
    found = np.zeros(crowd.start.size, np.bool_)
    found[np.unique(crowd.start, return_index=True)[1]] = True
    if crowd.parks:
        rows = np.flatnonzero(found)
        found[:] = False
        found[rows[np.unique(crowd.goal[rows], return_index=True)[1]]] = True
    return found


def can_begin(crowd: Crowd) -> bool:
    """Whether all robots `are_apart` and have ways to their goals; after `measure`."""
    return bool(are_apart(crowd).all() and (ways_of(crowd) < FAR).all())


def first(crowd: Crowd, robots: int) -> Crowd:
    """The first robots of a crowd."""
    return crowd._replace(start=crowd.start[:robots], goal=crowd.goal[:robots], distance=crowd.distance[:robots])


def only(crowd: Crowd, robots: Flags) -> Crowd:
    """Some of the robots of a crowd."""
    if robots.all():
        return crowd
    return crowd._replace(start=crowd.start[robots], goal=crowd.goal[robots], distance=crowd.distance[robots])
