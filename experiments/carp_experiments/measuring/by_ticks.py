"""Windows, queries and small optima against searches that count robots tick by tick."""

from collections.abc import Iterator, Sequence

import carp_optimized
from carp_optimum.optimum import optimum
from carp_reference.time_expanded import find_plan_by_ticks
from carp_spec import Instance, Plan, ResourceId
from carp_spec.windows import constraints_on, free_windows
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import joint_states, least_total_cost

FEW_STATES = 4000
SECONDS = 60
LATER = 3
"""Ticks after the last change that are looked at too."""


def faults_by_ticks(instance: Instance, plans: Sequence[Plan]) -> Iterator[str]:
    """What differs, beside the plans, from what is found tick by tick."""
    last = max((tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave or 0)), default=0)
    for resource in instance.graph.resources:
        windows = free_windows(constraints_on(instance.graph, plans, resource.id), instance.gap)
        for tick in range(last + LATER):
            is_free = all(has_room(instance, plans, resource.id, each) for each in (tick, tick + instance.gap))
            if is_free != any(each.start <= tick and each.lasts_until(tick + 1) for each in windows):
                yield f"{resource.id} is {'' if is_free else 'not '}free at {tick}"
    for robot in instance.robot:
        others = [plan for plan in plans if plan.robot != robot]
        found, by_ticks = carp_optimized.find(instance, others, robot), find_plan_by_ticks(instance, others, robot)
        arrivals = [None if plan is None else plan.visits[-1].enter for plan in (found, by_ticks)]
        if arrivals[0] != arrivals[1]:
            yield f"robot {robot} arrives at {arrivals[0]}, and by ticks at {arrivals[1]}"
    if instance.following == "allowed" and joint_states(instance) <= FEW_STATES and not Encoding(instance).wayless:
        best, least = optimum(instance, SECONDS), least_total_cost(instance)
        if not best.decided or best.cost != least:
            yield f"the optimum is {best.cost}, and by ticks {least}"


def has_room(instance: Instance, plans: Sequence[Plan], resource: ResourceId, tick: int) -> bool:
    """Whether one robot more fits into the resource, and into each group of it, counted at the tick."""
    return all(
        sum(
            any(
                visit.resource in each.resources
                and visit.enter <= tick
                and (visit.leave is None or tick < visit.leave + instance.gap)
                for visit in plan.visits
            )
            for plan in plans
        )
        < each.capacity
        for each in instance.graph.constraints
        if resource in each.resources
    )
