"""The certificate of a solution: `carp_spec` finds no rule broken, and z3 confirms the rules of robots together.

For each resource, z3 searches for a tick, any whole number, at which more robots occupy it than its capacity. For each
pair of resources between which robots move both ways, it searches for a tick at which two robots make opposite moves.
Each robot's stays are one tracked term, so that an answer names the robots. The question is the negation of the rule:
if z3 finds no answer, no such tick exists. This part shares no code with `carp_spec.check`, which sweeps over events
instead. The rules of single plans and of the list of plans get no second opinion here.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

from carp_spec import Instance, Plan, Resource, ResourceId, RobotId, Solution, Violation, Visit, judge
from carp_spec.limits import refuse
from carp_spec.rule import named
from carp_verify.lemmas.smt import Bool, Int, Model, Solver, any_of, at_least, between, equal, integer

Stays: TypeAlias = dict[RobotId, list[Visit]]
Ticks: TypeAlias = dict[RobotId, list[int]]
Pair: TypeAlias = tuple[ResourceId, ResourceId]


@dataclass(frozen=True, slots=True)
class Breach:
    """A tick at which a rule is broken: all robots in the resource, or all that exchange it and another."""

    rule: str
    robots: tuple[RobotId, ...]
    resource: ResourceId
    tick: int
    reason: str

    def __str__(self) -> str:
        """Print like `[joint/capacity] resource 3,4 at tick 5: robots r1, r9 (capacity 1)`."""
        return f"[{self.rule}] resource {self.resource} at tick {self.tick}: {named(self.robots)} ({self.reason})"


@dataclass(frozen=True, slots=True)
class Certificate:
    """The numbers of visited resources and of pairs with moves both ways that z3 was asked about, and the bad ticks.

    If `carp_spec` finds another rule broken, there are violations, and z3 is not asked.
    """

    resources: int
    pairs: int
    breaches: tuple[Breach, ...]
    violations: tuple[Violation, ...] = ()

    @property
    def accepted(self) -> bool:
        """Whether no rule is broken."""
        return not self.breaches and not self.violations


class Terms:
    """The terms about the unknown tick; equal terms are made once, because making them is slow.

    Over many resources there are far fewer different stays than visits.
    """

    def __init__(self) -> None:
        """Begin with a tick about which nothing is known."""
        self.tick: Int = integer("tick")
        self._stays: dict[tuple[int, int | None], Bool] = {}
        self._ticks: dict[int, Bool] = {}

    def in_visit(self, visit: Visit) -> Bool:
        """Whether the tick is in the visit."""
        stay = (visit.enter, visit.leave)
        if stay not in self._stays:
            within = self.tick >= visit.enter if visit.leave is None else between(visit.enter, self.tick, visit.leave)
            self._stays[stay] = within
        return self._stays[stay]

    def is_at(self, tick: int) -> Bool:
        """Whether the tick is this one."""
        if tick not in self._ticks:
            self._ticks[tick] = equal(self.tick, tick)
        return self._ticks[tick]


def certify(instance: Instance, solution: Solution, advance: Callable[[], None] = lambda: None) -> Certificate:
    """Check the solution, and have z3 confirm the rules of robots together; `advance` is called for each resource.

    Raises `smt.Undecided`, and `RuntimeError` if the checker and z3 contradict each other.
    """
    verdict = judge(instance, solution)
    violations = tuple(each for each in verdict.violations if not each.rule.startswith("joint/"))
    if violations:
        return Certificate(0, 0, (), violations)
    certificate = certify_together(instance, solution.plans, advance)
    if certificate.accepted != verdict.valid:
        raise RuntimeError(f"the checker and z3 differ: {(*verdict.violations, *certificate.breaches)[0]}")
    return certificate


def certify_together(
    instance: Instance, plans: Sequence[Plan], advance: Callable[[], None] = lambda: None
) -> Certificate:
    """Ask z3 about every resource that is visited: the rules `joint/...` alone."""
    refuse(instance, "groups", "stops")
    solver, terms = Solver(), Terms()
    index = instance.graph.index
    stays = stays_by_resource(instance, plans)
    moves = moves_by_pair(instance, plans)
    opposite = [(one, other) for one, other in moves if index[one] < index[other] and (other, one) in moves]
    breaches: list[Breach] = []
    for resource, visitors in stays.items():
        place = instance.graph.resource[resource]
        breaches.extend(overfull(solver, terms, "joint/capacity", place, visitors))
        if instance.gap:
            breaches.extend(overfull(solver, terms, "joint/following", place, longer(visitors, instance.gap)))
        advance()
    for one, other in opposite:
        breaches.extend(exchanged(solver, terms, (one, other), moves[one, other], moves[other, one]))
    return Certificate(len(stays), len(opposite), tuple(breaches))


def stays_by_resource(instance: Instance, plans: Sequence[Plan]) -> Mapping[ResourceId, Stays]:
    """The visits to each resource of the graph, by robot."""
    stays: dict[ResourceId, Stays] = {}
    for plan in plans:
        for visit in plan.visits:
            if visit.resource in instance.graph.resource:
                stays.setdefault(visit.resource, {}).setdefault(plan.robot, []).append(visit)
    return stays


def moves_by_pair(instance: Instance, plans: Sequence[Plan]) -> Mapping[Pair, Ticks]:
    """The ticks of the moves from one resource of the graph to another, by robot."""
    known = instance.graph.resource
    moves: dict[Pair, Ticks] = {}
    for plan in plans:
        for visit, following in pairwise(plan.visits):
            pair = (visit.resource, following.resource)
            if visit.resource in known and following.resource in known:
                moves.setdefault(pair, {}).setdefault(plan.robot, []).append(following.enter)
    return moves


def longer(stays: Stays, gap: int) -> Stays:
    """The visits, each `gap` ticks longer."""
    return {
        robot: [each if each.leave is None else replace(each, leave=each.leave + gap) for each in visits]
        for robot, visits in stays.items()
    }


def overfull(solver: Solver, terms: Terms, rule: str, resource: Resource, stays: Stays) -> Iterator[Breach]:
    """A tick at which more robots are in the resource than its capacity, if there is one."""
    occupies = {robot: any_of(*map(terms.in_visit, visits)) for robot, visits in stays.items()}
    model = solver.find_model([at_least(resource.capacity + 1, list(occupies.values()))])
    if model is not None:
        reason = f"capacity {resource.capacity}"
        yield Breach(rule, _robots_of(model, occupies), resource.id, int(model.value(terms.tick)), reason)


def exchanged(solver: Solver, terms: Terms, pair: Pair, there: Ticks, back: Ticks) -> Iterator[Breach]:
    """A tick at which two robots move opposite ways between the pair, if there is one."""
    goes, comes = ({robot: any_of(*map(terms.is_at, ticks)) for robot, ticks in ways.items()} for ways in (there, back))
    both = {robot: any_of(goes[robot], comes[robot]) for robot in goes if robot in comes}
    movers = {**goes, **comes, **both}
    different = (
        [at_least(2, list(movers.values()))] if both else []
    )  # else the robot that goes is not the one that comes
    model = solver.find_model([any_of(*goes.values()), any_of(*comes.values()), *different])
    if model is not None:
        reason = f"they exchange {pair[0]} and {pair[1]}"
        robots = _robots_of(model, movers)
        yield Breach("joint/exchange", robots, pair[0], int(model.value(terms.tick)), reason)


def _robots_of(model: Model, terms: Mapping[RobotId, Bool]) -> tuple[RobotId, ...]:
    """The robots whose tracked terms hold in the model."""
    return tuple(robot for robot, term in terms.items() if model.value(term))
