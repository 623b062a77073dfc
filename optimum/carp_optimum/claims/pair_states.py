"""The search for places that two robots cannot both be in at a tick, compiled.

It follows, from tick to tick, all pairs of states that the two can reach together, each with a delay up to a largest
one. The robots' recent ways show how often each was in which place at a tick. Places of the one and places of the other
are a *claim* if no two of them can be taken together. Its weight is how often the robots were in them; ways break a
claim that weighs more than their number. The heaviest claim is what a maximum flow leaves over, between places that can
be taken together (König's theorem).

A state of a robot is a spot and the ticks that it still has to stay there. Its spots are resources that it can pass
with its delay, then its goal at the end, and two in which it is nowhere: after that, and before its release.
"""

from typing import NamedTuple

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, IntTable, Longs
from carp_optimized.jit.references import Native, dereference
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.state import Market, duration_of, market_at

UNREACHED = -2


class Side(NamedTuple):
    """One of the two robots, `robot`, with the largest delay that is looked at, `delay`.

    `spot` is the number of each resource as a spot, or `NONE`, and `resource` the reverse; `first` has the first state
    of each spot, then the number of states. `often` is in how many ways the robot is in each spot at each tick. A state
    has a spot, `spot_of`, takes a place, and has `branches` states that follow it. At a tick that it is seen at, one of
    `sees`, the robot may only be in the spots that it has in `held`.

    At a tick, `used` are the spots in which any way is, `left` is how often that is, less the flow, and `before` is the
    spot of the other robot that a path comes from. `chosen` are the spots of the heaviest claim, and `inside` says of
    each spot whether it is one. `used` and `chosen` begin with the number of spots.
    """

    robot: Longs
    delay: Longs
    spot: Ints
    resource: Ints
    first: Ints
    often: IntTable
    spot_of: Ints
    place: Ints
    branches: Ints
    following: IntTable
    sees: Ints
    held: IntTable
    used: Ints
    left: Ints
    before: Ints
    chosen: Ints
    inside: Ints


class Meeting(NamedTuple):
    """Pairs of states at a tick and at the next, and `mark`, a number of the tick and search that reached a pair last.

    `origin` is the spot in which one of the robots was at an earlier tick, before a pair, and `blamed` are such spots.
    `together` is whether two spots can be taken together at the tick; `queue` holds spots to go on from. `found` is the
    weight of the best claim, its tick, and the last mark.
    """

    pairs: Ints
    later: Ints
    mark: Ints
    origin: Ints
    later_origin: Ints
    blamed: Ints
    together: IntTable
    flow: IntTable
    queue: Ints
    found: Longs


side_at = dereference(Side)
meeting_at = dereference(Meeting)


@compiled
def spots_of(side: Side) -> int:
    """The number of spots that are resources."""
    return side.first.size - 4


@compiled
def describe(market: Market, side: Side) -> None:
    """Fill in the spot of each state, and the resource that the robot takes there, `NONE` where it takes none."""
    spots = spots_of(side)
    for spot in range(spots + 3):
        place = NONE
        if spot < spots:
            place = int(side.resource[spot])
        elif spot == spots:
            place = int(market.requests.goal[side.robot[0]])
        for state in range(int(side.first[spot]), int(side.first[spot + 1])):
            side.spot_of[state] = spot
            side.place[state] = place


@compiled
def go_on(market: Market, side: Side, tick: int) -> None:
    """Fill in the states that follow each state at the tick."""
    spots = spots_of(side)
    for state in range(int(side.first[spots + 3])):
        spot = int(side.spot_of[state])
        side.following[state][0] = state
        side.branches[state] = 1
        if spot == spots + 2:
            if tick + 1 == market.requests.release[side.robot[0]]:
                side.following[state][0] = entered(side, int(market.requests.start[side.robot[0]]))
        elif state > side.first[spot]:
            side.following[state][0] = state - 1
        elif spot < spots:
            move_on(market, side, state, tick)
        elif not market.parks:
            side.following[state][0] = int(side.first[spots + 1])


@compiled
def entered(side: Side, resource: int) -> int:
    """The state of a robot that enters the resource."""
    return int(side.first[int(side.spot[resource]) + 1]) - 1


@compiled
def move_on(market: Market, side: Side, state: int, tick: int) -> None:
    """Fill in the states that follow one in which the robot is free to leave."""
    graph = market.graph
    robot = int(side.robot[0])
    rest = market.requests.rest[robot]
    here = int(side.place[state])
    late = tick + 1 - int(market.requests.earliest[robot])
    count = 1 if late + 1 + int(rest[here]) <= side.delay[0] else 0
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        target = int(graph.target[move])
        after = late + duration_of(market, robot, target) + int(rest[target])
        if side.spot[target] != NONE and after <= side.delay[0]:
            side.following[state][count] = entered(side, target)
            count += 1
        if target == market.requests.goal[robot] and late <= side.delay[0]:
            side.following[state][count] = int(side.first[spots_of(side) + 1]) - 1
            count += 1
    side.branches[state] = count


@entry
def find_claim(
    native: Native[Market],
    native_one: Native[Side],
    native_other: Native[Side],
    native_meeting: Native[Meeting],
    end: int,
    ways: int,
) -> int:
    """Find the heaviest claim of two robots before the tick `end`, and fill `chosen`: its weight less `ways`, or 0."""
    market = market_at(native)
    one = side_at(native_one)
    other = side_at(native_other)
    meeting = meeting_at(native_meeting)
    meeting.found[0] = 0
    size = begin(market, one, other, meeting)
    for tick in range(end):
        if tick > 0:
            weigh(one, other, meeting, size, tick, ways)
        size = step(market, one, other, meeting, size, tick)
    return int(meeting.found[0])


@entry
def find_meetings(
    native: Native[Market],
    native_one: Native[Side],
    native_other: Native[Side],
    native_meeting: Native[Meeting],
    whose: int,
    earlier: int,
) -> int:
    """Find out which spots can be taken together at the claim's tick; returns how many pairs are in spots of the claim.

    The spots in which the first robot, or with `whose` the other, was at an earlier tick before them are `blamed`.
    """
    market = market_at(native)
    one = side_at(native_one)
    other = side_at(native_other)
    meeting = meeting_at(native_meeting)
    size = begin(market, one, other, meeting)
    wide = other.place.size
    for tick in range(int(meeting.found[1])):
        if tick == earlier:
            for number in range(size):
                state = int(meeting.pairs[number]) // wide
                other_state = int(meeting.pairs[number]) - state * wide
                meeting.origin[number] = spot_at(one, state) if whose == 0 else spot_at(other, other_state)
        size = step(market, one, other, meeting, size, tick)
    relate(one, other, meeting, size)
    count = 0
    for number in range(size):
        state = int(meeting.pairs[number]) // wide
        other_state = int(meeting.pairs[number]) - state * wide
        if one.inside[spot_at(one, state)] == 1 and other.inside[spot_at(other, other_state)] == 1:
            meeting.blamed[int(meeting.origin[number])] = 1
            count += 1
    return count


@compiled
def begin(market: Market, one: Side, other: Side, meeting: Meeting) -> int:
    """Begin with the states at tick 0: one pair."""
    describe(market, one)
    describe(market, other)
    meeting.pairs[0] = start_of(market, one) * other.place.size + start_of(market, other)
    meeting.origin[0] = 0
    return 1


@compiled
def spot_at(side: Side, state: int) -> int:
    """The spot of a state; one that is after the goal has the goal's, and before its release the next one."""
    spot = int(side.spot_of[state])
    return spot if spot <= spots_of(side) else spot - 1


@compiled
def may_be(side: Side, state: int, tick: int) -> bool:
    """Whether the robot may be in the state at the tick."""
    return bool(side.sees[tick] == 0 or side.held[tick][spot_at(side, state)] == 1)


@compiled
def start_of(market: Market, side: Side) -> int:
    """The state at tick 0."""
    if market.requests.release[side.robot[0]] > 0:
        return int(side.first[spots_of(side) + 2])
    return entered(side, int(market.requests.start[side.robot[0]]))


@compiled
def step(market: Market, one: Side, other: Side, meeting: Meeting, size: int, tick: int) -> int:
    """Reach all pairs of states at the next tick: how many."""
    go_on(market, one, tick)
    go_on(market, other, tick)
    wide = other.place.size
    meeting.found[2] += 1
    mark = int(meeting.found[2])
    reached = 0
    for number in range(size):
        state = int(meeting.pairs[number]) // wide
        other_state = int(meeting.pairs[number]) - state * wide
        place = int(one.place[state])
        other_place = int(other.place[other_state])
        for first in range(int(one.branches[state])):
            after = int(one.following[state][first])
            if not may_be(one, after, tick + 1):
                continue
            target = int(one.place[after])
            for second in range(int(other.branches[other_state])):
                other_after = int(other.following[other_state][second])
                pair = after * wide + other_after
                if (
                    meeting.mark[pair] != mark
                    and may_be(other, other_after, tick + 1)
                    and can_move(market, place, target, other_place, int(other.place[other_after]))
                ):
                    meeting.mark[pair] = mark
                    meeting.later[reached] = pair
                    meeting.later_origin[reached] = meeting.origin[number]
                    reached += 1
    for number in range(reached):
        meeting.pairs[number] = int(meeting.later[number])
        meeting.origin[number] = int(meeting.later_origin[number])
    return reached


@compiled
def can_move(market: Market, place: int, target: int, other_place: int, other_target: int) -> bool:
    """Whether one robot may move, or stay, from place to target while the other does the same."""
    if target == other_target:
        return target == NONE or int(market.graph.capacity[target]) > 1
    return min(target, other_target) == NONE or target != other_place or other_target != place


@compiled
def weigh(one: Side, other: Side, meeting: Meeting, size: int, tick: int, ways: int) -> None:
    """Find the heaviest claim at the tick, and keep it if none before was as heavy."""
    in_all = use(one, tick) + use(other, tick) - ways
    if in_all <= meeting.found[0]:
        return
    relate(one, other, meeting, size)
    if is_free(one, other, meeting):
        return
    weight = in_all - most_flow(one, other, meeting)
    if weight > meeting.found[0]:
        meeting.found[0] = weight
        meeting.found[1] = tick
        choose(one, other)


@compiled
def use(side: Side, tick: int) -> int:
    """Find the spots that are used at the tick: how often in all. The number of them comes first."""
    in_all = 0
    count = 0
    for spot in range(spots_of(side) + 1):
        weight = int(side.often[tick][spot])
        if weight > 0:
            count += 1
            side.used[count] = spot
            side.left[spot] = weight
            in_all += weight
    side.used[0] = count
    return in_all


@compiled
def relate(one: Side, other: Side, meeting: Meeting, size: int) -> None:
    """Find out which spots can be taken together; a robot that has vanished has come to its goal."""
    rows = spots_of(one) + 1
    columns = spots_of(other) + 1
    for row in range(rows + 2):
        for column in range(columns + 2):
            meeting.together[row][column] = 0
    wide = other.place.size
    for number in range(size):
        state = int(meeting.pairs[number]) // wide
        row = int(one.spot_of[state])
        column = int(other.spot_of[int(meeting.pairs[number]) - state * wide])
        meeting.together[rows - 1 if row == rows else row][columns - 1 if column == columns else column] = 1


@compiled
def is_free(one: Side, other: Side, meeting: Meeting) -> bool:
    """Whether all spots that are used can be taken together."""
    for row in range(1, int(one.used[0]) + 1):
        for column in range(1, int(other.used[0]) + 1):
            if meeting.together[int(one.used[row])][int(other.used[column])] == 0:
                return False
    return True


@compiled
def most_flow(one: Side, other: Side, meeting: Meeting) -> int:
    """The largest flow between spots that can be taken together, path by path."""
    for row in range(1, int(one.used[0]) + 1):
        for column in range(1, int(other.used[0]) + 1):
            meeting.flow[int(one.used[row])][int(other.used[column])] = 0
    total = 0
    end = find_path(one, other, meeting)
    while end != NONE:
        total += push_along(one, other, meeting, end)
        end = find_path(one, other, meeting)
    return total


@compiled
def find_path(one: Side, other: Side, meeting: Meeting) -> int:
    """A spot of the other robot to which more can flow, or `NONE`."""
    size = 0
    for number in range(1, int(one.used[0]) + 1):
        row = int(one.used[number])
        one.before[row] = UNREACHED
        if one.left[row] > 0:
            one.before[row] = NONE
            meeting.queue[size] = row
            size += 1
    for number in range(1, int(other.used[0]) + 1):
        other.before[int(other.used[number])] = UNREACHED
    place = 0
    while place < size:
        row = int(meeting.queue[place])
        place += 1
        for number in range(1, int(other.used[0]) + 1):
            column = int(other.used[number])
            if other.before[column] == UNREACHED and meeting.together[row][column] == 1:
                other.before[column] = row
                if other.left[column] > 0:
                    return column
                size = return_from(one, meeting, column, size)
    return NONE


@compiled
def return_from(one: Side, meeting: Meeting, column: int, size: int) -> int:
    """Go back along the flow into a spot: the size of the queue."""
    for number in range(1, int(one.used[0]) + 1):
        row = int(one.used[number])
        if one.before[row] == UNREACHED and meeting.flow[row][column] > 0:
            one.before[row] = column
            meeting.queue[size] = row
            size += 1
    return size


@compiled
def push_along(one: Side, other: Side, meeting: Meeting, end: int) -> int:
    """Let as much flow along the path as can: how much."""
    amount = int(other.left[end])
    column = end
    while column != NONE:
        row = int(other.before[column])
        column = int(one.before[row])
        amount = min(amount, int(one.left[row]) if column == NONE else int(meeting.flow[row][column]))
    other.left[end] = int(other.left[end]) - amount
    column = end
    while column != NONE:
        row = int(other.before[column])
        meeting.flow[row][column] = int(meeting.flow[row][column]) + amount
        column = int(one.before[row])
        if column == NONE:
            one.left[row] = int(one.left[row]) - amount
        else:
            meeting.flow[row][column] = int(meeting.flow[row][column]) - amount
    return amount


@compiled
def choose(one: Side, other: Side) -> None:
    """Keep the spots of the one that a path reaches, and those of the other that none does."""
    count = 0
    for number in range(1, int(one.used[0]) + 1):
        if one.before[int(one.used[number])] != UNREACHED:
            count += 1
            one.chosen[count] = one.used[number]
    one.chosen[0] = count
    count = 0
    for number in range(1, int(other.used[0]) + 1):
        if other.before[int(other.used[number])] == UNREACHED:
            count += 1
            other.chosen[count] = other.used[number]
    other.chosen[0] = count
