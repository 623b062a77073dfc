"""The distance of planners from the optimum, in two parts: the price of planning in an order, and of searching one.

A prioritized planner can at best find the least total over all orders. The distance of that total from the optimum is
the price of prioritized planning. The distance of a planner's total from it is the price of its search for an order. It
is below zero if the planner does better than any order, as one that replans robots may.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

from carp_optimum.deadline import Deadline, TimeOver
from carp_optimum.optimum import optimum
from carp_optimum.sat.core_guided import Optimum
from carp_reference import plan, query
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Instance,
    LongestFirst,
    Neighbourhood,
    Plan,
    Planner,
    Shuffled,
    plan_cost,
    total_cost,
)
from carp_spec.inputs.options import SEARCH_SECONDS
from carp_spec.limits import goals_stand_alone
from carp_verify.bound.rules import require_kept
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.rules import MOST_ORDERED, refuse_size

PLANNERS: tuple[Planner, ...] = (Carp(), Shuffled(), LongestFirst(), Greedy(), FixedPaths(), Neighbourhood())
"""The planners that are compared where none are named."""


@dataclass(frozen=True, slots=True)
class PlannerGap:
    """A planner's total cost and the number of its unplanned robots; the total alone means nothing."""

    planner: Planner
    total: int
    unplanned: int


@dataclass(frozen=True, slots=True)
class Gap:
    """The optimum, the least total over all orders (`None`: none, or not known), and what planners reach."""

    optimum: Optimum
    best_order: int | None
    planners: tuple[PlannerGap, ...]


def gap(instance: Instance, planners: Sequence[Planner] = PLANNERS, limit: float = SEARCH_SECONDS) -> Gap:
    """Plan with every planner, and search for the optimum and for the best order, each for `limit` seconds at most.

    Where robots have stops, fixed paths are compared only if others than all planners are named.
    """
    best = optimum(instance, limit)
    reached = []
    knows_all = planners is not PLANNERS or goals_stand_alone(instance)
    for planner in planners if knows_all else [each for each in planners if each != FixedPaths()]:
        solution = plan(instance, planner)
        total = total_cost(instance, solution.plans)
        if not solution.unplanned:
            require_kept(best.lower, total)
        reached.append(PlannerGap(planner, total, len(solution.unplanned)))
    order = None
    if len(instance.robots) <= MOST_ORDERED:
        with suppress(TimeOver):
            order = best_order(instance, limit, best.lower)
    return Gap(best, order, tuple(reached))


def best_order(instance: Instance, limit: float, floor: int = 0) -> int | None:
    """The least total cost over all orders in which CARP plans all robots, or `None` if it fails in every order.

    Orders that begin alike share their plans, and an order is abandoned once it cannot beat the best. No total is less
    than `floor`; if an order reaches it, the others are not tried. Raises `TimeOver` after `limit` seconds, and
    `Refusal` for more than `MOST_ORDERED` robots.
    """
    refuse_size("the robots whose orders are all tried", len(instance.robots), MOST_ORDERED)
    encoding = Encoding(instance)
    if encoding.wayless:
        return None
    shortest = {robot.robot.id: robot.shortest or 0 for robot in encoding.robots}
    deadline = Deadline(limit)

    def best(plans: list[Plan], total: int, known: int | None) -> int | None:
        """The least total over the orders that begin with the plans, if it is less than what is known."""
        deadline.check()
        planned = {each.robot for each in plans}
        if len(planned) == len(instance.robots):
            return total
        for robot in instance.robots:
            if robot.id in planned or (known is not None and max(total, floor) >= known):
                continue
            following = query(instance, plans, robot.id)
            if following is not None:
                later = total + plan_cost(instance, following) - shortest[robot.id]
                if known is None or later < known:
                    known = best([*plans, following], later, known)
        return known

    return best([], encoding.shortest, None)
