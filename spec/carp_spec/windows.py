"""Free time windows, `window/...`: pure functions on the occupations of a resource and of the groups that hold it."""

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from operator import itemgetter
from typing import TypeAlias

from carp_spec.model import Plan, ResourceGraph, ResourceId
from carp_spec.rule import MORS, rule

Occupation: TypeAlias = tuple[int, int | None]
"""A committed stay [enter, leave) in a resource or a group; a leave of `None` is for ever."""
Constraint: TypeAlias = tuple[Sequence[Occupation], int]
"""The occupations of a resource or a group, and its capacity."""


@dataclass(frozen=True, slots=True)
class Window:
    """Ticks [start, end) in which a resource has room for one more robot; an end of `None` is for ever."""

    start: int
    end: int | None

    def lasts_until(self, tick: int | None) -> bool:
        """Whether a stay in the window may end at the tick (`None`: the stay never ends)."""
        return self.end is None or (tick is not None and tick <= self.end)


def occupancy(occupations: Sequence[Occupation], tick: int) -> int:
    """The number of occupations that hold the tick."""
    return sum(enter <= tick and (leave is None or tick < leave) for enter, leave in occupations)


def stays_within(plans: Iterable[Plan], resources: Container[ResourceId]) -> list[Occupation]:
    """The occupations of a group of resources by plans; a robot that moves within the group stays in it."""
    runs = [
        [*run]
        for plan in plans
        for inside, run in groupby(plan.visits, key=lambda visit: visit.resource in resources)
        if inside
    ]
    return [(run[0].enter, run[-1].leave) for run in runs]


def constraints_on(graph: ResourceGraph, plans: Sequence[Plan], resource: ResourceId) -> list[Constraint]:
    """What limits the use of a resource beside the plans: its own capacity, and its groups."""
    limits = map(graph.constraint, graph.constraints_of(resource))
    return [(stays_within(plans, limit.resources), limit.capacity) for limit in limits]


def free_windows(constraints: Sequence[Constraint], gap: int = 0) -> tuple[Window, ...]:
    """The windows that `window/free` describes, in order of time; `gap` is that of the instance."""
    changes = [(0, 0, 0)]
    for place, (occupations, _) in enumerate(constraints):
        for enter, leave in _longer(occupations, gap):
            changes.append((enter, place, 1))
            changes += [] if leave is None else [(leave, place, -1)]
    windows: list[Window] = []
    inside = [0] * len(constraints)
    opened: int | None = None
    for tick, at_tick in groupby(sorted(changes), key=itemgetter(0)):
        for _, place, change in at_tick:
            inside[place] += change
        is_free = all(count < capacity for count, (_, capacity) in zip(inside, constraints, strict=True))
        if opened is None and is_free:
            opened = tick
        elif opened is not None and not is_free:
            windows.extend([Window(opened, tick - gap)] if opened < tick - gap else [])
            opened = None
    return tuple(windows) if opened is None else (*windows, Window(opened, None))


@rule(
    "window/free",
    "The free windows of a resource are the maximal intervals, from tick 0, in which fewer committed plans occupy it "
    "than its capacity, and fewer each group that contains it than the group's. Where following is forbidden, a plan "
    "counts for a tick longer (in a group, after it leaves the group), and a window ends a tick earlier.",
    f"paper, section III; {MORS}",
)
def windows_are_free(windows: Sequence[Window], constraints: Sequence[Constraint], gap: int = 0) -> bool:
    limits = [(_longer(occupations, gap), capacity) for occupations, capacity in constraints]
    longer = [each for occupations, _ in limits for each in occupations]
    bounds = [*longer, *((enter - gap, enter) for enter, _ in longer), *((each.start, each.end) for each in windows)]
    changes = {0, *(max(tick, 0) for pair in bounds for tick in pair if tick is not None)}
    are_right = all(
        any(window.start <= tick and window.lasts_until(tick + 1) for window in windows)
        == all(occupancy(stays, each) < capacity for stays, capacity in limits for each in (tick, tick + gap))
        for tick in changes
    )
    each_lasts = all(each.start >= 0 and (each.end is None or each.start < each.end) for each in windows)
    are_apart = all(one.end is not None and one.end < other.start for one, other in pairwise(windows))
    return are_right and each_lasts and are_apart


def _longer(occupations: Sequence[Occupation], gap: int) -> list[Occupation]:
    """The occupations, each longer by `gap` ticks."""
    return [(enter, None if leave is None else leave + gap) for enter, leave in occupations]


@rule(
    "window/fits",
    "A robot that needs d ticks may use a window [a, b) only if it can stay: b - a >= d; "
    "it enters in [a, b - d] and leaves in [a + d, b], at least d ticks after it entered.",
    MORS,
)
def stay_fits(window: Window, enter: int, leave: int | None, duration: int) -> bool:
    long_enough = leave is None or leave - enter >= duration
    return window.start <= enter and long_enough and window.lasts_until(leave)
