"""Plans in the time that a person has: the best ones that can be had in it.

Robots that move a step a tick (classical MAPF) are planned by `carp_optimized.improve.planning`, which looks at the
clock after each few milliseconds. All others are planned by CARP, the shortest way first, as long as there is time, and
then by a repair and an annealing, if there is enough time for these. Nothing here is trusted: the law judges the plans.
"""

from collections.abc import Callable
from time import perf_counter

import carp_optimized
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.annealing import anneal
from carp_optimized.improve.planning import plan_crowd
from carp_spec import Instance, Solution
from carp_spec.inputs.options import require_polish_options
from carp_spec.inputs.values import require_instance

SECONDS = 10.0
"""The time, unless one is given."""
ENOUGH = 4
"""The annealing begins if CARP has left this many times its own time, as it takes up the plans again."""
AMPLE = 20
"""A repair of robots that are left out begins if CARP has taken at most one of this many parts of the time."""


def plan_within(
    instance: Instance,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
) -> Solution:
    """The best plans that are found in that many seconds, 10 unless given; `advance` gets rounds, unplanned and total.

    With `iterations`, first plans are improved by that many rounds: equal iterations and seed give an equal solution
    on every machine. With seconds they need not. Robots that have no plan when the time is over are unplanned. The
    compilation of the planner, which happens once, is not part of the time: `python -m carp_optimum` makes it happen.
    Raises `Refusal` for wrong options, and for numbers that are too large.
    """
    require_instance(instance)
    require_polish_options(iterations, seconds, seed)
    if iterations is None and seconds is None:
        seconds = SECONDS
    started = clock()
    found = plan_crowd(instance, iterations=iterations, seconds=seconds, seed=seed, advance=advance, clock=clock)
    if found is not None:
        return found
    solution = _first_plans(instance, lambda: seconds is None or clock() - started < seconds)
    if seconds is None:
        return carp_optimized.polish(instance, solution, iterations=iterations, seed=seed, advance=advance)
    spent = clock() - started
    left = seconds - ENOUGH * spent
    if left <= 0:
        return solution
    repairs = AMPLE * spent < seconds
    return anneal(instance, solution, seconds - spent, seed=seed, advance=advance, clock=clock, repairs=repairs)


def _first_plans(instance: Instance, goes_on: Callable[[], bool]) -> Solution:
    """The plans of CARP, the shortest way first, for as many robots as there is time for."""
    fleet = PlannedFleet(instance)
    for robot in sorted(range(len(instance.robots)), key=fleet.ticks_to_goal):
        if not goes_on():
            break
        plan = fleet.find(robot, None, 0)
        if plan is not None:
            fleet.commit([plan])
    return Solution.of(instance, fleet.plans)
