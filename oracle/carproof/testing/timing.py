"""Timing of a path: the ticks at which a robot that follows a path is in each resource, against committed plans."""

from collections.abc import Sequence
from dataclasses import dataclass

from carp_reference.context import Context, context_of
from carp_spec import Instance, Plan, ResourceGraph, ResourceId, Robot, Visit
from carp_spec.windows import Window, stay_fits


@dataclass(frozen=True, slots=True)
class Entry:
    """A window of the path's next resource, entered at `enter` after the visits `before`."""

    resource: ResourceId
    window: Window
    enter: int
    before: tuple[Visit, ...] = ()


def path_between(graph: ResourceGraph, source: ResourceId, target: ResourceId) -> tuple[ResourceId, ...]:
    """A path of the fewest moves, or no resource at all if none exists."""
    paths: dict[ResourceId, tuple[ResourceId, ...]] = {source: (source,)}
    for reached in (queue := [source]):
        for following in graph.successors[reached]:
            if following not in paths:
                paths[following] = (*paths[reached], following)
                queue.append(following)
    return paths.get(target, ())


def path_over(graph: ResourceGraph, robot: Robot, over: ResourceId) -> tuple[ResourceId, ...]:
    """A path from the robot's start over a resource, if that is possible, and its stops; `()` if none exists."""
    path = [robot.start]
    for target in (over, *(stop.resource for stop in robot.stops)):
        further = path_between(graph, path[-1], target)
        if not further:
            return () if over == robot.start else path_over(graph, robot, robot.start)
        path.extend(further[1:])
    return tuple(path)


def _stays(instance: Instance, robot: Robot, path: Sequence[ResourceId], waits: Sequence[int]) -> list[int]:
    """The least stays of a robot on a path over its stops, each longer by a wait; it serves each where it may."""
    stays = [instance.duration(robot.id, resource) + wait for resource, wait in zip(path, waits, strict=True)]
    *first, last = robot.stops
    served = 0
    for place, resource in enumerate(path[:-1]):
        if served < len(first) and resource == first[served].resource:
            stays[place] = max(stays[place], first[served].service)
            served += 1
    stays[-1] = max(stays[-1], last.service)
    return stays


def timed_plan(
    instance: Instance, committed: Sequence[Plan], robot: Robot, path: Sequence[ResourceId], waits: Sequence[int]
) -> Plan | None:
    """The plan along the path that stays so many ticks longer than it must in each resource and arrives first.

    The path leads from the robot's start over its stops to its goal. `None`: there is no path, or it is not free.
    """
    if not path:
        return None
    context, release = context_of(instance, committed), robot.release
    stays = _stays(instance, robot, path, waits)
    entries = [
        Entry(path[0], window, release)
        for window in context.windows(path[0])
        if stay_fits(window, release, release + stays[0], stays[0])
    ]
    for resource, stay_before, stay in zip(path[1:], stays, stays[1:], strict=False):
        entries = _next_entries(context, entries, resource, stay_before, stay)
    if instance.after_goal == "park":
        entries = [entry for entry in entries if entry.window.end is None]
    if not entries:
        return None
    last = min(entries, key=lambda entry: entry.enter)
    leave = None if instance.after_goal == "park" else last.enter + stays[-1]
    return Plan(robot.id, (*last.before, Visit(last.resource, last.enter, leave)))


def _next_entries(
    context: Context, entries: Sequence[Entry], resource: ResourceId, stay_before: int, stay: int
) -> list[Entry]:
    """The earliest entry into each window of the next resource."""
    following: list[Entry] = []
    for window in context.windows(resource):
        possible = []
        for entry in entries:
            enter = max(entry.enter + stay_before, window.start)
            while context.is_exchange(enter, entry.resource, resource):
                enter += 1
            if entry.window.lasts_until(enter) and stay_fits(window, enter, enter + stay, stay):
                visits = (*entry.before, Visit(entry.resource, entry.enter, enter))
                possible.append(Entry(resource, window, enter, visits))
        following.extend(sorted(possible, key=lambda entry: entry.enter)[:1])
    return following
