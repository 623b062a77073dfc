"""Executions of solutions: delays, drivers of robots, and results."""

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from typing import Literal, TypeAlias, get_args

import msgspec

from carp_reference.execution import Order, order_of
from carp_spec import Instance, Refusal, ResourceId, RobotId, Solution, Violation, violations_of
from carp_spec.documents.fields import all_converted
from carp_spec.execution.dependencies import Node, shortest_cycle
from carp_spec.execution.traces import Trace
from carp_spec.permutations import splitmix64
from carp_spec.refusal import RefusalKind
from carp_spec.rule import DESIGN, rule
from carproof.execution.delays import Delay, executed, in_order, on_the_clock, planned, slack, smallest_collision, stuck
from carproof.execution.switching import switching
from carproof.requests import whole_number

Driver: TypeAlias = Literal["clock", "order", "switching"]
DRIVERS: tuple[Driver, ...] = get_args(Driver)
MILLION = 1_000_000
DIGITS = 6  # of a chance, behind the point
TOGETHER = ("joint/capacity", "joint/group", "joint/exchange")


@rule(
    "request/delays",
    "A delay concerns a visit of a planned robot, for a whole number of ticks above 0, and no visit is named twice.",
    DESIGN,
)
def delays_are_right(solution: Solution, delays: Sequence[Delay]) -> bool:  # noqa: D103
    lengths = {plan.robot: len(plan.visits) for plan in solution.plans}
    known = all(0 <= delay.visit < lengths.get(delay.robot, 0) and delay.ticks > 0 for delay in delays)
    return known and len({(delay.robot, delay.visit) for delay in delays}) == len(delays)


def read_delays(data: bytes, solution: Solution) -> tuple[Delay, ...]:
    """Read a list of delays; raises `Refusal` for a delay at no visit of the solution."""
    try:
        entries = msgspec.json.decode(data, type=tuple[tuple[RobotId, int, int], ...])
    except msgspec.DecodeError as error:
        message = f"delays must be a list of [robot, visit, ticks]: {error}"
        raise Refusal("document", "$", delays_are_right.id, message) from error
    return require_delays(solution, [Delay(*each) for each in entries], "document", "$")


def require_delays(
    solution: Solution, delays: Sequence[Delay], kind: RefusalKind, path: str = "$.delays"
) -> tuple[Delay, ...]:
    """The delays; raises `Refusal` for the first that is not right."""
    if not delays_are_right(solution, delays):
        firsts = range(len(delays))
        place = bisect_left(firsts, True, key=lambda last: not delays_are_right(solution, delays[: last + 1]))
        wrong = [*astuple(delays[place])]
        message = f"the delay must be of another visit that is planned, for at least a tick, not {wrong}"
        raise Refusal(kind, f"{path}[{place}]", delays_are_right.id, message)
    return tuple(delays)


def random_delays(solution: Solution, share: int, most: int, seed: int) -> tuple[Delay, ...]:
    """Each visit but a robot's last is delayed with a chance of `share` in a million, by 1 to `most` ticks."""
    stream = splitmix64(seed)
    places = ((plan.robot, place) for plan in solution.plans for place in range(len(plan.visits) - 1))
    return tuple(Delay(*node, 1 + next(stream) % most) for node in places if next(stream) % MILLION < share)


def drawn_delays(text: str, solution: Solution, seed: int) -> tuple[Delay, ...]:
    """The delays that a model like `0.05:3` draws; raises `Refusal`."""
    chance, _, most = text.partition(":")
    whole, _, part = chance.partition(".")
    share = whole_number(f"{whole or '0'}{part:0<{DIGITS}}")
    if not whole + part or share is None or share > MILLION or len(part) > DIGITS:
        message = f"{text!r} must be a file of delays, or a chance from 0 to 1 with the most ticks, like 0.05:3"
        raise Refusal("option", "$.delays", delays_are_right.id, message)
    ticks = whole_number(most or "1")
    if ticks is None or not 0 < ticks < MILLION:
        message = f"the most ticks must be a whole number from 1 to {MILLION - 1}, not {most}"
        raise Refusal("option", "$.delays", delays_are_right.id, message)
    return random_delays(solution, share, ticks, seed)


def delay_named(text: str, instance: Instance, solution: Solution) -> Delay:
    """The delay that ROBOT:VISIT:TICKS names; raises `Refusal`."""
    name, *numbers = ["", "", *text.rsplit(":", 2)][-3:]
    called = [robot.id for robot in instance.robots if str(robot.id) == name]
    visit, ticks = map(whole_number, numbers)
    if len(called) == 1 and visit is not None and ticks is not None:
        delay = Delay(called[0], visit, ticks)
        if delays_are_right(solution, [delay]):
            return delay
    message = f"{text!r} must be ROBOT:VISIT:TICKS, with a planned robot, the position of a visit and ticks above 0"
    raise Refusal("option", "$.delay", delays_are_right.id, message)


@dataclass(frozen=True, slots=True)
class Execution:
    """The result of a driver with a solution.

    `followed` is the solution whose order it kept, switches included; after switches a plan may begin later than its
    release, which `plan/start` does not allow. `collisions` break `joint/capacity`, `joint/group` or `joint/exchange`;
    robots that follow each other where that is forbidden do not collide. `late` has, for each robot that arrived, the
    ticks by which it was later than planned, below 0 if it was earlier.
    """

    driver: Driver
    delays: tuple[Delay, ...]
    followed: Solution
    trace: Trace
    collisions: tuple[Violation, ...]
    standing: tuple[RobotId, ...]
    late: Mapping[RobotId, int]
    switches: int

    @property
    def is_safe(self) -> bool:
        """Whether no robot collided or stood for ever."""
        return not self.collisions and not self.standing


def execute(instance: Instance, solution: Solution, driver: Driver, delays: tuple[Delay, ...]) -> Execution:
    """Execute a lawful solution; if its dependencies have a cycle, nothing is switched."""
    order = order_of(instance, solution)
    followed, switches = solution, 0
    enters: Mapping[Node, int]
    if driver == "clock":
        enters = on_the_clock(order, delays)
    elif driver == "order" or stuck(order):
        enters = in_order(order, delays)
    else:
        switched = switching(instance, solution, delays)
        followed, switches = switched.solution, switched.switches
        enters = switched.enters
        order = order_of(instance, followed)
    trace = executed(order, enters, delays)
    arrivals = {plan.robot: plan.visits[-1].enter for plan in solution.plans}
    lasts_of = {plan.robot: (plan.robot, len(plan.visits) - 1) for plan in solution.plans}
    return Execution(
        driver=driver,
        delays=delays,
        followed=followed,
        trace=trace,
        collisions=tuple(each for each in violations_of(instance, trace.plans) if each.rule in TOGETHER),
        standing=tuple(robot for robot, node in lasts_of.items() if node not in enters),
        late={robot: enters[node] - arrivals[robot] for robot, node in lasts_of.items() if node in enters},
        switches=switches,
    )


class DependencyDocument(msgspec.Struct, frozen=True):
    """An edge of the dependency graph: after is entered at least this many ticks after before; visits are positions."""

    kind: str
    before: tuple[RobotId, int]
    after: tuple[RobotId, int]
    ticks: int
    resource: ResourceId


class VisitDocument(msgspec.Struct, frozen=True):
    """A visit with its slack: the longest delay there by which nobody arrives later than planned, null: any."""

    robot: RobotId
    visit: int
    resource: ResourceId
    enter: int
    leave: int | None
    slack: int | None


class CycleDocument(msgspec.Struct, frozen=True):
    """A rotation: each robot enters its resource at one tick, as the next robot leaves it."""

    tick: int
    robots: tuple[RobotId, ...]
    resources: tuple[ResourceId, ...]


class DependenciesDocument(msgspec.Struct, frozen=True):
    """The dependency graph of a solution, its shortest cycle (null: none), and the effect of delays.

    `late` has the robots that the delay in the request makes late, each with the ticks; it is null without such a
    delay. `collision` is the least set of delays that makes robots on the clock collide; it is null if none does.
    """

    acyclic: bool
    cycle: CycleDocument | None
    visits: tuple[VisitDocument, ...]
    edges: tuple[DependencyDocument, ...]
    late: tuple[tuple[RobotId, int], ...] | None
    collision: tuple[tuple[RobotId, int, int], ...] | None


def dependencies_document(order: Order, late: Mapping[RobotId, int] | None) -> DependenciesDocument:
    """The document of a dependency graph."""
    spare = slack(order)
    edges = shortest_cycle(order.edges)
    visits = (
        VisitDocument(*node, visit.resource, visit.enter, visit.leave, spare[node])
        for node in planned(order)
        for visit in [order.visit(node)]
    )
    cycle = (
        CycleDocument(
            order.visit(edges[0].after).enter,
            tuple(edge.after[0] for edge in edges),
            tuple(edge.resource for edge in edges),
        )
        if edges
        else None
    )
    smallest = smallest_collision(order.instance, order.solution)
    return DependenciesDocument(
        acyclic=not edges,
        cycle=cycle,
        visits=tuple(visits),
        edges=all_converted(order.edges, DependencyDocument),
        late=None if late is None else tuple(late.items()),
        collision=None if smallest is None else tuple((each.robot, each.visit, each.ticks) for each in smallest),
    )


def dot(order: Order) -> str:
    """The dependency graph in the language of Graphviz; edges of a cycle are red."""
    cycle = set(shortest_cycle(order.edges))
    lines = ["digraph dependencies {", "  rankdir=LR;", "  node [shape=box];"]
    number = {node: place for place, node in enumerate(order.nodes)}
    for node, place in number.items():
        visit = order.visit(node)
        label = msgspec.json.encode(f"{node[0]}: {visit.resource} at {visit.enter}").decode()
        lines.append(f"  v{place} [label={label}];")
    for edge in order.edges:
        style = "" if edge.kind == "travel" else ", style=dashed"
        colour = ", color=red" if edge in cycle else ""
        lines.append(f'  v{number[edge.before]} -> v{number[edge.after]} [label="{edge.ticks}"{style}{colour}];')
    return "\n".join([*lines, "}", ""])


def execution_document(execution: Execution) -> dict[str, object]:
    """The document of an execution, but for its trace; `late` are pairs of a robot and ticks."""
    return {
        "driver": execution.driver,
        "delays": [astuple(delay) for delay in execution.delays],
        "late": [*execution.late.items()],
        "collisions": [str(each) for each in execution.collisions],
        "standing": execution.standing,
        "switches": execution.switches,
    }
