"""The planner's face: `query`, `plan`, `add`, the same as `carp_optimized` has."""

from collections.abc import Sequence
from dataclasses import replace

from carp_reference.certifying import Certifier
from carp_reference.fixed_paths import fixed_paths
from carp_reference.neighbourhood import add_robot
from carp_reference.orderings import Plans, carp, greedy, longest_first, shuffled
from carp_reference.problem import Problem, prepare, ticks_to_goal
from carp_reference.query import find_plan
from carp_reference.time_expanded import time_expanded
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Instance,
    LongestFirst,
    Neighbourhood,
    Plan,
    Planner,
    RobotId,
    Shuffled,
    Solution,
    Stop,
)
from carp_spec.inputs.options import require_planner
from carp_spec.inputs.values import known, require_instance
from carp_spec.planners import BY_DEFAULT
from carp_spec.requests import require_addition, require_assignment, require_query


def query(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
    """The plan of one robot with the earliest arrival against the committed plans, or `None`.

    Its own plan among those committed is what it has followed until the tick `now`.
    """
    require_query(instance, committed, robot, now)
    return find(instance, committed, robot, now)


def find(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
    """`query` beside parts of plans; refuses nothing."""
    before = {plan.robot: plan for plan in committed if plan.robot == robot}
    others = [plan for plan in committed if plan.robot != robot]
    problem = Problem(instance, {robot: ticks_to_goal(instance, instance.robot[robot])}, now, before)
    return find_plan(problem, others, robot)


def certifier(instance: Instance) -> Certifier:
    """A certifying planner with no committed plans yet."""
    require_instance(instance)
    return Certifier(instance)


def plan(instance: Instance, planner: Planner = BY_DEFAULT) -> Solution:
    """Plan all robots of the instance at tick 0."""
    require_instance(instance)
    require_planner(planner)
    return known(instance, Solution.of(instance, _plans(prepare(instance, 0), planner)))


def add(instance: Instance, solution: Solution, robot: RobotId, now: int, options: Neighbourhood) -> Solution:
    """Add a robot to a solution of the others at the tick `now`; if it finds no plan, the other plans stay."""
    require_addition(instance, solution, robot, now, options)
    by_robot = {each.robot: each for each in solution.plans}
    committed = tuple(by_robot[each] for each in solution.order)
    plans = add_robot(prepare(instance, now), committed, robot, options) or committed
    named = {*by_robot, *solution.unplanned, robot}
    after = Solution.of(instance, plans)
    return known(instance, replace(after, unplanned=tuple(each for each in after.unplanned if each in named)))


def assign(
    instance: Instance, solution: Solution, robot: RobotId, stops: Sequence[Stop], now: int, options: Neighbourhood
) -> tuple[Instance, Solution]:
    """Give a robot under way or parked further stops at the tick `now`: it is planned again as if it were added.

    The instance with its stops, and the plans; if no plan is found, both are as they were.
    """
    further = require_assignment(instance, solution, robot, stops, now, options)
    by_robot = {each.robot: each for each in solution.plans}
    committed = tuple(by_robot[each] for each in solution.order if each != robot)
    problem = replace(prepare(further, now), before={robot: by_robot[robot]})
    plans = add_robot(problem, committed, robot, options)
    if plans is None:
        return instance, solution
    return further, known(further, replace(solution, plans=plans, order=tuple(plan.robot for plan in plans)))


def _plans(problem: Problem, planner: Planner) -> Plans:  # noqa: PLR0911 - one return a planner
    order = [robot.id for robot in problem.instance.robots]
    match planner:
        case Carp():
            return carp(problem, order)
        case Shuffled(attempts, seed):
            return shuffled(problem, order, attempts, seed)
        case LongestFirst():
            return longest_first(problem)
        case Greedy():
            return greedy(problem)
        case Neighbourhood():
            plans: Plans = ()
            for robot in order:
                plans = add_robot(problem, plans, robot, planner) or plans
            return plans
        case FixedPaths():
            return fixed_paths(problem, planner)
        case _:
            return time_expanded(problem.instance)
