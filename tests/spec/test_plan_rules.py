"""Costs, stops, and what a plan made again must keep; the other rules of a plan are tested with the checker."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from tests.spec.making import PARKED, SOLVED, plan_of

import carp_spec
from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Stop, Visit, has_ended
from carp_spec.instance_rules import stops_are_places_to_serve
from carp_spec.plan_rules import least_stays, plan_keeps_history, stops_left, stops_served


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


PICK = Robot("r1", "a", stops=(Stop("a", 4), Stop("c", 2), Stop("c2", 0), Stop("c", 3)), pace=2)
HALL = Instance(
    ResourceGraph((Resource("a"), Resource("c"), Resource("c2", duration=2)), (("a", "c"), ("c", "c2"))), (PICK,)
)
BUSY = plan_of("r1", ("a", 0, 2), ("c", 2, 4), ("a", 4, 8), ("c", 8, 10), ("c2", 10, 14), ("c", 14, 17))


@pytest.mark.parametrize(("visits", "served"), [(0, 0), (1, 0), (2, 0), (3, 1), (4, 2), (5, 3), (6, 4)])
def test_a_visit_serves_the_next_stop_if_it_is_there_for_long_enough(visits: int, served: int) -> None:
    assert stops_served(PICK.stops, BUSY.visits[:visits]) == served
    assert carp_spec.stops_served(PICK.stops, BUSY.visits[:visits]) == served
    assert stops_served(PICK.stops[:-1], BUSY.visits[:visits]) == min(served, 3)
    assert stops_served(PICK.stops, [Visit("a", 7, 10)]) == 0, "it is there for 3 of 4 ticks"
    assert stops_served(PICK.stops, [Visit("c", 0, 9)]) == 0, "it is elsewhere"
    under_way = [*BUSY.visits[: visits - 1], structs.replace(BUSY.visits[visits - 1], leave=None)] if visits else []
    assert stops_served(PICK.stops, under_way) == stops_served(PICK.stops, BUSY.visits[: max(visits - 1, 0)])


def test_stops_are_left_until_the_visit_that_serves_them_has_ended() -> None:
    left = [len(stops_left(PICK, BUSY, now)) for now in (0, 4, 7, 8, 9, 10, 13, 14, 99)]
    assert left == [4, 4, 4, 3, 3, 2, 2, 1, 1]
    assert stops_left(PICK, BUSY, 8) == PICK.stops[1:]
    assert stops_left(PICK, None, 8) == PICK.stops


def test_visits_that_serve_last_as_long_as_the_service_and_others_as_the_duration() -> None:
    assert least_stays(HALL, BUSY) == [2, 2, 4, 2, 4, 3]
    slow = replace(HALL, robots=(replace(PICK, pace=1),))
    assert least_stays(slow, BUSY) == [1, 1, 4, 2, 2, 3]


@pytest.mark.parametrize(
    ("stops", "path"),
    [
        ((), "$.robots[0].stops"),
        ((Stop("a", 1.5),), "$.robots[0].stops[0].service"),  # type: ignore[arg-type]
        ((Stop("a", -1),), "$.robots[0].stops[0].service"),
        ((Stop("a"), Stop("b")), "$.robots[0].stops[1].resource"),
        ((Stop("a"), Stop("c"), Stop("c", 1)), "$.robots[0].stops[2].resource"),
    ],
)
def test_what_is_no_list_of_stops_is_told_with_its_place(stops: tuple[Stop, ...], path: str) -> None:
    wrong = replace(HALL, robots=(replace(PICK, stops=stops),))
    assert [(fault.rule, fault.path) for fault in stops_are_places_to_serve(wrong)] == [("instance/stops", path)]


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
