"""The one encoding of an instance into clauses, and of a bound on the total cost.

Each robot has the clauses of `carp_verify.optimum.robot_clauses` up to its own horizon, which are a relaxation. The
rules `joint/capacity`, `joint/group` and `joint/exchange` are added for chosen places and ticks, or for all. So with
any horizons:

- if the clauses with `delays < k` have no model, no plan set costs less than the sum of shortest paths + k;
- a model of the clauses in which no robot is later than its horizon and in which all conflicts are forbidden
  holds a plan set of at most that cost (and the checker of carp_spec is asked anyway).
"""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, zip_longest

from carp_spec import Instance, Move, Plan, ResourceId, Robot
from carp_spec.joint_rules import opposite_moves
from carp_spec.windows import stays_within
from carp_verify.optimum.clauses import Clause, Formula, Literal
from carp_verify.optimum.robot_clauses import RobotClauses, predecessors
from carp_verify.optimum.rules import LARGEST_FORMULA, LARGEST_PROOF, refuse_size


@dataclass(frozen=True, slots=True)
class Conflict:
    """A constraint of the graph at a tick, by its index."""

    tick: int
    constraint: int


@dataclass(frozen=True, slots=True)
class Exchange:
    """Two moves at a tick that robots must not both make."""

    tick: int
    one: Move
    other: Move


@dataclass(frozen=True, slots=True)
class Evidence:
    """The horizons and the order of adding delays with which the encoding proves the bound."""

    horizons: tuple[int, ...]
    order: tuple[int, ...]


class Encoding:
    """The clauses of all robots of an instance, without a horizon at first; every robot must have a way.

    `check` is called before each robot, whose distances on a large map take a while; it may raise `TimeOver`. A formula
    of more than `most` clauses is refused. `seen` has the tick at which each robot is seen, if they are.
    """

    def __init__(
        self,
        instance: Instance,
        check: Callable[[], None] = lambda: None,
        most: int = LARGEST_FORMULA,
        seen: Sequence[int] = (),
    ) -> None:
        self.instance = instance
        self.constraints = instance.graph.constraints
        self.formula = Formula(most)
        before = predecessors(instance)
        self.robots: list[RobotClauses] = []
        for robot, tick in zip_longest(instance.robots, seen):
            check()
            self.robots.append(RobotClauses(instance, robot, before, self.formula, tick))
        self._defined: dict[tuple[int | str, ...], tuple[Literal, set[Clause]]] = {}

    @property
    def wayless(self) -> list[Robot]:
        """The robots from whose start no way leads to their goal."""
        return [robot.robot for robot in self.robots if robot.shortest is None]

    @property
    def shortest(self) -> int:
        """The sum of the robots' costs on the empty graph."""
        return sum(robot.shortest or 0 for robot in self.robots)

    def presence(self, position: int, constraint: int, tick: int, gap: int = 0) -> Literal | None:
        """A literal that holds if the constraint counts the robot at the tick; `None` if it cannot be there.

        A robot counts for `gap` ticks more after it has left.
        """
        robot, resources = self.robots[position], self.constraints[constraint].resources
        at = [(resource, tick - back) for resource in resources for back in range(gap + 1)]
        stays = list(dict.fromkeys(stay for each in at for stay in robot.stays(*each)))
        return self._any_of(stays, (position, constraint, tick, gap))

    def _any_of(self, alternatives: Sequence[Clause], key: tuple[int | str, ...]) -> Literal | None:
        """A literal that holds if all literals of an alternative do; `None` without any. Those of a key only grow."""
        if not alternatives:
            return None
        if len(alternatives) == 1 and len(alternatives[0]) == 1:
            return alternatives[0][0]
        if key not in self._defined:
            self._defined[key] = (self.formula.variable(), set())
        literal, known = self._defined[key]
        for each in alternatives:
            if each not in known:
                known.add(each)
                self.formula.add(*(-one for one in each), literal)
        return literal

    def moves(self, position: int, source: ResourceId, target: ResourceId, tick: int) -> Clause | None:
        """Literals that hold together if the robot makes the move at the tick; `None` if it cannot."""
        nodes = self.robots[position].leaving(source, tick)
        leaves = self._any_of([(node,) for node in nodes], (position, source, tick))
        enters = None if leaves is None else self.presence(position, self.instance.graph.index[target], tick)
        return None if leaves is None or enters is None else (leaves, enters)

    def forbid(self, conflict: Conflict | Exchange) -> None:
        """Add the clauses that forbid a conflict to all robots, as far as their horizons reach."""
        if isinstance(conflict, Conflict):
            constraint = self.constraints[conflict.constraint]
            visitors = sorted({each for resource in constraint.resources for each in self._visitors(resource)})
            gap = self.instance.gap
            present = [self.presence(each, conflict.constraint, conflict.tick, gap) for each in visitors]
            literals = [literal for literal in present if literal is not None]
            self.formula.at_most(literals, constraint.capacity)
            return
        there, back = (
            [(each, self.moves(each, *move, conflict.tick)) for each in self._visitors(move[0])]
            for move in (conflict.one, conflict.other)
        )
        for one, first in there:
            for other, second in back:
                if one != other and first is not None and second is not None:
                    self.formula.add(*(-literal for literal in (*first, *second)))

    def _visitors(self, resource: ResourceId) -> list[int]:
        return [position for position, robot in enumerate(self.robots) if robot.may_visit(resource)]

    def entries(self) -> Iterator[Conflict]:
        """All constraints wherever a robot may enter what they are on."""
        entries = dict.fromkeys(entry for robot in self.robots for entry in robot.entries())
        graph = self.instance.graph
        found = (Conflict(tick, each) for resource, tick in entries for each in graph.constraints_of(resource))
        yield from dict.fromkeys(found) if graph.groups else found

    def conflicts(self) -> Iterator[Conflict | Exchange]:
        """All conflicts that can happen within the horizons: of constraints, and exchanges.

        Raises `Refusal` for more exchanges than the formula may have clauses, as each has one at least.
        """
        yield from self.entries()
        movers: dict[tuple[int, Move], set[int]] = defaultdict(set)
        for position, robot in enumerate(self.robots):
            for source, tick in robot.leaves():
                for target in self.instance.graph.successors[source]:
                    if any(self.robots[position].stays(target, tick)):
                        movers[tick, (source, target)].add(position)
        exchanges = 0
        for exchange in _exchanges(self.instance, movers):
            there, back = (movers[exchange.tick, move] for move in (exchange.one, exchange.other))
            if len(there | back) > 1:
                exchanges += 1
                self.formula.require(exchanges)
                yield exchange

    def forbid_all(self) -> None:
        """Forbid all conflicts."""
        for conflict in list(self.conflicts()):
            self.forbid(conflict)

    def grow_to(self, horizons: Sequence[int]) -> None:
        """Give each robot its horizon; raises `Refusal` at once if the nodes alone need too many clauses."""
        nodes = sum(robot.nodes_within(horizon) for robot, horizon in zip(self.robots, horizons, strict=True))
        self.formula.require(nodes + sum(horizons))
        for robot, horizon in zip(self.robots, horizons, strict=True):
            while robot.horizon < horizon:
                robot.grow()

    def bound_delays(self, bound: int, order: Sequence[int]) -> None:
        """Demand that the delays of all robots add up to less than the bound; any order of adding them will do."""
        if bound <= 0:
            self.formula.add()  # the empty clause: no delay is below zero
            return
        delays = self.formula.at_least([self.robots[position].late for position in order], bound)
        if len(delays) >= bound:
            self.formula.add(-delays[bound - 1])

    def close(self) -> None:
        """Demand that no robot is later than its horizon."""
        for robot in self.robots:
            self.formula.add(-robot.late[robot.horizon])

    def plans(self, model: Sequence[bool]) -> list[Plan]:
        """The plans in a model, which is the truth of each variable, of all robots no later than their horizons."""
        return [plan for robot in self.robots if (plan := robot.plan(model)) is not None]


def reach_formula(instance: Instance, cost: int, evidence: Evidence, most: int = LARGEST_PROOF) -> Encoding:
    """The encoding of plans whose total is at most `cost`, each within its robot's horizon.

    Raises `Refusal` beyond `most` clauses.
    """
    encoding = beat_formula(instance, cost + 1, evidence, most)
    encoding.close()
    return encoding


def beat_formula(instance: Instance, cost: int | None, evidence: Evidence, most: int = LARGEST_PROOF) -> Encoding:
    """The relaxed encoding of plans whose total is less than `cost`, or of any plans where it is `None`.

    Raises `Refusal` beyond `most` clauses.
    """
    encoding = Encoding(instance, most=most)
    encoding.grow_to(evidence.horizons)
    encoding.forbid_all()
    if cost is not None:
        encoding.bound_delays(cost - encoding.shortest, evidence.order)
    return encoding


def _exchanges(instance: Instance, movers: Collection[tuple[int, Move]]) -> Iterator[Exchange]:
    """The pairs of these moves at one tick that two robots must not both make; raises `Refusal` for too many."""
    index = instance.graph.index
    opposite = opposite_moves(instance.graph, movers)
    pairs = 0
    for tick, move in movers:
        others = opposite((tick, move))
        pairs += len(others)
        refuse_size("the pairs of moves that exchange close resources", pairs, LARGEST_FORMULA)
        for _, other in others:
            if (index[move[0]], index[move[1]]) < (index[other[0]], index[other[1]]):
                yield Exchange(tick, move, other)


def violated(instance: Instance, plans: Sequence[Plan]) -> list[Conflict | Exchange]:
    """The conflicts among the plans, by tick: at each entry that exceeds a capacity, and at each exchange."""
    stays: dict[int, list[tuple[int, int | None]]] = defaultdict(list)
    movers: dict[tuple[int, Move], None] = {}
    for plan in plans:
        for visit in plan.visits:
            stays[instance.graph.index[visit.resource]].append((visit.enter, visit.leave))
        for visit, following in pairwise(plan.visits):
            movers[following.enter, (visit.resource, following.resource)] = None
    for number, group in enumerate(instance.graph.groups, len(instance.graph.resources)):
        stays[number] = stays_within(plans, group.resources)
    found: list[Conflict | Exchange] = []
    gap = instance.gap
    for constraint, intervals in stays.items():
        capacity = instance.graph.constraint(constraint).capacity
        if len(intervals) > capacity:
            for tick in dict.fromkeys(enter for enter, _ in intervals):
                present = sum(enter <= tick and (leave is None or tick < leave + gap) for enter, leave in intervals)
                if present > capacity:
                    found.append(Conflict(tick, constraint))
    return [*found, *_exchanges(instance, movers)]
