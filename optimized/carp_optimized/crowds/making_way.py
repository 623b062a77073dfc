"""Way for robots that prioritized planning has missed, at the cost of others that are planned again.

A robot that finds no path takes one on which it meets few others all the same, and those wait in turn. So it gets the
place in the order that it would have needed, and all others keep their plans. That need not end: two can put each
other out for ever.
"""

from carp_optimized.crowds.rounds import MISSED, Rounds, rounds_at
from carp_optimized.crowds.sipp import EXPANDED, find_path
from carp_optimized.crowds.soft_sipp import SoftQuery, find_soft_path, soft_query_at
from carp_optimized.crowds.stays import drop, later_than, leave_of, put, robot_at
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.orders import choice
from carp_optimized.state.arrays import NEVER, NONE


@entry
def make_way(native: Native[Rounds], soft: Native[SoftQuery], waiting: Ints, count: int, work: int) -> int:
    """Plan the robots `waiting[:count]`, drawn one by one. One that finds no path takes one through others.

    Those that it meets there wait in turn, without paths. Ends after that many labels, or if a path has too many
    visits. Returns how many wait, with all bits inverted if a row is too full for one.
    """
    state = rounds_at(native)
    query = soft_query_at(soft)
    done = int(state.query.counts[EXPANDED]) + int(query.labels.counts[EXPANDED])
    while count > 0 and state.query.counts[EXPANDED] + query.labels.counts[EXPANDED] < done + work:
        at = choice(state.stream, count)
        robot = int(waiting[at])
        count -= 1
        waiting[at] = waiting[count]
        if not find_path(state.crowd, state.stays, state.query, robot, NEVER - 1, state.paths, robot):
            state.counts[MISSED] += 1
            if not find_soft_path(state.crowd, state.stays, query, robot, state.paths, robot):
                state.paths.size[robot] = 0
                waiting[count] = robot
                return count + 1
            count = put_out(state, query, robot, waiting, count)
        if not put(state.crowd, state.stays, state.paths, robot, robot):
            state.paths.size[robot] = 0
            waiting[count] = robot
            return ~(count + 1)
    return count


@compiled
def put_out(state: Rounds, query: SoftQuery, robot: int, waiting: Ints, count: int) -> int:
    """Let those wait that the robot's path meets: in a place or on an edge; how many wait then."""
    stays = state.stays
    before = NONE
    for visit in range(int(state.paths.size[robot])):
        place = int(state.paths.place[robot][visit])
        enter = int(state.paths.enter[robot][visit])
        other = robot_at(stays, place, enter - 1)
        if NONE not in (before, other) and robot_at(stays, before, enter) == other:
            count = let_wait(state, query, other, waiting, count)
        other = last_met(state, robot, visit)
        while other != NONE:
            count = let_wait(state, query, other, waiting, count)
            other = last_met(state, robot, visit)
        before = place
    return count


@compiled
def last_met(state: Rounds, robot: int, visit: int) -> int:
    """The robot that is the last one in the place of a visit while the robot is there, or `NONE`."""
    stays = state.stays
    place = int(state.paths.place[robot][visit])
    at = int(stays.first[place]) + later_than(stays, place, leave_of(state.crowd, state.paths, robot, visit) - 1) - 1
    if at < stays.first[place] or stays.leave[at] <= state.paths.enter[robot][visit]:
        return NONE
    return int(stays.robot[at])


@compiled
def let_wait(state: Rounds, query: SoftQuery, robot: int, waiting: Ints, count: int) -> int:
    """Take the robot's path away; how many wait then."""
    drop(state.stays, state.paths, robot, int(state.paths.size[robot]))
    state.paths.size[robot] = 0
    query.met[robot] += 1
    waiting[count] = robot
    return count + 1
