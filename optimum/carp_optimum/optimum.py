"""The least total cost of plans for all robots, by a core-guided search over one encoding.

Each robot is assumed to have no delay at first. As long as the assumptions cannot hold together, the solver names
a core of them, and one of these must be given up: the lower bound rises by one, the robots in the core get a longer
horizon, and the next assumption is that no other one of the core is given up. Once the assumptions hold, the
model's plans have a total of just the lower bound; the conflicts among them are forbidden and the search
continues, until none is left. Source: the OLL algorithm of Andres, Kaufmann, Matheis and Schaub 2012, over delays.

After many conflicts two searches take over. One finds ever better plans (`carp_optimum.heuristics.ever_better`), in
another process (`carp_optimum.beside`). The other finds a lower bound with prices (`carp_optimum.bound`). From there
up, a few totals at a time, the formula of all plans of at most such a total (`carp_optimum.priced_formula`) either has
no model, which raises the bound, or one, which gives better plans, until the bound is the total of the best plans.

Where no plan set exists, the search finds one of these obstacles (`carp_verify.unsolvable` says why each is one):

- `no-way`: a robot has no way to its goal;
- `full-goal`: with `park`, a resource is the goal of more robots than its capacity;
- `clauses`: a core is empty, so robots break a rule however late they may be;
- `states`: the joint states of all robots are few, and a search over all of them finds no end.

The answer is not proved: it rests on this module and on the solver. `carp_optimum.proving` writes a proof of it.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import monotonic_ns

from carp_optimum.beside import Beside
from carp_optimum.heuristics import ever_better, plans_of_all
from carp_optimum.priced_formula import priced_formula
from carp_optimum.reduced_costs import PricedBound
from carp_optimum.solver import Deadline, Solver, TimeOver
from carp_spec import Instance, Plan, Refusal, Solution, judge, total_cost
from carp_verify.bound_rules import ContradictionError, require_kept
from carp_verify.clauses import Literal, Unary
from carp_verify.encoding import Encoding, Evidence, violated
from carp_verify.joint_search import least_total_cost
from carp_verify.limits import require_following
from carp_verify.unsolvable import Clauses, FullGoal, NoWay, Obstacle, States, is_searched

CONFLICTS_TO_SHRINK = 900
CONFLICTS_BEFORE_PRICES = 20_000
PRICE_STEPS = 1600
LARGEST_GAP = 12  # ticks
STRIDE = 2
"""A formula's largest total is this far above the lower bound: one for each total would take twice the time."""
CONFLICTS_BEFORE_BESIDE = 2000
"""After this many conflicts a formula's search asks for the plans that were found beside it."""
WORK_OF_STEP = 300
"""The propagations of a step of the search for prices, for each robot."""
WORK_OF_CLAUSE = 28
"""The propagations of making a clause of a formula with prices."""
DELAY_OF_DOUBT = 20
PARTS = 5
PARTS_BEFORE_HEURISTICS = (1, 3)


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


def optimum(instance: Instance, limit: float, clock: Callable[[], int] = monotonic_ns, priced: bool = True) -> Optimum:
    """Search for the optimum for at most `limit` seconds. Raises `Refusal` if the formula outgrows the memory.

    A long search continues with prices if `priced`, where the compiled search for them is at hand.

    The result does not depend on the clock, which gives nanoseconds: the same instance gives the same solution.
    """
    require_following(instance)
    deadline = Deadline(limit, clock)
    try:
        encoding = Encoding(instance, deadline.check)
    except TimeOver:
        return Optimum(None, None, 0, decided=False, solution=None, evidence=Evidence((), ()))
    search = _Search(encoding, deadline, priced)
    try:
        return search.run()
    finally:
        search.close()


class _Search:
    def __init__(self, encoding: Encoding, deadline: Deadline, priced: bool) -> None:
        self.instance = encoding.instance
        self.priced = priced
        self.deadline = deadline
        self.encoding = encoding
        self.solver = Solver(encoding.formula, self.look)
        self.delay = 0
        self.horizon = 0
        self.proved = 0
        self.best: Sequence[Plan] | None = None
        self.beside: Beside[Sequence[Plan]] | None = None
        self.tries_of_heuristics = 0
        self.order: dict[int, None] = {}
        self.robot_of: dict[Literal, int] = {}
        self.sum_of: dict[Literal, tuple[Unary, int]] = {}

    def close(self) -> None:
        self.solver.close()
        if self.beside is not None:
            self.beside.close()

    def run(self) -> Optimum:
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
        while True:
            assumptions = [-literal for literal in (*self.robot_of, *self.sum_of)]
            if self.solver.satisfiable(assumptions):
                plans = [plan for plan in self.encoding.plans(self.solver.model()) if plan is not None]
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
                if self.priced and self.solver.conflicts > CONFLICTS_BEFORE_PRICES:
                    self.priced = False
                    found = self.search_with_prices()
                    if found is not None:
                        return self.optimal(found)
                if self.delay == DELAY_OF_DOUBT and self.has_no_end():
                    return self.unsolvable(States())

    def search_with_prices(self) -> Sequence[Plan] | None:
        """The plans of an optimum, searched for from a bound up; `None` if it is too far from that for prices.

        All that is asked from the search beside this one is asked at an amount of work, so the plans do not depend on
        the clock.
        """
        from carp_optimized.compiling import is_cached  # noqa: PLC0415 - slow to load
        from carp_optimum.priced_ways import find_ways  # noqa: PLC0415

        if not is_cached(find_ways):
            return None
        self.beside = Beside(lambda look: ever_better(self.instance, look), self.look)
        plans: Sequence[Plan] | None = None
        try:
            bound = self.priced_bound()
            work = PRICE_STEPS * len(self.instance.robots) * WORK_OF_STEP
            while bound.gap(self.lower) <= LARGEST_GAP * bound.scale:
                known = self.cheaper(plans, self.beside.result(work))
                most = self.lower + STRIDE
                if known is not None:
                    most = min(most, total_cost(self.instance, known) - 1)
                if most < self.lower:
                    self.horizon = self.lower - self.encoding.shortest
                    return known
                found, work = self.plans_within(bound, most, work)
                plans = self.cheaper(known, found)
                self.best = self.cheaper(self.best, found)
                if found is None:
                    self.proved = most + 1
        except Refusal:
            pass
        return None

    def cheaper(self, *known: Sequence[Plan] | None) -> Sequence[Plan] | None:
        """The cheapest of the plan sets, the first one of equal ones; `None` without any."""
        there = [plans for plans in known if plans is not None]
        return min(there, key=lambda plans: total_cost(self.instance, plans), default=None)

    def plans_within(self, bound: PricedBound, most: int, work: int) -> tuple[Sequence[Plan] | None, int]:
        """Plans of at most this total, by their formula or found beside, and the work so far; `None` if none exist."""
        assert self.beside is not None  # noqa: S101 - it is there while prices are searched with
        encoding = priced_formula(self.instance, bound, most, self.look)
        work += len(encoding.formula.clauses) * WORK_OF_CLAUSE
        solver = Solver(encoding.formula, self.look, glucose=True)
        try:
            while (answer := solver.satisfiable([], CONFLICTS_BEFORE_BESIDE)) is None:
                plans = self.beside.result(work + solver.propagations)
                if plans is not None and total_cost(self.instance, plans) <= most:
                    return plans, work + solver.propagations
            model = [plan for plan in encoding.plans(solver.model()) if plan is not None] if answer else None
            return model, work + solver.propagations
        finally:
            solver.close()

    def priced_bound(self) -> PricedBound:
        """A lower bound with prices."""
        from carp_optimum.bound import lower_bound  # noqa: PLC0415 - slow to load

        certificate = lower_bound(self.instance, steps=PRICE_STEPS, on_step=lambda _: self.look(), seen=False)
        self.proved = certificate.bound
        self.look()
        return PricedBound(self.instance, certificate)

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
        """Look at the clock. A long search stops to plan with heuristics, and stops again if they find nothing."""
        if self.beside is not None:
            self.beside.read()
            self.deadline.check()
            return
        tries = self.tries_of_heuristics
        parts = PARTS_BEFORE_HEURISTICS[tries:]
        if self.best is None and parts and self.deadline.is_past(parts[0], PARTS):
            self.tries_of_heuristics += 1
            ticks_to_goal = {robot.robot.id: robot.ticks_to_goal for robot in self.encoding.robots}
            check = self.deadline.part(PARTS).check
            self.best = plans_of_all(self.instance, ticks_to_goal, check, self.lower, seed=tries)
        self.deadline.check()

    @property
    def evidence(self) -> Evidence:
        rest = [position for position in range(len(self.encoding.robots)) if position not in self.order]
        horizons = tuple(max(robot.horizon, self.horizon) for robot in self.encoding.robots)
        return Evidence(horizons, (*self.order, *rest))

    @property
    def lower(self) -> int:
        return max(self.encoding.shortest + self.delay, self.proved)

    def optimal(self, plans: Sequence[Plan]) -> Optimum:
        cost = total_cost(self.instance, plans)
        require_kept(self.lower, cost)
        return Optimum(
            self.encoding.shortest,
            cost,
            cost,
            decided=True,
            solution=self.solution(plans),
            evidence=self.evidence,
        )

    def unsolvable(self, obstacle: Obstacle) -> Optimum:
        return Optimum(self.encoding.shortest, None, self.lower, True, None, self.evidence, obstacle)

    def undecided(self) -> Optimum:
        beside = None if self.beside is None else self.beside.latest()
        self.best = self.cheaper(self.best, beside)
        if self.best is None:
            return Optimum(
                self.encoding.shortest, None, self.lower, decided=False, solution=None, evidence=self.evidence
            )
        cost = total_cost(self.instance, self.best)
        require_kept(self.lower, cost)
        return Optimum(
            self.encoding.shortest, cost, self.lower, cost == self.lower, self.solution(self.best), self.evidence
        )

    def solution(self, plans: Sequence[Plan]) -> Solution:
        """The solution with these plans; raises `ContradictionError` if they break the law."""
        solution = Solution(tuple(plans), tuple(plan.robot for plan in plans))
        verdict = judge(self.instance, solution)
        if verdict.violations or verdict.unplanned:
            raise ContradictionError("the search has found plans that break a rule")
        return solution
