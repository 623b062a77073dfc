"""The formulas of the lemmas are derived from the program: they answer as it does, and change where it does."""

import inspect
from collections.abc import Sequence
from itertools import product
from types import ModuleType

import pytest

from carp_spec import Plan, Visit, neighbourhood_rules, plan_rules, windows
from carp_spec.windows import Occupation, Window, free_windows, occupancy
from carp_verify.lemmas import lemma_named
from carp_verify.lemmas.derivation import Way, derived
from carp_verify.lemmas.engine import examine
from carp_verify.lemmas.reserving_splits_a_window import held_by_parts
from carp_verify.lemmas.smt import (
    Answer,
    Bool,
    Int,
    at_least,
    counted,
    find_model,
    greater,
    integer,
    integers,
    negation,
    truth,
    value_of,
)
from carp_verify.lemmas.vocabulary import has_ended, holds, interval, is_interval, replaces_best, stay_fits

TICKS = range(5)
STAYS: Sequence[Occupation] = [(a, b) for a in TICKS for b in (*range(a + 1, 5), None)]


def values_of(name: str, stay: Occupation) -> dict[str, Answer]:
    """The unknowns of an interval of that name."""
    start, end = stay
    return {f"{name}.start": start, f"{name}.end": end or 0, f"{name}.for_ever": end is None}


def evaluate(term: Int | Bool, *values: dict[str, Answer]) -> Answer:
    return value_of(term, {name: value for each in values for name, value in each.items()})


def test_holds_is_occupancy() -> None:
    within = holds(interval("stay"), integer("tick"))
    for stay, tick in product(STAYS, TICKS):
        assert evaluate(within, values_of("stay", stay), {"tick": tick}) == bool(occupancy([stay], tick))


def test_an_interval_has_a_tick_and_none_before_0() -> None:
    term = is_interval(interval("stay"))
    for start, end in product(range(-1, 4), (*range(-1, 4), None)):
        ticks = [tick for tick in range(-2, 9) if occupancy([(start, end)], tick)]
        assert evaluate(term, values_of("stay", (start, end))) == (ticks != [] and min(ticks) >= 0)


def test_stay_fits_is_that_of_the_specification() -> None:
    fits = stay_fits(interval("window"), interval("stay"), integer("duration"))
    for window, (enter, leave), duration in product(STAYS, STAYS, (1, 2, 3)):
        values = {**values_of("window", window), **values_of("stay", (enter, leave)), "duration": duration}
        assert evaluate(fits, values) == windows.stay_fits(Window(*window), enter, leave, duration)


def test_has_ended_is_that_of_the_specification() -> None:
    term = has_ended(interval("last"), integer("now"))
    for stay, now in product(STAYS, TICKS):
        plan = Plan("robot", (Visit("r", *stay),))
        assert evaluate(term, values_of("last", stay), {"now": now}) == plan_rules.has_ended(plan, now)


def test_replaces_best_is_that_of_the_specification() -> None:
    term = replaces_best(*integers("cost best"))
    for cost, best in product(TICKS, TICKS):
        assert evaluate(term, {"cost": cost, "best": best}) == neighbourhood_rules.replaces_best(cost, best)


@pytest.mark.parametrize(
    ("module", "name", "right", "wrong", "lemma"),
    [
        (windows, "stay_fits", "window.start <= enter", "window.start <= enter + 1", "reserving_splits_a_window"),
        (windows, "stay_fits", "and window.lasts_until(leave)", "", "reserving_splits_a_window"),
        (windows, "occupancy", "tick < leave", "tick <= leave", "reserving_splits_a_window"),
        (plan_rules, "has_ended", "leave <= now", "leave <= now + 1", "ended_plans_occupy_nothing"),
        (plan_rules, "has_ended", "leave is not None and", "leave is None or", "ended_plans_occupy_nothing"),
        (neighbourhood_rules, "replaces_best", "cost < best", "cost <= best", "cut_permutations_are_no_better"),
    ],
)
def test_an_error_planted_in_the_program_breaks_the_lemma(
    monkeypatch: pytest.MonkeyPatch, module: ModuleType, name: str, right: str, wrong: str, lemma: str
) -> None:
    function = getattr(module, name)
    source = inspect.getsource(getattr(function, "predicate", function))
    source = source[source.index("def ") :]
    assert source.count(right) == 1
    planted = dict(vars(module))
    exec(source.replace(right, wrong), planted)  # noqa: S102 - our own source
    assert examine(lemma_named(lemma)).checked
    monkeypatch.setattr(module, name, planted[name])
    assert not examine(lemma_named(lemma)).checked


def test_a_term_is_derived_from_whatever_python_does_with_whole_numbers() -> None:
    def odd_steps(way: Way) -> bool:
        a, b = way.number(integer("a")), way.number(integer("b"))
        low, high = min(a, b), max(a, b)
        steps = sum(low + step < high for step in range(3))
        return bool(a - b) and 1 - high != b and steps != 2 and (2 + a - b > 3 or a >= 3)

    term = derived(odd_steps)
    for a, b in product(range(-2, 5), repeat=2):
        low, high = min(a, b), max(a, b)
        steps = sum(low + step < high for step in range(3))
        expected = a != b and 1 - high != b and steps != 2 and (2 + a - b > 3 or a >= 3)
        assert evaluate(term, {"a": a, "b": b}) == expected


def test_a_function_of_one_answer_is_derived_too() -> None:
    assert find_model([negation(derived(lambda _: True))]) is None
    assert find_model([derived(lambda _: False)]) is None


@pytest.mark.parametrize("use", ["number // 2", "number * number", "[1, 2][number]", "{number}", "int(number)"])
def test_a_use_of_a_number_that_is_not_known_is_no_term(use: str) -> None:
    with pytest.raises(TypeError):
        derived(lambda way: eval(use, {"number": way.number(integer("number"))}))  # noqa: S307 - our own source


def test_a_term_with_an_unknown_left_has_no_value() -> None:
    with pytest.raises(ValueError, match="b is no known value"):
        value_of(integer("b"), {"a": 1})


def test_a_model_has_a_value_for_what_no_formula_is_about() -> None:
    model = find_model([truth("a")])
    assert model is not None
    assert isinstance(model.value(integer("b")), int)


def test_terms_count_and_compare() -> None:
    assert [evaluate(counted(truth("a")), {"a": holds}) for holds in (False, True)] == [0, 1]
    for a, b in product(range(3), repeat=2):
        assert evaluate(greater(integer("a"), integer("b")), {"a": a, "b": b}) == max(a, b)
    for values in product((False, True), repeat=3):
        for count in range(1, 5):
            term = at_least(count, [truth(name) for name in "abc"])
            assert evaluate(term, dict(zip("abc", values, strict=True))) == (sum(values) >= count)


def outside(start: int, end: int | None) -> list[Occupation]:
    """Stays that leave a resource of capacity one free in [start, end)."""
    before: list[Occupation] = [(0, start)] if start else []
    return before if end is None else [*before, (end, None)]


def held(windows: Sequence[Window], tick: int) -> bool:
    return any(window.start <= tick and window.lasts_until(tick + 1) for window in windows)


def test_the_parts_of_a_split_window_are_the_free_windows_of_capacity_one() -> None:
    term = held_by_parts(interval("window"), interval("stay"), integer("tick"))
    for start, end in STAYS:
        before = outside(start, end)
        (window,) = free_windows([(before, 1)])
        for enter, leave in STAYS:
            if windows.stay_fits(window, enter, leave, 1):
                after = free_windows([([*before, (enter, leave)], 1)])
                values = {**values_of("window", (start, end)), **values_of("stay", (enter, leave))}
                for tick in TICKS:
                    assert evaluate(term, values, {"tick": tick}) == held(after, tick)
