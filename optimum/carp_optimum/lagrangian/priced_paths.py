"""The cheapest way of each robot under prices, compiled: a plan costs its prices, and what its arrival costs.

A node is a resource r and a tick t: the robot is in r, free to leave it at t. Its delay is what the best way through it
comes later than the earliest arrival. Every way through a node arrives with the node's delay or more, so a node is left
out where what was paid and the least of its delay are no cheaper than the best known. Ways may pass through the goal:
with deadlines to be late can pay. Nodes are settled tick by tick. They are numbered by tick and resource, and what was
paid is kept for the next ticks alone: so it stays in the processor's cache. Source: Dijkstra over the time-expanded
graph, as in `carp_verify.optimum.robot_clauses`.
"""

from carp_optimized.jit.compiling import compiled, entry, inlined
from carp_optimized.jit.references import Native
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.state import (
    Dual,
    Scratch,
    dual_at,
    duration_of,
    further_price,
    goal_price,
    move_between,
    move_price,
    stay_price,
)
from carp_optimum.lagrangian.usage import count_way

ENDLESS = 1 << 62


@entry
def find_rests(native: Native[Dual], first: int, last: int) -> None:
    """Fill `rest` and `earliest` of the robots from the first up to the last, by Dijkstra from the goals backwards."""
    dual = dual_at(native)
    requests = dual.requests
    for robot in range(first, last):
        settle_rests(dual, robot)
        start = int(requests.start[robot])
        requests.earliest[robot] = NONE
        if start == requests.goal[robot]:
            requests.earliest[robot] = int(requests.release[robot])
        elif requests.rest[robot][start] != NONE:
            ticks = duration_of(dual, robot, start) + int(requests.rest[robot][start])
            requests.earliest[robot] = int(requests.release[robot]) + ticks


@compiled
def settle_rests(dual: Dual, robot: int) -> None:
    """Fill the rests of one robot. Where all stays are alike, a heap's order is that of a queue."""
    graph = dual.graph
    rest = dual.requests.rest[robot]
    keys = dual.scratch.keys
    nodes = dual.scratch.nodes
    for here in range(graph.duration.size):
        rest[here] = NONE
    first = 0
    size = 0
    goal = int(dual.requests.goal[robot])
    for edge in range(int(graph.backward_first[goal]), int(graph.backward_first[goal + 1])):
        size = wait_for_rest(dual, size, 0, int(graph.source[edge]))
    while size > first:
        ticks = int(keys[first])
        here = int(nodes[first])
        if dual.is_even:
            first += 1
        else:
            size -= 1
            replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if rest[here] != NONE:
            continue
        rest[here] = ticks
        further = ticks + duration_of(dual, robot, here)
        for edge in range(int(graph.backward_first[here]), int(graph.backward_first[here + 1])):
            if rest[int(graph.source[edge])] == NONE:
                size = wait_for_rest(dual, size, further, int(graph.source[edge]))


@compiled
def wait_for_rest(dual: Dual, size: int, ticks: int, here: int) -> int:
    """Put a resource into the queue or heap; its new size."""
    keys, nodes = dual.scratch.keys, dual.scratch.nodes
    if dual.is_even:
        keys[size] = ticks
        nodes[size] = here
    else:
        push(keys, nodes, size, ticks, here)
    return size + 1


@entry
def find_ways(native: Native[Dual], begin: int, end: int) -> int:
    """Give the robots from one on up to another a cheapest way: the sum of their least priced costs, after `add_up`."""
    dual = dual_at(native)
    total = 0
    for robot in range(begin, end):
        if dual.requests.earliest[robot] != NONE:
            total += find_way(dual, robot)
    return total


@compiled
def find_way(dual: Dual, robot: int) -> int:
    """Give the robot a cheapest way: the least priced cost of all its ways, or less where a delay has no nodes."""
    requests = dual.requests
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    if dual.ways.length[robot] == 0 and start != requests.goal[robot]:
        take_shortest(dual, robot)
    best = way_price(dual, robot)
    if start == requests.goal[robot]:
        at_once = goal_price(dual, robot, release) + int(dual.charges.cost[robot][0])
        if at_once < best:
            best = at_once
            count_way(dual, robot, -1)
            dual.ways.length[robot] = 1
            dual.ways.resource[robot][0] = start
            dual.ways.enter[robot][0] = release
            count_way(dual, robot, 1)
    if requests.rest[robot][start] != NONE:
        least = int(dual.charges.least[robot][0])
        best = least if best > least and find_free(dual, robot) else settle(dual, robot, best)
        best = min(best, int(dual.charges.least[robot][dual.delays]))
    return best


@compiled
def take_shortest(dual: Dual, robot: int) -> None:
    """Write a way that nothing delays, as the first one: always into the resource that fewest robots use then."""
    graph, requests = dual.graph, dual.requests
    rest = requests.rest[robot]
    goal = int(requests.goal[robot])
    here = int(requests.start[robot])
    tick = int(requests.release[robot])
    visits = 0
    while here != goal:
        dual.ways.resource[robot][visits] = here
        dual.ways.enter[robot][visits] = tick
        visits += 1
        tick += duration_of(dual, robot, here)
        following = NONE
        fewest = 0
        for move in range(int(graph.first[here]), int(graph.first[here + 1])):
            target = int(graph.target[move])
            leads = rest[target] != NONE and rest[here] == rest[target] + duration_of(dual, robot, target)
            if (target == goal and rest[here] == 0) or leads:
                used = int(dual.usage.present[target][tick]) if tick < dual.horizon else 0
                if following == NONE or used < fewest:
                    following = target
                    fewest = used
        here = following
    dual.ways.resource[robot][visits] = goal
    dual.ways.enter[robot][visits] = tick
    dual.ways.length[robot] = visits + 1
    count_way(dual, robot, 1)


@compiled
def way_price(dual: Dual, robot: int) -> int:
    """The priced cost of the way that the robot has; endless if it has none."""
    resources = dual.ways.resource[robot]
    enters = dual.ways.enter[robot]
    last = int(dual.ways.length[robot]) - 1
    if last < 0:
        return ENDLESS
    paid = 0
    for visit in range(last):
        here = int(resources[visit])
        leaves = int(enters[visit + 1])
        paid += price_on_way(dual, robot, here, int(enters[visit]), leaves)
        paid += move_price(dual, move_between(dual, here, int(resources[visit + 1])), leaves)
    arrival = int(enters[last])
    delay = arrival - int(dual.requests.earliest[robot])
    return paid + goal_price(dual, robot, arrival) + int(dual.charges.cost[robot][delay])


@inlined
def fees_of(dual: Dual, robot: int, here: int, begin: int, end: int) -> int:
    """The payment of a robot that is seen in the resource at ticks in [begin, end), on its way."""
    paid = 0
    row = dual.charges.row[robot]
    for tick in range(begin, min(end, dual.horizon)):
        paid += int(dual.charges.fee[int(row[tick])][here])
    return paid


@compiled
def price_on_way(dual: Dual, robot: int, here: int, enter: int, leave: int) -> int:
    """The price of a stay in [enter, leave) on the way, where the robot is seen included."""
    return stay_price(dual, here, enter, leave) + fees_of(dual, robot, here, enter, leave)


@compiled
def find_free(dual: Dual, robot: int) -> bool:
    """Search, depth first, for a way that nothing delays and that pays nothing, and take it.

    Each resource has one tick at which such a way leaves it. Those where there is room are tried first, so that ways
    meet less often. On a large map few nodes are seen, of many that are as good.
    """
    requests, scratch, graph = dual.requests, dual.scratch, dual.graph
    start, release = int(requests.start[robot]), int(requests.release[robot])
    rest = requests.rest[robot]
    ready = release + duration_of(dual, robot, start)
    is_free = dual.charges.cost[robot][0] == dual.charges.least[robot][0]
    if not is_free or start == requests.goal[robot] or price_on_way(dual, robot, start, release, ready) > 0:
        return False
    size = graph.duration.size
    scratch.generation[0] = int(scratch.generation[0]) + scratch.parent.size
    scratch.nodes[0] = (ready - release) * size + start
    scratch.parent[int(scratch.nodes[0])] = NONE
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = int(scratch.nodes[waiting])
        here = node % size
        tick = release + node // size
        if rest[here] == 0:
            if arrival_price(dual, robot, here, tick, 0) == dual.charges.cost[robot][0]:
                take_way(dual, robot, node)
                return True
            continue
        for has_room in range(2):
            for move in range(int(graph.first[here]), int(graph.first[here + 1])):
                target = int(graph.target[move])
                ready = tick + duration_of(dual, robot, target)
                used = int(dual.usage.present[target][tick]) if tick < dual.horizon else 0
                leads = rest[target] != NONE and rest[here] == int(rest[target]) + ready - tick
                if leads and (used < graph.capacity[target]) == (has_room > 0):
                    after = (ready - release) * size + target
                    mark = int(scratch.generation[0]) + after
                    if scratch.mark[target] != mark and entry_price(dual, robot, move, tick, ready) == 0:
                        scratch.mark[target] = mark
                        scratch.parent[after] = node
                        scratch.nodes[waiting] = after
                        waiting += 1
    return False


@inlined
def entry_price(dual: Dual, robot: int, move: int, tick: int, ready: int) -> int:
    """The price of moving at the tick, and of a stay on the way until the robot is ready to leave again."""
    target = int(dual.graph.target[move])
    moving = int(dual.prices.entering[min(tick, dual.horizon)][int(dual.exchanges.row[move])])
    staying = further_price(dual, target, tick + 1, ready)
    return moving + staying + fees_of(dual, robot, target, tick, ready)


@compiled
def settle(dual: Dual, robot: int, best: int) -> int:
    """Search for a way that costs less than the best known, and take it; the least priced cost."""
    requests = dual.requests
    scratch = dual.scratch
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    earliest = int(requests.earliest[robot])
    rest = requests.rest[robot]
    least = dual.charges.least[robot]
    tick = release + duration_of(dual, robot, start)
    delay = tick + int(rest[start]) - earliest
    if delay >= dual.delays:
        return best
    size = dual.graph.duration.size
    place = tick % scratch.head.size
    paid = price_on_way(dual, robot, start, release, tick)
    scratch.generation[0] = int(scratch.generation[0]) + scratch.parent.size
    pending = reach(scratch, place, place * size + start, (tick - release) * size + start, paid, NONE)
    found = NONE
    while pending > 0:
        place = tick % scratch.head.size
        slot = int(scratch.head[place])
        scratch.head[place] = NONE
        while slot != NONE:
            pending -= 1
            here = slot - place * size
            node = (tick - release) * size + here
            paid = int(scratch.paid[slot])
            following = int(scratch.following[slot])
            if paid + int(least[tick + int(rest[here]) - earliest]) < best:
                if rest[here] == 0:  # a move from here enters the goal
                    price = arrival_price(dual, robot, here, tick, paid)
                    if price < best:
                        best = price
                        found = node
                scratch.steps[0] = int(scratch.steps[0]) + 1
                pending += leave(dual, robot, node, tick, paid)
            slot = following
        tick += 1
    if found != NONE:
        take_way(dual, robot, found)
    return best


@compiled
def place_after(scratch: Scratch, place: int, ticks: int) -> int:
    """The place of the tick that comes these ticks after one with a place; no more ticks than the longest stay."""
    after = place + ticks
    return after if after < scratch.head.size else after - scratch.head.size


@compiled
def reach(scratch: Scratch, place: int, slot: int, node: int, paid: int, parent: int) -> int:
    """Reach a node at this price; returns 1 if it was not reached before, else 0."""
    mark = int(scratch.generation[0]) + node
    if scratch.mark[slot] == mark:
        if paid < scratch.paid[slot]:
            scratch.paid[slot] = paid
            scratch.parent[node] = parent
        return 0
    scratch.mark[slot] = mark
    scratch.paid[slot] = paid
    scratch.parent[node] = parent
    scratch.following[slot] = int(scratch.head[place])
    scratch.head[place] = slot
    return 1


@compiled
def leave(dual: Dual, robot: int, node: int, tick: int, paid: int) -> int:
    """Wait or move from a node, also through the goal, to come late: how many new nodes are reached."""
    graph = dual.graph
    rest = dual.requests.rest[robot]
    earliest = int(dual.requests.earliest[robot])
    scratch = dual.scratch
    size = graph.duration.size
    here = node - (tick - int(dual.requests.release[robot])) * size
    now = tick % scratch.head.size
    reached = 0
    if tick + int(rest[here]) - earliest + 1 < dual.delays:
        place = place_after(scratch, now, 1)
        waited = paid + int(dual.prices.waiting[min(tick, dual.horizon)][int(dual.limits.row[here])])
        waited += fees_of(dual, robot, here, tick, tick + 1)
        reached += reach(scratch, place, place * size + here, node + size, waited, node)
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        target = int(graph.target[move])
        if rest[target] != NONE:
            ready = tick + duration_of(dual, robot, target)
            delay = ready + int(rest[target]) - earliest
            if delay < dual.delays:
                moved = paid + entry_price(dual, robot, move, tick, ready)
                place = place_after(scratch, now, ready - tick)
                after = node - here + (ready - tick) * size + target
                reached += reach(scratch, place, place * size + target, after, moved, node)
    return reached


@compiled
def arrival_price(dual: Dual, robot: int, here: int, tick: int, paid: int) -> int:
    """The priced cost of moving to the goal now; endless if no move leads there."""
    graph = dual.graph
    goal = int(dual.requests.goal[robot])
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        if graph.target[move] == goal:
            delay = tick - int(dual.requests.earliest[robot])
            arrived = paid + move_price(dual, move, tick) + goal_price(dual, robot, tick)
            return arrived + int(dual.charges.cost[robot][delay])
    return ENDLESS


@compiled
def begins_stay(dual: Dual, node: int) -> bool:
    """Whether the way enters the node's resource there, rather than waits in it."""
    parent = int(dual.scratch.parent[node])
    return parent == NONE or (node - parent) % dual.graph.duration.size != 0


@compiled
def tick_of(dual: Dual, robot: int, node: int) -> int:
    """The tick of a node of the robot."""
    return int(dual.requests.release[robot]) + node // dual.graph.duration.size


@compiled
def take_way(dual: Dual, robot: int, last: int) -> None:
    """Write the way that arrives from the node."""
    count_way(dual, robot, -1)
    resources = dual.ways.resource[robot]
    enters = dual.ways.enter[robot]
    parent = dual.scratch.parent
    visits = 1
    node = last
    while node != NONE:
        visits += 1 if begins_stay(dual, node) else 0
        node = int(parent[node])
    dual.ways.length[robot] = visits
    resources[visits - 1] = int(dual.requests.goal[robot])
    enters[visits - 1] = tick_of(dual, robot, last)
    visit = visits - 2
    node = last
    while node != NONE:
        if begins_stay(dual, node):
            here = node % dual.graph.duration.size
            resources[visit] = here
            enters[visit] = tick_of(dual, robot, node) - duration_of(dual, robot, here)
            visit -= 1
        node = int(parent[node])
    count_way(dual, robot, 1)


@entry
def see_ways(native: Native[Dual]) -> None:
    """Fill in where the ways have the robots at each tick."""
    dual = dual_at(native)
    place = dual.charges.place
    for robot in range(dual.requests.start.size):
        tick = 0
        here = NONE
        for visit in range(int(dual.ways.length[robot])):
            enter = min(int(dual.ways.enter[robot][visit]), dual.horizon)
            while tick < enter:
                place[robot][tick] = here
                tick += 1
            is_last = visit + 1 == dual.ways.length[robot]
            here = dual.graph.duration.size if is_last else int(dual.ways.resource[robot][visit])
        while tick < dual.horizon:
            place[robot][tick] = here
            tick += 1
