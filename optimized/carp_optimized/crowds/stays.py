"""Who is where, and when: for each resource a row of stays in order of time, and the paths that they come from.

No stay is for ever in a crowd that vanishes, and the last one of each path is in one that parks. A row has room for a
certain number of stays. A full one makes a round end; the caller makes more room and asks again.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, IntTable
from carp_optimized.state.arrays import NEVER, NONE
from carp_spec import Instance, Plan, Robot, Solution, Visit
from carp_spec.documents.decoding import without_collection

SPARE = 6
"""The stays for which each row has room, beside half as many again as it holds."""


class Stays(NamedTuple):
    """The stays in r are `first[r]` to `first[r] + size[r]`; its room ends at `first[r + 1]`."""

    first: Ints
    size: Ints
    place: Ints
    enter: Ints
    leave: Ints
    robot: Ints


class Paths(NamedTuple):
    """Rows of visits: to `place[row][k]` at the tick `enter[row][k]`, until the next; `size[row]` of them."""

    size: Ints
    place: IntTable
    enter: IntTable


def no_paths(rows: int, room: int) -> Paths:
    """Rows without visits, with room for that many."""
    return Paths(np.zeros(rows, np.int32), np.empty((rows, room), np.int32), np.empty((rows, room), np.int32))


def solution_along(instance: Instance, robots: Iterable[Robot], paths: Paths) -> Solution:
    """The plans of robots along their paths; a row without visits is no path."""
    names = [each.id for each in instance.graph.resources]
    parks = instance.after_goal == "park"

    def plans() -> Iterator[Plan]:
        for row, (robot, size) in enumerate(zip(robots, paths.size.tolist(), strict=True)):
            if size > 0:
                enters: list[int] = paths.enter[row, :size].tolist()
                leaves = [*enters[1:], None if parks else enters[-1] + 1]
                places = map(names.__getitem__, paths.place[row, :size].tolist())
                yield Plan(robot.id, tuple(map(Visit, places, enters, leaves)))

    with without_collection():
        return Solution.of(instance, plans())


def no_stays(visits: Ints) -> Stays:
    """Rows without stays, with room for that many in each resource, and some more."""
    rooms = visits + visits // 2 + SPARE
    first = np.zeros(rooms.size + 1, np.int32)
    np.cumsum(rooms, out=first[1:])
    total = int(first[-1])
    return Stays(
        first=first,
        size=np.zeros(rooms.size, np.int32),
        place=np.repeat(np.arange(rooms.size, dtype=np.int32), rooms),
        enter=np.empty(total, np.int32),
        leave=np.empty(total, np.int32),
        robot=np.empty(total, np.int32),
    )


def with_more_room(stays: Stays) -> Stays:
    """The same stays, with more room in each row: when one is full, others nearly are."""
    larger = no_stays(stays.size + SPARE)
    ranks = np.arange(int(stays.size.sum())) - np.repeat(np.cumsum(stays.size) - stays.size, stays.size)
    before = np.repeat(stays.first[:-1], stays.size) + ranks
    after = np.repeat(larger.first[:-1], stays.size) + ranks
    for name in ("enter", "leave", "robot"):
        getattr(larger, name)[after] = getattr(stays, name)[before]
    larger.size[:] = stays.size
    return larger


@compiled
def later_than(stays: Stays, place: int, tick: int) -> int:
    """The number of stays in the place that begin by the tick; they come before all others."""
    first = int(stays.first[place])
    low = 0
    high = int(stays.size[place])
    while low < high:
        middle = (low + high) // 2
        if stays.enter[first + middle] <= tick:
            low = middle + 1
        else:
            high = middle
    return low


@compiled
def start_of(stays: Stays, gap: int) -> int:
    """The tick at which the gap before a stay begins: the robot that stays there before has left."""
    return int(stays.leave[gap - 1]) if gap > stays.first[stays.place[gap]] else 0


@compiled
def end_of(stays: Stays, gap: int) -> int:
    """The tick at which the gap before a stay ends: its robot enters."""
    place = int(stays.place[gap])
    return int(stays.enter[gap]) if gap < stays.first[place] + stays.size[place] else NEVER


@compiled
def robot_at(stays: Stays, place: int, tick: int) -> int:
    """The robot that is in the place at the tick, or `NONE`."""
    at = int(stays.first[place]) + later_than(stays, place, tick) - 1
    if at < stays.first[place] or stays.leave[at] <= tick:
        return NONE
    return int(stays.robot[at])


@compiled
def leave_of(crowd: Crowd, paths: Paths, row: int, visit: int) -> int:
    """The tick at which a visit ends."""
    if visit + 1 < paths.size[row]:
        return int(paths.enter[row][visit + 1])
    return NEVER if crowd.parks else int(paths.enter[row][visit]) + 1


@compiled
def met_at(crowd: Crowd, stays: Stays, paths: Paths, row: int, visit: int) -> int:
    """A robot that a path meets in the place of a visit, or on the way to it, or `NONE`."""
    place = int(paths.place[row][visit])
    enter = int(paths.enter[row][visit])
    at = int(stays.first[place]) + later_than(stays, place, leave_of(crowd, paths, row, visit) - 1) - 1
    if at >= stays.first[place] and stays.leave[at] > enter:
        return int(stays.robot[at])
    other = robot_at(stays, place, enter - 1) if visit > 0 else NONE
    if other != NONE and robot_at(stays, int(paths.place[row][visit - 1]), enter) == other:
        return other
    return NONE


@compiled
def put(crowd: Crowd, stays: Stays, paths: Paths, row: int, robot: int) -> bool:
    """Add the stays of a path; `False` if a row of stays is full, and then none is added."""
    for visit in range(int(paths.size[row])):
        leave = leave_of(crowd, paths, row, visit)
        if not put_stay(stays, int(paths.place[row][visit]), int(paths.enter[row][visit]), leave, robot):
            drop(stays, paths, row, visit)
            return False
    return True


@compiled
def put_stay(stays: Stays, place: int, enter: int, leave: int, robot: int) -> bool:
    """Add a stay, unless the row is full; whether it is added."""
    size = int(stays.size[place])
    first = int(stays.first[place])
    if first + size + 1 >= stays.first[place + 1]:
        return False
    at = first + size
    while at > first and stays.enter[at - 1] > enter:
        stays.enter[at] = stays.enter[at - 1]
        stays.leave[at] = stays.leave[at - 1]
        stays.robot[at] = stays.robot[at - 1]
        at -= 1
    stays.enter[at] = enter
    stays.leave[at] = leave
    stays.robot[at] = robot
    stays.size[place] = size + 1
    return True


@compiled
def drop(stays: Stays, paths: Paths, row: int, visits: int) -> None:
    """Remove the stays of the first visits of a path."""
    for visit in range(visits):
        drop_stay(stays, int(paths.place[row][visit]), int(paths.enter[row][visit]))


@compiled
def drop_stay(stays: Stays, place: int, enter: int) -> None:
    """Remove the stay that begins at the tick."""
    last = int(stays.first[place]) + int(stays.size[place]) - 1
    at = int(stays.first[place]) + later_than(stays, place, enter) - 1
    while at < last:
        stays.enter[at] = stays.enter[at + 1]
        stays.leave[at] = stays.leave[at + 1]
        stays.robot[at] = stays.robot[at + 1]
        at += 1
    stays.size[place] -= 1


@compiled
def copy_path(source: Paths, row: int, target: Paths, to: int) -> None:
    """Make a row the same as another."""
    target.size[to] = source.size[row]
    for visit in range(int(source.size[row])):
        target.place[to][visit] = source.place[row][visit]
        target.enter[to][visit] = source.enter[row][visit]


@compiled
def arrival(paths: Paths, row: int) -> int:
    """The tick at which the last visit begins."""
    return int(paths.enter[row][int(paths.size[row]) - 1])
