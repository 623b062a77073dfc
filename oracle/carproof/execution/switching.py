"""An executor that switches the order of robots where this is safe and makes them arrive earlier (SADG).

The executor learns of a delay when a robot enters the visit that takes longer. Then it looks at each robot that waits
for a late one, and lets it go first, in that resource and in all resources that the two share next to it, if the
dependency graph still has no cycle and the sum of all arrivals becomes smaller. Source: Berndt et al. 2020.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from carp_reference.execution import Order, order_of, order_with, solution_at
from carp_spec import Instance, ResourceId, Solution
from carp_spec.execution.dependencies import Dependency, Node
from carp_spec.limits import refuse
from carproof.execution.delays import Delay, delayed, is_last, reached, stuck

MOST_TRIED = 20


@dataclass(frozen=True, slots=True)
class Switched:
    """The solution whose order the robots kept in the end, the entry of each visit, and the number of switches."""

    solution: Solution
    enters: Mapping[Node, int]
    switches: int


def switching(instance: Instance, solution: Solution, delays: Sequence[Delay]) -> Switched:
    """Execute a solution without a cycle; no delay is at the last visit of a robot."""
    releases = {(robot.id, 0): robot.release for robot in instance.robots}
    order, known, switches = order_of(instance, solution), list[Delay](), 0
    enters = reached(order, releases)
    hidden = {(delay.robot, delay.visit): delay for delay in delays}
    while hidden:
        now = min(enters[node] for node in hidden)
        known += [delay for node, delay in hidden.items() if enters[node] <= now]
        hidden = {node: delay for node, delay in hidden.items() if enters[node] > now}
        happened = {node: tick for node, tick in enters.items() if tick <= now}
        while True:
            least = {node: happened.get(node, max(now + 1, releases.get(node, 0))) for node in order.nodes}
            enters = reached(delayed(order, known), least)
            better = _better(order, enters, least, known, now)
            if better is None:
                break
            order, switches = better, switches + 1
    return Switched(order.solution, enters, switches)


def _better(
    order: Order, enters: Mapping[Node, int], least: Mapping[Node, int], known: Sequence[Delay], now: int
) -> Order | None:
    """The order after the first switch tried that makes the sum of arrivals smaller."""
    lasts = [(plan.robot, len(plan.visits) - 1) for plan in order.solution.plans]
    total = sum(enters[node] for node in lasts)
    for pairs in _switches(order, enters, now):
        switched = order_with(order.instance, order.solution, _switched(order, pairs))
        times = reached(delayed(switched, known), least)
        if len(times) < len(order.nodes) or sum(times[node] for node in lasts) >= total:
            continue
        better = order_of(order.instance, solution_at(order, times))
        if not stuck(better):
            return better
    return None


def _switches(order: Order, enters: Mapping[Node, int], now: int) -> Iterator[frozenset[tuple[Node, Node]]]:
    """Pairs of visits that change places, all of two robots, where one waits for the other; the first waits first."""
    behind = dict.fromkeys(_neighbours(order))
    waits = sorted(
        (pair for pair in behind if min(enters[pair[0]], enters[pair[1]]) > now and pair[0][0] != pair[1][0]),
        key=lambda pair: (enters[pair[1]], str(pair)),
    )
    tried = 0
    for first, second in waits:
        if not _is_waiting(order, enters, first, second):
            continue
        found = {(first, second)}
        for step in (1, -1):
            for way in (1, -1):
                one, other = (first[0], first[1] + step), (second[0], second[1] + way * step)
                while (one, other) in behind and min(enters[one], enters[other]) > now:
                    found.add((one, other))
                    one, other = (one[0], one[1] + step), (other[0], other[1] + way * step)
        yield frozenset(found)
        tried += 1
        if tried == MOST_TRIED:
            return


def _is_waiting(order: Order, enters: Mapping[Node, int], first: Node, second: Node) -> bool:
    """Whether the second robot could enter earlier, but for the first."""
    before = (second[0], second[1] - 1)
    return second[1] > 0 and enters[second] > enters[before] + order.duration(before) and enters[second] > enters[first]


def _neighbours(order: Order) -> Iterator[tuple[Node, Node]]:
    """The pairs of visits to places for one robot, the second right after the first; who parks goes last."""
    for visits in _sequences(order).values():
        yield from (pair for pair in pairwise(visits) if order.visit(pair[1]).leave is not None)


def _sequences(order: Order) -> dict[ResourceId, list[Node]]:
    refuse(order.instance, "groups")
    sequences: dict[ResourceId, list[Node]] = defaultdict(list)
    for node in order.nodes:
        resource = order.visit(node).resource
        if order.instance.graph.resource[resource].capacity == 1:
            sequences[resource].append(node)
    return sequences


def _switched(order: Order, pairs: Collection[tuple[Node, Node]]) -> tuple[Dependency, ...]:
    """The edges after the switch."""
    sequences = _sequences(order)
    changed = {order.visit(first).resource for first, _ in pairs}
    for first, second in pairs:
        visits = sequences[order.visit(first).resource]
        place = visits.index(first)
        visits[place : place + 2] = [second, first]
    edges = [edge for edge in order.edges if edge.kind == "travel" or edge.resource not in changed]
    for resource in changed:
        for first, second in pairwise(sequences[resource]):
            ticks = order.instance.gap
            if is_last(order, first):
                edges.append(Dependency("order", first, second, order.duration(first) + ticks, resource))
            else:
                following = (first[0], first[1] + 1)
                came_from = order.visit((second[0], second[1] - 1)).resource if second[1] > 0 else None
                ticks = max(ticks, int(order.visit(following).resource == came_from))
                edges.append(Dependency("order", following, second, ticks, resource))
    return tuple(edges)
