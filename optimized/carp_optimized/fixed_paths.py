"""Fixed-path scheduling, with the paths and plans of `carp_reference.fixed_paths`."""

from collections.abc import Sequence
from heapq import heappop, heappush
from itertools import pairwise

import numpy as np

from carp_optimized.jit.references import Native
from carp_optimized.queries.paths import add_disjoint, reach_beside
from carp_optimized.state.arrays import NO_LIMIT, NONE, State

Path = Sequence[int]


def shortest_paths(native: Native[State], start: int, goal: int, k: int) -> list[Path]:
    """The k shortest simple paths: A* over their beginnings, each with the ticks of the best path that begins so."""
    graph = native.fields.graph
    targets = np.split(graph.target, graph.first[1:-1])
    rest = np.zeros(graph.duration.size, np.int64)
    found: list[Path] = []
    queue: list[tuple[int, list[int], int]] = [(0, [start], 0)]
    while queue and len(found) < k:
        _, path, gone = heappop(queue)
        if path[-1] == goal:
            found.append(path)
            continue
        gone += int(graph.duration[path[-1]])
        reach_beside(native, goal, np.array(path, np.int32), rest)
        for target in targets[path[-1]].tolist():
            if rest[target] < NO_LIMIT:
                heappush(queue, (gone + int(rest[target]), [*path, target], gone))
    return found


def disjoint_paths(native: Native[State], start: int, goal: int, k: int) -> list[Path]:
    """At most k disjoint paths, as short as possible together, the shortest first."""
    if start == goal:
        return [[start]]
    graph = native.fields.graph
    size = graph.duration.size
    before, ends, walk = np.full(size, NONE, np.int32), np.zeros(size, np.int32), np.zeros(2 * size, np.int32)
    scratch = np.zeros(size, np.int64), np.zeros(size, np.int64)
    for _ in range(min(k, size)):
        if not add_disjoint(native, start, goal, before, ends, *scratch, walk):
            break
    paths = []
    for last in np.flatnonzero(ends).tolist():
        path = [goal, last]
        while path[-1] != start:
            path.append(int(before[path[-1]]))
        paths.append(path[::-1])
    return sorted(paths, key=lambda path: (int(graph.duration[path].sum(dtype=np.int64)), path))


class PathMoves:
    """The arrays of a fleet with the moves of a path in place of its graph's."""

    def __init__(self, state: State) -> None:
        """Begin without moves; all other arrays are those of the fleet."""
        first, target = np.zeros_like(state.graph.first), np.full_like(state.graph.target, NONE)
        graph = state.graph._replace(first=first, target=target)
        self.native = Native(state._replace(graph=graph))

    def along(self, path: Path) -> Native[State]:
        """The arrays with the moves of this path alone."""
        first, target = self.native.fields.graph.first, self.native.fields.graph.target
        first[:] = 0
        sources = np.array(path[:-1], np.int32)
        first[sources + 1] = 1
        np.cumsum(first, out=first)
        for source, following in pairwise(path):
            target[first[source]] = following
        return self.native
