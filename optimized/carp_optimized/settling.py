"""Plans that no robot can better by itself, in an order that shows it.

A robot that was planned before others goes around plans that these no longer have, once a repair or a round of a polish
has changed them. So each is planned again beside all others, until none arrives earlier. Then plans are put into an
order in which none is late beside those before it, as far as there is one: what an audit asks.
"""

from collections.abc import Callable

from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Solution


def settle(fleet: PlannedFleet, goes_on: Callable[[], bool] = lambda: True, now: int = 0) -> bool:
    """Settle the plans of a fleet, as long as there is time; whether robots got plans, or better ones.

    Robots keep what they have done until now. At tick 0 those without a plan get one where there is room for it.
    """
    before = fleet.worth
    _plan_again(fleet, goes_on, now)
    if now == 0:
        fleet.put_in_order(goes_on)
    return fleet.worth < before


def _plan_again(fleet: PlannedFleet, goes_on: Callable[[], bool], now: int) -> None:
    robots = range(len(fleet.instance.robots)) if now == 0 else fleet.order
    is_better = True
    while is_better:
        is_better = False
        for robot in robots:
            if not goes_on():
                return
            fleet.forget_old_records()
            is_better |= fleet.plan_again(robot, now)


def settled(instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True) -> Solution:
    """The same for a solution, which breaks no rule."""
    fleet = PlannedFleet(instance)
    fleet.commit_solution(solution)
    settle(fleet, goes_on)
    return Solution.of(instance, fleet.plans)
