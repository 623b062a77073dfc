"""An executor that switches the order of robots where this is safe and makes them arrive earlier (SADG).

The executor learns of a delay when a robot enters the visit that takes longer. Then it looks at each robot that waits
for a late one, and lets it go first, in that resource or group and in all that the two share next to it, if the
dependency graph still has no cycle and the sum of all arrivals becomes smaller. Source: Berndt et al. 2020.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import TypeAlias

from carp_reference.execution import Order, order_of, order_with, solution_at
from carp_spec import Instance, RobotId, Solution
from carp_spec.execution.dependencies import Dependency, Node, Stay, stays_by_constraint, waiting
from carproof.execution.delays import Delay, delayed, reached, stuck

MOST_TRIED = 20

Pair: TypeAlias = tuple[int, Stay, Stay]
"""The index of a resource or group, and two stays in it, the second right after the first."""
Sequences: TypeAlias = Mapping[int, Sequence[Stay]]


@dataclass(frozen=True, slots=True)
class Switched:
    """The solution whose order the robots kept in the end, the entry of each visit, and the number of switches."""

    solution: Solution
    enters: Mapping[Node, int]
    switches: int


def switching(instance: Instance, solution: Solution, delays: Sequence[Delay]) -> Switched:
    """Execute a solution without a cycle."""
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
    sequences = _sequences(order)
    for pairs in _switches(order, sequences, enters, now):
        switched = order_with(order.instance, order.solution, _switched(order, sequences, pairs))
        times = reached(delayed(switched, known), least)
        if len(times) < len(order.nodes) or sum(times[node] for node in lasts) >= total:
            continue
        better = order_of(order.instance, solution_at(order, times))
        if not stuck(better):
            return better
    return None


def _switches(order: Order, sequences: Sequences, enters: Mapping[Node, int], now: int) -> Iterator[tuple[Pair, ...]]:
    """Pairs of stays that change places, all of two robots, where one waits for the other; the first waits first."""
    behind: dict[tuple[RobotId, RobotId], list[Pair]] = defaultdict(list)
    for constraint, stays in sequences.items():
        for first, second in pairwise(stays):
            if second.visit.leave is not None and min(enters[first.node], enters[second.node]) > now:
                behind[first.node[0], second.node[0]].append((constraint, first, second))
    waits = sorted(
        (pair for robots, pairs in behind.items() if robots[0] != robots[1] for pair in pairs),
        key=lambda pair: (enters[pair[2].node], str(pair[1:])),
    )
    late = (pair for pair in waits if _is_waiting(order, enters, pair[1].node, pair[2].node))
    for pair in islice(late, MOST_TRIED):
        yield _beside(pair, behind[pair[1].node[0], pair[2].node[0]])


def _is_waiting(order: Order, enters: Mapping[Node, int], first: Node, second: Node) -> bool:
    """Whether the second robot could enter earlier, but for the first."""
    before = (second[0], second[1] - 1)
    return second[1] > 0 and enters[second] > enters[before] + order.duration(before) and enters[second] > enters[first]


def _beside(pair: Pair, pairs: Collection[Pair]) -> tuple[Pair, ...]:
    """The pairs that lead from this one to each other over visits that are the next of both robots, or the same."""
    found = {pair: None}
    along = [pair]
    for one in along:
        new = [each for each in pairs if each not in found and all(map(_touch, one[1:], each[1:]))]
        found.update(dict.fromkeys(new))
        along += new
    return tuple(found)


def _touch(one: Stay, other: Stay) -> bool:
    return one.node[1] <= other.last[1] + 1 and other.node[1] <= one.last[1] + 1


def _sequences(order: Order) -> Sequences:
    """The stays in each resource and group that has room for one robot, in their order."""
    constraints = order.instance.graph.constraints
    return {
        constraint: sorted(stays, key=lambda stay: stay.visit.enter)
        for constraint, stays in stays_by_constraint(order.instance.graph, order.solution.plans).items()
        if constraints[constraint].capacity == 1
    }


def _switched(order: Order, sequences: Sequences, pairs: Collection[Pair]) -> tuple[Dependency, ...]:
    changed = {constraint: [*sequences[constraint]] for constraint, _, _ in pairs}
    for constraint, first, second in pairs:
        stays = changed[constraint]
        place = stays.index(first)
        stays[place : place + 2] = [second, first]
    edges = [edge for edge in order.edges if edge.kind == "travel" or edge.constraint not in changed]
    for constraint, stays in changed.items():
        for first, second in pairwise(stays):
            edges.append(waiting(order.instance, constraint, first, second, order.duration(first.last)))
    return tuple(edges)
