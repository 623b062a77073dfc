"""Why a robot is unplanned, for the person who asked."""

from collections.abc import Sequence

from carp_spec import Instance, Plan, ResourceGraph, ResourceId, RobotId
from carp_spec.windows import Window, constraints_on, free_windows, stay_fits


def why_unplanned(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> str:
    """One clause that says why CARP finds no plan for a robot that has none against the committed plans."""
    request = instance.robot[robot]
    if not leads(instance.graph, request.start, request.goal):
        return f"no moves lead from its start {request.start} to its goal {request.goal}"
    duration = instance.duration(robot, request.start)
    ready = max(request.release + duration, now)
    if not any(
        stay_fits(window, request.release, ready, duration) for window in windows(instance, committed, request.start)
    ):
        return f"its start {request.start} is taken in [{request.release},{ready}), from its release on"
    at_goal = windows(instance, committed, request.goal)
    if instance.after_goal == "park" and all(window.end is not None for window in at_goal):
        return f"its goal {request.goal} is taken for ever"
    return "the committed plans leave no way to its goal"


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
