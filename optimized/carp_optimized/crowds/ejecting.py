"""Rounds that clear the way of a delayed robot (ejection chains, Glover 1996).

Near the best sum, robots that are drawn hardly ever are those that must give way. So a delayed robot takes the earliest
path that meets few others, and these wait. Each of them is planned again, through others if there is no other way,
until nobody waits, or the sum cannot be kept. Who was put out of a path that was tried is dearer to meet.
"""

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
from carp_optimized.crowds.stays import arrival, met_at
from carp_optimized.jit.compiling import compiled
from carp_optimized.neighbourhood.orders import choice
from carp_optimized.neighbourhood.polishing import draw_raise
from carp_optimized.state.arrays import NONE

STEPS = 32
"""The paths that a round tries."""
BETWEEN, THROUGH = 8, 16
"""The labels that a query between others, or through them, may expand for each step of the way, and some more."""


@compiled
def eject(state: Rounds) -> bool:
    """Let a delayed robot arrive earlier; the sum grows by the raise at most. `False` if a row of stays is full."""
    raised = draw_raise(state.stream, int(state.counts[CHANCE]))
    add_member(state, delayed(state))
    take_out(state, 0)
    member = 0
    has_room = True
    steps = 0
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
def plan_through(state: Rounds, member: int, raised: int) -> bool:
    """Try a path for a member, and let those wait that it meets; `False` if the sum cannot be kept so."""
    robot = int(state.members[member])
    latest = latest_of(state, member, raised)
    if member == 0:
        latest = min(latest, arrival(state.paths, robot) - 1)
    turn = draw_turn(state)
    way = int(state.least[robot])
    state.query.counts[TURN] = turn
    state.query.counts[EFFORT] = BETWEEN * (way + 8)
    if find_path(state.crowd, state.stays, state.query, robot, latest, state.tried, member):
        return True
    state.soft.labels.counts[TURN] = turn
    state.soft.labels.counts[EFFORT] = THROUGH * (way + 16)
    if not find_soft_path(state.crowd, state.stays, state.soft, robot, latest, state.tried, member):
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
