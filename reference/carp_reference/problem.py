"""The data that a planner has before any committed plan."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import cast

from carp_spec import Instance, Plan, ResourceId, Robot, RobotId
from carp_spec.limits import refuse


@dataclass(frozen=True, slots=True)
class Problem:
    """An instance, the h of each robot's A*, the tick at which it is planned, and the plans followed until then.

    `ticks_to_goal[robot][resource]` is the least number of ticks from entering the resource to entering the goal on the
    empty graph, if a way leads there. Visits of `before` entered by the tick `now` are kept (`fleet/history`).
    """

    instance: Instance
    ticks_to_goal: Mapping[RobotId, Mapping[ResourceId, int]]
    now: int
    before: Mapping[RobotId, Plan] = field(default_factory=dict)


def prepare(instance: Instance, now: int) -> Problem:
    """Compute the distances to every robot's goal."""
    return Problem(instance, {robot.id: ticks_to_goal(instance, robot) for robot in instance.robots}, now)


def ticks_to_goal(instance: Instance, robot: Robot) -> Mapping[ResourceId, int]:
    """Dijkstra backwards from the goal; the cost of a move is the time in the resource that it leaves."""
    refuse(instance, "stops")
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    backward: nx.DiGraph[ResourceId] = nx.DiGraph()
    backward.add_nodes_from(instance.graph.index)
    for source, targets in instance.graph.successors.items():
        for target in targets:
            backward.add_edge(target, source, ticks=instance.duration(robot.id, source))
    ticks = nx.single_source_dijkstra_path_length(backward, robot.goal, weight="ticks")
    return cast("dict[ResourceId, int]", ticks)  # sums of ints
