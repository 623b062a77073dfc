"""The formula of all plans whose total is at most K, made small by a lower bound.

It has only nodes whose reduced cost (`carp_optimum.lagrangian.reduced_costs`) is within the gap, and all conflicts.
The costs that share the gap are counted in `LEVELS` parts of it, rounded down: the reduced cost of each robot, the
price of each resource that nobody is in, and the price of deadlines for each robot that is late, but one: the bound
takes it that all the others pay it. Instances have no groups: with them, exchanges would need more than the directions
of edges, and the search that asks for these formulas (`carp_optimum.narrowing`) found no optimum sooner.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise

from carp_optimum.lagrangian.reduced_costs import PricedBound, ReducedCosts
from carp_optimum.sat.totalizer_order import groups_of_near, sum_of_near
from carp_spec import Instance, ResourceId
from carp_verify.optimum.clauses import Formula, Literal, Unary
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.robot_clauses import Node, RobotClauses

LEVELS = 24
MOST_CLAUSES = 4_000_000


@dataclass(frozen=True, slots=True)
class PricedFormula:
    """The encoding of all plans of at most some total, and the sum of their delays."""

    encoding: Encoding
    delays: Unary

    def require_less(self, cost: int) -> None:
        """Demand a lower total than this."""
        delay = cost - self.encoding.shortest
        if delay <= 0:
            self.encoding.formula.add()  # the empty clause: no delay is below zero
        elif delay <= len(self.delays):
            self.encoding.formula.add(-self.delays[delay - 1])


def priced_formula(instance: Instance, bound: PricedBound, cost: int, look: Callable[[], None]) -> PricedFormula:
    """The formula of all plans of at most this total; `look` is called now and then, and may end it by an exception.

    Raises `Refusal` beyond `MOST_CLAUSES`.
    """
    encoding = Encoding(instance, look, MOST_CLAUSES)
    shortest = {robot.robot.id: robot.shortest or 0 for robot in encoding.robots}
    described: list[tuple[RobotClauses, ReducedCosts]] = []
    for robot in encoding.robots:
        look()
        horizon = 0
        if instance.after_goal == "park" or robot.robot.start != robot.robot.goal:
            reduced = ReducedCosts(bound, robot, shortest, cost)
            described.append((robot, reduced))
            robot.keep_only(reduced.nodes)
            horizon = max(reduced.delays, default=0)
        while robot.horizon < horizon:
            robot.grow()
    encoding.close()
    _forbid_meetings(encoding, look)
    _forbid_exchanges(encoding)
    formula, unit = encoding.formula, max(1, bound.gap(cost))
    levels = [{node: _level(reduced.nodes.get(node, 0), unit) for node in robot.node} for robot, reduced in described]
    rounds = groups_of_near([{node: (LEVELS + 1 - level) ** 2 for node, level in each.items()} for each in levels])
    delays = [robot.late for robot, _ in described]
    priced = PricedFormula(encoding, sum_of_near(formula, delays, rounds, max(1, cost + 1 - encoding.shortest)))
    priced.require_less(cost + 1)
    costs = [
        _reduced_cost(formula, robot, nodes, reduced, unit)
        for (robot, reduced), nodes in zip(described, levels, strict=True)
    ]
    others = [*_prices_of_empty_places(encoding, bound, unit), *_prices_of_late_robots(encoding, bound, unit)]
    total = formula.at_least([sum_of_near(formula, costs, rounds, LEVELS + 1), *others], LEVELS + 1)
    if len(total) > LEVELS:
        formula.add(-total[LEVELS])
    return priced


def _forbid_meetings(encoding: Encoding, look: Callable[[], None]) -> None:
    """Keep all capacities, as `Encoding.forbid` does, but look only at robots that have a node at the tick."""
    instance = encoding.instance
    near: dict[tuple[ResourceId, int], set[int]] = defaultdict(set)
    there: dict[ResourceId, set[int]] = defaultdict(set)
    for position, robot in enumerate(encoding.robots):
        there[robot.robot.goal].add(position)
        for place, leave in robot.node:
            for tick in range(leave - robot.routes.duration[place], leave + instance.gap):
                near[robot.routes.resource(place), tick].add(position)
    for conflict in encoding.entries():
        look()
        resource = instance.graph.resources[conflict.constraint]
        positions = sorted(near[resource.id, conflict.tick] | there[resource.id])
        present = [encoding.presence(each, conflict.constraint, conflict.tick, instance.gap) for each in positions]
        encoding.formula.at_most([literal for literal in present if literal is not None], resource.capacity)


def _forbid_exchanges(encoding: Encoding) -> None:
    """Give each edge a direction at each tick, and let robots move in no other.

    The encoding forbids each pair of moves, which took nearly half of the clauses for 100 robots on 20 x 20.
    """
    index = encoding.instance.graph.index
    directions: dict[tuple[int, ResourceId, ResourceId], Literal] = {}
    for position, robot in enumerate(encoding.robots):
        for source, tick in robot.node:
            for target in encoding.instance.graph.successors[source]:
                move = encoding.moves(position, source, target, tick)
                if move is not None:
                    forth = index[source] < index[target]
                    edge = (tick, source, target) if forth else (tick, target, source)
                    if edge not in directions:
                        directions[edge] = encoding.formula.variable()
                    direction = directions[edge] if forth else -directions[edge]
                    encoding.formula.add(*(-literal for literal in move), direction)


def _level(parts: int, unit: int) -> int:
    return min(parts * LEVELS // unit, LEVELS + 1)


def _number(formula: Formula, most: int) -> list[Literal]:
    """A new unary number."""
    number = [formula.variable() for _ in range(most)]
    for smaller, larger in pairwise(number):
        formula.add(-larger, smaller)
    return number


def _reduced_cost(
    formula: Formula, robot: RobotClauses, nodes: Mapping[Node, int], reduced: ReducedCosts, unit: int
) -> list[Literal]:
    """A number that is at least the level of each node that the robot passes, and of its delay."""
    delays = {delay: _level(cost, unit) for delay, cost in reduced.delays.items()}
    number = _number(formula, max([*nodes.values(), *delays.values()], default=0))
    for node, level in nodes.items():
        if level > 0:
            formula.add(-robot.node[node], number[level - 1])
    for delay in range(robot.horizon + 1):
        exactly = [*([-robot.late[delay - 1]] if delay > 0 else []), robot.late[delay]]
        if delay not in delays:
            formula.add(*exactly)
        elif delays[delay] > 0:
            formula.add(*exactly, number[delays[delay] - 1])
    return number


def _prices_of_empty_places(encoding: Encoding, bound: PricedBound, unit: int) -> list[list[Literal]]:
    """For each price of a resource at a tick, a number that is at least its level if nobody is there."""
    numbers = []
    for resource, tick, price in bound.certificate.resources:
        level = _level(price, unit)
        if level > 0:
            number = _number(encoding.formula, level)
            place = encoding.instance.graph.index[resource]
            present = [encoding.presence(position, place, tick) for position in range(len(encoding.robots))]
            encoding.formula.add(*(literal for literal in present if literal is not None), number[-1])
            numbers.append(number)
    return numbers


def _prices_of_late_robots(encoding: Encoding, bound: PricedBound, unit: int) -> list[list[Literal]]:
    """For each group with deadlines, which one robot must miss, a number: the level of the price for each other."""
    formula = encoding.formula
    clauses = {robot.robot.id: robot for robot in encoding.robots}
    numbers = []
    for deadlines in bound.certificate.deadlines:
        if deadlines.seen:
            continue  # no literal says whether a robot keeps its own
        entries = [(clauses[name], tick) for name, tick in zip(deadlines.robots, deadlines.ticks, strict=True)]
        if any(tick < robot.earliest for robot, tick in entries):
            continue  # a robot that is late anyhow has no literal for it
        late = [robot.later_than(tick - robot.earliest) for robot, tick in entries]
        formula.add(*late)
        number = _number(formula, _level(deadlines.price * (len(late) - 1), unit))
        for others, literal in enumerate(formula.at_least([[each] for each in late], len(late))):
            level = _level(deadlines.price * others, unit)
            if level > 0:
                formula.add(-literal, number[level - 1])
        numbers.append(number)
    return numbers
