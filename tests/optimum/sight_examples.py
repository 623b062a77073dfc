"""Instances whose robots raise a bound where they are seen, and the prices from which claims about them are found."""

from contextlib import suppress
from itertools import pairwise

from carp_optimum.lagrangian.price_search import PriceSearch
from carp_optimum.sat.solver import TimeOver
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carproof.generate import Fleet, Grid, grid_instance

SCALE = 1 << 10
MOST_STEPS = 4000


def two_lanes() -> Instance:
    """`long` meets `first` head-on in a lane, then `second` in another; there is a bay between the lanes."""
    cells = [*(f"west{number}" for number in range(4)), "bay", "hall", *(f"east{number}" for number in range(4))]
    lane = [cell for cell in cells if cell != "bay"]
    edges = (*pairwise(lane), ("bay", "hall"))
    robots = (Robot("long", "west0", "east3"), Robot("first", "hall", "west0"), Robot("second", "east3", "bay"))
    return Instance(ResourceGraph(tuple(map(Resource, cells)), edges), robots)


def long_way_round() -> Instance:
    """Robots that could make way for each other by detours."""
    return grid_instance(Grid(width=5, height=5, map=5, map_seed=5), Fleet(robots=8, seed=5))


def search_of(instance: Instance) -> PriceSearch:
    """Prices after a climb; it ends where no plans exist, as nothing else would end it."""
    search = PriceSearch(instance, SCALE)

    def check() -> None:
        if search.count >= MOST_STEPS:
            raise TimeOver

    with suppress(TimeOver):
        search.climb(SCALE, SCALE >> 4, check, lambda _, __: None)
    return search
