"""The bound of one part of a search by branching (`carp_optimum.branching`), compiled.

All stays take a tick and all resources hold one robot. A node says that a robot is in a resource at a tick, and a way
of a robot is a path of nodes from its start to its goal. A part of the search is the nodes that are still `alive`.
Robots pay prices, as in `carp_optimum.market_arrays`: a row is a resource, or a move and the stays before it, at a
tick. The bound is the sum of the cheapest ways, less all prices. As it takes microseconds, parts are bounded by the
thousand; so only what is alive is looked at, in arrays that are made for each part.
"""

from typing import NamedTuple

from carp_optimized.arrays import NONE, Ints, IntTable, Longs
from carp_optimized.compiling import compiled, entry
from carp_optimized.references import Native, dereference

SCALE = 1 << 16  # parts of a tick
ENDLESS = 1 << 60
UNIT = 64  # of a course
KEPT, KEPT_BITS = 15, 4  # of the course before, by its sixteenths
LESS_BITS = 2  # rows of moves take a quarter of the step, as in `carp_optimum.price_steps`
FACTOR_BITS = 16  # of the step, a factor of the course
LEAST_AIM = SCALE // 10
PATIENCE = 30  # steps
SURE_TICKS = 3  # ticks after the start at which it is asked where robots surely are
FEW = 32  # one part of the steps: a node in fewer ways, or in nearly all, is no choice
GUESS = SCALE // 2  # what a choice raises the bound by, before it was tried
COUNTERS = 4
WORK, STEPS, LAST, LATE = range(COUNTERS)
"""The counters: rows and arcs looked at, steps, the last tick of the ways and that of the nodes."""


class Nodes(NamedTuple):
    """The graph and the nodes, by robot, tick and resource.

    Moves lead from r to `target[first[r]:first[r + 1]]`; `back[move]` is the move back, or `NONE`. `of_robot` has the
    first node of each robot, and at the end their number; `at[robot][tick * resources + resource]` is the node, or
    `NONE`. A node leads to `leads[node][0]` by waiting and to `leads[node][1 + k]` by the k-th move of its resource,
    each `NONE` where it does not; one at the goal leads nowhere. `gain` adds up what the bound rose by where the robot
    was put there, which was tried as often as `tries` says.
    """

    first: Ints
    target: Ints
    back: Ints
    goal: Ints
    of_robot: Ints
    place: Ints
    tick: Ints
    at: IntTable
    leads: IntTable
    gain: Longs
    tries: Longs


class Rows(NamedTuple):
    """Prices and use: tick by tick, first the resources and then the moves.

    `best` are the prices of the best bound. `paid` is what waiting in a resource costs at the tick, and the move.
    """

    price: Longs
    best: Longs
    paid: Longs
    used: Ints
    course: Longs


class Live(NamedTuple):
    """The nodes that are alive, in order, with their arcs; `of_robot` has the first of each robot.

    Node k has the arcs from `arc[k]` on, to the live node `to` for what `row` costs. `least` is the least that is paid
    from the node on, `before` that up to it, and `choice` the arc of the cheapest way. `often` is in how many steps the
    robot's way had it.
    """

    number: Ints
    node: Ints
    of_robot: Ints
    arc: Ints
    to: Ints
    row: Ints
    least: Longs
    before: Longs
    choice: Ints
    often: Ints


class Part(NamedTuple):
    """All arrays of a search; `alive` says of each node whether the part has it."""

    nodes: Nodes
    rows: Rows
    live: Live
    alive: Ints
    counters: Longs


part_at = dereference(Part)


@compiled
def rows_of_tick(part: Part) -> int:
    """The number of rows of a tick."""
    return part.nodes.first.size - 1 + part.nodes.target.size


@entry
def bound_part(native: Native[Part], most: int, steps: int, aim: int) -> int:
    """The bound of the part, in parts of a tick, or `ENDLESS` if it has no plans of at most this total.

    The prices climb for this number of steps, with this aim at first, or until the bound is beyond the total. If `used`
    exceeds 1 nowhere, the ways taken last are lawful plans. Nodes that no plans of at most the total have are alive no
    more.
    """
    part = part_at(native)
    if not gather(part):
        return ENDLESS
    bound = climb(part, most * SCALE, steps, aim)
    if bound > most * SCALE:
        return ENDLESS
    if is_lawful(part):
        return bound
    for row in range(part.rows.price.size):
        part.rows.price[row] = part.rows.best[row]
    add_up(part, int(part.counters[LATE]))
    find_ways(part)
    drop_dear(part, most * SCALE - bound)
    return bound if settle(part) else ENDLESS


@compiled
def gather(part: Part) -> bool:
    """Make the arrays of what is alive; false if a robot has no node."""
    nodes = part.nodes
    live = part.live
    width = rows_of_tick(part)
    resources = nodes.first.size - 1
    size = 0
    late = 0
    for robot in range(nodes.goal.size):
        live.of_robot[robot] = size
        for node in range(int(nodes.of_robot[robot]), int(nodes.of_robot[robot + 1])):
            live.number[node] = NONE
            if part.alive[node] > 0:
                live.number[node] = size
                live.node[size] = node
                live.often[size] = 0
                size += 1
                late = max(late, int(nodes.tick[node]))
        if live.of_robot[robot] == size:
            return False
    live.of_robot[nodes.goal.size] = size
    part.counters[LATE] = late
    part.counters[WORK] = int(part.counters[WORK]) + part.alive.size
    arcs = 0
    for each in range(size):
        live.arc[each] = arcs
        node = int(live.node[each])
        here = int(nodes.place[node])
        row = (int(nodes.tick[node]) + 1) * width
        leads = nodes.leads[node]
        for way in range(int(nodes.first[here + 1]) - int(nodes.first[here]) + 1):
            if leads[way] != NONE and live.number[int(leads[way])] != NONE:
                live.to[arcs] = live.number[int(leads[way])]
                live.row[arcs] = row + (here if way == 0 else resources + int(nodes.first[here]) + way - 1)
                arcs += 1
    live.arc[size] = arcs
    return True


@compiled
def climb(part: Part, limit: int, steps: int, aim: int) -> int:
    """Take steps of the prices that aim closer and closer to the best bound; it, or one beyond the limit."""
    price = part.rows.price
    kept = part.rows.best
    width = rows_of_tick(part)
    last = begin(part)
    best = -ENDLESS
    failures = 0
    for _ in range(steps):
        worth = add_up(part, last)
        total = find_ways(part)
        if total >= ENDLESS:
            return ENDLESS
        last = max(last, int(part.counters[LAST]))
        bound = total - worth
        failures = 0 if bound > best + aim // 10 else failures + 1
        if bound > best:
            best = bound
            for row in range((last + 1) * width):
                kept[row] = price[row]
        if best > limit or is_lawful(part):
            return best
        if failures >= PATIENCE:
            failures = 0
            aim //= 2
            if aim < LEAST_AIM:
                return best
            for row in range((last + 1) * width):
                price[row] = kept[row]
                part.rows.course[row] = 0
        elif not step(part, last, best + aim - bound):
            return best
    return best


@compiled
def begin(part: Part) -> int:
    """Clear the courses, and give the last tick that has a price."""
    price, best, paid, course = part.rows.price, part.rows.best, part.rows.paid, part.rows.course
    last = 0
    for row in range(price.size):
        course[row] = 0
        best[row] = 0
        paid[row] = 0
        if price[row] > 0:
            last = row
    part.counters[STEPS] = 0
    return last // rows_of_tick(part)


@compiled
def add_up(part: Part, last: int) -> int:
    """Make what waiting and moving cost, up to a tick: the sum of all prices."""
    nodes = part.nodes
    price = part.rows.price
    paid = part.rows.paid
    resources = nodes.first.size - 1
    width = rows_of_tick(part)
    worth = 0
    for tick in range(last + 1):
        row = tick * width
        for here in range(resources):
            waiting = int(price[row + here])
            for move in range(int(nodes.first[here]), int(nodes.first[here + 1])):
                of_move = int(price[row + resources + move])
                waiting += of_move
                cost = of_move + int(price[row + int(nodes.target[move])])
                if nodes.back[move] != NONE:
                    cost += int(price[row + resources + int(nodes.back[move])])
                paid[row + resources + move] = cost
            paid[row + here] = waiting
            worth += waiting
    part.counters[WORK] = int(part.counters[WORK]) + (last + 1) * width
    return worth


@compiled
def find_ways(part: Part) -> int:
    """Find the cheapest way of each robot, and its use of the rows: what they cost together."""
    nodes = part.nodes
    live = part.live
    node, arc, to, row, least = live.node, live.arc, live.to, live.row, live.least
    place, tick, paid, choice = nodes.place, nodes.tick, part.rows.paid, live.choice
    clear_use(part)
    total = 0
    for robot in range(nodes.goal.size):
        first = int(live.of_robot[robot])
        goal = int(nodes.goal[robot])
        for each in range(int(live.of_robot[robot + 1]) - 1, first - 1, -1):
            here = int(node[each])
            cheapest = int(tick[here]) * SCALE if place[here] == goal else ENDLESS
            for way in range(int(arc[each]), int(arc[each + 1])):
                cost = int(paid[int(row[way])]) + int(least[int(to[way])])
                if cost < cheapest:
                    cheapest = cost
                    choice[each] = way
            least[each] = cheapest
        if least[first] >= ENDLESS:
            return ENDLESS
        total += int(least[first]) + int(part.rows.price[int(place[int(node[first])])])
        use_way(part, robot)
    part.counters[WORK] = int(part.counters[WORK]) + int(arc[int(live.of_robot[nodes.goal.size])])
    return total


@compiled
def clear_use(part: Part) -> None:
    """Take all ways from the rows."""
    used = part.rows.used
    for row in range(used.size):
        used[row] = 0
    part.counters[LAST] = 0


@compiled
def use_way(part: Part, robot: int) -> None:
    """Count the rows that a robot's cheapest way uses."""
    nodes = part.nodes
    live = part.live
    used = part.rows.used
    resources = nodes.first.size - 1
    width = rows_of_tick(part)
    each = int(live.of_robot[robot])
    node = int(live.node[each])
    used[int(nodes.place[node])] += 1
    while nodes.place[node] != nodes.goal[robot]:
        arc = int(live.choice[each])
        begin_of_tick = (int(nodes.tick[node]) + 1) * width
        move = int(live.row[arc]) - begin_of_tick - resources
        if move < 0:
            here = int(nodes.place[node])
            for stayed in range(int(nodes.first[here]), int(nodes.first[here + 1])):
                used[begin_of_tick + resources + stayed] += 1
        else:
            used[begin_of_tick + resources + move] += 1
            if nodes.back[move] != NONE:
                used[begin_of_tick + resources + int(nodes.back[move])] += 1
        each = int(live.to[arc])
        node = int(live.node[each])
        used[begin_of_tick + int(nodes.place[node])] += 1
    part.counters[LAST] = max(int(part.counters[LAST]), int(nodes.tick[node]))


@compiled
def is_lawful(part: Part) -> bool:
    """Whether the ways use no row more than once."""
    used = part.rows.used
    for row in range((int(part.counters[LAST]) + 1) * rows_of_tick(part)):  # noqa: SIM110 - compiled
        if used[row] > 1:
            return False
    return True


@compiled
def step(part: Part, last: int, gain: int) -> bool:
    """Change the prices up to a tick along their courses, to gain so much; false if nothing is to be gained."""
    count_ways(part)
    price = part.rows.price
    course = part.rows.course
    used = part.rows.used
    resources = part.nodes.first.size - 1
    width = rows_of_tick(part)
    square = 0
    for tick in range(last + 1):
        for row in range(tick * width, (tick + 1) * width):
            turned = (int(course[row]) * KEPT >> KEPT_BITS) + UNIT * (int(used[row]) - 1)
            if turned < 0 and price[row] == 0:
                turned = 0
            course[row] = turned
            square += turned * turned if row < tick * width + resources else turned * turned >> LESS_BITS
    if square == 0:
        return False
    factor = (max(gain, 0) * UNIT << FACTOR_BITS) // square
    for tick in range(last + 1):
        for row in range(tick * width, (tick + 1) * width):
            if course[row] != 0:
                bits = FACTOR_BITS if row < tick * width + resources else FACTOR_BITS + LESS_BITS
                price[row] = max(int(price[row]) + (factor * int(course[row]) >> bits), 0)
    return True


@compiled
def count_ways(part: Part) -> None:
    """Count which nodes the ways have."""
    live = part.live
    part.counters[STEPS] = int(part.counters[STEPS]) + 1
    for robot in range(part.nodes.goal.size):
        each = int(live.of_robot[robot])
        live.often[each] += 1
        while part.nodes.place[int(live.node[each])] != part.nodes.goal[robot]:
            each = int(live.to[int(live.choice[each])])
            live.often[each] += 1


@compiled
def drop_dear(part: Part, gap: int) -> None:
    """Drop nodes through which each way costs more than the gap above the robot's cheapest one."""
    nodes = part.nodes
    live = part.live
    for robot in range(nodes.goal.size):
        first = int(live.of_robot[robot])
        end = int(live.of_robot[robot + 1])
        for each in range(first, end):
            live.before[each] = ENDLESS
        live.before[first] = 0
        cheapest = int(live.least[first])
        for each in range(first, end):
            before = int(live.before[each])
            if before + int(live.least[each]) - cheapest > gap:
                part.alive[int(live.node[each])] = 0
                continue
            for arc in range(int(live.arc[each]), int(live.arc[each + 1])):
                cost = before + int(part.rows.paid[int(live.row[arc])])
                live.before[int(live.to[arc])] = min(live.before[int(live.to[arc])], cost)


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
def choose(native: Native[Part]) -> int:
    """The robot and tick to branch on, as tick times robots plus robot; `NONE` if all robots have one way left.

    The tick is the first one at which a robot was in different places in the steps. Of the robots that have a choice
    then, it is the one whose choices are likely to leave the least to search: each is guessed to leave a part that
    falls as the square of the rise of the bound.
    """
    part = part_at(native)
    first = first_choice(part)
    last = int(part.counters[LATE])
    for offset in range(last):
        tick = (first - 1 + offset) % last + 1
        robot = choice_at(part, tick)
        if robot != NONE:
            return tick * part.nodes.goal.size + robot
    return NONE


@compiled
def choice_at(part: Part, tick: int) -> int:
    """The robot to branch on at the tick, or `NONE` if none has a choice there."""
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
def put(native: Native[Part], robot: int, tick: int, resource: int) -> bool:
    """Let the robot be in the resource at the tick, or be gone where it is `NONE`; false if the law forbids it."""
    part = part_at(native)
    nodes = part.nodes
    chosen = NONE if resource == NONE else int(nodes.at[robot][tick * (nodes.first.size - 1) + resource])
    for node in range(int(nodes.of_robot[robot]), int(nodes.of_robot[robot + 1])):
        now = int(nodes.tick[node])
        if resource == NONE:
            keep = now < tick
        elif now == tick:
            keep = node == chosen
        else:
            keep = now > tick or nodes.place[node] != nodes.goal[robot]
        if not keep:
            part.alive[node] = 0
    return settle(part)
