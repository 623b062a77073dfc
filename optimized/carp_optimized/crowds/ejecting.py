"""Rounds that clear the way of a delayed robot (ejection chains, Glover 1996).

Near the best sum, robots that are drawn hardly ever are those that must give way. So a delayed robot takes the earliest
path that meets few others, and these wait. Each of them is planned again, through others if there is no other way,
until nobody waits, or the sum cannot be kept. Who was put out of a path that was tried is dearer to meet.

In half of the rounds the first robot met gives way before that: it must not be for some ticks where it was, there or
some visits before. Robots that take their earliest paths in some order never share a delay like that.
"""

from carp_optimized.crowds.neighbourhoods import visit_near
from carp_optimized.crowds.sipp import EFFORT, TURN, UNTIL_FOUND, find_path
from carp_optimized.crowds.soft_sipp import find_soft_path
from carp_optimized.crowds.state import (
    CHANCE,
    MARK,
    MOST_MEMBERS,
    SIZE,
    Rounds,
    add_member,
    delayed,
    draw_turn,
    end_round,
    latest_of,
    put_in,
    take_out,
    take_out_again,
)
from carp_optimized.crowds.stays import arrival, drop_stay, end_of, later_than, met_at, put_stay
from carp_optimized.draws import choice, draw_raise
from carp_optimized.jit.compiling import compiled
from carp_optimized.state.arrays import NONE

STEPS = 32
"""The paths that a round tries."""
BETWEEN, THROUGH = 8, 16
"""The labels that a query between others, or through them, may expand for each step of the way, and some more."""
NEAR, LONG = 6, 4
"""Who gives way does so fewer than `2 ** NEAR` visits before the robots meet, for at most `2 ** (LONG - 1)` ticks."""


@compiled
def eject(state: Rounds) -> bool:
    """Let a delayed robot arrive earlier; the sum grows by the raise at most. `False` if a row of stays is full."""
    raised = draw_raise(state.stream, int(state.counts[CHANCE]))
    add_member(state, delayed(state))
    take_out(state, 0)
    member = 0
    has_room = True
    steps = 0
    if choice(state.stream, 2) == 0 and find_way_through(state, 0, raised):
        has_room = give_way(state, raised)
    while has_room and member != NONE and steps < STEPS and plan_through(state, member, raised):
        has_room = put_in(state, member)
        member = one_that_waits(state)
        steps += 1
    state.query.counts[EFFORT] = UNTIL_FOUND
    state.soft.labels.counts[EFFORT] = UNTIL_FOUND
    for k in range(int(state.counts[SIZE])):
        state.soft.met[int(state.members[k])] = 0
    end_round(state, has_room and member == NONE)
    return has_room


@compiled
def one_that_waits(state: Rounds) -> int:
    """A member that waits, or `NONE`."""
    size = int(state.counts[SIZE])
    first = choice(state.stream, size)
    for k in range(first, first + size):
        member = k if k < size else k - size
        if state.waits[member] == 1:
            return member
    return NONE


@compiled
def give_way(state: Rounds, raised: int) -> bool:
    """Plan the first robot that the path tried meets, kept away from where it was; `False` if a row of stays is full.

    It waits if it finds no path. There is no further member if nobody is met, or only a robot that never moves.
    """
    visit = 0
    size = int(state.tried.size[0])
    while visit < size and met_at(state.crowd, state.stays, state.tried, 0, visit) == NONE:
        visit += 1
    if visit == size:
        return True
    robot = met_at(state.crowd, state.stays, state.tried, 0, visit)
    tick = int(state.tried.enter[0][visit])
    at = visit_near(state.paths, robot, int(state.tried.place[0][visit]), tick)
    if at == NONE:  # they swap
        at = visit_near(state.paths, robot, int(state.tried.place[0][visit - 1]), tick)
    at = max(at - choice(state.stream, 1 << choice(state.stream, NEAR)), 1)
    if at >= state.paths.size[robot]:
        return True
    let_wait(state, robot)
    place = int(state.paths.place[robot][at])
    closes = int(state.paths.enter[robot][at])
    opens = closes + 1 + choice(state.stream, 1 << choice(state.stream, LONG))
    opens = min(opens, end_of(state.stays, int(state.stays.first[place]) + later_than(state.stays, place, closes)))
    if not put_stay(state.stays, place, closes, opens, NONE):
        return False
    is_found = find_way_between(state, 1, raised)
    drop_stay(state.stays, place, closes)
    return not is_found or put_in(state, 1)


@compiled
def latest_arrival(state: Rounds, member: int, raised: int) -> int:
    """The tick by which a member must arrive: the first one earlier than before, and all so that the sum is kept."""
    latest = latest_of(state, member, raised)
    return min(latest, arrival(state.paths, int(state.members[0])) - 1) if member == 0 else latest


@compiled
def find_way_between(state: Rounds, member: int, raised: int) -> bool:
    """Try a path for a member that meets nobody."""
    robot = int(state.members[member])
    state.query.counts[TURN] = draw_turn(state)
    state.query.counts[EFFORT] = BETWEEN * (int(state.least[robot]) + 8)
    latest = latest_arrival(state, member, raised)
    return find_path(state.crowd, state.stays, state.query, robot, latest, state.tried, member)


@compiled
def find_way_through(state: Rounds, member: int, raised: int) -> bool:
    """Try a path for a member that meets few others."""
    robot = int(state.members[member])
    state.soft.labels.counts[TURN] = draw_turn(state)
    state.soft.labels.counts[EFFORT] = THROUGH * (int(state.least[robot]) + 16)
    latest = latest_arrival(state, member, raised)
    return find_soft_path(state.crowd, state.stays, state.soft, robot, latest, state.tried, member)


@compiled
def plan_through(state: Rounds, member: int, raised: int) -> bool:
    """Try a path for a member, and let those wait that it meets; `False` if the sum cannot be kept so."""
    if find_way_between(state, member, raised):
        return True
    if not find_way_through(state, member, raised):
        return False
    for visit in range(int(state.tried.size[member])):
        other = met_at(state.crowd, state.stays, state.tried, member, visit)
        while other != NONE:
            if not let_wait(state, other):
                return False
            other = met_at(state.crowd, state.stays, state.tried, member, visit)
    return True


@compiled
def let_wait(state: Rounds, robot: int) -> bool:
    """Let a robot wait, as one of the members; `False` if these are too many."""
    size = int(state.counts[SIZE])
    if state.mark[robot] != state.counts[MARK]:
        if size == MOST_MEMBERS:
            return False
        add_member(state, robot)
        take_out(state, size)
    else:
        member = 0
        while state.members[member] != robot:
            member += 1
        take_out_again(state, member)
        state.soft.met[robot] += 1
    return True
