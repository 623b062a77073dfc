"""Prioritized planning of a fleet, as `carp_reference.orderings` has it: CARP in an order, or the cheapest first."""

from collections.abc import Callable, Sequence

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import NONE, UNASKED
from carp_spec import Shuffled
from carp_spec.permutations import shuffle, splitmix64

PART = 64  # robots of a pass in one compiled call


def carp(fleet: PlannedFleet, order: Sequence[int]) -> None:
    """Plan the robots in order, as if there were no plans yet."""
    fleet.clear()
    fleet.forget()
    plan_in_order(fleet, np.array(order, np.int32), fleet.held, 0)


def shuffled(
    fleet: PlannedFleet, planner: Shuffled, order: Sequence[int], advance: Callable[[], None], now: int = 0
) -> None:
    """The best of several passes of CARP; robots that have a plan keep what they did until now."""
    followed = fleet.held.copy()
    fleet.clear()
    stream = splitmix64(planner.seed)
    best_worth: tuple[int, int] | None = None
    best = np.zeros(0, np.int32), np.zeros(0, np.int32)
    for attempt in range(planner.attempts):
        order = order if attempt == 0 else shuffle(order, stream)
        used = fleet.state.records.used.copy()
        robots = np.array(order, np.int32)
        plans = plan_in_order(fleet, robots, followed, now)
        found = plans != NONE
        worth = (-int(found.sum()), fleet.cost(plans[found]))
        fleet.clear()
        if best_worth is None or worth < best_worth:
            best_worth, best = worth, (robots[found], plans[found])
        else:
            fleet.state.records.used[:] = used
        advance()
    fleet.reserve(*best)


def greedy(fleet: PlannedFleet, advance: Callable[[], None]) -> None:
    """Plan all robots, as if there were no plans yet, each time the one whose plan is cheapest."""
    fleet.clear()
    count = fleet.held.size
    robots, plans = np.zeros(count, np.int32), np.full(count, NONE, np.int32)

    def rounds() -> int:
        waiting, found = np.arange(count, dtype=np.int32), np.full(count, UNASKED, np.int32)
        return passes.greedy(fleet.native, waiting, found, robots, plans, fleet.reuse.unchanged)

    planned = fleet.call(rounds)
    fleet.hold(robots[:planned], plans[:planned])
    for _ in range(planned):
        advance()


def plan_in_order(fleet: PlannedFleet, robots: Ints, followed: Ints, now: int) -> Ints:
    """Plan robots in order, where there are no plans yet, and hold the plans found.

    `followed` are the plans followed until now, by robot. A part at a time, so that little is done again where there
    was too little room.
    """
    plans = np.full(robots.size, NONE, np.int32)
    for first in range(0, robots.size, PART):
        part, found = robots[first : first + PART], plans[first : first + PART]

        def attempt(part: Ints = part, found: Ints = found, first: int = first) -> None:
            passes.carp(fleet.native, part, followed, now, found, first)

        fleet.call(attempt)
        held = plans[: first + PART]
        fleet.hold(robots[: first + PART][held != NONE], held[held != NONE])
    return plans
