"""Refuses numbers that the arrays of a state cannot hold."""

from collections.abc import Sequence
from typing import NoReturn

from carp_optimized.state.arrays import LARGEST
from carp_spec import Instance, Refusal, Robot

LARGEST_COORDINATE = 2**29
NO_LIMIT_THERE = "the reference engine has no such limit, but finds no bounds"


def refuse_what_is_too_large(instance: Instance) -> None:
    """Raise `Refusal` where a number of the instance does not fit."""
    longest = 1
    for position, resource in enumerate(instance.graph.resources):
        path = f"$.graph.nodes[{position}]"
        longest = max(longest, resource.duration)
        if resource.duration > LARGEST:
            _refuse(f"{path}.duration", f"the duration must be at most {LARGEST}, and is {resource.duration}")
        for name, value in (("x", resource.x or 0), ("y", resource.y or 0)):
            if abs(value) > LARGEST_COORDINATE:
                between = f"between -{LARGEST_COORDINATE} and {LARGEST_COORDINATE}"
                _refuse(f"{path}.{name}", f"{name} must be {between}, and is {value}")
    refuse_robots(instance.robots, longest)


def refuse_robots(robots: Sequence[Robot], longest: int) -> None:
    """The same for robots, where that is the longest duration."""
    for position, robot in enumerate(robots):
        path = f"$.robots[{position}]"
        if robot.release > LARGEST:
            _refuse(f"{path}.release", f"the release must be at most {LARGEST}, and is {robot.release}")
        if sum(stop.service for stop in robot.stops) > LARGEST:
            _refuse(f"{path}.stops", f"the services must be at most {LARGEST} together, and are more")
        if robot.pace * longest > LARGEST:
            product = f"the pace times {longest}, the longest duration,"
            _refuse(f"{path}.pace", f"{product} must be at most {LARGEST}, and is {robot.pace}")


def refuse_tick(path: str, tick: int) -> None:
    """Raise `Refusal` for a tick that does not fit."""
    if tick > LARGEST:
        _refuse(path, f"the tick must be at most {LARGEST}, and is {tick}")


def _refuse(path: str, message: str) -> NoReturn:
    raise Refusal("limit", path, "limit/ticks", f"{message}; {NO_LIMIT_THERE}")
