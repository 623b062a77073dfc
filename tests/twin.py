"""The naive planner for robots under way: it keeps what they have done, and searches on by ticks."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from carp_reference.time_expanded import Table, entries, search, table_of, visits_of
from carp_spec import Instance, Plan, RobotId, Visit, has_ended
from carp_spec.plan_rules import stops_served


def find_plan_by_ticks(
    instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0, before: Plan | None = None
) -> Plan | None:
    """A plan with the earliest arrival that keeps the visits of `before` up to the tick now, or `None`."""
    table = table_of(instance, committed)
    if before is not None and has_ended(before, now):
        return before if allows(table, before.visits) else None
    request = instance.robot[robot]
    entered = [] if before is None else [visit for visit in before.visits if visit.enter <= now]
    *past, current = entered or [Visit(request.start, request.release, None)]
    *stops, last_stop = request.stops
    due = current.enter + instance.duration(robot, current.resource)
    ready = max(due, now)
    if not allows(table, [*past, Visit(current.resource, current.enter, ready)]):
        return None
    served = stops_served(stops, past)
    starts = []
    for start in entries(table, robot, current.resource, current.enter, served, None):
        is_in_time = current.enter + instance.stay(robot, last_stop) >= now or instance.after_goal == "park"
        rest = max(start.rest, ready - current.enter - 1)
        starts.append(replace(start, rest=rest, arrived=start.arrived and is_in_time))
    last = search(table, robot, starts)
    return None if last is None else Plan(robot, (*past, *visits_of(instance, robot, last)))


def allows(table: Table, visits: Sequence[Visit]) -> bool:
    """Whether one more robot could make these visits."""
    stays = all(table.is_free_during(visit.resource, visit.enter, visit.leave) for visit in visits)
    return stays and not any(table.is_exchange(to.enter, at.resource, to.resource) for at, to in pairwise(visits))
