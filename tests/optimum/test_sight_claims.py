"""Claims about two robots that are seen: each is true, and has a proof."""

import numpy as np
import pytest
from hypothesis import event, given, settings
from tests.optimum.sight_examples import SCALE, long_way_round, search_of
from tests.profiles import draws

from carp_optimum.bound import lower_bound
from carp_optimum.price_search import PriceSearch
from carp_optimum.sight_claims import Sides
from carp_optimum.sight_search import STEPS, SightSearch, pairs_in
from carp_optimum.solver import TimeOver
from carp_spec import Instance
from carp_verify.verify_bound import verify_bound
from carproof.generate import Fleet, Grid, grid_instance
from carproof.strategies import Sizes, instances

MIXED = Sizes(resources=5, robots=3, capacity=2, duration=3, release=3, pace=2)


def sides_near(prices: PriceSearch) -> tuple[Sides, list[tuple[int, int]]]:
    """The robots near the best prices, and the pairs that are in the same place at the same tick."""
    delays, at = prices.wander_places(STEPS, SCALE // 4, lambda: None)
    sides = Sides(prices, at, np.minimum(delays.max(axis=0) + 2, SightSearch(prices).most), {})
    return sides, sorted(pairs_in(at, len(prices.instance.graph.resources)))


@settings(max_examples=draws(60))
@given(instances(MIXED, least_robots=2))
def test_all_that_is_found_has_a_proof(instance: Instance) -> None:
    prices = search_of(instance)
    search = SightSearch(prices)
    sides, pairs = sides_near(prices)
    for one, other in pairs:
        weight, members = sides.claim(one, other, True, lambda: None)
        if weight > 0:
            event("claimed")
            assert search._refutation(search._unproved(members).document, lambda: None)


@pytest.mark.parametrize("seed", [0, 2])
def test_all_that_is_found_about_more_ticks_has_a_proof(seed: int) -> None:
    instance = grid_instance(Grid(width=9, height=9, map=5, map_seed=seed), Fleet(robots=24, seed=seed))
    prices = search_of(instance)
    sides, pairs = sides_near(prices)
    claims = [sides.claim(*pair, True, lambda: None) for pair in pairs]
    again = [members for weight, members in claims if weight > 0 and len(members) > 2]
    assert again
    search = SightSearch(prices)
    assert all(search._refutation(search._unproved(members).document, lambda: None) for members in again)


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
    monkeypatch.setattr("carp_optimum.sight_claims.MOST_SIGHTS", -1)
    assert lower_bound(instance, steps=1600).bound == 51
