"""A campaign of delayed executions in order: without a rotation none breaks a rule or stops, with one each stops.

In each solution a robot waits for another, and in each execution at least one visit is delayed. The executions of a
solution without a rotation are made all at once. Some are made and judged by the law beside them, in order and on the
clock, and must be the same.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec
import numpy as np

from carp_experiments.beyond.many_executions import LONGEST, Longs, breaches, delays_of, entered_in_order, random_delays
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row
from carp_reference import plan
from carp_reference.execution import Order, order_of
from carp_spec import Carp, Plan, RobotId, Visit
from carp_spec.execution.dependencies import Dependency, shortest_cycle
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.joint_rules import JOINT_RULES
from carp_spec.permutations import splitmix64
from carproof.execution.delays import Delay, executed, in_order, on_the_clock
from carproof.testing.random_instances import Draw, draw_fleet, draw_instance

BLOCK = 10_000
FULL_EXECUTIONS = 1_020_000
QUICK_EXECUTIONS = 50_000
OF_A_SOLUTION = 100
JUDGED = 2
"""The executions in order of each solution that the law judges too; on the clock it judges one."""
SHOWN = 3


class Block(msgspec.Struct):
    """A row of the campaign: executions, those of solutions with a rotation, and delays; `broken` ended wrongly.

    Of the solutions, `collided` collide on the clock.
    """

    executions: int
    cyclic: int = 0
    delays: int = 0
    solutions: int = 0
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
            count = min(OF_A_SOLUTION, self.first + self.executions - first)
            always = (cycle[0].after[0], cycle[0].after[1] - 1) if cycle else None
            delays = random_delays(order, next(draw.stream), count, always)
            singly = [delays_of(order, column) for column in delays.T[: count if cycle else JUDGED]]
            found = wrong_stops(order, singly, cycle) if cycle else wrong_arrivals(order, delays, singly)
            block.solutions += 1
            block.cyclic += count if cycle else 0
            block.delays += int(np.count_nonzero(delays))
            block.collided += bool(crashes(order, executed(order, on_the_clock(order, singly[0]), singly[0])))
            block.broken += [{"number": first + place, "wrong": wrong} for place, wrong in found]
        return msgspec.to_builtins(block)  # type: ignore[no-any-return] # a struct becomes a dict


def drawn_order(draw: Draw) -> Order:
    """A solution of few robots, by CARP or by no planner, in which a robot waits for another."""
    while True:
        instance = draw_instance(draw)
        if draw.happens(3):
            instance = replace(instance, following="forbidden")
        solution = draw_fleet(draw, instance).solution if draw.happens(2) else plan(instance, Carp())
        order = order_of(instance, solution)
        waits = any(edge.before[0] != edge.after[0] for edge in order.edges)
        if waits and any(len(each.visits) > 1 for each in solution.plans):
            return order


def wrong_arrivals(order: Order, delays: Longs, singly: Sequence[Sequence[Delay]]) -> Iterator[tuple[int, str]]:
    """The executions in order that break a rule or are too late, and those that the law judges otherwise."""
    enters = entered_in_order(order, delays)
    planned = np.array([[order.visit(node).enter] for node in order.nodes])
    strays, collisions = breaches(order, enters)
    late = (enters > planned + delays.sum(axis=0)).any(axis=0)
    for what, flags in (("does not follow the plans", strays), ("collides", collisions), ("is too late", late)):
        yield from ((place, what) for place in np.flatnonzero(flags).tolist())
    for place, each in enumerate(singly):
        if in_order(order, each) != dict(zip(order.nodes, enters[:, place].tolist(), strict=True)):
            yield place, "has other ticks"
        for name, ticks in (("in order", enters[:, place : place + 1]), ("on the clock", on_clock(order, each))):
            trace = executed(order, dict(zip(order.nodes, ticks[:, 0].tolist(), strict=True)), each)
            law = not follows(order, trace), bool(crashes(order, trace))
            if law != tuple(bool(flags[0]) for flags in breaches(order, ticks)):
                yield place, f"is judged otherwise {name}"


def on_clock(order: Order, delays: Sequence[Delay]) -> Longs:
    """The entries of an execution on the clock, as a column."""
    enters = on_the_clock(order, delays)
    return np.array([[enters[node]] for node in order.nodes])


def follows(order: Order, trace: Trace) -> bool:
    """Whether a trace follows the solution by the rules of the law."""
    return not trace_violations(order.instance, order.solution, trace)


def crashes(order: Order, trace: Trace) -> bool:
    """Whether robots collide by the rules of the law."""
    return any(True for rule in JOINT_RULES for _ in rule(order.instance, trace.plans))


def wrong_stops(
    order: Order, singly: Sequence[Sequence[Delay]], cycle: Sequence[Dependency]
) -> Iterator[tuple[int, str]]:
    """The executions in order in which robots of the rotation go on, or could by the law, or that break a rule."""
    for place, delays in enumerate(singly):
        enters = in_order(order, delays)
        trace = executed(order, enters, delays)
        if not follows(order, trace) or crashes(order, trace):
            yield place, "breaks a rule"
        if any(edge.after in enters for edge in cycle):
            yield place, "turns"
        for robot in able_to_go_on(order, trace):
            yield place, f"stops robot {robot} without a reason"


def able_to_go_on(order: Order, trace: Trace) -> Iterator[RobotId]:
    """The standing robots that could go on alone."""
    later = trace.now + LONGEST + max(order.duration(node) for node in order.nodes)
    for place, done in enumerate(trace.plans):
        visits = order.plans[done.robot].visits
        if len(done.visits) < len(visits):
            left = [*done.visits[:-1], *(Visit(each.resource, each.enter, later) for each in done.visits[-1:])]
            entered = Plan(done.robot, (*left, Visit(visits[len(left)].resource, later, None)))
            if follows(order, Trace(later, (*trace.plans[:place], entered, *trace.plans[place + 1 :]))):
                yield done.robot


def executions_cases(executions: int, seed: int) -> tuple[ExecutionsCase, ...]:
    """That many executions, in blocks."""
    return tuple(ExecutionsCase(first, min(BLOCK, executions - first), seed) for first in range(0, executions, BLOCK))


def executions_report(rows: Iterable[Row]) -> ExperimentReport:
    """The number of executions of each kind, and those that did not end as they must."""
    blocks = [msgspec.convert(row, Block) for row in rows]
    broken = [each for block in blocks for each in block.broken]
    columns = ("executions", "with a rotation", "delays", "end wrongly", "solutions", "collide on the clock")
    counts = {name: sum(getattr(block, name) for block in blocks) for name in Block.__struct_fields__[:-1]}
    executions, cyclic, delays, solutions, collided = map(str, counts.values())
    shown = tuple(f"A WRONG END: {msgspec.json.encode(each).decode()}" for each in broken[:SHOWN])
    title = "Delayed executions in order: without a rotation all robots arrive, with one its robots stop"
    row = (executions, cyclic, delays, str(len(broken)), solutions, collided)
    table = Table("executions", title, columns, (row,), columns)
    return ExperimentReport({**counts, "broken": broken}, (table,), shown, holds=not broken)
