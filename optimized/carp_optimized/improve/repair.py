"""Plans for robots that a planner leaves out: in the way of others, or in small groups, jointly among the others.

First robots left out take the way of others, who are planned again (`carp_optimized.improve.ejection`). Where robots
must let each other pass in a narrow place, the first one planned may leave no plan to the others, whatever the order.
So the last few robots without a plan are planned together with those in their way
(`carp_optimized.improve.joint_plans`). The group grows by the outside robot that its members would meet first if they
were alone. Crowds for which that fails too are moved tick by tick, if `carp_optimized.lacam.search` can. Nothing here
is trusted: the law judges the plans.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import takewhile

from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.ejection import plan_left_out
from carp_optimized.improve.joint_plans import joint_plans
from carp_optimized.lacam.search import plans_by_steps
from carp_optimized.planners import polish_while
from carp_optimized.settling import settled
from carp_spec import Instance, Plan, RobotId, Solution
from carp_spec.joint_rules import JOINT_RULES
from carp_spec.requests import sound_solution

LARGEST_GROUP = 4  # robots whose plans are searched for together
ALL_STATES = 300
"""The search for all groups of a solution ends after this number of states."""
FEW = 4
"""At most this many robots left out are planned in groups, which take long."""
ATTEMPTS = 4
TIMES = 16
"""In an attempt, a robot left out takes the way of others at most so often."""
ROUNDS = 200  # of a polish


def repair(instance: Instance, solution: Solution, goes_on: Callable[[], bool] = lambda: True) -> Solution:
    """Plan the robots of a solution that have a path but no plan, as far as possible; plans of others may change.

    In an attempt, those left out take the way of others, rounds of `polish/...` are played, and the last few are
    planned jointly. If some still are left out, all are planned tick by tick. In the end plans are settled. It ends
    soon after it goes on no more. Raises `Refusal` for a solution that breaks a rule, and for numbers that are too
    large.
    """
    given = solution = sound_solution(instance, solution)
    fleet = PlannedFleet(instance)
    asked = takewhile(lambda _: goes_on(), solution.unplanned)
    without_path = {robot for robot in asked if fleet.find(fleet.index(robot), None, 0) is None}
    for seed in range(ATTEMPTS):
        if without_path.issuperset(solution.unplanned) or not goes_on():
            break
        fleet.clear()
        fleet.commit_solution(solution)
        plan_left_out(fleet, goes_on, times=TIMES, seed=seed)
        solution = polish_while(instance, Solution.of(instance, fleet.plans), goes_on, ROUNDS, seed)
        if len(solution.unplanned) <= FEW + len(without_path):
            solution = repair_jointly(instance, solution, goes_on)
    if not without_path.issuperset(solution.unplanned) and goes_on():
        able = tuple(each for each in instance.robots if each.id not in without_path)
        found = plans_by_steps(replace(instance, robots=able))
        if found is not None:
            solution = polish_while(instance, Solution.of(instance, found), goes_on, ROUNDS, ATTEMPTS)
    return solution if solution == given or not goes_on() else settled(instance, solution, goes_on)


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


def _first_met(instance: Instance, others: Sequence[Plan], plans: Sequence[Plan]) -> RobotId | None:
    """The robot among the others that plans of a group meet first."""
    members = {plan.robot for plan in plans}
    faults = (fault for predicate in JOINT_RULES for fault in predicate(instance, (*plans, *others)))
    for fault in sorted(faults, key=lambda fault: fault.start or 0):
        for robot in fault.robots:
            if robot not in members:
                return robot
    return None
