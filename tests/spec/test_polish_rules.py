"""The decisions of a polish: what is drawn, who is taken out, in which order, and what is kept."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import count, islice
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tests.spec.making import SOLVED, VANISHING, instance_on, line, plan_of
from tests.spec.strategies import FEWER

from carp_spec import Plan, Refusal, Robot, Solution, Visit
from carp_spec.inputs.options import require_polish_options
from carp_spec.permutations import splitmix64
from carp_spec.planners import LARGEST_SEED
from carp_spec.polish_rules import (
    ITERATIONS,
    KINDS,
    LEAST_MEMBERS,
    SIZES,
    by_distance,
    drawn,
    is_in_way,
    is_kept,
    kind_of,
    last_round,
    members_of,
    options_are_right,
    order_of,
    pivot_of,
    spans,
    ticks_apart,
)
from carp_spec.requests import sound_solution

SEEDS = st.integers(0, LARGEST_SEED)
ROW = line("abcde")


@st.composite
def walks(draw: st.DrawFn, robot: str) -> Plan:
    """Visits of neighbouring cells of a row, one after the other."""
    at = draw(st.integers(0, 4))
    tick = draw(st.integers(0, 6))
    visits = []
    for step in draw(st.lists(st.sampled_from([-1, 1]), max_size=5)):
        leave = tick + draw(st.integers(1, 3))
        visits.append(Visit("abcde"[at], tick, leave))
        at, tick = (at + step) % 5, leave
    return Plan(robot, (*visits, Visit("abcde"[at], tick, draw(st.sampled_from([None, tick + 1])))))


@FEWER
@given(st.lists(st.integers(), max_size=8), SEEDS, st.data())
def test_some_are_drawn_as_all_are_and_each_once(things: list[int], seed: int, data: st.DataObject) -> None:
    some = data.draw(st.integers(0, len(things)))
    stream = splitmix64(seed)
    everything = drawn(things, len(things), splitmix64(seed))
    assert drawn(things, some, stream) == everything[:some]
    assert sorted(everything) == sorted(things)
    assert next(stream) == next(islice(splitmix64(seed), some, None)), "a number for each"


def test_each_of_two_things_is_drawn_first_by_its_number() -> None:
    assert [drawn("ab", 2, iter([number, 0])) for number in (0, 1, 2, 3)] == [["a", "b"], ["b", "a"]] * 2


@FEWER
@given(st.integers(0, 9), st.integers(0, 2), st.integers(0, 2), SEEDS)
def test_rounds_repair_in_turn_and_end_when_nothing_is_left(turn: int, waiting: int, delay: int, number: int) -> None:
    kind = kind_of(turn, waiting, delay, iter([number]))
    assert (kind is None) == (waiting == 0 == delay)
    if waiting and delay:
        assert (kind == "repair") == (turn in (0, 2, 4, 6, 8))
    elif waiting:
        assert kind == "repair"
    elif delay:
        assert kind == KINDS[number % 10]


def test_eight_of_ten_rounds_are_for_a_delayed_robot() -> None:
    kinds = [kind_of(1, 0, 1, iter([number])) for number in range(10)]
    assert kinds == ["delayed"] * 8 + ["contested", "near"]


@FEWER
@given(st.lists(st.integers(0, 3), min_size=1, max_size=5).filter(any))
def test_a_pivot_is_chosen_by_as_many_numbers_as_its_weight(weights: list[int]) -> None:
    chosen = [pivot_of(weights, iter([number])) for number in range(sum(weights))]
    assert chosen == sorted(chosen)
    assert [chosen.count(place) for place in range(len(weights))] == weights


@FEWER
@given(st.integers(1, 14), st.integers(0, 12), SEEDS)
def test_members_are_the_pivot_the_first_candidates_and_others(robots: int, candidates: int, seed: int) -> None:
    everyone = list(range(robots))
    near = everyone[1:][::-1][:candidates]
    members = members_of(0, near, everyone, splitmix64(seed))
    size = min(LEAST_MEMBERS + next(splitmix64(seed)) % SIZES, robots)
    assert len(set(members)) == len(members) == size
    assert members[0] == 0
    assert members[1 : 1 + len(near)] == near[: size - 1]
    assert set(members) <= set(everyone)


@FEWER
@given(walks("r1"), walks("r2"))
def test_in_the_way_is_who_is_near_between_the_first_tick_and_the_last(plan: Plan, other: Plan) -> None:
    end = 40

    def ticks(visits: Sequence[Visit]) -> set[int]:
        first = min((visit.enter for visit in visits), default=0)
        last = max((end if visit.leave is None else visit.leave for visit in visits), default=-1)
        return set(range(first, last + 1))

    met = False
    for cell in "abcde":
        near = [visit for visit in plan.visits if visit.resource in (cell, *ROW.successors[cell])]
        met |= any(visit.resource == cell and ticks([visit]) & ticks(near) for visit in other.visits)
    assert is_in_way(spans(ROW.successors, plan), other) == met


@pytest.mark.parametrize(
    ("enter", "leave", "is_met"), [(2, 4, False), (2, 5, True), (2, None, True), (8, 9, True), (9, 10, False)]
)
def test_a_stay_is_in_the_way_from_the_first_tick_of_a_span_to_the_last(
    enter: int, leave: int | None, is_met: bool
) -> None:
    plan, other = Plan("r1", (Visit("c", 5, 8),)), Plan("r2", (Visit("b", enter, leave),))
    assert is_in_way(spans(ROW.successors, plan), other) == is_met


@FEWER
@given(walks("r1"), walks("r2"))
def test_robots_that_cross_a_resource_are_apart_by_ticks(plan: Plan, other: Plan) -> None:
    for visit in plan.visits:
        there = {each.enter for each in other.visits if each.resource == visit.resource}
        near = (ticks for ticks in count() if {visit.enter - ticks, visit.enter + ticks} & there)
        assert ticks_apart(visit, other) == (next(near) if there else None)


@FEWER
@given(st.lists(st.fractions(0, 3, max_denominator=3), max_size=6))
def test_near_robots_come_by_distance_and_equals_in_their_order(distances: list[Fraction]) -> None:
    assert by_distance(distances) == sorted(range(len(distances)), key=lambda place: (distances[place], place))


@FEWER
@given(st.lists(st.integers(), min_size=1, max_size=6, unique=True), st.booleans(), SEEDS)
def test_an_order_has_each_member_once_and_a_repair_begins_with_the_pivot(
    members: list[int], is_repair: bool, seed: int
) -> None:
    order = order_of(members, is_repair, splitmix64(seed))
    assert sorted(order) == sorted(members)
    if is_repair or next(splitmix64(seed)) % 2 == 0:
        assert order[0] == members[0]


def test_a_shuffled_pivot_can_come_anywhere() -> None:
    assert {order_of("pab", False, splitmix64(seed)).index("p") for seed in range(50)} == {0, 1, 2}


@FEWER
@given(*[st.integers(0, 3)] * 4)
def test_what_is_kept_leaves_fewer_unplanned_or_as_many_at_no_larger_total(
    unplanned: int, total: int, unplanned_now: int, total_now: int
) -> None:
    kept = is_kept((unplanned, total), (unplanned_now, total_now))
    assert kept == (unplanned_now < unplanned or (unplanned_now == unplanned and total_now <= total))


@FEWER
@given(st.integers(-3, LARGEST_SEED + 3) | st.sampled_from([True, 1.5, float("nan"), float("inf"), "1"]))
@example(-1)
@example(1)
@example(LARGEST_SEED + 1)
def test_options_are_numbers_within_their_bounds(value: Any) -> None:  # noqa: ANN401 - nonsense too
    whole = type(value) is int
    assert (not [*options_are_right(value, None, 0)]) == (whole and value >= 0)
    assert (not [*options_are_right(None, value, 0)]) == (value == 1.5 or (whole and value > 0))
    assert (not [*options_are_right(None, None, value)]) == (whole and 0 <= value <= LARGEST_SEED)


def test_there_are_rounds_or_a_time() -> None:
    assert (last_round(None, None), last_round(7, None), last_round(None, 0.5)) == (ITERATIONS, 7, None)
    with pytest.raises(Refusal, match="not both"):
        require_polish_options(1, 1, 0)


def test_robots_that_are_not_named_are_unplanned_and_broken_rules_are_refused() -> None:
    instance = instance_on(ROW, Robot("r1", "a", "b"), Robot("r2", "d", "e"))
    plan = plan_of("r1", ("a", 0, 1), ("b", 1, 2))
    assert sound_solution(instance, Solution((plan,), ("r1",))).unplanned == ("r2",)
    assert sound_solution(VANISHING, Solution(SOLVED, tuple(each.robot for each in SOLVED))).unplanned == ()
    with pytest.raises(Refusal, match="plan/goal"):
        sound_solution(instance, Solution((plan_of("r1", ("a", 0, 1), ("b", 1, 3)),), ("r1",)))
