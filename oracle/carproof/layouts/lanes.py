"""Tells the lanes of an instance from its points: an instance calls both resources."""

from collections.abc import Mapping

from carp_spec import Instance, ResourceGraph, ResourceId


def lanes_of(instance: Instance) -> Mapping[ResourceId, tuple[ResourceId, ResourceId]]:
    """The lanes, each with the points between which it leads; none if the graph is no plant of points and lanes.

    A lane has one resource before it and another after it, neither of which is a lane; it is at their middle, if they
    have positions, and no robot starts or stops on it. Where a resource and its neighbour may be lanes, the later one
    in the order of the graph is. In a plant every move enters or leaves a lane, or stays within a group of capacity 1.
    Instances of layouts have the lanes of the layout.
    """
    graph = instance.graph
    before: dict[ResourceId, list[ResourceId]] = {each.id: [] for each in graph.resources}
    for source, targets in graph.successors.items():
        for target in targets:
            before[target].append(source)
    points = {place for robot in instance.robots for place in (robot.start, *(stop.resource for stop in robot.stops))}
    lanes: dict[ResourceId, tuple[ResourceId, ResourceId]] = {}
    for each in reversed(graph.resources):
        sources, targets = before[each.id], graph.successors[each.id]
        if len(sources) == len(targets) == 1 and each.id not in points:
            ends = (sources[0], targets[0])
            if ends[0] != ends[1] and lanes.keys().isdisjoint(ends) and _is_between(graph, each.id, ends):
                lanes[each.id] = ends
    between = (move for move in graph.moves if lanes.keys().isdisjoint(move))
    return lanes if all(graph.are_close(*move) for move in between) else {}


def _is_between(graph: ResourceGraph, lane: ResourceId, ends: tuple[ResourceId, ResourceId]) -> bool:
    """Whether the lane is at the middle of its ends, rounded down, or none of them has a position."""
    here, one, two = (graph.resource[each] for each in (lane, *ends))
    if here.x is None or here.y is None or one.x is None or one.y is None or two.x is None or two.y is None:
        return all(each.x is None for each in (here, one, two))
    return (here.x, here.y) == ((one.x + two.x) // 2, (one.y + two.y) // 2)
