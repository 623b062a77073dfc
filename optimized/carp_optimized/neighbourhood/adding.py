"""The neighbourhood planner, the paper's Algorithm 1: one compiled call adds a robot."""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.distances import follow, nearest
from carp_optimized.neighbourhood.order_search import hold_members, search_orders
from carp_optimized.neighbourhood.orders import draw_orders
from carp_optimized.neighbourhood.replanning import (
    alike_at_end,
    alike_at_start,
    could_use_freed,
    forget_freed,
    note_freed,
    replan,
)
from carp_optimized.queries.over_stops import shortest_of
from carp_optimized.queries.search import find_plan_alone, find_plan_by
from carp_optimized.state.arrays import (
    LARGEST,
    NEVER,
    NO_LIMIT,
    NONE,
    UNCHANGED,
    UNKNOWN,
    Adding,
    Answers,
    Options,
    State,
    Work,
)
from carp_optimized.state.natives import adding_at
from carp_optimized.state.records import cost_of, same_plan
from carp_optimized.windows.fitting import has_same_order, plan_fits, still_found
from carp_optimized.windows.reserving import give_rank, reserve_but, withdraw, withdraw_but


@entry
def add_robot(  # noqa: C901 - Algorithm 1 from its first line to its last
    native: Native[Adding], before: Ints, robot: int, followed: int, now: int, after: Ints
) -> bool:
    """Add a robot to those `before` it in planning order; returns whether it got a plan.

    One that is to be planned again has `followed` a plan until now, whose record that is; others have `NONE`.

    If so, `after` becomes the planning order with the robot. The windows hold the plans before and afterwards.
    """
    adding = adding_at(native)
    state = adding.state
    empty = adding.empty
    work = adding.work
    answers = adding.answers
    options = adding.options
    size = before.size
    robots = size + 1
    shortest = find_plan_alone(empty, robot, followed, now)
    if shortest == NONE:
        return False
    rounds = min(begin(state, work, before, robot, shortest, now), options.m - 1)
    work.before[robot] = followed
    best = NO_LIMIT
    if options.baseline or rounds == 0:
        best = try_baseline(state, work, size, shortest, now, options.unchanged)
    with_plan = size
    for turn in range(1, rounds + 1):
        taken = nearest(state, work, size, turn)
        if taken == NONE:
            break
        take_out(state, work, taken, size, turn)
        size -= 1
        with_plan = replan(state, work, size, min(taken, with_plan), now, options)
        cost_outside = follow_plans(state, work, with_plan)
        if with_plan < size:
            for member in range(turn + 1):
                work.alone[member] = NONE
            continue
        limit = best - cost_outside if turn == rounds else NO_LIMIT
        cost = plan_members(state, work, answers, turn + 1, limit, now, options)
        if cost == NONE:
            continue
        for k in range(turn + 1):
            follow(state, work, int(work.found_order[k]), int(work.found_plans[k]))
        if cost_outside + cost < best:
            best = cost_outside + cost
            keep_candidate(work, size, turn + 1)
    if best == NO_LIMIT:
        work.before[robot] = NONE
        for k in range(robots):
            work.best_plans[k] = work.before[work.queue[k]]
        settle(state, work, work.queue, work.best_plans, robots)
        return False
    settle(state, work, work.best_order, work.best_plans, robots)
    for k in range(robots):
        after[k] = work.best_order[k]
    return True


@compiled
def begin(state: State, work: Work, queue: Ints, new: int, shortest: int, now: int) -> int:
    """Begin with all robots but the new one outside the neighbourhood; returns how many have not ended by now."""
    size = queue.size
    for k in range(size):
        work.queue[k] = queue[k]
    work.queue[size] = new
    give_ranks(state, work.queue, size + 1)
    under_way = 0
    work.before[new] = NONE
    work.trajectories[new] = NONE
    follow(state, work, new, shortest)
    work.members[0] = new
    work.alone[0] = NONE
    for k in range(size):
        robot = int(work.queue[k])
        record = int(state.reserved[robot])
        work.outside[k] = robot
        work.before[robot] = record
        work.held[robot] = record
        work.trajectories[robot] = NONE
        follow(state, work, robot, record)
        work.ended[robot] = state.records.leave[record] <= now
        if not work.ended[robot]:
            under_way += 1
    return under_way


@compiled
def give_ranks(state: State, robots: Ints, count: int) -> None:
    """Make ranks grow in the order of the robots; those that stay in order keep theirs."""
    before = NONE
    for k in range(count):
        robot = int(robots[k])
        if state.rank[robot] <= before or state.rank[robot] > LARGEST:
            give_rank(state, robot, before + 1)
        before = int(state.rank[robot])


@compiled
def try_baseline(state: State, work: Work, size: int, shortest: int, now: int, skip_unchanged: bool) -> int:
    """Make the plans unchanged, and one for the new robot, the best candidate; its cost.

    If they leave room for its plan on the empty graph, that is found again (`carp_optimized.neighbourhood.replanning`).
    """
    new = int(work.queue[size])
    if skip_unchanged and still_found(state, shortest):
        state.counters[UNCHANGED] += 1
        plan = shortest
    else:
        plan = find_plan_by(state, new, int(work.before[new]), now, NEVER, NEVER)
    work.alone[0] = plan
    if plan == NONE:
        return NO_LIMIT
    cost = cost_of(state, plan)
    for k in range(size):
        work.best_order[k] = work.queue[k]
        work.best_plans[k] = work.before[work.queue[k]]
        cost += cost_of(state, int(work.best_plans[k]))
    work.best_order[size] = new
    work.best_plans[size] = plan
    return cost


@compiled
def take_out(state: State, work: Work, taken: int, size: int, turn: int) -> None:
    """Move the robot at that position from outside the neighbourhood to its end."""
    robot = int(work.outside[taken])
    for k in range(taken, size - 1):
        work.outside[k] = work.outside[k + 1]
    work.members[turn] = robot
    work.alone[turn] = work.held[robot]
    forget_freed(state.freed)
    if work.held[robot] != NONE:
        withdraw(state, int(work.held[robot]))
        note_freed(state, int(work.held[robot]), 0, 0)


@compiled
def follow_plans(state: State, work: Work, count: int) -> int:
    """Make the plans of the first robots outside their trajectories; the sum of their costs."""
    cost = 0
    for k in range(count):
        robot = int(work.outside[k])
        follow(state, work, robot, int(work.held[robot]))
        cost += cost_of(state, int(work.held[robot]))
    return cost


@compiled
def plan_members(
    state: State,
    work: Work,
    answers: Answers,
    count: int,
    limit: int,
    now: int,
    options: Options,
) -> int:
    """The cost of the members' best order below the limit, or `NONE`.

    Orders are drawn even if no member can be planned: the next round draws from the same stream. With a limit there is
    no next round, and plans of members may stay reserved until `settle`.
    """
    possible = True
    if options.shared or options.bounds:
        possible = plan_alone(state, work, count, limit if options.bounds else NO_LIMIT, now, options.unchanged)
    if not possible and limit < NO_LIMIT:
        return NONE
    rows = draw_orders(work, count, options.sample, work.stream)
    if not possible:
        return NONE
    cost = search_orders(state, work, answers, count, rows, limit, now, options)
    if limit == NO_LIMIT:
        hold_members(state, work, 0, count)
    return cost


@compiled
def plan_alone(state: State, work: Work, count: int, limit: int, now: int, skip_unchanged: bool) -> bool:
    """Update the members' plans against the robots outside alone; returns whether all have one and cost less together.

    A robot not asked for yet costs at least its shortest path. So the rest need not be asked once that is too much, and
    a query is asked for a plan that does not make it too much. The plans that stand are counted first.
    """
    least = 0
    for member in range(count):
        latest = latest_alone(state, work, member, member == count - 1, skip_unchanged)
        work.chosen[member] = latest
        is_known = latest == NONE
        least += cost_of(state, int(work.alone[member])) if is_known else shortest_of(state, int(work.members[member]))
    for member in range(count):
        if least >= limit:
            return False
        if work.chosen[member] == NONE:
            state.counters[UNCHANGED] += 1
            continue
        robot = int(work.members[member])
        shortest = shortest_of(state, robot)
        latest = min(int(work.chosen[member]), int(state.robots.release[robot]) + shortest + limit - least - 1)
        work.alone[member] = find_plan_by(state, robot, int(work.before[robot]), now, NEVER, latest)
        if work.alone[member] == NONE:
            for k in range(count):
                work.alone[k] = NONE
            return False
        least += cost_of(state, int(work.alone[member])) - shortest
    return least < limit


@compiled
def latest_alone(state: State, work: Work, member: int, is_last: bool, skip_unchanged: bool) -> int:
    """By when the member's plan against the robots outside alone arrives; `NONE` if the plan that it has stands.

    A plan that still fits can be found again, so none that arrives later is.
    The member taken in last comes with its plan among the robots outside. It saw those before it, and none of them has
    changed in this round, so what was taken back does not touch it; those behind it were added since.
    """
    record = int(work.alone[member])
    if record == NONE or not plan_fits(state, record):
        return NEVER
    is_known = skip_unchanged and state.records.expansions[record] != UNKNOWN
    if is_known and ((is_last and has_same_order(state, record, NEVER)) or not could_use_freed(state, record, NEVER)):
        return NONE
    return int(state.records.arrival[record])


@compiled
def keep_candidate(work: Work, size: int, count: int) -> None:
    """Make the robots outside with their plans, and the round's best order, the best candidate."""
    for k in range(size):
        work.best_order[k] = work.outside[k]
        work.best_plans[k] = work.held[work.outside[k]]
    for k in range(count):
        work.best_order[size + k] = work.found_order[k]
        work.best_plans[size + k] = work.found_plans[k]


@compiled
def settle(state: State, work: Work, robots: Ints, plans: Ints, count: int) -> None:
    """Make the windows hold just these plans of these robots.

    Stays that a robot's plan before has too, at its beginning or end, stay reserved; ranks grow first, so theirs are
    right.
    """
    give_ranks(state, robots, count)
    for k in range(count):
        robot = int(robots[k])
        held = int(state.reserved[robot])
        work.held[robot] = NONE
        if held == NONE or held == plans[k]:
            continue
        if plans[k] == NONE:
            withdraw(state, held)
        elif same_plan(state.records, held, int(plans[k])):
            state.reserved[robot] = plans[k]
        else:
            work.held[robot] = held
            head = alike_at_start(state, held, int(plans[k]))
            withdraw_but(state, held, head, alike_at_end(state, held, int(plans[k])))
    for k in range(count):
        robot = int(robots[k])
        plan = int(plans[k])
        if plan != NONE and state.reserved[robot] == NONE:
            held = int(work.held[robot])
            head = alike_at_start(state, held, plan) if held != NONE else 0
            reserve_but(state, plan, head, alike_at_end(state, held, plan) if held != NONE else 0)
