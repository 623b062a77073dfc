"""A fleet that stays up: plans are made and robots added one after the other, on arrays that persist."""

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from carp_optimized import passes
from carp_optimized.fixed_paths import Path, PathMoves, disjoint_paths, shortest_paths
from carp_optimized.jit.compiling import RecordsExhausted, RoomExhausted, TicksExhausted
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.adding import add_robot
from carp_optimized.neighbourhood.polishing import play_rounds
from carp_optimized.neighbourhood.reuse import Queries, Reuse
from carp_optimized.queries.search import ALONE
from carp_optimized.recording import enlarged, read_plan, write_plan
from carp_optimized.state import encoding, limits, room
from carp_optimized.state.arrays import (
    FORGOTTEN,
    LARGEST,
    NONE,
    NOW,
    QUEUED,
    TURN,
    UNASKED,
    UNKNOWN,
    Adding,
    Options,
    Polish,
    Records,
    State,
)
from carp_optimized.state.records import keep_records
from carp_spec import FixedPaths, Instance, Neighbourhood, Plan, Refusal, Robot, RobotId, Shuffled, Solution
from carp_spec.documents.solutions import PlanColumns
from carp_spec.inputs.values import require_instance
from carp_spec.limits import refuse_stops
from carp_spec.permutations import shuffle, splitmix64

T = TypeVar("T")

WITH_STOPS = Reuse(unchanged=False, prefixes=False, shared=False, bounds=False)
PART = 64  # robots of a pass between two looks at a clock
MORE = 64  # robots for which there is room
MANY = 1 << 16  # visits and expansions of records that are no longer held


class PlannedFleet:
    """An instance with the plans that some of its robots have, in planning order.

    Robots are named by their index in the instance. Compiled functions get the arrays of `state` as `native`, within
    `call`: one that runs out of room is called again with larger arrays. The windows hold the plans of `order` whenever
    none is at work.
    """

    def __init__(self, instance: Instance, reuse: Reuse | None = None) -> None:
        """Begin without plans.

        Raises `Refusal` if the instance has numbers that are too large.
        """
        require_instance(instance)
        limits.refuse_what_is_too_large(instance)
        self.instance = instance
        self.reuse = reuse or Reuse()
        self._adding: Native[Adding] | None = None
        self._path_moves: PathMoves | None = None
        self._take(encoding.encode(instance))
        self._ids = [robot.id for robot in instance.robots]
        self._names = [*instance.graph.index]
        self._index = {id: position for position, id in enumerate(self._ids)}
        self._vacant: list[int] = []
        self._destinations = encoding.destinations_in_use(self.state)
        self._numbered = self.state.guides.goal.size
        self._order = np.zeros(0, np.int32)
        self._records = np.full(len(instance.robots), NONE, np.int32)
        self._noted = self._records
        self._plans: dict[int, Plan] = {}
        self._many = MANY
        self._forgotten = 0
        self._options: Neighbourhood | None = None
        self._reuse: Reuse | None = None

    @property
    def queries(self) -> Queries:
        """The queries asked and avoided until now."""
        return Queries(*self.state.counters.tolist())

    @property
    def plans(self) -> tuple[Plan, ...]:
        """The plans in planning order."""
        return tuple(self._plan(int(self._records[robot])) for robot in self._order)

    @property
    def order(self) -> tuple[int, ...]:
        """The robots that have a plan, in planning order."""
        return tuple(int(robot) for robot in self._order)

    def index(self, robot: RobotId) -> int:
        """The index of a robot in the instance."""
        return self._index[robot]

    def ticks_to_goal(self, robot: int) -> int:
        """The cost of a robot's shortest path on the empty graph; 0 if none exists."""
        return self.call(lambda: passes.shortest(self.native, robot))

    @property
    def keeps_all_guides(self) -> bool:
        """Whether there is room for the distances to all goals at once."""
        return self.state.guides.holds.size == self.state.guides.goal.size

    def require_robots(self, robots: Sequence[Robot]) -> None:
        """Raise `Refusal` unless the robots can be taken up."""
        limits.refuse_robots(robots, self.state.longest)

    def enlist(self, robot: Robot) -> int:
        """Take up a robot of a new id, without a plan yet; its index, which no other has while it is there."""
        if not self._vacant:
            size = 2 * len(self._ids) + MORE
            self._vacant = [*range(size - 1, len(self._ids) - 1, -1)]
            self._make_room(size, robot)
        index = self._vacant.pop()
        self._write(robot, index)
        self._ids[index] = robot.id
        self._index[robot.id] = index
        return index

    def _write(self, robot: Robot, index: int) -> None:
        """Write a robot over the one at an index."""
        ends = encoding.destinations_of(self.instance, robot)
        new = {end for end in ends if end not in self._destinations}
        is_full = self._numbered + len(new) > self.state.guides.goal.size
        if new and (is_full or not encoding.has_scale(self.state, robot.pace)):
            self._make_room(len(self._ids), robot)
        for end in ends:
            if end not in self._destinations:
                self._destinations[end] = self._numbered
                self._numbered += 1
        if not encoding.has_room_for_stops(self.state, index, robot):
            self._take(encoding.with_stops(self.state, robot))
        encoding.write_robot(self.state, self.instance, robot, index, self._destinations)

    def dismiss(self, robots: Sequence[int]) -> tuple[RobotId, ...]:
        """Forget robots, with the plans of those that have one; others may get their indices. Their ids."""
        self.withdraw(robots)
        for index in robots:
            del self._index[self._ids[index]]
            self._vacant.append(index)
            encoding.forget_stops(self.state, index)
        return tuple(map(self._ids.__getitem__, robots))

    def remove(self, robot: int) -> None:
        """Forget a robot, as `dismiss` does, that may be in the way of others still."""
        self._ask_again()
        self.dismiss([robot])

    def withdraw(self, robots: Sequence[int] | Ints) -> None:
        """Take the plans of robots away, of those that have one."""
        gone = np.array(robots, np.int32)
        held = self._records[gone]
        held = held[held != NONE]
        if held.size:
            self.call(lambda: passes.withdraw_all(self.native, held))
            order = self._order[~np.isin(self._order, gone)]
            self._hold(order, self._records[order])

    @property
    def places(self) -> tuple[Ints, list[RobotId]]:
        """The robots that have a plan, in planning order, and the ids of all indices; neither changes any more."""
        return self._order, self._ids.copy()

    def ended(self, now: int) -> tuple[int, ...]:
        """The robots whose plans are in nobody's way from the tick `now` on."""
        if self.state.parks:
            return ()
        leave = self.state.records.leave[self._records[self._order]]
        return tuple(self._order[leave <= now - self.state.gap].tolist())

    def note(self) -> None:
        """Note the plans as they are now."""
        self._noted = self._records.copy()

    def changed(self) -> tuple[PlanColumns, ...]:
        """The plans that are not those that were noted, in planning order; robots may have come since."""
        held = self._records[self._order]
        return tuple(map(self._columns, held[held != self._noted[self._order]].tolist()))

    def replan(self, plans: Sequence[Plan], order: Sequence[RobotId]) -> None:
        """Take over other plans of robots that have one, and the planning order of all."""
        self._ask_again()
        changed = np.array([self._index[plan.robot] for plan in plans], np.int32)
        records = np.array([self.record(plan) for plan in plans], np.int32)
        self.withdraw(changed)
        self._reserve(changed, records)
        robots = np.array([self._index[id] for id in order], np.int32)
        self._hold(robots, self._records[robots])

    def assign(
        self, robot: Robot, before: Robot, plan: Plan, now: int, options: Neighbourhood, number: int | None = None
    ) -> bool:
        """Plan again, as `add` does, a robot that has other stops than `before`, and has followed the plan until now.

        If it finds no plan, all is as before. What queries have noted may stay: for a robot with stops it is not
        used, and once the robot has vanished, its plan before has ended too, as that left no later.
        """
        index, order = self._index[robot.id], self._order
        self.withdraw([index])
        self._write(robot, index)
        if self.add(index, now, options, number, plan):
            return True
        self._write(before, index)
        self.commit([plan])
        self._hold(order, self._records[order])
        return False

    @property
    def _kinds(self) -> Reuse:
        """The kinds of reuse; robots with stops do not note what their queries read, and have but one."""
        return self.reuse if self.state.stops.first[-1] == 0 else WITH_STOPS

    def has_more_visits(self, than: int) -> bool:
        """Whether all plans together have more visits than that."""
        return int(self.state.records.used[1]) > than and self.visits > than

    @property
    def visits(self) -> int:
        """The visits of all plans together."""
        return int(self.state.records.visits[self._records[self._order]].sum(dtype=np.int64))

    def commit(self, plans: Sequence[Plan]) -> None:
        """Take over plans made elsewhere, which must fit the plans of the fleet."""
        records = np.array([self.record(plan) for plan in plans], np.int32)
        robots = np.array([self._index[plan.robot] for plan in plans], np.int32)
        self._reserve(robots, records)

    def commit_solution(self, solution: Solution) -> None:
        """Take over the plans of a solution, in its planning order."""
        plans = {plan.robot: plan for plan in solution.plans}
        self.commit([plans[robot] for robot in solution.order])

    def find(self, robot: int, before: Plan | None, now: int, asked: int = ALONE) -> Plan | None:
        """The plan of a robot that is not in the fleet, which has followed the plan `before` until now.

        It is the one of `query/ties`, or one of the same arrival if `WHOLE` is asked for
        (`carp_optimized.queries.search`).
        """
        limits.refuse_tick("$.now", now)
        followed = NONE if before is None else self.record(before)
        record = self.call(lambda: passes.find_one(self.native, robot, followed, now, asked))
        return None if record == NONE else self._plan(record)

    def plan_again(self, robot: int, now: int = 0) -> bool:
        """Plan a robot beside the plans of all others; whether it has none so far, or one that arrives later.

        If so, it comes last in the planning order; if not, all is as before. It keeps what it has done until now.
        """
        own, order = np.array([robot], np.int32), self._order
        held = self._records[own]
        self.withdraw(own)
        followed = int(held[0]) if now > 0 else NONE
        found = np.full(1, self.call(lambda: passes.find_one(self.native, robot, followed, now, ALONE)), np.int32)
        is_better = bool(found[0] != NONE and (held[0] == NONE or self._cost(found) < self._cost(held)))
        if is_better:
            self._reserve(own, found)
        elif held[0] != NONE:
            self._reserve(own, held)
            self._hold(order, self._records[order])
        return is_better

    def put_in_order(self, goes_on: Callable[[], bool]) -> None:
        """Put plans of tick 0 into an order in which none is late beside those before it, as far as there is one.

        A plan that is best beside some plans stays so beside more: it is next as soon as it is. Others come last, and
        so do those for which there is no time.
        """
        if not goes_on():
            return
        records, waiting, last = self._records.copy(), [*self.order], -1
        self.clear()
        while len(waiting) != last and goes_on():
            last = len(waiting)
            for robot in tuple(waiting):
                own = np.array([robot], np.int32)
                if goes_on() and self._is_best(robot, records[own]):
                    waiting.remove(robot)
                    self._reserve(own, records[own])
        rest = np.array(waiting, np.int32)
        self._reserve(rest, records[rest])

    def _is_best(self, robot: int, record: Ints) -> bool:
        """Whether the robot, which has no plan now, could not arrive earlier than by that one."""
        used = self.state.records.used.copy()
        found = np.full(1, self.call(lambda: passes.find_one(self.native, robot, NONE, 0, ALONE)), np.int32)
        is_best = found[0] != NONE and self._cost(found) == self._cost(record)
        self.state.records.used[:] = used
        return bool(is_best)

    def find_beside(self, robot: int, records: Sequence[int]) -> Plan | None:
        """The plan of a robot as `find` makes it without history, beside further plans, which `record` has taken up."""
        further = np.array(records, np.int32)

        def attempt() -> int:
            passes.reserve_all(self.native, further)
            found = passes.find_one(self.native, robot, NONE, 0, ALONE)
            passes.withdraw_all(self.native, further)
            return found

        found = self.call(attempt)
        return None if found == NONE else self._plan(found)

    def repeat_query(self, robot: int, times: int) -> None:
        """Ask the query of a robot without a plan that often; for benchmarks."""
        self.call(lambda: passes.repeat_query(self.native, robot, times))

    def carp(self, order: Sequence[int], goes_on: Callable[[], bool] = lambda: True) -> None:
        """Plan the robots in order, as if there were no plans yet, as long as it goes on."""
        self.clear()
        self.state.records.used[:] = 0
        self._plans.clear()
        robots = np.array(order, np.int32)
        self._pass(robots, self._records, 0, goes_on)

    def shuffled(self, planner: Shuffled, order: Sequence[int], advance: Callable[[], None], now: int = 0) -> None:
        """The best of several passes of CARP; robots that have a plan keep what they did until now."""
        followed = self._records.copy()
        self.clear()
        stream = splitmix64(planner.seed)
        best_worth: tuple[int, int] | None = None
        best = np.zeros(0, np.int32), np.zeros(0, np.int32)
        for attempt in range(planner.attempts):
            order = order if attempt == 0 else shuffle(order, stream)
            used = self.state.records.used.copy()
            robots = np.array(order, np.int32)
            plans = self._pass(robots, followed, now)
            found = plans != NONE
            worth = (-int(found.sum()), self._cost(plans[found]))
            self.clear()
            if best_worth is None or worth < best_worth:
                best_worth, best = worth, (robots[found], plans[found])
            else:
                self.state.records.used[:] = used
            advance()
        self._reserve(*best)

    def greedy(self, advance: Callable[[], None]) -> None:
        """Plan all robots, as if there were no plans yet, each time the one whose plan is cheapest."""
        self.clear()
        count = len(self._records)
        robots, plans = np.zeros(count, np.int32), np.full(count, NONE, np.int32)

        def rounds() -> int:
            waiting, found = np.arange(count, dtype=np.int32), np.full(count, UNASKED, np.int32)
            return passes.greedy(self.native, waiting, found, robots, plans, self.reuse.unchanged)

        planned = self.call(rounds)
        self._hold(robots[:planned], plans[:planned])
        for _ in range(planned):
            advance()

    def fixed_paths(self, options: FixedPaths) -> None:
        """Plan all robots in the order given, as if there were no plans yet, each on the best of a few paths."""
        refuse_stops(self.instance)
        self.clear()
        for robot in range(len(self._records)):
            self.add_on_path(robot, self.paths(robot, options))

    def paths(self, robot: int, options: FixedPaths) -> list[Path]:
        """The paths from which a robot may choose."""
        start, goal = int(self.state.robots.start[robot]), int(self.state.robots.goal[robot])
        choose = shortest_paths if options.paths == "shortest" else disjoint_paths
        return self.call(lambda: choose(self.native, start, goal, options.k))

    def add_on_path(self, robot: int, paths: Sequence[Path]) -> bool:
        """Add a robot on the path on which it arrives first, the first of equals; whether it has a plan on any."""
        self.forget_old_records()

        def attempt() -> list[int]:
            passes.reach_from_everywhere(self.native, robot)
            moves = self._path_moves = self._path_moves or PathMoves(self.state)
            return [passes.find_one(moves.along(path), robot, NONE, 0, ALONE) for path in paths]

        found = [record for record in self.call(attempt) if record != NONE]
        if not found:
            return False
        best = np.array([min(found, key=lambda record: int(self.state.records.arrival[record]))], np.int32)
        self._reserve(np.array([robot], np.int32), best)
        return True

    def add(
        self, robot: int, now: int, options: Neighbourhood, number: int | None = None, before: Plan | None = None
    ) -> bool:
        """Add a robot by the neighbourhood planner; if it stays unplanned, all plans stay as they are.

        Orders are drawn for its `number` in the instance, which is its index unless given. A robot that is to be
        planned again has followed the plan `before` until now.
        """
        limits.refuse_tick("$.now", now)
        self.forget_old_records()
        followed = NONE if before is None else self.record(before)
        order = np.empty(self._order.size + 1, np.int32)

        def attempt() -> bool:
            adding = self._adding_with(options)
            if options.sample is not None:  # orders are drawn
                adding.fields.work.stream[0] = (options.seed + (robot if number is None else number)) % 2**64
            return add_robot(adding, self._order, robot, followed, now, order)

        if self.call(attempt):
            self._order = order
            self._records = self.state.reserved.copy()
            return True
        if options.fallback is None:
            return False
        return self._fall_back(robot, followed, now, Shuffled(options.fallback, options.seed))

    def polishing(self, seed: int, now: int = 0) -> Native[Polish]:
        """The arrays for polishing this fleet at a tick, from the plans that it has."""
        limits.refuse_tick("$.now", now)
        able = np.array(sorted(self._index.values() if now == 0 else self.order), np.int32)
        followed = self._records if now > 0 else np.full(len(self._records), NONE, np.int32)
        costs = np.full(len(self._records), NONE, np.int64)
        self.call(lambda: passes.cost_each_alone(self._empty, able, followed, now, costs))
        past = np.zeros(len(self._records), np.int32)
        for robot in self._order if now > 0 else ():
            past[robot] = sum(enter <= now for enter in self._columns(int(self._records[robot])).enters)
        polish = room.no_polish(costs, past, self.state.graph.duration.size)
        polish.stream[0] = seed
        polish.counts[NOW] = now
        polish.counts[FORGOTTEN] = self._forgotten
        return Native(polish)

    def polish(self, polishing: Native[Polish], rounds: int) -> int:
        """Play rounds of `polish/...`; returns how many were played before nothing was left to do."""
        self.forget_old_records()
        work = polishing.fields
        size, turn, stream = self._order.size, int(work.counts[TURN]), int(work.stream[0])
        if work.counts[FORGOTTEN] != self._forgotten:
            work.alone[work.alone != NONE] = UNASKED
            work.counts[FORGOTTEN] = self._forgotten
        alone = work.alone.copy()

        def attempt() -> int:
            work.alone[:] = alone
            work.queue[:size] = self._order
            work.plans[:] = self._records
            work.counts[QUEUED], work.counts[TURN], work.stream[0] = size, turn, stream
            return play_rounds(self.native, polishing, self._empty, rounds)

        played = self.call(attempt)
        order = work.queue[: work.counts[QUEUED]].copy()
        self._hold(order, work.plans[order])
        self._ask_again()
        return played

    def _ask_again(self) -> None:
        """Let all queries be asked again: plans are withdrawn that have been in the way of others."""
        self.state.records.expansions[self._records[self._order]] = UNKNOWN

    @property
    def worth(self) -> tuple[int, int]:
        """The number of unplanned robots, and the total cost of the others."""
        return (self._records.size - self._order.size, self._cost(self._records[self._order]))

    def _adding_with(self, options: Neighbourhood) -> Native[Adding]:
        """All that adding a robot with these options takes, kept as long as they and the arrays stay the same."""
        reuse = self._kinds
        if self._adding is not None and self._options is options and self._reuse is reuse:
            return self._adding
        self._options, self._reuse = options, reuse
        kinds = (reuse.kept, reuse.unchanged, reuse.prefixes, reuse.shared, reuse.bounds)
        members, sample = min(options.m, len(self._records) + 1), options.sample or 0
        encoded = Options(members, sample, options.baseline, *kinds)
        if self._adding is None or self._adding.fields.options != encoded:
            work = room.no_work(len(self._records), members, sample)
            answers = room.no_answers(members, self.state.graph.duration.size)
            self._adding = Native(Adding(self.state, self._empty.fields, encoded, work, answers))
        return self._adding

    def clear(self) -> None:
        """Forget all plans."""
        self.withdraw(self._order)

    def _take(self, state: State) -> None:
        """Work on other arrays."""
        self.state = state
        self.native = Native(state)
        self._empty = Native(encoding.without_reservations(state))
        self._adding = None
        self._path_moves = None

    def _make_room(self, size: int, robot: Robot) -> None:
        """Make room for that many robots, up to that robot's pace, and more destinations; guides are made again."""
        further = max(size, 2 * len(robot.stops))
        state, self._numbered = encoding.with_robots(self.state, size, robot.pace, further)
        self._destinations = encoding.destinations_in_use(state)
        self._take(state)
        more = size - len(self._ids)
        self._ids += more * [""]
        nothing = np.full(more, NONE, np.int32)
        self._records = np.concatenate([self._records, nothing])
        self._noted = np.concatenate([self._noted, nothing])

    def _fall_back(self, robot: int, followed: int, now: int, planner: Shuffled) -> bool:
        order, held = self._order, self._records[self._order]
        self._records[robot] = followed
        self.shuffled(planner, [*self.order, robot], lambda: None, now)
        if self._order.size == order.size + 1:
            return True
        self.clear()
        self._reserve(order, held)
        return False

    def _pass(self, robots: Ints, followed: Ints, now: int, goes_on: Callable[[], bool] = lambda: True) -> Ints:
        """Plan robots in order as long as it goes on, where there are no plans yet, and hold the plans found.

        A part at a time, so that little is done again where there was too little room.
        """
        plans = np.full(robots.size, NONE, np.int32)
        for first in range(0, robots.size, PART):
            if not goes_on():
                break
            part, found = robots[first : first + PART], plans[first : first + PART]

            def attempt(part: Ints = part, found: Ints = found, first: int = first) -> None:
                passes.carp(self.native, part, followed, now, found, first)

            self.call(attempt)
            held = plans[: first + PART]
            self._hold(robots[: first + PART][held != NONE], held[held != NONE])
        return plans

    def _reserve(self, robots: Ints, records: Ints) -> None:
        """Hold further plans behind those held."""
        self.call(lambda: passes.reserve_all(self.native, records))
        self._hold(np.append(self._order, robots), np.append(self._records[self._order], records))

    def _hold(self, robots: Ints, records: Ints) -> None:
        """Note the plans that the windows hold."""
        self._order = robots
        self._records = np.full(self._records.size, NONE, np.int32)
        self._records[robots] = records

    def _cost(self, records: Ints) -> int:
        held = self.state.records
        last = held.visits_at[records] + held.visits[records] - 1
        releases = self.state.robots.release[held.robot[records]]
        return int(held.enter[last].sum(dtype=np.int64) - releases.sum(dtype=np.int64))

    def call(self, function: Callable[[], T]) -> T:
        """Call a compiled function, again with more room if there was too little; refuse ticks that are too large."""
        while True:
            used = self.state.records.used.tolist()
            counters = self.state.counters.tolist()
            try:
                return function()
            except RecordsExhausted:
                self._rebuild(used, counters, enlarged(self.state.records), 1)
            except RoomExhausted:
                self._rebuild(used, counters, self.state.records, 2)
            except TicksExhausted:
                self._rebuild(used, counters, self.state.records, 1)
                message = f"a plan would need ticks beyond {LARGEST}; {limits.NO_LIMIT_THERE}"
                raise Refusal("limit", "$.robots", "limit/ticks", message) from None

    def _rebuild(self, used: Sequence[int], counters: Sequence[int], records: Records, times: int) -> None:
        """Go back to the plans held before a call that was broken off, with these records and `times` the places."""
        self.state.counters[:] = counters
        records.used[:] = used
        self._take(encoding.with_room(self.state, times * self.state.windows.start.size, records))
        held = self._records[self._order]
        self.call(lambda: passes.reserve_all(self.native, held))

    def forget_old_records(self) -> None:
        """Forget records of plans that are no longer held, if they have become many."""
        _, visits, expansions = self.state.records.used.tolist()
        if visits + expansions > self._many:
            self.forget()

    def forget(self) -> None:
        """Keep only the records of the plans held."""
        self._forgotten += 1
        used = self.state.records.used
        kept = np.sort(self._records[self._order])
        number = np.full(int(used[0]) + 1, NONE, np.int32)  # the last is that of no record
        number[kept] = np.arange(kept.size)
        self._noted = number[self._noted]
        keep_records(self.native, kept)
        self._plans = {new: self._plans[int(old)] for new, old in enumerate(kept) if int(old) in self._plans}
        self._records = self.state.reserved.copy()
        self._many = 4 * (int(used[1]) + int(used[2])) + MANY

    def record(self, plan: Plan) -> int:
        """Take up a plan without reserving it; the number by which it is known."""
        for position, visit in enumerate(plan.visits):
            limits.refuse_tick(f"$.plans[{self._index[plan.robot]}].visits[{position}]", visit.leave or visit.enter)
        record = self.call(lambda: write_plan(self.native, self.instance, self._index[plan.robot], plan))
        self._plans[record] = plan
        return record

    def _plan(self, record: int) -> Plan:
        if record not in self._plans:
            self._plans[record] = self._columns(record).plan
        return self._plans[record]

    def _columns(self, record: int) -> PlanColumns:
        return read_plan(self.state, self._names, record, self._ids)
