"""Prioritized planning: robots one after the other, each against the plans before it."""

from collections.abc import Sequence

from carp_reference.problem import Problem
from carp_reference.query import find_plan
from carp_spec import Plan, RobotId, plan_cost, total_cost
from carp_spec.permutations import shuffle, splitmix64

Plans = tuple[Plan, ...]


def carp(problem: Problem, order: Sequence[RobotId]) -> Plans:
    """Plan the robots in the order given; one that finds no plan is left out."""
    plans: list[Plan] = []
    for robot in order:
        plan = find_plan(problem, plans, robot)
        if plan is not None:
            plans.append(plan)
    return tuple(plans)


def shuffled(problem: Problem, order: Sequence[RobotId], attempts: int, seed: int) -> Plans:
    """The best of several passes, as `Shuffled` has them."""
    stream = splitmix64(seed)
    best = carp(problem, order)
    for _ in range(attempts - 1):
        order = shuffle(order, stream)
        plans = carp(problem, order)
        if _worth(problem, plans) < _worth(problem, best):
            best = plans
    return best


def _worth(problem: Problem, plans: Plans) -> tuple[int, int]:
    """More robots planned are better, then a smaller total."""
    return (-len(plans), total_cost(problem.instance, plans))


def longest_first(problem: Problem) -> Plans:
    """CARP with the longest shortest path first."""
    shortest = {robot.id: problem.ticks_to_goal[robot.id][0].get(robot.start, 0) for robot in problem.instance.robots}
    return carp(problem, sorted(shortest, key=shortest.__getitem__, reverse=True))


def greedy(problem: Problem) -> Plans:
    """Plan, in each round, the robot whose plan costs least."""
    plans: list[Plan] = []
    waiting = [robot.id for robot in problem.instance.robots]
    while waiting:
        found = [plan for robot in waiting if (plan := find_plan(problem, plans, robot)) is not None]
        if not found:
            break
        cheapest = min(found, key=lambda plan: plan_cost(problem.instance, plan))
        plans.append(cheapest)
        waiting.remove(cheapest.robot)
    return tuple(plans)
