"""Claims about two robots that are seen at ticks: places that they cannot all be in.

Prices let robots that meet head-on pass each other by halves. Near the best prices, a robot's ways have it in several
places at a tick. `carp_optimum.claims.pair_states` finds places of two robots that exclude each other at a tick, and
that the ways take too often. All places that these exclude are added.

Detours that no recent way makes may let the robots be in such places all the same. Then both robots are seen at earlier
ticks too: first at all of them and where they have been, which leaves no detour. Ticks are dropped as long as the claim
holds, in halves and then in smaller parts; mostly one or two are left. There all places are added but those that let
the robots meet. The search follows all joint states of the two that it does not leave out, so such a claim is true.
"""

from collections.abc import Callable, Iterable, Sequence
from heapq import heappop, heappush
from typing import TypeAlias

import numpy as np

from carp_optimized.jit.kinds import Flags, IntTable, Longs
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE, Graph
from carp_optimum.claims.pair_states import Meeting, Side, find_claim, find_meetings
from carp_optimum.lagrangian.deadlines import Member
from carp_optimum.lagrangian.price_search import PriceSearch

MOST_SPOTS = 400  # resources, or ticks in them, that one robot of a pair can be in
LEAST_WEIGHT = 8  # by which ways break a claim
MOST_SIGHTS = 8  # of a claim, beside its last tick

Sight: TypeAlias = tuple[int, int]
"""The first of two robots, 0, or the other, 1, and a tick at which it is seen."""
Claim: TypeAlias = tuple[int, Sequence[Member]]
"""By how many ways a claim is broken, and its members."""

NOTHING: Claim = 0, ()


def meeting_of(one: Side, other: Side) -> Meeting:
    """Room for the search of two robots."""
    rows, columns = one.inside.size, other.inside.size
    pairs = one.place.size * other.place.size
    return Meeting(
        one=one,
        other=other,
        pairs=np.zeros((2, pairs), np.int32),
        origin=np.zeros((2, pairs), np.int32),
        mark=np.zeros(pairs, np.int32),
        blamed=np.zeros(rows + columns, np.int32),
        together=np.zeros((rows, columns), np.int32),
        flow=np.zeros((rows, columns), np.int32),
        queue=np.zeros(rows + columns, np.int32),
        found=np.zeros(3, np.int64),
    )


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


def member_of(side: Side, spots: Flags, tick: int) -> Member:
    """The robot, seen at the tick in the spots."""
    places = tuple(side.resource[np.flatnonzero(spots[:-1])].tolist())
    return Member(side.robot, tick if spots[-1] else -1, tick, places)


class Pair:
    """Two robots, whose joint states before the end are searched, and the ways that they took in some steps."""

    def __init__(self, search: PriceSearch, sides: tuple[Side, Side], steps: int) -> None:
        self.sides = sides
        self.end = end_of(search, *sides)
        self.steps = steps
        self.meeting = meeting_of(*sides)
        self.natives = search.native, Native(self.meeting)

    def claim(self, is_about_more: bool, check: Callable[[], None]) -> Claim:
        """The heaviest claim about one tick, or else perhaps one about more; `check` may raise `TimeOver`."""
        weight = find_claim(*self.natives, self.end, self.steps)
        if weight >= LEAST_WEIGHT:
            return weight, self.last_members()
        return self.at_more_ticks(check) if is_about_more else NOTHING

    def at_more_ticks(self, check: Callable[[], None]) -> Claim:
        """A claim about one tick and earlier ones."""
        for side in self.sides:
            side.sees[:-1] = side.often.sum(axis=1) > 0
            side.held[:-1, :-1] = side.often > 0
        try:
            weight = find_claim(*self.natives, self.end, self.steps)
            if weight < LEAST_WEIGHT:
                return NOTHING
            needed = self.needed(check)
            weight -= sum(self.missing(whose, tick) for whose, tick in needed)
            if weight < LEAST_WEIGHT or len(needed) > MOST_SIGHTS:
                return NOTHING
            return weight, (*(self.earlier_member(*sight) for sight in needed), *self.last_members())
        finally:
            self.see_at(())

    def see_at(self, sights: Iterable[Sight]) -> None:
        """Let the robots be seen there, and nowhere else."""
        for side in self.sides:
            side.sees[:] = 0
        for whose, tick in sights:
            self.sides[whose].sees[tick] = 1

    def meetings(self, sights: Iterable[Sight], whose: int = 0, earlier: int = NONE) -> int:
        """In how many joint states at the claim's last tick the robots break it, when they are seen there.

        `blamed` gets the spots in which one of them was at an earlier tick before these.
        """
        self.see_at(sights)
        self.meeting.blamed[:] = 0
        return find_meetings(*self.natives, whose, earlier)

    def needed(self, check: Callable[[], None]) -> list[Sight]:
        """The earlier ticks at which the robots must be seen for the claim; `held` gets where."""
        for side in self.sides:
            side.inside[:] = 0
            side.inside[side.chosen[1 : 1 + side.chosen[0]]] = 1

        def is_enough(sights: Sequence[Sight]) -> bool:
            check()
            return self.meetings(sights) == 0

        last = int(self.meeting.found[1])
        seen = [(whose, tick) for tick in range(1, last) for whose in (0, 1) if self.sides[whose].sees[tick]]
        sights = fewest(seen, is_enough)
        if len(sights) <= MOST_SIGHTS:
            for whose, tick in sights:
                check()
                held = self.sides[whose].held[tick]
                held[:] = 1
                while self.meetings(sights, whose, tick) > 0:
                    held[self.meeting.blamed[: len(held)] == 1] = 0
        return sights

    def missing(self, whose: int, tick: int) -> int:
        """In how many steps the robot was not where it is held at the tick."""
        side = self.sides[whose]
        return self.steps - int(side.often[tick][side.held[tick, :-1] == 1].sum())

    def last_members(self) -> tuple[Member, Member]:
        """The robots at the claim's last tick, in all spots that cannot be taken together then."""
        find_meetings(*self.natives, 0, NONE)
        first, second = self.sides
        tick = int(self.meeting.found[1])
        together = self.meeting.together[:-1, :-1] > 0
        chosen = first.chosen[1 : 1 + first.chosen[0]]
        others = ~together[chosen].any(axis=0) & (tick <= second.latest)
        others &= together.any(axis=0) | np.isin(np.arange(len(others)), second.chosen[1 : 1 + second.chosen[0]])
        ones = ~together[:, others].any(axis=1) & (tick <= first.latest)
        ones &= together.any(axis=1) | np.isin(np.arange(len(ones)), chosen)
        return member_of(first, ones, tick), member_of(second, others, tick)

    def earlier_member(self, whose: int, tick: int) -> Member:
        """The robot where it is held at the tick, without places from which it comes too late for the last tick."""
        side = self.sides[whose]
        return member_of(side, (side.held[tick, :-1] == 1) & (tick <= side.latest), tick)


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


def end_of(search: PriceSearch, one: Side, other: Side) -> int:
    """The tick before which a claim of two robots is searched for."""
    earliest = search.dual.requests.earliest
    return min(int(min(earliest[each.robot] + each.delay for each in (one, other))) + 1, search.horizon)


def work_of(search: PriceSearch, one: Side | None, other: Side | None) -> int:
    """The most pairs of states, over all ticks, in a search for a claim of two robots; 0 where there is none."""
    return 0 if one is None or other is None else one.place.size * other.place.size * end_of(search, one, other)


def side_of(search: PriceSearch, robot: int, at: IntTable, most: int, entries: dict[int, Longs]) -> Side | None:
    """The robot with delays up to the most, unless it has no way or too many spots; `at` has where its ways were.

    `entries` keeps the first entries of robots that were seen before.
    """
    dual = search.dual
    requests, graph = dual.requests, dual.graph
    start, goal = int(requests.start[robot]), int(requests.goal[robot])
    if start == goal or requests.rest[robot][start] == NONE:
        return None
    release, rest = int(requests.release[robot]), requests.rest[robot]
    latest = int(requests.earliest[robot]) + most
    durations = graph.duration.astype(np.int64) * int(requests.pace[robot])
    if robot not in entries:
        entries[robot] = first_entries(graph, durations, start, release)
    arrival = np.where(rest == NONE, 1 << 30, entries[robot] + durations + rest)
    resource = np.flatnonzero(arrival <= latest).astype(np.int32)
    spots = len(resource)
    if spots > MOST_SPOTS or durations[resource].sum() > MOST_SPOTS or start not in resource:
        return None
    spot = np.full(len(durations), NONE, np.int32)
    spot[resource] = np.arange(spots)
    lengths = [*durations[resource].tolist(), 1 if dual.parks else int(durations[goal]), 1, 1]
    first = np.cumsum([0, *lengths]).astype(np.int32)
    states, horizon = int(first[-1]), search.horizon
    number = np.append(spot, [spots, NONE]).astype(np.int32)  # at the goal at the end, or nowhere
    often = np.zeros((horizon, spots + 2), np.int32)
    places = number[at]
    ticks = np.broadcast_to(np.arange(horizon), places.shape)
    np.add.at(often, (ticks.ravel(), places.ravel()), 1)
    latest_at = np.append(latest - durations[resource] - rest[resource], latest)
    often[:, :-1][np.arange(horizon)[:, None] > latest_at] = 0
    return Side(
        robot=robot,
        delay=most,
        start=int(first[spots + 2]) if release > 0 else int(first[spot[start] + 1]) - 1,
        spot=spot,
        resource=resource,
        first=first,
        latest=latest_at,
        often=often[:, :-1].copy(),
        spot_of=np.repeat([*range(spots + 1), spots, spots + 1], lengths).astype(np.int32),
        place=np.repeat([*resource, goal, NONE, NONE], lengths).astype(np.int32),
        branches=np.zeros(states, np.int32),
        following=np.zeros((states, int(np.diff(graph.first).max(initial=0)) + 2), np.int32),
        sees=np.zeros(horizon + 1, np.int32),
        held=np.ones((horizon + 1, spots + 2), np.int32),
        used=np.zeros(spots + 2, np.int32),
        left=np.zeros(spots + 2, np.int32),
        before=np.zeros(spots + 2, np.int32),
        chosen=np.zeros(spots + 2, np.int32),
        inside=np.zeros(spots + 2, np.int32),
    )
