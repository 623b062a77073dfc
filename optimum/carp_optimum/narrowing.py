"""A lower bound and plans that come ever closer, searched for beside the core-guided search (`carp_optimum.optimum`).

First an annealing gives plans, and prices a lower bound (`carp_optimum.bound`). From there up, a few totals at a time,
the formula of all plans of at most such a total (`carp_optimum.priced_formula`) either has no model, which raises the
bound, or one, which gives better plans, until the bound is the total of the best plans. Where the bound is too far from
the total for such formulas, only the plans get better.

Each stage gives the work of the next one before it begins. So one who asks for the results of less work need not wait.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from carp_optimum import heuristics
from carp_optimum.priced_formula import priced_formula
from carp_optimum.reduced_costs import PricedBound
from carp_optimum.solver import Solver
from carp_spec import Instance, Plan, Refusal, total_cost

PRICE_STEPS = 1600
LARGEST_GAP = 12  # ticks
STRIDE = 2
"""A formula's largest total is this far above the lower bound: one for each total would take twice the time."""
CONFLICTS = 300
"""After this many conflicts a formula's search gives the work that it has done."""
WORK_OF_STEP, WORK_OF_STEP_BY_TEN_RESOURCES = 120, 6
"""The propagations of a step of the search for prices, for each robot, and more on a larger graph."""
WORK_OF_PAIR = 2500
"""The propagations of making a formula with prices, for each robot and each other one."""


@dataclass(frozen=True, slots=True)
class Between:
    """No plans of all robots cost less than `lower` ticks, and `plans`, if any, are the best known."""

    instance: Instance
    lower: int = 0
    plans: Sequence[Plan] | None = None

    @property
    def total(self) -> int | None:
        """The total cost of the plans."""
        return None if self.plans is None else total_cost(self.instance, self.plans)

    @property
    def is_optimum(self) -> bool:
        """Whether no plans cost less than these."""
        return self.total is not None and self.total <= self.lower

    def with_plans(self, plans: Sequence[Plan]) -> "Between":
        """These plans instead, if they cost less."""
        better = self.total is None or total_cost(self.instance, plans) < self.total
        return replace(self, plans=plans) if better else self


def narrowed(instance: Instance, look: Callable[[], None]) -> Iterator[tuple[int, Between]]:
    """The bound and plans so far, with the work for them in propagations of a solver, up to an optimum.

    `look` is called now and then, and may end it by an exception. Raises `Refusal` for numbers that are too large.
    """
    known = Between(instance)
    better = heuristics.ever_better(instance, look)
    robots = len(instance.robots)
    work = heuristics.ROUNDS * heuristics.WORK_OF_ROUND * robots
    yield work, known
    for _, plans in better:
        known = known.with_plans(plans)
        break
    yield work, known
    work_of_step = WORK_OF_STEP + WORK_OF_STEP_BY_TEN_RESOURCES * len(instance.graph.resources) // 10
    work += PRICE_STEPS * work_of_step * robots
    yield work, known
    bound = _priced_bound(instance, look)
    known = replace(known, lower=bound.certificate.bound)
    while not known.is_optimum and bound.gap(known.lower) <= LARGEST_GAP * bound.scale:
        yield work, known
        work += WORK_OF_PAIR * robots**2
        yield work, known
        most = known.lower + STRIDE
        if known.total is not None:
            most = min(most, known.total - 1)
        try:
            search = _Formula(instance, bound, most, look)
        except Refusal:
            break
        for further in search.run():
            if search.plans is not None:
                known = known.with_plans(search.plans)
            yield work + further, known
        work += search.work
        known = replace(known, lower=search.least)
    yield work, known
    if not known.is_optimum:
        for further, plans in better:
            known = known.with_plans(plans)
            yield work + further, known


def _priced_bound(instance: Instance, look: Callable[[], None]) -> PricedBound:
    from carp_optimum.bound import lower_bound  # noqa: PLC0415 - slow to load

    return PricedBound(instance, lower_bound(instance, steps=PRICE_STEPS, on_step=lambda _: look(), seen=False))


class _Formula:
    """The search for the cheapest plans of at most a total; after it, no plans cost less than `least`."""

    def __init__(self, instance: Instance, bound: PricedBound, most: int, look: Callable[[], None]) -> None:
        self.priced = priced_formula(instance, bound, most, look)
        self.look = look
        self.plans: Sequence[Plan] | None = None
        self.least = most + 1
        self.work = 0

    def run(self) -> Iterator[int]:
        """Search, and give the work so far now and then, and where `plans` are better."""
        encoding = self.priced.encoding
        solver = Solver(encoding.formula, self.look, glucose=True)
        try:
            while (answer := solver.satisfiable([], CONFLICTS)) is not False:
                if answer:
                    self.plans = [plan for plan in encoding.plans(solver.model()) if plan is not None]
                    self.least = total_cost(encoding.instance, self.plans)
                    self.priced.require_less(self.least)
                yield solver.work
            self.work = solver.work
        finally:
            solver.close()
