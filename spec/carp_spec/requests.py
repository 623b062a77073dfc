"""Requests: a robot to plan, and the plans beside which it is planned.

The rules are those of `carproof.requests`.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from carp_spec.check import judge, solution_violations, violations_of
from carp_spec.execution.traces import Trace
from carp_spec.inputs.options import require_planner
from carp_spec.inputs.values import has_sound_plans, remember, require_plans, require_solution
from carp_spec.instance_rules import stops_are_places_to_serve
from carp_spec.model import Instance, Plan, Robot, RobotId, Solution, Stop
from carp_spec.plan_rules import has_ended
from carp_spec.planners import Neighbourhood
from carp_spec.refusal import Refusal
from carp_spec.rule import Violation, is_between
from carp_spec.shapes import SHAPE, require_each, require_shape


def require_robot(instance: Instance, robot: RobotId, path: str = "$.robot") -> None:
    """Raise `Refusal` if the instance does not have the robot."""
    require_shape(robot, RobotId, path)
    if robot not in instance.robot:
        raise Refusal("request", path, "request/robot", f"the instance must have the robot, and has no {robot!r}")


def require_new_robot(instance: Instance, solution: Solution, robot: RobotId, path: str = "$.robot") -> None:
    """Raise `Refusal` if the instance does not have the robot, or the solution a plan of it."""
    require_robot(instance, robot, path)
    if any(plan.robot == robot for plan in solution.plans):
        raise Refusal("request", path, "request/robot", f"the robot to add must have no plan, and {robot!r} has one")


def require_tick(now: object, path: str = "$.now") -> None:
    """Raise `Refusal` if it is no tick."""
    if not is_between(now, 0):
        raise Refusal("request", path, "request/now", f"it must be a whole number of at least 0, not {now!r}")


def require_query(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int) -> None:
    """Raise `Refusal` unless the robot can be asked for beside the plans at the tick now."""
    solution = require_plans(instance, committed)
    require_tick(now)
    require_robot(instance, robot)
    sound_solution(instance, solution, robot)


def require_addition(instance: Instance, solution: Solution, robot: RobotId, now: int, options: Neighbourhood) -> None:
    """Raise `Refusal` unless the robot can be added to the solution at the tick now."""
    require_solution(instance, solution)
    require_planner(options, Neighbourhood)
    require_tick(now)
    require_new_robot(instance, solution, robot)
    sound_solution(instance, solution)


def require_assignment(
    instance: Instance, solution: Solution, robot: RobotId, stops: Sequence[Stop], now: int, options: Neighbourhood
) -> Instance:
    """The instance in which the robot has these stops too; raises `Refusal` unless it can get them at the tick now."""
    require_solution(instance, solution)
    require_planner(options, Neighbourhood)
    require_tick(now)
    require_robot(instance, robot)
    sound_solution(instance, solution)
    plan = solution.plan_of(robot)
    if plan is None or has_ended(plan, now):
        message = f"the robot must be under way or parked at {now}, and {robot!r} "
        raise Refusal("request", "$.robot", "request/robot", message + ("has no plan" if plan is None else "has left"))
    before = instance.robot[robot]
    further = further_stops(instance, before, stops)
    return replace(instance, robots=tuple(further if each is before else each for each in instance.robots))


def further_stops(instance: Instance, robot: Robot, stops: Sequence[Stop]) -> Robot:
    """The robot with these stops behind its own; raises `Refusal` where they break `instance/stops`."""
    require_each(stops, Stop, "$.stops")
    if not stops:
        raise Refusal("request", "$.stops", stops_are_places_to_serve.id, "there must be at least one stop")
    further = replace(robot, stops=(*robot.stops, *stops))
    for fault in stops_are_places_to_serve(replace(instance, robots=(further,))):
        place, _, name = fault.path.partition(".stops[")[2].partition("]")
        path = f"$.stops[{int(place) - len(robot.stops)}]{name}"
        raise Refusal("request", path, fault.rule, fault.message)
    return further


@contextmanager
def about_stops(robot: int) -> Iterator[None]:
    """Put what is refused about the stops of that robot of an instance where a request for further ones has them."""
    try:
        yield
    except Refusal as refusal:
        if refusal.path != f"$.robots[{robot}].stops":
            raise
        raise Refusal(refusal.kind, "$.stops", refusal.rule, refusal.message) from refusal


def require_trace(instance: Instance, solution: Solution, trace: Trace) -> None:
    """Raise `Refusal` unless the solution breaks no rule, and the trace is well-formed."""
    require_solution(instance, solution)
    require_shape(trace, Trace)
    if trace.now < 0:
        raise Refusal("document", "$.now", SHAPE, f"it must be at least 0, not {trace.now}")
    sound_solution(instance, solution)


def sound_solution(instance: Instance, solution: Solution, asked: RobotId | None = None) -> Solution:
    """The solution, robots not named unplanned; raises `Refusal` with the first rule that it breaks.

    The plan of the robot that is asked for is its history until now. The rest of that plan may be in the way of others,
    so it is not checked against them. What the instance remembers as sound is not checked again, nor are plans of it.
    """
    require_solution(instance, solution)
    seen = [(each, is_sound) for each, is_sound in (*instance.seen,) if each() is solution]
    named = {*solution.unplanned, *(plan.robot for plan in solution.plans)}
    missing = tuple(robot for robot in instance.robot if robot not in named)
    whole = replace(solution, unplanned=(*solution.unplanned, *missing)) if missing else solution
    if not any(is_sound for _, is_sound in seen):
        is_known = has_sound_plans(instance, solution.plans)
        found = solution_violations(instance, whole) if is_known else judge(instance, whole).violations
        of_all = [each for each in found if asked not in each.robots or not each.rule.startswith("joint/")]
        of_others = (
            violations_of(instance, [plan for plan in whole.plans if plan.robot != asked])
            if found and not of_all
            else ()
        )
        for violation in (*of_all, *of_others):
            raise Refusal("request", path_to(violation, solution), violation.rule, violation.message)
        if not found:
            remember(instance, seen[-1][0], is_sound=True)
    return whole


def path_to(violation: Violation, solution: Solution) -> str:
    """The path of a violation in the solution's document: the first visit to blame, else the plan, else all of it."""
    for number, plan in enumerate(solution.plans):
        if plan.robot != violation.robots[0]:
            continue
        for position, visit in enumerate(plan.visits):
            begins_by_then = violation.start is not None and visit.enter <= violation.start
            lasts_until_then = visit.leave is None or (violation.start or 0) < max(visit.leave, visit.enter + 1)
            if visit.resource == violation.resource and begins_by_then and lasts_until_then:
                return f"$.plans[{number}].visits[{position}]"
        return f"$.plans[{number}]"
    return "$"
