"""Retiming: after delays, plans for the rest of the way in the planned order, as early as possible."""

from collections import defaultdict, deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from carp_spec import Instance, Plan, RobotId, Solution, Visit
from carp_spec.execution.dependencies import Dependency, Node, dependencies
from carp_spec.execution.execution_rules import require_followed, require_lawful_ends
from carp_spec.execution.traces import Trace
from carp_spec.plan_rules import least_stays
from carp_spec.requests import require_trace


@dataclass(frozen=True, slots=True)
class Order:
    """A lawful solution with its dependency graph; `nodes` are in the order of their planned entries."""

    instance: Instance
    solution: Solution
    plans: Mapping[RobotId, Plan]
    nodes: tuple[Node, ...]
    edges: tuple[Dependency, ...]
    out_of: Mapping[Node, Sequence[Dependency]]
    least: Mapping[RobotId, Sequence[int]]

    def visit(self, node: Node) -> Visit:
        """The visit of the plan."""
        return self.plans[node[0]].visits[node[1]]

    def duration(self, node: Node) -> int:
        """Ticks that the visit takes at least."""
        return self.least[node[0]][node[1]]


def order_of(instance: Instance, solution: Solution) -> Order:
    """Make the dependency graph of a lawful solution."""
    return order_with(instance, solution, tuple(dependencies(instance, solution.plans)))


def order_with(instance: Instance, solution: Solution, edges: tuple[Dependency, ...]) -> Order:
    """The order with these edges."""
    out_of: dict[Node, list[Dependency]] = defaultdict(list)
    for edge in edges:
        out_of[edge.before].append(edge)
    plans = {plan.robot: plan for plan in solution.plans}
    enters = {(plan.robot, place): visit.enter for plan in solution.plans for place, visit in enumerate(plan.visits)}
    least = {plan.robot: least_stays(instance, plan) for plan in solution.plans}
    return Order(instance, solution, plans, tuple(sorted(enters, key=enters.__getitem__)), edges, out_of, least)


def earliest(order: Order, least: Mapping[Node, int]) -> dict[Node, int]:
    """The earliest entry of each visit, none before its tick in `least`.

    No edge leads to a visit planned earlier: times are propagated in the planned order, and within a tick until nothing
    changes.
    """
    enters = {node: least.get(node, 0) for node in order.nodes}
    for _, group in groupby(order.nodes, key=lambda node: order.visit(node).enter):
        waiting = deque(group)
        alike = set(waiting)
        while waiting:
            node = waiting.popleft()
            for edge in order.out_of.get(node, ()):
                if enters[edge.after] < enters[node] + edge.ticks:
                    enters[edge.after] = enters[node] + edge.ticks
                    if edge.after in alike:
                        waiting.append(edge.after)
    return enters


def retime(instance: Instance, solution: Solution, trace: Trace) -> Solution:
    """Plan the rest of the way: the visits of the trace are kept, and all others entered after the tick `trace.now`.

    Who changes these plans at the tick `trace.now + 1` or later keeps what the trace tells; at `trace.now` a robot
    could still leave where it has stayed.

    Raises `Refusal` if the trace does not follow the solution, and where no lawful plan has the history.
    """
    require_trace(instance, solution, trace)
    require_followed(instance, solution, trace)
    order = order_of(instance, solution)
    least = {(robot.id, 0): robot.release for robot in instance.robots}
    for node in order.nodes:
        if node[1] > 0 or least[node] <= trace.now:
            least[node] = trace.now + 1
    enters = earliest(order, {**least, **{node: visit.enter for node, visit in trace.happened.items()}})
    after = solution_at(order, enters)
    require_lawful_ends(instance, after, trace)
    return after


def solution_at(order: Order, enters: Mapping[Node, int]) -> Solution:
    """The solution with its visits at these ticks."""
    plans = []
    for plan in order.solution.plans:
        ticks = [enters[plan.robot, place] for place in range(len(plan.visits))]
        parks = plan.visits[-1].leave is None
        ends = [*ticks[1:], None if parks else ticks[-1] + order.duration((plan.robot, len(ticks) - 1))]
        stays = zip(plan.visits, ticks, ends, strict=True)
        plans.append(Plan(plan.robot, tuple(Visit(visit.resource, enter, leave) for visit, enter, leave in stays)))
    return Solution(tuple(plans), order.solution.order, order.solution.unplanned)
