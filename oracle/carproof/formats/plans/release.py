"""How far robots may go by the planned order."""

from collections import defaultdict
from collections.abc import Mapping

from carp_spec import Instance, RobotId, Solution
from carp_spec.execution.dependencies import dependencies


def released(instance: Instance, solution: Solution, at: int) -> Mapping[RobotId, int]:
    """How many visits of each plan may be released at a tick, if all robots have kept to their plans so far.

    A visit may be released once every robot that is planned to leave its resource, or a group of it, before has left.
    A robot that is not yet released has none. The solution is lawful.
    """
    entries = {(plan.robot, place): visit.enter for plan in solution.plans for place, visit in enumerate(plan.visits)}
    waits: dict[RobotId, list[int]] = defaultdict(list)
    for each in dependencies(instance, solution.plans):
        if each.kind == "order" and entries[each.before] + each.ticks > at:
            robot, place = each.after
            waits[robot].append(place)
    return {
        plan.robot: 0 if instance.robot[plan.robot].release > at else min(waits[plan.robot], default=len(plan.visits))
        for plan in solution.plans
    }
