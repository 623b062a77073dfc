"""Integer leaf functions of the specification, stated again in one line each, on CrossHair.

It looks for counterexamples by symbolic execution, and finds a `stay_fits` that is wrong for the one entry 123457,
which random examples do not.
"""

from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carp_spec.neighbourhood_rules import replaces_best, replanned_from
from carp_spec.windows import Window, occupancy, stay_fits

EXAMPLES = 300

Check = Callable[[int, int, int, int], None]


def fits_is_four_comparisons(start: int, length: int, enter: int, stay: int) -> None:
    window = Window(start, start + length)
    fits = start <= enter and stay >= 2 and enter + stay <= start + length
    assert stay_fits(window, enter, enter + stay, 2) == fits


def an_endless_stay_fits_an_endless_window_alone(start: int, length: int, enter: int, duration: int) -> None:
    assert stay_fits(Window(start, None), enter, None, duration) == (start <= enter)
    assert not stay_fits(Window(start, start + length), enter, None, duration)


def an_occupation_holds_its_half_open_interval(enter: int, length: int, tick: int, other: int) -> None:
    held = occupancy([(enter, enter + length), (other, None)], tick)
    assert held == (enter <= tick < enter + length) + (other <= tick)


def the_earlier_position_is_replanned_and_the_smaller_cost_kept(taken: int, planned: int, cost: int, best: int) -> None:
    assert replanned_from(taken, planned) in {taken, planned}
    assert replanned_from(taken, planned) <= taken
    assert replanned_from(taken, planned) <= planned
    assert replaces_best(cost, best) == (best > cost)


LEAVES: list[Check] = [
    fits_is_four_comparisons,
    an_endless_stay_fits_an_endless_window_alone,
    an_occupation_holds_its_half_open_interval,
    the_earlier_position_is_replanned_and_the_smaller_cost_kept,
]


@pytest.mark.nightly
@pytest.mark.parametrize("leaf", LEAVES, ids=lambda leaf: leaf.__name__)
def test_a_leaf_function_does_what_one_line_says(leaf: Check) -> None:
    numbers = st.integers()

    @settings(backend="crosshair", max_examples=EXAMPLES, deadline=None, database=None)
    @given(numbers, numbers, numbers, numbers)
    def check(first: int, second: int, third: int, fourth: int) -> None:
        leaf(first, second, third, fourth)

    check()
