"""Executions of solutions by robots that are late."""

from collections.abc import Sequence
from math import inf

from carp_spec import Instance, Refusal, RobotId, Solution
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_robot, sound_solution
from carp_spec.rule import is_between
from carp_spec.shapes import require_each
from carp_verify.release.rules import Grant
from carproof.execution.delays import Delay
from carproof.execution.releasing import MOST_STATES, GrantsVerdict, Released, Releasing
from carproof.execution.simulation import DRIVERS, Driver, Execution, delays_are_right, require_delays
from carproof.execution.simulation import execute as executed
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
    limit = _limit(states, seconds)
    require_each(beyond, RobotId, "$.beyond")
    situation = Releasing(instance, solution, trace)
    for robot in beyond:
        require_robot(instance, robot, "$.beyond")
    return situation.released([robot for robot in beyond if robot in situation.plans], *limit)


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
    limit = _limit(states, seconds)
    require_each(grants, Grant, "$.grants")
    return Releasing(instance, solution, trace).check(grants, *limit)


def _limit(states: int | None, seconds: float | None) -> tuple[float, float]:
    """The states of each search, and when all must have ended, if they begin now."""
    if states is not None and not is_between(states, 1):
        message = f"it must be a whole number of at least 1, not {states!r}"
        raise Refusal("option", "$.states", "request/limit", message)
    return states or (MOST_STATES if seconds is None else inf), deadline(seconds)
