"""The least total cost of plans for all robots, by a core-guided search over one encoding.

Each robot is assumed to have no delay at first. As long as the assumptions cannot hold together, the solver names
a core of them, and one of these must be given up: the lower bound rises by one, the robots in the core get a longer
horizon, and the next assumption is that no other one of the core is given up. Once the assumptions hold, the
model's plans have a total of just the lower bound; the conflicts among them are forbidden and the search
continues, until none is left. Source: the OLL algorithm of Andres, Kaufmann, Matheis and Schaub 2012, over delays.

After many conflicts another search may begin beside it, for plans and for a lower bound (`carp_optimum.optimum`). The
search ends where the best plans cost no more than the better bound.

Where no plan set exists, the search finds one of these obstacles (`carp_verify.optimum.unsolvable` says why each is
one):

- `no-way`: a robot has no way to its goal;
- `full-goal`: with `park`, a resource is the goal of more robots than its capacity;
- `clauses`: a core is empty, so robots break a rule however late they may be;
- `states`: the joint states of all robots are few, and a search over all of them finds no end.

The answer is not proved: it rests on this module and on the solver. `carp_optimum.sat.proving` writes a proof of it.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from time import monotonic_ns
from typing import TYPE_CHECKING

from carp_optimum.deadline import Deadline, TimeOver
from carp_optimum.sat.between import Between
from carp_optimum.sat.heuristics import plans_of_all, sum_of_shortest_paths
from carp_optimum.sat.solver import Solver
from carp_spec import Instance, Plan, Refusal, Solution, judge, total_cost
from carp_spec.inputs.options import require_limits
from carp_spec.inputs.values import require_instance
from carp_spec.limits import goals_stand_alone
from carp_verify.bound.rules import ContradictionError, require_kept
from carp_verify.optimum.clauses import Literal, Unary
from carp_verify.optimum.encoding import Encoding, Evidence, violated
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.unsolvable import Clauses, FullGoal, NoWay, Obstacle, States, is_searched

if TYPE_CHECKING:
    from carp_optimum.background import BackgroundSearch

CONFLICTS_TO_SHRINK = 300  # of a search without one literal of a core
CONFLICTS_BEFORE_BESIDE = 60_000
"""Most searches that end within a minute end before these, and faster while nothing uses the memory beside them."""
CONFLICTS_BETWEEN_RESULTS = 2000
"""After this many conflicts the search asks for what was found beside it."""
DELAY_OF_DOUBT = 20  # ticks of all robots together, at which it is asked whether there are any plans
PARTS = 5
"""A search of which one of this many parts of the time is over plans with heuristics, for as long again.

If its formula is not made by then, it plans for the rest of the time.
"""


@dataclass(frozen=True, slots=True)
class Optimum:
    """The least total cost.

    `decided`: by the search, `cost` is the optimum and `solution` has it, or, where `cost` is `None`, no plan set
    exists because of the `obstacle`. Otherwise `solution` is the best known, if any, `cost` its total, and `lower` a
    bound that no plan set beats. `shortest` is the sum of the robots' costs if each were alone, a robot without a
    way left out; `None` if the limit did not suffice to find them.
    """

    shortest: int | None
    cost: int | None
    lower: int
    decided: bool
    solution: Solution | None
    evidence: Evidence
    obstacle: Obstacle | None = None


def core_guided(
    instance: Instance,
    limit: float,
    clock: Callable[[], int] = monotonic_ns,
    start_beside: "Callable[[CoreGuided], None] | None" = None,
    watch: Callable[[], None] | None = None,
) -> Optimum:
    """Search for the optimum for at most `limit` seconds. Raises `Refusal` if the formula outgrows the memory.

    `start_beside` is called once, after many conflicts, unless the instance has groups or stops, which that search does
    not know. `watch` is called as time goes by, and may end the search by `TimeOver`; by default it looks at the clock.

    Before the limit, the result does not depend on the clock, which gives nanoseconds: the same instance gives the same
    solution.
    """
    require_instance(instance)
    require_limits(limit=limit)
    deadline = Deadline(limit, clock)
    try:
        encoding = Encoding(instance, deadline.part(PARTS).check)
    except TimeOver:
        return _planned(instance, deadline)
    is_known = goals_stand_alone(instance) and not instance.graph.groups
    with closing(CoreGuided(encoding, deadline, start_beside if is_known else None, watch)) as search:
        return search.run()


def _planned(instance: Instance, deadline: Deadline) -> Optimum:
    """The shortest paths of a fleet whose formula takes too long, and plans made in the rest of the time.

    Plans that cost no more than these paths are the optimum.
    """
    shortest = sum_of_shortest_paths(instance, deadline.part(PARTS).check)
    plans = plans_of_all(instance, [*instance.robot], deadline)
    cost = None if plans is None else total_cost(instance, plans)
    solution = None if plans is None else _solution(instance, plans)
    robots = range(len(instance.robots))
    evidence = Evidence((0,) * len(robots), tuple(robots))
    is_least = cost is not None and cost == shortest
    return Optimum(shortest, cost, shortest or 0, decided=is_least, solution=solution, evidence=evidence)


def _solution(instance: Instance, plans: Sequence[Plan]) -> Solution:
    """The solution with these plans; raises `ContradictionError` if they break the law."""
    solution = Solution(tuple(plans), tuple(plan.robot for plan in plans))
    verdict = judge(instance, solution)
    if verdict.violations or verdict.unplanned:
        raise ContradictionError("the search has found plans that break a rule")
    return solution


class CoreGuided:
    """The state of a search; `known` has the bound and the plans that were found beside it."""

    def __init__(
        self,
        encoding: Encoding,
        deadline: Deadline,
        start_beside: "Callable[[CoreGuided], None] | None",
        watch: Callable[[], None] | None,
    ) -> None:
        self.instance = encoding.instance
        self.start_beside = start_beside
        self.deadline = deadline
        self.encoding = encoding
        self.solver = Solver(encoding.formula, self.look, glucose=True, watch=watch)
        self.delay = 0
        self.horizon = 0
        self.best: Sequence[Plan] | None = None
        self.known = Between(self.instance)
        self.here: Between | None = None
        self.beside: BackgroundSearch[Between] | None = None
        self.work_before = 0
        self.has_tried_heuristics = False
        self.order: dict[int, None] = {}
        self.robot_of: dict[Literal, int] = {}
        self.sum_of: dict[Literal, tuple[Unary, int]] = {}

    def close(self) -> None:
        """End the search, and the one beside it."""
        self.solver.close()
        if self.beside is not None:
            self.beside.close()

    def run(self) -> Optimum:
        """Search until the optimum is known, no plan set is known to exist, or the time is over."""
        obstacle = self.obstacle()
        if obstacle is not None:
            return self.unsolvable(obstacle)
        try:
            for position in range(len(self.encoding.robots)):
                self.grow(position)
            return self.raise_bound()
        except TimeOver:
            return self.undecided()

    def obstacle(self) -> Obstacle | None:
        """The obstacle, if it shows without a search."""
        for robot in self.encoding.wayless:
            return NoWay(robot.id)
        if self.instance.after_goal == "park":
            for goal, robots in Counter(robot.goal for robot in self.instance.robots).items():
                if robots > self.instance.graph.resource[goal].capacity:
                    return FullGoal(goal)
        return None

    def raise_bound(self) -> Optimum:
        """Raise the lower bound by one with each core, until the assumptions hold."""
        while True:
            assumptions = [-literal for literal in (*self.robot_of, *self.sum_of)]
            answer = None
            while answer is None:
                self.read_beside()
                if self.known.plans is not None and self.is_met:
                    self.horizon = self.lower - self.encoding.shortest  # suffices for a proof
                    return self.optimal(self.known.plans)
                answer = self.solver.satisfiable(assumptions, CONFLICTS_BETWEEN_RESULTS)
            if answer:
                plans = self.encoding.plans(self.solver.model())
                conflicts = violated(self.instance, plans)
                if not conflicts:
                    return self.optimal(plans)
                for conflict in conflicts:
                    self.encoding.forbid(conflict)
            else:
                core = self.shrunk([-literal for literal in self.solver.core()])
                if not core:
                    return self.unsolvable(Clauses(self.evidence.horizons))
                self.relax(core)
                if self.delay == DELAY_OF_DOUBT and self.has_no_end():
                    return self.unsolvable(States())

    def read_beside(self) -> None:
        """Ask for what was found beside at an amount of work, so that the answer does not depend on the clock."""
        if self.beside is not None:
            work = (self.solver.work - self.work_before) * 3 // 4  # the two slow each other down, the other one more
            self.take(self.beside.result(work))
        elif self.start_beside is not None and self.solver.conflicts > CONFLICTS_BEFORE_BESIDE:
            start, self.start_beside = self.start_beside, None
            start(self)

    def take(self, found: Between | None) -> None:
        """Take in what was found beside, of all plans or of the half that is not searched here."""
        if self.here is not None:
            found = self.here.of_all(found or Between(self.instance))
        if found is not None:
            self.known = self.known.sharpened(found)

    def has_no_end(self) -> bool:
        """Whether the states of all robots together are few, and none is the end of a plan set."""
        if not is_searched(self.instance):
            return False
        try:
            return least_total_cost(self.instance, on_step=self.look) is None
        except Refusal:
            return False

    def grow(self, position: int) -> None:
        """Give a robot a longer horizon, and assume that it arrives within it."""
        self.look()
        robot = self.encoding.robots[position]
        robot.grow()
        self.robot_of[robot.late[robot.horizon]] = position

    def shrunk(self, core: list[Literal]) -> list[Literal]:
        """A core within the core, from which the solver drops nothing quickly."""
        kept = 0
        while kept < len(core) and len(core) > 1:
            trial = core[:kept] + core[kept + 1 :]
            if self.solver.satisfiable([-literal for literal in trial], CONFLICTS_TO_SHRINK) is False:
                named = {-literal for literal in self.solver.core()}
                core = [literal for literal in trial if literal in named]
            else:
                kept += 1
        return core

    def relax(self, core: Sequence[Literal]) -> None:
        """One delay of the core must happen: raise the bound, and assume instead that no second one does."""
        self.delay += 1
        self.encoding.formula.add(*core)
        for literal in core:
            if literal in self.robot_of:
                position = self.robot_of.pop(literal)
                self.order.setdefault(position)
                self.grow(position)
            else:
                self.assume_less(*self.sum_of.pop(literal))
        self.assume_less(self.encoding.formula.at_least([[literal] for literal in core], len(core)), 1)

    def assume_less(self, number: Unary, reached: int) -> None:
        """Assume that a number which is at least `reached` is no more than that."""
        if reached < len(number):
            self.sum_of[number[reached]] = (number, reached + 1)

    def look(self) -> None:
        """Look at the clock. A long search stops once to plan with heuristics."""
        if self.beside is not None:
            self.beside.read()
            self.deadline.check()
            return
        if not self.has_tried_heuristics and self.deadline.is_past(PARTS):
            self.has_tried_heuristics = True
            longest_first = sorted(self.encoding.robots, key=lambda robot: -(robot.shortest or 0))
            order = [robot.robot.id for robot in longest_first]
            self.best = plans_of_all(self.instance, order, self.deadline.part(PARTS))
        self.deadline.check()

    @property
    def evidence(self) -> Evidence:
        """The horizons and the order of robots with which a proof can be written."""
        rest = [position for position in range(len(self.encoding.robots)) if position not in self.order]
        horizons = tuple(max(robot.horizon, self.horizon) for robot in self.encoding.robots)
        return Evidence(horizons, (*self.order, *rest))

    @property
    def lower(self) -> int:
        """No plan set costs less."""
        return max(self.encoding.shortest + self.delay, self.known.lower)

    @property
    def is_met(self) -> bool:
        """Whether the best plans known cost no more than the bound."""
        return self.known.total is not None and self.known.total == self.lower

    def optimal(self, plans: Sequence[Plan]) -> Optimum:
        """The answer that these plans are the best."""
        cost = total_cost(self.instance, plans)
        require_kept(self.lower, cost)
        solution = _solution(self.instance, plans)
        return Optimum(self.encoding.shortest, cost, cost, decided=True, solution=solution, evidence=self.evidence)

    def unsolvable(self, obstacle: Obstacle) -> Optimum:
        """The answer that no plan set exists."""
        return Optimum(self.encoding.shortest, None, self.lower, True, None, self.evidence, obstacle)

    def undecided(self) -> Optimum:
        """The answer when the time is over: the best plans and the best bound so far."""
        if self.beside is not None:
            self.take(self.beside.latest())
        known = self.known.with_plans(self.best)
        cost = known.total
        if cost is not None:
            require_kept(self.lower, cost)
        solution = None if known.plans is None else _solution(self.instance, known.plans)
        return Optimum(self.encoding.shortest, cost, self.lower, cost == self.lower, solution, self.evidence)
