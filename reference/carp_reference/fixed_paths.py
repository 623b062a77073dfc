"""Fixed-path scheduling: each robot takes the best of a few paths."""

from collections.abc import Sequence
from itertools import islice, pairwise

from carp_reference.orderings import Plans
from carp_reference.problem import Problem
from carp_reference.query import find_plan
from carp_spec import FixedPaths, Plan, ResourceId, Robot, plan_cost
from carp_spec.limits import refuse

Path = tuple[ResourceId, ...]
Flow = dict[tuple[str, ResourceId], dict[tuple[str, ResourceId], int]]


def fixed_paths(problem: Problem, options: FixedPaths) -> Plans:
    """Plan the robots in the order given, each on its best path, the first of equals."""
    refuse(problem.instance, "stops")
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
    """The k shortest simple paths (Yen 1971), shortest first."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    if robot.start not in problem.ticks_to_goal[robot.id][0]:
        return []
    graph: nx.DiGraph[ResourceId] = nx.DiGraph()
    for source, targets in problem.instance.graph.successors.items():
        for target in targets:
            graph.add_edge(source, target, ticks=problem.instance.duration(robot.id, source))
    if robot.start == robot.goal:
        return [(robot.start,)]
    paths = nx.shortest_simple_paths(graph, robot.start, robot.goal, weight="ticks")
    return [tuple(path) for path in islice(paths, k)]


def disjoint_paths(problem: Problem, robot: Robot, k: int) -> list[Path]:
    """At most k disjoint paths: a flow of least cost with each resource split in two (as Suurballe 1974)."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    if robot.start == robot.goal:
        return [(robot.start,)]
    graph: nx.DiGraph[object] = nx.DiGraph()
    graph.add_edge("source", ("out", robot.start), capacity=k)
    graph.add_node(("in", robot.goal))
    for source, targets in problem.instance.graph.successors.items():
        if source != robot.goal:
            graph.add_edge(
                ("in", source), ("out", source), capacity=1, weight=problem.instance.duration(robot.id, source)
            )
            for target in targets:
                if target != robot.start:
                    graph.add_edge(("out", source), ("in", target), capacity=1)
    flow = nx.max_flow_min_cost(graph, "source", ("in", robot.goal))
    firsts = (target for (_, target), used in flow["out", robot.start].items() if used)
    paths = [_follow(flow, robot, first) for first in firsts]
    index = problem.instance.graph.index
    lengths = {path: sum(problem.instance.duration(robot.id, resource) for resource in path) for path in paths}
    return sorted(paths, key=lambda path: (lengths[path], [index[resource] for resource in path]))


def _follow(flow: Flow, robot: Robot, first: ResourceId) -> Path:
    path = [robot.start, first]
    while path[-1] != robot.goal:
        path.extend(target for (_, target), used in flow["out", path[-1]].items() if used)
    return tuple(path)
