"""Delays, and what they do to robots that keep the planned order or keep to the clock.

All of it follows from the action dependency graph of a lawful solution, an `Order`.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from msgspec import structs

from carp_reference.execution import Order, earliest, order_with
from carp_spec import Instance, Plan, ResourceGraph, ResourceId, RobotId, Solution, Visit
from carp_spec.execution.dependencies import Dependency, Node, stays_by_constraint
from carp_spec.execution.traces import Trace
from carp_spec.plan_rules import least_stays


@dataclass(frozen=True, slots=True)
class Delay:
    """The robot needs `ticks` more for that visit of its plan than the duration."""

    robot: RobotId
    visit: int
    ticks: int


def longer(delays: Iterable[Delay]) -> dict[Node, int]:
    """The ticks that each delayed visit lasts longer."""
    return {(delay.robot, delay.visit): delay.ticks for delay in delays}


def delayed(order: Order, delays: Iterable[Delay]) -> Order:
    """The order with longer edges out of the visits that are delayed."""
    more = longer(delays)
    edges = (
        replace(edge, ticks=edge.ticks + more[edge.before]) if edge.before in more and edge.holds else edge
        for edge in order.edges
    )
    return order_with(order.instance, order.solution, tuple(edges))


def is_last(order: Order, node: Node) -> bool:
    """Whether the plan ends with the visit."""
    return node[1] == len(order.plans[node[0]].visits) - 1


def planned(order: Order) -> dict[Node, int]:
    """The tick at which each visit is planned to begin."""
    return {node: order.visit(node).enter for node in order.nodes}


def slack(order: Order) -> dict[Node, int | None]:
    """The slack of each visit: the longest delay there by which no robot arrives later than planned; `None`: any.

    Robots wait for others in the planned order, and otherwise keep to the ticks of their plans.
    """
    ticks = planned(order)
    horizon = max(ticks.values(), default=0)
    least = {node: -tick if is_last(order, node) else -horizon for node, tick in ticks.items()}
    turned = tuple(replace(edge, before=edge.after, after=edge.before) for edge in order.edges)
    backwards = replace(order_with(order.instance, order.solution, turned), nodes=order.nodes[::-1])
    latest = {node: -tick for node, tick in earliest(backwards, least).items()}
    return {
        node: min(
            (latest[edge.after] - edge.ticks - tick for edge in order.out_of.get(node, ()) if edge.holds), default=None
        )
        for node, tick in ticks.items()
    }


def late_robots(order: Order, delays: Sequence[Delay]) -> dict[RobotId, int]:
    """The ticks by which robots arrive later than planned; robots that are not late are left out."""
    enters = earliest(delayed(order, delays), planned(order))
    last = [(plan.robot, len(plan.visits) - 1) for plan in order.solution.plans]
    return {node[0]: late for node in last if (late := enters[node] - order.visit(node).enter) > 0}


def smallest_collision(instance: Instance, solution: Solution) -> tuple[Delay, ...] | None:
    """Delays of the least sum by which robots that keep to the clock collide; `None` if no delays do that.

    A robot on the clock enters each visit at its planned tick, or as soon after it as its own durations and delays
    allow. A collision is either too many robots in a resource or a group when one enters, or two robots that exchange
    places. A delay is spent best at the visit that it makes too long. Of equal sums the fewest delays are taken.
    """
    found = _collisions(instance, solution)
    return min(found, key=lambda delays: (sum(delay.ticks for delay in delays), len(delays)), default=None)


def _collisions(instance: Instance, solution: Solution) -> Iterator[tuple[Delay, ...]]:
    """The shortest delays that make a collision, for each visit and all robots that may be there when it begins."""
    graph, constraints = instance.graph, instance.graph.constraints
    plans = {plan.robot: (plan.visits, least_stays(instance, plan)) for plan in solution.plans}
    for constraint, stays in stays_by_constraint(graph, solution.plans).items():
        capacity = constraints[constraint].capacity
        for stay in stays:
            tick = stay.visit.enter
            present = {
                each.node[0]
                for each in stays
                if each.visit.enter <= tick and (each.visit.leave is None or tick < each.visit.leave)
            }
            found: dict[RobotId, Delay] = {}
            for each in stays:
                robot, place = each.last
                if robot in present or each.visit.leave is None or each.visit.leave > tick:
                    continue
                visits, least = plans[robot]
                ticks = tick + 1 - visits[place].enter - least[place]
                if ticks > 1 and graph.is_area(constraint) and _is_close(graph, each.target, stay.source):
                    yield (Delay(robot, place, ticks - 1),)
                found[robot] = Delay(robot, place, ticks)  # of a later visit of the same robot, the shorter one
            missing = capacity + 1 - len(present)
            if missing <= len(found):
                yield tuple(sorted(found.values(), key=lambda delay: delay.ticks)[:missing])


def _is_close(graph: ResourceGraph, target: ResourceId | None, source: ResourceId | None) -> bool:
    return target is not None and source is not None and graph.are_close(target, source)


def on_the_clock(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
    """The entry of each visit if every robot keeps to the ticks of its own plan as well as it can."""
    more = longer(delays)
    enters: dict[Node, int] = {}
    for plan in order.solution.plans:
        ready = 0
        for place, visit in enumerate(plan.visits):
            node = (plan.robot, place)
            enters[node] = max(visit.enter, ready)
            ready = enters[node] + order.duration(node) + more.get(node, 0)
    return enters


def in_order(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
    """The entry of each visit if every robot continues as soon as its dependencies allow.

    Robots that wait for each other in a cycle, and those that wait for them, never enter; they are left out.
    """
    return reached(delayed(order, delays), {(robot.id, 0): robot.release for robot in order.instance.robots})


def stuck(order: Order) -> frozenset[Node]:
    """The visits in a cycle of dependencies, and those that wait for one."""
    return frozenset(order.nodes) - reached(order, {}).keys()


def reached(order: Order, least: Mapping[Node, int]) -> dict[Node, int]:
    """The earliest entry of each visit that waits for no cycle, none before its tick in `least`."""
    enters = {node: least.get(node, 0) for node in order.nodes}
    missing = dict.fromkeys(order.nodes, 0)
    for edge in order.edges:
        missing[edge.after] += 1
    ready = [node for node in order.nodes if missing[node] == 0]
    for node in ready:
        for edge in order.out_of.get(node, ()):
            enters[edge.after] = max(enters[edge.after], enters[node] + edge.ticks)
            missing[edge.after] -= 1
            if missing[edge.after] == 0:
                ready.append(edge.after)
    return {node: tick for node, tick in enters.items() if missing[node] == 0}


def may_enter(order: Order, trace: Trace, ready: Iterable[RobotId]) -> tuple[RobotId, ...]:
    """The robots among those ready that enter their next visit at the tick `trace.now`, if all keep the planned order.

    A robot may enter at the tick at which another makes room for it. So robots in a row move together.
    """
    enters = {node: visit.enter for node, visit in trace.happened.items()}
    leaves = {node: visit.leave for node, visit in trace.happened.items()}

    def is_over(edge: Dependency) -> bool:
        if edge.before not in enters:
            return False
        if not edge.holds:
            return enters[edge.before] + edge.ticks <= trace.now
        leave = leaves.get(edge.before)
        return leave is not None and leave + edge.ticks - order.duration(edge.before) <= trace.now

    waits_for: dict[Node, list[Dependency]] = defaultdict(list)
    for edge in order.edges:
        if edge.kind == "order":
            waits_for[edge.after].append(edge)
    chosen = set(ready)
    waiting = [(plan.robot, len(plan.visits)) for plan in trace.plans if plan.robot in chosen]
    waiting = [node for node in waiting if node[1] < len(order.plans[node[0]].visits)]
    entering: list[RobotId] = []
    while (node := next((each for each in waiting if all(map(is_over, waits_for[each]))), None)) is not None:
        waiting.remove(node)
        enters[node] = trace.now
        entering.append(node[0])
    return tuple(entering)


def executed(order: Order, enters: Mapping[Node, int], delays: Iterable[Delay] = (), now: int | None = None) -> Trace:
    """The trace of an execution by the tick now, or by its last event."""
    more = longer(delays)
    plans = []
    for plan in order.solution.plans:
        visits = []
        for place, visit in enumerate(plan.visits):
            node = (plan.robot, place)
            if node not in enters:
                break
            leave = enters.get((plan.robot, place + 1))
            if is_last(order, node) and visit.leave is not None:
                leave = enters[node] + order.duration(node) + more.get(node, 0)
            visits.append(Visit(visit.resource, enters[node], leave))
        plans.append(Plan(plan.robot, tuple(visits)))
    events = (tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave or 0))
    whole = Trace(max(events, default=0), tuple(plans))
    return whole if now is None else until(whole, now)


def until(trace: Trace, now: int) -> Trace:
    """The part of a trace that has happened by the tick now."""
    plans = (
        Plan(
            plan.robot,
            tuple(
                structs.replace(visit, leave=None if visit.leave is None or visit.leave > now else visit.leave)
                for visit in plan.visits
                if visit.enter <= now
            ),
        )
        for plan in trace.plans
    )
    return Trace(now, tuple(plans))
