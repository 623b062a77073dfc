"""Why a robot is unplanned, for the person who asked."""

from collections.abc import Sequence

from carp_reference.context import context_of
from carp_reference.problem import ticks_to_goal
from carp_spec import Instance, Plan, RobotId
from carp_spec.windows import stay_fits


def why_unplanned(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> str:
    """One clause that says why CARP finds no plan for a robot that has none against the committed plans."""
    request = instance.robot[robot]
    if request.start not in ticks_to_goal(instance, request):
        return f"no moves lead from its start {request.start} to its goal {request.goal}"
    context = context_of(instance, committed)
    duration = instance.duration(robot, request.start)
    ready = max(request.release + duration, now)
    if not any(stay_fits(window, request.release, ready, duration) for window in context.windows(request.start)):
        return f"its start {request.start} is taken in [{request.release},{ready}), from its release on"
    if instance.after_goal == "park" and all(window.end is not None for window in context.windows(request.goal)):
        return f"its goal {request.goal} is taken for ever"
    return "the committed plans leave no way to its goal"
