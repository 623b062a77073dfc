"""The search for deadlines of two robots that are seen at a tick: places that they cannot both be in then.

Prices let robots that meet head-on pass each other by halves. Near the best prices, a robot's ways have it in several
places at a tick. `carp_optimum.meetings` finds places of two robots that exclude each other at a tick, and that the
ways take too often. All places that these exclude are added.

Detours that no recent way makes may let the robots be in such places all the same. Then, once the prices hardly gain
with claims about one tick, both robots are seen at earlier ticks too: first at all of them and where they have been,
which leaves no detour. Ticks are dropped as long as the claim holds, in halves and then in smaller parts; mostly one or
two are left. There all places are added but those that let the robots meet.

The search follows all joint states of the two that it does not leave out, so such a claim is true, and prices may count
on it at once. A certificate needs its refutation, which takes longer to find. So only the claims that have a price
after a climb are proved; the others are dropped, and a later round finds them again where they are still broken.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from heapq import heappop, heappush
from itertools import combinations, count
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from carp_optimized.arrays import NONE, Graph, Ints, IntTable, Longs, LongTable
from carp_optimized.references import Native
from carp_optimum.deadlines import Deadlines, Member
from carp_optimum.meetings import Meeting, Side, find_claim, find_meetings
from carp_optimum.price_search import PriceSearch
from carp_optimum.proving import refutation
from carp_optimum.solver import NANOSECONDS, Deadline, TimeOver
from carp_spec import Refusal
from carp_verify.bound_cuts import formula_of_deadlines
from carp_verify.bound_rules import ContradictionError
from carp_verify.bounds import DeadlinesDocument
from carp_verify.optimum_rules import LARGEST_FORMULA

STEPS = 120
PERIOD = 200  # steps; ways of the last `STEPS` among them are looked at
EVERY = 4  # step: the places in it are compared
MARGIN = 4  # ticks of delay above the largest of a robot's ways
LARGEST_DELAY = 30
MOST_SPOTS = 400
LARGEST_ENCODING = 2_000_000
LEAST_WEIGHT = 8  # by which ways break a claim
MOST_WORK = 150_000_000  # pairs of states by ticks, in a round
MOST_DOUBLINGS = 6  # of a pair's work, by searches that found no claim
MOST_FOUND = 400  # claims in a round
LEAST_GAIN = 100  # one part of the best bound: what a round's claims must be broken by for another round
SLOW = 500  # one part of the best bound: claims about more ticks are searched for where a period gains less
MOST_SIGHTS = 8  # of a claim, beside its last tick
LOOKS = 400  # of a search for a refutation at its clock
LONGEST_REFUTATION = 300_000  # characters


Natives: TypeAlias = tuple[Native[Side], Native[Side], Native[Meeting]]
Sight: TypeAlias = tuple[int, int]
"""The first of two robots, 0, or the other, 1, and a tick at which it is seen."""


class SightSearch:
    """Finds deadlines of pairs of robots for a search for prices."""

    def __init__(self, search: PriceSearch) -> None:
        self.search = search
        self.instance = search.instance
        self.most = min(LARGEST_DELAY, search.market.delays - 1)
        self.without_proof: set[Sequence[Member]] = set()
        self.entries: dict[int, Longs] = {}
        self.searched: Counter[tuple[int, int]] = Counter()
        self.before = 0
        self.is_slow = False
        self.watched = 0
        self.ways: list[tuple[Longs, IntTable]] = []

    def round(self, check: Callable[[], None]) -> int:
        """Add claims that the ways near the best prices break, and return by how much, in parts of a tick; 0 if little.

        `check` may raise `TimeOver`; the claims found until then are added first.
        """
        search = self.search
        wide = max(len(self.instance.graph.resources), search.market.delays, search.horizon)
        if len(self.instance.robots) * wide > LARGEST_ENCODING:
            return 0
        gain = self._add(*search.wander_places(STEPS, search.scale // 4, check), check)
        gained = gain * search.scale // STEPS
        return gained if gained * LEAST_GAIN >= search.best else 0

    def watch(self, check: Callable[[], None]) -> None:
        """Look at the ways after a step of a climb; now and then add claims that the last ones break, and drop others.

        A claim that has no price after `PERIOD` steps is dropped. `check` may raise `TimeOver`.
        """
        search = self.search
        self.watched = self.watched % PERIOD + 1
        if self.watched > PERIOD - STEPS:
            self.ways.append((search.delays(), search.places()))
        if self.watched == PERIOD:
            delays, at = (np.stack(each) for each in zip(*self.ways, strict=True))
            self.ways = []
            search.drop_idle_deadlines()
            self.is_slow = (search.best - self.before) * SLOW < search.best
            self.before = search.best
            self._add(delays, at, check)

    def _add(self, delays: LongTable, at: IntTable, check: Callable[[], None]) -> int:
        """Add claims that these ways break, those that are found fastest first: by how many ways in all.

        On a tree, robots whose ways are short or cannot pass each other break claims most often, and have few states.
        A pair counts as twice the work for each search since its last claim, so that every pair has its turn.
        """
        search = self.search
        sides = _Sides(search, at, np.minimum(delays.max(axis=0) + MARGIN, self.most), self.entries)
        known = {tuple(claim.members) for claim in search.deadlines} | self.without_proof
        work = {pair: sides.work(*pair) for pair in pairs_in(at, len(self.instance.graph.resources))}
        chosen: list[Deadlines] = []
        gain = 0
        left = MOST_WORK
        try:
            for pair in sorted(work, key=lambda each: (work[each] << min(self.searched[each], MOST_DOUBLINGS), each)):
                check()
                left -= work[pair]
                if left < 0 or len(chosen) == MOST_FOUND:
                    break
                weight, members = sides.claim(*pair, self.is_slow, check)
                self.searched[pair] += 1
                if weight >= LEAST_WEIGHT and members not in known:
                    chosen.append(self._unproved(members))
                    gain += weight
                    del self.searched[pair]
        finally:
            search.add_deadlines(chosen)
        return gain

    def prove(self, check: Callable[[], None]) -> None:
        """Prove the claims that have a price, the dearest first, and drop those without a proof.

        `check` may raise `TimeOver`; the claims proved until then are kept.
        """
        search = self.search
        if all(each.document.refutation for each in search.deadlines):
            return
        search.finish()
        kept = [each for each in search.deadlines if each.document.refutation]
        unproved = [
            (fee, number)
            for number, fee in enumerate(search.fees.tolist())
            if fee > 0 and not search.deadlines[number].document.refutation
        ]
        try:
            for _, number in sorted(unproved, key=lambda each: (-each[0], each[1])):
                claim = search.deadlines[number]
                lines = self._refutation(claim.document, check)
                if lines:
                    search.deadlines[number] = Deadlines(claim.members, replace(claim.document, refutation=lines))
                    kept.append(search.deadlines[number])
                else:
                    self.without_proof.add(claim.members)
        finally:
            search.keep_deadlines(kept)

    def _unproved(self, members: Sequence[Member]) -> Deadlines:
        """The claim without its proof."""
        graph = self.instance.graph
        robots = tuple(self.instance.robots[member.robot].id for member in members)
        seen = tuple((member.seen, tuple(graph.resources[at].id for at in member.places)) for member in members)
        ticks = tuple(max(member.arrival, 0) for member in members)
        return Deadlines(members, DeadlinesDocument(robots, ticks, 0, "", seen))

    def _refutation(self, claim: DeadlinesDocument, check: Callable[[], None]) -> str:
        """The refutation of the claim's contrary, or nothing if it is too long."""
        looks = count()

        def clock() -> int:
            check()
            return next(looks) * NANOSECONDS

        try:
            formula = formula_of_deadlines(self.instance, claim, LARGEST_FORMULA)
            lines = refutation(formula, Deadline(LOOKS, clock))
        except (TimeOver, Refusal, ContradictionError):
            check()
            return ""
        return lines if len(lines) <= LONGEST_REFUTATION else ""


def pairs_in(at: IntTable, resources: int) -> set[tuple[int, int]]:
    """Pairs of robots that are in the same place at the same tick, in one step or in different ones."""
    places = at[::EVERY]
    _, robots, ticks = places.shape
    _, robot, tick = np.nonzero((places >= 0) & (places < resources))
    place = places[(places >= 0) & (places < resources)].astype(np.int64)
    cell, robot = np.divmod(np.unique((place * ticks + tick) * robots + robot), robots)
    groups = np.split(robot, np.flatnonzero(np.diff(cell)) + 1)
    return {pair for group in groups for pair in combinations(group.tolist(), 2)}


def meeting_of(first: Side, second: Side) -> Meeting:
    """Room for the search of two robots."""
    rows, columns = first.first.size, second.first.size
    pairs = int(first.first[-1]) * int(second.first[-1])
    return Meeting(
        pairs=np.zeros(pairs, np.int32),
        later=np.zeros(pairs, np.int32),
        mark=np.zeros(pairs, np.int32),
        origin=np.zeros(pairs, np.int32),
        later_origin=np.zeros(pairs, np.int32),
        blamed=np.zeros(rows + columns, np.int32),
        together=np.zeros((rows, columns), np.int32),
        flow=np.zeros((rows, columns), np.int32),
        queue=np.zeros(rows + columns, np.int32),
        found=np.zeros(3, np.int64),
    )


def see_at(sides: tuple[Side, Side], sights: Iterable[Sight]) -> None:
    """Let the robots be seen there, and nowhere else."""
    for side in sides:
        side.sees[:] = 0
    for whose, tick in sights:
        sides[whose].sees[tick] = 1


def fewest(sights: list[Sight], is_enough: Callable[[list[Sight]], bool]) -> list[Sight]:
    """Some of the sights that are enough: they are dropped in halves, then in smaller parts."""
    size = len(sights)
    while size > 0:
        place = 0
        while place < len(sights):
            fewer = sights[:place] + sights[place + size :]
            if is_enough(fewer):
                sights = fewer
            else:
                place += size
        size //= 2
    return sights


def first_entries(graph: Graph, durations: Longs, start: int, release: int) -> Longs:
    """The ticks at which a robot can enter the resources first; late where it cannot."""
    ticks = np.full(len(durations), 1 << 30, np.int64)
    queue = [(release, start)]
    while queue:
        tick, here = heappop(queue)
        if tick < ticks[here]:
            ticks[here] = tick
            for target in graph.target[graph.first[here] : graph.first[here + 1]].tolist():
                heappush(queue, (tick + int(durations[here]), target))
    return ticks


class _Sides:
    """The robots as `carp_optimum.meetings` sees them, each made when it is first asked for.

    `entries` keeps the first entries of robots that were seen before.
    """

    def __init__(self, search: PriceSearch, at: IntTable, delays: Ints, entries: dict[int, Longs]) -> None:
        self.search = search
        self.at = at
        self.delays = delays
        self.entries = entries
        self.known: dict[int, Side | None] = {}

    def work(self, one: int, other: int) -> int:
        """The most pairs of states, over all ticks, in a search for a claim of two robots."""
        first, second = self.side(one), self.side(other)
        if first is None or second is None:
            return 0
        return int(first.first[-1]) * int(second.first[-1]) * self.end(one, other)

    def end(self, one: int, other: int) -> int:
        """The tick before which a claim of two robots is searched for."""
        earliest = self.search.market.requests.earliest
        return min(int(min(earliest[at] + self.delays[at] for at in (one, other))) + 1, self.search.horizon)

    def claim(
        self, one: int, other: int, is_about_more: bool, check: Callable[[], None]
    ) -> tuple[int, Sequence[Member]]:
        """The heaviest claim of two robots at a tick, or perhaps one about more ticks, and its weight; else nothing.

        `check` may raise `TimeOver`.
        """
        first, second = self.side(one), self.side(other)
        if first is None or second is None:
            return 0, ()
        sides = first, second
        meeting = meeting_of(*sides)
        natives = Native(first), Native(second), Native(meeting)
        end = self.end(one, other)
        weight = find_claim(self.search.native, *natives, end, STEPS)
        if weight >= LEAST_WEIGHT:
            return weight, self.at_one_tick(sides, meeting, natives)
        if not is_about_more:
            return 0, ()
        for side in sides:
            side.sees[:-1] = side.often.sum(axis=1) > 0
            side.held[:-1, :-1] = side.often > 0
        try:
            weight = find_claim(self.search.native, *natives, end, STEPS)
            kept = self.needed(sides, meeting, natives, check) if weight >= LEAST_WEIGHT else []
            weight -= sum(STEPS - self.share(sides[whose], tick) for whose, tick in kept)
            if weight < LEAST_WEIGHT or len(kept) > MOST_SIGHTS:
                return 0, ()
            last = self.at_one_tick(sides, meeting, natives)
        finally:
            see_at(sides, ())
        earlier = [
            self.member(sides[whose], (sides[whose].held[tick, :-1] == 1) & self.valid(sides[whose], tick), tick)
            for whose, tick in kept
        ]
        return weight, (*earlier, *last)

    def at_one_tick(self, sides: tuple[Side, Side], meeting: Meeting, natives: Natives) -> tuple[Member, Member]:
        """The robots at the claim's last tick, in all spots that cannot be taken together then."""
        first, second = sides
        find_meetings(self.search.native, *natives, 0, NONE)
        tick = int(meeting.found[1])
        together = meeting.together[: first.first.size - 3, : second.first.size - 3] > 0
        chosen = first.chosen[1 : 1 + first.chosen[0]]
        far = self.valid(first, tick), self.valid(second, tick)
        others = ~together[chosen].any(axis=0) & far[1]
        others &= together.any(axis=0) | np.isin(np.arange(len(others)), second.chosen[1 : 1 + second.chosen[0]])
        ones = ~together[:, others].any(axis=1) & far[0]
        ones &= together.any(axis=1) | np.isin(np.arange(len(ones)), chosen)
        return self.member(first, ones, tick), self.member(second, others, tick)

    def share(self, side: Side, tick: int) -> int:
        """In how many ways the robot is in spots that it has held at the tick."""
        return int(side.often[tick][side.held[tick, :-1] == 1].sum())

    def needed(
        self, sides: tuple[Side, Side], meeting: Meeting, natives: Natives, check: Callable[[], None]
    ) -> list[Sight]:
        """The robots, 0 or 1, with earlier ticks at which they must be seen for the claim; `held` gets where."""
        for side in sides:
            side.inside[:] = 0
            side.inside[side.chosen[1 : 1 + side.chosen[0]]] = 1

        def meetings(kept: Iterable[Sight], whose: int = 0, earlier: int = NONE) -> int:
            check()
            see_at(sides, kept)
            meeting.blamed[:] = 0
            return find_meetings(self.search.native, *natives, whose, earlier)

        seen = [(whose, at) for at in range(1, int(meeting.found[1])) for whose in (0, 1) if sides[whose].sees[at]]
        kept = fewest(seen, lambda fewer: meetings(fewer) == 0)
        if len(kept) <= MOST_SIGHTS:
            for whose, at in kept:
                held = sides[whose].held[at]
                held[:] = 1
                while meetings(kept, whose, at) > 0:
                    held[meeting.blamed[: len(held)] == 1] = 0
        see_at(sides, kept)
        return kept

    def member(self, side: Side, spots: npt.NDArray[np.bool_], tick: int) -> Member:
        """The robot, seen at the tick in the spots."""
        places = tuple(side.resource[np.flatnonzero(spots[:-1])].tolist())
        return Member(int(side.robot[0]), tick if spots[-1] else -1, tick, places)

    def valid(self, side: Side, tick: int) -> npt.NDArray[np.bool_]:
        """Whether all ways of the robot that are in a spot at the tick have a delay that is looked at."""
        requests = self.search.market.requests
        robot = int(side.robot[0])
        duration = self.search.market.graph.duration[side.resource].astype(np.int64) * int(requests.pace[robot])
        late = tick - int(requests.earliest[robot])
        within = late + duration + requests.rest[robot][side.resource] <= side.delay[0]
        return np.append(within, late <= side.delay[0])

    def side(self, robot: int) -> Side | None:
        """The robot, unless it has no way or too many spots."""
        if robot not in self.known:
            self.known[robot] = self._side(robot)
        return self.known[robot]

    def _side(self, robot: int) -> Side | None:
        market = self.search.market
        requests, graph = market.requests, market.graph
        start, goal = int(requests.start[robot]), int(requests.goal[robot])
        if start == goal or requests.rest[robot][start] == NONE:
            return None
        durations = graph.duration.astype(np.int64) * int(requests.pace[robot])
        if robot not in self.entries:
            self.entries[robot] = first_entries(market.graph, durations, start, int(requests.release[robot]))
        near = self.entries[robot]
        delay = np.where(requests.rest[robot] == NONE, 1 << 30, near + durations + requests.rest[robot])
        resource = np.flatnonzero(delay - int(requests.earliest[robot]) <= self.delays[robot]).astype(np.int32)
        if len(resource) > MOST_SPOTS or durations[resource].sum() > MOST_SPOTS or start not in resource:
            return None
        spot = np.full(len(durations), NONE, np.int32)
        spot[resource] = np.arange(len(resource))
        lengths = [*durations[resource].tolist(), 1 if market.parks else int(durations[goal]), 1, 1]
        first = np.cumsum([0, *lengths]).astype(np.int32)
        spots = len(resource)
        number = np.append(spot, [spots, NONE]).astype(np.int32)  # at the goal at the end, or nowhere
        often = np.zeros((self.search.horizon, spots + 2), np.int32)
        places = number[self.at[:, robot, :]]
        ticks = np.broadcast_to(np.arange(self.search.horizon), places.shape)
        np.add.at(often, (ticks.ravel(), places.ravel()), 1)
        side = Side(
            robot=np.array([robot], np.int64),
            delay=np.array([self.delays[robot]], np.int64),
            spot=spot,
            resource=resource,
            first=first,
            often=often[:, : spots + 1].copy(),
            spot_of=np.zeros(first[-1], np.int32),
            place=np.zeros(first[-1], np.int32),
            branches=np.zeros(first[-1], np.int32),
            following=np.zeros((first[-1], int(np.diff(graph.first).max(initial=0)) + 2), np.int32),
            sees=np.zeros(self.search.horizon + 1, np.int32),
            held=np.ones((self.search.horizon + 1, spots + 2), np.int32),
            used=np.zeros(spots + 4, np.int32),
            left=np.zeros(spots + 4, np.int32),
            before=np.zeros(spots + 4, np.int32),
            chosen=np.zeros(spots + 4, np.int32),
            inside=np.zeros(spots + 4, np.int32),
        )
        late = np.arange(self.search.horizon) - int(requests.earliest[robot])
        within = late[:, None] + durations[resource] + requests.rest[robot][resource] <= self.delays[robot]
        side.often[:, :spots][~within] = 0
        side.often[late > self.delays[robot], spots] = 0
        return side
