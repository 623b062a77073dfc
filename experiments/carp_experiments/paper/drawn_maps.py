"""Maps of the paper, with spanning trees drawn in other ways than carproof does."""

from collections.abc import Iterator, Sequence
from functools import cache
from math import isqrt

import numpy as np

from carp_experiments.paper.map_cases import FULL_MAP
from carp_optimized.jit.kinds import Ints
from carp_spec.permutations import shuffle, splitmix64
from carproof.generate import Grid, grid_instance

SIDE = 20


@cache
def map_arrays(map: int, tree: str, seed: int) -> tuple[Ints, Ints]:
    """The neighbours of each cell, int32 (cells, 4), and the distances of all pairs times 2^16, int64."""
    cells = [(number % SIDE, number // SIDE) for number in range(SIDE * SIDE)]
    neighbours = np.full((len(cells), 4), -1, np.int32)
    used = [0] * len(cells)
    for source, target in map_edges(map, tree, seed):
        for one, other in ((source, target), (target, source)):
            neighbours[one, used[one]] = other
            used[one] += 1
    apart = [[isqrt(((x - u) ** 2 + (y - v) ** 2) << 32) for u, v in cells] for x, y in cells]
    return neighbours, np.array(apart, np.int64)


def map_edges(map: int, tree: str, seed: int) -> list[tuple[int, int]]:
    """The edges of a map, between indices of cells."""
    if tree == "Kruskal":
        return generated_edges(map, seed)
    grid = generated_edges(FULL_MAP)
    stream = splitmix64(seed)
    kept = drawn_tree(grid, tree == "depth first", stream)
    others = shuffle([edge for edge in grid if edge not in kept], stream)
    return sorted(kept | set(others[: len(others) * map // FULL_MAP]))


def generated_edges(map: int, seed: int = 0) -> list[tuple[int, int]]:
    """The edges of a map of the generator, between indices of cells."""
    graph = grid_instance(Grid(SIDE, SIDE, map, seed)).graph
    return [(graph.index[source], graph.index[target]) for source, target in graph.edges]


def drawn_tree(edges: Sequence[tuple[int, int]], is_depth_first: bool, stream: Iterator[int]) -> set[tuple[int, int]]:
    """A spanning tree: of a depth-first search with random neighbours, or of a random walk (Aldous and Broder)."""
    around: dict[int, list[int]] = {}
    for one, other in edges:
        around.setdefault(one, []).append(other)
        around.setdefault(other, []).append(one)
    tree: set[tuple[int, int]] = set()
    seen, path = {0}, [0]
    while len(seen) < len(around):
        here = path[-1]
        choices = [each for each in around[here] if each not in seen or not is_depth_first]
        if not choices:
            path.pop()
            continue
        there = choices[next(stream) % len(choices)]
        if there not in seen:
            seen.add(there)
            tree.add((min(here, there), max(here, there)))
        path.append(there)
    return tree
