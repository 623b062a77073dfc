"""A layout many times side by side, its copies joined by lanes."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import isqrt

import networkx as nx

from carproof.layouts.layout import Layout, Point

GAP = 5000
"""Between two tiles, in mm."""


def tiled(layout: Layout, tiles: int) -> Layout:
    """As many tiles, row by row of a square; the names in each begin with its number.

    On each side, a lane leads from the outermost point in the core of a tile to the tile beside it, and another lane
    back. Points where vehicles do not stand are taken if there are any. Raises `Refusal` where points have no position.
    """
    core = core_of(layout)
    joints = [each for each in core if not each.stands] or core
    width, height = _pitch(layout, _x), _pitch(layout, _y)
    columns = isqrt(tiles - 1) + 1
    whole = Layout(layout.tree, layout.holds_ends)
    for number in range(tiles):
        row, column = divmod(number, columns)
        _copy(layout, whole, f"{number}/", width * column, height * row)
    for number in range(tiles):
        beside = number + 1 if (number + 1) % columns else tiles
        for other, along in ((beside, _x), (number + columns, _y)):
            if other < tiles:
                by_place = sorted(joints, key=along)
                _join(whole, number, by_place[-2:], other, by_place[:2])
    return whole


def core_of(layout: Layout) -> list[Point]:
    """The points of the largest part in which each is reached from each."""
    lanes = nx.DiGraph((each.source, each.target) for each in layout.lanes.values())
    parts = sorted(nx.strongly_connected_components(lanes), key=len)
    if not parts or any(each.x is None for each in layout.points.values()):
        raise layout.tree.refuse("the layout must have lanes, and a position of each point, to be tiled")
    return [each for each in layout.points.values() if each.id in parts[-1]]


def _x(point: Point) -> int:
    return point.x or 0


def _y(point: Point) -> int:
    return point.y or 0


def _pitch(layout: Layout, along: Callable[[Point], int]) -> int:
    places = [along(each) for each in layout.points.values()]
    return max(places) - min(places) + GAP


def _copy(layout: Layout, whole: Layout, tile: str, x: int, y: int) -> None:
    for point in layout.points.values():
        whole.points[tile + point.id] = replace(point, id=tile + point.id, x=x + _x(point), y=y + _y(point))
    for lane in layout.lanes.values():
        source, target = tile + lane.source, tile + lane.target
        strips = tuple(replace(each, ends=frozenset(tile + end for end in each.ends)) for each in lane.strips)
        whole.lanes[tile + lane.id] = replace(lane, id=tile + lane.id, source=source, target=target, strips=strips)
    for block in layout.blocks.values():
        members = tuple(tile + each for each in block.members)
        whole.blocks[tile + block.id] = replace(block, id=tile + block.id, members=members)
    whole.places |= {tile + point: tile + place for point, place in layout.places.items()}


def _join(whole: Layout, one: int, out: Sequence[Point], two: int, into: Sequence[Point]) -> None:
    """Add a lane from one tile to the other between their outer points, and a lane back between the next ones."""
    whole.lane(whole.tree, None, (f"{one}/{out[-1].id}", f"{two}/{into[0].id}"))
    whole.lane(whole.tree, None, (f"{two}/{into[-1].id}", f"{one}/{out[0].id}"))
