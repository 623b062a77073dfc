"""The paper's maps: from a random spanning tree of a grid, map 0, to the full grid, map 20.

Source: the paper, section IV (experiments).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from carp_spec import Instance, Move, Resource, ResourceGraph, ResourceId
from carp_spec.permutations import shuffle, splitmix64
from carproof.generate.fleet import Fleet, random_robots
from carproof.generate.options import Traits, refuse_large_maps, refuse_wrong_options

FULL_MAP = 20
NO_TRAITS = Traits()
NO_FLEET = Fleet(robots=0)


@dataclass(frozen=True, slots=True)
class Grid:
    """A map of the paper: map i of a seed has its spanning tree and i twentieths of the grid's other edges.

    The maps of one seed are nested: map i has all edges of map i - 1.
    """

    width: int = 20
    height: int = 20
    map: int = FULL_MAP
    map_seed: int = 0


def grid_instance(grid: Grid, fleet: Fleet = NO_FLEET, traits: Traits = NO_TRAITS) -> Instance:
    """Make a map and its robots; they start and end anywhere."""
    refuse_wrong_options(grid=(grid, Grid), fleet=(fleet, Fleet), traits=(traits, Traits))
    refuse_large_maps(grid.width, grid.height)
    cells = [(x, y) for y in range(grid.height) for x in range(grid.width)]
    stream = splitmix64(grid.map_seed)
    edges = _kept_edges(grid, list(cell_edges(cells)), stream)
    graph = cell_graph(cells, edges, traits, stream)
    ids = [resource.id for resource in graph.resources]
    return Instance(graph, random_robots(fleet, ids, ids), fleet.after_goal)


def cell_id(x: int, y: int) -> str:
    """The id of a cell, like `3,4`."""
    return f"{x},{y}"


def cell_edges(cells: Sequence[tuple[int, int]]) -> Iterator[Move]:
    """The edges between cells side by side, each once: from each cell to the right, then downwards."""
    present = set(cells)
    for x, y in cells:
        for neighbour in ((x + 1, y), (x, y + 1)):
            if neighbour in present:
                yield (cell_id(x, y), cell_id(*neighbour))


def cell_graph(
    cells: Sequence[tuple[int, int]], edges: Sequence[Move], traits: Traits, stream: Iterator[int]
) -> ResourceGraph:
    """The graph of the cells, with capacities and durations from the stream."""
    resources = tuple(
        Resource(cell_id(x, y), traits.capacity.draw(stream), traits.duration.draw(stream), x, y) for x, y in cells
    )
    return ResourceGraph(resources, tuple(edges))


def _kept_edges(grid: Grid, edges: Sequence[Move], stream: Iterator[int]) -> Sequence[Move]:
    """The edges of the map, in the order of the grid's."""
    weights = dict(zip(edges, stream, strict=False))
    tree = minimum_spanning_tree(sorted(edges, key=weights.__getitem__))
    others = shuffle([edge for edge in edges if edge not in tree], stream)
    kept = tree | set(others[: len(others) * grid.map // FULL_MAP])
    return [edge for edge in edges if edge in kept]


def minimum_spanning_tree(edges: Sequence[Move]) -> set[Move]:
    """Kruskal's algorithm, for edges in the order of their weights."""
    from networkx.utils import UnionFind  # noqa: PLC0415 - slow to load, and few commands need it

    trees: UnionFind[ResourceId] = UnionFind()
    tree: set[Move] = set()
    for source, target in edges:
        if trees[source] != trees[target]:
            trees.union(source, target)
            tree.add((source, target))
    return tree
