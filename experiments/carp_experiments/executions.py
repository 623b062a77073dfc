"""A campaign of delayed executions in order: without a rotation none breaks a rule or stops, with one each stops.

In each solution a robot waits for another, and in each execution at least one visit is delayed. The rules of the law
judge the traces. Executions on the clock, with the same delays, show how many of them would collide.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row
from carp_reference import plan
from carp_reference.execution import Delay, Order, executed, in_order, on_the_clock, order_of
from carp_spec import Carp, Plan, Visit
from carp_spec.dependencies import Dependency, Node, shortest_cycle
from carp_spec.execution_rules import trace_violations
from carp_spec.joint_rules import JOINT_RULES
from carp_spec.permutations import splitmix64
from carp_spec.traces import Trace
from carproof.questions import Draw, draw_fleet, draw_instance

BLOCK = 1000
FULL_EXECUTIONS = 1_000_000
QUICK_EXECUTIONS = 10_000
OF_A_SOLUTION = 20
LONGEST = 6
SHOWN = 3
KEPT_BY_WAITING = {"execution/order", "execution/exchange"}


class Block(msgspec.Struct):
    """A row of the campaign. The solutions of `cyclic` executions have a rotation.

    `collided` is how many collide on the clock.
    """

    executions: int
    cyclic: int = 0
    delays: int = 0
    collided: int = 0
    broken: list[dict[str, Any]] = msgspec.field(default_factory=list)


@dataclass(frozen=True, slots=True)
class ExecutionsCase:
    """The executions of a seed numbered from `first` on."""

    first: int
    executions: int = BLOCK
    seed: int = 0

    @property
    def key(self) -> str:
        """Blocks in their order."""
        return f"seed {self.seed} executions {self.first:09} to {self.first + self.executions - 1:09}"

    def run(self) -> Row:
        """How many executions were of each kind, and those that did not end as they must."""
        block = Block(self.executions)
        for first in range(self.first, self.first + self.executions, OF_A_SOLUTION):
            draw = Draw(splitmix64(next(splitmix64(self.seed)) + first))
            order = drawn_order(draw)
            cycle = shortest_cycle(order.edges)
            for number in range(first, min(first + OF_A_SOLUTION, self.first + self.executions)):
                delays = drawn_delays(draw, order, cycle)
                clock = executed(order, on_the_clock(order, delays), delays)
                block.cyclic += bool(cycle)
                block.delays += len(delays)
                block.collided += bool(crashes(order, clock))
                wrong = wrong_end(order, delays, cycle)
                if wrong:
                    block.broken.append({"number": number, "wrong": wrong, "solution": str(order.solution)})
        return msgspec.to_builtins(block)  # type: ignore[no-any-return] # a struct becomes a dict


def drawn_order(draw: Draw) -> Order:
    """A solution of few robots, by CARP or by no planner, in which a robot waits for another."""
    while True:
        instance = draw_instance(draw)
        if draw.happens(3):
            instance = replace(instance, following="forbidden")
        solution = draw_fleet(draw, instance).solution if draw.happens(2) else plan(instance, Carp())
        order = order_of(instance, solution)
        if delayed_visits(order) and any(edge.before[0] != edge.after[0] for edge in order.edges):
            return order


def delayed_visits(order: Order) -> Sequence[Node]:
    """The visits that can be delayed: all but the last of each robot."""
    return [node for node in order.nodes if not order.is_last(node)]


def drawn_delays(draw: Draw, order: Order, cycle: Sequence[Dependency]) -> Sequence[Delay]:
    """Delays of some visits, among them the visit from which a robot enters the rotation."""
    visits = delayed_visits(order)
    robot, place = cycle[0].after if cycle else (None, 0)
    chosen = {draw.one_of(visits) if robot is None else (robot, place - 1)}
    return [Delay(*node, draw.between(1, LONGEST)) for node in visits if node in chosen or draw.happens(4)]


def crashes(order: Order, trace: Trace) -> list[str]:
    """The rules of robots together that a trace breaks."""
    return [found.rule for rule in JOINT_RULES for found in rule(order.instance, trace.plans)]


def wrong_end(order: Order, delays: Sequence[Delay], cycle: Sequence[Dependency]) -> list[str]:
    """What is wrong with an execution in order: rules broken, robots too late, or other robots standing than must."""
    enters = in_order(order, delays)
    trace = executed(order, enters, delays)
    broken = [found.rule for found in trace_violations(order.instance, order.solution, trace)] + crashes(order, trace)
    total = sum(delay.ticks for delay in delays)
    late = [f"{node} is late" for node, tick in enters.items() if tick > order.visit(node).enter + total]
    never = {node for node in order.nodes if node not in enters}
    missing = [f"{edge.after} does not stand" for edge in cycle if edge.after not in never]
    if not cycle:
        missing += [f"{node} stands" for node in never]
    return broken + late + missing + [f"{robot} could go on" for robot in able_to_go_on(order, trace)]


def able_to_go_on(order: Order, trace: Trace) -> Iterator[str]:
    """The standing robots that could go on alone, by the rules."""
    later = trace.now + LONGEST + max(order.duration(node) for node in order.nodes)
    for place, done in enumerate(trace.plans):
        visits = order.plans[done.robot].visits
        if len(done.visits) < len(visits):
            left = [*done.visits[:-1], *(Visit(each.resource, each.enter, later) for each in done.visits[-1:])]
            entered = Plan(done.robot, (*left, Visit(visits[len(left)].resource, later, None)))
            plans = (*trace.plans[:place], entered, *trace.plans[place + 1 :])
            broken = trace_violations(order.instance, order.solution, Trace(later, plans))
            if not KEPT_BY_WAITING & {found.rule for found in broken}:
                yield str(done.robot)


def executions_cases(executions: int, seed: int) -> tuple[ExecutionsCase, ...]:
    """That many executions, in blocks."""
    return tuple(ExecutionsCase(first, min(BLOCK, executions - first), seed) for first in range(0, executions, BLOCK))


def executions_report(rows: Iterable[Row]) -> ExperimentReport:
    """The number of executions of each kind, and those that did not end as they must."""
    blocks = [msgspec.convert(row, Block) for row in rows]
    broken = [each for block in blocks for each in block.broken]
    columns = ("executions", "with a rotation", "delays", "collide on the clock", "end wrongly")
    sums = [sum(getattr(block, name) for block in blocks) for name in ("executions", "cyclic", "delays", "collided")]
    shown = tuple(f"A WRONG END: {msgspec.json.encode(each).decode()}" for each in broken[:SHOWN])
    title = "Delayed executions in order: without a rotation all robots arrive, with one its robots stop"
    table = Table("executions", title, columns, ((*map(str, sums), str(len(broken))),), columns)
    return ExperimentReport({"broken": broken}, (table,), (), shown, holds=not broken)
