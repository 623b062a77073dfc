"""Plans of a few robots together, beside the plans of all others, which stay.

This is conflict-based search (Sharon et al. 2015) with priorities between robots (Ma et al. 2019). Each robot is
planned alone among the others. Where two robots of the group meet, one of them must not be where they meet, or must
avoid the whole plan of the other one.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from heapq import heappop, heappush
from itertools import count, islice
from math import inf
from typing import TypeAlias

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.state.arrays import ALONE, NONE
from carp_spec import Group, Instance, Plan, Resource, ResourceGraph, ResourceId, RobotId, Visit, total_cost
from carp_spec.joint_rules import JOINT_RULES
from carp_spec.rule import Violation

STATES = 200
"""The search ends after this number of states."""
Avoided: TypeAlias = tuple[RobotId, Plan]
"""A robot, and the plan of another that it has to avoid, or a visit to a place that is then closed to it."""


def joint_plans(
    instance: Instance, others: Sequence[Plan], group: Sequence[RobotId], states: Iterator[int]
) -> tuple[Plan, ...] | None:
    """Plans of a group that break no rule together with the plans of others; `None` if the search finds none.

    The search takes one of `states` for each state that it expands, and ends when none is left.
    """
    finder = _Finder(instance, others)
    serial = count()
    queue: list[tuple[int, int, int, tuple[Avoided, ...], dict[RobotId, Plan]]] = []

    def push(avoided: tuple[Avoided, ...], plans: dict[RobotId, Plan]) -> None:
        meetings = sum(1 for _ in finder.meetings(tuple(plans.values())))
        heappush(queue, (meetings, total_cost(instance, tuple(plans.values())), next(serial), avoided, plans))

    first = {robot: plan for robot in group if (plan := finder.find(robot, ())) is not None}
    if len(first) == len(group):
        push((), first)
    for _ in islice(states, STATES):
        if not queue:
            return None
        meetings, _, _, avoided, plans = heappop(queue)
        if meetings == 0:
            return tuple(plans.values())
        for robot, what in finder.ways_out(next(finder.meetings(tuple(plans.values()))), plans):
            kept = (each for each in avoided if each[0] != robot or each[1].robot != what.robot or what.robot == robot)
            narrowed = (*kept, (robot, what))
            plan = finder.find(robot, [each for name, each in narrowed if name == robot])
            if plan is not None and plan != plans[robot]:
                push(narrowed, {**plans, robot: plan})
    return None


class _Finder:
    """Plans single robots among the plans of others, and away from further plans, which may overlap.

    A fleet accepts overlapping plans only where capacities are larger than 1. So all capacities are doubled, each plan
    of the others counts twice, and visits to be avoided fill their places. A fleet with room for two knows of no
    exchange between resources of a group. So one with a robot outside is a meeting, and a plan to be avoided fills its
    groups for a tick more: then nobody enters one as it is left.
    """

    def __init__(self, instance: Instance, others: Sequence[Plan]) -> None:
        graph, self._places = _doubled(instance.graph, max(1, len(instance.robots)))
        twins = tuple(replace(each, id=_twin(each.id)) for each in instance.robots)
        self._instance = instance
        self._capacity = {each.id: each.capacity for each in graph.resources}
        self._fleet = PlannedFleet(replace(instance, graph=graph, robots=(*instance.robots, *twins)))
        self._fleet.commit([*others, *(replace(plan, robot=_twin(plan.robot)) for plan in others)])
        self._records: dict[Plan, list[int]] = {}
        wide = {each.id for each in instance.graph.resources if each.capacity > 1} | {*instance.graph.groups_of}
        self._crowd: defaultdict[ResourceId, list[tuple[int, float, Plan]]] = defaultdict(list)
        for plan in others:
            if any(visit.resource in wide for visit in plan.visits):
                for place, enter, leave in self._stays(plan):
                    self._crowd[place].append((enter, leave, plan))

    def _stays(self, plan: Plan) -> Iterator[tuple[ResourceId, int, float]]:
        """The places of the plan's visits, each with the first and the last tick at which it may meet others there."""
        for visit in plan.visits:
            last = inf if visit.leave is None else visit.leave + self._instance.gap
            for place in self._places[visit.resource]:
                yield place, visit.enter, last

    def find(self, robot: RobotId, avoided: Sequence[Plan]) -> Plan | None:
        """The earliest plan of a robot that meets none of these plans."""
        records = [record for plan in avoided for record in self._filling(plan)]
        further, fleet, index = np.array(records, np.int32), self._fleet, self._fleet.index(robot)

        def attempt() -> int:
            passes.reserve_all(fleet.native, further)
            found = passes.find_one(fleet.native, index, NONE, 0, ALONE)
            passes.withdraw_all(fleet.native, further)
            return found

        found = fleet.call(attempt)
        return None if found == NONE else fleet.plan_of(found)

    def _filling(self, plan: Plan) -> list[int]:
        """The records of the plan, and of this many more visits that nobody has room beside it."""
        if plan not in self._records:
            single = (
                Plan(plan.robot, (Visit(place, visit.enter, visit.leave and visit.leave + min(number, 1)),))
                for visit in plan.visits
                for number, place in enumerate(self._places[visit.resource])
                for _ in range(self._capacity[place] - (place == visit.resource))
            )
            self._records[plan] = [self._fleet.record(each) for each in (plan, *single)]
        return self._records[plan]

    def meetings(self, plans: Sequence[Plan]) -> Iterator[Violation]:
        """Where plans of the group break a rule together, or with plans of others that the fleet does not keep off."""
        near = {
            other.robot: other
            for plan in plans
            for place, first, last in self._stays(plan)
            for enter, leave, other in self._crowd[place]
            if first <= leave and enter <= last
        }
        for predicate in JOINT_RULES:
            yield from predicate(self._instance, (*plans, *near.values()))

    def ways_out(self, meeting: Violation, plans: Mapping[RobotId, Plan]) -> Iterator[Avoided]:
        """The constraints from a meeting: each robot avoids that place, or the whole plan of another robot."""
        robots = [robot for robot in meeting.robots if robot in plans]
        for robot in robots:
            if meeting.rule != "joint/exchange" and meeting.resource is not None and meeting.start is not None:
                place = self._met(meeting.resource, meeting.start, meeting.end, [plans[each] for each in robots])
                yield robot, Plan(robot, (Visit(place, meeting.start, meeting.end),))
            else:
                for visit in plans[robot].visits:
                    if visit.enter == meeting.start:
                        place = self._places[visit.resource][0]
                        yield robot, Plan(robot, (Visit(place, visit.enter, visit.enter + 1),))
            for other in robots:
                if other != robot:
                    yield robot, plans[other]

    def _met(self, resource: ResourceId, start: int, end: int | None, plans: Sequence[Plan]) -> ResourceId:
        """The place that closes the smallest constraint on the resource in which all plans are between the ticks."""
        graph, gap = self._instance.graph, self._instance.gap

        def is_in(plan: Plan, constraint: Group) -> bool:
            return any(
                visit.resource in constraint.resources
                and (end is None or visit.enter < end)
                and (visit.leave is None or visit.leave + gap > start)
                for visit in plan.visits
            )

        constraints = map(graph.constraint, graph.constraints_of(resource))
        met = [
            (constraint.capacity, number)
            for number, constraint in enumerate(constraints)
            if all(is_in(plan, constraint) for plan in plans)
        ]
        return self._places[resource][min(met)[1]]


def _doubled(graph: ResourceGraph, most: int) -> tuple[ResourceGraph, Mapping[ResourceId, Sequence[ResourceId]]]:
    """The graph with twice the room, of at most `most` robots, and the places that close what limits each resource.

    A resource that is in no group closes itself. Each group, and each resource of a group, gets a place beside it that
    closes it, and nothing else, when it is full. The first place of a resource closes the resource itself.
    """
    resources = [replace(each, capacity=2 * min(each.capacity, most)) for each in graph.resources]
    grouped = [Group(each.id, (each.id,), each.capacity) for each in resources if each.id in graph.groups_of]
    groups = [replace(each, capacity=2 * min(each.capacity, most)) for each in graph.groups]
    places: dict[ResourceId, list[ResourceId]] = {
        each.id: [] if each.id in graph.groups_of else [each.id] for each in resources
    }
    beside, closed = list[Resource](), list[Group]()
    for number, group in enumerate((*grouped, *groups)):
        place = Resource(f"\0{number}", group.capacity)
        beside.append(place)
        closed.append(Group(place.id, (*group.resources, place.id), group.capacity))
        places[place.id] = [place.id]
        for resource in group.resources:
            places[resource].append(place.id)
    return replace(graph, resources=(*resources, *beside), groups=tuple(closed)), places


def _twin(robot: RobotId) -> RobotId:
    """A name that no robot of a document has."""
    return f"\0{robot!r}"
