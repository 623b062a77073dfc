"""Plans in the time that a person has: the best ones that can be had in it.

Robots that move a step a tick (classical MAPF) are planned by `carp_optimized.improve.planning`, which looks at the
clock after each few milliseconds. All others are planned by CARP, the shortest way first, as long as there is time; if
some get no plan, once more, where each holds its start until it is planned. Then follow a repair and an annealing, if
there is enough time for these. Else those left out take the way of others, who are planned again, and in the end plans
are settled, if there is time. A pass that falls behind, so that half of the time would be too short for it, goes on
with greedy queries, and so does what follows. Nothing here is trusted: the law judges the plans.
"""

from collections.abc import Callable
from time import perf_counter

import numpy as np

import carp_optimized
from carp_optimized.crowds.crowd import crowd_of
from carp_optimized.crowds.distances import landmarks_of, near
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.annealing import BRIEF, anneal
from carp_optimized.improve.ejection import plan_left_out
from carp_optimized.improve.holding import plan_holding_starts
from carp_optimized.improve.planning import Found, plan_crowd, time_of_visit
from carp_optimized.jit.kinds import Longs
from carp_optimized.settling import plan_again, settle, settled
from carp_optimized.state.arrays import ALONE, GREEDY, SOON
from carp_optimized.state.limits import refuse_what_is_too_large
from carp_spec import Instance, Solution
from carp_spec.inputs.options import require_polish_options
from carp_spec.inputs.values import known, require_instance

SECONDS = 10.0
"""The time, unless one is given."""
ENOUGH = 4
"""The annealing begins if CARP has left this many times its own time, as it takes up the plans again."""
AGAIN = 2
"""With less, plans are settled in half of the rest if CARP has left this many times its own time."""
UNHURRIED, PACE = 0.05, 0.45
"""The parts of the time that CARP may take for any robots, and in all for the ways of those that it has planned."""


def plan_within(
    instance: Instance,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
    finish: Callable[[Solution], object] = lambda _: None,
) -> Found:
    """The best plans that are found in that many seconds, as `carproof.plan_within` does.

    The time to `finish` with the solution, which the caller does, is part of the seconds. So is that of compiling.
    """
    started = clock()
    require_instance(instance)
    require_polish_options(iterations, seconds, seed)
    if seconds is None and iterations is None:
        seconds = SECONDS
    refuse_what_is_too_large(instance)
    if not instance.robots:
        return Found(known(instance, Solution((), ())), 0)
    begun, started = started, clock()
    if seconds is not None:
        seconds = max(seconds - (started - begun), BRIEF)
    found = plan_crowd(
        instance, iterations=iterations, seconds=seconds, seed=seed, advance=advance, clock=clock, finish=finish
    )
    if found is not None:
        return found
    visit = 0.0 if seconds is None else time_of_visit(instance, clock, finish)
    fleet = PlannedFleet(instance)
    fleet.ticks_to_goal(0)  # loads machine code, whose time does not count as that of the first plans
    if seconds is not None:
        seconds -= clock() - started
    started = clock()
    fleet, asked = _first_plans(fleet, lambda: clock() - started, seconds, visit)
    solution = Solution.of(instance, fleet.plans)
    if seconds is None:
        solution = carp_optimized.polish(instance, solution, iterations=iterations, seed=seed, advance=advance)
        return Found(settled(instance, solution), None)
    spent = clock() - started
    left = seconds - visit * fleet.visits
    if left > (1 + ENOUGH) * spent:
        solution = anneal(instance, solution, left - spent, seed=seed, advance=advance, clock=clock)
        return Found(solution, None)
    settles = left > AGAIN * spent

    def until(end: float) -> Callable[[], bool]:
        return lambda: clock() - started + visit * fleet.visits < end

    plan_left_out(fleet, until((seconds + spent) / 2 if settles else seconds), asked)
    if settles:
        settle(fleet, until(seconds), asked=SOON if asked == GREEDY else ALONE)
    return Found(Solution.of(instance, fleet.plans), None)


def _first_plans(
    fleet: PlannedFleet, spent: Callable[[], float], seconds: float | None, visit: float
) -> tuple[PlannedFleet, int]:
    """The plans of CARP, the shortest way first, as far as there is time, and how they were asked for."""

    def goes_on(visits: int) -> bool:
        return seconds is None or spent() + visit * visits < seconds

    ways = shortest_ways(fleet)
    order = nearest_first(ways)
    gone, whole, asked = 0, int(ways.sum()) + 1, ALONE
    for robot in order:
        gone += int(ways[robot])
        at = spent()
        if seconds is not None and at + visit * fleet.visits >= seconds:
            break
        is_late = seconds is not None and at > seconds * (UNHURRIED + PACE * gone / whole)
        plan_again(fleet, robot, asked=GREEDY if is_late else ALONE)
        asked = GREEDY if is_late else asked
    if len(fleet.order) < len(order) and (seconds is None or 2 * spent() < seconds):
        other = plan_holding_starts(fleet.instance, order, goes_on, asked)
        if len(other.order) > len(fleet.order):
            fleet = other
    return fleet, asked


def nearest_first(ways: Longs) -> list[int]:
    """The robots, those with the shortest ways first."""
    return [int(robot) for robot in np.argsort(ways, kind="stable")]


def shortest_ways(fleet: PlannedFleet) -> Longs:
    """The ticks of the shortest way of each robot; estimates where not all guides fit, as these would be made twice."""
    if fleet.keeps_all_guides:
        return np.array([fleet.ticks_to_goal(robot) for robot in range(len(fleet.instance.robots))], np.int64)
    crowd = crowd_of(fleet.instance)
    paces = np.array([each.pace for each in fleet.instance.robots], np.int64)
    return np.multiply(near(crowd, landmarks_of(crowd)), paces, dtype=np.int64)
