"""The formulas of the lemmas say what the program does: both are evaluated on every small input.

So a change of the program that the lemmas do not speak of breaks a test here.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, product

import pytest

from carp_reference import query
from carp_reference.context import Context
from carp_reference.problem import prepare
from carp_reference.query import Node, _expand
from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Visit
from carp_spec import has_ended as plan_has_ended
from carp_spec.plan_rules import plan_keeps_history
from carp_spec.windows import Occupation, Window, free_windows, occupancy, windows_are_free
from carp_spec.windows import stay_fits as spec_stay_fits
from carp_verify.lemmas.counting_gives_occupancy import changes_up_to
from carp_verify.lemmas.entry_is_the_least_allowed import first_candidate, may_enter
from carp_verify.lemmas.history_is_kept import keeps_history, may_leave_from
from carp_verify.lemmas.occupancy_changes_only_where_stays_begin_or_end import no_change
from carp_verify.lemmas.reserving_splits_a_window import held_by_parts
from carp_verify.lemmas.sweeping_makes_the_free_windows import sweep_step
from carp_verify.smt import Answer, Bool, Int, integer, integers, truth, value_of
from carp_verify.vocabulary import has_ended, holds, interval, lasts_until, stay_fits

TICKS = range(5)
STAYS: Sequence[Occupation] = [(a, b) for a in TICKS for b in (*range(a + 1, 5), None)]


def values_of(name: str, stay: Occupation) -> dict[str, Answer]:
    """The unknowns of an interval of that name."""
    start, end = stay
    return {f"{name}.start": start, f"{name}.end": end or 0, f"{name}.for_ever": end is None}


def evaluate(term: Int | Bool, *values: dict[str, Answer]) -> Answer:
    return value_of(term, {name: value for each in values for name, value in each.items()})


def test_holds_is_occupancy_and_the_sum_of_changes_is_too() -> None:
    within, changes = holds(interval("stay"), integer("tick")), changes_up_to(interval("stay"), integer("tick"))
    for stay, tick in product(STAYS, TICKS):
        values = {**values_of("stay", stay), "tick": tick}
        assert evaluate(within, values) == bool(occupancy([stay], tick))
        assert evaluate(changes, values) == occupancy([stay], tick)


def test_no_change_is_said_only_where_the_occupancy_stays_the_same() -> None:
    term = no_change(interval("stay"), *integers("start end"))
    for stay, start, end in product(STAYS, TICKS, TICKS):
        if evaluate(term, values_of("stay", stay), {"start": start, "end": end}) and start <= end:
            assert len({occupancy([stay], tick) for tick in range(start, end + 1)}) == 1


def test_stay_fits_and_lasts_until_are_those_of_the_specification() -> None:
    fits = stay_fits(interval("window"), interval("stay"), integer("duration"))
    lasts = lasts_until(interval("window"), integer("tick"))
    for window in STAYS:
        for tick in TICKS:
            assert evaluate(lasts, values_of("window", window), {"tick": tick}) == Window(*window).lasts_until(tick)
        for (enter, leave), duration in product(STAYS, (1, 2, 3)):
            values = {**values_of("window", window), **values_of("stay", (enter, leave)), "duration": duration}
            assert evaluate(fits, values) == spec_stay_fits(Window(*window), enter, leave, duration)


def swept(occupations: Sequence[Occupation], capacity: int) -> Iterator[Window]:
    """The windows that the lemma's step makes, change by change."""
    is_open_term, opened_term, tick_term, free_term = truth("is_open"), *integers("opened tick"), truth("free")
    step = sweep_step(is_open_term, opened_term, tick_term, free_term)
    changes = {0, *(enter for enter, _ in occupations), *(leave for _, leave in occupations if leave is not None)}
    is_open, opened = False, 0
    for tick in sorted(changes):
        is_free_there = occupancy(occupations, tick) < capacity
        values: dict[str, Answer] = {"is_open": is_open, "opened": opened, "tick": tick, "free": is_free_there}
        if evaluate(step.finishes, values):
            yield Window(opened, tick)
        is_open, opened = bool(evaluate(step.is_open, values)), int(evaluate(step.opened, values))
    if is_open:
        yield Window(opened, None)


@pytest.mark.parametrize("capacity", [1, 2])
def test_the_sweep_makes_the_windows_of_the_specification(capacity: int) -> None:
    small = [stay for stay in STAYS if stay[0] < 3 and (stay[1] or 0) < 4]
    for occupations in [(), *((each,) for each in small), *combinations_with_replacement(small, 2)]:
        windows = tuple(swept(occupations, capacity))
        assert windows == free_windows(occupations, capacity)
        assert windows_are_free(windows, occupations, capacity)


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
        (window,) = free_windows(before, 1)
        for enter, leave in STAYS:
            if spec_stay_fits(window, enter, leave, 1):
                after = free_windows([*before, (enter, leave)], 1)
                values = {**values_of("window", (start, end)), **values_of("stay", (enter, leave))}
                for tick in TICKS:
                    assert evaluate(term, values, {"tick": tick}) == held(after, tick)


def test_an_entry_is_the_one_of_the_reference() -> None:
    graph = ResourceGraph((Resource("r"), Resource("s", duration=2)), (("r", "s"),))
    instance = Instance(graph, (Robot("robot", "r", "s"),))
    first = first_candidate(integer("ready"), interval("entered"))
    allowed = may_enter(integer("ready"), interval("left"), interval("entered"), integer("duration"), integer("tick"))
    lefts: Sequence[Occupation] = [(0, 2), (0, 4), (1, None)]
    entereds: Sequence[Occupation] = [(0, 3), (2, 4), (3, None), (1, 2)]
    for left, entered, ready, exchanges in product(lefts, entereds, (1, 2, 3), ((), (2,), (1, 2, 3))):
        context = Context(instance, {"s": outside(*entered)}, frozenset((tick, ("s", "r")) for tick in exchanges))
        values = {**values_of("left", left), **values_of("entered", entered), "ready": ready, "duration": 2}
        node = Node("r", Window(*left), 0, ready, None)
        found = [each.enter for each in _expand(prepare(instance, 0), context, "robot", node, ["s"])]
        candidates = range(int(evaluate(first, values)), 9)
        expected = [t for t in candidates if t not in exchanges and evaluate(allowed, values, {"tick": t})]
        assert found == expected[:1]


def test_the_heuristic_of_the_reference_is_the_one_of_the_lemma() -> None:
    """It is 0 at the goal, and along every move no more than the duration and the heuristic after it."""
    graph = ResourceGraph(
        tuple(Resource(id, duration=duration) for id, duration in zip("abcde", (1, 3, 2, 1, 2), strict=True)),
        (("a", "b"), ("b", "c"), ("c", "d"), ("a", "e"), ("e", "c")),
    )
    for goal, pace in product("abcde", (1, 2)):
        instance = Instance(graph, (Robot("robot", "a", goal, pace=pace),))
        h = prepare(instance, 0).ticks_to_goal["robot"]
        assert h[goal] == 0
        for source, targets in graph.successors.items():
            assert all(h[source] <= instance.duration("robot", source) + h[target] for target in targets)
            if source != goal:
                assert h[source] == min(instance.duration("robot", source) + h[target] for target in targets)


def test_leaving_and_history_are_those_of_the_specification_and_the_reference() -> None:
    ready, kept = may_leave_from(*integers("enter duration now")), keeps_history(*integers("leave now"))
    for enter, duration, now in product(range(3), (1, 2, 3), range(6)):
        graph = ResourceGraph((Resource("r", duration=duration), Resource("s")), (("r", "s"),))
        plan = query(Instance(graph, (Robot("robot", "r", "s", enter),)), (), "robot", now)
        assert plan is not None
        assert plan.visits[0].leave == evaluate(ready, {"enter": enter, "duration": duration, "now": now})
        before = Plan("robot", (Visit("r", enter, None),))
        for leave in range(enter + 1, 8):
            again = Plan("robot", (Visit("r", enter, leave),))
            if enter <= now:
                broken = any(plan_keeps_history(before, again, now))
                assert evaluate(kept, {"leave": leave, "now": now}) == (not broken)


def test_has_ended_is_that_of_the_specification() -> None:
    term = has_ended(interval("last"), integer("now"))
    for stay, now in product(STAYS, TICKS):
        plan = Plan("robot", (Visit("r", *stay),))
        assert evaluate(term, values_of("last", stay), {"now": now}) == plan_has_ended(plan, now)
