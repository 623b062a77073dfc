"""Plans that no robot can better by itself, in an order that shows it.

A robot that was planned before others goes around plans that these no longer have, once a repair or a round of a polish
has changed them. So each is planned again beside all others, until none arrives earlier. Then plans are put into an
order in which none is late beside those before it, as far as there is one: what an audit asks.
"""

from collections.abc import Callable

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import ALONE, NONE
from carp_spec import Instance, Solution


def settle(fleet: PlannedFleet, goes_on: Callable[[], bool] = lambda: True, now: int = 0, asked: int = ALONE) -> bool:
    """Settle the plans of a fleet, as long as there is time; whether robots got plans, or better ones.

    Robots keep what they have done until now. At tick 0 those without a plan get one where there is room for it. Where
    plans are asked for `SOON`, some better ones may be missed.
    """
    before = fleet.worth
    _plan_all_again(fleet, goes_on, now, asked)
    if now == 0:
        put_in_order(fleet, goes_on, asked)
    return fleet.worth < before


def _plan_all_again(fleet: PlannedFleet, goes_on: Callable[[], bool], now: int, asked: int) -> None:
    robots = range(len(fleet.instance.robots)) if now == 0 else fleet.order
    is_better = True
    while is_better:
        is_better = False
        for robot in robots:
            if not goes_on():
                return
            fleet.forget_old_records()
            is_better |= plan_again(fleet, robot, now, asked)


def plan_again(fleet: PlannedFleet, robot: int, now: int = 0, asked: int = ALONE) -> bool:
    """Plan a robot beside the plans of all others; whether it has none so far, or one that arrives later.

    If so, it comes last in the planning order; if not, all is as before. It keeps what it has done until now.
    """
    own, order = np.array([robot], np.int32), fleet.planned
    held = fleet.held[own]
    fleet.withdraw(own)
    followed = int(held[0]) if now > 0 else NONE
    found = _found(fleet, robot, followed, now, asked)
    is_better = bool(found[0] != NONE and (held[0] == NONE or fleet.cost(found) < fleet.cost(held)))
    if is_better:
        fleet.reserve(own, found)
    elif held[0] != NONE:
        fleet.reserve(own, held)
        fleet.hold(order, fleet.held[order])
    return is_better


def _found(fleet: PlannedFleet, robot: int, followed: int = NONE, now: int = 0, asked: int = ALONE) -> Ints:
    return np.full(1, fleet.call(lambda: passes.find_one(fleet.native, robot, followed, now, asked)), np.int32)


def put_in_order(fleet: PlannedFleet, goes_on: Callable[[], bool], asked: int = ALONE) -> None:
    """Put plans of tick 0 into an order in which none is late beside those before it, as far as there is one.

    A plan that is best beside some plans stays so beside more: it is next as soon as it is. Others come last, and
    so do those for which there is no time.
    """
    if not goes_on():
        return
    records, waiting, last = fleet.held.copy(), [*fleet.order], -1
    fleet.clear()
    while len(waiting) != last and goes_on():
        last = len(waiting)
        for robot in tuple(waiting):
            own = np.array([robot], np.int32)
            if goes_on() and _is_best(fleet, robot, records[own], asked):
                waiting.remove(robot)
                fleet.reserve(own, records[own])
    rest = np.array(waiting, np.int32)
    fleet.reserve(rest, records[rest])


def _is_best(fleet: PlannedFleet, robot: int, record: Ints, asked: int) -> bool:
    """Whether the robot, which has no plan now, could not arrive earlier than by that one."""
    used = fleet.state.records.used.copy()
    found = _found(fleet, robot, asked=asked)
    is_best = found[0] != NONE and fleet.cost(found) == fleet.cost(record)
    fleet.state.records.used[:] = used
    return bool(is_best)


def settled(
    instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True, asked: int = ALONE
) -> Solution:
    """The same for a solution, which breaks no rule."""
    fleet = PlannedFleet(instance)
    fleet.commit_solution(solution)
    settle(fleet, goes_on, asked=asked)
    return Solution.of(instance, fleet.plans)
