"""The bound of one part of a search by branching (`carp_optimum.branching.branching`), compiled.

Robots pay prices, as in `carp_optimum.lagrangian.state`: a row is a resource, or a move and the stays before it, at a
tick. The bound is the sum of the cheapest ways, less all prices. As it takes microseconds, parts are bounded by the
thousand; so only what is alive is looked at, in arrays that are made for each part.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimum.branching.arrays import ENDLESS, LAST, LATE, SCALE, STEPS, WORK, Part, part_at, rows_of_tick
from carp_optimum.branching.choices import settle

UNIT = 64  # of a course
KEPT, KEPT_BITS = 15, 4  # of the course before, by its sixteenths
LESS_BITS = 2  # rows of moves take a quarter of the step, as in `carp_optimum.lagrangian.price_steps`
FACTOR_BITS = 16  # of the step, a factor of the course
LEAST_AIM = SCALE // 10
PATIENCE = 30  # steps


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
    for each in range(part.rows.used.size):
        part.rows.used[each] = 0
    part.counters[LAST] = 0
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
