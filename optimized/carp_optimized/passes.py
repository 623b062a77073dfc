"""Prioritized planning of many robots: CARP, and greedy best-first."""

from carp_optimized.jit.compiling import RecordsExhausted, TicksExhausted, entry
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.jit.references import Native
from carp_optimized.queries.guides import guide_of, guide_slot
from carp_optimized.queries.over_stops import shortest_of
from carp_optimized.queries.search import cost_alone, find_any_plan, find_plan_by
from carp_optimized.state.arrays import ALONE, NEVER, NONE, NOTED, TOO_FAR, UNASKED, UNCHANGED, UNKNOWN, State
from carp_optimized.state.natives import state_at
from carp_optimized.state.records import close_record, cost_of, start_record
from carp_optimized.windows.fitting import still_found
from carp_optimized.windows.reserving import book_all, reserve


@entry
def find_one(native: Native[State], robot: int, before: int, now: int, asked: int) -> int:
    """The record of one robot's plan against the reservations, or `NONE`; nothing is reserved.

    It is asked for `ALONE`, `WHOLE` or `GREEDY`.
    """
    state = state_at(native)
    return find_any_plan(state, robot, before, now, NEVER, NEVER, asked)


@entry
def cost_each_alone(empty: Native[State], robots: Ints, before: Ints, now: int, costs: Longs) -> None:
    """The costs of the plans that robots have where nothing is reserved, by robot; `NONE` for one without.

    `before` are the plans followed until now, by robot.
    """
    state = state_at(empty)
    used, visits, expansions = int(state.records.used[0]), int(state.records.used[1]), int(state.records.used[2])
    for robot in robots:
        costs[robot] = cost_alone(state, int(robot), int(before[robot]), now)
        state.records.used[0] = used
        state.records.used[1] = visits
        state.records.used[2] = expansions


@entry
def shortest(native: Native[State], robot: int) -> int:
    """The ticks from the robot's start to its goal on the empty graph; 0 if no moves lead there."""
    state = state_at(native)
    ticks = shortest_of(state, robot)
    if ticks == TOO_FAR:
        raise TicksExhausted
    return max(ticks, 0)


@entry
def reach_from_everywhere(native: Native[State], robot: int) -> None:
    """Make the guide of the robot's destination as far as any resource."""
    state = state_at(native)
    for resource in range(state.graph.duration.size):
        guide_slot(state, robot, resource)


@entry
def reach_stop(native: Native[State], number: int) -> int:
    """Make the guide to a stop, one of those of all robots, as far as moves lead; its slot."""
    state = state_at(native)
    return guide_of(state, int(state.stops.destination[number]))


@entry
def reserve_all(native: Native[State], plans: Ints) -> None:
    """Reserve plans that fit."""
    book_all(state_at(native), plans, True)


@entry
def withdraw_all(native: Native[State], plans: Ints) -> None:
    """Withdraw plans that are reserved."""
    book_all(state_at(native), plans, False)


@entry
def record_plan(native: Native[State], robot: int, resources: Ints, enters: Ints, leave: int) -> int:
    """The record of a plan that no query has made."""
    state = state_at(native)
    records = state.records
    record = start_record(state, robot, 0, 0)
    first = int(records.visits_at[record])
    end = first + resources.size
    if end > records.resource.size:
        raise RecordsExhausted
    for k in range(resources.size):
        records.resource[first + k] = resources[k]
        records.enter[first + k] = enters[k]
    records.visits[record] = resources.size
    records.leave[record] = leave
    records.expansions[record] = UNKNOWN
    close_record(state, record)
    return record


@entry
def carp(native: Native[State], order: Ints, before: Ints, now: int, plans: Ints, rank: int) -> None:
    """Plan the robots in order, each against those before it, into `plans`; `NONE` for one that finds no plan.

    `before` are the plans followed until now, by robot. The first robot gets the rank. Queries of robots that park may
    read so much that it is not noted.
    """
    state = state_at(native)
    for k in range(order.size):
        robot = int(order[k])
        state.rank[robot] = rank + k
        plan = find_any_plan(state, robot, int(before[robot]), now, NEVER, NEVER, ALONE if state.parks else NOTED)
        plans[k] = plan
        if plan != NONE:
            reserve(state, plan)


@entry
def greedy(native: Native[State], waiting: Ints, found: Ints, order: Ints, plans: Ints, skip_unchanged: bool) -> int:
    """Plan, in each round, the waiting robot with the cheapest plan; returns how many have one, in `order`.

    `found` holds what the robots waiting found last, `UNASKED` at first. Later rounds only have more reservations. So a
    plan that still fits is found again (see `carp_optimized.neighbourhood.replanning`), and a robot without a plan
    stays without one.
    """
    state = state_at(native)
    for count in range(waiting.size):
        cheapest = NONE
        least = NEVER
        for k in range(waiting.size - count):
            robot = int(waiting[k])
            known = skip_unchanged and found[k] != UNASKED
            if known and (found[k] == NONE or still_found(state, int(found[k]))):
                state.counters[UNCHANGED] += 1
            else:
                found[k] = find_any_plan(state, robot, NONE, 0, NEVER, NEVER, ALONE if state.parks else NOTED)
            if found[k] != NONE:
                cost = cost_of(state, int(found[k]))
                if cost < least:
                    least = cost
                    cheapest = k
        if cheapest == NONE:
            return count
        order[count] = waiting[cheapest]
        plans[count] = found[cheapest]
        reserve(state, int(plans[count]))
        for k in range(cheapest, waiting.size - count - 1):
            waiting[k] = waiting[k + 1]
            found[k] = found[k + 1]
    return int(waiting.size)


@entry
def repeat_query(native: Native[State], robot: int, times: int) -> int:
    """Ask the same query that often, for the benchmark; the records are forgotten."""
    state = state_at(native)
    records, visits, expansions = int(state.records.used[0]), int(state.records.used[1]), int(state.records.used[2])
    found = NONE
    for _ in range(times):
        found = find_plan_by(state, robot, NONE, 0, NEVER, NEVER)
        state.records.used[0] = records
        state.records.used[1] = visits
        state.records.used[2] = expansions
    return found
