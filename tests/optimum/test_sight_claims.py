"""Claims about two robots that are seen: each is true, has a proof, and is broken by as much as it says."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis.strategies import integers
from tests.optimum.sight_examples import SCALE, long_way_round, search_of
from tests.profiles import draws

from carp_optimum.bound import lower_bound
from carp_optimum.claims.pair_constraints import Claim, Sides
from carp_optimum.claims.pair_search import STEPS, SightSearch, pairs_in
from carp_optimum.lagrangian.deadlines import Member
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_optimum.sat.solver import TimeOver
from carp_spec import Instance
from carp_verify.bound.verify import verify_bound
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import Sizes, instances

MIXED = Sizes(resources=5, robots=3, capacity=2, duration=3, release=3, pace=2)


def sides_near(prices: PriceSearch, margin: int = 2) -> tuple[Sides, list[tuple[int, int]]]:
    """The robots near the best prices, and the pairs that are in the same place at the same tick.

    The largest delays that are looked at are the margin more than those near the best prices.
    """
    delays, at = prices.wander_places(STEPS, SCALE // 4, lambda: None)
    sides = Sides(prices, at, np.minimum(delays.max(axis=0) + margin, SightSearch(prices).most), {})
    return sides, sorted(pairs_in(at, len(prices.instance.graph.resources)))


def on_a_map(width: int, robots: int, seed: int) -> Instance:
    return grid_instance(Grid(width=width, height=width, map=5, map_seed=seed), Fleet(robots=robots, seed=seed))


def about_more_ticks(sides: Sides, pairs: list[tuple[int, int]]) -> dict[tuple[int, int], Claim]:
    claims = {pair: sides.claim(*pair, True, lambda: None) for pair in pairs}
    return {pair: claim for pair, claim in claims.items() if len(claim[1]) > 2}


def broken_by(sides: Sides, members: Sequence[Member]) -> int:
    """In how many steps the ways keep what the members say, beyond those of all members but one."""
    kept = sum(int(np.isin(sides.at[:, each.robot, each.seen], each.places).sum()) for each in members)
    arrived = len(sides.search.instance.graph.resources)
    kept += sum(int((sides.at[:, each.robot, each.seen] == arrived).sum()) for each in members if each.arrival >= 0)
    return kept - len(sides.at) * (len(members) - 1)


@settings(max_examples=draws(60))
@given(instances(MIXED, least_robots=2), integers(0, 2))
def test_all_that_is_found_has_a_proof(instance: Instance, margin: int) -> None:
    prices = search_of(instance)
    search = SightSearch(prices)
    sides, pairs = sides_near(prices, margin)
    for one, other in pairs:
        weight, members = sides.claim(one, other, True, lambda: None)
        if weight > 0:
            event("claimed")
            assert broken_by(sides, members) == weight
            assert search._refutation(search._unproved(members).document, lambda: None)


@pytest.mark.parametrize(("width", "robots", "seed"), [(7, 14, 7), (9, 24, 0), (9, 24, 2)])
def test_all_that_is_found_about_more_ticks_is_broken_and_has_a_proof(width: int, robots: int, seed: int) -> None:
    prices = search_of(on_a_map(width, robots, seed))
    sides, pairs = sides_near(prices)
    search = SightSearch(prices)
    claims = about_more_ticks(sides, pairs)
    assert claims
    for weight, members in claims.values():
        assert broken_by(sides, members) == weight
        assert search._refutation(search._unproved(members).document, lambda: None)


def test_ways_that_are_too_long_to_be_looked_at_make_a_claim_lighter() -> None:
    sides, pairs = sides_near(search_of(on_a_map(9, 24, 27)), -1)
    claims = about_more_ticks(sides, pairs)
    assert claims
    assert all(broken_by(sides, members) == weight for weight, members in claims.values())


def test_a_claim_for_which_there_is_no_time_leaves_the_robots_free_to_be_anywhere() -> None:
    sides, pairs = sides_near(search_of(long_way_round()))

    def stop() -> None:
        raise TimeOver

    stopped = 0
    for pair in pairs:
        try:
            sides.claim(*pair, True, stop)
        except TimeOver:
            stopped += 1
        assert all(not side.sees.any() for side in sides.known.values() if side is not None)
    assert stopped > 0


def test_robots_that_are_seen_more_than_once_raise_the_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = long_way_round()
    certificate = lower_bound(instance, steps=1600)
    assert verify_bound(instance, certificate) == 52
    assert sum(len(each.robots) > len(set(each.robots)) for each in certificate.deadlines) > 1
    monkeypatch.setattr("carp_optimum.claims.pair_constraints.MOST_SIGHTS", -1)
    assert lower_bound(instance, steps=1600).bound == 51
