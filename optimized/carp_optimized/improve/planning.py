"""Plans of a crowd in a given time or a number of rounds: the best that can be had (anytime search).

First come plans by LaCAM, and by prioritized planning. With the shortest way first, robots that arrive early park
early, and those that come later go around them. Where that makes jams, passes in other orders follow, else less greedy
ones. Who soon finds no path takes one on which it meets few others, and those are planned again. If that is not much
better than LaCAM, LaCAM follows guides too. Where nothing ends, as many robots as possible are planned one after the
other. Then rounds improve the best plans.

They may raise the sum for a while (simulated annealing, Kirkpatrick et al. 1983): on average by a share of a robot's
mean delay, which falls to 0 as the cube of what is left of the cycle. There are several cycles, each from the best
paths so far. Where there is time for many rounds, each path is one of those that arrive equally early.

The better start may be a trap: where robots with short ways went first through a narrow place, crowds wait behind them,
and no few robots can change that. Plans by LaCAM have no such order. So they come first if they are the better ones
once each robot has been planned again, and most cycles begin from the worse start, unless there are too few rounds to
come down from it, or so little room that LaCAM moves robots to and fro. The last cycle goes on from the best paths.

A clock is looked at after each few milliseconds of work. What takes time at the end is timed on a part before. Where
there is no time to measure all distances, the nearest robots are planned, with distances that end a little beyond
their starts.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import inf
from time import perf_counter

import numpy as np

from carp_optimized.improve.checking import require_lawful
from carp_optimized.improve.crowds import FAR, Crowd, are_apart, crowd_of, is_stepwise, measure, near, only, ways_of
from carp_optimized.improve.guides import guides_of
from carp_optimized.improve.improving import LONGER, Improving, arrivals, paths_of
from carp_optimized.improve.lacam import RUNNING, STEPS, Search
from carp_optimized.improve.rounds import GREEDY, SURE
from carp_optimized.improve.sipp import UNTIL_FOUND
from carp_optimized.improve.stays import Paths, no_paths
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NO_LIMIT
from carp_spec import Instance, Plan, Robot, Solution, Visit
from carp_spec.documents.decoding import without_collection

Advance = Callable[[int, int, int], None]

WORK = 1 << 15
"""The work of one compiled call: some milliseconds."""
PART = 32
"""The robots whose distances one compiled call measures."""
MEASURING = 0.7
"""The part of the time in which the distances of all robots must be measured; else only the nearest are planned."""
DECIDED = 1 / 32
"""The part of the time that measuring must have taken before that is decided: the first few may take longer."""
BEYOND = 64
"""How much further than to its start the distances of a robot are then measured."""
SEARCHING, GUIDING, GUIDED, LAST, LATEST, ALL = 3, 4, 5, 6, 7, 8
"""The eighths of the time after which prioritized planning ends, then LaCAM and guides, then LaCAM with guides.

If LaCAM has plans, guides may take until `GUIDED` and LaCAM with them until `LATEST`: where that matters, rounds gain
little. If nothing has found plans for all, LaCAM goes on until `LAST`, and what is left is for prioritized planning of
as many as possible.
"""
MISSES = 8
"""Prioritized planning gives up when robots have found no path this often, on average."""
HOPE, MANY = 8, 8
"""It gives up after one of `HOPE` parts of its time if it has missed more than one of `MANY` robots."""
SOME, PATIENCE = 64, 3
"""If a pass has missed at most one of `SOME` robots, so many times its time is for these."""
EFFORT = 1000
"""The gaps that a query may look at before the robot takes a way through others: who goes far around comes late.

In larger crowds it may look at all, as ways through others take longer there.
"""
LESS = ((0, 5), (GREEDY // 4, 2))
"""Less greed than `GREEDY`, and how many times as long prioritized planning takes with it."""
JAMMED = 4
"""Other orders are tried where the shortest way first makes paths longer by more than one of so many parts."""
NOISE = (2, 64, 1, 4, 2, 64)
"""The most noise in the orders, in mean ways."""
LARGE, CROWDED = 2000, 4
"""With more robots there is no time for other orders, nor for any if LaCAM's paths are twice the shortest ways."""
LONGEST = 700
"""The visits of a path by prioritized planning, or twice those of the longest way: one through others may be long."""
CYCLES, LEAVING, CHOOSING = 8, 1, 7
"""The cycles; the one that leaves the better start for the worse one, and the one that chooses the best paths."""
FEW, SPARSE = 8, 8
"""The worse start is tried if at least so many rounds a robot are expected, and each robot has so many places."""
HEAT, REHEAT = 64, 16
"""The mean raise of the first rounds of the first cycle and of others, in 16ths of the mean delay of a robot."""
ENOUGH = 32
"""With fewer rounds a robot than this, raises are smaller by the square: there is no time to make up for them."""
SAMPLE, SLOWER = 5000, 4
"""It is timed how long it takes to make that many visits; checking and making plans takes this many times as long."""
PARTS = 1 << 10
"""What is left of the time is counted in parts of this."""


@dataclass(slots=True)
class Clock:
    """The time that is over, as far as it counts: none where rounds are counted."""

    seconds: float | None
    now: Callable[[], float]
    started: float
    visit: float = 0.0
    """The seconds that each visit takes at the end."""
    reserved: float = 0.0
    begun: float = 0.0
    """When those began that share the rest of the time."""

    @property
    def spent(self) -> float:
        """The seconds since the start."""
        return self.now() - self.started

    def left(self, eighths: int = ALL) -> float:
        """The seconds that are left of so many eighths of the time."""
        if self.seconds is None:
            return inf
        return self.begun + (self.seconds - self.reserved - self.begun) * eighths / ALL - self.spent

    def goes_on(self, eighths: int = ALL) -> bool:
        """Whether so many eighths of the time are not over."""
        return self.left(eighths) > 0

    def reserve(self, visits: int) -> None:
        """Leave time for that many visits."""
        self.reserved = self.visit * visits


@dataclass(frozen=True, slots=True)
class Found:
    """What a search has found: a solution, and the sum of costs if each robot with a plan were alone, where known."""

    solution: Solution
    shortest: int | None


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


def plan_crowd(
    instance: Instance,
    *,
    iterations: int | None,
    seconds: float | None,
    seed: int = 0,
    advance: Advance = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
    finish: Callable[[Solution], object] = lambda _: None,
) -> Found | None:
    """Paths for as many robots as possible, by that many rounds or in that many seconds.

    `advance` gets the rounds, the robots without a plan, and the total. The time for `finish`, which the caller does
    with what is found, is part of the seconds: it is timed on a few visits. Equal iterations and seed give an equal
    result. `None` for an instance that is not `is_stepwise`.
    """
    timer = Clock(seconds, clock, clock())
    if not is_stepwise(instance) or not instance.robots:
        return None
    crowd = crowd_of(instance)
    apart = are_apart(crowd)
    rows, crowd = np.flatnonzero(apart), only(crowd, apart)
    timer.visit = time_of_visit(instance, clock, finish)
    is_measured = _measured(crowd, timer)
    if is_measured:
        has_way = ways_of(crowd) < FAR
        rows, crowd = rows[has_way], only(crowd, has_way)
    paths = _paths(crowd, timer, is_measured, iterations, seed, advance)
    require_lawful(crowd, paths)
    solution = solution_along(instance, [instance.robots[row] for row in rows], paths)
    return Found(solution, int(ways_of(crowd)[paths.size > 0].sum()))


def improve_crowd(
    instance: Instance,
    solution: Solution,
    seconds: float,
    *,
    seed: int = 0,
    advance: Advance = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
) -> Solution | None:
    """Better plans by that many seconds of rounds; `None` if a robot has no plan, or the instance is not stepwise."""
    timer = Clock(seconds, clock, clock())
    if len(solution.plans) < len(instance.robots) or not is_stepwise(instance) or not instance.robots:
        return None
    crowd = crowd_of(instance)
    timer.visit = time_of_visit(instance, clock)
    paths = _paths_of_plans(instance, solution)
    timer.reserve(int(paths.size.sum()))
    if not _measured(crowd, timer):
        return solution
    paths = improved(crowd, [paths], None, timer, seed, advance)
    require_lawful(crowd, paths)
    return solution_along(instance, instance.robots, paths)


def _paths_of_plans(instance: Instance, solution: Solution) -> Paths:
    """The plans as paths."""
    index = dict(instance.graph.index)
    row = {robot.id: position for position, robot in enumerate(instance.robots)}
    paths = no_paths(len(row), max(len(each.visits) for each in solution.plans) + LONGER)
    for plan in solution.plans:
        robot, size = row[plan.robot], len(plan.visits)
        paths.size[robot] = size
        paths.place[robot, :size] = [index[each.resource] for each in plan.visits]
        paths.enter[robot, :size] = [each.enter for each in plan.visits]
    return paths


def _measured(crowd: Crowd, timer: Clock) -> bool:
    """Whether the distances of all robots are measured, as there is time for it."""
    native = Native(crowd)
    robots = np.arange(crowd.start.size, dtype=np.int32)
    began, time = timer.spent, timer.seconds or inf
    for done in range(0, robots.size, PART):
        took = timer.spent - began
        expected = took * (robots.size - done) / max(done, 1)
        if took > DECIDED * time and timer.spent + expected > MEASURING * time:
            return False
        measure(native, robots, done, min(done + PART, robots.size), FAR)
        if done == 0:  # the machine code may have to be loaded first
            began = timer.spent
    return True


def _paths(crowd: Crowd, timer: Clock, is_measured: bool, iterations: int | None, seed: int, advance: Advance) -> Paths:
    """The paths of as many robots as possible, and the best ones if all have some."""
    if crowd.start.size == 0:
        return no_paths(0, 1)
    if is_measured:
        timer.reserve(int(ways_of(crowd).sum()))
        timer.begun = timer.spent
        starts = first_paths(crowd, timer, seed)
        timer.begun = 0.0
    else:
        starts = [_nearest(crowd, timer)]
    timer.reserve(max(int(each.size.sum()) for each in starts))
    paths = min(starts, key=_sum)
    if paths.size.all() and timer.goes_on():
        return improved(crowd, starts, iterations, timer, seed, advance)
    advance(0, int(np.count_nonzero(paths.size == 0)), int(arrivals(paths)[paths.size > 0].sum()))
    return paths


def _nearest(crowd: Crowd, timer: Clock) -> Paths:
    """The paths of as many robots as there is time for, about the nearest first, each measured when it is planned."""
    native = Native(crowd)
    order = np.argsort(near(crowd), kind="stable").astype(np.int32)
    improving = Improving(crowd, no_paths(order.size, LONGEST))
    for begin in range(0, order.size, PART):
        part = order[begin : begin + PART]
        if not timer.goes_on():
            break
        measure(native, part, 0, part.size, BEYOND)
        improving.plan_first(part, timer.goes_on, GREEDY, UNTIL_FOUND)
        timer.reserve(int(improving.rounds.paths.size.sum()))
    return improving.rounds.paths


def first_paths(crowd: Crowd, timer: Clock, seed: int) -> list[Paths]:
    """First paths of all robots, the more promising first; those of as many as possible if nothing has all.

    Paths by LaCAM are more promising unless the others are much better.
    """
    search = Search(crowd, seed)
    by_steps = _searched(search, STEPS, lambda: timer.goes_on(GUIDING))
    in_order = _best_in_order(crowd, timer, by_steps, seed)
    has_all = bool(in_order.size.all())
    if has_all and _is_better(crowd, in_order, by_steps):
        return [in_order, *by_steps]
    until, last = (GUIDED, LATEST) if by_steps else (GUIDING, GUIDED)
    for guides in guides_of(crowd, lambda: timer.goes_on(until)):
        found = _searched(Search(crowd, seed, guides), STEPS, lambda: timer.goes_on(last))
        if not found:
            break
        by_steps += found
    if not by_steps and not has_all:
        by_steps = _searched(search, STEPS if timer.seconds is None else NO_LIMIT, lambda: timer.goes_on(LAST))
    if has_all or by_steps:
        return sorted(by_steps, key=_sum)[: 1 if has_all else 2] + [in_order] * has_all
    later = _planned_in_order(crowd, timer, seed, ALL, GREEDY, UNTIL_FOUND, ways_of(crowd))
    return [max(in_order, later, key=lambda each: int(np.count_nonzero(each.size)))]


def _best_in_order(crowd: Crowd, timer: Clock, by_steps: Sequence[Paths], seed: int) -> Paths:
    """The best paths of greedy passes of prioritized planning, or of a less greedy one, as far as there is time."""
    ways = ways_of(crowd)
    is_large = ways.size > LARGE
    best = no_paths(ways.size, 1)
    if is_large and any(2 * _sum(each) >= CROWDED * int(ways.sum()) for each in by_steps):
        return best
    longest, effort = 0.0, UNTIL_FOUND if is_large else EFFORT
    for keys in [ways] if is_large else _orders(ways, seed):
        if 0 < longest >= timer.left(SEARCHING):
            break
        began = timer.spent
        until = ALL if by_steps and is_large else SEARCHING
        found = _planned_in_order(crowd, timer, seed, until, GREEDY, effort, keys)
        longest = max(longest, timer.spent - began)
        best = min(best, found, key=_badness)
        if by_steps and not best.size.all():
            break
        if not found.size.all():
            effort = UNTIL_FOUND
        is_short_first = keys is ways and bool(best.size.all())
        if is_short_first and (is_large or JAMMED * _sum(best) < (JAMMED + 1) * int(ways.sum())):
            less = _less_greedy(crowd, timer, by_steps, seed, best, effort, timer.spent - began)
            return min(less, best, key=_badness)
    return best


def _orders(ways: Ints, seed: int) -> Iterator[Ints]:
    """Keys for orders of robots: any order, the shortest and the longest way first, and the shortest with noise.

    The shortest way first is the best order where that leads to few delays. Else robots that park early hold up others.
    """
    stream = np.random.default_rng(seed)
    yield stream.permutation(ways.size).astype(np.int32)
    yield ways
    yield -ways
    for most in NOISE:
        yield ways + stream.integers(0, 1 + most * int(ways.mean()), ways.size, dtype=np.int32)


def _less_greedy(
    crowd: Crowd, timer: Clock, by_steps: Sequence[Paths], seed: int, greedy: Paths, effort: int, took: float
) -> Paths:
    """The paths of a less greedy pass than one that took so long, if there is time for it.

    There is more time for what is likely to be much better than paths by LaCAM.
    """
    until, share = (LAST, 1) if _is_better(crowd, greedy, by_steps) else (SEARCHING, 4)
    for greed, times in LESS:
        if share * times * took < timer.left(until):
            return _planned_in_order(crowd, timer, seed, until, greed, times * effort, ways_of(crowd))
    return greedy


def _badness(paths: Paths) -> tuple[int, int]:
    """The robots without a path, and the sum of the others' arrivals."""
    return int(np.count_nonzero(paths.size == 0)), int(arrivals(paths)[paths.size > 0].sum())


def _is_better(crowd: Crowd, in_order: Paths, by_steps: Sequence[Paths]) -> bool:
    """Whether the delays of paths by LaCAM are more than 1.5 times those of others."""
    least = int(ways_of(crowd).sum())
    return all(3 * (_sum(in_order) - least) < 2 * (_sum(each) - least) for each in by_steps)


def _sum(paths: Paths) -> int:
    return int(arrivals(paths).sum())


def _searched(search: Search, steps: int, goes_on: Callable[[], bool]) -> list[Paths]:
    """The paths of all robots by LaCAM, if they are found in that many steps and in time."""
    last = min(search.tried + steps, NO_LIMIT)
    while search.outcome == RUNNING and search.tried < last and goes_on():
        search.go(8)
    return [] if search.ways is None else [paths_of(search.ways)]


def _planned_in_order(crowd: Crowd, timer: Clock, seed: int, until: int, greed: int, effort: int, keys: Ints) -> Paths:
    """The paths of a pass of prioritized planning, and then of the robots that it missed, as long as they get fewer."""
    robots = crowd.start.size
    room = max(LONGEST, 2 * int(ways_of(crowd).max()))
    improving = Improving(crowd, no_paths(robots, room), seed)
    begun, time = timer.spent, timer.seconds or inf

    def goes_on(*, is_likely: bool) -> bool:
        return timer.goes_on(until) and (is_likely or HOPE * (timer.spent - begun) < time)

    order = np.argsort(keys, kind="stable").astype(np.int32)
    improving.plan_first(order, lambda: goes_on(is_likely=MANY * improving.missed <= robots), greed, effort)
    missing = int(np.count_nonzero(improving.rounds.paths.size == 0))
    last = improving.missed + MISSES * robots
    patient = begun + PATIENCE * (timer.spent - begun) * (SOME * missing <= robots)
    half, halved, halving = missing, begun, 0.0

    def gets_fewer(waiting: int) -> bool:
        nonlocal half, halved, halving
        if 2 * waiting <= half:
            half, halved, halving = waiting, timer.spent, timer.spent - halved
        is_soon = waiting.bit_length() * max(halving, timer.spent - halved) < 2 * timer.left()
        return improving.missed < last and goes_on(is_likely=is_soon or timer.spent < patient)

    return improving.make_way(gets_fewer)


def improved(
    crowd: Crowd, starts: Sequence[Paths], iterations: int | None, timer: Clock, seed: int, advance: Advance
) -> Paths:
    """The best paths that rounds make of the better start, and in some cycles of the other one, if there is one.

    The first start is the better one, unless the second still is after each robot has been planned again.
    """
    searches, other = _begun(crowd, starts[0], timer, seed), starts[1:2]
    if searches and other and _sum(other[0]) < searches[0].best:
        searches, other = _begun(crowd, other[0], timer, seed) + searches, []
        searches.sort(key=lambda each: each.best, reverse=True)
    if not searches:
        return min(starts, key=_sum)
    robots = crowd.start.size
    least = int(ways_of(crowd).sum())
    current = 0
    for gone, rounds in _parts(iterations, timer, searches):
        cycle, part = divmod(CYCLES * gone, PARTS)
        expected = iterations or PARTS * _played(searches) // max(gone, 1)
        if cycle > current:
            current = cycle
            if cycle == LEAVING and FEW * robots <= expected and SPARSE * robots <= crowd.queue.size:
                searches.reverse()
                for paths in other:
                    searches += _begun(crowd, paths, timer, seed)
            elif cycle == CHOOSING:
                searches.sort(key=lambda each: each.best, reverse=True)
            if searches[-1].total > searches[-1].best and not searches[-1].return_to_best(timer.goes_on):
                break
        improving = searches[-1]
        heat = (REHEAT if cycle else HEAT) * (improving.total - least)
        improving.play(rounds, WORK, _chance(heat, robots, expected, PARTS - part), turning=expected >= ENOUGH * robots)
        best = min(each.best for each in searches)
        advance(_played(searches), 0, best)
        if best == least:
            break
    return min(*(each.rounds.best for each in searches), *starts, key=_sum)


def _begun(crowd: Crowd, paths: Paths, timer: Clock, seed: int) -> list[Improving]:
    """A search from these paths in which each robot has been planned again; none if there is no time for it."""
    improving = Improving(crowd, paths, seed)
    if not improving.begin(timer.goes_on):
        return []
    delays = arrivals(paths) - improving.rounds.least
    improving.plan_each(np.argsort(-delays, kind="stable").astype(np.int32), timer.goes_on, GREEDY)
    return [improving]


def _played(searches: Sequence[Improving]) -> int:
    return sum(each.played for each in searches)


def _parts(iterations: int | None, timer: Clock, searches: Sequence[Improving]) -> Iterator[tuple[int, int]]:
    """The parts of the time, or of the rounds, that are gone, and how many rounds to play next at most."""
    started = timer.spent
    while timer.goes_on():
        if iterations is None:
            left = (timer.seconds or 0) - timer.reserved - started
            yield min(int(PARTS * (timer.spent - started) / left), PARTS - 1), SURE
        elif _played(searches) < iterations:
            played = _played(searches)
            yield PARTS * played // iterations, min(iterations - played, 100)
        else:
            break


def _chance(heated: int, robots: int, rounds: int, left: int) -> int:
    """The chance of each further tick of a raise, in parts of `SURE`; it makes the mean raise what it is to be.

    `heated` is the delay of all robots times the heat, and `rounds` are those expected.
    """
    enough = ENOUGH * robots
    mean = heated * min(rounds, enough) ** 2 * left**3
    return SURE * mean // (mean + 16 * robots * enough**2 * PARTS**3)


def time_of_visit(
    instance: Instance, clock: Callable[[], float], finish: Callable[[Solution], object] = lambda _: None
) -> float:
    """The seconds that it takes to check a path, to make its plan and to finish with it, for each visit.

    What a solution of no visits takes does not count: that of 10,000 robots takes as long as 20,000 visits.
    """
    ticks = np.arange(SAMPLE, dtype=np.int32)[np.newaxis]
    spent = []
    for visits in (SAMPLE, 0, SAMPLE):  # the first time takes longer
        started = clock()
        finish(solution_along(instance, instance.robots[:1], Paths(np.full(1, visits, np.int32), 0 * ticks, ticks)))
        spent.append(clock() - started)
    return SLOWER * max(spent[2] - spent[1], 0.0) / SAMPLE
