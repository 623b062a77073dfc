"""Cuts and deadlines of groups of robots, also of robots that are seen at a tick, in lower bounds."""

from collections.abc import Callable
from itertools import product

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.verify.bound_examples import (
    HORIZON,
    SCALE,
    Tamper,
    certificates,
    crossing,
    cut_certificate,
    deadline_certificate,
    left,
    payment,
    plans_of,
    sight_certificate,
)
from tests.verify.plain_search import least_cost_of
from tests.verify.tampered_bounds import TAMPERED

from carp_optimum.bound import lower_bound
from carp_optimum.sat.solver import Solver
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument, CutDocument, DeadlinesDocument, Sight
from carp_spec.documents.instances import digest
from carp_spec.plan_rules import plan_cost
from carp_verify.bound.cuts import formula_of, formula_of_deadlines
from carp_verify.bound.tariff import Fees, Tariff
from carp_verify.bound.verify import verify_bound
from carproof.testing.strategies import Sizes, instances


@settings(max_examples=draws(120))
@given(st.data(), instances(Sizes(resources=3, robots=1, capacity=1, duration=2, release=3, pace=1), least_robots=1))
def test_who_keeps_a_deadline_pays_for_it_and_may_drive_on_through_the_goal_to_miss_it(
    data: st.DataObject, instance: Instance
) -> None:
    certificate = data.draw(certificates(instance))
    robot = instance.robots[0]
    fees = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), st.integers(0, 4 * SCALE)), max_size=3))
    costs = [
        SCALE * plan_cost(instance, plan)
        + payment(instance, certificate, plan)
        + sum(price for tick, price in fees if plan.visits[-1].enter <= tick)
        for plan in plans_of(instance, robot)
    ]
    tariff = Tariff(instance, certificate)
    assert least_cost_of(tariff, robot, SCALE, Fees(fees)) == min(costs, default=None)


@settings(max_examples=draws(200))
@given(st.data(), instances(Sizes(resources=3, robots=1, capacity=1, duration=3, release=3, pace=1), least_robots=1))
def test_who_is_seen_in_a_place_on_the_way_pays_for_it_once(data: st.DataObject, instance: Instance) -> None:
    certificate = data.draw(certificates(instance))
    robot = instance.robots[0]
    places = st.sets(st.sampled_from([resource.id for resource in instance.graph.resources]))
    prices = st.integers(0, 4 * SCALE)
    arrivals = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), prices), max_size=2))
    sights = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), places, prices), max_size=4))
    fees = Fees([*arrivals, (0, 0)], sights)
    costs = [
        SCALE * plan_cost(instance, plan)
        + payment(instance, certificate, plan)
        + sum(price for tick, price in arrivals if plan.visits[-1].enter <= tick)
        + sum(
            price
            for tick, counted, price in sights
            if any(visit.resource in counted and visit.enter <= tick < left(visit) for visit in plan.visits[:-1])
        )
        for plan in plans_of(instance, robot)
    ]
    tariff = Tariff(instance, certificate)
    assert least_cost_of(tariff, robot, SCALE, fees) == min(costs, default=None)


def test_who_vanishes_drives_on_through_its_goal_where_nothing_else_makes_it_late() -> None:
    """It pays 20 to come by tick 3, and 9 for each tick of waiting: on to c and back to b costs 2 ticks more."""
    lane = Instance(
        ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c"))),
        (Robot("r", "a", "b"),),
        after_goal="vanish",
    )
    waits = tuple(("a", tick, 9) for tick in range(1, HORIZON))
    tariff = Tariff(lane, BoundDocument(BOUND_FORMAT, digest(lane), 0, 1, HORIZON, waits, (), (), ()))
    assert [least_cost_of(tariff, lane.robots[0], 1, Fees([(tick, 20)])) for tick in (0, 1, 2, 3)] == [1, 3, 3, 4]


def test_who_waits_pays_for_the_ticks_of_its_waiting_alone() -> None:
    lane = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b"),))
    keep_away = BoundDocument(BOUND_FORMAT, digest(lane), 0, 1, HORIZON, (("b", 1, 9),), (), (), ())
    for tick, least in ((0, 2 + 5), (1, 2 + 5), (2, 2), (3, 2)):
        fees = Fees([(0, 0)], [(tick, {"a"}, 5)])
        assert least_cost_of(Tariff(lane, keep_away), lane.robots[0], 1, fees) == least, tick


def test_deadlines_find_what_prices_alone_miss_and_carry_their_proofs() -> None:
    instance = crossing()
    certificate = lower_bound(instance, steps=4500)
    assert certificate.bound == 11
    assert certificate.deadlines
    assert verify_bound(instance, certificate) == 11


@pytest.mark.parametrize(("honest", "tamper", "path", "reason"), TAMPERED)
def test_tampered_cuts_deadlines_and_sights_are_refused(
    honest: Callable[[], BoundDocument], tamper: Tamper, path: str, reason: str
) -> None:
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(crossing(), tamper(honest()))
    rule = "bound/cut" if path.startswith("$.cuts") else "bound/deadline"
    assert (refused.value.path, refused.value.rule) == (path, rule)


def test_each_robot_has_a_deadline_or_the_deadlines_are_refused() -> None:
    for ticks in ((2,), (2, 2, 2)):
        changed = msgspec.structs.replace(deadline_certificate().deadlines[0], ticks=ticks)
        with pytest.raises(Refusal, match="it must have a deadline of each of 2 robots") as refused:
            verify_bound(crossing(), msgspec.structs.replace(deadline_certificate(), deadlines=(changed,)))
        assert refused.value.rule == "bound/deadline"


@pytest.mark.parametrize(
    ("seen", "reason"),
    [
        ((), "robot lost can be at its goal at None, not at 2"),
        (((1, ("middle",)), (1, ("middle",))), "a robot of the group has no way to its goal"),
    ],
)
def test_a_robot_without_a_way_has_no_deadline(seen: tuple[Sight, ...], reason: str) -> None:
    crossed = crossing()
    instance = Instance(crossed.graph, (*crossed.robots, Robot("lost", "north", "island")))
    deadlines = DeadlinesDocument(("r0", "lost"), (2, 2), 1, "1 0 1 0\n", seen)
    with pytest.raises(Refusal, match=reason):
        verify_bound(instance, msgspec.structs.replace(lower_bound(instance, steps=2), deadlines=(deadlines,)))


def test_a_robot_that_vanishes_may_have_passed_its_goal_when_it_is_seen() -> None:
    lane = Instance(
        ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c"))), (Robot("r", "a", "b"),)
    )
    deadlines = DeadlinesDocument(("r",), (0,), 1, "", ((2, ("c",)),))
    assert Solver(formula_of_deadlines(lane, deadlines, 100), lambda: None).satisfiable([])
    earlier = msgspec.structs.replace(deadlines, seen=((1, ("c",)),))
    assert not Solver(formula_of_deadlines(lane, earlier, 100), lambda: None).satisfiable([])


def test_who_is_seen_several_times_pays_for_each_tick_of_its_stay_in_whatever_order_they_are_named() -> None:
    sights = [(3, {"a"}, 1), (1, {"a", "b"}, 2), (2, {"b"}, 4), (0, {"a"}, 8), (2, {"a"}, 16)]
    fees = Fees([], sights)
    for resource, first, end in product("abc", range(5), range(5)):
        paid = sum(price for tick, places, price in sights if first <= tick < end and resource in places)
        assert fees.on_the_way(resource, first, end) == paid
    assert (fees.last, Fees([(5, 1)], sights).last) == (3, 5)


def test_a_robot_pays_only_where_it_is_seen() -> None:
    certificate = sight_certificate()
    assert [least for _, least in certificate.robots] == [3 << 16, 2 << 16, 3 << 16]
    claimed = tuple((robot, 7 << 15) for robot, _ in certificate.robots)
    with pytest.raises(Refusal, match="robot r0 can have no more than 196608"):
        verify_bound(crossing(), msgspec.structs.replace(certificate, robots=claimed))


def test_deadlines_are_counted_once_for_all_robots_but_one() -> None:
    certificate = deadline_certificate()
    assert [least for _, least in certificate.robots] == [3 << 16, 2 << 16, 3 << 16]
    dearer = msgspec.structs.replace(certificate, bound=8)
    with pytest.raises(Refusal, match="the bound must be 7") as refused:
        verify_bound(crossing(), dearer)
    assert refused.value.rule == "bound/total"


@pytest.mark.parametrize(("quarters", "number", "bound"), [(0, 1, 6), (1, 1, 7), (2, 1, 8), (4, 1, 9), (2, 2, 9)])
def test_a_cut_counts_its_least_total_in_place_of_a_share_of_its_robots_costs(
    quarters: int, number: int, bound: int
) -> None:
    """Each robot costs 2 on its shortest path, and r0 and r2 cost 7 together: 6 + 3/4 of a tick for each quarter."""
    (cut,) = cut_certificate().cuts
    part = 1 << 4
    cuts = (msgspec.structs.replace(cut, multiplier=quarters * part),) * number
    left = 2 * (4 - quarters * number) * part
    robots = (("r0", left), ("r1", 8 * part), ("r2", left))
    certificate = BoundDocument(BOUND_FORMAT, digest(crossing()), bound, 4 * part, 0, (), (), cuts, robots)
    assert verify_bound(crossing(), certificate) == bound
    for robot in range(3):
        claims = tuple((name, least + (robot == at)) for at, (name, least) in enumerate(robots))
        with pytest.raises(Refusal, match="can have no more than"):
            verify_bound(crossing(), msgspec.structs.replace(certificate, robots=claims))


def test_horizons_of_a_cut_go_from_0_to_its_least_total() -> None:
    (cut,) = cut_certificate().cuts
    for horizons in ((0, cut.least), (cut.least, 0)):
        assert formula_of(crossing(), msgspec.structs.replace(cut, horizons=horizons), 10**6).clauses


def test_the_multipliers_of_all_cuts_of_a_robot_count_together() -> None:
    (cut,) = cut_certificate().cuts
    half = msgspec.structs.replace(cut, multiplier=cut_certificate().scale * 3 // 4)
    with pytest.raises(Refusal, match="the multipliers of robot r0 must add up to 65536 at most") as refused:
        verify_bound(crossing(), msgspec.structs.replace(cut_certificate(), cuts=(half, half)))
    assert refused.value.path == "$.cuts[1].multiplier"


def test_a_cut_of_a_robot_without_a_way_is_refused() -> None:
    crossed = crossing()
    instance = Instance(crossed.graph, (*crossed.robots, Robot("lost", "north", "island")))
    certificate = lower_bound(instance, steps=2)
    cut = CutDocument(("r0", "lost"), 0, 1, (0, 0), (0, 1), "1 0 1 0\n")
    with pytest.raises(Refusal, match="a robot of the group has no way to its goal"):
        verify_bound(instance, msgspec.structs.replace(certificate, cuts=(cut,)))
