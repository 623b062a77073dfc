"""Free time windows: as the ticks say, and no other list passes for them."""

from collections.abc import Sequence

from hypothesis import example, given
from hypothesis import strategies as st

from carp_spec.windows import Constraint, Occupation, Window, free_windows, occupancy, stay_fits, windows_are_free

HORIZON = 30
STAYS = st.tuples(st.integers(0, 12), st.integers(1, 6) | st.none()).map(
    lambda stay: (stay[0], None if stay[1] is None else stay[0] + stay[1])
)
OCCUPATIONS = st.lists(STAYS, max_size=6)
CAPACITIES = st.integers(1, 3)
CONSTRAINTS = st.lists(st.tuples(OCCUPATIONS, CAPACITIES), min_size=1, max_size=3)
GAPS = st.integers(0, 1)


def room(constraints: Sequence[Constraint], gap: int = 0) -> list[bool]:
    """Tick by tick, whether each constraint has room for one robot more, in that tick and the `gap` ticks after it."""
    free = [True] * (HORIZON + gap)
    for occupations, capacity in constraints:
        stays = [range(enter, HORIZON + gap if leave is None else leave + gap) for enter, leave in occupations]
        free = [has and capacity > sum(tick in stay for stay in stays) for tick, has in enumerate(free)]
    return [all(free[tick : tick + gap + 1]) for tick in range(HORIZON)]


def runs(ticks: Sequence[bool]) -> list[Window]:
    """The maximal runs of free ticks; a run that reaches the horizon is for ever."""
    starts = [tick for tick in range(HORIZON) if ticks[tick] and (tick == 0 or not ticks[tick - 1])]
    ends = [tick for tick in range(1, HORIZON) if ticks[tick - 1] and not ticks[tick]]
    return [Window(start, end) for start, end in zip(starts, [*ends, None], strict=False)]


@given(occupations=OCCUPATIONS, tick=st.integers(0, HORIZON - 1), capacity=CAPACITIES)
def test_occupancy_counts_the_stays_that_hold_the_tick(occupations: list[Occupation], tick: int, capacity: int) -> None:
    assert (occupancy(occupations, tick) < capacity) == room([(occupations, capacity)])[tick]


@given(constraints=CONSTRAINTS, gap=GAPS)
@example(constraints=[([(0, 1), (3, None)], 1)], gap=1)  # the tick between them is no window
def test_free_windows_are_the_maximal_runs_of_free_ticks(constraints: list[Constraint], gap: int) -> None:
    windows = free_windows(constraints, gap)
    assert list(windows) == runs(room(constraints, gap))
    assert windows_are_free(windows, constraints, gap)


@given(constraints=CONSTRAINTS, gap=GAPS)
def test_every_small_change_to_the_free_windows_is_refused(constraints: list[Constraint], gap: int) -> None:
    windows = free_windows(constraints, gap)
    for at, window in enumerate(windows):
        last = HORIZON if window.end is None else window.end
        for others in (
            (),
            (Window(window.start + 1, window.end),),
            (Window(window.start - 1, window.end),),
            (Window(window.start, last + 1),),
            (Window(window.start, last - 1),),
            (Window(window.start, last), Window(last, window.end)),
            (window, window),
            (window, Window(last, last)),
            (window, Window(last + 1, last + 1)),
            (window, Window(last + 2, last + 1)),
        ):
            assert not windows_are_free((*windows[:at], *others, *windows[at + 1 :]), constraints, gap)
    if len(windows) > 1:
        assert not windows_are_free(windows[::-1], constraints, gap)


@given(
    start=st.integers(0, 6),
    lasts=st.integers(1, 6) | st.none(),
    enter=st.integers(0, 9),
    stays=st.integers(0, 6) | st.none(),
    duration=st.integers(1, 5),
)
@example(start=0, lasts=5, enter=1, stays=2, duration=2)
def test_a_stay_fits_if_all_its_ticks_are_in_the_window_and_enough(
    start: int, lasts: int | None, enter: int, stays: int | None, duration: int
) -> None:
    window = range(start, HORIZON if lasts is None else start + lasts)
    ticks = range(enter, HORIZON if stays is None else enter + stays)
    leave = None if stays is None else enter + stays
    fits = all(tick in window for tick in ticks) and len(ticks) >= duration
    assert stay_fits(Window(start, None if lasts is None else start + lasts), enter, leave, duration) == fits
