"""The cheapest way of each robot under prices, compiled: a plan costs its robot's weight for each tick, and its prices.

A robot pays for each tick that it is in a resource (`joint/capacity`), and for each exchange row (r, s, t) if at t it
moves from r to s or from s to r, or is in r just before t and at t (`joint/exchange`). Prices end at the horizon.

A node is a resource r and a tick t: the robot is in r, free to leave it at t. Its delay is what the best way through it
comes later than the earliest arrival. Nodes are settled tick by tick, and one through which no way is cheaper than the
best known is left out. They are numbered by tick and resource, and what was paid is kept for the next ticks alone: so
it stays in the processor's cache. Source: Dijkstra over the time-expanded graph, as in `carp_verify.robot_clauses`.
"""

from typing import NamedTuple

from carp_optimized.arrays import NONE, Graph, Ints, IntTable, Longs, LongTable
from carp_optimized.compiling import compiled, entry
from carp_optimized.heap import push, replace_root
from carp_optimized.references import Native, dereference

ENDLESS = 1 << 62


class Requests(NamedTuple):
    """The robots.

    `rest[robot][r]` is the least ticks from leaving r to entering the goal, `NONE` where no way leads there;
    `earliest` is the tick at which the robot enters its goal if nothing delays it, `NONE` if it never can.
    `weight` is what a tick costs the robot.
    """

    start: Ints
    goal: Ints
    release: Ints
    pace: Ints
    earliest: Longs
    rest: IntTable
    weight: Longs


class Prices(NamedTuple):
    """Prices by resource and tick, and by move (r, s) and tick for the exchange row (r, s).

    `back[move]` is the number of the move back, or `NONE`. `stay[r][t]` is the sum of the prices of r before t, and
    `across[r][t]` that of all exchange rows of r. A search goes from tick to tick, so what a robot pays at a tick lies
    together: `waiting[t][r]` for being in r just before t and at t, `entering[t][move]` for moving at t, with the price
    of the target at t. From the horizon on these are 0.
    """

    resource: LongTable
    exchange: LongTable
    back: Ints
    stay: LongTable
    across: LongTable
    waiting: LongTable
    entering: LongTable


class Ways(NamedTuple):
    """The way of each robot: `length` visits, each a resource and the tick of entering; none at first."""

    length: Ints
    resource: IntTable
    enter: IntTable


class Usage(NamedTuple):
    """The use of the ways: robots by resource and tick, by move and tick, and those in a resource before and at a tick.

    `course` and `course_of_exchange` are the direction in which the prices of the rows were changed last.
    """

    present: IntTable
    moving: IntTable
    staying: IntTable
    course: LongTable
    course_of_exchange: LongTable


class Scratch(NamedTuple):
    """The scratch of a search.

    `parent[node]` is the node before. A tick has a place: the tick modulo one more than the longest stay. A place and a
    resource are a slot, which keeps what was paid on the way to the node, the slot of the next node of the tick, and as
    `mark` the sum of the search's `generation` and the node. `head` is the first slot of each place. `keys` and `nodes`
    are a heap.
    """

    generation: Longs
    mark: Longs
    paid: Longs
    parent: Ints
    following: Ints
    head: Ints
    keys: Longs
    nodes: Ints


class Market(NamedTuple):
    """All arrays that the compiled functions read and write; nodes have delays below `delays`."""

    graph: Graph
    requests: Requests
    prices: Prices
    ways: Ways
    usage: Usage
    scratch: Scratch
    horizon: int
    delays: int
    parks: bool


market_at = dereference(Market)


@entry
def find_rests(native: Native[Market]) -> None:
    """Fill `rest` and `earliest` of all robots, by Dijkstra from the goals backwards."""
    market = market_at(native)
    requests = market.requests
    for robot in range(requests.start.size):
        settle_rests(market, robot)
        start = int(requests.start[robot])
        requests.earliest[robot] = NONE
        if start == requests.goal[robot]:
            requests.earliest[robot] = int(requests.release[robot])
        elif requests.rest[robot][start] != NONE:
            ticks = duration_of(market, robot, start) + int(requests.rest[robot][start])
            requests.earliest[robot] = int(requests.release[robot]) + ticks


@compiled
def settle_rests(market: Market, robot: int) -> None:
    """Fill the rests of one robot."""
    graph = market.graph
    rest = market.requests.rest[robot]
    keys = market.scratch.keys
    nodes = market.scratch.nodes
    for here in range(graph.duration.size):
        rest[here] = NONE
    size = 0
    goal = int(market.requests.goal[robot])
    for edge in range(int(graph.backward_first[goal]), int(graph.backward_first[goal + 1])):
        push(keys, nodes, size, 0, int(graph.source[edge]))
        size += 1
    while size > 0:
        ticks = int(keys[0])
        here = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if rest[here] != NONE:
            continue
        rest[here] = ticks
        further = ticks + duration_of(market, robot, here)
        for edge in range(int(graph.backward_first[here]), int(graph.backward_first[here + 1])):
            if rest[int(graph.source[edge])] == NONE:
                push(keys, nodes, size, further, int(graph.source[edge]))
                size += 1


@compiled
def duration_of(market: Market, robot: int, resource: int) -> int:
    """The least ticks of the robot's stay."""
    return int(market.requests.pace[robot]) * int(market.graph.duration[resource])


@compiled
def stay_price(market: Market, resource: int, enter: int, leave: int) -> int:
    """The price of a stay in [enter, leave)."""
    stay = market.prices.stay[resource]
    across = market.prices.across[resource]
    end = min(leave, market.horizon)
    present = int(stay[end]) - int(stay[min(enter, end)])
    return present + int(across[end]) - int(across[min(enter + 1, end)])


@compiled
def further_price(market: Market, resource: int, tick: int, leave: int) -> int:
    """The price of staying in [tick, leave) in a resource that the robot is in just before the tick, and later ones."""
    if tick >= leave:
        return 0
    stay = market.prices.stay[resource]
    across = market.prices.across[resource]
    begin = min(tick, market.horizon)
    end = min(leave, market.horizon)
    return int(stay[end]) - int(stay[begin]) + int(across[end]) - int(across[begin])


@compiled
def move_price(market: Market, move: int, tick: int) -> int:
    """The price of a move at the tick."""
    back = int(market.prices.back[move])
    if tick >= market.horizon or back == NONE:
        return 0
    return int(market.prices.exchange[move][tick]) + int(market.prices.exchange[back][tick])


@compiled
def goal_price(market: Market, robot: int, tick: int) -> int:
    """The price of the last stay of a robot that arrives at the tick."""
    goal = int(market.requests.goal[robot])
    leave = market.horizon if market.parks else tick + duration_of(market, robot, goal)
    return stay_price(market, goal, tick, leave)


@compiled
def move_between(market: Market, source: int, target: int) -> int:
    """The number of the move."""
    move = int(market.graph.first[source])
    while market.graph.target[move] != target:
        move += 1
    return move


@compiled
def way_price(market: Market, robot: int) -> int:
    """The priced cost of the way that the robot has; endless if it has none."""
    resources = market.ways.resource[robot]
    enters = market.ways.enter[robot]
    last = int(market.ways.length[robot]) - 1
    if last < 0:
        return ENDLESS
    paid = 0
    for visit in range(last):
        here = int(resources[visit])
        leave = int(enters[visit + 1])
        paid += stay_price(market, here, int(enters[visit]), leave)
        paid += move_price(market, move_between(market, here, int(resources[visit + 1])), leave)
    arrival = int(enters[last])
    ticks = arrival - int(market.requests.release[robot])
    return paid + goal_price(market, robot, arrival) + int(market.requests.weight[robot]) * ticks


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
def begin(market: Market, robot: int, tick: int, paid: int) -> int:
    """Begin a search at the node of the robot's start; returns 1."""
    scratch = market.scratch
    size = market.graph.duration.size
    start = int(market.requests.start[robot])
    place = tick % scratch.head.size
    node = (tick - int(market.requests.release[robot])) * size + start
    scratch.generation[0] = int(scratch.generation[0]) + scratch.parent.size
    return reach(scratch, place, place * size + start, node, paid, NONE)


@compiled
def place_after(scratch: Scratch, place: int, ticks: int) -> int:
    """The place of the tick that comes these ticks after one with a place; no more ticks than the longest stay."""
    after = place + ticks
    return after if after < scratch.head.size else after - scratch.head.size


@compiled
def find_way(market: Market, robot: int) -> int:
    """Give the robot a cheapest way: the least priced cost of all its ways.

    It is less if a way of a delay that no node has would be cheaper, were it free of prices.
    """
    requests = market.requests
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    best = way_price(market, robot)
    if start == requests.goal[robot]:
        at_once = goal_price(market, robot, release)
        if at_once < best:
            best = at_once
            market.ways.length[robot] = 1
            market.ways.resource[robot][0] = start
            market.ways.enter[robot][0] = release
    if requests.rest[robot][start] != NONE and (market.parks or start != requests.goal[robot]):
        best = settle(market, robot, best)
        late = int(requests.earliest[robot]) - release + market.delays
        best = min(best, int(requests.weight[robot]) * late)
    return best


@compiled
def settle(market: Market, robot: int, best: int) -> int:
    """Search for a way that costs less than the best known, and take it; the least priced cost."""
    requests = market.requests
    scratch = market.scratch
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    weight = int(requests.weight[robot])
    rest = requests.rest[robot]
    tick = release + duration_of(market, robot, start)
    delay = tick + int(rest[start]) - int(requests.earliest[robot])
    if delay >= market.delays:
        return best
    pending = begin(market, robot, tick, stay_price(market, start, release, tick))
    size = market.graph.duration.size
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
            if paid + weight * (tick + int(rest[here]) - release) < best:
                if rest[here] == 0:  # a move from here enters the goal
                    price = arrival_price(market, robot, here, tick, paid)
                    if price < best:
                        best = price
                        found = node
                pending += leave(market, robot, node, tick, paid)
            slot = following
        tick += 1
    if found != NONE:
        take_way(market, robot, found)
    return best


@compiled
def arrival_price(market: Market, robot: int, here: int, tick: int, paid: int) -> int:
    """The priced cost of moving to the goal now; endless if no move leads there."""
    graph = market.graph
    goal = int(market.requests.goal[robot])
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        if graph.target[move] == goal:
            ticks = tick - int(market.requests.release[robot])
            arrived = paid + move_price(market, move, tick) + goal_price(market, robot, tick)
            return arrived + int(market.requests.weight[robot]) * ticks
    return ENDLESS


@compiled
def leave(market: Market, robot: int, node: int, tick: int, paid: int) -> int:
    """Wait or move from a node: how many nodes are reached that were not before."""
    graph = market.graph
    rest = market.requests.rest[robot]
    earliest = int(market.requests.earliest[robot])
    scratch = market.scratch
    goal = int(market.requests.goal[robot])
    waiting = market.prices.waiting[min(tick, market.horizon)]
    entering = market.prices.entering[min(tick, market.horizon)]
    size = graph.duration.size
    here = node - (tick - int(market.requests.release[robot])) * size
    now = tick % scratch.head.size
    reached = 0
    if tick + int(rest[here]) - earliest + 1 < market.delays:
        place = place_after(scratch, now, 1)
        reached += reach(scratch, place, place * size + here, node + size, paid + int(waiting[here]), node)
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        target = int(graph.target[move])
        if rest[target] != NONE and (market.parks or target != goal):
            ready = tick + duration_of(market, robot, target)
            delay = ready + int(rest[target]) - earliest
            if delay < market.delays:
                moved = paid + int(entering[move]) + further_price(market, target, tick + 1, ready)
                place = place_after(scratch, now, ready - tick)
                later = node - here + (ready - tick) * size + target
                reached += reach(scratch, place, place * size + target, later, moved, node)
    return reached


@compiled
def begins_stay(market: Market, node: int) -> bool:
    """Whether the way enters the node's resource there, rather than waits in it."""
    parent = int(market.scratch.parent[node])
    return parent == NONE or (node - parent) % market.graph.duration.size != 0


@compiled
def tick_of(market: Market, robot: int, node: int) -> int:
    """The tick of a node of the robot."""
    return int(market.requests.release[robot]) + node // market.graph.duration.size


@compiled
def take_way(market: Market, robot: int, last: int) -> None:
    """Write the way that arrives from the node."""
    resources = market.ways.resource[robot]
    enters = market.ways.enter[robot]
    parent = market.scratch.parent
    visits = 1
    node = last
    while node != NONE:
        visits += 1 if begins_stay(market, node) else 0
        node = int(parent[node])
    market.ways.length[robot] = visits
    resources[visits - 1] = int(market.requests.goal[robot])
    enters[visits - 1] = tick_of(market, robot, last)
    visit = visits - 2
    node = last
    while node != NONE:
        if begins_stay(market, node):
            here = node % market.graph.duration.size
            resources[visit] = here
            enters[visit] = tick_of(market, robot, node) - duration_of(market, robot, here)
            visit -= 1
        node = int(parent[node])


@compiled
def count_way(market: Market, robot: int, sign: int) -> None:
    """Add what the robot's way uses, or take it off again."""
    usage = market.usage
    resources = market.ways.resource[robot]
    enters = market.ways.enter[robot]
    last = int(market.ways.length[robot]) - 1
    for visit in range(last + 1):
        here = int(resources[visit])
        enter = int(enters[visit])
        end = market.horizon
        if visit < last:
            end = int(enters[visit + 1])
            if end < market.horizon:
                moving = usage.moving[move_between(market, here, int(resources[visit + 1]))]
                moving[end] = int(moving[end]) + sign
        elif not market.parks:
            end = enter + duration_of(market, robot, here)
        present = usage.present[here]
        staying = usage.staying[here]
        for tick in range(enter, min(end, market.horizon)):
            present[tick] = int(present[tick]) + sign
            if tick > enter:
                staying[tick] = int(staying[tick]) + sign


@entry
def find_ways(native: Native[Market]) -> int:
    """Give each robot a cheapest way: the sum of their least priced costs, less the prices times the capacities."""
    market = market_at(native)
    total = -add_up(market)
    for robot in range(market.requests.start.size):
        if market.requests.earliest[robot] != NONE:
            count_way(market, robot, -1)
            total += find_way(market, robot)
            count_way(market, robot, 1)
    return total


@entry
def least_cost(native: Native[Market], robot: int) -> int:
    """The least priced cost of a robot, once the prices have been added up."""
    return find_way(market_at(native), robot)


@compiled
def add_up(market: Market) -> int:
    """Make the sums of the prices: the sum of all prices times their capacities."""
    graph = market.graph
    worth = 0
    for here in range(graph.duration.size):
        stay = market.prices.stay[here]
        across = market.prices.across[here]
        price = market.prices.resource[here]
        for tick in range(market.horizon):
            of_rows = 0
            for move in range(int(graph.first[here]), int(graph.first[here + 1])):
                of_rows += int(market.prices.exchange[move][tick])
            across[tick + 1] = int(across[tick]) + of_rows
            stay[tick + 1] = int(stay[tick]) + int(price[tick])
            market.prices.waiting[tick][here] = int(price[tick]) + of_rows
            for move in range(int(graph.first[here]), int(graph.first[here + 1])):
                target = int(graph.target[move])
                paid = move_price(market, move, tick) + int(market.prices.resource[target][tick])
                market.prices.entering[tick][move] = paid
        worth += (int(stay[market.horizon]) + int(across[market.horizon])) * int(graph.capacity[here])
    return worth
