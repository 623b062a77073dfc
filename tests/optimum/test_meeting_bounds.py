"""Robots that meet raise a bound above what prices alone give, by claims of deadlines with and without sight."""

from itertools import pairwise

import pytest

from carp_optimum.bound import lower_bound
from carproof import Instance, Resource, ResourceGraph, Robot, verify_bound
from carproof.generate import Fleet, Grid, grid_instance


def two_lanes() -> Instance:
    """`long` meets `first` head-on in a lane, then `second` in another; there is a bay between the lanes."""
    cells = [*(f"west{number}" for number in range(4)), "bay", "hall", *(f"east{number}" for number in range(4))]
    lane = [cell for cell in cells if cell != "bay"]
    edges = (*pairwise(lane), ("bay", "hall"))
    robots = (Robot("long", "west0", "east3"), Robot("first", "hall", "west0"), Robot("second", "east3", "bay"))
    return Instance(ResourceGraph(tuple(map(Resource, cells)), edges), robots)


def dead_end() -> Instance:
    """`in` has to leave the dead end by the place where `out` is, which wants to be in the dead end at once."""
    cells = tuple(Resource(name) for name in ("end", "door", "left", "right", "yard"))
    graph = ResourceGraph(cells, (("end", "door"), ("door", "left"), ("door", "right"), ("right", "yard")))
    robots = (Robot("out", "door", "end"), Robot("in", "end", "left"), Robot("far", "yard", "right"))
    return Instance(graph, robots)


def way_round(seed: int) -> Instance:
    """Robots that could make way for each other by detours."""
    return grid_instance(Grid(width=5, height=5, map=5, map_seed=seed), Fleet(robots=8, seed=seed))


@pytest.mark.parametrize(("instance", "expected"), [(two_lanes(), 24), (dead_end(), 7), (way_round(5), 52)])
def test_claims_about_robots_that_meet_raise_the_bound(instance: Instance, expected: int) -> None:
    certificate = lower_bound(instance, steps=1600)
    assert certificate.bound == verify_bound(instance, certificate) >= expected
    assert certificate.bound > lower_bound(instance, steps=0).bound
    assert certificate.deadlines
    assert certificate == lower_bound(instance, steps=1600)


def test_no_claims_are_searched_for_once_the_bound_is_enough() -> None:
    instance = two_lanes()
    enough = lower_bound(instance, steps=1600, enough=lower_bound(instance, steps=0).bound)
    assert not enough.deadlines
    assert lower_bound(instance, steps=1600, enough=1000) == lower_bound(instance, steps=1600)


def test_robots_that_are_seen_more_than_once_raise_the_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = way_round(14)
    certificate = lower_bound(instance, steps=1600)
    assert sum(len(each.robots) > len(set(each.robots)) for each in certificate.deadlines) > 0
    monkeypatch.setattr("carp_optimum.claims.pair_constraints.MOST_SIGHTS", -1)
    assert certificate.bound > lower_bound(instance, steps=1600).bound
