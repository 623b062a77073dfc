"""Tells the lanes of an instance from its points: an instance calls both resources."""

from collections.abc import Mapping

from carp_spec import Instance, ResourceId


def lanes_of(instance: Instance) -> Mapping[ResourceId, tuple[ResourceId, ResourceId]]:
    """The lanes, each with the points between which it leads. Instances of layouts have the lanes of the layout.

    A lane has one resource before it and another after it, neither of which is a lane, and no robot starts or stops on
    it. Where a resource may be a lane and its neighbour too, the later one in the order of the graph is.
    """
    graph = instance.graph
    before: dict[ResourceId, list[ResourceId]] = {each.id: [] for each in graph.resources}
    for source, targets in graph.successors.items():
        for target in targets:
            before[target].append(source)
    points = {place for robot in instance.robots for place in (robot.start, *(stop.resource for stop in robot.stops))}
    lanes: dict[ResourceId, tuple[ResourceId, ResourceId]] = {}
    for each in reversed(graph.resources):
        ends = {*before[each.id], *graph.successors[each.id]}
        leads = len(before[each.id]) == len(graph.successors[each.id]) == 1 and len(ends) > 1
        if leads and each.id not in points and ends.isdisjoint(lanes):
            lanes[each.id] = (before[each.id][0], graph.successors[each.id][0])
    return lanes
