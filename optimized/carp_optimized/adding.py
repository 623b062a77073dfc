"""A robot added to a fleet, or planned again with further stops, together with robots near it (Algorithm 1)."""

import numpy as np

from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.adding import add_robot
from carp_optimized.orderings import shuffled
from carp_optimized.state import limits
from carp_optimized.state.arrays import NONE
from carp_spec import Neighbourhood, Plan, Robot, Shuffled


def add(
    fleet: PlannedFleet,
    robot: int,
    now: int,
    options: Neighbourhood,
    number: int | None = None,
    before: Plan | None = None,
) -> bool:
    """Add a robot by the neighbourhood planner; if it stays unplanned, all plans stay as they are.

    Orders are drawn for its `number` in the instance, which is its index unless given. A robot that is to be
    planned again has followed the plan `before` until now.
    """
    limits.refuse_tick("$.now", now)
    fleet.forget_old_records()
    followed = NONE if before is None else fleet.record(before)
    order = np.empty(fleet.planned.size + 1, np.int32)

    def attempt() -> bool:
        adding = fleet.adding_with(options)
        if options.sample is not None:  # orders are drawn
            adding.fields.work.stream[0] = (options.seed + (robot if number is None else number)) % 2**64
        return add_robot(adding, fleet.planned, robot, followed, now, order)

    if fleet.call(attempt):
        fleet.planned = order
        fleet.held = fleet.state.reserved.copy()
        return True
    if options.fallback is None:
        return False
    return _fall_back(fleet, robot, followed, now, Shuffled(options.fallback, options.seed))


def _fall_back(fleet: PlannedFleet, robot: int, followed: int, now: int, planner: Shuffled) -> bool:
    """Plan all robots again in shuffled orders; if one stays unplanned, all plans stay as they are."""
    order, held = fleet.planned, fleet.held[fleet.planned]
    fleet.held[robot] = followed
    shuffled(fleet, planner, [*fleet.order, robot], lambda: None, now)
    if fleet.planned.size == order.size + 1:
        return True
    fleet.clear()
    fleet.reserve(order, held)
    return False


def assign(
    fleet: PlannedFleet,
    robot: Robot,
    before: Robot,
    plan: Plan,
    now: int,
    options: Neighbourhood,
    number: int | None = None,
) -> bool:
    """Plan again, as `add` does, a robot that has other stops than `before`, and has followed the plan until now.

    If it finds no plan, all is as before. What queries have noted may stay: for a robot with stops it is not
    used, and once the robot has vanished, its plan before has ended too, as that left no later.
    """
    index, order = fleet.index(robot.id), fleet.planned
    fleet.withdraw([index])
    fleet.write(robot, index)
    if add(fleet, index, now, options, number, plan):
        return True
    fleet.write(before, index)
    fleet.commit([plan])
    fleet.hold(order, fleet.held[order])
    return False
