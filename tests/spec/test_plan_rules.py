"""Costs, and what a plan made again must keep; the other rules of a plan are tested with the checker."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import PARKED, SOLVED, VANISHING, plan_of
from tests.spec.strategies import FEWER

from carp_spec import Plan, Visit, has_ended, plan_cost, total_cost
from carp_spec.plan_rules import is_plan_cost, is_total_cost, plan_keeps_history


def test_costs_count_from_the_release_to_entering_the_goal() -> None:
    assert [plan_cost(VANISHING, plan) for plan in SOLVED] == [5, 3, 0]
    assert total_cost(VANISHING, SOLVED) == 8
    assert total_cost(VANISHING, ()) == 0
    assert [is_plan_cost(VANISHING, SOLVED[0], cost) for cost in (4, 5, 6)] == [False, True, False]
    assert [is_total_cost(VANISHING, SOLVED, cost) for cost in (7, 8, 9)] == [False, True, False]


@pytest.mark.parametrize(
    ("plan", "now", "ended"),
    [
        (SOLVED[0], 5, False),
        (SOLVED[0], 6, True),
        (SOLVED[0], 7, True),
        (PARKED[0], 10**9, False),
        (plan_of("r1"), 0, False),
    ],
)
def test_a_plan_has_ended_once_its_last_visit_is_left(plan: Plan, now: int, ended: bool) -> None:
    assert has_ended(plan, now) is ended


WHOLE = SOLVED[0]
HISTORY_TOLD = {
    "another way": (
        plan_of("r1", ("a", 0, 3), ("b", 3, 4)),
        2,
        [
            "[fleet/history] resource a in [0,3): robot r1 (by 2 it was in a, entered at 0 and left at 2)",
            "[fleet/history] resource b in [3,4): robot r1 (by 2 it was in b, entered at 2 and left no earlier than 2)",
        ],
    ),
    "too short": (
        plan_of("r1", ("a", 0, 2)),
        4,
        [
            "[fleet/history] resource b in [2,3): robot r1 (by 4 it was in b, entered at 2 and left at 3)",
            "[fleet/history] resource c in [3,5): robot r1 (by 4 it was in c, entered at 3 and left no earlier than 4)",
        ],
    ),
    "gone on after its end": (
        plan_of("r1", ("a", 0, 2), ("b", 2, 3), ("c", 3, 5), ("d", 5, 6), ("c", 6, 8)),
        6,
        ["[fleet/history] resource c in [6,8): robot r1 (its plan had ended by 6)"],
    ),
}


@pytest.mark.parametrize("what", HISTORY_TOLD)
def test_what_is_not_kept_of_the_history_is_told(what: str) -> None:
    after, now, expected = HISTORY_TOLD[what]
    assert [str(violation) for violation in plan_keeps_history(WHOLE, after, now)] == expected


def was_at(plan: Plan, tick: int) -> tuple[object, int] | None:
    """The resource in which the robot is at the tick, and since when."""
    for visit in plan.visits:
        if visit.enter <= tick and (visit.leave is None or tick < visit.leave):
            return visit.resource, visit.enter
    return None


STAYS = st.lists(st.tuples(st.sampled_from("abc"), st.integers(1, 3)), min_size=1, max_size=4)


def walk(stays: list[tuple[str, int]], parks: bool) -> Plan:
    enters = [sum(stay for _, stay in stays[:at]) for at in range(len(stays) + 1)]
    visits = [Visit(name, enters[at], enters[at + 1]) for at, (name, _) in enumerate(stays)]
    if parks:
        visits[-1] = Visit(visits[-1].resource, visits[-1].enter, None)
    return Plan("r", tuple(visits))


@given(
    before=STAYS,
    after=STAYS,
    parks=st.booleans(),
    parks_again=st.booleans(),
    same=st.integers(0, 4),
    now=st.integers(0, 12),
)
def test_history_is_kept_if_the_robot_was_tick_by_tick_where_it_was(
    before: list[tuple[str, int]], after: list[tuple[str, int]], parks: bool, parks_again: bool, same: int, now: int
) -> None:
    old, new = walk(before, parks), walk([*before[:same], *after], parks_again)
    kept = all(was_at(old, tick) == was_at(new, tick) for tick in range(now))
    present = was_at(old, now)
    if present is None:
        kept = old == new
    elif present[1] == now:
        kept = kept and any((visit.resource, visit.enter) == present for visit in new.visits)
    assert (not list(plan_keeps_history(old, new, now))) == kept


@FEWER
@given(stays=STAYS, parks=st.booleans(), now=st.integers(-1, 12))
def test_a_plan_keeps_its_own_history(stays: list[tuple[str, int]], parks: bool, now: int) -> None:
    plan = walk(stays, parks)
    assert not list(plan_keeps_history(plan, plan, now))
