"""Cuts and deadlines of groups of robots, also of robots that are seen at a tick, in lower bounds."""

from collections.abc import Callable, Mapping
from itertools import product
from time import process_time

import msgspec
import pytest
from tests.spec.making import instance, line
from tests.verify.bound.examples import (
    HORIZON,
    Tamper,
    crossing,
    cut_certificate,
    deadline_certificate,
    priced,
    sight_certificate,
)
from tests.verify.bound.plain_search import least_cost_of
from tests.verify.bound.tampered import NOT_WHOLE, TAMPERED
from tests.verify.optimum.models import has_model

from carp_optimum.bound import lower_bound
from carp_spec import Instance, Refusal, Robot
from carp_spec.documents.bounds import BoundDocument, CutDocument, DeadlinesDocument
from carp_verify.bound.cuts import formula_of, formula_of_deadlines
from carp_verify.bound.tariff import Fees, Tariff
from carp_verify.bound.verify import verify_bound


def test_who_vanishes_drives_on_through_its_goal_where_nothing_else_makes_it_late() -> None:
    """It pays 20 to come by tick 3, and 9 for each tick of waiting: on to c and back to b costs 2 ticks more."""
    lane = instance(line("abc"), ("a", "b"), after_goal="vanish")
    waits = tuple(("a", tick, 9) for tick in range(1, HORIZON))
    tariff = Tariff(lane, priced(lane, scale=1, resources=waits))
    assert [least_cost_of(tariff, lane.robots[0], 1, Fees([(tick, 20)])) for tick in (0, 1, 2, 3)] == [1, 3, 3, 4]


def test_who_waits_pays_for_the_ticks_of_its_waiting_alone() -> None:
    lane = instance(line("ab"), ("a", "b"))
    tariff = Tariff(lane, priced(lane, scale=1, resources=(("b", 1, 9),)))
    for tick, least in ((0, 2 + 5), (1, 2 + 5), (2, 2), (3, 2)):
        fees = Fees([(0, 0)], [(tick, {"a"}, 5)])
        assert least_cost_of(tariff, lane.robots[0], 1, fees) == least, tick


def test_deadlines_find_what_prices_alone_miss_and_carry_their_proofs() -> None:
    certificate = lower_bound(crossing(), steps=4500)
    assert certificate.deadlines
    assert verify_bound(crossing(), certificate) == certificate.bound == 11


@pytest.mark.parametrize(("honest", "tamper", "path", "reason"), TAMPERED)
def test_tampered_cuts_deadlines_and_sights_are_refused(
    honest: Callable[[], BoundDocument], tamper: Tamper, path: str, reason: str
) -> None:
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(crossing(), tamper(honest()))
    rule = "bound/cut" if path.startswith("$.cuts") else "bound/deadline"
    assert (refused.value.path, refused.value.rule) == (path, rule)


@pytest.mark.parametrize(("honest", "tamper", "path"), NOT_WHOLE)
def test_numbers_of_cuts_deadlines_and_sights_are_whole(
    honest: Callable[[], BoundDocument], tamper: Tamper, path: str
) -> None:
    with pytest.raises(Refusal) as refused:
        verify_bound(crossing(), tamper(honest()))
    assert (refused.value.path, refused.value.rule) == (path, "document/shape")


LOST = ("r0", "lost")
NO_WAY = "a robot of the group has no way to its goal"


@pytest.mark.parametrize(
    ("claim", "reason"),
    [
        (
            {"deadlines": (DeadlinesDocument(LOST, (2, 2), 1, "1 0 1 0\n"),)},
            "robot lost can be at its goal at None, not at 2",
        ),
        ({"deadlines": (DeadlinesDocument(LOST, (2, 2), 1, "1 0 1 0\n", ((1, ("middle",)),) * 2),)}, NO_WAY),
        ({"cuts": (CutDocument(LOST, 0, 1, (0, 0), (0, 1), "1 0 1 0\n"),)}, NO_WAY),
    ],
)
def test_nothing_is_claimed_of_a_group_with_a_robot_without_a_way(claim: Mapping[str, object], reason: str) -> None:
    crossed = crossing()
    with_lost = Instance(crossed.graph, (*crossed.robots, Robot("lost", "north", "island")))
    with pytest.raises(Refusal, match=reason):
        verify_bound(with_lost, msgspec.structs.replace(lower_bound(with_lost, steps=2), **claim))


def test_a_robot_that_vanishes_may_have_passed_its_goal_when_it_is_seen() -> None:
    lane = instance(line("abc"), ("a", "b"))
    deadlines = DeadlinesDocument(("r0",), (0,), 1, "", ((2, ("c",)),))
    assert has_model(formula_of_deadlines(lane, deadlines, 100))
    earlier = msgspec.structs.replace(deadlines, seen=((1, ("c",)),))
    assert not has_model(formula_of_deadlines(lane, earlier, 100))


def test_who_is_seen_several_times_pays_for_each_tick_of_its_stay_in_whatever_order_they_are_named() -> None:
    sights = [(3, {"a"}, 1), (1, {"a", "b"}, 2), (2, {"b"}, 4), (0, {"a"}, 8), (2, {"a"}, 16)]
    fees = Fees([], sights)
    for resource, first, end in product("abc", range(5), range(5)):
        paid = sum(price for tick, places, price in sights if first <= tick < end and resource in places)
        assert fees.on_the_way(resource, first, end) == paid
    assert (fees.last, Fees([(5, 1)], sights).last) == (3, 5)


def test_what_a_robot_pays_is_found_in_a_time_that_hardly_grows_with_its_deadlines() -> None:
    def seconds(many: int) -> float:
        fees = Fees([(tick, 1) for tick in range(many)], [(tick, {"a"}, 1) for tick in range(many)])
        started = process_time()
        for tick in range(500):
            assert fees.at_arrival(tick) == many - tick
            assert fees.on_the_way("a", tick, many) == many - tick
        return process_time() - started

    assert min(seconds(50_000) for _ in range(3)) < 10 * min(seconds(500) for _ in range(3))


@pytest.mark.parametrize("honest", [deadline_certificate, sight_certificate])
def test_deadlines_are_counted_once_for_all_robots_but_one(honest: Callable[[], BoundDocument]) -> None:
    """And a robot pays only where it keeps its deadline, or is seen."""
    certificate = honest()
    assert [least for _, least in certificate.robots] == [3 << 16, 2 << 16, 3 << 16]
    dearer = tuple((robot, 7 << 15) for robot, _ in certificate.robots)
    for change, rule, reason in (
        ({"bound": 8}, "bound/total", "the bound must be 7"),
        ({"robots": dearer}, "bound/robots", "robot r0 can have no more than 196608"),
    ):
        with pytest.raises(Refusal, match=reason) as refused:
            verify_bound(crossing(), msgspec.structs.replace(certificate, **change))
        assert refused.value.rule == rule


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
    certificate = priced(crossing(), bound=bound, scale=4 * part, horizon=0, cuts=cuts, robots=robots)
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
