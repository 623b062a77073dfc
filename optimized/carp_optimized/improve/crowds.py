"""Robots that all move a step a tick (classical multi-agent path finding), as flat arrays of ints.

Resources and robots are their indices in the instance. The graph is that of `carp_optimized.state.arrays`, reduced to
what a step takes; the distances are the least ticks from each resource to the goal of each robot.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.jit.compiling import entry
from carp_optimized.jit.kinds import Ints, IntTable
from carp_optimized.jit.references import Native, dereference
from carp_optimized.state.encoding import encode_graph
from carp_spec import Instance

GONE = -1
"""The place of a robot that has vanished."""


class Crowd(NamedTuple):
    """Moves lead from r to `target[first[r]:first[r + 1]]`, and come to it from `source[backward_first[r]:...]`.

    `distance[robot][r]` is the number of resources where the goal cannot be reached: more than any distance.
    """

    first: Ints
    target: Ints
    backward_first: Ints
    source: Ints
    start: Ints
    goal: Ints
    distance: IntTable
    queue: Ints
    parks: bool


crowd_at = dereference(Crowd)


def is_stepwise(instance: Instance) -> bool:
    """Whether all robots are there from tick 0, and each needs one tick and a place of its own."""
    return (
        instance.following == "allowed"
        and all(each.capacity == 1 and each.duration == 1 for each in instance.graph.resources)
        and all(each.release == 0 and each.pace == 1 for each in instance.robots)
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
        np.empty((len(instance.robots), resources), np.int32),
        np.empty(resources, np.int32),
        instance.after_goal == "park",
    )


def can_begin(crowd: Crowd) -> bool:
    """Whether no two robots start in one place, or park in one, and each has a way to its goal; after `measure`."""
    robots = crowd.start.size
    far = crowd.queue.size
    has_ways = all(int(crowd.distance[robot, crowd.start[robot]]) < far for robot in range(robots))
    goals_differ = not crowd.parks or np.unique(crowd.goal).size == robots
    return has_ways and goals_differ and np.unique(crowd.start).size == robots


@entry
def measure(native: Native[Crowd], begin: int, end: int) -> None:
    """Measure the distances of these robots, by breadth-first search from their goals."""
    crowd = crowd_at(native)
    queue = crowd.queue
    far = queue.size
    for robot in range(begin, end):
        distance = crowd.distance[robot]
        for resource in range(far):
            distance[resource] = far
        queue[0] = crowd.goal[robot]
        distance[int(crowd.goal[robot])] = 0
        size = 1
        k = 0
        while k < size:
            place = int(queue[k])
            k += 1
            further = int(distance[place]) + 1
            for edge in range(int(crowd.backward_first[place]), int(crowd.backward_first[place + 1])):
                source = int(crowd.source[edge])
                if distance[source] == far:
                    distance[source] = further
                    queue[size] = source
                    size += 1
