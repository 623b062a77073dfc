"""Plans of a crowd in a given time or a number of rounds: the best that can be had (anytime search).

First come plans by LaCAM, and by prioritized planning with the shortest way first: robots that arrive early park early,
and those that come later go around them. Then rounds improve the better ones. They may raise the sum for a while
(simulated annealing, Kirkpatrick et al. 1983): on average by a share of a robot's mean delay, which falls to 0 as the
cube of what is left of the cycle. There are several cycles, each from the best paths so far.

A clock is looked at after each few milliseconds of work. What takes time at the end is timed on a part before.
"""

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from carp_optimized.improve.checking import require_lawful
from carp_optimized.improve.crowds import Crowd, can_begin, crowd_of, is_stepwise, measure
from carp_optimized.improve.improving import Improving, arrivals, paths_of
from carp_optimized.improve.lacam import RUNNING, STEPS, Search
from carp_optimized.improve.rounds import SURE
from carp_optimized.improve.stays import Paths, no_paths
from carp_optimized.jit.kinds import IntTable
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NO_LIMIT
from carp_spec import Instance, Plan, Solution, Visit

Advance = Callable[[int, int, int], None]

WORK = 1 << 15
"""The work of one compiled call: some milliseconds."""
ATTEMPTS = 50
"""Orders of prioritized planning where LaCAM finds no plans; else one that fails is not worth another."""
SHARE = 3
"""The part of the time that LaCAM has at first, and prioritized planning beside it: one of this many."""
LONGEST = 700
"""The visits of a path by prioritized planning, if LaCAM has found none that shows how many they are."""
CYCLES = 8
HEAT, REHEAT = 64, 16
"""The mean raise of the first rounds of the first cycle and of others, in 16ths of the mean delay of a robot."""
ENOUGH = 32
"""With fewer rounds a robot than this, raises are smaller by the square: there is no time to make up for them."""
SAMPLE, SLOWER = 5000, 2
"""It is timed how long it takes to make that many visits; checking and making plans takes this many times as long."""
PARTS = 1 << 10
"""What is left of the time is counted in parts of this."""


@dataclass(slots=True)
class Clock:
    """The time that is over, as far as it counts: none where rounds are counted."""

    seconds: float | None
    now: Callable[[], float]
    started: float
    reserved: float = 0.0

    @property
    def spent(self) -> float:
        """The seconds since the start."""
        return self.now() - self.started

    def goes_on(self, share: int = 1) -> bool:
        """Whether the time, or one of so many parts of it, is not over."""
        return self.seconds is None or self.spent < (self.seconds - self.reserved) / share


def plan_crowd(
    instance: Instance,
    *,
    iterations: int | None,
    seconds: float | None,
    seed: int = 0,
    advance: Advance = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
) -> Solution | None:
    """Plans for as many robots as possible, by that many rounds or in that many seconds.

    `advance` gets the rounds, the robots without a plan, and the total. Equal iterations and seed give an equal
    solution. `None` for an instance that is not `is_stepwise`, and where robots cannot all have plans.
    """
    timer = Clock(seconds, clock, clock())
    if not is_stepwise(instance) or not instance.robots:
        return None
    crowd = crowd_of(instance)
    native = Native(crowd)
    robots = crowd.start.size
    for robot in range(0, robots, 8):
        if not timer.goes_on():
            return Solution.of(instance, ())
        measure(native, robot, min(robot + 8, robots))
    if not can_begin(crowd):
        return None
    timer.reserved = _time_to_end(instance, int(crowd.distance[np.arange(robots), crowd.start].sum()), clock)
    paths = first_paths(crowd, timer, seed)
    if paths.size.all():
        timer.reserved = _time_to_end(instance, int(paths.size.sum()), clock)
        paths = improved(crowd, paths, iterations, timer, seed, advance)
    require_lawful(crowd, paths)
    with _without_collection():
        return Solution.of(instance, plans_along(instance, paths))


def first_paths(crowd: Crowd, timer: Clock, seed: int) -> Paths:
    """The better paths of LaCAM and of prioritized planning; of as many robots as possible if neither has all."""
    search = Search(crowd, seed)
    ways = _searched(search, STEPS, lambda: timer.goes_on(SHARE))
    if ways is not None:
        by_steps = paths_of(ways)
        in_order = _planned_in_order(crowd, timer, SHARE, by_steps.place.shape[1], 1)
        has_all = bool(in_order.size.all())
        return in_order if has_all and arrivals(in_order).sum() < arrivals(by_steps).sum() else by_steps
    in_order = _planned_in_order(crowd, timer, 2, LONGEST, ATTEMPTS)
    if in_order.size.all():
        return in_order
    ways = _searched(search, STEPS if timer.seconds is None else NO_LIMIT, timer.goes_on)
    return in_order if ways is None else paths_of(ways)


def _searched(search: Search, steps: int, goes_on: Callable[[], bool]) -> IntTable | None:
    """The places of all robots, tick by tick, if they are found in that many steps and in time."""
    last = min(search.tried + steps, NO_LIMIT)
    while search.outcome == RUNNING and search.tried < last and goes_on():
        search.go(8)
    return search.ways


def _planned_in_order(crowd: Crowd, timer: Clock, share: int, room: int, attempts: int) -> Paths:
    """The paths of the best of some passes, each with the robots first that the one before left out."""
    robots = crowd.start.size
    ways = crowd.distance[np.arange(robots), crowd.start]
    order = np.argsort(ways, kind="stable").astype(np.int32)
    best = no_paths(robots, room)
    for _ in range(attempts):
        improving = Improving(crowd, no_paths(robots, room))
        improving.plan_first(order, lambda: timer.goes_on(share))
        paths = improving.rounds.paths
        if np.count_nonzero(paths.size) > np.count_nonzero(best.size):
            best = paths
        if best.size.all() or not timer.goes_on(share):
            break
        order = order[np.argsort(paths.size[order] > 0, kind="stable")]
    return best


def improved(crowd: Crowd, paths: Paths, iterations: int | None, timer: Clock, seed: int, advance: Advance) -> Paths:
    """The best paths that rounds make of these."""
    improving = Improving(crowd, paths, seed)
    improving.begin()
    robots = crowd.start.size
    least = int(improving.rounds.least.sum())
    delays = arrivals(paths) - improving.rounds.least
    improving.plan_each(np.argsort(-delays, kind="stable").astype(np.int32), timer.goes_on)
    current = 0
    for gone, rounds in _parts(iterations, timer, improving):
        cycle, part = divmod(CYCLES * gone, PARTS)
        if cycle > current:
            current = cycle
            if improving.total > improving.best:
                improving.return_to_best()
        expected = iterations or PARTS * improving.played // max(gone, 1)
        heat = (REHEAT if cycle else HEAT) * (improving.total - least)
        improving.play(rounds, WORK, _chance(heat, robots, expected, PARTS - part))
        advance(improving.played, 0, improving.best)
        if improving.best == least:
            break
    return improving.rounds.best


def _parts(iterations: int | None, timer: Clock, improving: Improving) -> Iterator[tuple[int, int]]:
    """The parts of the time, or of the rounds, that are gone, and how many rounds to play next at most."""
    started = timer.spent
    while timer.goes_on():
        if iterations is None:
            left = (timer.seconds or 0) - timer.reserved - started
            yield min(int(PARTS * (timer.spent - started) / left), PARTS - 1), SURE
        elif improving.played < iterations:
            yield PARTS * improving.played // iterations, min(iterations - improving.played, 100)
        else:
            break


def _chance(heated: int, robots: int, rounds: int, left: int) -> int:
    """The chance of each further tick of a raise, in parts of `SURE`; it makes the mean raise what it is to be.

    `heated` is the delay of all robots times the heat, and `rounds` are those expected.
    """
    enough = ENOUGH * robots
    mean = heated * min(rounds, enough) ** 2 * left**3
    return SURE * mean // (mean + 16 * robots * enough**2 * PARTS**3)


@contextmanager
def _without_collection() -> Iterator[None]:
    """Collect no garbage: there is none, and to look for it at each thousand visits takes longer than to make them."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def plans_along(instance: Instance, paths: Paths) -> Iterator[Plan]:
    """The plans of robots with these paths, but for those without any."""
    names = [each.id for each in instance.graph.resources]
    parks = instance.after_goal == "park"
    for row, (robot, size) in enumerate(zip(instance.robots, paths.size.tolist(), strict=True)):
        if size == 0:
            continue
        enters: list[int] = paths.enter[row, :size].tolist()
        leaves = [*enters[1:], None if parks else enters[-1] + 1]
        yield Plan(
            robot.id, tuple(map(Visit, map(names.__getitem__, paths.place[row, :size].tolist()), enters, leaves))
        )


def _time_to_end(instance: Instance, visits: int, clock: Callable[[], float]) -> float:
    """The seconds that it takes to check paths with that many visits, and to make plans of them."""
    resource = instance.graph.resources[0].id
    with _without_collection():
        started = clock()
        made = tuple(Visit(resource, tick, tick + 1) for tick in range(SAMPLE))
        return SLOWER * (clock() - started) * visits / len(made)
