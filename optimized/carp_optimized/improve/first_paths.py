"""First paths of a crowd: by LaCAM, and by prioritized planning in several orders.

With the shortest way first, robots that arrive early park early, and those that come later go around them. Where that
makes jams, passes in other orders follow, else less greedy ones. A robot that does not find a path soon takes one on
which it meets few others, and those are planned again. Where that does not end in time, or the crowd is large, passes
are as greedy as can be, and then less and less. If that is not much better than LaCAM, LaCAM follows guides too.
Where nothing ends, or LaCAM would take far too long, as many robots as possible are planned one after the other.
"""

from collections.abc import Sequence
from math import inf

import numpy as np

from carp_optimized.crowds.crowd import Crowd, ways_of
from carp_optimized.crowds.improving import Improving, arrivals, total_of
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.sipp import BUCKETS, UNTIL_FOUND, WHOLE
from carp_optimized.crowds.stays import Paths, no_paths
from carp_optimized.improve.clock import ALL, Clock
from carp_optimized.jit.kinds import Ints
from carp_optimized.lacam.guides import guides_of
from carp_optimized.lacam.search import RUNNING, STEPS, Search
from carp_optimized.state.arrays import NO_LIMIT

SEARCHING, GUIDING, GUIDED, LAST, LATEST = 3, 4, 5, 6, 7
"""The eighths of the time after which prioritized planning ends, then LaCAM and guides, then LaCAM with guides.

If LaCAM has plans, guides may take until `GUIDED` and LaCAM with them until `LATEST`: where that matters, rounds gain
little. If nothing has found plans for all, LaCAM goes on until `LAST`, and what is left is for prioritized planning of
as many as possible.
"""
SAMPLES, EACH = 10, 16
"""With guides, LaCAM tries so many next configurations if a search takes one of `EACH` parts of the time at most."""
SURE, DOUBT = 64, 2
"""After so many steps of LaCAM it is known how long a step takes, but for a factor of `DOUBT`."""
MISSES = 8
"""Prioritized planning gives up when robots have found no path this often, on average."""
SOME, HOPE, PATIENCE = 64, 8, 2
"""A pass that may give up does so if it has missed more than one of `SOME` robots, or would not end in time.

The latter is known after one of `HOPE` parts of the time. Then so many times its own time is for those that it missed.
"""
FEW = 16
"""Where at most one of so many robots waits for a path, way may be made until `GUIDED`."""
EFFORT = 1000
"""The gaps that a query may look at, beside its way, before the robot takes a way through others, not far around.

In larger crowds it may look at all, as ways through others take longer there.
"""
LESS = ((0, 5), (GREEDY // 4, 2))
"""Less greed than `GREEDY`, and how many times as long prioritized planning takes with it."""
LADDER = (16 * GREEDY, 4 * GREEDY, GREEDY, GREEDY // 4, 0)
"""Less and less greed: where a pass with `GREEDY` does not end in time, the greediest may, in half to a sixth of it."""
LATE = 1 << 12
"""The ticks of delay for which there must be buckets beside the greed: without, all bounds share the last bucket."""
JAMMED = 4
"""Other orders are tried where the shortest way first makes paths longer by more than one of so many parts."""
LARGE = 2000
"""With more robots there is no time for other orders."""
LONGEST = 700
"""The visits of a path by prioritized planning, or twice those of the longest way: one through others may be long."""


def first_paths(crowd: Crowd, timer: Clock, seed: int) -> list[Paths]:
    """First paths of all robots, the more promising first; those of as many as possible if nothing has all.

    Paths by LaCAM are more promising unless the others are much better.
    """
    search, began = Search(crowd, seed), timer.spent
    by_steps = _searched(search, STEPS, timer, GUIDING)
    is_given_up = search.outcome == RUNNING and search.tried < STEPS and timer.goes_on(GUIDING)
    if is_given_up:
        return [_as_many_in_order(crowd, timer, seed)]
    took = timer.spent - began
    samples = 1 + sum(EACH * count * took < timer.left() for count in range(2, SAMPLES + 1))
    in_order = no_paths(crowd.start.size, 1)
    if crowd.start.size <= LARGE:
        in_order = _best_in_order(crowd, timer, by_steps, seed)
    if not in_order.size.all():
        in_order = min(in_order, best_of_ladder(crowd, timer, by_steps, seed), key=_badness)
    has_all = bool(in_order.size.all())
    if has_all and _is_better(crowd, in_order, by_steps):
        return [in_order, *by_steps]
    until, last = (GUIDED, LATEST) if by_steps else (GUIDING, GUIDED)
    for guides in guides_of(crowd, lambda: timer.goes_on(until)):
        found = _searched(Search(crowd, seed, guides, samples), STEPS, timer, last)
        if not found:
            break
        by_steps += found
    if not by_steps and not has_all:
        by_steps = _searched(search, STEPS if timer.seconds is None else NO_LIMIT, timer, LAST)
    if has_all or by_steps:
        return sorted(by_steps, key=total_of)[: 1 if has_all else 2] + [in_order] * has_all
    later = _as_many_in_order(crowd, timer, seed)
    return [max(in_order, later, key=lambda each: int(np.count_nonzero(each.size)))]


def _as_many_in_order(crowd: Crowd, timer: Clock, seed: int) -> Paths:
    """The paths of as many robots as there is time for."""
    return planned_in_order(crowd, timer, seed, ALL, GREEDY, UNTIL_FOUND, ways_of(crowd), is_part=True)


def _best_in_order(crowd: Crowd, timer: Clock, by_steps: Sequence[Paths], seed: int) -> Paths:
    """The best paths of greedy passes of prioritized planning, or of a less greedy one, as far as there is time."""
    ways, any_order = ways_of(crowd), np.random.default_rng(seed).permutation(crowd.start.size).astype(np.int32)
    best, longest, effort = no_paths(ways.size, 1), 0.0, EFFORT
    for keys in (ways, any_order, -ways):
        if 0 < longest >= timer.left(SEARCHING):
            break
        began = timer.spent
        found = planned_in_order(crowd, timer, seed, SEARCHING, GREEDY, effort, keys)
        longest = max(longest, timer.spent - began)
        best = min(best, found, key=_badness)
        if by_steps and not best.size.all() and keys is not ways:
            break
        if not found.size.all():
            effort = UNTIL_FOUND
        is_short_first = keys is ways and bool(best.size.all())
        if is_short_first and JAMMED * total_of(best) < (JAMMED + 1) * int(ways.sum()):
            less = _less_greedy(crowd, timer, by_steps, seed, best, timer.spent - began)
            return min(less, best, key=_badness)
    return best


def best_of_ladder(crowd: Crowd, timer: Clock, by_steps: Sequence[Paths], seed: int) -> Paths:
    """The best paths of passes with less and less greed, as far as there is time. The first one is soon over."""
    ways = ways_of(crowd)
    best, took, until = no_paths(ways.size, 1), 0.0, ALL if by_steps else SEARCHING
    for greed in LADDER:
        if greed * int(ways.max()) // WHOLE > BUCKETS - LATE:
            continue
        if took > timer.left(until):
            break
        began = timer.spent
        found = planned_in_order(crowd, timer, seed, until, greed, UNTIL_FOUND, ways, gives_up=True)
        best, took, until = min(best, found, key=_badness), timer.spent - began, LATEST
        if not found.size.all():
            break
    return best


def _less_greedy(crowd: Crowd, timer: Clock, by_steps: Sequence[Paths], seed: int, greedy: Paths, took: float) -> Paths:
    """The paths of a less greedy pass than one that took so long, if there is time for it.

    There is more time for what is likely to be much better than paths by LaCAM. Where few robots hold up others, one
    that goes far around comes earlier than one that makes others be planned again.
    """
    until, share = (LAST, 1) if _is_better(crowd, greedy, by_steps) else (SEARCHING, 4)
    for greed, times in LESS:
        if share * times * took < timer.left(until):
            return planned_in_order(crowd, timer, seed, until, greed, UNTIL_FOUND, ways_of(crowd))
    return greedy


def _badness(paths: Paths) -> tuple[int, int]:
    """The robots without a path, and the sum of the others' arrivals."""
    return int(np.count_nonzero(paths.size == 0)), int(arrivals(paths)[paths.size > 0].sum())


def _is_better(crowd: Crowd, in_order: Paths, by_steps: Sequence[Paths]) -> bool:
    """Whether the delays of paths by LaCAM are more than 1.5 times those of others."""
    least = int(ways_of(crowd).sum())
    return all(3 * (total_of(in_order) - least) < 2 * (total_of(each) - least) for each in by_steps)


def _searched(search: Search, steps: int, timer: Clock, until: int) -> list[Paths]:
    """The paths of all robots by LaCAM, if they are found in that many steps and in time.

    No paths end in fewer steps than the longest way has. If these take far too long, the search is given up.
    """
    first, began = search.tried, timer.spent
    last = min(first + steps, NO_LIMIT)
    while search.outcome == RUNNING and search.tried < last and timer.goes_on(until):
        search.go(8)
        done = search.tried - first
        if done >= SURE and (timer.spent - began) * (search.longest - search.tried) > DOUBT * timer.left(LAST) * done:
            break
    return [] if search.paths is None else [search.paths]


def planned_in_order(
    crowd: Crowd,
    timer: Clock,
    seed: int,
    until: int,
    greed: int,
    effort: int,
    keys: Ints,
    *,
    is_part: bool = False,
    gives_up: bool = False,
) -> Paths:
    """The paths of a pass of prioritized planning, and then of the robots that it missed.

    If paths of a part of the robots are of use, time is left for the visits of those alone. A pass that `gives_up` does
    so soon if it misses some robots, or would not end in time if the work grows with the square of the robots planned:
    those with longer ways are planned later, and among more others.
    """
    robots = crowd.start.size
    room = max(LONGEST, 2 * int(ways_of(crowd).max()))
    improving = Improving(crowd, no_paths(robots, room), seed)
    begun, time = timer.spent, timer.seconds or inf

    def goes_on(last: int) -> bool:
        if is_part:
            timer.reserve(int(improving.rounds.paths.size.sum()))
        return timer.goes_on(last)

    def is_given_up() -> bool:
        took = timer.spent - begun
        done = int(np.count_nonzero(improving.rounds.paths.size)) + improving.missed
        is_in_time = HOPE * took < time or took * robots**2 < (took + timer.left(until)) * done**2
        return gives_up and (SOME * improving.missed > robots or not is_in_time)

    order = np.argsort(keys, kind="stable").astype(np.int32)
    improving.plan_first(order, lambda: goes_on(until) and not is_given_up(), greed, effort)
    if is_given_up():
        return improving.rounds.paths
    most = improving.missed + MISSES * robots
    patient = timer.spent + PATIENCE * (timer.spent - begun) if gives_up else inf

    def goes_on_for(waiting: int) -> bool:
        last = max(until, GUIDED) if FEW * waiting <= robots else until
        return improving.missed < most and timer.spent < patient and goes_on(last)

    return improving.make_way(goes_on_for)
