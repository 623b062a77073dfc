"""Which further resources robots may be granted: by the planned order, and beyond it by search.

By the order, a robot may have its next resources as far as all robots have left them that are planned to have left them
by then. All robots may have theirs together. Beyond the order, the search looks for a sequence of moves by which all
robots finish. Before it goes through all states, it tries to keep the order of the others, and pairs of robots.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf
from time import perf_counter
from typing import Literal, TypeAlias

from carp_spec import Instance, Refusal, ResourceId, RobotId, Solution
from carp_spec.execution.dependencies import Node, Stay, stays_by_constraint
from carp_spec.execution.execution_rules import EXECUTION_RULES, TRACE_RULES, is_acyclic
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_robot, require_trace, sound_solution
from carp_spec.rule import is_between
from carp_verify.bound.rules import ContradictionError
from carp_verify.release.holding import State, Ways, places_of
from carp_verify.release.rules import Grant, answer_is_shown, grants_are_next, there_is_room
from carp_verify.release.verify import Finish, Overfull, Stuck, Witness
from carproof.execution.release_search import Budget, CutOffError, Search, all_places
from carproof.requests import POSITIVE_LIMIT, deadline

Answer: TypeAlias = Literal["safe", "unsafe", "undecided"]
MOST_STATES = 20_000
SHARE = 3
"""A search has one of this many parts of the time; to check its witness and to write it take no more than it does."""


def limit_of(states: int | None, seconds: float | None) -> tuple[float, float]:
    """The states of each search, and when all must have ended, if they begin now; raises `Refusal` for wrong ones."""
    if states is not None and not is_between(states, 1):
        message = f"it must be a whole number of at least 1, not {states!r}"
        raise Refusal("option", "$.states", POSITIVE_LIMIT.id, message)
    return states or (MOST_STATES if seconds is None else inf), deadline(seconds)


def end_of_part(until: float, parts: int) -> float:
    """When the first of so many equal parts of the time until then is over."""
    now = perf_counter()
    return now + (until - now) / parts


@dataclass(frozen=True, slots=True)
class GrantsVerdict:
    """Whether grants are safe, and the witness; without one the search was cut off.

    `by_order` is whether they follow from the planned order.
    """

    witness: Witness | None
    by_order: bool = False

    @property
    def answer(self) -> Answer:
        """The answer of the witness."""
        if self.witness is None:
            return "undecided"
        return "safe" if isinstance(self.witness, Finish) else "unsafe"


@dataclass(frozen=True, slots=True)
class Beyond:
    """What one robot may be granted while the others get nothing.

    `next` is the first resource that it may not have, with the answer for it and the robots in the way; `None` at the
    end of its plan, and for a robot that is not released yet, which may have nothing.
    """

    grant: Grant
    next: ResourceId | None = None
    answer: Answer = "safe"
    robots: tuple[RobotId, ...] = ()


@dataclass(frozen=True, slots=True)
class Released:
    """What all robots may be granted together by the planned order, and what each may be granted alone.

    `follows` is whether the robots have kept the planned order so far; where they have not, it grants nothing.
    """

    follows: bool
    in_order: tuple[Grant, ...]
    beyond: tuple[Beyond, ...] = ()


class Leaving:
    """The stays in a place in the order in which they are planned to end."""

    def __init__(self, stays: Sequence[Stay], gap: int) -> None:
        left = ((each.visit.leave, each.last) for each in stays if each.visit.leave is not None)
        self.ends = sorted(((leave + gap, node) for leave, node in left), key=lambda end: end[0])
        self.first = 0

    def due(self, state: State) -> int | None:
        """The tick from which entering robots wait: one is planned to have left by then, and has not."""
        while self.first < len(self.ends) and state[(end := self.ends[self.first][1])[0]] > end[1]:
            self.first += 1
        return self.ends[self.first][0] if self.first < len(self.ends) else None


class Releasing:
    """The situation of a trace: where robots are, and what the planned order grants them.

    Raises `Refusal`, of the kind `request` for the solution, and else for the trace.
    """

    def __init__(self, instance: Instance, solution: Solution, trace: Trace) -> None:
        require_trace(instance, solution, trace)
        self.instance, self.solution, self.trace = instance, sound_solution(instance, solution), trace
        self.plans = {plan.robot: plan for plan in self.solution.plans}
        self.ways = Ways.of(instance, self.solution.plans)
        self.stays = stays_by_constraint(instance.graph, self.solution.plans)
        for each in (*TRACE_RULES, EXECUTION_RULES[0]):
            for violation in each(instance, self.solution, trace):
                raise Refusal("document", "$.plans", violation.rule, violation.message)
        self.now = places_of(trace, self.solution.plans)
        self.follows = not any(
            violation for each in EXECUTION_RULES[1:] for violation in each(instance, self.solution, trace)
        )
        if not self.follows:
            for fault in there_is_room(self.ways.overfull(self.now, self.now)):
                raise Refusal("document", fault.path, fault.rule, fault.message)
        self.in_order = self._in_order() if self.follows else self.now
        if self.follows and self._keeping_order(self.in_order, Budget(inf)) is None:
            for violation in is_acyclic(instance, self.solution):
                message = f"{violation.message}; carproof execution untangle makes plans without rotations"
                raise Refusal("request", "$", is_acyclic.id, message)
            raise ContradictionError("the planned order has no cycle, and robots that keep it do not finish")

    def _in_order(self) -> State:
        """The last visit of each robot before which nobody has to leave a place that is not left yet."""
        most = {robot: len(plan.visits) - 1 for robot, plan in self.plans.items()}
        for stays in self.stays.values():
            due = Leaving(stays, self.instance.gap).due(self.now)
            for stay in stays:
                robot, place = stay.node
                if due is not None and stay.visit.enter >= due and place > self.now[robot]:
                    most[robot] = min(most[robot], place - 1)
        released = {robot for robot in most if self.instance.robot[robot].release <= self.trace.now}
        return {robot: max(most[robot], now) if robot in released else now for robot, now in self.now.items()}

    def _keeping_order(self, start: State, budget: Budget) -> Finish | None:
        """Moves by which all finish if robots go on in the planned order from there; `None` if they do not."""
        state, moves = dict(start), list[RobotId]()
        used = self.ways.used(state)
        begins: dict[Node, list[tuple[Leaving, int]]] = defaultdict(list)
        for stays in self.stays.values():
            leaving = Leaving(stays, self.instance.gap)
            for stay in stays:
                begins[stay.node].append((leaving, stay.visit.enter))

        def may_move(robot: RobotId) -> bool:
            if not self.ways.is_open(robot, state[robot], used):
                return False
            dues = ((leaving.due(state), enter) for leaving, enter in begins[robot, state[robot] + 1])
            return all(due is None or enter < due for due, enter in dues)

        count = -1
        while count < len(moves):
            count = len(moves)
            for robot in self.plans:
                budget.look_at_the_clock()
                while may_move(robot):
                    used.subtract(self.ways.held(robot, state[robot], state[robot]))
                    state[robot] += 1
                    used.update(self.ways.held(robot, state[robot], state[robot]))
                    moves.append(robot)
        has_ended = all(self.ways.has_ended(robot, place) for robot, place in state.items())
        return Finish(tuple(moves)) if has_ended else None

    def check(self, grants: Sequence[Grant], states: float, until: float) -> GrantsVerdict:
        """Whether grants are safe, as far as searches of so many states tell until then, by `perf_counter`."""
        for fault in grants_are_next(self.instance, self.solution.plans, self.trace, grants):
            raise Refusal("document", fault.path, fault.rule, fault.message)
        granted = {**self.now, **{each.robot: self.now[each.robot] + len(each.resources) for each in grants}}
        try:
            witness = self._witness(granted, Budget(states, end_of_part(until, SHARE)))
        except CutOffError:
            return GrantsVerdict(None)
        if not answer_is_shown(self.instance, self.solution.plans, self.now, granted, witness):
            raise ContradictionError(f"the search says {type(witness).__name__}, and its witness does not show it")
        return GrantsVerdict(witness, self.follows and all(granted[each] <= self.in_order[each] for each in granted))

    def _witness(self, granted: State, budget: Budget) -> Witness:
        for constraint, robots in self.ways.overfull(self.now, granted):
            return Overfull(constraint, robots)
        kept = self._keeping_order(granted, budget)
        if kept is not None:
            return kept
        planned = {robot: [visit.enter for visit in plan.visits] for robot, plan in self.plans.items()}

        def finish(robots: Sequence[RobotId]) -> tuple[RobotId, ...] | None:
            return Search(self.ways.only(robots), planned, budget).finish(granted)

        for pair in self._pairs(granted):
            if finish(pair) is None:
                return Stuck(pair, all_places(self.ways.only(pair), granted, pair, budget))
        robots = tuple(self.plans)
        moves = finish(robots)
        if moves is not None:
            return Finish(moves)
        for robot in self.plans:
            fewer = tuple(each for each in robots if each != robot)
            if finish(fewer) is None:
                robots = fewer
        return Stuck(robots, all_places(self.ways.only(robots), granted, robots, budget))

    def _pairs(self, granted: State) -> Iterator[tuple[RobotId, RobotId]]:
        """Robots that are granted more than the order grants, each with one whose way leads through a place of its."""
        ahead = [robot for robot, place in granted.items() if place > self.in_order[robot]]
        rest = {robot: self.ways.held(robot, place, len(self.plans[robot].visits)) for robot, place in granted.items()}
        for robot in ahead:
            yield from ((robot, other) for other in rest if other != robot and not rest[robot].isdisjoint(rest[other]))

    def released(self, beyond: Sequence[RobotId], states: float, until: float) -> Released:
        """What the planned order grants, and for these robots, if they have plans, what each may be granted alone."""
        for robot in beyond:
            require_robot(self.instance, robot, "$.beyond")
        beyond = [robot for robot in beyond if robot in self.plans]
        in_order = tuple(self._grant(robot, place) for robot, place in self.in_order.items())
        parts = range(len(beyond), 0, -1)
        alone = (self._beyond(each, states, end_of_part(until, part)) for part, each in zip(parts, beyond, strict=True))
        return Released(self.follows, in_order, tuple(alone))

    def _grant(self, robot: RobotId, last: int) -> Grant:
        visits = self.plans[robot].visits[self.now[robot] + 1 : last + 1]
        return Grant(robot, tuple(visit.resource for visit in visits))

    def _beyond(self, robot: RobotId, states: float, until: float) -> Beyond:
        best = self._grant(robot, self.in_order[robot])
        if self.instance.robot[robot].release > self.trace.now:
            return Beyond(best)
        for last in range(self.in_order[robot] + 1, len(self.plans[robot].visits)):
            grant = self._grant(robot, last)
            verdict = GrantsVerdict(None) if perf_counter() >= until else self.check([grant], states, until)
            if verdict.answer != "safe":
                witness = verdict.witness
                robots = () if witness is None or isinstance(witness, Finish) else witness.robots
                return Beyond(
                    best, grant.resources[-1], verdict.answer, tuple(each for each in robots if each != robot)
                )
            best = grant
        return Beyond(best)
