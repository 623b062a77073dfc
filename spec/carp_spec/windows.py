"""Free time windows: `window/...`, as pure functions on the occupations of one resource.

An occupation is a committed stay [enter, leave) in the resource; a leave of `None` is for ever.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from carp_spec.rule import MORS, rule

Occupation: TypeAlias = tuple[int, int | None]


@dataclass(frozen=True, slots=True)
class Window:
    """The ticks [start, end) in which a resource has room for one more robot; an end of `None` is for ever."""

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
    change = {0: 0}
    for enter, leave in occupations:
        change[enter] = change.get(enter, 0) + 1
        if leave is not None:
            change[leave] = change.get(leave, 0) - 1
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
    return (*windows, Window(opened, None)) if opened is not None else tuple(windows)


@rule(
    "window/free",
    "The free windows of a resource are the maximal intervals, from tick 0, in which fewer committed plans occupy it "
    "than its capacity, so that there is room for one robot more. Where following is forbidden, a plan counts for a "
    "tick longer, and a window ends a tick earlier.",
    f"paper, section III; {MORS}",
)
def windows_are_free(windows: Sequence[Window], occupations: Sequence[Occupation], capacity: int, gap: int = 0) -> bool:
    longer = _longer(occupations, gap)
    ends = [end for _, end in longer if end is not None]
    bounds = [bound for window in windows for bound in (window.start, window.end) if bound is not None]
    starts = [tick for enter, _ in occupations for tick in (max(enter - gap, 0), enter)]
    ticks = {0, *starts, *ends, *bounds}
    shown = [(tick, any(window.start <= tick and window.lasts_until(tick + 1) for window in windows)) for tick in ticks]
    all_told_rightly = all(
        free == all(occupancy(longer, each) < capacity for each in (tick, tick + gap)) for tick, free in shown
    )
    each_lasts = all(window.start >= 0 and (window.end is None or window.start < window.end) for window in windows)
    gaps_between = all(one.end is not None and one.end < two.start for one, two in pairwise(windows))
    return all_told_rightly and each_lasts and gaps_between


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
