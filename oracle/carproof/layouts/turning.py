"""Splits the points of a layout by the heading of vehicles, so that a turn takes time.

A point becomes a resource for each heading that lanes have there, a resource for each turn between two, and itself, at
which goals are reached in any heading. All of them are a group of capacity one. A lane is entered from the heading that
it has. A turn of up to a quarter takes the time of a quarter turn, any other twice as long.
"""

from dataclasses import replace
from itertools import permutations
from math import gcd

from carp_spec import Instance, Move, Resource, ResourceGraph, ResourceId
from carp_spec.model import Group
from carproof.layouts.layout import Lane, Layout

Heading = tuple[int, int]


def with_headings(layout: Layout, instance: Instance, quarter: int) -> Instance:
    """The instance with split points; `quarter` is the ticks of a quarter turn. Robots start in the first heading."""
    headings: dict[str, dict[Heading, None]] = {each: {} for each in layout.points}
    for lane in layout.lanes.values():
        for end in (lane.source, lane.target):
            headings[end][_heading(layout, lane)] = None
    taken = set(instance.graph.index)
    parts: dict[ResourceId, list[Resource]] = {}
    at: dict[tuple[str, Heading], str] = {}
    moves: list[Move] = []

    def add(point: str, name: str, duration: int) -> str:
        while name in taken:
            name += "'"
        taken.add(name)
        parts.setdefault(point, []).append(replace(instance.graph.resource[point], id=name, duration=duration))
        return name

    for point, here in headings.items():
        for heading in here:
            at[point, heading] = add(point, f"{point} @{heading[0]},{heading[1]}", 1)
            moves.append((at[point, heading], point))
        for one, two in permutations(here, 2):
            ticks = quarter if one[0] * two[0] + one[1] * two[1] >= 0 else 2 * quarter
            turn = add(point, f"{at[point, one]} to @{two[0]},{two[1]}", ticks)
            moves += [(at[point, one], turn), (turn, at[point, two])]
    for lane in layout.lanes.values():
        heading = _heading(layout, lane)
        moves += [(at[lane.source, heading], lane.id), (lane.id, at[lane.target, heading])]
    split = {point: tuple(each.id for each in here) for point, here in parts.items()}
    groups = [
        replace(each, resources=tuple(part for name in each.resources for part in (name, *split.get(name, ()))))
        for each in instance.graph.groups
    ]
    groups += [Group(f"headings at {point}", (point, *here)) for point, here in split.items()]
    resources = [part for each in instance.graph.resources for part in (each, *parts.get(each.id, ()))]
    graph = ResourceGraph(tuple(resources), tuple(moves), directed=True, groups=tuple(groups))
    robots = tuple(replace(each, start=split.get(each.start, (each.start,))[0]) for each in instance.robots)
    return replace(instance, graph=graph, robots=robots)


def _heading(layout: Layout, lane: Lane) -> Heading:
    """The direction in which the vehicle looks, in the least whole numbers; (0, 0) where positions are unknown."""
    one, two = layout.points[lane.source], layout.points[lane.target]
    if one.x is None or one.y is None or two.x is None or two.y is None:
        return 0, 0
    way = (two.x - one.x, two.y - one.y) if not lane.backwards else (one.x - two.x, one.y - two.y)
    least = gcd(*way) or 1
    return way[0] // least, way[1] // least
