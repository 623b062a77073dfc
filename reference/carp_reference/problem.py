"""The data that a planner has before any committed plan."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

from carp_spec import Instance, Plan, ResourceId, Robot, RobotId

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class Problem:
    """An instance, the h of each robot's A*, the tick at which it is planned, and the plans followed until then.

    `ticks_to_goal[robot][served][resource]` is the least number of ticks from entering the resource, with so many stops
    served, to entering the goal on the empty graph, if a way over the other stops leads there. Visits of `before`
    entered by the tick `now` are kept (`fleet/history`).
    """

    instance: Instance
    ticks_to_goal: Mapping[RobotId, Sequence[Mapping[ResourceId, int]]]
    now: int
    before: Mapping[RobotId, Plan] = field(default_factory=dict)


def prepare(instance: Instance, now: int) -> Problem:
    """Compute the distances over every robot's stops to its goal."""
    return Problem(instance, {robot.id: ticks_to_goal(instance, robot) for robot in instance.robots}, now)


def ticks_to_goal(instance: Instance, robot: Robot) -> Sequence[Mapping[ResourceId, int]]:
    """The ticks to the next stop, and what its service takes longer than the duration, and so on to the goal."""
    tables = [ticks_to(instance, robot, robot.goal)]
    for stop in reversed(robot.stops[:-1]):
        longer = instance.stay(robot.id, stop) - instance.duration(robot.id, stop.resource)
        rest = tables[0].get(stop.resource)
        to_stop = {} if rest is None else ticks_to(instance, robot, stop.resource)
        tables.insert(0, {place: ticks + longer + (rest or 0) for place, ticks in to_stop.items()})
    return tables


def ticks_to(instance: Instance, robot: Robot, place: ResourceId) -> Mapping[ResourceId, int]:
    """Dijkstra backwards from a place; the cost of a move is the time in the resource that it leaves."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    ticks = nx.single_source_dijkstra_path_length(backward_graph(instance, robot), place, weight="ticks")
    return cast("dict[ResourceId, int]", ticks)  # sums of ints


def backward_graph(instance: Instance, robot: Robot) -> "nx.DiGraph[ResourceId]":
    """The moves backwards, each with the ticks that the robot takes in the resource that it leaves."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    backward: nx.DiGraph[ResourceId] = nx.DiGraph()
    backward.add_nodes_from(instance.graph.index)
    for source, targets in instance.graph.successors.items():
        for target in targets:
            backward.add_edge(target, source, ticks=instance.duration(robot.id, source))
    return backward
