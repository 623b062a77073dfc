"""Executions of solutions by robots that are late."""

from collections.abc import Sequence
from time import perf_counter

from carp_reference.execution import order_of
from carp_spec import Instance, Refusal, RobotId, Solution, Visit
from carp_spec.execution.execution_rules import require_followed
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_robot, require_tick, require_trace, sound_solution
from carp_spec.shapes import require_each
from carp_verify.release.rules import Grant
from carproof.engines import engine_named
from carproof.execution.delays import Delay, may_enter
from carproof.execution.giving_way import GivenWay
from carproof.execution.giving_way import give_way as way_given
from carproof.execution.releasing import GrantsVerdict, Released, Releasing, limit_of
from carproof.execution.simulation import DRIVERS, Driver, Execution, delays_are_right, require_delays
from carproof.execution.simulation import execute as executed
from carproof.execution.untangling import Untangled
from carproof.execution.untangling import untangle as untangled
from carproof.requests import deadline


def execute(instance: Instance, solution: Solution, driver: Driver, delays: Sequence[Delay] = ()) -> Execution:
    """Simulate robots that need longer at some visits than planned.

    Driver `clock` keeps to the ticks of the plans, `order` to the planned order, and `switching` changes the order
    where this is safe and gains time. Raises `Refusal` for a solution that breaks a rule, and for wrong delays.
    """
    sound = sound_solution(instance, solution)
    if driver not in DRIVERS:
        message = f"there is no driver {driver!r}; the drivers are {', '.join(DRIVERS)}"
        raise Refusal("option", "$.driver", delays_are_right.id, message)
    require_each(delays, Delay, "$.delays")
    return executed(instance, sound, driver, require_delays(sound, delays, "option"))


def retime(instance: Instance, solution: Solution, trace: Trace) -> Solution:
    """The plans for the rest of the way after a trace, in the same order and as early as possible.

    Other functions go on with these plans at the tick after that of the trace. Raises `Refusal` for a solution that
    breaks a rule, a trace that does not follow it or that no lawful plan can have, and numbers that are too large.
    """
    return engine_named(None).retime(instance, solution, trace)


def drive(instance: Instance, solution: Solution, trace: Trace, ready: Sequence[RobotId]) -> tuple[RobotId, ...]:
    """The robots among those ready that enter their next visits at the tick of a trace, in the planned order.

    A robot is ready if it is released, or has stayed in its last visit as long as it needs. Raises `Refusal` for a
    solution that breaks a rule, a trace that does not follow it, and robots that the instance does not have.
    """
    require_trace(instance, solution, trace)
    require_followed(instance, solution, trace)
    require_each(ready, RobotId, "$.ready")
    for robot in ready:
        require_robot(instance, robot, "$.ready")
    return may_enter(order_of(instance, solution), trace, ready)


def untangle(instance: Instance, solution: Solution, seconds: float | None = None) -> Untangled:
    """Replan robots until no robots enter each other's places in a circle, or the seconds are over.

    Raises `Refusal` for a solution that breaks a rule, and for numbers that are too large.
    """
    ends = deadline(seconds)
    sound = sound_solution(instance, solution)
    return untangled(instance, sound, engine_named(None), lambda: perf_counter() < ends)


def give_way(
    instance: Instance, solution: Solution, robot: RobotId, now: int = 0, route: Sequence[Visit] | None = None
) -> GivenWay:
    """Give a robot the earliest plan that the histories of the others at the tick now allow, and plan them around it.

    With a route, the robot has its visits. Raises `Refusal` for a solution or a route that breaks a rule, a robot that
    the instance does not have, a tick below 0, and numbers that are too large.
    """
    require_tick(now)
    sound = sound_solution(instance, solution)
    require_robot(instance, robot)
    require_each(() if route is None else route, Visit, "$.route")
    return way_given(instance, sound, robot, now, engine_named(None), route)


def release(
    instance: Instance,
    solution: Solution,
    trace: Trace,
    beyond: Sequence[RobotId] = (),
    states: int | None = None,
    seconds: float | None = None,
) -> Released:
    """Which further resources robots may be granted at the tick of a trace, so that everybody can still finish.

    By the planned order, all robots may have theirs together. For the robots of `beyond`, it is also decided what each
    may have alone, whatever the order, by searches that take at most so many seconds together, and each at most so many
    states: 20,000 if neither is given. Raises `Refusal` for a solution that breaks a rule or has rotations, and for a
    trace that does not keep to its paths and durations.
    """
    limit = limit_of(states, seconds)
    require_each(beyond, RobotId, "$.beyond")
    return Releasing(instance, solution, trace).released(beyond, *limit)


def check_grants(
    instance: Instance,
    solution: Solution,
    trace: Trace,
    grants: Sequence[Grant],
    states: int | None = None,
    seconds: float | None = None,
) -> GrantsVerdict:
    """Whether robots can all finish if they are granted these resources at the tick of a trace, with a witness.

    The answer is undecided if a search would take more than so many states or seconds, 20,000 states if neither is
    given. Raises `Refusal` as `release` does, and for grants of other than the next resources of plans.
    """
    limit = limit_of(states, seconds)
    require_each(grants, Grant, "$.grants")
    return Releasing(instance, solution, trace).check(grants, *limit)
