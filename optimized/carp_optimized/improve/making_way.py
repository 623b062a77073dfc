"""Way for robots that prioritized planning has missed, at the cost of others that are planned again.

A robot that finds no path takes one of its shortest ways all the same, and those that it meets wait in turn. So it gets
the place in the order that it would have needed, and all others keep their plans. That need not end: two can put each
other out for ever.
"""

from carp_optimized.improve.rounds import MISSED, Rounds, choice, rounds_at
from carp_optimized.improve.sipp import EXPANDED, find_path
from carp_optimized.improve.stays import drop, put, robot_at
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NEVER, NONE


@entry
def make_way(native: Native[Rounds], waiting: Ints, count: int, work: int) -> int:
    """Plan the robots `waiting[:count]`, drawn one by one. One that finds no path takes one of its shortest ways.

    Those that it meets there wait in turn, without paths. Ends after that many labels, or if a way has too many visits.
    Returns how many wait, with all bits inverted if a row is too full for one.
    """
    state = rounds_at(native)
    until = int(state.query.counts[EXPANDED]) + work
    while count > 0 and state.query.counts[EXPANDED] < until:
        at = choice(state.stream, count)
        robot = int(waiting[at])
        count -= 1
        waiting[at] = waiting[count]
        if not find_path(state.crowd, state.stays, state.query, robot, NEVER - 1, state.paths, robot):
            state.counts[MISSED] += 1
            state.query.counts[EXPANDED] += state.least[robot]
            if not draw_way(state, robot):
                waiting[count] = robot
                return count + 1
            count = put_out(state, robot, waiting, count)
        if not put(state.crowd, state.stays, state.paths, robot, robot):
            state.paths.size[robot] = 0
            waiting[count] = robot
            return ~(count + 1)
    return count


@compiled
def draw_way(state: Rounds, robot: int) -> bool:
    """Make one of its shortest ways the robot's path, through places that are free then where there are some.

    `False` if it has too many visits.
    """
    place = int(state.crowd.start[robot])
    size = int(state.least[robot]) + 1
    if size > state.paths.place[robot].size:
        return False
    state.paths.size[robot] = size
    for tick in range(size):
        state.paths.place[robot][tick] = place
        state.paths.enter[robot][tick] = tick
        place = draw_nearer(state, robot, place, tick + 1)
    return True


@compiled
def draw_nearer(state: Rounds, robot: int, place: int, tick: int) -> int:
    """A place to step to that is nearer to the robot's goal, and free at the tick if one is."""
    crowd = state.crowd
    distance = crowd.distance[robot]
    found = NONE
    is_free = False
    among = 0
    for edge in range(int(crowd.first[place]), int(crowd.first[place + 1])):
        target = int(crowd.target[edge])
        if distance[target] >= distance[place]:
            continue
        frees = robot_at(state.stays, target, tick) == NONE
        if frees and not is_free:
            among = 0
        if frees or not is_free:
            is_free = frees
            among += 1
            if choice(state.stream, among) == 0:
                found = target
    return found


@compiled
def put_out(state: Rounds, robot: int, waiting: Ints, count: int) -> int:
    """Let those wait that the robot's path meets: in a place, on an edge, or in its goal later; how many wait then."""
    stays = state.stays
    before = NONE
    for tick in range(int(state.paths.size[robot])):
        place = int(state.paths.place[robot][tick])
        other = robot_at(stays, place, tick)
        if other != NONE:
            count = let_wait(state, other, waiting, count)
        other = robot_at(stays, place, tick - 1)
        if NONE not in (before, other) and robot_at(stays, before, tick) == other:
            count = let_wait(state, other, waiting, count)
        before = place
    goal = int(state.crowd.goal[robot])
    first = int(stays.first[goal])
    while state.crowd.parks and stays.size[goal] > 0:
        last = first + int(stays.size[goal]) - 1
        if stays.leave[last] <= state.least[robot]:
            break
        count = let_wait(state, int(stays.robot[last]), waiting, count)
    return count


@compiled
def let_wait(state: Rounds, robot: int, waiting: Ints, count: int) -> int:
    """Take the robot's path away; how many wait then."""
    drop(state.stays, state.paths, robot, int(state.paths.size[robot]))
    state.paths.size[robot] = 0
    waiting[count] = robot
    return count + 1
