"""The choices that are left in a part of a search by branching, and the part that one of them makes, compiled."""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimum.branching.arrays import ENDLESS, LATE, SCALE, STEPS, Part, part_at

SURE_TICKS = 3  # ticks after the start at which it is asked where robots surely are
FEW = 32  # one part of the steps: a node in fewer ways, or in nearly all, is no choice
GUESS = SCALE // 2  # what a choice raises the bound by, before it was tried


@compiled
def has_arrived(part: Part, robot: int, tick: int) -> bool:
    """Whether the robot may have entered its goal before the tick."""
    goal = int(part.nodes.goal[robot])
    for earlier in range(tick):  # noqa: SIM110 - compiled
        if is_alive(part, robot, earlier, goal):
            return True
    return False


@compiled
def options(part: Part, robot: int, tick: int) -> int:
    """In how many resources the robot may be at a tick, and one more if it may be gone."""
    count = 1 if has_arrived(part, robot, tick) else 0
    for resource in range(part.nodes.first.size - 1):
        if is_alive(part, robot, tick, resource):
            count += 1
    return count


@compiled
def only_place(part: Part, robot: int, tick: int) -> int:
    """The only resource in which the robot may be at the tick, if it is not gone, or `NONE`."""
    place = NONE
    for resource in range(part.nodes.first.size - 1):
        if is_alive(part, robot, tick, resource):
            if place != NONE:
                return NONE
            place = resource
    return place


@compiled
def settle(part: Part) -> bool:
    """Drop nodes that the law forbids beside robots that are surely somewhere; false if a robot is left nowhere."""
    changes = True
    while changes:
        changes = False
        for tick in range(1, min(SURE_TICKS, int(part.counters[LATE])) + 1):
            for robot in range(part.nodes.goal.size):
                count = options(part, robot, tick)
                if count == 0:
                    return False
                place = only_place(part, robot, tick) if count == 1 else NONE
                if place != NONE and keep_others_off(part, robot, tick, place):
                    changes = True
    return True


@compiled
def keep_others_off(part: Part, robot: int, tick: int, place: int) -> bool:
    """Drop the nodes of others in the place, and in the one before if they would exchange; whether there were any."""
    before = only_place(part, robot, tick - 1)
    changes = False
    for other in range(part.nodes.goal.size):
        if other != robot:
            changes |= drop(part, other, tick, place)
            exchanges = before not in (NONE, place) and is_alive(part, other, tick, before)
            if exchanges and only_place(part, other, tick - 1) == place:
                changes |= drop(part, other, tick, before)
    return changes


@compiled
def is_alive(part: Part, robot: int, tick: int, resource: int) -> bool:
    """Whether the robot may be in the resource at the tick."""
    node = int(part.nodes.at[robot][tick * (part.nodes.first.size - 1) + resource])
    return node != NONE and part.alive[node] > 0


@compiled
def drop(part: Part, robot: int, tick: int, resource: int) -> bool:
    """Drop a node; whether it was alive."""
    if not is_alive(part, robot, tick, resource):
        return False
    part.alive[int(part.nodes.at[robot][tick * (part.nodes.first.size - 1) + resource])] = 0
    return True


@entry
def tick_of_choice(native: Native[Part]) -> int:
    """The first tick at which a robot was in different places in the steps, and may be; `NONE`: all have one way left.

    If no robot has a choice there, it is a later one, or the first of all.
    """
    part = part_at(native)
    first = first_choice(part)
    last = int(part.counters[LATE])
    for offset in range(last):
        tick = (first - 1 + offset) % last + 1
        for robot in range(part.nodes.goal.size):
            if options(part, robot, tick) > 1:
                return tick
    return NONE


@entry
def robot_of_choice(native: Native[Part], tick: int) -> int:
    """The robot whose choices at the tick are likely to leave the least to search, or `NONE` if none has a choice.

    Each is guessed to leave a part that falls as the square of the rise of the bound.
    """
    part = part_at(native)
    chosen = NONE
    least = ENDLESS
    for robot in range(part.nodes.goal.size):
        if options(part, robot, tick) > 1:
            left = work_left(part, robot, tick)
            if left < least:
                least = left
                chosen = robot
    return chosen


@compiled
def first_choice(part: Part) -> int:
    """The first tick after the start at which a robot's ways were in different places, or the last tick."""
    live = part.live
    first = int(part.counters[LATE])
    steps = int(part.counters[STEPS])
    for each in range(int(live.of_robot[part.nodes.goal.size])):
        node = int(live.node[each])
        often = int(live.often[each])
        if part.alive[node] > 0 and steps < often * FEW < steps * (FEW - 1):
            first = min(first, int(part.nodes.tick[node]))
    return max(first, 1)


@compiled
def work_left(part: Part, robot: int, tick: int) -> int:
    """The work that the choices of a robot at a tick are guessed to leave."""
    nodes = part.nodes
    resources = nodes.first.size - 1
    guess = (1 << 52) // ((SCALE + GUESS) * (SCALE + GUESS))
    left = guess if has_arrived(part, robot, tick) else 0
    for resource in range(resources):
        if is_alive(part, robot, tick, resource):
            node = int(nodes.at[robot][tick * resources + resource])
            rise = GUESS if nodes.tries[node] == 0 else int(nodes.gain[node]) // int(nodes.tries[node])
            left += (1 << 52) // ((SCALE + rise) * (SCALE + rise))
    return left


@entry
def put(native: Native[Part], robot: int, tick: int, chosen: int) -> bool:
    """Let the robot be in the chosen node of the tick, or be gone where it is `NONE`; false if the law forbids it."""
    part = part_at(native)
    nodes = part.nodes
    for node in range(int(nodes.of_robot[robot]), int(nodes.of_robot[robot + 1])):
        now = int(nodes.tick[node])
        if chosen == NONE:
            keep = now < tick
        elif now == tick:
            keep = node == chosen
        else:
            keep = now > tick or nodes.place[node] != nodes.goal[robot]
        if not keep:
            part.alive[node] = 0
    return settle(part)
