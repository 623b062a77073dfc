"""The certificate of a solution: `carp_spec` finds no rule broken, and z3 confirms the rules of robots together.

For each resource and each group, z3 searches for a tick, any whole number, at which more robots occupy it than its
capacity. For each pair of areas between which robots move both ways, it searches for a tick at which two robots make
opposite moves. An area is a group of capacity 1, or a resource that is in none.
Each robot's stays are one tracked term, so that an answer names the robots. The question is the negation of the rule:
if z3 finds no answer, no such tick exists. This part shares no code with `carp_spec.check`, which sweeps over events
instead. The rules of single plans and of the list of plans get no second opinion here.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import pairwise, product
from typing import TypeAlias

from msgspec import structs

from carp_spec import Instance, Plan, ResourceId, RobotId, Solution, Violation, Visit, judge
from carp_spec.model import Group, Move
from carp_spec.rule import named
from carp_verify.lemmas.smt import Bool, Int, Model, Solver, any_of, at_least, between, equal, integer

Stays: TypeAlias = dict[RobotId, list[Visit]]
Moves: TypeAlias = dict[RobotId, list[tuple[int, Move]]]
"""The moves of each robot with their ticks."""


@dataclass(frozen=True, slots=True)
class Breach:
    """A tick at which a rule is broken: all robots in the resource or group, or all that exchange places."""

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
    """The numbers of visited resources and groups, and of pairs with moves both ways, and the bad ticks.

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
        self.in_stay = cache(self._in_stay)
        self.is_at = cache(partial(equal, self.tick))

    def _in_stay(self, enter: int, leave: int | None) -> Bool:
        """Whether the tick is in [enter, leave)."""
        return self.tick >= enter if leave is None else between(enter, self.tick, leave)


def certify(instance: Instance, solution: Solution, advance: Callable[[], None] = lambda: None) -> Certificate:
    """Check the solution, and have z3 confirm the rules of robots together.

    `advance` is called for each resource and group. Raises `smt.Undecided`, and `RuntimeError` if the checker and z3
    contradict each other.
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
    """Ask z3 about every resource and group that is visited: the rules `joint/...` alone."""
    solver, terms = Solver(), Terms()
    breaches: list[Breach] = []
    places = visited(instance, plans)
    for place in places:
        stays = stays_in(place, plans)
        breaches.extend(overfull(solver, terms, place, stays))
        if instance.gap:
            breaches.extend(
                overfull(solver, terms, replace(place, rule="joint/following"), longer(stays, instance.gap))
            )
        advance()
    moves = moves_between(instance, plans)
    opposite = [(one, other) for one, other in moves if one <= other and (other, one) in moves]
    for one, other in opposite:
        breaches.extend(exchanged(solver, terms, moves[one, other], moves[other, one]))
    return Certificate(len(places), len(opposite), tuple(breaches))


@dataclass(frozen=True, slots=True)
class Place:
    """Resources that robots occupy together, no more of them than the capacity, by the rule."""

    rule: str
    resources: frozenset[ResourceId]
    capacity: int
    of: str = ""


def visited(instance: Instance, plans: Sequence[Plan]) -> list[Place]:
    """The resources of the graph and the groups that have a visit."""
    used = {visit.resource for plan in plans for visit in plan.visits}
    graph = instance.graph
    alone = [Place("joint/capacity", frozenset([each.id]), each.capacity) for each in graph.resources]
    groups = [Place("joint/group", frozenset(each.resources), each.capacity, _named(each)) for each in graph.groups]
    return [place for place in alone + groups if not used.isdisjoint(place.resources)]


def _named(group: Group) -> str:
    return "" if group.resources == (group.id,) else f" of group {group.id}"


def stays_in(place: Place, plans: Sequence[Plan]) -> Stays:
    """The visits to its resources, by robot."""
    stays: Stays = {}
    for plan in plans:
        for visit in plan.visits:
            if visit.resource in place.resources:
                stays.setdefault(plan.robot, []).append(visit)
    return stays


def moves_between(instance: Instance, plans: Sequence[Plan]) -> Mapping[tuple[int, int], Moves]:
    """The moves from one area of the graph to another, or within one, by robot."""
    areas: dict[ResourceId, list[int]] = {each.id: [] for each in instance.graph.resources}
    for number, group in enumerate(instance.graph.groups):
        for resource in group.resources if group.capacity == 1 else ():
            areas[resource].append(number)
    for number, resource in enumerate(areas):
        areas[resource] = areas[resource] or [len(instance.graph.groups) + number]
    moves: dict[tuple[int, int], Moves] = {}
    for plan in plans:
        for visit, following in pairwise(plan.visits):
            pair = (visit.resource, following.resource)
            if visit.resource != following.resource and set(pair) <= areas.keys():
                for way in product(areas[visit.resource], areas[following.resource]):
                    moves.setdefault(way, {}).setdefault(plan.robot, []).append((following.enter, pair))
    return moves


def longer(stays: Stays, gap: int) -> Stays:
    """The visits, each `gap` ticks longer."""
    return {
        robot: [each if each.leave is None else structs.replace(each, leave=each.leave + gap) for each in visits]
        for robot, visits in stays.items()
    }


def overfull(solver: Solver, terms: Terms, place: Place, stays: Stays) -> Iterator[Breach]:
    """A tick at which more robots are in the place than its capacity, if there is one."""
    occupies = {
        robot: any_of(*(terms.in_stay(each.enter, each.leave) for each in visits)) for robot, visits in stays.items()
    }
    model = solver.find_model([at_least(place.capacity + 1, list(occupies.values()))])
    if model is not None:
        robots, tick = _robots_of(model, occupies), int(model.value(terms.tick))
        at = next(each.resource for each in stays[robots[0]] if _covers(each, tick))
        yield Breach(place.rule, robots, at, tick, f"capacity {place.capacity}{place.of}")


def _covers(visit: Visit, tick: int) -> bool:
    return visit.enter <= tick and (visit.leave is None or tick < visit.leave)


def exchanged(solver: Solver, terms: Terms, there: Moves, back: Moves) -> Iterator[Breach]:
    """A tick at which two robots move opposite ways between two areas, if there is one."""
    goes, comes = (
        {robot: any_of(*(terms.is_at(tick) for tick, _ in moves)) for robot, moves in ways.items()}
        for ways in (there, back)
    )
    both = {robot: any_of(goes[robot], comes[robot]) for robot in goes if robot in comes}
    movers = {**goes, **comes, **both}
    # without any that does both, the robot that goes is not the one that comes
    different = [at_least(2, list(movers.values()))] if both else []
    model = solver.find_model([any_of(*goes.values()), any_of(*comes.values()), *different])
    if model is not None:
        tick = int(model.value(terms.tick))
        pairs = product(_moves_at(tick, there), _moves_at(tick, back))
        one, other = next((move, opposite) for (robot, move), (another, opposite) in pairs if robot != another)
        what = f"{one[0]} and {one[1]}" if other == one[::-1] else f"{one} and {other}"
        yield Breach("joint/exchange", _robots_of(model, movers), one[0], tick, f"they exchange {what}")


def _moves_at(tick: int, ways: Moves) -> list[tuple[RobotId, Move]]:
    return [(robot, move) for robot, moves in ways.items() for at, move in moves if at == tick]


def _robots_of(model: Model, terms: Mapping[RobotId, Bool]) -> tuple[RobotId, ...]:
    """The robots whose tracked terms hold in the model."""
    return tuple(robot for robot, term in terms.items() if model.value(term))
