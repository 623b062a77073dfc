"""Strips: the pieces of the floor that lanes between two places share, such as the two directions of a lane.

Positions and lengths are millimetres.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isqrt

MICROMETRES = 1000
"""In a mm."""
NEAR = 2
"""The square of how far a point may be from where it belongs, as positions are rounded to mm."""

Spot = tuple[int, int]
"""A position in whole mm."""


@dataclass(frozen=True, slots=True)
class Track:
    """What is known of the way along a lane: its length, rounded up, and the control points of its curve."""

    length: int | None = None
    course: tuple[Spot, ...] = ()


@dataclass(frozen=True, slots=True)
class Strip:
    """A piece of the floor between two places: the straight one, the one of a length, or that of control points."""

    ends: frozenset[str]
    length: int | None = None
    course: tuple[Spot, ...] = ()


def length_of(course: Sequence[Spot]) -> int:
    """The length of a polygon, rounded up; a side is known to a micrometre, so points on one line add nothing."""
    return -(-sum(isqrt(_square(*side) * MICROMETRES**2) for side in pairwise(course)) // MICROMETRES)


def strip_of(track: Track, ends: frozenset[str], spots: Sequence[Spot], distance: int | None) -> Strip:
    """The strip along a track between two places, which are at the spots and so far from each other.

    Both directions of a curve are one strip. Without control points the length tells the strip.
    """
    if not track.course:
        return Strip(ends) if track.length in (None, distance) else Strip(ends, track.length)
    within = tuple(each for each in track.course if all(_square(each, spot) > NEAR for spot in spots))
    if length_of(track.course) == distance or all(_lies_between(each, spots) for each in within):
        return Strip(ends)
    return Strip(ends, course=min(within, within[::-1]))


def _lies_between(spot: Spot, spots: Sequence[Spot]) -> bool:
    """Whether the spot is on the straight line from the first of the spots to the last."""
    (x, y), (end_x, end_y) = spots[0], spots[-1]
    way, gap = (end_x - x, end_y - y), (spot[0] - x, spot[1] - y)
    along, across = gap[0] * way[0] + gap[1] * way[1], gap[0] * way[1] - gap[1] * way[0]
    return 0 < along < (square := _square(spots[0], spots[-1])) and across**2 <= NEAR * square


def _square(one: Spot, two: Spot) -> int:
    return (one[0] - two[0]) ** 2 + (one[1] - two[1]) ** 2
