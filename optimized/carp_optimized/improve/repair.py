"""Plans for robots that a planner leaves out: in small groups, jointly among the other plans, or in another order.

Where robots must let each other pass in a narrow place, the first one planned may leave no plan to the others, whatever
the order. So a robot without a plan is planned together with those in its way, by conflict-based search (Sharon et al.
2015) with priorities between robots (Ma et al. 2019). The group grows by the outside robot that its members would meet
first if they were alone. Where no group is found, all robots are planned one after the other, pass after pass; those
that a pass leaves out come first in the next. Crowds for which that fails too are moved tick by tick, if
`carp_optimized.lacam.search` can. Nothing here is trusted: the law judges the plans.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from heapq import heappop, heappush
from itertools import count, islice, takewhile
from typing import TypeAlias

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.lacam.search import plans_by_steps
from carp_optimized.orderings import carp
from carp_optimized.planners import polish_while
from carp_optimized.queries.search import ALONE
from carp_optimized.settling import settled
from carp_optimized.state.arrays import NONE
from carp_spec import Instance, Plan, RobotId, Solution, Visit, total_cost
from carp_spec.joint_rules import JOINT_RULES
from carp_spec.requests import sound_solution
from carp_spec.rule import Violation

LARGEST_GROUP = 4  # robots whose plans are searched for together
STATES = 200
"""The search for plans of one group ends after this number of states."""
ALL_STATES = 300
"""The search for all groups of a solution ends after this number of states."""
FEW = 4
"""At most this many robots left out are planned in groups: groups of more take longer than other orders."""
ATTEMPTS = 4  # other first plans, each polished
ROUNDS = 200  # of a polish
PASSES = 100  # of CARP for other first plans
Avoided: TypeAlias = tuple[RobotId, Plan]
"""A robot, and the plan of another that it has to avoid, or one visit that it must not make."""


def repair(instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True) -> Solution:
    """Plan the robots of a solution that have a path but no plan, as far as possible; plans of others may change.

    An attempt plays rounds of `polish/...`, and plans robots jointly if few are left out and there are no groups of
    resources. If some robots still are, the next attempt begins with plans in another order, and the last with plans
    made tick by tick. In the end the plans are settled. It ends soon after it goes on no more. Raises `Refusal` for a
    solution that breaks a rule, and for numbers that are too large.
    """
    given = solution = sound_solution(instance, solution)
    fleet = PlannedFleet(instance)
    asked = takewhile(lambda _: goes_on(), solution.unplanned)
    without_path = {robot for robot in asked if fleet.find(fleet.index(robot), None, 0) is None}
    for seed in range(ATTEMPTS):
        if without_path.issuperset(solution.unplanned) or not goes_on():
            break
        if seed > 0:
            solution = plan_failed_first(instance, solution, goes_on)
        solution = polish_while(instance, solution, goes_on, ROUNDS, seed)
        if len(solution.unplanned) <= FEW + len(without_path) and not instance.graph.groups:
            solution = repair_jointly(instance, solution, goes_on)
    if not without_path.issuperset(solution.unplanned) and goes_on():
        able = tuple(each for each in instance.robots if each.id not in without_path)
        found = plans_by_steps(replace(instance, robots=able))
        if found is not None:
            solution = polish_while(instance, Solution.of(instance, found), goes_on, ROUNDS, ATTEMPTS)
    return solution if solution == given or not goes_on() else settled(instance, solution, goes_on)


def plan_failed_first(instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True) -> Solution:
    """The plans of the best of some passes of CARP, each with the robots first that the one before left out.

    The solution itself, if no pass plans more robots. A pass that is not over when it goes on no more counts too.
    """
    fleet = PlannedFleet(instance)
    order = [fleet.index(robot) for robot in (*solution.unplanned, *solution.order)]
    for _ in range(PASSES):
        carp(fleet, order, goes_on)
        planned = {*fleet.order}
        if len(planned) > len(solution.plans):
            solution = Solution.of(instance, fleet.plans)
        if len(planned) == len(order) or not goes_on():
            break
        order.sort(key=planned.__contains__)
    return solution


def repair_jointly(instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True) -> Solution:
    """The solution with plans for those of its unplanned robots for which a group that can be planned is found."""
    states = takewhile(lambda _: goes_on(), range(ALL_STATES))
    for robot in solution.unplanned:
        solution = _planned_with_others(instance, solution, robot, states) or solution
    return solution


def _planned_with_others(
    instance: Instance, solution: Solution, robot: RobotId, states: Iterator[int]
) -> Solution | None:
    """The solution with a plan for the robot; `None` if no group of robots was found that can be planned with it."""
    group = [robot]
    while len(group) <= LARGEST_GROUP:
        others = [plan for plan in solution.plans if plan.robot not in group]
        found = joint_plans(instance, others, group, states)
        if found is not None:
            order = (*(each for each in solution.order if each not in group), *group)
            unplanned = tuple(each for each in solution.unplanned if each != robot)
            return Solution((*others, *found), order, unplanned)
        alone = joint_plans(instance, (), group, states)
        met = None if alone is None else _first_met(instance, others, alone)
        if met is None:
            return None
        group.append(met)
    return None


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
        for robot, what in _ways_out(next(finder.meetings(tuple(plans.values()))), plans):
            kept = (each for each in avoided if each[0] != robot or each[1].robot != what.robot or what.robot == robot)
            narrowed = (*kept, (robot, what))
            plan = finder.find(robot, [each for name, each in narrowed if name == robot])
            if plan is not None:
                push(narrowed, {**plans, robot: plan})
    return None


def _ways_out(meeting: Violation, plans: dict[RobotId, Plan]) -> Iterator[Avoided]:
    """The constraints from a meeting: each robot avoids that place, or the whole plan of another robot."""
    robots = [robot for robot in meeting.robots if robot in plans]
    for robot in robots:
        if meeting.rule != "joint/exchange" and meeting.resource is not None and meeting.start is not None:
            yield robot, Plan(robot, (Visit(meeting.resource, meeting.start, meeting.end),))
        else:
            for visit in plans[robot].visits:
                if visit.enter == meeting.start:
                    yield robot, Plan(robot, (Visit(visit.resource, visit.enter, visit.enter + 1),))
        for other in robots:
            if other != robot:
                yield robot, plans[other]


def _first_met(instance: Instance, others: Sequence[Plan], plans: Sequence[Plan]) -> RobotId | None:
    """The robot among the others that plans of a group meet first."""
    members = {plan.robot for plan in plans}
    faults = (fault for predicate in JOINT_RULES for fault in predicate(instance, (*plans, *others)))
    for fault in sorted(faults, key=lambda fault: fault.start or 0):
        for robot in fault.robots:
            if robot not in members:
                return robot
    return None


class _Finder:
    """Plans single robots among the plans of others, and away from further plans, which may overlap.

    A fleet accepts overlapping plans only where capacities are larger than 1. So all capacities are doubled, each plan
    of the others counts twice, and a visit to be avoided fills its resource. No resource has room for more than
    all robots.
    """

    def __init__(self, instance: Instance, others: Sequence[Plan]) -> None:
        graph = instance.graph
        most = max(1, len(instance.robots))
        doubled = tuple(replace(each, capacity=2 * min(each.capacity, most)) for each in graph.resources)
        twins = tuple(replace(each, id=_twin(each.id)) for each in instance.robots)
        self._instance = instance
        self._capacity = {each.id: each.capacity for each in doubled}
        self._fleet = PlannedFleet(
            replace(instance, graph=replace(graph, resources=doubled), robots=(*instance.robots, *twins))
        )
        self._fleet.commit([*others, *(replace(plan, robot=_twin(plan.robot)) for plan in others)])
        self._records: dict[Plan, list[int]] = {}
        wide = {each.id for each in graph.resources if each.capacity > 1}
        self._crowd = tuple(plan for plan in others if any(visit.resource in wide for visit in plan.visits))

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
        """The records of the plan, and of this many more visits of each resource that nobody has room beside it."""
        if plan not in self._records:
            visits = (visit for visit in plan.visits for _ in range(self._capacity[visit.resource] - 1))
            single = (Plan(plan.robot, (visit,)) for visit in visits)
            self._records[plan] = [self._fleet.record(each) for each in (plan, *single)]
        return self._records[plan]

    def meetings(self, plans: Sequence[Plan]) -> Iterator[Violation]:
        """Where plans of the group break a rule together, beside plans in resources that have room for several."""
        for predicate in JOINT_RULES:
            yield from predicate(self._instance, (*plans, *self._crowd))


def _twin(robot: RobotId) -> RobotId:
    """A name that no robot of a document has."""
    return f"\0{robot!r}"
