"""The check that vehicles of a size keep apart: shapes that overlap, and visits in both that share a tick."""

from collections.abc import Iterator, Sequence
from heapq import nsmallest
from math import isqrt

from carp_spec import Instance, Plan, ResourceId, RobotId, Violation
from carp_spec.refusal import Refusal
from carp_verify.footprint.floor import Shape, shapes
from carp_verify.footprint.meeting import overlap
from carp_verify.footprint.rules import (
    MOST_PAIRS,
    Footprint,
    Meeting,
    pairs_fit,
    vehicle_has_a_size,
    vehicles_keep_apart,
)

Stay = tuple[int, int | None, RobotId, ResourceId]
"""Enter, leave, robot and resource."""


def footprint_violations(
    instance: Instance, plans: Sequence[Plan], size: Footprint, most: int | None = None
) -> tuple[Violation, ...]:
    """The violations of `footprint/apart`, at most the first `most` of them (`None`: all).

    Visits that end before they begin, and those of unknown resources, are left to other rules. Raises `Refusal` for a
    size that is none, a resource without a position, and resources that are neither points nor lanes.
    """
    for fault in vehicle_has_a_size(size):
        raise Refusal("option", fault.path, fault.rule, fault.message)
    shape = shapes(instance.graph)
    stays: dict[Shape, list[Stay]] = {}
    for plan in plans:
        for visit in plan.visits:
            if visit.resource in shape and (visit.leave is None or visit.enter < visit.leave):
                stay = (visit.enter, visit.leave, plan.robot, visit.resource)
                stays.setdefault(shape[visit.resource], []).append(stay)
    found = vehicles_keep_apart(_meetings(stays, size), size)
    if most is None:
        return tuple(sorted(found, key=_first))
    return tuple(nsmallest(most, found, key=_first))


def _first(violation: Violation) -> int:
    return violation.start or 0


def _meetings(stays: dict[Shape, list[Stay]], size: Footprint) -> Iterator[Meeting]:
    for here in stays.values():
        here.sort(key=lambda stay: stay[0])
        yield from _together(here, ())
    for one, two in _near([*stays], size):
        if overlap(one, two, size):
            yield from _together(stays[one], stays[two])


def _near(all_shapes: Sequence[Shape], size: Footprint) -> list[tuple[Shape, Shape]]:
    """The pairs whose bounding boxes overlap."""
    reach = isqrt(size.length**2 + size.width**2) + 1
    boxes = []
    for each in all_shapes:
        (left, right), (low, high) = (sorted(ends) for ends in zip(each.start, each.end, strict=True))
        boxes.append((2 * left - reach, 2 * right + reach, 2 * low - reach, 2 * high + reach, each))
    boxes.sort(key=lambda box: box[:4])
    pairs: list[tuple[Shape, Shape]] = []
    for number, (_, right, low, high, one) in enumerate(boxes):
        for other in range(number + 1, len(boxes)):
            left, _, other_low, other_high, two = boxes[other]
            if left >= right:
                break
            if low < other_high and other_low < high:
                pairs.append((one, two))
        if not pairs_fit(len(pairs)):
            message = f"there must be at most {MOST_PAIRS} pairs of points and lanes so near that vehicles may overlap"
            raise Refusal("limit", "$.solution", pairs_fit.id, message)
    return pairs


def _together(ones: Sequence[Stay], twos: Sequence[Stay]) -> Iterator[Meeting]:
    """The stays of two robots that share a tick: one of each list or, if the second is empty, two of the first."""
    sides = [(stay, 0) for stay in ones] + [(stay, 1) for stay in twos]
    present: list[tuple[Stay, int]] = []
    for stay, side in sorted(sides, key=lambda each: each[0][0]):
        enter, leave, robot, resource = stay
        present = [each for each in present if each[0][1] is None or each[0][1] > enter]
        for (_, until, other, there), other_side in present:
            if other != robot and (other_side != side or not twos):
                ends = [each for each in (leave, until) if each is not None]
                yield Meeting((other, robot), (there, resource), enter, min(ends, default=None))
        present.append((stay, side))
