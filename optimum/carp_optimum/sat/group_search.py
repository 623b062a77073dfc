"""Better plans by planning groups of 8 to 24 robots together, while the others keep their plans.

A polish plans one robot after the other, and ends where no such change helps. Here one formula has all plans whose
delays are little above those of the plans known, and its solver keeps what it learns. A try assumes the plans of the
robots outside of a group, and a lower total. Groups are drawn: a robot that is late, then robots that are near one of
the group. Where groups of one size fail, larger ones are tried, and in the end longer delays. Nothing here is trusted:
the law judges the plans.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from itertools import count
from random import Random

from carp_optimum.sat.solver import Solver
from carp_spec import Instance, Plan, Solution, judge, total_cost
from carp_verify.bound.rules import ContradictionError
from carp_verify.optimum.clauses import Literal
from carp_verify.optimum.encoding import Encoding

SIZES = (8, 12, 16, 24)
FAILURES = 6
"""After this many tries in a row that find nothing, groups of the next size are tried."""
CONFLICTS = 2000
"""A try ends after this many conflicts."""
WORK_TO_MAKE, WORK_TO_TRY = 60, 5
"""The propagations that making a clause of a formula is worth, and each try."""
MARGIN = 2
"""The delay that the first formula gives each robot beyond that of its plan."""
MOST_CLAUSES = 4_000_000


def improved(
    instance: Instance, plans: Sequence[Plan], look: Callable[[], None]
) -> Iterator[tuple[int, Sequence[Plan]]]:
    """After each try the best plans so far, with the work for them in propagations; it ends where no robot is late.

    `plans` are lawful ones of all robots. Raises `Refusal` if a formula gets too large. `look` may end it by an
    exception.
    """
    random = Random(0)  # noqa: S311 - not for secrets
    work = 0
    for margin in count(MARGIN):
        search = _GroupSearch(instance, plans, margin, look)
        with closing(search.solver):
            clauses = len(search.encoding.formula.clauses)
            work += clauses * WORK_TO_MAKE
            for size in SIZES:
                failures = 0
                while failures < FAILURES and search.delays:
                    failures = 0 if search.improves(search.group(random, size)) else failures + 1
                    plans = search.plans
                    work += clauses * WORK_TO_TRY
                    yield work + search.solver.work, plans
            work += search.solver.work
        if not search.delays:
            return


class _GroupSearch:
    """The formula of plans with delays that are little above those of the plans known."""

    def __init__(self, instance: Instance, plans: Sequence[Plan], margin: int, look: Callable[[], None]) -> None:
        self.instance = instance
        by_robot = {plan.robot: plan for plan in plans}
        self.plans = [by_robot[robot.id] for robot in instance.robots]
        self.encoding = Encoding(instance, look, MOST_CLAUSES)
        self.encoding.grow_to([delay + margin for delay in map(self.delay, range(len(plans)))])
        self.encoding.close()
        self.encoding.forbid_all()
        delays = [robot.late for robot in self.encoding.robots]
        self.total = self.encoding.formula.at_least(delays, self.delays + 1)
        self.solver = Solver(self.encoding.formula, look, glucose=True)
        self.near = self.nearness()

    def delay(self, position: int) -> int:
        """The delay of a robot's plan."""
        return total_cost(self.instance, [self.plans[position]]) - (self.encoding.robots[position].shortest or 0)

    @property
    def delays(self) -> int:
        """The delays of all plans."""
        return sum(map(self.delay, range(len(self.plans))))

    def nearness(self) -> Sequence[Mapping[int, int]]:
        """For each robot, for how many ticks which others are in the same resource or beside it."""
        end = max(plan.visits[-1].enter for plan in self.plans) + 1
        stays = [
            [(visit.resource, tick) for visit in plan.visits for tick in range(visit.enter, visit.leave or end)]
            for plan in self.plans
        ]
        present = defaultdict(list)
        for position, stay in enumerate(stays):
            for place in stay:
                present[place].append(position)
        successors = self.instance.graph.successors
        return [
            Counter(
                other
                for resource, tick in stay
                for place in (resource, *successors[resource])
                for other in present.get((place, tick), ())
            )
            for stay in stays
        ]

    def group(self, random: Random, size: int) -> Sequence[int]:
        """A group of this many robots, or of all: one that is likely late, and others that are likely near."""
        everyone = range(len(self.plans))
        group = random.choices(everyone, [5 * self.delay(position) + 1 for position in everyone])
        while len(group) < min(size, len(everyone)):
            near = self.near[random.choice(group)]
            weights = [0 if position in group else 20 * near.get(position, 0) + 1 for position in everyone]
            group += random.choices(everyone, weights)
        return group

    def improves(self, group: Sequence[int]) -> bool:
        """Whether plans of the group of a lower total are found; they are taken, as good as a few tries make them."""
        fixed = [
            literal
            for position in range(len(self.plans))
            if position not in group
            for literal in self.literals(position)
        ]
        improves = False
        while self.delays and self.solver.satisfiable([*fixed, -self.total[self.delays - 1]], CONFLICTS):
            self.take(self.encoding.plans(self.solver.model()))
            improves = True
        return improves

    def take(self, plans: Sequence[Plan]) -> None:
        """Take plans of all robots; raises `ContradictionError` if they break the law, or have no lower total."""
        verdict = judge(self.instance, Solution(tuple(plans), tuple(plan.robot for plan in plans)))
        if verdict.violations or verdict.unplanned or verdict.cost >= total_cost(self.instance, self.plans):
            raise ContradictionError("the plans in a model of a formula are not what the formula describes")
        self.plans = list(plans)
        self.near = self.nearness()

    def literals(self, position: int) -> Iterator[Literal]:
        """Literals that hold together only if the robot keeps its plan, or one of the same visits and delay."""
        robot, plan, delay = self.encoding.robots[position], self.plans[position], self.delay(position)
        for visit in plan.visits[:-1]:
            ready = visit.enter + self.instance.duration(plan.robot, visit.resource)
            for tick in range(ready, (visit.leave or ready) + 1):
                yield robot.node[visit.resource, tick]
        if delay > 0:
            yield robot.late[delay - 1]
        yield -robot.late[delay]
