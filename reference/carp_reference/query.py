"""The CARP query: A* over free time windows (ter Mors 2010), a close relative of SIPP (Phillips and Likhachev 2011).

A node is a free window of a resource (a safe interval in SIPP) with the number of stops that have been served, entered
as early as possible. A robot can wait in a window at no cost, so each window needs only one entry for each number.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from itertools import pairwise

from carp_reference.context import Context, context_of
from carp_reference.problem import Problem
from carp_spec import Instance, Plan, ResourceId, RobotId, Visit, has_ended
from carp_spec.plan_rules import stops_served
from carp_spec.query_rules import expansion_key
from carp_spec.windows import Window, stay_fits


@dataclass(frozen=True, slots=True)
class Node:
    """A window entered at `enter`, with so many stops `served`, which the robot may leave from `ready` on.

    `parent` is where it came from; if that is the same resource, the robot has served a stop there.
    """

    resource: ResourceId
    window: Window
    enter: int
    ready: int
    served: int
    parent: "Node | None"


def find_plan(
    problem: Problem,
    committed: Sequence[Plan],
    robot: RobotId,
    successors: Mapping[ResourceId, Sequence[ResourceId]] | None = None,
) -> Plan | None:
    """The plan with the earliest arrival against the committed plans, or `None`; `successors` restricts the moves."""
    context = context_of(problem.instance, committed)
    before = problem.before.get(robot)
    if before is not None and has_ended(before, problem.now):
        return before if context.allows(before.visits) else None
    past, start = _start(problem, context, robot)
    if start is None:
        return None
    moves = successors or problem.instance.graph.successors
    last, _ = _search(problem, context, robot, start, moves, _opens(problem, context, robot))
    return None if last is None else Plan(robot, (*past, *_visits(problem.instance, robot, last)))


def nodes_before_arrival(problem: Problem, committed: Sequence[Plan], robot: RobotId) -> list[Node]:
    """The nodes after the start from which the goal might be reached before the arrival, expanded in the order of f."""
    before = problem.before.get(robot)
    context = context_of(problem.instance, committed)
    _, start = _start(problem, context, robot)
    if start is None or (before is not None and has_ended(before, problem.now)):
        return []
    _, expanded = _search(problem, context, robot, start, problem.instance.graph.successors, 0)
    return expanded[1:]


def _start(problem: Problem, context: Context, robot: RobotId) -> tuple[Sequence[Visit], Node | None]:
    """The visits that are over, and the node of the current one; `None` if a committed plan conflicts with them."""
    request = problem.instance.robot[robot]
    before = problem.before.get(robot)
    entered = [] if before is None else [visit for visit in before.visits if visit.enter <= problem.now]
    *past, current = entered or [Visit(request.start, request.release, None)]
    ready = max(current.enter + problem.instance.duration(robot, current.resource), problem.now)
    stay = Visit(current.resource, current.enter, ready)
    window = context.window_around(stay)
    if window is None or not context.allows([*past, stay]):
        return past, None
    served = stops_served(request.stops[:-1], past)
    return past, Node(current.resource, window, current.enter, ready, served, None)


def _opens(problem: Problem, context: Context, robot: RobotId) -> int:
    """The tick at which the last window of the goal opens, in which the robot parks; 0 if it does not park."""
    windows = context.windows(problem.instance.robot[robot].goal)
    return windows[-1].start if windows and problem.instance.after_goal == "park" else 0


def _search(
    problem: Problem,
    context: Context,
    robot: RobotId,
    start: Node,
    successors: Mapping[ResourceId, Sequence[ResourceId]],
    opens: int,
) -> tuple[Node | None, list[Node]]:
    """A* in the order of `query/ties`: the node in which the robot ends its plan, or `None`, and those expanded before.

    Nodes of an f up to `opens` come first. The start is not among the windows entered: a robot that has stayed at its
    goal too long to end there may come back.
    """
    entered: dict[tuple[ResourceId, Window, int], int] = {}
    expanded: list[Node] = []
    queue: list[tuple[tuple[int, ...], Node]] = []

    def push(node: Node) -> None:
        ticks_to_goal = problem.ticks_to_goal[robot][node.served]
        if node.resource in ticks_to_goal:
            g = node.ready - problem.instance.duration(robot, node.resource)
            index = problem.instance.graph.index[node.resource]
            key = expansion_key(g + ticks_to_goal[node.resource], g, index, node.window.start, node.served, opens)
            heappush(queue, (key, node))

    push(start)
    while queue:
        _, node = heappop(queue)
        if _can_end(problem, robot, node):
            return node, expanded
        expanded.append(node)
        targets = successors.get(node.resource, ())
        for following in (*_serve(context, robot, node), *_expand(context, robot, node, targets)):
            key = (following.resource, following.window, following.served)
            if key not in entered or following.ready < entered[key]:
                entered[key] = following.ready
                push(following)
    return None, expanded


def _can_end(problem: Problem, robot: RobotId, node: Node) -> bool:
    """Whether the plan can end in the node: at the last stop, for ever (`park`), or until its end (`vanish`)."""
    instance = problem.instance
    *stops, last = instance.robot[robot].stops
    if node.resource != last.resource or node.served < len(stops):
        return False
    if instance.after_goal == "park":
        return node.window.end is None
    leave = node.enter + instance.stay(robot, last)
    return leave >= problem.now and node.window.lasts_until(leave)


def _serve(context: Context, robot: RobotId, node: Node) -> Iterator[Node]:
    """The same window once the next stop but the last is served, if it is here."""
    *stops, _ = context.instance.robot[robot].stops
    if node.served < len(stops) and stops[node.served].resource == node.resource:
        ready = max(node.ready, node.enter + stops[node.served].service)
        if node.window.lasts_until(ready):
            yield replace(node, ready=ready, served=node.served + 1, parent=node)


def _expand(context: Context, robot: RobotId, node: Node, targets: Sequence[ResourceId]) -> Iterator[Node]:
    """Every window that one move leads to, entered as early as possible."""
    for target in targets:
        duration = context.instance.duration(robot, target)
        for window in context.windows(target):
            enter = max(node.ready, window.start)
            while context.is_exchange(enter, node.resource, target):
                enter += 1
            if node.window.lasts_until(enter) and stay_fits(window, enter, enter + duration, duration):
                yield Node(target, window, enter, enter + duration, node.served, node)


def _visits(instance: Instance, robot: RobotId, last: Node) -> tuple[Visit, ...]:
    """Follow the parents back to the start."""
    path = [last]
    while path[-1].parent is not None:
        path.append(path[-1].parent)
    path = [node for node in reversed(path) if node.parent is None or node.resource != node.parent.resource]
    stay = instance.stay(robot, instance.robot[robot].stops[-1])
    leave = None if instance.after_goal == "park" else last.enter + stay
    stays = [Visit(node.resource, node.enter, following.enter) for node, following in pairwise(path)]
    return (*stays, Visit(last.resource, last.enter, leave))
