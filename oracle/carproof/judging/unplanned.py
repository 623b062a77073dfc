"""Why a robot is unplanned, for the person who asked."""

from collections.abc import Sequence
from itertools import pairwise

from carp_spec import Instance, Plan, ResourceGraph, ResourceId, Robot, RobotId
from carp_spec.windows import Window, constraints_on, free_windows, stay_fits


def why_unplanned(
    instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0, followed: Plan | None = None
) -> str:
    """One clause that says why CARP finds no plan for a robot that has none against the committed plans.

    A robot that has followed a plan until now waits at its start no more, and the plan shows that moves lead on.
    """
    request = instance.robot[robot]
    is_waiting = followed is None or followed.visits[0].enter > now
    reason = _why_it_cannot_begin(instance, committed, request, now) if is_waiting else None
    if reason is not None:
        return reason
    at_goal = windows(instance, committed, request.goal)
    if instance.after_goal == "park" and all(window.end is not None for window in at_goal):
        return f"its goal {request.goal} is taken for ever"
    return "the committed plans leave no way to its goal"


def _why_it_cannot_begin(instance: Instance, committed: Sequence[Plan], request: Robot, now: int) -> str | None:
    places = (request.start, *(stop.resource for stop in request.stops))
    names = ("its start", *("its stop",) * (len(places) - 2), "its goal")
    for (here, name), (there, other) in pairwise(zip(places, names, strict=True)):
        if not leads(instance.graph, here, there):
            return f"no moves lead from {name} {here} to {other} {there}"
    duration = instance.duration(request.id, request.start)
    ready = max(request.release + duration, now)
    if not any(
        stay_fits(window, request.release, ready, duration) for window in windows(instance, committed, request.start)
    ):
        return f"its start {request.start} is taken in [{request.release},{ready}), from its release on"
    return None


def leads(graph: ResourceGraph, start: ResourceId, goal: ResourceId) -> bool:
    """Whether moves lead from the start to the goal."""
    reached, waiting = {start}, [start]
    while waiting:
        further = [target for target in graph.successors[waiting.pop()] if target not in reached]
        reached.update(further)
        waiting.extend(further)
    return goal in reached


def windows(instance: Instance, committed: Sequence[Plan], resource: ResourceId) -> tuple[Window, ...]:
    """The free windows that the committed plans leave at one resource."""
    return free_windows(constraints_on(instance.graph, committed, resource), instance.gap)
