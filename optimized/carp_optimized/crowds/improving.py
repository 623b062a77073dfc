"""Paths of a crowd that get better, for as long as they are asked to: the rounds of `carp_optimized.crowds.rounds`."""

from collections.abc import Callable

import numpy as np

from carp_optimized.crowds.crowd import Crowd, ways_of
from carp_optimized.crowds.making_way import make_way
from carp_optimized.crowds.rounds import FIRST_WEIGHTS, FULL, plan_each, plan_first, play, put_all
from carp_optimized.crowds.sipp import EFFORT, GREED, WHOLE, no_query
from carp_optimized.crowds.soft_sipp import no_soft_query
from carp_optimized.crowds.state import (
    BEST,
    CHANCE,
    COUNTS,
    DIRTY,
    MISSED,
    MOST_MEMBERS,
    ROUNDS,
    TOTAL,
    TURNING,
    Rounds,
)
from carp_optimized.crowds.stays import Paths, no_paths, no_stays, with_more_room
from carp_optimized.draws import SURE
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native

WORK = 1 << 15
"""The labels that one compiled call expands before it looks whether to go on: some milliseconds."""
SLOW, GREEDIEST = 32, 8 * WHOLE
"""After so many calls that do not halve those that wait, ways through others are twice as greedy, up to this."""
PART = 256
"""The robots whose stays one compiled call adds."""
LONGER = 32
"""The visits that a path may have beyond the longest one given."""


class Improving:
    """Paths of all robots, and the best ones seen."""

    __slots__ = ("_native", "rounds")

    def __init__(self, crowd: Crowd, paths: Paths, seed: int = 0) -> None:
        """The crowd has been measured. The paths break no rule together."""
        robots, room = paths.place.shape
        visits = np.arange(room) < paths.size[:, np.newaxis]
        stays = no_stays(np.bincount(paths.place[visits], minlength=crowd.queue.size).astype(np.int32))
        self.rounds = Rounds(
            crowd=crowd,
            stays=stays,
            query=no_query(stays),
            soft=no_soft_query(stays, np.zeros(robots, np.int32)),
            paths=paths,
            best=no_paths(robots, room),
            tried=no_paths(MOST_MEMBERS, room),
            least=ways_of(crowd),
            members=np.zeros(MOST_MEMBERS, np.int32),
            waits=np.zeros(MOST_MEMBERS, np.int32),
            key=np.zeros(MOST_MEMBERS, np.int64),
            mark=np.zeros(robots, np.int32),
            changed=np.zeros(robots, np.int32),
            is_changed=np.zeros(robots, np.int32),
            weight=np.array(FIRST_WEIGHTS, np.int64),
            counts=np.zeros(COUNTS, np.int64),
            stream=np.array([seed], np.uint64),
        )
        self._native = Native(self.rounds)

    @property
    def best(self) -> int:
        """The sum of arrivals of the best paths."""
        return int(self.rounds.counts[BEST])

    @property
    def total(self) -> int:
        """The sum of arrivals of the paths."""
        return int(self.rounds.counts[TOTAL])

    @property
    def missed(self) -> int:
        """How often `plan_first` and `make_way` have found no path."""
        return int(self.rounds.counts[MISSED])

    @property
    def played(self) -> int:
        """The rounds so far."""
        return int(self.rounds.counts[ROUNDS])

    def begin(self, goes_on: Callable[[], bool]) -> bool:
        """Take the paths for the best, if there is time for it; whether there was."""
        robots = self.rounds.paths.size.size
        done = 0
        while done < robots:
            if not goes_on():
                return False
            end = min(done + PART, robots)
            done = put_all(self._native, done, end)
            if done < end:
                self._make_room()
        self.rounds.counts[TOTAL] = arrivals(self.rounds.paths).sum()
        self._remember()
        return True

    def _remember(self) -> None:
        counts = self.rounds.counts
        counts[BEST] = counts[TOTAL]
        for best, paths in zip(self.rounds.best, self.rounds.paths, strict=True):
            best[...] = paths
        counts[DIRTY] = 0
        self.rounds.is_changed[:] = 0

    def return_to_best(self, goes_on: Callable[[], bool]) -> bool:
        """Go on from the best paths, if there is time for it; whether there was."""
        for best, paths in zip(self.rounds.best, self.rounds.paths, strict=True):
            paths[...] = best
        self.rounds.stays.size[:] = 0
        return self.begin(goes_on)

    def play(self, rounds: int, work: int, chance: int, *, turning: bool = False) -> int:
        """Play that many rounds, or as many as take that much work; how many. Equally early paths are tried in turn."""
        self.rounds.counts[CHANCE] = min(chance, SURE - 1)
        self.rounds.counts[TURNING] = turning
        played = play(self._native, rounds, work)
        if played != FULL:
            return played
        self._make_room()
        return 0

    def plan_each(self, order: Ints, goes_on: Callable[[], bool], greed: int) -> None:
        """Plan the robots again, one after the other."""
        self.rounds.query.counts[GREED] = greed
        self._go_through(plan_each, order, goes_on)

    def plan_first(self, order: Ints, goes_on: Callable[[], bool], greed: int, effort: int) -> None:
        """Plan robots that have no paths yet, one after the other, those that find none left out.

        They look at `effort` gaps at most.
        """
        self.rounds.query.counts[GREED] = greed
        self.rounds.query.counts[EFFORT] = effort
        self._go_through(plan_first, order, goes_on)

    def make_way(self, goes_on: Callable[[int], bool]) -> Paths:
        """Plan robots that `plan_first` has left out, and others again that were in their way.

        `goes_on` gets the number that wait. Returns paths of all robots, or those when few waited.
        """
        missing = np.flatnonzero(self.rounds.paths.size == 0)
        waiting = np.zeros(self.rounds.paths.size.size, np.int32)
        waiting[: missing.size] = missing
        fewest = count = missing.size
        greed, calls = WHOLE, 0
        self._remember()
        while count > 0 and goes_on(count):
            self.rounds.soft.labels.counts[GREED] = greed
            count = make_way(self._native, waiting, count, WORK)
            calls += 1
            if calls == SLOW:
                greed, calls = min(2 * greed, GREEDIEST), 0
            if count < 0:
                count = ~count
                self._make_room()
            if 0 < 2 * count <= fewest:  # copies of many long paths take long
                fewest, calls = count, 0
                self._remember()
        return self.rounds.best if count > 0 else self.rounds.paths

    def _go_through(
        self, step: Callable[[Native[Rounds], Ints, int, int], int], order: Ints, goes_on: Callable[[], bool]
    ) -> None:
        done = 0
        while done < order.size and goes_on():
            done = step(self._native, order, done, WORK)
            if done < 0:
                done = ~done
                self._make_room()

    def _make_room(self) -> None:
        stays = with_more_room(self.rounds.stays)
        query = no_query(stays)._replace(counts=self.rounds.query.counts)
        soft = no_soft_query(stays, self.rounds.soft.met)
        soft.labels.counts[:] = self.rounds.soft.labels.counts
        self.rounds = self.rounds._replace(stays=stays, query=query, soft=soft)
        self._native = Native(self.rounds)


def arrivals(paths: Paths) -> Ints:
    """The ticks at which the robots arrive."""
    last: Ints = paths.enter[np.arange(paths.size.size), paths.size - 1]
    return last


def total_of(paths: Paths) -> int:
    """The sum of arrivals."""
    return int(arrivals(paths).sum())
