"""Certificates of lower bounds that are refused: forged, malformed, or too large."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from time import process_time
from typing import Any

import msgspec
import pytest
from tests.spec.making import instance_on, line, row
from tests.verify.bound.examples import Tamper, completed, crossing, cut_certificate, deadline_certificate, priced

from carp_optimum.bound import lower_bound
from carp_optimum.lagrangian import price_search
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.documents.bounds import BoundDocument
from carp_verify.bound import rules as bound_rules
from carp_verify.bound import tariff
from carp_verify.bound import verify as page
from carp_verify.bound.verify import verify_bound
from carproof.generate import Fleet, Grid, grid_instance


def test_a_bound_whose_claims_take_the_checker_too_long_claims_less_and_no_less_than_shortest_ways(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    instance = grid_instance(Grid(5, 5), Fleet(robots=14, seed=3, after_goal="park"))
    shortest = lower_bound(instance, steps=0).bound
    bounds = []
    for most in (0, 30, 120, 10**6):
        monkeypatch.setattr(price_search, "MOST_STEPS", most)
        monkeypatch.setattr(page, "LARGEST_SEARCH", most * 4 // 3)
        certificate = lower_bound(instance, steps=400)
        assert verify_bound(instance, certificate) == certificate.bound
        bounds.append(certificate.bound)
    assert bounds == sorted(bounds)
    assert bounds[0] == shortest < bounds[-1]


LANE = instance_on(line("ab"), Robot("r", "a", "b"))


def sized(change: str) -> tuple[Instance, BoundDocument]:
    """A certificate with one size larger than all others."""
    if change == "prices":
        prices = {"resources": (("a", 29, 1), ("b", 1, 1)), "exchanges": (("b", "a", 29, 1), ("a", "b", 3, 1))}
        return LANE, completed(LANE, msgspec.structs.replace(lower_bound(LANE, steps=1), horizon=30, **prices))
    cuts = {"cuts": 2, "both": 1}.get(change, 0) * cut_certificate().cuts
    deadlines = {"deadlines": 3, "both": 1}.get(change, 0) * deadline_certificate().deadlines
    certificate = msgspec.structs.replace(cut_certificate(), cuts=cuts, deadlines=deadlines)
    return crossing(), completed(crossing(), certificate)


@pytest.mark.parametrize(
    ("change", "limit", "size", "path"),
    [
        ("robots", "LARGEST_RESTS", 3 * 6, "$.robots"),
        ("cuts", "LARGEST_TABLE", 2 * 2 * 6, "$.cuts"),
        ("prices", "LARGEST_TABLE", 30 * 2, "$.resources"),
        ("cuts", "LARGEST_FORMULA", 2 * 97, "$.cuts[1]"),
        ("deadlines", "LARGEST_TABLE", 3 * 2 * 6, "$.deadlines"),
        ("deadlines", "LARGEST_FORMULA", 3 * 13, "$.deadlines[2]"),
        ("both", "LARGEST_FORMULA", 97 + 13, "$.deadlines[0]"),
        ("prices", "LARGEST_SEARCH", 1, "$.robots"),
    ],
)
def test_each_size_is_accepted_up_to_its_limit(
    change: str, limit: str, size: int, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    instance, certificate = sized(change)

    def set_limit(most: int) -> None:
        for module in (page, tariff):
            monkeypatch.setattr(module, limit, most, raising=False)

    set_limit(size)
    assert verify_bound(instance, certificate) == certificate.bound
    set_limit(size - 1)
    with pytest.raises(Refusal, match=f"at most {size - 1}|more than {size - 1}") as refused:
        verify_bound(instance, certificate)
    assert (refused.value.path, refused.value.rule) == (path, "bound/size")


def test_a_bound_holds_where_following_is_forbidden_too() -> None:
    instance = replace(crossing(), following="forbidden")
    certificate = lower_bound(instance, steps=2)
    assert verify_bound(instance, certificate) == certificate.bound


def test_prices_that_keep_a_robot_waiting_for_long_are_refused_after_a_bounded_search() -> None:
    prices = (*(("b", tick, 10**12) for tick in range(1000)), ("b", 9_999_999, 1))
    certificate = priced(LANE, scale=1, horizon=10**7, resources=prices, robots=(("r", 0),))
    started = process_time()
    with pytest.raises(Refusal, match="bound"):
        verify_bound(LANE, certificate)
    assert process_time() - started < 30


@pytest.mark.parametrize(("horizons", "least"), [((3000, 3000), 3007), ((10**9, 0), 10**9), ((0, 10**99), 10**99)])
def test_a_cut_with_a_large_formula_is_refused_at_once(horizons: tuple[int, int], least: int) -> None:
    (cut,) = cut_certificate().cuts
    large = msgspec.structs.replace(cut, horizons=horizons, least=least)
    started = process_time()
    with pytest.raises(Refusal, match="must have at most 5000000 clauses together") as refused:
        verify_bound(crossing(), msgspec.structs.replace(cut_certificate(), cuts=(large,)))
    assert (refused.value.path, refused.value.rule) == ("$.cuts[0]", "bound/size")
    assert process_time() - started < 20


def test_stays_too_long_to_be_searched_are_refused_with_the_limit_named() -> None:
    with pytest.raises(Refusal, match="must be at most 100000, the limit, and is 200000") as refused:
        lower_bound(replace(LANE, graph=line("ab", a=200_000)), steps=3)
    assert refused.value.rule == "bound/stay"


def test_a_robot_without_a_way_is_named_and_left_out() -> None:
    instance = instance_on(crossing().graph, crossing().robots[0], Robot("lost", "north", "island"))
    certificate = lower_bound(instance, steps=30)
    assert certificate.robots[1] == ("lost", None)
    assert verify_bound(instance, certificate) == 2
    for wrong in ((("r0", None), ("lost", None)), (certificate.robots[0], ("lost", 0))):
        with pytest.raises(Refusal, match="bound/robots"):
            verify_bound(instance, msgspec.structs.replace(certificate, robots=wrong))


@pytest.mark.parametrize(
    ("start", "goal"), [("behind", "far"), ("near", "before"), ("island", "behind"), ("far", "near")]
)
def test_that_others_reach_a_goal_or_leave_a_start_is_no_way_between_them(start: str, goal: str) -> None:
    """All distances from and to the places that the first robot reaches are known to the checker."""
    cells = tuple(Resource(name) for name in ("before", "near", "far", "behind", "island"))
    edges = (("before", "near"), ("near", "far"), ("far", "behind"))
    robots = (Robot("first", "near", "far"), Robot("lost", start, goal))
    instance = Instance(ResourceGraph(cells, edges, directed=True), robots)
    certificate = priced(instance, bound=1, scale=1, horizon=0, robots=(("first", 1), ("lost", None)))
    assert verify_bound(instance, certificate) == 1
    claimed = msgspec.structs.replace(certificate, bound=101, robots=(("first", 1), ("lost", 100)))
    with pytest.raises(Refusal, match="robot lost can have no more than None") as refused:
        verify_bound(instance, claimed)
    assert refused.value.rule == "bound/robots"


def test_an_instance_that_breaks_a_rule_has_no_bound() -> None:
    instance = instance_on(row(1, 1, capacity=0), Robot("r", 0, 1))
    with pytest.raises(Refusal) as refused:
        verify_bound(instance, priced(instance, bound=2, scale=1, horizon=0, robots=(("r", 2),)))
    assert refused.value.rule == "instance/capacity"


def change(**fields: object) -> Tamper:
    return lambda certificate: msgspec.structs.replace(certificate, **fields)


def reprice(price: object = None, tick: object = None, place: object = None) -> Tamper:
    """Change the first price."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        first = certificate.resources[0]
        new = (place or first[0], first[1] if tick is None else tick, first[2] if price is None else price)
        return msgspec.structs.replace(certificate, resources=(new, *certificate.resources[1:]))

    return tamper


def exchange(*row: object) -> Tamper:
    return lambda certificate: msgspec.structs.replace(certificate, exchanges=(row, *certificate.exchanges))


def of_robot(more: int) -> Tamper:
    """Claim more of the first robot, and of the bound."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        (robot, least), *rest = certificate.robots
        bound = certificate.bound + more // certificate.scale
        return msgspec.structs.replace(certificate, robots=((robot, (least or 0) + more), *rest), bound=bound)

    return tamper


@pytest.mark.parametrize(
    ("tamper", "path", "rule", "reason"),
    [
        (change(instance="0" * 64), "$.instance", "bound/instance", "it is about another instance"),
        (change(instance="f" * 64), "$.instance", "bound/instance", "it is about another instance"),
        (change(scale=3), "$.scale", "bound/scale", "must be a power of two, and is 3"),
        (reprice(price=-1), "$.resources[0]", "bound/price", "-1 at . must be a price of at least 0"),
        (reprice(tick=99), "$.resources[0]", "bound/price", "at 99 must be .* at a tick below"),
        (reprice(place="moon"), "$.resources[0]", "bound/price", "moon must be a resource"),
        (exchange("north", "moon", 1, 1), "$.exchanges[0]", "bound/price", "north and moon must be"),
        (exchange("north", "east", 1, 1), "$.exchanges[0]", "bound/price", "with a move each way"),
        (
            lambda each: exchange("middle", "north", 0, 1)(exchange("north", "east", 1, 1)(each)),
            "$.exchanges[1]",
            "bound/price",
            "with a move each way",
        ),
        (lambda each: change(robots=each.robots[1:])(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(robots=each.robots[::-1])(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(robots=each.robots * 2)(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(resources=each.resources * 2)(each), None, "bound/once", "must have one price at tick"),
        (of_robot(1 << 16), "$.robots[0]", "bound/robots", "robot r0 can have no more than"),
        (lambda each: change(bound=each.bound + 1)(each), "$.bound", "bound/total", "the bound must be 11,"),
        (lambda each: change(bound=each.bound - 1)(each), "$.bound", "bound/total", "and is 10"),
        (change(bound=9.0), "$.bound", "document/shape", r"not 9\.0"),
        (lambda each: reprice(tick=10**12)(change(horizon=10**13)(each)), "$.resources", "bound/size", "would be"),
    ],
)
def test_a_tampered_certificate_is_refused(tamper: Tamper, path: str | None, rule: str, reason: str) -> None:
    instance = crossing()
    certificate = lower_bound(instance, steps=500)
    verify_bound(instance, certificate)
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(instance, tamper(certificate))
    assert refused.value.rule == rule
    assert path in {None, refused.value.path}


@pytest.mark.parametrize(
    ("is_right", "values", "right"),
    [
        (bound_rules.is_scale, (*range(-8, 18), True, 1.0, 1 << 99, (1 << 99) + 1), [1, 2, 4, 8, 16, 1 << 99]),
        (lambda tick: bound_rules.is_price(0, tick, 5), (-1, 0, 4, 5, 6, True, 1.0), [0, 4]),
        (lambda price: bound_rules.is_price(price, 0, 5), (-1, 0, 1, 10**99, True, 1.0), [0, 1, 10**99]),
        (lambda claimed: bound_rules.is_least(claimed, 5), (None, -1, 0, 4, 5, 6, True, 4.0), [-1, 0, 4, 5]),
        (lambda claimed: bound_rules.is_least(claimed, None), (None, -1, 0, 4, True), [None]),
    ],
    ids=["a scale is a power of two", "a tick before the horizon", "a price", "a claim", "no way"],
)
def test_values_keep_their_rule(is_right: Callable[[Any], bool], values: Sequence[object], right: list[object]) -> None:
    assert [value for value in values if is_right(value)] == right


@pytest.mark.parametrize("place", [("a", "b"), ("b", "a")])
def test_an_exchange_needs_moves_both_ways(place: tuple[str, str]) -> None:
    instance = instance_on(line("ab", directed=True), Robot("r", "a", "b"))
    certificate = msgspec.structs.replace(lower_bound(instance, steps=1), horizon=3, exchanges=((*place, 1, 1),))
    with pytest.raises(Refusal, match="must be a resource, or two with a move each way") as refused:
        verify_bound(instance, certificate)
    assert (refused.value.path, refused.value.rule) == ("$.exchanges[0]", "bound/price")
