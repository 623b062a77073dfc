"""A sorting centre laid out as `maps/sorting_map.grid` of RHCR: chutes in rows, one-way lanes in pairs between them.

77 by 37 cells: every third one in both directions is a chute, and 50 places at two edges are stations where parcels
are taken up. Between columns of chutes two lanes run the same way, and from pair to pair the other way; so do rows.
"""

from collections.abc import Iterator
from itertools import product

from carp_spec import Instance, Resource, ResourceGraph
from carproof.generate import Fleet
from carproof.generate.fleet import random_robots
from carproof.generate.grid import cell_id

WIDTH, HEIGHT = 77, 37
APART, CHUTES = 3, 2
"""Columns of chutes are so far apart, from this one on; in them are the stations too."""
Cell = tuple[int, int]


def sorting_instance(fleet: Fleet) -> Instance:
    """Robots that start at stations, each with a goal beside a chute."""
    cells = [(x, y) for y, x in product(range(HEIGHT), range(WIDTH)) if not is_chute(x, y)]
    edges = [(cell_id(*cell), cell_id(*to)) for cell in cells for to in moves(*cell)]
    stations = [cell_id(x, y) for x, y in cells if y in {0, HEIGHT - 1} and x % APART == CHUTES]
    drops = [
        cell_id(*cell) for cell in cells if any(is_chute(*near) for near in around(*cell) if 0 < near[1] < HEIGHT - 1)
    ]
    graph = ResourceGraph(tuple(Resource(cell_id(x, y), x=x, y=y) for x, y in cells), tuple(edges), directed=True)
    return Instance(graph, random_robots(fleet, stations, drops), fleet.after_goal)


def is_chute(x: int, y: int) -> bool:
    """Whether it is a chute, or one of the corners, which are closed."""
    inside = 0 < y < HEIGHT - 1
    return (x % APART == CHUTES and y % APART == 0) if inside else x in {0, WIDTH - 1} and y in {0, HEIGHT - 1}


def around(x: int, y: int) -> tuple[Cell, ...]:
    """The four cells beside one."""
    return ((x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1))


def moves(x: int, y: int) -> Iterator[Cell]:
    """Where one may drive from a cell: along its column, along its row, and at the edges through a station."""
    goes_up = (x // APART) % 2 == 1
    if x % APART != CHUTES:
        yield from within(x, y + 1 if goes_up else y - 1)
    if 0 < y < HEIGHT - 1:
        if y % APART != 0:
            yield from within(x + 1 if (y - 1) // APART % 2 == 0 else x - 1, y)
    elif x % APART == CHUTES:
        yield from within(x + 1 if goes_up == (y > 0) else x - 1, y)
    elif goes_up == (y > 0):
        yield from within(x + 1 if x % APART == 1 else x - 1, y)


def within(x: int, y: int) -> Iterator[Cell]:
    """The cell, if it is one to drive on."""
    if 0 <= x < WIDTH and 0 <= y < HEIGHT and not is_chute(x, y):
        yield x, y
