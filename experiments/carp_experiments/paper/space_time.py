"""Planning on the paper's maps tick by tick, under rules that the law does not have: for the experiment on conventions.

Every cell holds one robot, and every move takes a tick. Robots are planned one after the other, each by A* over
(tick, cell), where `occupant` holds who is where at each tick.
"""

from typing import NamedTuple

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints

HORIZON = 400
NONE = -1
FOR_EVER = -1
ALL = 1 << 40
TICKS, DIFFERENCE, UNDIVIDED = range(3)


class World(NamedTuple):
    """The map, the robots, their plans, and what a search writes on.

    `neighbours` int32 (cells, 4), padded with -1; `steps` int32 (cells, cells), -1 where none lead there; `apart`
    int64 (cells, cells), distances; `start`, `goal`, `release` int32 of each robot; `occupant` int32 (ticks, cells);
    `path` int32 (robots, ticks), the cell at each tick from `entered` to `arrival`, which is -1 without a plan.
    """

    neighbours: Ints
    steps: Ints
    apart: Ints
    start: Ints
    goal: Ints
    release: Ints
    occupant: Ints
    path: Ints
    entered: Ints
    arrival: Ints
    seen: Ints
    link: Ints
    came: Ints
    head: Ints
    tail: Ints
    stamp: Ints
    stay: int
    swaps: bool
    following: bool
    shallow: bool
    late: bool
    moves_alone: bool


@entry
def fill_steps(neighbours: Ints, steps: Ints, queue: Ints) -> None:
    """Breadth-first search from every cell: the number of moves between all pairs."""
    for first in range(steps.shape[0]):
        queue[0], size, at = first, 1, 0
        steps[first, first] = 0
        while at < size:
            cell = queue[at]
            at += 1
            for neighbour in neighbours[cell]:
                if neighbour != NONE and steps[neighbour, first] == NONE:
                    steps[neighbour, first] = steps[cell, first] + 1
                    queue[size] = neighbour
                    size += 1


@compiled
def clear(world: World) -> None:
    """Empty the map."""
    for tick in range(world.occupant.shape[0]):
        for cell in range(world.occupant.shape[1]):
            world.occupant[tick, cell] = NONE


@compiled
def reserve(world: World, robot: int, value: int) -> None:
    """Write the robot's number, or `NONE`, wherever its plan is."""
    last = world.arrival[robot]
    for tick in range(world.entered[robot], last):
        world.occupant[tick, world.path[robot, tick]] = value
    for tick in range(last, end_of_stay(world, last)):
        world.occupant[tick, world.goal[robot]] = value


@compiled
def end_of_stay(world: World, arrival: int) -> int:
    """The tick at which a robot is gone that has arrived then."""
    return HORIZON if world.stay == FOR_EVER else min(HORIZON, arrival + world.stay + 1)


@compiled
def push(world: World, tick: int, cell: int, source: int, goal: int) -> None:
    """Take a node into the queue, the first time that it is reached."""
    node = tick * world.occupant.shape[1] + cell
    steps = world.steps[cell, goal]
    if steps == NONE or world.seen[node] == world.stamp[0] or tick + steps >= HORIZON:
        return
    world.seen[node] = world.stamp[0]
    world.came[node] = source
    rank = tick + steps
    if world.shallow and world.head[rank] != NONE:
        world.link[node] = NONE
        world.link[world.tail[rank]] = node
    else:
        world.link[node] = world.head[rank]
        world.head[rank] = node
        if world.link[node] != NONE:
            return
    world.tail[rank] = node


@compiled
def is_free(world: World, tick: int, cell: int) -> bool:
    """Whether nobody is in the cell at the tick; beyond the horizon nobody is anywhere."""
    return bool(tick >= HORIZON or world.occupant[tick, cell] == NONE)


@compiled
def may_move(world: World, tick: int, source: int, target: int) -> bool:
    """Whether a robot may be in the source until the tick, and in the target, another cell, from it on."""
    before, after = world.occupant[tick - 1, target], world.occupant[tick, source]
    if not world.following:
        return bool(before == NONE and after == NONE)
    return bool(world.swaps or before == NONE or before != after)


@compiled
def may_enter(world: World, tick: int, cell: int) -> bool:
    """Whether a robot may appear in the cell at the tick."""
    return is_free(world, tick, cell) and (world.following or tick == 0 or is_free(world, tick - 1, cell))


@compiled
def may_end(world: World, tick: int, goal: int) -> bool:
    """Whether a robot that has arrived at the tick finds its goal free for its stay."""
    end = end_of_stay(world, tick)
    for later in range(tick + 1, end):
        if world.occupant[later, goal] != NONE:
            return False
    return bool(world.following or is_free(world, end, goal))


@compiled
def expand(world: World, tick: int, cell: int, goal: int) -> None:
    """Reach at the tick, from a cell that is held until then, the cell itself and those around it."""
    if tick == HORIZON:
        return
    if world.occupant[tick, cell] == NONE:
        push(world, tick, cell, cell, goal)
    for neighbour in world.neighbours[cell]:
        is_open = neighbour != NONE and world.occupant[tick, neighbour] == NONE
        if is_open and may_move(world, tick, cell, int(neighbour)):
            push(world, tick, int(neighbour), cell, goal)


@compiled
def find(world: World, robot: int) -> bool:
    """Plan a robot with the earliest arrival against what is reserved; reserves nothing."""
    start, goal, release = int(world.start[robot]), int(world.goal[robot]), int(world.release[robot])
    cells = world.occupant.shape[1]
    world.arrival[robot] = NONE
    least = world.steps[start, goal]
    if least == NONE:
        return False
    world.stamp[0] += 1
    world.head[:] = NONE
    for rank in range(release + least, HORIZON):
        if (world.late or rank == release + least) and may_enter(world, rank - least, start):
            push(world, rank - least, start, NONE, goal)
        while world.head[rank] != NONE:
            node = int(world.head[rank])
            world.head[rank] = world.link[node]
            tick, cell = node // cells, node % cells
            if cell == goal and may_end(world, tick, goal):
                trace(world, robot, tick, cell)
                return True
            expand(world, tick + 1, cell, goal)
    return False


@compiled
def trace(world: World, robot: int, tick: int, cell: int) -> None:
    """Write the path that led to a node."""
    world.arrival[robot] = tick
    while cell != NONE:
        world.path[robot, tick] = cell
        world.entered[robot] = tick
        cell = int(world.came[tick * world.occupant.shape[1] + cell])
        tick -= 1


@compiled
def cost_of(world: World, robot: int) -> int:
    """The robot's actions: ticks from its release to its arrival, or its moves alone."""
    if not world.moves_alone:
        return int(world.arrival[robot] - world.release[robot])
    moves = 0
    for tick in range(world.entered[robot] + 1, world.arrival[robot] + 1):
        moves += world.path[robot, tick] != world.path[robot, tick - 1]
    return moves


@entry
def lay(world: World, robots: Ints, first: int, keeps: bool = False) -> int:
    """Empty the map, reserve the plans of the robots before `first`, and plan the others until one finds no plan.

    Returns how many have one. If it `keeps` plans, a robot that finds none keeps the one that it had, which others may
    meet; all robots have a plan before.
    """
    clear(world)
    for position in range(robots.size):
        robot = int(robots[position])
        before = world.arrival[robot]
        if position >= first and not find(world, robot):
            if not keeps:
                return position
            world.arrival[robot] = before
        reserve(world, robot, robot)
    return robots.size


@entry
def total(world: World, robots: Ints) -> int:
    """The cost of these robots' plans."""
    cost = 0
    for robot in robots:
        cost += cost_of(world, int(robot))
    return cost


@entry
def best_order(world: World, members: Ints, orders: Ints, reserved: Ints, least: Ints) -> int:
    """The first of the cheapest orders in which all members find plans beside what is reserved, or `NONE`.

    `orders` (orders, members) rise lexicographically, so that one shares its beginning with the one before; `least`
    has each member's least cost. An order is left as soon as it cannot be cheaper. In the end nobody is reserved.
    """
    best, found = ALL, NONE
    held = 0  # members reserved, in the order before
    dead = 0  # the length of its beginning that is of no use; 0 if none is known
    for row in range(orders.shape[0]):
        shared = alike(orders, row)
        if 0 < dead <= shared:
            continue
        take_back(world, reserved, held, shared)
        cost, dead = plan_order(world, members, orders[row], reserved, least, min(held, shared), best)
        held = members.size if dead == 0 else dead - 1
        if dead == 0:
            best, found = cost, row
    take_back(world, reserved, held, 0)
    return found


@compiled
def alike(orders: Ints, row: int) -> int:
    """How many places at its beginning an order shares with the one before."""
    shared = 0
    while row > 0 and shared < orders.shape[1] and orders[row, shared] == orders[row - 1, shared]:
        shared += 1
    return shared


@compiled
def take_back(world: World, reserved: Ints, held: int, kept: int) -> None:
    """Keep the first robots reserved alone."""
    for position in range(kept, held):
        reserve(world, int(reserved[position]), NONE)


@compiled
def plan_order(  # noqa: PLR0913, PLR0917 - a step of `best_order`
    world: World, members: Ints, order: Ints, reserved: Ints, least: Ints, held: int, limit: int
) -> tuple[int, int]:
    """Plan the members in order, those that are `held` already left out; the cost, and 0.

    If one finds no plan, or the cost reaches the limit, the length of the beginning that shows it in place of 0.
    """
    cost = 0
    for position in range(members.size):
        member = order[position]
        cost += cost_of(world, int(members[member])) if position < held else least[member]
    for position in range(held, members.size):
        robot = int(members[order[position]])
        if not find(world, robot):
            return cost, position + 1
        cost += cost_of(world, robot) - least[order[position]]
        if cost >= limit:
            return cost, position + 1
        reserve(world, robot, robot)
        reserved[position] = robot
    return cost, 0


@entry
def nearest(world: World, trajectories: World, outside: Ints, members: Ints, both_move: bool, divisor: int) -> int:
    """The position of the robot outside that is least distant from a member.

    The distance is the mean from the earlier release to the later arrival, or while both move. The sum is divided by
    the number of ticks, by `DIFFERENCE` one less, or by `UNDIVIDED` not at all.
    """
    best, best_ticks, found = 0, 0, NONE
    for position in range(outside.size):
        for member in members:
            distance, ticks = distance_of(world, trajectories, int(outside[position]), int(member), both_move)
            if divisor != TICKS:
                ticks = max(ticks - 1, 1) if divisor == DIFFERENCE else 1
            if found == NONE or distance * best_ticks < best * ticks:
                best, best_ticks, found = distance, ticks, position
    return found


@compiled
def distance_of(world: World, trajectories: World, one: int, other: int, both_move: bool) -> tuple[int, int]:
    """The sum of the distances of two robots over the ticks, and how many these are."""
    first, last = int(min(world.release[one], world.release[other])), 0
    if both_move:
        first = int(max(world.release[one], world.release[other]))
        last = int(min(trajectories.arrival[one], trajectories.arrival[other]))
    else:
        last = int(max(trajectories.arrival[one], trajectories.arrival[other]))
    last = max(last, first)
    distance = 0
    for tick in range(first, last + 1):
        distance += world.apart[place_of(trajectories, one, tick), place_of(trajectories, other, tick)]
    return distance, last + 1 - first


@compiled
def place_of(world: World, robot: int, tick: int) -> int:
    """Where the robot is: at its start before it has entered, at its goal after its arrival."""
    if tick >= world.arrival[robot]:
        return int(world.goal[robot])
    return int(world.path[robot, tick] if tick >= world.entered[robot] else world.start[robot])
