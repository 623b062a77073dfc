"""The rounds of a polish, large neighbourhood search (`polish/...`): one compiled call plays many.

A neighbourhood is planned in place: its plans are withdrawn, and those that are not kept are reserved again. An order
is cut as soon as it leaves more robots unplanned than before, or as many and its cost with the least costs of the
robots still to come is above that of the plans before: it could not be kept.

`carp_optimized.improve.annealing` lets rounds raise the total. In a polish by the rules none may: then nothing is
drawn for it. With raises, every second round takes turns (`carp_optimized.neighbourhood.turns`).
"""

from carp_optimized.draws import choice, draw_raise, shuffle, swap
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.candidates import (
    mark_spans,
    meets_span,
    note_robots_in_spans,
    rank_crossing,
    rank_near,
)
from carp_optimized.neighbourhood.turns import draw_turns
from carp_optimized.queries.search import find_plan_only
from carp_optimized.state.arrays import (
    CHANCE,
    MOST_MEMBERS,
    MOST_TURNS,
    NEVER,
    NONE,
    NOW,
    QUEUED,
    TURN,
    UNASKED,
    Polish,
    State,
)
from carp_optimized.state.natives import polish_at, state_at
from carp_optimized.state.records import cost_of, first_visits
from carp_optimized.windows.reserving import reserve, withdraw

REPAIR, DELAYED, CONTESTED, NEAR = range(4)
LEAST_MEMBERS = 4
SIZES = MOST_MEMBERS - LEAST_MEMBERS + 1


@entry
def play_rounds(native: Native[State], native_polish: Native[Polish], native_empty: Native[State], rounds: int) -> int:
    """Play that many rounds; returns how many were played before nothing was left to do."""
    state = state_at(native)
    polish = polish_at(native_polish)
    empty = state_at(native_empty)
    for turn in range(rounds):
        if not play_round(state, polish, empty):
            return turn
        polish.counts[TURN] += 1
    return rounds


@compiled
def play_round(state: State, polish: Polish, empty: State) -> bool:
    """Take out a neighbourhood, replan it and keep new plans that are not worse; `False` if there is nothing to do."""
    waiting = 0
    delay = 0
    planned = 0
    for robot in range(polish.plans.size):
        waiting += weight(state, polish, REPAIR, robot)
        delay += weight(state, polish, DELAYED, robot)
        planned += weight(state, polish, CONTESTED, robot)
    if waiting > 0 and (delay == 0 or polish.counts[TURN] % 2 == 0):
        kind = REPAIR
        pivot = pivot_of(state, polish, kind, waiting)
    elif delay == 0:
        return False
    elif polish.counts[CHANCE] > 0 and choice(polish.stream, 2) == 0:
        take_turns(state, polish, pivot_of(state, polish, CONTESTED, planned))
        return True
    else:
        number = choice(polish.stream, 10)
        kind = max(DELAYED, number - 6)
        pivot = pivot_of(state, polish, kind, delay if kind == DELAYED else planned)
    if kind == CONTESTED:
        candidates = rank_crossing(state, polish, pivot, choose_visit(state, polish, pivot), MOST_MEMBERS)
    elif kind == NEAR:
        candidates = rank_near(state, polish, pivot)
    else:
        candidates = draw_in_way(state, polish, empty, kind, pivot)
    size = choose_members(polish, pivot, candidates)
    is_first = kind == REPAIR or choice(polish.stream, 2) == 0
    shuffle(polish.stream, polish.members, 1 if is_first else 0, size)  # `polish/order`
    replan_members(state, polish, size)
    return True


@compiled
def weight(state: State, polish: Polish, kind: int, robot: int) -> int:
    """The weight of a robot in the choice of the pivot (`polish/pivot`)."""
    if polish.alone[robot] == NONE:
        return 0
    record = int(polish.plans[robot])
    if kind == REPAIR:
        return 1 if record == NONE else 0
    if record == NONE:
        return 0
    return cost_of(state, record) - int(polish.least[robot]) if kind == DELAYED else 1


@compiled
def pivot_of(state: State, polish: Polish, kind: int, weights: int) -> int:
    """Choose the pivot; the weights sum up to `weights`."""
    left = choice(polish.stream, weights)
    robot = 0
    while True:
        left -= weight(state, polish, kind, robot)
        if left < 0:
            return robot
        robot += 1


@compiled
def draw_in_way(state: State, polish: Polish, empty: State, kind: int, pivot: int) -> int:
    """Draw all robots in the way of the pivot's plan, or of its plan alone (`polish/way`); how many there are."""
    if kind == DELAYED and choice(polish.stream, 2) == 1:
        mark_spans(state, polish, int(polish.plans[pivot]))
    else:
        mark_spans(state, polish, plan_alone(polish, empty, pivot))
    count = 0
    is_told = note_robots_in_spans(state, polish)
    for robot in range(polish.plans.size):
        if robot == pivot or polish.plans[robot] == NONE or (is_told and polish.others[robot] == 0):
            continue
        if is_told or meets_span(state, polish, int(polish.plans[robot])):
            polish.candidates[count] = robot
            count += 1
    for k in range(count):
        swap(polish.candidates, k, k + choice(polish.stream, count - k))
    return count


@compiled
def plan_alone(polish: Polish, empty: State, robot: int) -> int:
    """The record of the plan that the robot has alone, made when it is first asked for: few are, in few rounds.

    It goes on from what the robot had done by now as the polish began. A plan made since may begin with a move at this
    very tick, which a robot that follows it would have done.
    """
    if polish.alone[robot] == UNASKED:
        now = int(polish.counts[NOW])
        followed = NONE
        if now > 0:
            followed = first_visits(empty, int(polish.plans[robot]), int(polish.past[robot]))
        polish.alone[robot] = find_plan_only(empty, robot, followed, now, NEVER)
    return int(polish.alone[robot])


@compiled
def choose_visit(state: State, polish: Polish, pivot: int) -> int:
    """Choose a visit of the pivot's plan (`polish/contested`)."""
    own = int(polish.plans[pivot])
    return int(state.records.visits_at[own]) + choice(polish.stream, int(state.records.visits[own]))


@compiled
def take_turns(state: State, polish: Polish, pivot: int) -> None:
    """Replan robots that cross a resource of the pivot's plan, in an order like that of their crossings."""
    chosen = choose_visit(state, polish, pivot)
    candidates = rank_crossing(state, polish, pivot, chosen, MOST_TURNS)
    size = min(LEAST_MEMBERS + choice(polish.stream, MOST_TURNS - LEAST_MEMBERS + 1), candidates + 1)
    polish.members[0] = pivot
    for k in range(1, size):
        polish.members[k] = polish.candidates[k - 1]
    draw_turns(state, polish, size, chosen)
    replan_members(state, polish, size)


@compiled
def choose_members(polish: Polish, pivot: int, candidates: int) -> int:
    """Choose how many members there are, and which (`polish/members`)."""
    size = min(LEAST_MEMBERS + choice(polish.stream, SIZES), polish.has_path)
    polish.members[0] = pivot
    count = 1
    while count < size and count <= candidates:
        polish.members[count] = polish.candidates[count - 1]
        count += 1
    if count == size:
        return size
    others = 0
    for robot in range(polish.plans.size):
        if polish.alone[robot] != NONE and not is_among(polish, count, robot):
            polish.others[others] = robot
            others += 1
    for k in range(size - count):
        other = k + choice(polish.stream, others - k)
        robot = int(polish.others[other])
        polish.others[other] = polish.others[k]
        polish.members[count + k] = robot
    return size


@compiled
def is_among(polish: Polish, count: int, robot: int) -> bool:
    """Whether the robot is one of the first members."""
    for k in range(count):  # noqa: SIM110 - no generators in compiled code
        if polish.members[k] == robot:
            return True
    return False


@compiled
def replan_members(state: State, polish: Polish, size: int) -> None:
    """Plan the members in their order, and keep their new plans or go back to those before (`polish/kept`)."""
    records = state.records
    used = int(records.used[0])
    used_visits = int(records.used[1])
    used_expansions = int(records.used[2])
    missing = 0
    limit = 0
    for k in range(size):
        record = int(polish.plans[polish.members[k]])
        polish.before[k] = record
        if record == NONE:
            missing += 1
        else:
            limit += cost_of(state, record)
            withdraw(state, record)
    planned = plan_members(state, polish, size, missing, limit + draw_raise(polish.stream, int(polish.counts[CHANCE])))
    if planned == size:
        keep_members(polish, size)
        return
    for k in range(planned):
        if polish.chosen[k] != NONE:
            withdraw(state, int(polish.chosen[k]))
    for k in range(size):
        if polish.before[k] != NONE:
            reserve(state, int(polish.before[k]))
    records.used[0] = used
    records.used[1] = used_visits
    records.used[2] = used_expansions


@compiled
def plan_members(state: State, polish: Polish, size: int, missing: int, limit: int) -> int:
    """Plan and reserve the members in their order; returns how many, `size` if their plans are to be kept.

    They are kept if fewer than `missing` are unplanned, or equally many and the cost is not above the limit. A member
    that must be planned is not planned if its plan would exceed the rest of the limit.
    """
    rest = 0
    for k in range(size):
        rest += int(polish.least[polish.members[k]])
    unplanned = 0
    cost = 0
    now = int(polish.counts[NOW])
    for k in range(size):
        robot = int(polish.members[k])
        rest -= int(polish.least[robot])
        latest = NEVER if unplanned < missing else int(state.robots.release[robot]) + limit - cost - rest
        followed = int(polish.before[k]) if now > 0 else NONE
        record = find_plan_only(state, robot, followed, now, latest)
        polish.chosen[k] = record
        if record == NONE:
            unplanned += 1
        else:
            cost += cost_of(state, record)
        if unplanned > missing or (unplanned == missing and cost + rest > limit):
            return k
        if record != NONE:
            reserve(state, record)
    return size


@compiled
def keep_members(polish: Polish, size: int) -> None:
    """Make the new plans of the members theirs, and put them behind the robots outside."""
    count = 0
    for k in range(int(polish.counts[QUEUED])):
        robot = int(polish.queue[k])
        if not is_among(polish, size, robot):
            polish.queue[count] = robot
            count += 1
    for k in range(size):
        robot = int(polish.members[k])
        polish.plans[robot] = polish.chosen[k]
        if polish.chosen[k] != NONE:
            polish.queue[count] = robot
            count += 1
    polish.counts[QUEUED] = count
