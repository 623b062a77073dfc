"""The search for moves by which robots finish, over the places of all of them.

A robot at a place that nobody can miss stays there without harm: each constraint on it has room for all that still
come. So what is open up to such a place is done at once. All other moves are tried, the one planned first before the
others.
"""

from collections import defaultdict, deque
from collections.abc import Mapping, Sequence
from math import inf
from time import perf_counter

from carp_spec import RobotId
from carp_verify.release.holding import State, Ways
from carp_verify.release.verify import Places


class CutOffError(Exception):
    """More states than the limit would have to be looked at, or the time is over."""


class Budget:
    """The number of states that may still be looked at, and until when, by `perf_counter`."""

    def __init__(self, states: float, until: float = inf) -> None:
        self.left, self.until = states, until

    def spend(self) -> None:
        """Look at one; raises `CutOffError` if none is left."""
        self.look_at_the_clock()
        if self.left == 0:
            raise CutOffError
        self.left -= 1

    def look_at_the_clock(self) -> None:
        """Raise `CutOffError` if the time is over."""
        if perf_counter() >= self.until:
            raise CutOffError


class Search:
    """The moves of some robots; `planned` has the ticks at which they are to enter their visits."""

    def __init__(self, ways: Ways, planned: Mapping[RobotId, Sequence[int]], budget: Budget) -> None:
        self.ways, self.planned, self.budget = ways, planned, budget
        self.robots = tuple(ways.constraints)
        self.last: dict[int, dict[RobotId, int]] = defaultdict(dict)
        for robot, way in ways.constraints.items():
            for place, constraints in enumerate(way):
                for each in constraints:
                    self.last[each][robot] = place

    def finish(self, start: State) -> tuple[RobotId, ...] | None:
        """Moves by which all robots finish, `None` if there are none."""
        state, moves = self._settled({robot: start[robot] for robot in self.robots})
        first = tuple(state.values())
        before: dict[Places, tuple[Places | None, tuple[RobotId, ...]]] = {first: (None, moves)}
        waiting = [first]
        while waiting:
            places = waiting.pop()
            self.budget.spend()
            state = dict(zip(self.robots, places, strict=True))
            if all(self.ways.has_ended(robot, place) for robot, place in state.items()):
                return _way_to(places, before)
            used = self.ways.used(state)
            for robot in self._last_planned_first(state):
                if self.ways.is_open(robot, state[robot], used):
                    after, more = self._settled({**state, robot: state[robot] + 1})
                    reached = tuple(after.values())
                    if reached not in before:
                        before[reached] = (places, (robot, *more))
                        waiting.append(reached)
        return None

    def _last_planned_first(self, state: State) -> list[RobotId]:
        def due(robot: RobotId) -> int:
            ticks = self.planned[robot]
            return ticks[min(state[robot] + 1, len(ticks) - 1)]

        return sorted(self.robots, key=due, reverse=True)

    def _settled(self, state: dict[RobotId, int]) -> tuple[dict[RobotId, int], tuple[RobotId, ...]]:
        """The state after all moves that harm nobody, and these moves."""
        moves: list[RobotId] = []
        used = self.ways.used(state)
        waiting = deque(self.robots)
        while waiting:
            self.budget.look_at_the_clock()
            robot = waiting.popleft()
            place = best = state[robot]
            while self.ways.is_open(robot, place, used):
                used.subtract(self.ways.held(robot, place, place))
                place += 1
                used.update(self.ways.held(robot, place, place))
                if self._harms_nobody(robot, place, state):
                    best = place
            used.subtract(self.ways.held(robot, place, place))
            used.update(self.ways.held(robot, best, best))
            if best > state[robot]:
                moves += [robot] * (best - state[robot])
                state[robot] = best
                waiting.extend(each for each in self.robots if each not in waiting)
        return state, tuple(moves)

    def _harms_nobody(self, robot: RobotId, place: int, state: State) -> bool:
        return all(
            sum(other != robot and last >= state[other] for other, last in self.last[each].items())
            < self.ways.capacity[each]
            for each in self.ways.held(robot, place, place)
        )


def _way_to(
    places: Places | None, before: Mapping[Places, tuple[Places | None, tuple[RobotId, ...]]]
) -> tuple[RobotId, ...]:
    parts: list[tuple[RobotId, ...]] = []
    while places is not None:
        places, moves = before[places]
        parts.append(moves)
    return tuple(robot for moves in reversed(parts) for robot in moves)


def all_places(ways: Ways, start: State, robots: Sequence[RobotId], budget: Budget) -> frozenset[Places]:
    """All places that the robots can get to together."""
    found = {tuple(start[robot] for robot in robots)}
    waiting = [*found]
    while waiting:
        places = waiting.pop()
        budget.spend()
        state = dict(zip(robots, places, strict=True))
        used = ways.used(state)
        for number, robot in enumerate(robots):
            after = (*places[:number], places[number] + 1, *places[number + 1 :])
            if after not in found and ways.is_open(robot, places[number], used):
                found.add(after)
                waiting.append(after)
    return frozenset(found)
