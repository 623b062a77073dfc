"""Plants, whose lanes are drawn as lanes, and groups of resources, which are outlined."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isqrt
from typing import TypeAlias

from carp_spec import Instance, ResourceGraph, ResourceId

Point: TypeAlias = tuple[int, int]
Points: TypeAlias = Mapping[ResourceId, Point]
Way: TypeAlias = tuple[Point, Point]
"""Where a lane begins and ends."""
Lanes: TypeAlias = Mapping[ResourceId, tuple[ResourceId, ResourceId]]

BESIDE = 18
"""Drawing units from a lane to the next one between the same points."""
END = 14
"""Drawing units from a point to the end of a lane, where the lane is long."""
AROUND_POINT, AROUND_LANE = 20, 8
MOST_OUTLINED = 300


def without_lanes(graph: ResourceGraph, lanes: Lanes) -> ResourceGraph:
    """The points, joined where a lane joins them or a move does."""
    points = tuple(each for each in graph.resources if each.id not in lanes)
    moves = (move for move in graph.edges if move[0] not in lanes and move[1] not in lanes)
    return ResourceGraph(points, (*lanes.values(), *moves), directed=True)


def ways_of(points: Points, lanes: Lanes) -> Mapping[ResourceId, Way]:
    """Where lanes are drawn: several between the same points side by side, so that traffic keeps to the right."""
    between: dict[frozenset[ResourceId], list[ResourceId]] = {}
    for id, ends in lanes.items():
        between.setdefault(frozenset(ends), []).append(id)
    ways: dict[ResourceId, Way] = {}
    for together in between.values():
        first = lanes[together[0]]
        beside = sorted(together, key=lambda lane: lanes[lane] == first)
        for place, id in enumerate(beside):
            aside = (2 * place - len(beside) + 1) * BESIDE // 2
            source, target = (points[end] for end in lanes[id])
            ways[id] = shifted(source, target, aside if lanes[id] == first else -aside)
    return ways


def shifted(source: Point, target: Point, aside: int) -> Way:
    """The line between two points, as far to its right, and a little shorter at both ends."""
    dx, dy = target[0] - source[0], target[1] - source[1]
    far = max(1, isqrt(dx * dx + dy * dy))
    x, y = -dy * aside // far, dx * aside // far
    end = min(END, far // 4)
    ahead_x, ahead_y = dx * end // far, dy * end // far
    return (source[0] + x + ahead_x, source[1] + y + ahead_y), (target[0] + x - ahead_x, target[1] + y - ahead_y)


def outlines(
    instance: Instance, lanes: Lanes, points: Points, ways: Mapping[ResourceId, Way]
) -> Iterator[tuple[ResourceId, Sequence[Point]]]:
    """The groups with the corners of a line around each, or around each part of the graph that it has resources of.

    Left out are those that are seen anyway: a point with its headings and all its lanes, and lanes between two points.
    There are none if there are very many.
    """
    spot = {each.id: each.id if each.x is None else (each.x, each.y) for each in instance.graph.resources}
    at: dict[object, set[ResourceId]] = {}
    for id in points:
        for end in lanes.get(id, (id,)):
            at.setdefault(spot[end], set()).add(id)
    seen = {frozenset(each) for each in at.values()}

    def is_seen(members: frozenset[ResourceId]) -> bool:
        return members in seen or len({frozenset(map(spot.get, lanes.get(each, (each,)))) for each in members}) == 1

    groups = [each for each in instance.graph.groups if not is_seen(frozenset(each.resources))]
    part = parts_of(instance.graph) if groups else {}
    for group in groups if len(groups) <= MOST_OUTLINED else ():
        for number in dict.fromkeys(part[id] for id in group.resources):
            here = (id for id in group.resources if part[id] == number)
            corners = [corner for id in here for corner in corners_of(id, points, ways)]
            if corners:
                yield group.id, hull(corners)


def parts_of(graph: ResourceGraph) -> Mapping[ResourceId, int]:
    """The number of the connected part of each resource, in the order of the graph."""
    beside: dict[ResourceId, list[ResourceId]] = {each.id: [] for each in graph.resources}
    for source, target in graph.edges:
        beside[source].append(target)
        beside[target].append(source)
    part: dict[ResourceId, int] = {}
    for number, first in enumerate(beside):
        found = [] if first in part else [first]
        part.setdefault(first, number)
        for id in found:
            new = [each for each in beside[id] if each not in part]
            part.update(dict.fromkeys(new, number))
            found += dict.fromkeys(new)
    return part


def corners_of(id: ResourceId, points: Points, ways: Mapping[ResourceId, Way]) -> Iterator[Point]:
    """The corners of squares around a point, or around both ends of a lane."""
    ends = ways.get(id) or ((points[id],) if id in points else ())
    half = AROUND_LANE if id in ways else AROUND_POINT
    for x, y in ends:
        yield from ((x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half))


def hull(points: Iterable[Point]) -> Sequence[Point]:
    """The corners of the least convex shape around the points (Andrew 1979)."""
    ordered = sorted(set(points))

    def half(way: Iterable[Point]) -> list[Point]:
        corners: list[Point] = []
        for x, y in way:
            while len(corners) > 1:
                (x1, y1), (x2, y2) = corners[-2:]
                if (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1) > 0:
                    break
                corners.pop()
            corners.append((x, y))
        return corners[:-1]

    return half(ordered) + half(reversed(ordered))
