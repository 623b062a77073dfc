"""Robots side by side: which lane of a resource each visit takes, and where that lane is drawn."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from math import isqrt
from typing import TypeAlias

from carp_spec import Plan, Resource, ResourceId
from carp_spec.windows import Occupation

SIDE = 32
"""Drawing units of a resource's side."""
RADIUS = 13
STRIP = 8
"""The height of a line of text above or below the robots in a resource."""
NUDGES = ((0, 0), (1, 1), (-1, -1), (1, -1), (-1, 1))
"""The shifts of robots beyond the capacity, in halves of a radius: each is seen, and all stay near the resource."""

Stays: TypeAlias = list[tuple[int, int, Occupation]]
"""Occupations of a resource, each with the index of its plan and of its visit."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A lane of a resource: where a robot in it is drawn, relative to the resource's centre, and how large."""

    dx: int
    dy: int
    radius: int


@dataclass(frozen=True, slots=True)
class Area:
    """The part of a resource's square that robots are drawn in: how far down its centre is, and half its height."""

    down: int
    half: int


def lasts(enter: int, leave: int | None) -> bool:
    """Whether a visit takes any time; in broken plans it may not."""
    return leave is None or enter < leave


def occupations(plans: Sequence[Plan]) -> dict[ResourceId, Stays]:
    """The visits to each resource that take time, in the order of their beginning."""
    found: dict[ResourceId, Stays] = {}
    for at_plan, plan in enumerate(plans):
        for at_visit, visit in enumerate(plan.visits):
            if lasts(visit.enter, visit.leave):
                found.setdefault(visit.resource, []).append((at_plan, at_visit, (visit.enter, visit.leave)))
    for visits in found.values():
        visits.sort(key=lambda each: (each[2][0], each[0], each[1]))
    return found


def lanes(stays: Sequence[Occupation]) -> Iterator[int]:
    """The lowest free lane for each stay; they come in the order of their beginning."""
    taken: list[tuple[int, int]] = []
    free: list[int] = []
    opened = 0
    for enter, leave in stays:
        while taken and taken[0][0] <= enter:
            heappush(free, heappop(taken)[1])
        lane = heappop(free) if free else opened
        opened = max(opened, lane + 1)
        if leave is not None:
            heappush(taken, (leave, lane))
        yield lane


def area(*, is_named: bool, has_traits: bool) -> Area:
    """The part of a resource's square for robots and marks: names are above it, capacities and durations below."""
    top = STRIP - SIDE // 2 if is_named else -SIDE // 2
    end = SIDE // 2 - STRIP if has_traits else SIDE // 2
    return Area((top + end) // 2, (end - top) // 2)


def slots(count: int, area: Area, largest: int) -> tuple[Spot, ...]:
    """As many circles of equal size, side by side; `largest` is the radius of one alone if there is room for it."""
    columns = isqrt(max(1, count) - 1) + 1
    rows = -(-max(1, count) // columns)
    radius = max(1, min(largest // columns, (area.half - 1) // rows))
    places = (divmod(at, columns) for at in range(count))
    return tuple(
        Spot(
            SIDE * (2 * column + 1) // (2 * columns) - SIDE // 2,
            area.down + area.half * (2 * row + 1) // rows - area.half,
            radius,
        )
        for row, column in places
    )


def spots(resource: Resource | None, lane_count: int, area: Area) -> tuple[Spot, ...]:
    """The places of as many lanes: within the capacity side by side, beyond it over the others, a little shifted."""
    beside = slots(max(1, lane_count if resource is None else min(resource.capacity, lane_count)), area, RADIUS)

    def spot(lane: int) -> Spot:
        first = beside[lane % len(beside)]
        right, down = NUDGES[lane // len(beside) % len(NUDGES)]
        return Spot(first.dx + right * first.radius // 2, first.dy + down * first.radius // 2, first.radius)

    return tuple(spot(lane) for lane in range(lane_count))
