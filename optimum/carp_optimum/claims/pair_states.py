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
from carp_optimum.lagrangian.state import Dual, dual_at, duration_of

UNREACHED = -2


class Side(NamedTuple):
    """One of the two robots, with the largest `delay` that is looked at, and its state at tick 0, `start`.

    `spot` is the number of each resource as a spot, or `NONE`, and `resource` the reverse; `first` has the first state
    of each spot, then the number of states. `latest` has for each spot the last tick at which all ways through it have
    a delay that is looked at. `often` is in how many ways the robot is in each spot at each tick. A state has a spot,
    `spot_of`, that of the goal after it, takes a place, `NONE` where it is nowhere, and has `branches` states that
    follow it. At a tick that it is seen at, one of `sees`, the robot may only be in the spots that it has in `held`.

    At a tick, `used` are the spots in which any way is, `left` is how often that is, less the flow, and `before` is the
    spot of the other robot that a path comes from. `chosen` are the spots of the heaviest claim, and `inside` says of
    each spot whether it is one. `used` and `chosen` begin with the number of spots.
    """

    robot: int
    delay: int
    start: int
    spot: Ints
    resource: Ints
    first: Ints
    latest: Longs
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
    """Two robots, and the pairs of their states, a row each for even and odd ticks.

    `mark` is a number of the tick and search that reached a pair last. `origin` is the spot in which one of the robots
    was at an earlier tick, before a pair, and `blamed` are such spots. `together` is whether two spots can be taken
    together at the tick; `queue` holds spots to go on from. `found` is the weight of the best claim, its tick, and the
    last mark.
    """

    one: Side
    other: Side
    pairs: IntTable
    origin: IntTable
    mark: Ints
    blamed: Ints
    together: IntTable
    flow: IntTable
    queue: Ints
    found: Longs


meeting_at = dereference(Meeting)


@compiled
def spots_of(side: Side) -> int:
    """The number of spots that are resources."""
    return side.resource.size


@compiled
def go_on(dual: Dual, side: Side, tick: int) -> None:
    """Fill in the states that follow each state at the tick."""
    spots = spots_of(side)
    for state in range(side.place.size):
        spot = int(side.spot_of[state])
        side.following[state][0] = state
        side.branches[state] = 1
        if side.place[state] == NONE:
            if spot > spots and tick + 1 == dual.requests.release[side.robot]:
                side.following[state][0] = entered(side, int(dual.requests.start[side.robot]))
        elif state > side.first[spot]:
            side.following[state][0] = state - 1
        elif spot < spots:
            move_on(dual, side, state, tick)
        elif not dual.parks:
            side.following[state][0] = int(side.first[spots + 1])


@compiled
def entered(side: Side, resource: int) -> int:
    """The state of a robot that enters the resource."""
    return int(side.first[int(side.spot[resource]) + 1]) - 1


@compiled
def move_on(dual: Dual, side: Side, state: int, tick: int) -> None:
    """Fill in the states that follow one in which the robot is free to leave."""
    graph, robot = dual.graph, side.robot
    rest = dual.requests.rest[robot]
    here = int(side.place[state])
    late = tick + 1 - int(dual.requests.earliest[robot])
    count = 1 if late + 1 + int(rest[here]) <= side.delay else 0
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        target = int(graph.target[move])
        after = late + duration_of(dual, robot, target) + int(rest[target])
        if side.spot[target] != NONE and after <= side.delay:
            side.following[state][count] = entered(side, target)
            count += 1
        if target == dual.requests.goal[robot] and late <= side.delay:
            side.following[state][count] = int(side.first[spots_of(side) + 1]) - 1
            count += 1
    side.branches[state] = count


@entry
def find_claim(native: Native[Dual], native_meeting: Native[Meeting], end: int, ways: int) -> int:
    """Find the heaviest claim of two robots before the tick `end`, and fill `chosen`: its weight less `ways`, or 0."""
    dual, meeting = dual_at(native), meeting_at(native_meeting)
    meeting.found[0] = 0
    size = begin(meeting)
    for tick in range(end):
        if tick > 0:
            weigh(meeting, size, tick, ways)
        size = step(dual, meeting, size, tick)
    return int(meeting.found[0])


@entry
def find_meetings(native: Native[Dual], native_meeting: Native[Meeting], whose: int, earlier: int) -> int:
    """Find out which spots can be taken together at the claim's tick; returns how many pairs are in spots of the claim.

    The spots in which the first robot, or with `whose` the other, was at an earlier tick before them are `blamed`.
    """
    dual, meeting = dual_at(native), meeting_at(native_meeting)
    last = int(meeting.found[1])
    size = begin(meeting)
    for tick in range(last):
        if tick == earlier:
            for number in range(size):
                spots = spots_at(meeting, number, tick)
                meeting.origin[tick % 2][number] = spots[0] if whose == 0 else spots[1]
        size = step(dual, meeting, size, tick)
    relate(meeting, size, last)
    count = 0
    for number in range(size):
        spot, other_spot = spots_at(meeting, number, last)
        if meeting.one.inside[spot] == 1 and meeting.other.inside[other_spot] == 1:
            meeting.blamed[int(meeting.origin[last % 2][number])] = 1
            count += 1
    return count


@compiled
def begin(meeting: Meeting) -> int:
    """Begin with the states at tick 0: one pair."""
    meeting.pairs[0][0] = meeting.one.start * meeting.other.place.size + meeting.other.start
    meeting.origin[0][0] = 0
    return 1


@compiled
def spots_at(meeting: Meeting, number: int, tick: int) -> tuple[int, int]:
    """The spots of a pair of states at the tick."""
    state, other_state = divmod(int(meeting.pairs[tick % 2][number]), meeting.other.place.size)
    return int(meeting.one.spot_of[state]), int(meeting.other.spot_of[other_state])


@compiled
def may_be(side: Side, state: int, tick: int) -> bool:
    """Whether the robot may be in the state at the tick."""
    return bool(side.sees[tick] == 0 or side.held[tick][int(side.spot_of[state])] == 1)


@compiled
def step(dual: Dual, meeting: Meeting, size: int, tick: int) -> int:
    """Reach all pairs of states at the next tick: how many."""
    one, other = meeting.one, meeting.other
    go_on(dual, one, tick)
    go_on(dual, other, tick)
    pairs, later = meeting.pairs[tick % 2], meeting.pairs[(tick + 1) % 2]
    origin, later_origin = meeting.origin[tick % 2], meeting.origin[(tick + 1) % 2]
    wide = other.place.size
    meeting.found[2] += 1
    mark = int(meeting.found[2])
    reached = 0
    for number in range(size):
        state, other_state = divmod(int(pairs[number]), wide)
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
                    and can_move(dual, place, target, other_place, int(other.place[other_after]))
                ):
                    meeting.mark[pair] = mark
                    later[reached] = pair
                    later_origin[reached] = int(origin[number])
                    reached += 1
    return reached


@compiled
def can_move(dual: Dual, place: int, target: int, other_place: int, other_target: int) -> bool:
    """Whether one robot may move, or stay, from place to target while the other does the same."""
    if target == other_target:
        return target == NONE or int(dual.graph.capacity[target]) > 1
    return min(target, other_target) == NONE or target != other_place or other_target != place


@compiled
def weigh(meeting: Meeting, size: int, tick: int, ways: int) -> None:
    """Find the heaviest claim at the tick, and keep it if none before was as heavy."""
    in_all = use(meeting.one, tick) + use(meeting.other, tick) - ways
    if in_all <= meeting.found[0]:
        return
    relate(meeting, size, tick)
    weight = in_all - most_flow(meeting)
    if weight > meeting.found[0]:
        meeting.found[0] = weight
        meeting.found[1] = tick
        choose(meeting.one, True)
        choose(meeting.other, False)


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
def relate(meeting: Meeting, size: int, tick: int) -> None:
    """Find out which spots can be taken together at the tick."""
    for row in range(spots_of(meeting.one) + 2):
        for column in range(spots_of(meeting.other) + 2):
            meeting.together[row][column] = 0
    for number in range(size):
        row, column = spots_at(meeting, number, tick)
        meeting.together[row][column] = 1


@compiled
def most_flow(meeting: Meeting) -> int:
    """The largest flow between spots that can be taken together, path by path."""
    one, other = meeting.one.used, meeting.other.used
    for row in range(1, int(one[0]) + 1):
        for column in range(1, int(other[0]) + 1):
            meeting.flow[int(one[row])][int(other[column])] = 0
    total = 0
    end = find_path(meeting)
    while end != NONE:
        total += push_along(meeting, end)
        end = find_path(meeting)
    return total


@compiled
def find_path(meeting: Meeting) -> int:
    """A spot of the other robot to which more can flow, or `NONE`."""
    one, other = meeting.one, meeting.other
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
                size = return_from(meeting, column, size)
    return NONE


@compiled
def return_from(meeting: Meeting, column: int, size: int) -> int:
    """Go back along the flow into a spot: the size of the queue."""
    one = meeting.one
    for number in range(1, int(one.used[0]) + 1):
        row = int(one.used[number])
        if one.before[row] == UNREACHED and meeting.flow[row][column] > 0:
            one.before[row] = column
            meeting.queue[size] = row
            size += 1
    return size


@compiled
def push_along(meeting: Meeting, end: int) -> int:
    """Let as much flow along the path as can: how much."""
    one, other = meeting.one, meeting.other
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
def choose(side: Side, is_reached: bool) -> None:
    """Keep the spots that a path reaches, or those that none does."""
    count = 0
    for number in range(1, int(side.used[0]) + 1):
        spot = int(side.used[number])
        if (side.before[spot] != UNREACHED) == is_reached:
            count += 1
            side.chosen[count] = spot
    side.chosen[0] = count
