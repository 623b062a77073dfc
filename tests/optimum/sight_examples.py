"""Instances whose robots raise a bound where they are seen, and the prices from which claims about them are found."""

from itertools import pairwise

from carp_optimum.price_search import PriceSearch
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carproof.generate import Fleet, Grid, grid_instance

SCALE = 1 << 10


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
    search = PriceSearch(instance, SCALE)
    search.climb(SCALE, SCALE >> 4, lambda: None, lambda _, __: None)
    return search
