"""The rounds of a polish, large neighbourhood search (`polish/...`): one compiled call plays many.

A neighbourhood is planned in place: its plans are withdrawn, and those that are not kept are reserved again. An order
is cut as soon as it leaves more robots unplanned than before, or as many and its cost with the least costs of the
robots still to come is above that of the plans before: it could not be kept.

`carp_optimized.improve.annealing` lets rounds raise the total. In a polish by the rules none may: then nothing is
drawn for it. With raises, every second round takes turns: it takes out robots that cross one resource, up to 16 of
them, and plans them in the order in which they cross it, changed a little by draws. So on a tree one direction can go
before the other. Of 16 robots in a drawn order hardly any could be planned as well as before.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, Longs, Numbers
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.distances import Mean, distance_below, is_apart, is_less
from carp_optimized.neighbourhood.orders import choice, shuffle, swap
from carp_optimized.queries.search import find_plan_only
from carp_optimized.queries.windows import reserve, withdraw
from carp_optimized.state.arrays import BLOCK, MOST_MEMBERS, MOST_TURNS, NEVER, NONE, UNASKED, Polish, State
from carp_optimized.state.natives import polish_at, state_at
from carp_optimized.state.records import cost_of, first_visits

QUEUED, TURN, MARKS, CHANCE, MARKED, NOW, FORGOTTEN = range(7)  # the counts
SURE = 1 << 16  # a chance is in parts of this
REPAIR, DELAYED, CONTESTED, NEAR = range(4)
LEAST_MEMBERS = 4
SIZES = MOST_MEMBERS - LEAST_MEMBERS + 1
PIVOTS_WAY, OTHER_WAYS, DRAWN = range(3)  # the robots that go first, of four choices; else none does
NOISE = 16  # ticks by which robots may change places
AFTER = 1 << 40  # more than any tick


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
def mark_spans(state: State, polish: Polish, record: int) -> None:
    """Mark the resources that the plan visits, and those that a move leads to from there, with their spans."""
    polish.counts[MARKS] += 1
    polish.counts[MARKED] = 0
    records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        mark_span(polish, resource, enter, leave)
        for edge in range(int(state.graph.first[resource]), int(state.graph.first[resource + 1])):
            mark_span(polish, int(state.graph.target[edge]), enter, leave)


@compiled
def mark_span(polish: Polish, resource: int, enter: int, leave: int) -> None:
    """Make the span of the resource include the stay."""
    if polish.mark[resource] == polish.counts[MARKS]:
        polish.first[resource] = min(int(polish.first[resource]), enter)
        polish.last[resource] = max(int(polish.last[resource]), leave)
    else:
        polish.mark[resource] = polish.counts[MARKS]
        polish.first[resource] = enter
        polish.last[resource] = leave
        polish.marked[polish.counts[MARKED]] = resource
        polish.counts[MARKED] += 1


@compiled
def note_robots_in_spans(state: State, polish: Polish) -> bool:
    """Note as 1 in `others` the robots with a stay that meets a span, 0 for the others; whether windows tell robots.

    Those of a capacity above 1 do not. The windows hold all plans, and a stay is between two of them.
    """
    windows = state.windows
    if state.stays.start.size > BLOCK:
        return False
    for robot in range(polish.others.size):
        polish.others[robot] = 0
    for k in range(int(polish.counts[MARKED])):
        resource = int(polish.marked[k])
        slot = int(windows.offset[resource])
        last = slot + int(windows.size[resource]) - 1
        # a stay begins as the window before it ends, and ends as the window behind it begins, but for the gaps
        while slot < last and int(windows.start[slot + 1]) - state.gap < polish.first[resource]:
            slot += 1
        while slot < last and int(windows.end[slot]) + state.gap <= polish.last[resource]:
            polish.others[windows.robot[slot]] = 1
            slot += 1
    return True


@compiled
def meets_span(state: State, polish: Polish, record: int) -> bool:
    """Whether a stay of the plan meets the span of its resource."""
    records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        if polish.mark[resource] == polish.counts[MARKS]:
            leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
            if polish.first[resource] <= leave and records.enter[k] <= polish.last[resource]:
                return True
    return False


@compiled
def choose_visit(state: State, polish: Polish, pivot: int) -> int:
    """Choose a visit of the pivot's plan (`polish/contested`)."""
    own = int(polish.plans[pivot])
    return int(state.records.visits_at[own]) + choice(polish.stream, int(state.records.visits[own]))


@compiled
def crossing(state: State, record: int, chosen: int) -> int:
    """The plan's visit to the resource of the chosen visit that begins the fewest ticks apart from it; else `NONE`."""
    records = state.records
    nearest = NONE
    least = NEVER
    first = int(records.visits_at[record])
    for visit in range(first, first + int(records.visits[record])):
        apart = abs(int(records.enter[visit]) - int(records.enter[chosen]))
        if records.resource[visit] == records.resource[chosen] and apart < least:
            nearest = visit
            least = apart
    return nearest


@compiled
def rank_crossing(state: State, polish: Polish, pivot: int, chosen: int, most: int) -> int:
    """Rank the robots that visit the resource of the chosen visit (`polish/contested`); how many there are.

    With the pivot they are at most as many as given.
    """
    records = state.records
    resource = int(records.resource[chosen])
    polish.counts[MARKS] += 1
    polish.counts[MARKED] = 0
    mark_span(polish, resource, 0, NEVER)
    is_told = note_robots_in_spans(state, polish)
    count = 0
    for robot in range(polish.plans.size):
        record = int(polish.plans[robot])
        if robot == pivot or record == NONE or (is_told and polish.others[robot] == 0):
            continue
        visit = crossing(state, record, chosen)
        if visit != NONE:
            apart = abs(int(records.enter[visit]) - int(records.enter[chosen]))
            count = insert(polish, count, robot, Mean(apart, 0, 1), most)
    return count


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
def draw_turns(state: State, polish: Polish, size: int, chosen: int) -> None:
    """Order the members by their crossings: those of one direction first, or a drawn half, or with drawn delays."""
    own = way_after(state, int(polish.plans[polish.members[0]]), chosen)
    leaders = choice(polish.stream, 4)
    noise = 1 + choice(polish.stream, 2) * (NOISE - 1)
    for k in range(size):
        record = int(polish.plans[polish.members[k]])
        visit = crossing(state, record, chosen)
        enter = int(state.records.enter[visit])
        is_own = way_after(state, record, visit) == own
        put_in_turn(polish.stream, polish.members, polish.whole, k, enter, is_own, leaders, noise)


@compiled
def put_in_turn(
    stream: Numbers, members: Ints, keys: Longs, k: int, tick: int, is_own: bool, leaders: int, noise: int
) -> None:
    """Put member k, which crosses at the tick, among those before it: those that lead first, each with a drawn delay.

    Its way is the pivot's own, or not.
    """
    robot = int(members[k])
    key = tick + choice(stream, noise)
    if (
        (leaders == PIVOTS_WAY and not is_own)
        or (leaders == OTHER_WAYS and is_own)
        or (leaders == DRAWN and choice(stream, 2) == 0)
    ):
        key += AFTER
    place = k
    while place > 0 and keys[place - 1] > key:
        keys[place] = keys[place - 1]
        members[place] = members[place - 1]
        place -= 1
    keys[place] = key
    members[place] = robot


@compiled
def way_after(state: State, record: int, visit: int) -> int:
    """The resource that the plan goes to after the visit; `NONE` after its last."""
    records = state.records
    last = int(records.visits_at[record]) + int(records.visits[record]) - 1
    return int(records.resource[visit + 1]) if visit < last else NONE


@compiled
def rank_near(state: State, polish: Polish, pivot: int) -> int:
    """Rank the robots by their distance from the pivot (`polish/near`); how many there are.

    Only those that can become members are ranked.
    """
    count = 0
    for robot in range(polish.plans.size):
        record = int(polish.plans[robot])
        if robot == pivot or record == NONE:
            continue
        farthest = Mean(1 << (31 + state.split), 0, 1)  # more than any term
        if count == MOST_MEMBERS - 1:
            farthest = Mean(int(polish.whole[count - 1]), int(polish.rest[count - 1]), int(polish.ticks[count - 1]))
        if is_apart(state, record, int(polish.plans[pivot]), farthest.whole):
            continue
        mean = distance_below(state, record, int(polish.plans[pivot]), farthest)
        if is_less(mean, farthest):
            count = insert(polish, count, robot, mean, MOST_MEMBERS)
    return count


@compiled
def insert(polish: Polish, count: int, robot: int, rank: Mean, most: int) -> int:
    """Insert a candidate behind those of its rank or less; with the pivot, as many as given are kept."""
    place = count
    while place > 0:
        before = Mean(int(polish.whole[place - 1]), int(polish.rest[place - 1]), int(polish.ticks[place - 1]))
        if not is_less(rank, before):
            break
        place -= 1
    count = min(count + 1, most - 1)
    for k in range(count - 1, place, -1):
        polish.candidates[k] = polish.candidates[k - 1]
        polish.whole[k] = polish.whole[k - 1]
        polish.rest[k] = polish.rest[k - 1]
        polish.ticks[k] = polish.ticks[k - 1]
    if place < count:
        polish.candidates[place] = robot
        polish.whole[place] = rank.whole
        polish.rest[place] = rank.rest
        polish.ticks[place] = rank.ticks
    return count


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
def draw_raise(stream: Numbers, chance: int) -> int:
    """Draw by how much a round may raise the total: each further tick by the chance, which is below `SURE`."""
    ticks = 0
    while chance > 0 and choice(stream, SURE) < chance:
        ticks += 1
    return ticks


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
