"""Rounds of large neighbourhood search over a crowd (MAPF-LNS, Li et al. 2021): one compiled call plays many.

A round takes a few robots out, plans them one after the other by `carp_optimized.crowds.sipp`, and keeps the new paths
if the sum of their arrivals is not above the sum before by more than a raise that is drawn (simulated annealing). The
best paths seen are kept apart. A path is looked for only up to the arrival at which the sum could still be kept.

There are kinds of neighbourhoods, and queries of more or less greed. Each is chosen by the share of its weight, which
follows what its rounds gained for the work that they took (adaptive large neighbourhood search, Ropke and Pisinger
2006).
"""

from typing import NamedTuple

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.sipp import EXPANDED, GREED, TURN, WHOLE, Query, find_path
from carp_optimized.crowds.stays import Paths, Stays, arrival, copy_path, drop, later_than, put, robot_at
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, Longs, Numbers
from carp_optimized.jit.references import Native, dereference
from carp_optimized.neighbourhood.orders import choice, shuffle
from carp_optimized.neighbourhood.polishing import NOISE, SURE, put_in_turn
from carp_optimized.state.arrays import NEVER, NONE

TOTAL, BEST, CHANCE, DIRTY, MARK, SIZE, WORK, ROUNDS, MISSED, TURNING = range(10)  # the counts
IN_WAY, CROSSING, TURNS, DRAWN = range(4)  # the kinds
KINDS = 4
GREEDY = WHOLE // 2
DEGREES = 3  # of greed: none, `GREEDY`, and four times that
MOST_MEMBERS = 16
LEAST_WEIGHT, LEAST_OF_DEGREES = 1 << 8, 1 << 4
SHIFT = 16
FIRST_WEIGHTS = KINDS * (1 << 16,) + (1 << 10, 1 << 12, 1 << 12)
"""Of the kinds, and of the degrees: queries without greed may take much longer."""
GAIN = 1 << 20  # a gain of one tick for one unit of work adds this to a weight
MEMORY = 64  # rounds over which a weight is about the mean
WALKS = 10
FULL = NONE


class Rounds(NamedTuple):
    """The state of a search: paths and their stays, the best paths, those tried in a round, and its members.

    `changed[:counts[DIRTY]]` are the robots whose paths may differ from the best, and `is_changed` says so of each.
    """

    crowd: Crowd
    stays: Stays
    query: Query
    paths: Paths
    best: Paths
    tried: Paths
    least: Ints
    members: Ints
    key: Longs
    mark: Ints
    changed: Ints
    is_changed: Ints
    weight: Longs
    counts: Longs
    stream: Numbers


rounds_at = dereference(Rounds)


@entry
def play(native: Native[Rounds], rounds: int, work: int) -> int:
    """Play rounds until that many are played or that much work is done; how many, or `FULL` after an unfinished one."""
    state = rounds_at(native)
    until = int(state.counts[WORK]) + work
    for played in range(rounds):
        if state.counts[WORK] >= until:
            return played
        if not play_round(state):
            return FULL
        state.counts[ROUNDS] += 1
    return rounds


@entry
def plan_each(native: Native[Rounds], order: Ints, begin: int, work: int) -> int:
    """Plan robots again, one by one, that have paths, from `order[begin]` on, until that many labels are expanded.

    Returns the number of the next one, with all bits inverted if a row is too full for it.
    """
    state = rounds_at(native)
    until = int(state.query.counts[EXPANDED]) + work
    for k in range(begin, order.size):
        if state.query.counts[EXPANDED] >= until:
            return k
        state.members[0] = order[k]
        state.counts[SIZE] = 1
        state.counts[CHANCE] = 0
        if not replan(state):
            return ~k
    return int(order.size)


@entry
def plan_first(native: Native[Rounds], order: Ints, begin: int, work: int) -> int:
    """Plan robots, one by one, that have no paths yet; those without any get none. As `plan_each`."""
    state = rounds_at(native)
    until = int(state.query.counts[EXPANDED]) + work
    for k in range(begin, order.size):
        if state.query.counts[EXPANDED] >= until:
            return k
        robot = int(order[k])
        state.paths.size[robot] = 0
        if not find_path(state.crowd, state.stays, state.query, robot, NEVER - 1, state.paths, robot):
            state.counts[MISSED] += 1
        elif not put(state.crowd, state.stays, state.paths, robot, robot):
            state.paths.size[robot] = 0
            return ~k
    return int(order.size)


@entry
def put_all(native: Native[Rounds], begin: int, end: int) -> int:
    """Add the stays of the paths from one on up to another; the first that is not added, as a row is full."""
    state = rounds_at(native)
    for robot in range(begin, end):
        if not put(state.crowd, state.stays, state.paths, robot, robot):
            return robot
    return end


@compiled
def play_round(state: Rounds) -> bool:
    """Take out a neighbourhood and replan it; `False` if a row of stays is full."""
    kind = choose_kind(state)
    degree = choose_by_weight(state, KINDS, DEGREES)
    state.query.counts[GREED] = GREEDY * (degree - KINDS) ** 2
    state.counts[MARK] += 1
    state.counts[SIZE] = 0
    size = 2 + choice(state.stream, 9)
    before = int(state.counts[TOTAL])
    begun = int(state.query.counts[EXPANDED])
    if kind == IN_WAY:
        draw_in_way(state, size)
    elif kind == CROSSING:
        draw_crossing(state, size)
    elif kind == TURNS:
        draw_crossing(state, 4 + choice(state.stream, MOST_MEMBERS - 3))
        draw_turns(state)
    else:
        add_drawn(state, size)
    if kind in (IN_WAY, CROSSING):  # half of the time the first stays first
        shuffle(state.stream, state.members, choice(state.stream, 2), int(state.counts[SIZE]))
    if not replan(state):
        return False
    work = 100 * int(state.counts[SIZE]) + int(state.query.counts[EXPANDED]) - begun
    state.counts[WORK] += work
    gain = max(before - int(state.counts[TOTAL]), 0) * GAIN // work
    update_weight(state, kind, gain, LEAST_WEIGHT)
    update_weight(state, degree, (gain << SHIFT) // work, LEAST_OF_DEGREES)
    return True


@compiled
def update_weight(state: Rounds, which: int, gain: int, least: int) -> None:
    """Let a weight follow what a round gained."""
    after = int(state.weight[which]) + (gain - int(state.weight[which])) // MEMORY
    state.weight[which] = max(after, least)


@compiled
def choose_kind(state: Rounds) -> int:
    """Choose a kind: one of all in one round of four, else by the weights."""
    if choice(state.stream, 4) == 0:
        return choice(state.stream, KINDS)
    return choose_by_weight(state, 0, KINDS)


@compiled
def choose_by_weight(state: Rounds, first: int, among: int) -> int:
    """Choose one of that many, from the first on, by the share of its weight."""
    total = 0
    for which in range(first, first + among):
        total += int(state.weight[which])
    left = choice(state.stream, total)
    for which in range(first, first + among):
        left -= int(state.weight[which])
        if left < 0:
            return which
    return first


@compiled
def add_member(state: Rounds, robot: int) -> None:
    """Make the robot a member, if it is none yet."""
    if state.mark[robot] != state.counts[MARK]:
        state.mark[robot] = state.counts[MARK]
        state.members[int(state.counts[SIZE])] = robot
        state.counts[SIZE] += 1


@compiled
def delay_of(state: Rounds, robot: int) -> int:
    """The ticks by which the robot arrives later than it could alone."""
    return arrival(state.paths, robot) - int(state.least[robot])


@compiled
def delayed(state: Rounds) -> int:
    """A robot, drawn by the share of its delay; any if none is late."""
    robots = int(state.least.size)
    total = 0
    for robot in range(robots):
        total += delay_of(state, robot)
    if total == 0:
        return choice(state.stream, robots)
    left = choice(state.stream, total)
    robot = 0
    while True:
        left -= delay_of(state, robot)
        if left < 0:
            return robot
        robot += 1


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


@compiled
def replan(state: Rounds) -> bool:
    """Plan the members in their order, and keep their new paths or go back; `False` if a row of stays is full."""
    size = int(state.counts[SIZE])
    before = 0
    rest = 0
    for k in range(size):
        robot = int(state.members[k])
        before += arrival(state.paths, robot)
        rest += int(state.least[robot])
        drop(state.stays, state.paths, robot, int(state.paths.size[robot]))
    limit = before
    while state.counts[CHANCE] > 0 and choice(state.stream, SURE) < state.counts[CHANCE]:
        limit += 1
    after = 0
    has_room = True
    planned = 0
    while planned < size and has_room:
        robot = int(state.members[planned])
        rest -= int(state.least[robot])
        latest = limit - after - rest
        state.query.counts[TURN] = 1 + choice(state.stream, SURE) if state.counts[TURNING] else 0
        if not find_path(state.crowd, state.stays, state.query, robot, latest, state.tried, planned):
            break
        has_room = put(state.crowd, state.stays, state.tried, planned, robot)
        if has_room:
            after += arrival(state.tried, planned)
            planned += 1
    if planned == size:
        keep(state, after - before)
        return True
    for k in range(planned):
        drop(state.stays, state.tried, k, int(state.tried.size[k]))
    for k in range(size):
        robot = int(state.members[k])
        put(state.crowd, state.stays, state.paths, robot, robot)
    return has_room


@compiled
def keep(state: Rounds, raised: int) -> None:
    """Make the paths that were tried those of the members, and note whether they are the best."""
    counts = state.counts
    for k in range(int(counts[SIZE])):
        robot = int(state.members[k])
        copy_path(state.tried, k, state.paths, robot)
        if state.is_changed[robot] == 0:
            state.is_changed[robot] = 1
            state.changed[int(counts[DIRTY])] = robot
            counts[DIRTY] += 1
    counts[TOTAL] += raised
    if counts[TOTAL] < counts[BEST]:
        counts[BEST] = counts[TOTAL]
        for k in range(int(counts[DIRTY])):
            robot = int(state.changed[k])
            state.is_changed[robot] = 0
            copy_path(state.paths, robot, state.best, robot)
        counts[DIRTY] = 0
