"""The search for deadlines: cores need no robot outside, are as small and as late as can be, and are proved."""

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
