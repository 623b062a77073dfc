"""Way for robots that prioritized planning has missed, at the cost of others that are planned again.

A robot that finds no path takes one on which it meets few others all the same, and those wait in turn. So it gets the
place in the order that it would have needed, and all others keep their plans. That need not end: two can put each
other out for ever.
"""

from carp_optimized.crowds.sipp import find_path
from carp_optimized.crowds.soft_sipp import find_soft_path
from carp_optimized.crowds.state import MISSED, Rounds, expanded, rounds_at
from carp_optimized.crowds.stays import drop, met_at, put
from carp_optimized.draws import choice
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NEVER, NONE


@entry
def make_way(native: Native[Rounds], waiting: Ints, count: int, work: int) -> int:
    """Plan the robots `waiting[:count]`, drawn one by one. One that finds no path takes one through others.

    Those that it meets there wait in turn, without paths. Ends after that many labels, or if a path has too many
    visits. Returns how many wait, with all bits inverted if a row is too full for one.
    """
    state = rounds_at(native)
    until = expanded(state) + work
    while count > 0 and expanded(state) < until:
        at = choice(state.stream, count)
        robot = int(waiting[at])
        count -= 1
        waiting[at] = waiting[count]
        if not find_path(state.crowd, state.stays, state.query, robot, NEVER - 1, state.paths, robot):
            state.counts[MISSED] += 1
            if not find_soft_path(state.crowd, state.stays, state.soft, robot, NEVER - 1, state.paths, robot):
                state.paths.size[robot] = 0
                waiting[count] = robot
                return count + 1
            count = put_out(state, robot, waiting, count)
        if not put(state.crowd, state.stays, state.paths, robot, robot):
            state.paths.size[robot] = 0
            waiting[count] = robot
            return ~(count + 1)
    return count


@compiled
def put_out(state: Rounds, robot: int, waiting: Ints, count: int) -> int:
    """Let those wait that the robot's path meets: in a place or on an edge; how many wait then."""
    for visit in range(int(state.paths.size[robot])):
        other = met_at(state.crowd, state.stays, state.paths, robot, visit)
        while other != NONE:
            count = let_wait(state, other, waiting, count)
            other = met_at(state.crowd, state.stays, state.paths, robot, visit)
    return count


@compiled
def let_wait(state: Rounds, robot: int, waiting: Ints, count: int) -> int:
    """Take the robot's path away; how many wait then."""
    drop(state.stays, state.paths, robot, int(state.paths.size[robot]))
    state.paths.size[robot] = 0
    state.soft.met[robot] += 1
    waiting[count] = robot
    return count + 1
