"""A lower bound and plans that come ever closer, searched for beside the core-guided search.

First an annealing gives plans. Then plans of a total of at most a few ticks above the bound are searched for, again and
again: there are none, which raises the bound, or the cheapest ones are found, and these are the optimum. Prices give a
lower bound (`carp_optimum.bound`), and such a search is a formula (`carp_optimum.sat.priced_formula`). Where the bound
is too far from the total for formulas, only the plans get better. For a crowd it is half of a search by branching
(`carp_optimum.branching.branching`); another one does the other half.

Each stage gives the work of the next one before it begins. So one who asks for the results of less work need not wait.
"""

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from functools import partial
from typing import TypeAlias

from carp_optimum.branching.branching import Branching
from carp_optimum.lagrangian.reduced_costs import PricedBound
from carp_optimum.sat import heuristics
from carp_optimum.sat.between import Between
from carp_optimum.sat.priced_formula import priced_formula
from carp_optimum.sat.solver import Solver
from carp_spec import Instance, Plan, Refusal, total_cost

PRICE_STEPS = 1600  # of the search for prices that comes first
LARGEST_GAP = 12  # ticks
STRIDE, STRIDE_OF_CROWD = 2, 1
"""The largest total of a search is this far above the lower bound: one for each total would take twice the time.

For a crowd each tick more takes two to three times as long, so a search that goes too far costs more.
"""
CONFLICTS = 300
"""After this many conflicts a formula's search gives the work that it has done."""
WORK_OF_STEP, WORK_OF_STEP_BY_TEN_RESOURCES = 120, 6
"""The propagations of a step of the search for prices, for each robot, and more on a larger graph."""
WORK_OF_PAIR = 2500
"""The propagations of making a formula or a branching, for each robot and each other one."""


Results: TypeAlias = Iterator[tuple[int, Between]]
"""The bound and plans so far, with the work for them in propagations of a solver, up to an optimum."""


def narrowed(instance: Instance, look: Callable[[], None]) -> Results:
    """The results of annealing, prices and formulas.

    `look` is called now and then, and may end it by an exception. Raises `Refusal` for numbers that are too large.
    """
    from carp_optimum.bound import lower_bound  # noqa: PLC0415 - slow to load

    work, known, better = yield from _planned(instance, look)
    robots = len(instance.robots)
    work_of_step = WORK_OF_STEP + WORK_OF_STEP_BY_TEN_RESOURCES * len(instance.graph.resources) // 10
    work += PRICE_STEPS * work_of_step * robots
    yield work, known
    enough = None if known.total is None else known.total - STRIDE
    certificate = lower_bound(instance, steps=PRICE_STEPS, on_step=lambda _: look(), enough=enough)
    bound = PricedBound(instance, certificate)
    known = replace(known, lower=certificate.bound)
    work, known = yield from _raised(
        known,
        work,
        STRIDE,
        lambda most: _Formula(instance, bound, most, look),
        lambda lower: bound.gap(lower) <= LARGEST_GAP * bound.scale,
    )
    yield work, known
    if not known.is_optimum:
        for further, plans in better:
            known = known.with_plans(plans)
            yield work + further, known


def half_narrowed(instance: Instance, look: Callable[[], None], half: int) -> Results:
    """The results of annealing and branching for a crowd; the bound is that of half of the parts (`Between.of_all`).

    Both halves begin with the same plans and bound. So they ask for the same totals, and share the same parts. It ends
    at once without plans, and where its tables would be too large.
    """
    work, known, _ = yield from _planned(instance, look)
    if known.total is not None:
        with suppress(Refusal):
            known = replace(known, lower=Branching(instance, known.total - 1, look).least_of_all())
        branching = partial(Branching, instance, look=look, half=half)
        work, known = yield from _raised(known, work, STRIDE_OF_CROWD, branching)
        yield work, known


def _planned(
    instance: Instance, look: Callable[[], None]
) -> Generator[tuple[int, Between], None, tuple[int, Between, Iterator[tuple[int, Sequence[Plan]]]]]:
    """The plans of a first annealing, if any: the work, what is known, and where better plans come from."""
    known = Between(instance)
    better = heuristics.ever_better(instance, look)
    work = heuristics.WORK_OF_ANNEALING * len(instance.robots)
    yield work, known
    _, plans = next(better, (work, None))
    known = known.with_plans(plans)
    yield work, known
    return work, known, better


def _raised(
    known: Between,
    work: int,
    stride: int,
    search_for: Callable[[int], "_Formula | Branching"],
    is_near: Callable[[int], bool] = lambda _: True,
) -> Generator[tuple[int, Between], None, tuple[int, Between]]:
    """The results of searches for plans of at most ever larger totals, as long as the bound is near enough for them.

    It ends where a search is refused. Returns the work and the last result.
    """
    while not known.is_optimum and is_near(known.lower):
        yield work, known
        work += WORK_OF_PAIR * len(known.instance.robots) ** 2
        yield work, known
        most = known.lower + stride
        if known.total is not None:
            most = min(most, known.total - 1)
        try:
            search = search_for(most)
        except Refusal:
            break
        for further in search.run():
            known = known.with_plans(search.plans)
            yield work + further, known
        work += search.work
        known = replace(known.with_plans(search.plans), lower=search.least)
    return work, known


class _Formula:
    """A search by a formula with prices for the cheapest plans of at most a total, as `Branching` is one."""

    def __init__(self, instance: Instance, bound: PricedBound, most: int, look: Callable[[], None]) -> None:
        self.priced = priced_formula(instance, bound, most, look)
        self.look = look
        self.plans: Sequence[Plan] | None = None
        self.least = most + 1
        self.work = 0

    def run(self) -> Iterator[int]:
        """Search, and give the work so far now and then."""
        encoding = self.priced.encoding
        with closing(Solver(encoding.formula, self.look, glucose=True)) as solver:
            while (answer := solver.satisfiable([], CONFLICTS)) is not False:
                if answer:
                    self.plans = encoding.plans(solver.model())
                    self.least = total_cost(encoding.instance, self.plans)
                    self.priced.require_less(self.least)
                yield solver.work
            self.work = solver.work
