"""Rules and violations as people read them."""

import pytest
from tests.spec.making import PARKING, SOLVED, VANISHING, plan_of

from carp_spec import Violation, Visit, violations_of
from carp_spec.rule import at_visit, interval, is_whole, of_robots, rule


def test_a_violation_prints_rule_place_time_robots_and_reason() -> None:
    violation = Violation("joint/capacity", ("r1", "r9"), "3,4", 5, 7, "capacity 1")
    assert str(violation) == "[joint/capacity] resource 3,4 in [5,7): robots r1, r9 (capacity 1)"


def test_a_violation_of_many_robots_names_the_first_five_and_counts_the_others() -> None:
    six = Violation("joint/capacity", tuple(range(6)), "a", 5, 7, "capacity 1")
    assert str(six) == "[joint/capacity] resource a in [5,7): robots 0, 1, 2, 3, 4 and 1 more (capacity 1)"
    five = Violation("joint/capacity", tuple(range(5)), "a", 5, 7, "capacity 1")
    assert str(five) == "[joint/capacity] resource a in [5,7): robots 0, 1, 2, 3, 4 (capacity 1)"


def test_a_violation_for_ever_prints_so() -> None:
    violation = Violation("plan/goal", *at_visit(7, Visit("d", 4, None), "the last visit must be to c"))
    assert str(violation) == "[plan/goal] resource d in [4,for ever): robot 7 (the last visit must be to c)"


def test_a_violation_without_place_and_time_prints_neither() -> None:
    violation = Violation("solution/covers", *of_robots(["r1", "r2"], "the instance has no such robot"))
    assert str(violation) == "[solution/covers] robots r1, r2 (the instance has no such robot)"
    assert (violation.resource, violation.start, violation.end) == (None, None, None)


def test_the_checker_prints_one_line_a_violation() -> None:
    plans = (
        plan_of("r1"),
        plan_of("r2", ("e", 1, 2), ("b", 3, 4), ("d", 4, None)),
        plan_of("r3", ("d", 4, 4), ("x", 4, 6), ("c", 6, 7), ("f", 7, 8)),
    )
    assert [str(violation) for violation in violations_of(VANISHING, plans)] == [
        "[plan/start] robot r1 (the first visit must be to a at the release tick 0, and there is no visit)",
        "[plan/start] resource d in [4,4): robot r3 (the first visit must be to f at the release tick 0)",
        "[plan/goal] robot r1 (the last visit must be to d, and there is no visit)",
        "[plan/goal] resource d in [4,for ever): robot r2 (the last visit must be to a)",
        "[plan/resource] resource x in [4,6): robot r3 (the graph has no such resource)",
        "[plan/move] resource d in [4,for ever): robot r2 (the graph has no move to it from b)",
        "[plan/contiguous] resource b in [3,4): robot r2 (it must enter when it leaves e, which is left at 2)",
        "[plan/duration] resource d in [4,4): robot r3 (it stays 0 of at least 1 ticks)",
        "[plan/duration] resource c in [6,7): robot r3 (it stays 1 of at least 2 ticks)",
    ]


def test_the_checker_prints_how_a_plan_must_end() -> None:
    late = plan_of("r3", ("f", 0, 2))
    ends = [str(violation) for instance in (VANISHING, PARKING) for violation in violations_of(instance, [late])]
    assert ends == [
        "[plan/goal] resource f in [0,2): robot r3 (it must leave the goal at 1)",
        "[plan/goal] resource f in [0,2): robot r3 (it must stay at the goal for ever)",
    ]


def test_the_checker_prints_what_happens_between_robots() -> None:
    first = plan_of("r1", ("a", 0, 4), ("b", 4, 5), ("c", 5, 7), ("d", 7, 8))
    assert [str(violation) for violation in violations_of(VANISHING, (first, *SOLVED[1:]))] == [
        "[joint/exchange] resource a in [4,5): robots r1, r2 (they exchange a and b at tick 4)"
    ]


@pytest.mark.parametrize(
    ("value", "whole"),
    [(0, True), (-3, True), (10**40, True), (True, False), (1.0, False), ("1", False), (None, False)],
)
def test_booleans_and_floats_are_no_whole_numbers(value: object, whole: bool) -> None:
    assert is_whole(value) is whole


@pytest.mark.parametrize(("end", "printed"), [(7, "[5,7)"), (None, "[5,for ever)")])
def test_intervals_are_printed_half_open(end: int | None, printed: str) -> None:
    assert interval(5, end) == printed


def test_a_rule_is_asked_by_calling_it() -> None:
    @rule("test/even", "The number is even.", "here")
    def is_even(number: int) -> bool:
        return number % 2 == 0

    assert (is_even.id, is_even.statement, is_even.source) == ("test/even", "The number is even.", "here")
    assert is_even(2)
    assert not is_even(number=3)
