"""The search for deadlines of robots that are seen: what it finds is true, and raises the bound where robots meet."""

import pytest
from tests.optimum.sight_examples import SCALE, search_of, two_lanes

from carp_optimum.bound import lower_bound
from carp_optimum.claims.pair_search import SightSearch
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.sat.solver import TimeOver
from carp_spec.documents.bounds import DeadlinesDocument
from carp_verify.bound.cuts import require_deadlines


def test_claims_are_proved_and_raise_the_bound() -> None:
    instance = two_lanes()
    prices = search_of(instance)
    before = prices.best
    search = SightSearch(prices)
    for _ in range(4):
        search.round(lambda: None)
        prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
        search.prove(lambda: None)
    assert prices.best > before + SCALE
    assert prices.deadlines
    for deadlines in prices.deadlines:
        assert deadlines.document.seen
        assert require_deadlines(instance, deadlines.document, 10**6) > 0


def test_claims_are_added_and_dropped_while_prices_move_on() -> None:
    prices = search_of(two_lanes())
    before = prices.best
    late = DeadlinesDocument(("long", "first"), (0, 0), 0, "")
    prices.add_deadlines([Deadlines([Member(0, 0, 0, ()), Member(1, 0, 0, ())], late)])
    search = SightSearch(prices)
    seen: dict[int, Deadlines] = {}  # which also keeps them, so that no id is used again

    def watch(_: int, __: int) -> None:
        search.watch(lambda: None)
        seen.update((id(each), each) for each in prices.deadlines)

    prices.roam(SCALE, SCALE >> 4, lambda: None, watch)
    assert prices.best > before + SCALE
    assert len(prices.deadlines) < len(seen)
    best = prices.best
    prices.drop_idle_deadlines()
    search.prove(lambda: None)
    assert all(each.document.refutation for each in prices.deadlines)
    assert prices.best == best


def test_claims_that_are_dropped_leave_the_others_their_prices() -> None:
    prices = search_of(two_lanes())
    search = SightSearch(prices)
    search.round(lambda: None)
    prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    prices.finish()
    expected = [each for each, fee in zip(prices.deadlines, prices.fees.tolist(), strict=True) if fee > 0]
    fees = prices.fees[prices.fees > 0].tolist()
    best = prices.best
    prices.add_deadlines([prices.deadlines[0]])
    prices.drop_idle_deadlines()
    assert [each is other for each, other in zip(prices.deadlines, expected, strict=True)] == [True] * len(expected)
    assert prices.fees.tolist() == fees
    prices.finish()
    assert prices.fees.tolist() == fees
    prices.climb(SCALE, SCALE, lambda: None, lambda _, __: None)
    assert prices.best >= best


def test_claims_without_a_price_or_a_proof_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = search_of(two_lanes())
    before = prices.best
    search = SightSearch(prices)
    search.round(lambda: None)
    found = len(prices.deadlines)
    prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    priced = int((prices.fees > 0).sum())
    assert prices.best > before
    search.prove(lambda: None)
    assert 0 < len(prices.deadlines) == priced <= found
    search.round(lambda: None)
    prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    monkeypatch.setattr("carp_optimum.claims.pair_search.LONGEST_REFUTATION", 0)
    search.prove(lambda: None)
    assert all(each.document.refutation for each in prices.deadlines)


def test_the_bound_is_that_of_the_claims_that_are_proved_in_time() -> None:
    prices = search_of(two_lanes())
    before = prices.best
    search = SightSearch(prices)
    search.round(lambda: None)
    prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    assert prices.best > before

    def stop() -> None:
        raise TimeOver

    with pytest.raises(TimeOver):
        search.prove(stop)
    assert not prices.deadlines
    assert prices.best <= before
    certificate = lower_bound(two_lanes(), steps=0)
    assert certificate.bound <= -(-before // SCALE)


def test_the_same_search_finds_the_same() -> None:
    found = []
    for _ in range(2):
        prices = search_of(two_lanes())
        SightSearch(prices).round(lambda: None)
        found.append([deadlines.document for deadlines in prices.deadlines])
    assert found[0] == found[1]
