"""A fleet that stays up: plans are made and robots added one after the other, on arrays that persist."""

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from carp_optimized import passes
from carp_optimized.jit.compiling import RecordsExhausted, RoomExhausted, TicksExhausted
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.reuse import Queries, Reuse
from carp_optimized.recording import enlarged, read_plan, write_plan
from carp_optimized.state import encoding, limits, room
from carp_optimized.state.arrays import (
    ALONE,
    LARGEST,
    NONE,
    UNKNOWN,
    Adding,
    Options,
    Records,
    State,
)
from carp_optimized.state.records import keep_records
from carp_spec import Instance, Neighbourhood, Plan, Refusal, Robot, RobotId, Solution
from carp_spec.documents.solutions import PlanColumns
from carp_spec.inputs.values import require_instance

T = TypeVar("T")

WITH_STOPS = Reuse(unchanged=False, prefixes=False, shared=False, bounds=False)
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
        self._take(encoding.encode(instance))
        self._ids = [robot.id for robot in instance.robots]
        self._names = [*instance.graph.index]
        self._index = {id: position for position, id in enumerate(self._ids)}
        self._vacant: list[int] = []
        self._destinations = encoding.destinations_in_use(self.state)
        self._numbered = self.state.guides.goal.size
        self.planned = np.zeros(0, np.int32)
        self.held = np.full(len(instance.robots), NONE, np.int32)
        self._noted = self.held
        self._plans: dict[int, Plan] = {}
        self._many = MANY
        self.forgotten = 0
        self._options: Neighbourhood | None = None
        self._reuse: Reuse | None = None

    @property
    def queries(self) -> Queries:
        """The queries asked and avoided until now."""
        return Queries(*self.state.counters.tolist())

    @property
    def plans(self) -> tuple[Plan, ...]:
        """The plans in planning order."""
        return tuple(self.plan_of(int(self.held[robot])) for robot in self.planned)

    @property
    def order(self) -> tuple[int, ...]:
        """The robots that have a plan, in planning order."""
        return tuple(int(robot) for robot in self.planned)

    @property
    def robots(self) -> Ints:
        """All robots, those without a plan too."""
        return np.array(sorted(self._index.values()), np.int32)

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
        self.write(robot, index)
        self._ids[index] = robot.id
        self._index[robot.id] = index
        return index

    def write(self, robot: Robot, index: int) -> None:
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
        self.ask_again()
        self.dismiss([robot])

    def withdraw(self, robots: Sequence[int] | Ints) -> None:
        """Take the plans of robots away, of those that have one."""
        gone = np.array(robots, np.int32)
        held = self.held[gone]
        held = held[held != NONE]
        if held.size:
            self.call(lambda: passes.withdraw_all(self.native, held))
            left = self.held.copy()
            left[gone] = NONE
            order = self.planned[left[self.planned] != NONE]
            self.hold(order, left[order])

    @property
    def places(self) -> tuple[Ints, list[RobotId]]:
        """The robots that have a plan, in planning order, and the ids of all indices; neither changes any more."""
        return self.planned, self._ids.copy()

    def ended(self, now: int) -> tuple[int, ...]:
        """The robots whose plans are in nobody's way from the tick `now` on."""
        if self.state.parks:
            return ()
        leave = self.state.records.leave[self.held[self.planned]]
        return tuple(self.planned[leave <= now - self.state.gap].tolist())

    def note(self) -> None:
        """Note the plans as they are now."""
        self._noted = self.held.copy()

    def changed(self) -> tuple[PlanColumns, ...]:
        """The plans that are not those that were noted, in planning order; robots may have come since."""
        held = self.held[self.planned]
        return tuple(map(self.columns, held[held != self._noted[self.planned]].tolist()))

    def replan(self, plans: Sequence[Plan], order: Sequence[RobotId]) -> None:
        """Take over other plans of robots that have one, and the planning order of all."""
        self.ask_again()
        changed = np.array([self._index[plan.robot] for plan in plans], np.int32)
        records = np.array([self.record(plan) for plan in plans], np.int32)
        self.withdraw(changed)
        self.reserve(changed, records)
        robots = np.array([self._index[id] for id in order], np.int32)
        self.hold(robots, self.held[robots])

    @property
    def kinds(self) -> Reuse:
        """The kinds of reuse; robots with stops do not note what their queries read, and have but one."""
        return self.reuse if self.state.stops.first[-1] == 0 else WITH_STOPS

    def has_more_visits(self, than: int) -> bool:
        """Whether all plans together have more visits than that."""
        return int(self.state.records.used[1]) > than and self.visits > than

    @property
    def visits(self) -> int:
        """The visits of all plans together."""
        return int(self.state.records.visits[self.held[self.planned]].sum(dtype=np.int64))

    def commit(self, plans: Sequence[Plan]) -> None:
        """Take over plans made elsewhere, which must fit the plans of the fleet."""
        records = np.array([self.record(plan) for plan in plans], np.int32)
        robots = np.array([self._index[plan.robot] for plan in plans], np.int32)
        self.reserve(robots, records)

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
        return None if record == NONE else self.plan_of(record)

    def ask_again(self) -> None:
        """Let all queries be asked again: plans are withdrawn that have been in the way of others."""
        self.state.records.expansions[self.held[self.planned]] = UNKNOWN

    @property
    def worth(self) -> tuple[int, int]:
        """The number of unplanned robots, and the total cost of the others."""
        return (self.held.size - self.planned.size, self.cost(self.held[self.planned]))

    def adding_with(self, options: Neighbourhood) -> Native[Adding]:
        """All that adding a robot with these options takes, kept as long as they and the arrays stay the same."""
        reuse = self.kinds
        if self._adding is not None and self._options is options and self._reuse is reuse:
            return self._adding
        self._options, self._reuse = options, reuse
        kinds = (reuse.kept, reuse.unchanged, reuse.prefixes, reuse.shared, reuse.bounds)
        members, sample = min(options.m, len(self.held) + 1), options.sample or 0
        encoded = Options(members, sample, options.baseline, *kinds)
        if self._adding is None or self._adding.fields.options != encoded:
            work = room.no_work(len(self.held), members, sample)
            answers = room.no_answers(members, self.state.graph.duration.size)
            self._adding = Native(Adding(self.state, self.empty.fields, encoded, work, answers))
        return self._adding

    def clear(self) -> None:
        """Forget all plans."""
        self.withdraw(self.planned)

    def _take(self, state: State) -> None:
        """Work on other arrays."""
        self.state = state
        self.native = Native(state)
        self.empty = Native(encoding.without_reservations(state))
        self._adding = None

    def _make_room(self, size: int, robot: Robot) -> None:
        """Make room for that many robots, up to that robot's pace, and more destinations; guides are made again."""
        further = max(size, 2 * len(robot.stops))
        state, self._numbered = encoding.with_robots(self.state, size, robot.pace, further)
        self._destinations = encoding.destinations_in_use(state)
        self._take(state)
        more = size - len(self._ids)
        self._ids += more * [""]
        nothing = np.full(more, NONE, np.int32)
        self.held = np.concatenate([self.held, nothing])
        self._noted = np.concatenate([self._noted, nothing])

    def reserve(self, robots: Ints, records: Ints) -> None:
        """Hold further plans behind those held."""
        self.call(lambda: passes.reserve_all(self.native, records))
        self.hold(np.append(self.planned, robots), np.append(self.held[self.planned], records))

    def hold(self, robots: Ints, records: Ints) -> None:
        """Note the plans that the windows hold."""
        self.planned = robots
        self.held = np.full(self.held.size, NONE, np.int32)
        self.held[robots] = records

    def cost(self, records: Ints) -> int:
        """What the plans of these records cost together."""
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
        held = self.held[self.planned]
        self.call(lambda: passes.reserve_all(self.native, held))

    def forget_old_records(self) -> None:
        """Forget records of plans that are no longer held, if they have become many."""
        _, visits, expansions = self.state.records.used.tolist()
        if visits + expansions > self._many:
            self.forget()

    def forget(self) -> None:
        """Keep only the records of the plans held."""
        self.forgotten += 1
        used = self.state.records.used
        kept = np.sort(self.held[self.planned])
        number = np.full(int(used[0]) + 1, NONE, np.int32)  # the last is that of no record
        number[kept] = np.arange(kept.size)
        self._noted = number[self._noted]
        keep_records(self.native, kept)
        self._plans = {new: self._plans[int(old)] for new, old in enumerate(kept) if int(old) in self._plans}
        self.held = self.state.reserved.copy()
        self._many = 4 * (int(used[1]) + int(used[2])) + MANY

    def record(self, plan: Plan) -> int:
        """Take up a plan without reserving it; the number by which it is known."""
        limits.refuse_tick("$.plans", plan.visits[-1].leave or plan.visits[-1].enter)
        record = self.call(lambda: write_plan(self.native, self.instance, self._index[plan.robot], plan))
        self._plans[record] = plan
        return record

    def plan_of(self, record: int) -> Plan:
        """The plan of a record."""
        if record not in self._plans:
            self._plans[record] = self.columns(record).plan
        return self._plans[record]

    def columns(self, record: int) -> PlanColumns:
        """The same as columns."""
        return read_plan(self.state, self._names, record, self._ids)
