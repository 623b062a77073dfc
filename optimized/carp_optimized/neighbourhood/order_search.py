"""Planning a neighbourhood in all its orders, asking no query whose answer is known or cannot matter.

Three kinds of reuse; each leaves the best order and its plans as they are:

- Prefixes. An order that begins like the one before keeps the plans of that beginning, which do not depend on the rest.
- Shared answers. A query of a robot against `given` plans is answered by one asked against fewer of them, if the plan
  found then clashes with none of the others: stays that leave room for it do not change it (see
  `carp_optimized.neighbourhood.replanning`). No plan against fewer is no plan against more. So two prefixes with the
  same plans share their answers, too. An answer remembers only those of the given plans on which it depends
  (`carp_optimized.queries.relevant_plans`), so that it holds for more prefixes. On a single one it always depends: a
  query is asked only where that clashes with the plan found alone. An answer keeps the record of its own query, even
  if another query has found the same plan: the readings of the other do not count, because it may have been asked
  against different plans.
- Bounds. The cost of a robot is at least that against the robots outside alone, or against some of the plans of the
  prefix: more plans leave fewer ways. If the cost of a prefix and the least costs of the robots still to come are not
  below the limit, no order with that prefix is strictly better. All known answers are looked at only before a query
  would be asked. A query is asked for a plan cheap enough to stay below the limit, because with any other plan the
  prefix is cut at once. If no such plan exists, that gives a least cost of the robot.
"""

from carp_optimized.jit.compiling import compiled
from carp_optimized.neighbourhood.answers import known_answer, learn, least_of, number_plan, start_answers
from carp_optimized.neighbourhood.orders import next_permutation, next_row, queries_after, queries_of_rows, take_row
from carp_optimized.queries.relevant_plans import reasons
from carp_optimized.queries.search import find_plan_by
from carp_optimized.state.arrays import (
    BOUND,
    LARGEST,
    LATE,
    NEVER,
    NO_LIMIT,
    NONE,
    PREFIX,
    SHARED,
    UNKNOWN,
    Answers,
    Options,
    State,
    Work,
)
from carp_optimized.state.records import cost_of
from carp_optimized.windows.reserving import reserve, withdraw


@compiled
def search_orders(
    state: State, work: Work, answers: Answers, count: int, rows: int, limit: int, now: int, options: Options
) -> int:
    """The cost of the cheapest order below the limit, the first of such, or `NONE`; it is put into `found_order`.

    `rows` is the number of orders drawn, 0 for all. The members' plans `alone` are there if `shared` or `bounds` is on.
    Afterwards some members' plans may be reserved.
    """
    rest = start_search(state, work, answers, count, options)
    if rows == 0:
        for place in range(count):
            work.order[place] = place
    else:
        take_row(work, 0, count)
    found = NONE
    place = 0
    row = 0
    while True:
        state.counters[PREFIX] += place
        cut = int(state.counters[BOUND])
        shared = plan_order(state, work, answers, count, place, limit, rest, now, options)
        if shared > count:
            limit = int(work.cost[count])
            found = limit
            for k in range(count):
                work.found_order[k] = work.members[work.order[k]]
                work.found_plans[k] = work.chosen[k]
        shared = min(shared, count) if options.prefixes else count
        is_cut = state.counters[BOUND] > cut
        if rows == 0:
            state.counters[BOUND] += queries_after(work.order, shared if is_cut else count, count)
            place = next_permutation(work.order, count, shared)
        else:
            before = row
            row = next_row(work, row + 1, rows, shared)
            state.counters[BOUND] += queries_of_rows(work, before if is_cut else row, row, count)
            place = take_row(work, row, count) if row < rows else NONE
        if place == NONE:
            break
        if not options.prefixes:
            place = 0
    return found


@compiled
def start_search(state: State, work: Work, answers: Answers, count: int, options: Options) -> int:
    """Begin a round with what is known of the members alone; the sum of their least costs."""
    start_answers(answers, count)
    work.cost[0] = 0
    work.given[0] = 0
    total = 0
    for member in range(count):
        work.least[member] = 0
        if options.shared or options.bounds:
            work.least[member] = cost_of(state, int(work.alone[member]))
            total += int(work.least[member])
        if options.shared:
            record = int(work.alone[member])
            learn(answers, member, 0, number_plan(state, answers, member, record), record, int(work.least[member]))
    return total


@compiled
def plan_order(
    state: State,
    work: Work,
    answers: Answers,
    count: int,
    place: int,
    limit: int,
    total_least: int,
    now: int,
    options: Options,
) -> int:
    """Plan the order from the place on; returns in how many first places the next must differ, count + 1 if better.

    `total_least` is the sum of the least costs of all members.
    """
    rest = total_least
    for k in range(place):
        rest -= int(work.least[work.order[k]])
    while place < count:
        if options.bounds and work.cost[place] + rest >= limit:
            state.counters[BOUND] += count - place
            return place
        member = int(work.order[place])
        rest -= int(work.least[member])
        answer = known_answer(state, answers, member, int(work.given[place])) if options.shared else NONE
        spare = NO_LIMIT
        if answer == NONE and options.bounds and limit < NO_LIMIT:
            spare = limit - int(work.cost[place]) - rest
            if options.shared:
                least = least_of(answers, member, int(work.given[place]))
                spare = spare_for(work, answers, place, count, spare, least)
                if spare <= least:
                    state.counters[BOUND] += count - place
                    return place
        record = plan_member(state, work, answers, place, count, answer, spare, now, options.shared)
        if record == NONE:
            if spare < NO_LIMIT:
                state.counters[BOUND] += count - place - 1
            return place + 1
        work.chosen[place] = record
        work.cost[place + 1] = work.cost[place] + cost_of(state, record)
        place += 1
    return count + 1 if work.cost[count] < limit else count


@compiled
def spare_for(work: Work, answers: Answers, place: int, count: int, spare: int, least: int) -> int:
    """The cost that a plan for that place must stay below, by all answers known of the members behind it.

    `spare` is that by their plans alone. It only shrinks, so nobody else is looked at once it is no more than `least`.
    """
    for k in range(place + 1, count):
        if spare <= least:
            break
        member = int(work.order[k])
        spare -= least_of(answers, member, int(work.given[place])) - int(work.least[member])
    return spare


@compiled
def plan_member(
    state: State, work: Work, answers: Answers, place: int, count: int, answer: int, spare: int, now: int, shared: bool
) -> int:
    """The record of the plan of the member in that place of the order against those before it, or `NONE`.

    `answer` is the known answer, or `NONE`. A plan that is asked for must cost less than `spare`.
    """
    member = int(work.order[place])
    given = int(work.given[place])
    plan = NONE
    if answer != NONE:
        state.counters[SHARED] += 1
        plan = int(answers.plan[answer])
        record = int(answers.found[answer])
    else:
        hold_members(state, work, place, count)
        robot = int(work.members[member])
        latest = min(spare - 1 + int(state.robots.release[robot]), NEVER)
        state.search.expansions[0] = UNKNOWN
        record = find_plan_by(state, robot, int(work.before[robot]), now, NEVER, latest)
        if shared and place > 1 and state.search.expansions[0] != UNKNOWN:
            given = reasons(state, answers, robot, record, latest, given)
        if shared and record != NONE:
            plan = number_plan(state, answers, member, record)
            learn(answers, member, given, plan, record, cost_of(state, record))
        elif shared and latest > LARGEST:
            learn(answers, member, given, NONE, NONE, NO_LIMIT)
        elif shared:
            learn(answers, member, given, LATE, NONE, spare)
    work.given[place + 1] = work.given[place] if plan == NONE else int(work.given[place]) | (1 << plan)
    return record


@compiled
def hold_members(state: State, work: Work, place: int, count: int) -> None:
    """Have the plans before that place of the order reserved, and no other member's; only a query needs it."""
    for k in range(count):
        held = int(state.reserved[work.members[work.order[k]]])
        if held != NONE and (k >= place or held != work.chosen[k]):
            withdraw(state, held)
    for k in range(place):
        if state.reserved[work.members[work.order[k]]] == NONE:
            reserve(state, int(work.chosen[k]))
