"""Whether the shapes that two vehicles of a size sweep overlap, in whole numbers.

Coordinates are doubled, so that middles and half sizes are whole. A root appears where a side of a vehicle lies along a
lane; each comparison is of sides that are not negative, and their squares decide it.
"""

from carp_verify.footprint.floor import Shape, Spot
from carp_verify.footprint.rules import Footprint


def overlap(one: Shape, two: Shape, size: Footprint) -> bool:
    """Whether the shapes have an inner point in common."""
    if size.round:
        return _are_nearer(one, two, size.length)
    if one.heading is None and two.heading is None:
        gap = _minus(one.start, two.start)
        return _dot(gap, gap) < size.length**2 + size.width**2
    if one.heading is not None and two.heading is not None:
        sides = (one.heading, _across(one.heading), two.heading, _across(two.heading))
        return not any(_lies_between(side, one, two, size) for side in sides)
    return _disc_reaches(one, two, size) if one.heading is None else _disc_reaches(two, one, size)


def _are_nearer(one: Shape, two: Shape, distance: int) -> bool:
    """Whether the middles of two discs may come nearer than the distance."""
    if _parts(one, two) and _parts(two, one):
        return True
    ends = [(end, two) for end in (one.start, one.end)] + [(end, one) for end in (two.start, two.end)]
    return any(_is_nearer(spot, shape, distance) for spot, shape in ends)


def _parts(line: Shape, other: Shape) -> bool:
    """Whether the ends of the other lie on both sides of the line."""
    way = _minus(line.end, line.start)
    left, right = (_cross(way, _minus(end, line.start)) for end in (other.start, other.end))
    return (left < 0 < right) or (right < 0 < left)


def _is_nearer(spot: Spot, shape: Shape, distance: int) -> bool:
    way, gap = _minus(shape.end, shape.start), _minus(spot, shape.start)
    long, along = _dot(way, way), _dot(way, gap)
    if along <= 0:
        return _dot(gap, gap) < distance**2
    if along >= long:
        rest = _minus(spot, shape.end)
        return _dot(rest, rest) < distance**2
    return _cross(way, gap) ** 2 < distance**2 * long


def _lies_between(side: Spot, one: Shape, two: Shape, size: Footprint) -> bool:
    """Whether a line at a right angle to the side has the two rectangles on either hand.

    That is so if gap >= a / sqrt(p) + b / sqrt(q), where the gap of the middles is less what both lanes take of it, a
    and b are what the vehicles take, and p and q are the squared lengths of their headings. Of gap >= 0, squared and
    times p q: rest = gap^2 p q - a^2 q - b^2 p >= 2 a b sqrt(p q).
    """
    ways = [_minus(each.end, each.start) for each in (one, two)]
    gap = abs(_dot(_minus(_doubled_middle(one), _doubled_middle(two)), side)) - sum(abs(_dot(w, side)) for w in ways)
    a, b = (size.length * abs(_dot(h, side)) + size.width * abs(_cross(h, side)) for h in map(_heading, (one, two)))
    p, q = (_dot(h, h) for h in map(_heading, (one, two)))
    rest = gap**2 * p * q - a**2 * q - b**2 * p
    return gap >= 0 and rest >= 0 and rest**2 >= 4 * a**2 * b**2 * p * q


def _disc_reaches(disc: Shape, box: Shape, size: Footprint) -> bool:
    """Whether the rectangle comes nearer to the disc's middle than half the diagonal of a vehicle.

    Along the heading h the middles are x / |h| apart, less the lane, and across it y / |h|. The rectangle ends at half
    of a length and of a width; what lies beyond that, squared, is compared with the squared diagonal, both times |h|^2.
    """
    heading = _heading(box)
    square = _dot(heading, heading)
    gap = _minus((2 * disc.start[0], 2 * disc.start[1]), _doubled_middle(box))
    x = abs(_dot(gap, heading)) - abs(_dot(_minus(box.end, box.start), heading))
    y = abs(_cross(gap, heading))
    beyond = [(far, half) for far, half in ((x, size.length), (y, size.width)) if far > 0 and far**2 > half**2 * square]
    # the sum of (far - half |h|)^2 < (length^2 + width^2) |h|^2, with the part of |h| on the right
    plain = sum(far**2 + half**2 * square for far, half in beyond) - (size.length**2 + size.width**2) * square
    rooted = sum(2 * far * half for far, half in beyond)
    return plain < 0 or plain**2 < rooted**2 * square


def _heading(shape: Shape) -> Spot:
    assert shape.heading is not None  # noqa: S101 - it is a rectangle
    return shape.heading


def _doubled_middle(shape: Shape) -> Spot:
    return shape.start[0] + shape.end[0], shape.start[1] + shape.end[1]


def _across(way: Spot) -> Spot:
    return -way[1], way[0]


def _minus(one: Spot, two: Spot) -> Spot:
    return one[0] - two[0], one[1] - two[1]


def _dot(one: Spot, two: Spot) -> int:
    return one[0] * two[0] + one[1] * two[1]


def _cross(one: Spot, two: Spot) -> int:
    return one[0] * two[1] - one[1] * two[0]
