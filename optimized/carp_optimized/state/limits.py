"""Refuses numbers that the arrays of a state cannot hold."""

from collections.abc import Iterator, Sequence

from carp_optimized.state.arrays import LARGEST
from carp_spec import Fault, Instance, Refusal, Robot

LARGEST_COORDINATE = 2**29
NO_LIMIT_THERE = "the reference engine has no such limit, but finds no bounds"


def refuse_what_is_too_large(instance: Instance) -> None:
    """Raise `Refusal` where a number of the instance does not fit, and for what is not known here."""
    _refuse(_too_large(instance))


def refuse_robots(robots: Sequence[Robot], longest: int) -> None:
    """The same for robots that come to a fleet, where that is the longest duration."""
    _refuse(_large_robots(robots, longest))


def _refuse(faults: Iterator[Fault]) -> None:
    for fault in faults:
        raise Refusal("limit", fault.path, fault.rule, f"{fault.message}; {NO_LIMIT_THERE}")


def refuse_tick(path: str, tick: int) -> None:
    """Raise `Refusal` for a tick that does not fit."""
    if tick > LARGEST:
        raise Refusal(
            "limit", path, "limit/ticks", f"the tick must be at most {LARGEST}, and is {tick}; {NO_LIMIT_THERE}"
        )


def _too_large(instance: Instance) -> Iterator[Fault]:
    longest = 1
    for position, resource in enumerate(instance.graph.resources):
        path = f"$.graph.nodes[{position}]"
        longest = max(longest, resource.duration)
        if resource.duration > LARGEST:
            message = f"the duration must be at most {LARGEST}, and is {resource.duration}"
            yield Fault("limit/ticks", f"{path}.duration", message)
        for name, value in (("x", resource.x or 0), ("y", resource.y or 0)):
            if abs(value) > LARGEST_COORDINATE:
                message = f"{name} must be between -{LARGEST_COORDINATE} and {LARGEST_COORDINATE}, and is {value}"
                yield Fault("limit/ticks", f"{path}.{name}", message)
    yield from _large_robots(instance.robots, longest)


def _large_robots(robots: Sequence[Robot], longest: int) -> Iterator[Fault]:
    for position, robot in enumerate(robots):
        path = f"$.robots[{position}]"
        if robot.release > LARGEST:
            yield Fault(
                "limit/ticks", f"{path}.release", f"the release must be at most {LARGEST}, and is {robot.release}"
            )
        if sum(stop.service for stop in robot.stops) > LARGEST:
            message = f"the services must be at most {LARGEST} together, and are more"
            yield Fault("limit/ticks", f"{path}.stops", message)
        if robot.pace * longest > LARGEST:
            message = f"the pace times {longest}, the longest duration, must be at most {LARGEST}, and is {robot.pace}"
            yield Fault("limit/ticks", f"{path}.pace", message)
