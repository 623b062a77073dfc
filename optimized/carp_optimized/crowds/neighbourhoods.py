"""Neighbourhoods: the robots that a round plans again one after the other, drawn in several ways."""

from carp_optimized.crowds.state import SIZE, Rounds, add_member, delayed
from carp_optimized.crowds.stays import Paths, arrival, later_than, robot_at
from carp_optimized.draws import choice
from carp_optimized.jit.compiling import compiled
from carp_optimized.neighbourhood.turns import NOISE, put_in_turn
from carp_optimized.state.arrays import NEVER, NONE

WALKS = 10  # of the delayed robot, until enough others are met


@compiled
def draw_in_way(state: Rounds, size: int) -> None:
    """A delayed robot, and those that it meets on random walks by which it could arrive earlier."""
    robot = delayed(state)
    add_member(state, robot)
    until = arrival(state.paths, robot)
    tick = 0
    for _ in range(WALKS):
        walk(state, robot, tick, until, size)
        if state.counts[SIZE] >= size:
            return
        tick = choice(state.stream, until if tick == 0 else tick)


@compiled
def walk(state: Rounds, robot: int, tick: int, until: int, size: int) -> None:
    """Leave the robot's path at the tick, for steps by which it could arrive before `until`; add whom it meets."""
    place = int(state.paths.place[robot][visit_at(state.paths, robot, tick)])
    while state.counts[SIZE] < size:
        tick += 1
        found = draw_step(state, robot, place, until - tick)
        if found == NONE:
            return
        other = robot_at(state.stays, found, tick)
        if other != NONE:
            add_member(state, other)
        other = robot_at(state.stays, found, tick - 1)
        if other != NONE and state.counts[SIZE] < size and robot_at(state.stays, place, tick) == other:
            add_member(state, other)
        place = found


@compiled
def draw_step(state: Rounds, robot: int, place: int, below: int) -> int:
    """A place that the robot can step to, or stay in, from which its goal is fewer ticks away than that, or `NONE`."""
    crowd = state.crowd
    distance = crowd.distance[robot]
    found = place if distance[place] < below else NONE
    among = 1 if found != NONE else 0
    for edge in range(int(crowd.first[place]), int(crowd.first[place + 1])):
        target = int(crowd.target[edge])
        if distance[target] < below:
            among += 1
            if choice(state.stream, among) == 0:
                found = target
    return found


@compiled
def visit_at(paths: Paths, row: int, tick: int) -> int:
    """The visit that is under way at the tick."""
    low = 0
    high = int(paths.size[row])
    while low + 1 < high:
        middle = (low + high) // 2
        if paths.enter[row][middle] <= tick:
            low = middle
        else:
            high = middle
    return low


@compiled
def draw_crossing(state: Rounds, size: int) -> None:
    """Robots that are in a place at about the same time, and then in places near by. The first is a delayed one."""
    crowd = state.crowd
    stays = state.stays
    robot = delayed(state) if choice(state.stream, 2) == 0 else choice(state.stream, int(state.least.size))
    visit = choice(state.stream, int(state.paths.size[robot]))
    place = int(state.paths.place[robot][visit])
    tick = int(state.paths.enter[robot][visit])
    add_member(state, robot)
    state.key[0] = place
    state.key[1] = tick
    for _ in range(4 * size):
        first = int(stays.first[place])
        last = first + int(stays.size[place]) - 1
        right = first + later_than(stays, place, tick)
        left = right - 1
        while (left >= first or right <= last) and state.counts[SIZE] < size:
            if right > last or (left >= first and tick - stays.enter[left] <= stays.enter[right] - tick):
                add_member(state, int(stays.robot[left]))
                left -= 1
            else:
                add_member(state, int(stays.robot[right]))
                right += 1
        if state.counts[SIZE] >= size:
            return
        edges = int(crowd.first[place + 1]) - int(crowd.first[place])
        if edges == 0:
            return
        place = int(crowd.target[int(crowd.first[place]) + choice(state.stream, edges)])


@compiled
def add_drawn(state: Rounds, size: int) -> None:
    """Robots that are drawn."""
    for _ in range(size):
        add_member(state, choice(state.stream, int(state.least.size)))


@compiled
def draw_turns(state: Rounds) -> None:
    """Order the members by their arrivals in the place where they cross, or those of one direction first."""
    place = int(state.key[0])
    tick = int(state.key[1])
    pivot = int(state.members[0])
    own = way_after(state.paths, pivot, visit_near(state.paths, pivot, place, tick))
    leaders = choice(state.stream, 4)
    noise = 1 + choice(state.stream, 2) * (NOISE - 1)
    for k in range(int(state.counts[SIZE])):
        robot = int(state.members[k])
        visit = visit_near(state.paths, robot, place, tick)
        enter = int(state.paths.enter[robot][visit]) if visit != NONE else tick
        is_own = way_after(state.paths, robot, visit) == own
        put_in_turn(state.stream, state.members, state.key, k, enter, is_own, leaders, noise)


@compiled
def visit_near(paths: Paths, robot: int, place: int, tick: int) -> int:
    """The robot's visit of the place that begins the fewest ticks apart from the tick, or `NONE`."""
    found = NONE
    least = NEVER
    for visit in range(int(paths.size[robot])):
        apart = abs(int(paths.enter[robot][visit]) - tick)
        if paths.place[robot][visit] == place and apart < least:
            found = visit
            least = apart
    return found


@compiled
def way_after(paths: Paths, robot: int, visit: int) -> int:
    """Where the robot goes after the visit; `NONE` after its last, or after none."""
    return int(paths.place[robot][visit + 1]) if visit != NONE and visit + 1 < paths.size[robot] else NONE
