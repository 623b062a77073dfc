"""The search for deadlines: cores need no robot outside, are as small and as late as can be, and are proved."""

import pytest

from carp_optimum.claims.deadline_search import DeadlineSearch, _Cores
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carp_verify.bound.cuts import require_deadlines

SCALE = 1 << 10


def dead_end() -> Instance:
    """`in` has to leave the dead end by the place where `out` is, which wants to be in the dead end at once."""
    cells = tuple(Resource(name) for name in ("end", "door", "left", "right", "yard"))
    graph = ResourceGraph(cells, (("end", "door"), ("door", "left"), ("door", "right"), ("right", "yard")))
    robots = (Robot("out", "door", "end"), Robot("in", "end", "left"), Robot("far", "yard", "right"))
    return Instance(graph, robots)


def cores(instance: Instance) -> _Cores:
    return _Cores(instance, PriceSearch(instance, SCALE), lambda: None)


def test_a_core_names_each_robot_that_it_needs_however_late_that_may_be() -> None:
    search = cores(dead_end())
    assert search.core({0: 0}, 1000) is None
    assert search.core({0: 0, 1: 0, 2: 0}, 1000) == {0: 0, 1: 0}
    assert search.core({0: 0}, 1000) is None


def test_cores_are_disjoint_until_all_delays_can_be_kept() -> None:
    search = cores(dead_end())
    assert list(search.disjoint([0, 0, 0])) == [{0: 0, 1: 0}]
    assert list(search.disjoint([9, 9, 0])) == []


def test_a_core_is_raised_up_to_the_delays_that_are_wanted_and_as_far_as_it_is_a_core() -> None:
    search = cores(dead_end())
    most = PriceSearch(dead_end(), SCALE).delays() + 1
    raised = search.raised({0: 0, 1: 0}, most)
    assert search.core(raised, 1000) == raised
    assert all(delay <= 1 for delay in raised.values())
    for robot in raised:
        higher = {**raised, robot: raised[robot] + 1}
        assert raised[robot] == most[robot] or search.core(higher, 1000) is None


def test_deadlines_that_are_found_are_proved_and_raise_the_bound() -> None:
    instance = dead_end()
    prices = PriceSearch(instance, SCALE)
    search = DeadlineSearch(prices)
    assert search.round(lambda: None) > 0
    for deadlines in prices.deadlines:
        assert require_deadlines(instance, deadlines.document, 10**6) > 0
        assert all(member.arrival >= prices.market.requests.earliest[member.robot] for member in deadlines.members)
    before = prices.best
    prices.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    assert prices.best > before


def test_the_same_deadlines_are_not_found_twice() -> None:
    search = DeadlineSearch(PriceSearch(dead_end(), SCALE))
    search.round(lambda: None)
    found = len(search.search.deadlines)
    assert search.round(lambda: None) == 0
    assert len(search.search.deadlines) == found


def test_no_deadlines_are_searched_for_where_the_formula_would_be_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimum.claims.deadline_search.LARGEST_ENCODING", 3 * 64 - 1)
    assert DeadlineSearch(PriceSearch(dead_end(), SCALE)).round(lambda: None) == 0
    monkeypatch.setattr("carp_optimum.claims.deadline_search.LARGEST_ENCODING", 3 * 64)
    assert DeadlineSearch(PriceSearch(dead_end(), SCALE)).round(lambda: None) > 0


def test_no_deadlines_are_searched_for_where_robots_wait_for_long(monkeypatch: pytest.MonkeyPatch) -> None:
    search = DeadlineSearch(PriceSearch(dead_end(), SCALE))
    monkeypatch.setattr("carp_optimum.claims.deadline_search.LARGEST_DELAYS", -1)
    assert search.round(lambda: None) == 0
    monkeypatch.setattr("carp_optimum.claims.deadline_search.LARGEST_DELAYS", 300)
    assert search.round(lambda: None) > 0
