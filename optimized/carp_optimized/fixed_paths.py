"""Fixed-path scheduling, with the paths and plans of `carp_reference.fixed_paths`."""

from collections.abc import Sequence
from heapq import heappop, heappush
from itertools import pairwise

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.jit.references import Native
from carp_optimized.queries.paths import add_disjoint, reach_beside
from carp_optimized.state.arrays import ALONE, NO_LIMIT, NONE, State
from carp_spec import FixedPaths
from carp_spec.limits import refuse_stops

Path = Sequence[int]


def fixed_paths(fleet: PlannedFleet, options: FixedPaths) -> None:
    """Plan all robots in the order given, as if there were no plans yet, each on the best of a few paths."""
    refuse_stops(fleet.instance)
    fleet.clear()
    moves = PathMoves(fleet)
    for robot in range(fleet.held.size):
        moves.add(robot, paths_of(fleet, robot, options))


def paths_of(fleet: PlannedFleet, robot: int, options: FixedPaths) -> list[Path]:
    """The paths from which a robot may choose."""
    start, goal = int(fleet.state.robots.start[robot]), int(fleet.state.robots.goal[robot])
    choose = shortest_paths if options.paths == "shortest" else disjoint_paths
    return fleet.call(lambda: choose(fleet.native, start, goal, options.k))


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
    """Adds robots to a fleet on paths: queries see the moves of a path in place of the graph's."""

    def __init__(self, fleet: PlannedFleet) -> None:
        """Begin with the arrays that the fleet has."""
        self._fleet = fleet
        self._take()

    def _take(self) -> None:
        """Take the fleet's arrays, but without moves."""
        self._state = self._fleet.state
        graph = self._state.graph
        first, target = np.zeros_like(graph.first), np.full_like(graph.target, NONE)
        self._native = Native(self._state._replace(graph=graph._replace(first=first, target=target)))

    def add(self, robot: int, paths: Sequence[Path]) -> bool:
        """Add a robot on the path on which it arrives first, the first of equals; whether it has a plan on any."""
        fleet = self._fleet
        fleet.forget_old_records()

        def attempt() -> list[int]:
            passes.reach_from_everywhere(fleet.native, robot)
            if self._state is not fleet.state:  # a call that ran out of room has made larger arrays
                self._take()
            return [passes.find_one(self._along(path), robot, NONE, 0, ALONE) for path in paths]

        found = [record for record in fleet.call(attempt) if record != NONE]
        if not found:
            return False
        best = np.array([min(found, key=lambda record: int(fleet.state.records.arrival[record]))], np.int32)
        fleet.reserve(np.array([robot], np.int32), best)
        return True

    def _along(self, path: Path) -> Native[State]:
        """The arrays with the moves of this path alone."""
        first, target = self._native.fields.graph.first, self._native.fields.graph.target
        first[:] = 0
        sources = np.array(path[:-1], np.int32)
        first[sources + 1] = 1
        np.cumsum(first, out=first)
        for source, following in pairwise(path):
            target[first[source]] = following
        return self._native
