"""The floor: which resources are points and which are lanes, and the shape that a vehicle sweeps in each.

Nothing but positions and edges is read. Resources at one position that edges join, such as the headings of a point, are
one place. A place that is joined to two others and lies at their middle may be a lane. Those that may not are points;
what is joined to a point is a lane, and what is joined to a lane is a point. So all kinds are known, because the places
of a part of the graph cannot all lie at the middle of two others.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

from carp_spec import ResourceId
from carp_spec.model import ResourceGraph
from carp_spec.refusal import Refusal
from carp_verify.footprint.rules import all_have_positions, lanes_lie_between_points

Spot = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Shape:
    """What the middle of a vehicle sweeps, from one end to the other; it looks along `heading`, or turns (`None`)."""

    start: Spot
    end: Spot
    heading: Spot | None


def shapes(graph: ResourceGraph) -> Mapping[ResourceId, Shape]:
    """The shape of each resource; those of one place share one. Raises `Refusal` where there is none."""
    spot = spots_of(graph)
    place = _places(graph, spot)
    beside: dict[ResourceId, dict[ResourceId, None]] = {each: {} for each in place.values()}
    for one, two in graph.edges:
        if place[one] != place[two]:
            beside[place[one]][place[two]] = None
            beside[place[two]][place[one]] = None
    lanes = _lanes(beside, spot)
    right = [
        (one, two, place[one] == place[two] or (place[one] in lanes) != (place[two] in lanes))
        for one, two in graph.edges
    ]
    for fault in lanes_lie_between_points(right):
        raise Refusal("document", fault.path, fault.rule, fault.message)
    made = {each: _lane(*(spot[end] for end in beside[each])) for each in lanes}
    points = [each for each in beside if each not in lanes]
    made |= {each: _point(spot[each], [made[lane].heading or (0, 0) for lane in beside[each]]) for each in points}
    return {each: made[place[each]] for each in spot}


def spots_of(graph: ResourceGraph) -> Mapping[ResourceId, Spot]:
    """The position of each resource; raises `Refusal` for one without."""
    for fault in all_have_positions(graph.resources):
        raise Refusal("document", fault.path, fault.rule, fault.message)
    return {each.id: (each.x or 0, each.y or 0) for each in graph.resources}


def _places(graph: ResourceGraph, spot: Mapping[ResourceId, Spot]) -> dict[ResourceId, ResourceId]:
    """The first resource of the place of each one."""
    joined: dict[ResourceId, list[ResourceId]] = {each: [] for each in spot}
    for one, two in graph.edges:
        if spot[one] == spot[two]:
            joined[one].append(two)
            joined[two].append(one)
    place: dict[ResourceId, ResourceId] = {}
    for first in spot:
        found = [] if first in place else [first]
        while found:
            each = found.pop()
            if each not in place:
                place[each] = first
                found += joined[each]
    return place


def _lanes(beside: Mapping[ResourceId, Mapping[ResourceId, None]], spot: Mapping[ResourceId, Spot]) -> set[ResourceId]:
    """The lanes: neighbours of points, from those on that can be nothing else."""
    points = [each for each, others in beside.items() if not _is_in_the_middle(spot[each], [spot[o] for o in others])]
    known, lanes = set(points), set[ResourceId]()
    for point in points:
        new = [each for each in beside[point] if each not in known]
        lanes.update(new)
        ends = dict.fromkeys(end for lane in new for end in beside[lane] if end not in known and end not in lanes)
        known.update(new, ends)
        points += ends
    return lanes


def _is_in_the_middle(spot: Spot, ends: list[Spot]) -> bool:
    return len(ends) == 2 and all(2 * at <= a + b <= 2 * at + 1 for at, a, b in zip(spot, *ends, strict=True))  # noqa: PLR2004


def _lane(start: Spot, end: Spot) -> Shape:
    return Shape(start, end, (end[0] - start[0], end[1] - start[1]))


def _point(spot: Spot, ways: list[Spot]) -> Shape:
    turns = any(a * d != b * c for (a, b), (c, d) in pairwise(ways))
    return Shape(spot, spot, None if turns or not ways else ways[0])
