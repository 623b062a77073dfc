"""Free time windows, `window/...`: pure functions on the occupations of one resource."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from carp_spec.rule import MORS, rule

Occupation: TypeAlias = tuple[int, int | None]
"""A committed stay [enter, leave) in the resource; a leave of `None` is for ever."""


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


def free_windows(occupations: Sequence[Occupation], capacity: int, gap: int = 0) -> tuple[Window, ...]:
    """The windows that `window/free` describes, in order of time; `gap` is that of the instance."""
    if gap > 0:
        longer = free_windows(_longer(occupations, gap), capacity)
        shorter = (Window(each.start, None if each.end is None else each.end - gap) for each in longer)
        return tuple(each for each in shorter if each.end is None or each.start < each.end)
    change = Counter({0: 0})
    for enter, leave in occupations:
        change[enter] += 1
        if leave is not None:
            change[leave] -= 1
    windows: list[Window] = []
    inside = 0
    opened: int | None = None
    for tick in sorted(change):
        inside += change[tick]
        if opened is None and inside < capacity:
            opened = tick
        elif opened is not None and inside >= capacity:
            windows.append(Window(opened, tick))
            opened = None
    return tuple(windows) if opened is None else (*windows, Window(opened, None))


@rule(
    "window/free",
    "The free windows of a resource are the maximal intervals, from tick 0, in which fewer committed plans occupy it "
    "than its capacity. Where following is forbidden, a plan counts for a tick longer, and a window ends a tick "
    "earlier.",
    f"paper, section III; {MORS}",
)
def windows_are_free(windows: Sequence[Window], occupations: Sequence[Occupation], capacity: int, gap: int = 0) -> bool:
    longer = _longer(occupations, gap)
    bounds = [*longer, *((enter - gap, enter) for enter, _ in longer), *((each.start, each.end) for each in windows)]
    changes = {0, *(max(tick, 0) for pair in bounds for tick in pair if tick is not None)}
    are_right = all(
        any(window.start <= tick and window.lasts_until(tick + 1) for window in windows)
        == all(occupancy(longer, each) < capacity for each in (tick, tick + gap))
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
