"""Rules and violations as people read them."""

import pytest

from carp_spec import Violation, Visit
from carp_spec.rule import at_visit, is_whole, of_robots, rule


@pytest.mark.parametrize(
    ("violation", "printed"),
    [
        (
            Violation("joint/x", ("r1", "r9"), "3,4", 5, 7, "full"),
            "[joint/x] resource 3,4 in [5,7): robots r1, r9 (full)",
        ),
        (
            Violation("plan/x", *at_visit(7, Visit("d", 4, None), "no")),
            "[plan/x] resource d in [4,for ever): robot 7 (no)",
        ),
        (Violation("x", *of_robots(range(5), "no")), "[x] robots 0, 1, 2, 3, 4 (no)"),
        (Violation("x", *of_robots(range(6), "no")), "[x] robots 0, 1, 2, 3, 4 and 1 more (no)"),
    ],
)
def test_a_violation_prints_rule_place_time_some_robots_and_reason(violation: Violation, printed: str) -> None:
    assert str(violation) == printed


@pytest.mark.parametrize(
    ("value", "whole"),
    [(0, True), (-3, True), (10**40, True), (True, False), (1.0, False), ("1", False), (None, False)],
)
def test_booleans_and_floats_are_no_whole_numbers(value: object, whole: bool) -> None:
    assert is_whole(value) is whole


def test_a_rule_is_asked_by_calling_it() -> None:
    @rule("test/even", "The number is even.", "here")
    def is_even(number: int) -> bool:
        return number % 2 == 0

    assert (is_even.id, is_even.statement, is_even.source) == ("test/even", "The number is even.", "here")
    assert is_even(2)
    assert not is_even(number=3)
