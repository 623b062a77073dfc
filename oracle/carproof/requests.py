"""The rules of requests, which command line and protocol check before a planner sees them: `request/...`.

Refusals name paths in the wrong document: `$.plans[2].visits[0]`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from carp_spec import Instance, Refusal, RobotId, Solution, Violation, check, judge
from carp_spec.rule import DESIGN, is_whole
from carproof.codes import Code

KNOWN_ROBOT = Code(
    "request/robot", "The robot asked for is one of the instance, and one to be added has no plan yet.", DESIGN
)
TICK = Code("request/now", "The tick now is a whole number of at least 0.", DESIGN)
SOUND_PLANS = Code(
    "request/plans",
    "The plans to which a query or a new robot is put break no rule; of the robot itself that a query is for, only "
    "the plan alone. A robot that the solution does not name counts as unplanned.",
    DESIGN,
)
POSITIVE_LIMIT = Code("request/limit", "The limit of a search, in seconds or steps, is a number above 0.", DESIGN)
REQUEST_RULES: tuple[Code, ...] = (KNOWN_ROBOT, TICK, SOUND_PLANS, POSITIVE_LIMIT)


def completed(instance: Instance, solution: Solution) -> Solution:
    """The solution with every robot that it does not name as an unplanned one."""
    named = {*solution.unplanned, *(plan.robot for plan in solution.plans)}
    missing = [robot.id for robot in instance.robots if robot.id not in named]
    return replace(solution, unplanned=(*solution.unplanned, *missing))


def sound_solution(instance: Instance, solution: Solution, asked: RobotId | None = None) -> Solution:
    """The completed solution; raises `Refusal` with the first rule that it breaks.

    The plan of the robot that is asked for is its history until now. The rest of that plan may be in the way of others,
    so it is not checked against them.
    """
    whole = completed(instance, solution)
    of_all = [
        violation
        for violation in judge(instance, whole).violations
        if asked not in violation.robots or not violation.rule.startswith("joint/")
    ]
    others = [plan for plan in whole.plans if plan.robot in instance.robot and plan.robot != asked]
    of_others = check(instance, others) if len(others) < len(whole.plans) else ()
    for violation in (*of_all, *of_others):
        raise Refusal("request", path_to(violation, solution), violation.rule, violation.message)
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


def require_robot(instance: Instance, robot: RobotId, path: str) -> None:
    """Raise `Refusal` if the instance does not have the robot."""
    if robot not in instance.robot:
        raise Refusal("request", path, KNOWN_ROBOT.id, f"the instance must have the robot, and has no {robot!r}")


def require_new_robot(instance: Instance, solution: Solution, robot: RobotId, path: str) -> None:
    """Raise `Refusal` if the instance does not have the robot, or the solution a plan of it."""
    require_robot(instance, robot, path)
    if any(plan.robot == robot for plan in solution.plans):
        raise Refusal("request", path, KNOWN_ROBOT.id, f"the robot to add must have no plan, and {robot!r} has one")


def require_tick(now: object, path: str) -> None:
    """Raise `Refusal` if it is no tick."""
    if not (is_whole(now) and now >= 0):
        raise Refusal("request", path, TICK.id, f"it must be a whole number of at least 0, not {now!r}")


def robot_called(instance: Instance, name: str) -> RobotId:
    """The robot whose id prints like the name; raises `Refusal` if none exists, or if `1` and `"1"` both do."""
    called = [robot.id for robot in instance.robots if str(robot.id) == name]
    if len(called) > 1:
        message = f"a robot's id must differ from the others when printed, and {len(called)} print as {name}"
        raise Refusal("request", "ROBOT", KNOWN_ROBOT.id, message)
    id = called[0] if called else name
    require_robot(instance, id, "ROBOT")
    return id


@contextmanager
def inside(prefix: str) -> Iterator[None]:
    """Put the paths of refusals below a prefix: `$.graph` inside `$.instance` is `$.instance.graph`.

    A refusal of an option stays as it is, because options stand beside the documents.
    """
    try:
        yield
    except Refusal as refusal:
        if refusal.kind == "option":
            raise
        path = prefix + refusal.path.removeprefix("$")
        raise Refusal(refusal.kind, path, refusal.rule, refusal.message) from refusal


def sound_within(instance: Instance, solution: Solution, asked: RobotId | None = None) -> Solution:
    """The completed solution of a request's field `solution`, as `sound_solution` has it."""
    with inside("$.solution"):
        return sound_solution(instance, solution, asked)
