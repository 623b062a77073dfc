"""Fixed-path scheduling: each robot takes the best of a few paths."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from heapq import heappop, heappush
from itertools import pairwise
from typing import TYPE_CHECKING, cast

from carp_reference.orderings import Plans
from carp_reference.problem import Problem, backward_graph
from carp_reference.query import find_plan
from carp_spec import FixedPaths, Move, Plan, ResourceId, Robot, plan_cost
from carp_spec.limits import refuse_stops

if TYPE_CHECKING:
    import networkx as nx

Path = tuple[ResourceId, ...]


def fixed_paths(problem: Problem, options: FixedPaths) -> Plans:
    """Plan the robots in the order given, each on its best path, the first of equals."""
    refuse_stops(problem.instance)
    paths_of = shortest_paths if options.paths == "shortest" else disjoint_paths
    plans: list[Plan] = []
    for robot in problem.instance.robots:
        paths = paths_of(problem, robot, options.k)
        found = [plan for path in paths if (plan := find_on_path(problem, plans, robot, path)) is not None]
        if found:
            plans.append(min(found, key=lambda plan: plan_cost(problem.instance, plan)))
    return tuple(plans)


def find_on_path(problem: Problem, committed: Sequence[Plan], robot: Robot, path: Path) -> Plan | None:
    """The CARP query with the moves of the path alone, which visits no resource twice."""
    successors = {source: (target,) for source, target in pairwise(path)}
    return find_plan(problem, committed, robot.id, {**successors, robot.goal: ()})


def shortest_paths(problem: Problem, robot: Robot, k: int) -> list[Path]:
    """The k shortest simple paths, shortest first, of equals the one whose resources come first in the graph.

    A* over their beginnings; h is the rest of the shortest path that begins so.
    """
    graph, backward = problem.instance.graph, backward_graph(problem.instance, robot)
    found: list[Path] = []
    queue: list[tuple[int, list[int], Path]] = [(0, [graph.index[robot.start]], (robot.start,))]
    while queue and len(found) < k:
        _, _, path = heappop(queue)
        if path[-1] == robot.goal:
            found.append(path)
            continue
        gone = sum(problem.instance.duration(robot.id, resource) for resource in path)
        rest = _ticks_beside(backward, robot.goal, path)
        for target in graph.successors[path[-1]]:
            if target in rest:
                longer = (*path, target)
                heappush(queue, (gone + rest[target], [graph.index[resource] for resource in longer], longer))
    return found


def _ticks_beside(backward: "nx.DiGraph[ResourceId]", goal: ResourceId, path: Path) -> Mapping[ResourceId, int]:
    """The ticks from entering each resource to entering the goal, by moves that lead from no resource of the path."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    def weight(_: ResourceId, source: ResourceId, move: dict[str, int]) -> int | None:
        return None if source in path else move["ticks"]

    return cast("dict[ResourceId, int]", nx.single_source_dijkstra_path_length(backward, goal, weight=weight))


def disjoint_paths(problem: Problem, robot: Robot, k: int) -> list[Path]:
    """At most k disjoint paths of the least length together, shortest first (as Suurballe 1974).

    They are a flow, made path by path; the moves of each further one may undo some of those before.
    """
    if robot.start == robot.goal:
        return [(robot.start,)]
    moves: set[Move] = set()
    for _ in range(k):
        changed = _one_more(problem, robot, moves)
        if not changed:
            break
        moves ^= changed
    following = {source: target for source, target in moves if source != robot.start}
    paths = [_follow(following, robot, target) for source, target in moves if source == robot.start]
    index = problem.instance.graph.index
    lengths = {path: sum(problem.instance.duration(robot.id, resource) for resource in path) for path in paths}
    return sorted(paths, key=lambda path: (lengths[path], [index[resource] for resource in path]))


def _one_more(problem: Problem, robot: Robot, moves: set[Move]) -> set[Move]:
    """The moves to make, or to undo, for one path more at the least cost; none if there is no further path.

    Of equals, those of the fewest steps, then those that stand at the resources that come first in the graph.
    """
    index = problem.instance.graph.index
    best: dict[ResourceId, tuple[int, int, tuple[int, ...], tuple[Move, ...]]] = {robot.start: (0, 0, (), ())}
    queue = deque([robot.start])
    while queue:
        here = queue.popleft()
        cost, steps, places, changed = best[here]
        for there, ticks, changes in _steps(problem, robot, moves, here):
            label = (cost + ticks, steps + 1, (*places, index[there]), (*changed, *changes))
            if there not in best or label[:3] < best[there][:3]:
                best[there] = label
                if there != robot.goal:
                    queue.append(there)
    return set(best[robot.goal][3]) if robot.goal in best else set()


def _steps(
    problem: Problem, robot: Robot, moves: set[Move], here: ResourceId
) -> Iterator[tuple[ResourceId, int, list[Move]]]:
    """Steps behind `here` in search of one path more: where each leads, what it costs, and the moves that it changes.

    To a resource of another path comes with the move that led there undone; from there on that path needs another way.
    """
    before = {target: source for source, target in moves if target != robot.goal}
    for target in problem.instance.graph.successors[here]:
        move = (here, target)
        if target == robot.start or move in moves:
            continue
        if target == robot.goal:
            yield target, 0, [move]
        elif target not in before:
            yield target, problem.instance.duration(robot.id, target), [move]
        else:
            yield before[target], 0, [move, (before[target], target)]
    if here in before:
        yield before[here], -problem.instance.duration(robot.id, here), [(before[here], here)]


def _follow(following: dict[ResourceId, ResourceId], robot: Robot, first: ResourceId) -> Path:
    path = [robot.start, first]
    while path[-1] != robot.goal:
        path.append(following[path[-1]])
    return tuple(path)
