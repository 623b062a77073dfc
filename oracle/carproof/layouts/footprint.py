"""Which points and lanes two vehicles of a size may not occupy together, in exact arithmetic.

A rectangle on a lane sweeps a longer one along it. At a point it turns, and sweeps the disc around it, unless all lanes
there lie along one line. A round vehicle sweeps all points that are nearer than its radius. Shapes that only touch do
not meet. Lanes are taken as straight. What is on another level is above or below, and never in the way; a lane between
levels is on both.

Positions are doubled, so that half a length is whole. Of the two directions of a lane, with squared lengths p and q, a
comparison is about the sign of a + b sqrt(p) + c sqrt(q), which squaring decides.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from carp_spec.model import Group
from carp_verify.footprint.rules import Footprint
from carproof.layouts.layout import Layout

Vector = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Shape:
    """What is swept from `start` along `way`; `heading` is that of the vehicle, `None` where it turns or is round.

    It is on its `levels`; on any where there are none.
    """

    members: tuple[str, ...]
    start: Vector
    way: Vector
    heading: Vector | None
    levels: frozenset[str]


def conflicts(layout: Layout, size: Footprint) -> Iterator[Group]:
    """The groups: for each two shapes that meet, their points and lanes."""
    shapes = list(_shapes(layout, size))
    for one, two in _near(shapes, size):
        if _share_a_level(one, two) and _meet(one, two, size):
            yield Group(f"{one.members[0]} | {two.members[0]}", (*one.members, *two.members))


def _shapes(layout: Layout, size: Footprint) -> Iterator[Shape]:
    at: dict[str, Vector] = {}
    for point in layout.points.values():
        if point.x is None or point.y is None:
            raise layout.tree.refuse(f"the point {point.id!r} must have a position, for a footprint")
        at[point.id] = (2 * point.x, 2 * point.y)
    ways: dict[str, list[Vector]] = {each: [] for each in at}
    strips: dict[object, list[str]] = {}
    for lane in layout.lanes.values():
        way = _from(at[lane.source], at[lane.target])
        if way != (0, 0):
            ways[lane.source].append(way)
            ways[lane.target].append(way)
        strips.setdefault(lane.strips[0], []).append(lane.id)
    for name, place in at.items():
        along = ways[name][:1]
        turns = not along or any(_cross(along[0], way) for way in ways[name])
        yield Shape((name,), place, (0, 0), None if turns or size.round else along[0], _levels(layout, name))
    for lanes in strips.values():
        lane = layout.lanes[lanes[0]]
        way = _from(at[lane.source], at[lane.target])
        heading = None if size.round or way == (0, 0) else way
        yield Shape(tuple(lanes), at[lane.source], way, heading, _levels(layout, lane.source, lane.target))


def _levels(layout: Layout, *points: str) -> frozenset[str]:
    """The levels of the points; none if that of a point is not known."""
    levels = [layout.points[each].level for each in points]
    return frozenset() if None in levels else frozenset(each for each in levels if each is not None)


def _share_a_level(one: Shape, two: Shape) -> bool:
    return not (one.levels and two.levels) or not one.levels.isdisjoint(two.levels)


def _near(shapes: Sequence[Shape], size: Footprint) -> Iterator[tuple[Shape, Shape]]:
    """The pairs whose bounding boxes meet, in the order of the shapes."""
    reach = 1 + isqrt(size.length**2 + size.width**2)
    boxes = [
        (
            min(each.start[0], each.start[0] + each.way[0]) - reach,
            max(each.start[0], each.start[0] + each.way[0]) + reach,
            min(each.start[1], each.start[1] + each.way[1]) - reach,
            max(each.start[1], each.start[1] + each.way[1]) + reach,
        )
        for each in shapes
    ]
    found: list[tuple[int, int]] = []
    active: list[int] = []
    for here in sorted(range(len(shapes)), key=lambda number: boxes[number]):
        active = [other for other in active if boxes[other][1] > boxes[here][0]]
        found += [
            (min(here, other), max(here, other))
            for other in active
            if boxes[other][2] < boxes[here][3] and boxes[here][2] < boxes[other][3]
        ]
        active.append(here)
    return ((shapes[one], shapes[two]) for one, two in sorted(found))


def _meet(one: Shape, two: Shape, size: Footprint) -> bool:
    if size.round:
        return _segment_square(one, two) < 4 * size.length**2
    if one.heading is not None and two.heading is not None:
        return not any(_separates(axis, one, two, size) for each in (one, two) for axis in _axes(each))
    if one.heading is None and two.heading is None:
        gap = _from(one.start, two.start)
        return _dot(gap, gap) < 4 * (size.length**2 + size.width**2)
    box, disc = (one, two) if one.heading is not None else (two, one)
    return _box_meets_disc(box, disc, size)


def _axes(shape: Shape) -> tuple[Vector, Vector]:
    assert shape.heading is not None  # noqa: S101 - it is a box
    return shape.heading, (-shape.heading[1], shape.heading[0])


def _separates(axis: Vector, one: Shape, two: Shape, size: Footprint) -> bool:
    """Whether the shadows of two boxes on the axis do not overlap; lengths along it are doubled."""
    gap = abs(_dot(_from(_doubled_middle(one), _doubled_middle(two)), axis))
    rest = Fraction(gap - abs(_dot(one.way, axis)) - abs(_dot(two.way, axis)))
    parts = []
    for each in (one, two):
        heading, normal = _axes(each)
        square = _dot(heading, heading)
        half = size.length * abs(_dot(heading, axis)) + size.width * abs(_dot(normal, axis))
        parts.append((Fraction(-2 * half, square), square))
    return _sign(rest, *parts[0], *parts[1]) >= 0


def _box_meets_disc(box: Shape, disc: Shape, size: Footprint) -> bool:
    """Whether the nearest point of the box is nearer to the centre than half the diagonal."""
    heading, _ = _axes(box)
    square = _dot(heading, heading)
    gap = _from(_doubled_middle(box), (2 * disc.start[0], 2 * disc.start[1]))
    along = Fraction(abs(_dot(gap, heading)) - abs(_dot(box.way, heading)), 2 * square)
    across = Fraction(abs(_cross(gap, heading)), 2 * square)
    plain, rooted = Fraction(-(size.length**2) - size.width**2), Fraction(0)
    for beyond, half in ((along, size.length), (across, size.width)):
        if _sign(Fraction(-half), beyond, square) > 0:
            plain += beyond**2 * square + half**2
            rooted -= 2 * beyond * half
    return _sign(plain, rooted, square) < 0


def _segment_square(one: Shape, two: Shape) -> Fraction:
    """The squared distance of two segments."""
    if _cross_each_other(one, two):
        return Fraction(0)
    return min(
        _point_square(point, each)
        for each, other in ((one, two), (two, one))
        for point in (other.start, (other.start[0] + other.way[0], other.start[1] + other.way[1]))
    )


def _point_square(point: Vector, shape: Shape) -> Fraction:
    gap, square = _from(shape.start, point), _dot(shape.way, shape.way)
    share = Fraction(max(0, min(square, _dot(gap, shape.way))), square) if square else Fraction(0)
    return (gap[0] - share * shape.way[0]) ** 2 + (gap[1] - share * shape.way[1]) ** 2


def _cross_each_other(one: Shape, two: Shape) -> bool:
    """Whether the segments cross at a point within both."""
    turn = _cross(one.way, two.way)
    if not turn:
        return False
    gap = _from(one.start, two.start)
    return all(0 <= Fraction(_cross(gap, way), turn) <= 1 for way in (two.way, one.way))


def _doubled_middle(shape: Shape) -> Vector:
    return 2 * shape.start[0] + shape.way[0], 2 * shape.start[1] + shape.way[1]


def _from(one: Vector, two: Vector) -> Vector:
    return two[0] - one[0], two[1] - one[1]


def _dot(one: Vector, two: Vector) -> int:
    return one[0] * two[0] + one[1] * two[1]


def _cross(one: Vector, two: Vector) -> int:
    return one[0] * two[1] - one[1] * two[0]


def _of(value: Fraction) -> int:
    return (value > 0) - (value < 0)


def _sign(a: Fraction, b: Fraction, p: int, c: Fraction = Fraction(0), q: int = 0) -> int:
    """The sign of a + b sqrt(p) + c sqrt(q): of two parts with opposite signs, the one with the larger square."""
    if c == 0:
        first, second = _of(a), _of(b) if p else 0
        return first or second if first * second >= 0 else first * _of(a**2 - b**2 * p)
    first, second = _sign(a, b, p), _of(c) if q else 0
    return first or second if first * second >= 0 else first * _sign(a**2 + b**2 * p - c**2 * q, 2 * a * b, p)
