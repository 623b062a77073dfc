"""The check that vehicles of a size keep apart: shapes that overlap, and visits in both that share a tick."""

from collections.abc import Iterable, Iterator, Sequence
from heapq import nsmallest
from math import isqrt
from operator import attrgetter

from carp_spec import Instance, Plan, ResourceId, RobotId, Violation, Visit
from carp_spec.refusal import Refusal
from carp_verify.footprint.cells import swept_in_cells
from carp_verify.footprint.floor import Shape, shapes
from carp_verify.footprint.meeting import overlap
from carp_verify.footprint.rules import (
    MOST_PAIRS,
    Footprint,
    Meeting,
    cells_have_a_step,
    pairs_fit,
    vehicle_has_a_size,
    vehicles_keep_apart,
)

Stay = tuple[int, int | None, RobotId, ResourceId]
"""Enter, leave, robot and resource."""


def footprint_violations(
    instance: Instance,
    plans: Sequence[Plan],
    size: Footprint,
    most: int | None = None,
    cells: int | None = None,
) -> tuple[Violation, ...]:
    """The violations of `footprint/apart`, at most the first `most` of them (`None`: all).

    With `cells`, the length in mm of a step of the positions, no resource is a lane. Visits that end before they begin,
    and those of unknown resources, are left to other rules. Raises `Refusal` for a size that is none, a resource
    without a position, and, without `cells`, resources that are neither points nor lanes.
    """
    for fault in (*vehicle_has_a_size(size), *cells_have_a_step(cells, size)):
        raise Refusal("option", fault.path, fault.rule, fault.message)
    # the middle of two cells may be at half a mm, so that all is doubled there
    measured = size if cells is None else Footprint(2 * size.length, 2 * size.width, size.round)
    swept = _swept_on_lanes(instance, plans) if cells is None else swept_in_cells(instance.graph, plans, 2 * cells)
    stays: dict[Shape, list[Stay]] = {}
    for shape, plan, visit in swept:
        if visit.leave is None or visit.enter < visit.leave:
            stays.setdefault(shape, []).append((visit.enter, visit.leave, plan.robot, visit.resource))
    return tuple(vehicles_keep_apart(iter(_earliest(_meetings(stays, measured), most)), size))


def _swept_on_lanes(instance: Instance, plans: Sequence[Plan]) -> Iterator[tuple[Shape, Plan, Visit]]:
    """The shape of each visit of a known resource, on a floor of points and lanes."""
    shape = shapes(instance.graph)
    return ((shape[each.resource], plan, each) for plan in plans for each in plan.visits if each.resource in shape)


def _earliest(meetings: Iterable[Iterator[Meeting]], most: int | None) -> Sequence[Meeting]:
    """At most the first `most` meetings, each two visits once, of whose shapes several may overlap.

    Those of each iterator are in order of time, and at one time those of an earlier iterator come first. So no more
    than `most` of an iterator are looked for, nor are many more kept.
    """
    kept: dict[frozenset[tuple[RobotId, ResourceId, int]], Meeting] = {}
    for each in meetings:
        more = 0
        for meeting in each:
            visits = frozenset((*pair, meeting.start) for pair in zip(meeting.robots, meeting.resources, strict=True))
            more += visits not in kept
            kept.setdefault(visits, meeting)
            if most is not None and more >= most:
                break
        if most is not None and len(kept) > 10 * most:
            kept = dict(nsmallest(most, kept.items(), key=lambda item: item[1].start))
    return sorted(kept.values(), key=attrgetter("start"))[:most]


def _meetings(stays: dict[Shape, list[Stay]], size: Footprint) -> Iterator[Iterator[Meeting]]:
    """The meetings in each shape, and in each two that overlap."""
    for here in stays.values():
        yield _together(here, ())
    for one, two in _near([*stays], size):
        if overlap(one, two, size):
            yield _together(stays[one], stays[two])


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
            raise Refusal("limit", "$.graph", pairs_fit.id, message)
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
