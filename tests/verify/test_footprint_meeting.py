"""Whether shapes overlap, beside another way to tell: by the hull of all differences of their corners.

All lengths are tenfold, so that the corners of vehicles with these headings are whole numbers.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise, product
from math import gcd

import pytest

from carp_verify.footprint.floor import Shape
from carp_verify.footprint.meeting import overlap
from carp_verify.footprint.rules import Footprint

Point = tuple[int, int]
TENFOLD = 10
HEADINGS = ((1, 0), (0, -1), (3, 4), (-4, 3))
SIZES = ((4, 2), (3, 5), (10, 5), (1, 1))
PLACES = tuple(product((-7, -4, -2, 0, 1, 3, 5, 10), (-6, -3, 0, 2, 5, 7)))


def cross(one: Point, two: Point, three: Point) -> int:
    """Positive if one turns left from two to three."""
    return (two[0] - one[0]) * (three[1] - one[1]) - (two[1] - one[1]) * (three[0] - one[0])


def hull(points: Iterable[Point]) -> list[Point]:
    """The corners of the least convex polygon around the points, to the left, the first of them again at the end."""

    def chain(those: Iterable[Point]) -> list[Point]:
        found: list[Point] = []
        for each in those:
            while len(found) > 1 and cross(found[-2], found[-1], each) <= 0:
                found.pop()
            found.append(each)
        return found[:-1]

    ordered = sorted(set(points))
    return [*chain(ordered), *chain(ordered[::-1]), ordered[0]]


def reaches_inside(corners: Sequence[Point]) -> bool:
    """Whether the origin lies inside, not at the border."""
    return len(corners) > 3 and all(cross(one, two, (0, 0)) > 0 for one, two in pairwise(corners))


def is_within(corners: Sequence[Point], square: int) -> bool:
    """Whether the origin is nearer to the polygon than a distance, of which this is the square."""
    if reaches_inside(corners):
        return True
    for (x, y), (u, v) in pairwise((*corners, corners[0])):
        way = (u - x, v - y)
        long, along = way[0] ** 2 + way[1] ** 2, -x * way[0] - y * way[1]
        if 0 < along < long:
            near = cross((x, y), (u, v), (0, 0)) ** 2 < square * long
        else:
            near = min(x**2 + y**2, u**2 + v**2) < square
        if near:
            return True
    return False


def differences(one: Sequence[Point], two: Sequence[Point]) -> list[Point]:
    return hull((a[0] - b[0], a[1] - b[1]) for a in one for b in two)


def ends(shape: Shape) -> list[Point]:
    return [(TENFOLD * x, TENFOLD * y) for x, y in (shape.start, shape.end)]


def corners(shape: Shape, size: Footprint) -> list[Point]:
    """The corners of the rectangles at both ends."""
    assert shape.heading is not None
    x, y = (each // gcd(*shape.heading) for each in shape.heading)
    unit = TENFOLD // (2 if abs(x) + abs(y) == 1 else 10)
    return [
        (a + unit * (i * size.length * x - j * size.width * y), b + unit * (i * size.length * y + j * size.width * x))
        for a, b in ends(shape)
        for i in (-1, 1)
        for j in (-1, 1)
    ]


def do_overlap(one: Shape, two: Shape, size: Footprint) -> bool:
    if size.round:
        return is_within(differences(ends(one), ends(two)), (TENFOLD * size.length) ** 2)
    square = TENFOLD**2 * (size.length**2 + size.width**2)
    if one.heading is None and two.heading is None:
        return is_within(differences(ends(one), ends(two)), square)
    if one.heading is not None and two.heading is not None:
        return reaches_inside(differences(corners(one, size), corners(two, size)))
    disc, box = (one, two) if one.heading is None else (two, one)
    doubled = [(2 * x, 2 * y) for x, y in differences(ends(disc), corners(box, size))]
    return is_within(doubled, square)


def shapes_at(start: Point) -> list[Shape]:
    """A place to turn, and lanes of two lengths that lead from it."""
    lanes = [Shape(start, (start[0] + k * x, start[1] + k * y), (k * x, k * y)) for x, y in HEADINGS for k in (1, -2)]
    return [Shape(start, start, None), *lanes]


@pytest.mark.parametrize("size", [*(Footprint(*each) for each in SIZES), Footprint(5, 5, True), Footprint(2, 2, True)])
def test_shapes_overlap_just_where_the_hull_of_their_differences_says_so(size: Footprint) -> None:
    met = 0
    for one in shapes_at((0, 0)):
        for place in PLACES:
            for two in shapes_at(place):
                met += do_overlap(one, two, size)
                assert overlap(one, two, size) == overlap(two, one, size) == do_overlap(one, two, size), (one, two)
    assert met > 0


@pytest.mark.parametrize("size", [Footprint(1, 1, True), Footprint(2, 2, True)])
def test_so_do_the_least_round_vehicles_on_the_shortest_lanes(size: Footprint) -> None:
    near = [(x, y) for x in range(-2, 3) for y in range(-2, 3)]
    for way, place, other in product(near, near, near):
        one = Shape((0, 0), way, (1, 0))
        two = Shape(place, (place[0] + other[0], place[1] + other[1]), (1, 0))
        assert overlap(one, two, size) == do_overlap(one, two, size), (one, two)
