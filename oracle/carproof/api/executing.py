"""Executions of solutions by robots that are late."""

from collections.abc import Sequence

from carp_spec import Instance, Refusal, Solution
from carp_spec.requests import sound_solution
from carproof.execution.delays import Delay
from carproof.execution.simulation import DRIVERS, Driver, Execution, delays_are_right
from carproof.execution.simulation import execute as executed


def execute(instance: Instance, solution: Solution, driver: Driver, delays: Sequence[Delay] = ()) -> Execution:
    """Simulate robots that need longer at some visits than planned.

    Driver `clock` keeps to the ticks of the plans, `order` to the planned order, and `switching` changes the order
    where this is safe and gains time. Raises `Refusal` for a solution that breaks a rule, and for wrong delays.
    """
    sound = sound_solution(instance, solution)
    if driver not in DRIVERS:
        message = f"there is no driver {driver!r}; the drivers are {', '.join(DRIVERS)}"
        raise Refusal("option", "$.driver", delays_are_right.id, message)
    if not delays_are_right(sound, delays):
        message = "each delay must name a planned robot, the position of a visit, and ticks above 0"
        raise Refusal("option", "$.delays", delays_are_right.id, message)
    return executed(instance, sound, driver, tuple(delays))
