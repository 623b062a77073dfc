"""Plans of a crowd in a given time or a number of rounds: the best that can be had (anytime search).

First come paths by LaCAM and by prioritized planning (`carp_optimized.improve.first_paths`). Then rounds improve the
best ones (`carp_optimized.improve.cycles`). What takes time at the end is timed on a part before.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf
from time import perf_counter

import numpy as np

from carp_optimized.crowds.checking import require_lawful
from carp_optimized.crowds.crowd import FAR, Crowd, are_apart, crowd_of, first, is_stepwise, only, ways_of
from carp_optimized.crowds.distances import PART, are_right, estimate, landmarks_of, measure, near
from carp_optimized.crowds.improving import LONGER, arrivals, total_of
from carp_optimized.crowds.stays import Paths, no_paths, solution_along
from carp_optimized.improve.clock import Clock
from carp_optimized.improve.cycles import Advance, improved
from carp_optimized.improve.first_paths import first_paths
from carp_optimized.jit.kinds import Flags, Ints
from carp_optimized.jit.references import Native
from carp_spec import Instance, Solution

LONG, MEASURING = 1 / 8, 0.7
"""The parts of the time in which all distances must be measured where estimates are as good, and where not."""
NEAREST = 2 / 3
"""Else those of the nearest robots are found until this part of what their visits leave is over; no others."""
LOADING = 4 * PART
"""The robots after which it is decided: the machine code may have to be loaded first."""
SAMPLE, SAMPLES, SLOWER = 5000, 4, 2
"""The least time counts that so many visits take to make; checking and making all takes at most this many times it."""


@dataclass(frozen=True, slots=True)
class Found:
    """What a search has found: a solution, and the sum of costs if each robot with a plan were alone, where known."""

    solution: Solution
    shortest: int | None


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
    result. `None` for an instance that is not `is_stepwise`, and for ways longer than distances are measured.
    """
    timer = Clock(seconds, clock, clock())
    if not is_stepwise(instance) or not instance.robots:
        return None
    crowd = crowd_of(instance)
    apart = _apart(crowd, timer)
    if apart is None:
        return None
    rows, crowd = np.flatnonzero(apart), only(crowd, apart)
    timer.visit = time_of_visit(instance, clock, finish)
    crowd, found, is_measured = _with_distances(crowd, timer)
    if _may_be_further(crowd):
        return None
    rows = rows[found]
    has_way = ways_of(crowd) < FAR
    rows, crowd = rows[has_way], only(crowd, has_way)
    paths = _paths(crowd, timer, iterations, seed, advance)
    require_lawful(crowd, paths)
    solution = solution_along(instance, [instance.robots[row] for row in rows], paths)
    return Found(solution, int(ways_of(crowd)[paths.size > 0].sum()) if is_measured else None)


def improve_crowd(
    instance: Instance,
    solution: Solution,
    seconds: float,
    *,
    seed: int = 0,
    advance: Advance = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
) -> Solution | None:
    """Better plans by that many seconds of rounds.

    `None` if a robot has no plan, the instance is not stepwise, or a way is longer than distances are measured.
    """
    timer = Clock(seconds, clock, clock())
    if len(solution.plans) < len(instance.robots) or not is_stepwise(instance) or not instance.robots:
        return None
    crowd = crowd_of(instance)
    timer.visit = time_of_visit(instance, clock)
    paths = _paths_of_plans(instance, solution)
    timer.reserve(int(paths.size.sum()))
    crowd, found, _ = _with_distances(crowd, timer)
    if (ways_of(crowd) == FAR).any():
        return None
    if found.size < len(instance.robots):
        return solution
    paths = Paths(paths.size[found], paths.place[found], paths.enter[found])
    paths = improved(crowd, [paths], None, timer, seed, advance)
    require_lawful(crowd, paths)
    return solution_along(instance, [instance.robots[row] for row in found], paths)


def _apart(crowd: Crowd, timer: Clock) -> Flags | None:
    """Of each robot, whether none before it that has a way starts in its place, or parks in its goal.

    `None` if it cannot be told whether one has a way. Where there is no time to find out, each has one.
    """
    ends = (crowd.start, crowd.goal) if crowd.parks else (crowd.start,)
    shared = np.any([np.bincount(each)[each] > 1 for each in ends], axis=0)
    has_way = np.ones(shared.size, np.bool_)
    if shared.any():
        sharing = only(crowd, shared)
        native, rows = Native(sharing), np.arange(sharing.start.size, dtype=np.int32)
        done = 0
        while done < rows.size and timer.spent < LONG * (timer.seconds or inf):
            measure(native, rows, done, min(done + PART, rows.size))
            done += PART
        if _may_be_further(first(sharing, done)):
            return None
        has_way[np.flatnonzero(shared)[:done]] = ways_of(first(sharing, done)) < FAR
    has_way[has_way] = are_apart(only(crowd, has_way))
    return has_way


def _may_be_further(crowd: Crowd) -> bool:
    """Whether distances to a goal were measured as far as they go, and the way to it may be longer."""
    return bool((crowd.distance[ways_of(crowd) == FAR] == FAR - 1).any())


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


def _with_distances(crowd: Crowd, timer: Clock) -> tuple[Crowd, Ints, bool]:
    """The crowd of those robots whose distances there is time to find, which these are, and whether they are measured.

    Else they are estimated.
    """
    native = Native(crowd)
    robots = np.arange(crowd.start.size, dtype=np.int32)
    began, time = timer.spent, timer.seconds or inf
    for done in range(0, robots.size, PART):
        if done == PART:
            began = timer.spent
        if done == LOADING:
            ends = timer.spent + (timer.spent - began) * (robots.size - done) / (done - PART)
            if ends > LONG * time:
                landmarks = landmarks_of(crowd)
                ways = near(crowd, landmarks)
                if are_right(crowd, landmarks):
                    return *_with_nearest(crowd, timer, ways, partial(estimate, Native(landmarks))), False
                if ends > MEASURING * (time - timer.visit * int(ways.sum())):
                    return *_with_nearest(crowd, timer, ways, measure), True
        if timer.spent > MEASURING * time:
            return first(crowd, done), robots[:done], True
        measure(native, robots, done, min(done + PART, robots.size))
    return crowd, robots, True


def _with_nearest(
    crowd: Crowd, timer: Clock, ways: Ints, find: Callable[[Native[Crowd], Ints, int, int], None]
) -> tuple[Crowd, Ints]:
    """The crowd of the nearest robots, as many as there is time to find distances for, and which these are."""
    order = np.argsort(ways, kind="stable").astype(np.int32)
    nearest = crowd._replace(start=crowd.start[order], goal=crowd.goal[order])
    native, robots = Native(nearest), np.arange(order.size, dtype=np.int32)
    for done in range(0, order.size, PART):
        if timer.spent > NEAREST * ((timer.seconds or inf) - timer.visit * int(ways[order[:done]].sum())):
            return first(nearest, done), order[:done]
        find(native, robots, done, min(done + PART, order.size))
    return nearest, order


def _paths(crowd: Crowd, timer: Clock, iterations: int | None, seed: int, advance: Advance) -> Paths:
    """The paths of as many robots as possible, and the best ones if all have some."""
    if crowd.start.size == 0:
        return no_paths(0, 1)
    timer.reserve(int(ways_of(crowd).sum()))
    timer.begun = timer.spent
    starts = first_paths(crowd, timer, seed)
    timer.begun = 0.0
    timer.reserve(max(int(each.size.sum()) for each in starts))
    paths = min(starts, key=total_of)
    if paths.size.all() and timer.goes_on():
        return improved(crowd, starts, iterations, timer, seed, advance)
    advance(0, int(np.count_nonzero(paths.size == 0)), int(arrivals(paths)[paths.size > 0].sum()))
    return paths


def time_of_visit(
    instance: Instance, clock: Callable[[], float], finish: Callable[[Solution], object] = lambda _: None
) -> float:
    """The seconds that it takes to check a path, to make its plan and to finish with it, for each visit.

    What a solution of no visits takes does not count: that of 10,000 robots takes as long as 20,000 visits.
    """
    ticks = np.arange(SAMPLE, dtype=np.int32)[np.newaxis]

    def least(visits: int) -> float:
        paths = Paths(np.full(1, visits, np.int32), 0 * ticks, ticks)
        spent = []
        for _ in range(SAMPLES):
            started = clock()
            finish(solution_along(instance, instance.robots[:1], paths))
            spent.append(clock() - started)
        return min(spent)

    return SLOWER * max(least(SAMPLE) - least(0), 0.0) / SAMPLE
