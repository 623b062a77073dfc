"""Plans for robots left out: they take the way of others, who are planned again (ejection chains, Glover 1996).

A robot left out is given a plan beside the others but for a few: those that it would meet first if it went as if it
were alone. These are planned again. If one of them finds no plan, it is the next that is left out. If more do, all is
as before, and the robot comes again behind the others left out. The more often it has come, the more robots may make
way for it at once. So at no time more robots are left out than before. Nothing here is trusted: the law judges the
plans.
"""

from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.meetings import first_meetings
from carp_optimized.settling import plan_again
from carp_optimized.state.arrays import ALONE, NEVER, NONE
from carp_spec.permutations import shuffle, splitmix64

DOUBLINGS = 4
"""At first at most 2 to this power of robots make way; as many again, and so on, until the robot finds a plan."""


def plan_left_out(
    fleet: PlannedFleet, goes_on: Callable[[], bool], asked: int = ALONE, *, times: int = NEVER, seed: int = 0
) -> None:
    """Plan the robots of a fleet that have no plan, as long as it goes on; each comes at most so many times."""
    stream = splitmix64(seed)
    waiting = deque(robot for robot in fleet.robots.tolist() if fleet.held[robot] == NONE)
    came: Counter[int] = Counter()
    while waiting and goes_on():
        robot = waiting.popleft()
        came[robot] += 1
        if came[robot] <= times:
            step = 1 << min(next(stream) % came[robot], DOUBLINGS)
            waiting += _left_out_then(fleet, robot, step, goes_on, asked, stream)


def _left_out_then(
    fleet: PlannedFleet, robot: int, step: int, goes_on: Callable[[], bool], asked: int, stream: Iterator[int]
) -> list[int]:
    """Plan a robot in the way of others; who is left out then: nobody, one of them, or the robot, if all is as before.

    Nobody is, too, if the robot has no path.
    """
    if plan_again(fleet, robot, asked=asked):
        return []
    fleet.forget_old_records()
    order, held = fleet.planned, fleet.held
    met = _in_the_way(fleet, robot, asked)
    if met is None:
        return []
    gone: list[int] = []
    while len(gone) < len(met) and goes_on():
        gone += met[len(gone) : len(gone) + step]
        fleet.withdraw(gone)
        step += step
        if plan_again(fleet, robot, asked=asked):
            failed = _planned_again(fleet, shuffle(gone, stream), goes_on, asked)
            if failed is not None:
                return failed
            break
    fleet.withdraw([robot, *gone])
    back = np.array(gone, np.int32)
    fleet.reserve(back, held[back])
    fleet.hold(order, held[order])
    return [robot]


def _planned_again(
    fleet: PlannedFleet, robots: Sequence[int], goes_on: Callable[[], bool], asked: int
) -> list[int] | None:
    """Plan robots one after the other: the one that finds no plan, if any; `None` if several do, or time is over."""
    failed: list[int] = []
    for robot in robots:
        if not goes_on():
            return None
        if not plan_again(fleet, robot, asked=asked):
            failed.append(robot)
        if len(failed) > 1:
            return None
    return failed


def _in_the_way(fleet: PlannedFleet, robot: int, asked: int) -> list[int] | None:
    """The robots that one would meet if it went as if it were alone, first those met first; `None` without a path."""
    plan = fleet.call(lambda: passes.find_one(fleet.empty, robot, NONE, 0, asked))
    if plan == NONE:
        return None
    planned, size = fleet.planned, fleet.state.graph.room.size
    ticks = np.zeros(planned.size, np.int32)
    scratch = np.zeros(size, np.int32), np.zeros(size, np.int32)
    first_meetings(fleet.native, plan, fleet.held[planned], *scratch, ticks)
    met = planned[np.argsort(ticks, kind="stable")][: np.count_nonzero(ticks < NEVER)]
    return [int(each) for each in met]
