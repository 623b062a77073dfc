"""The arrays of the search for prices, and what they say: what robots pay for stays, moves and arrivals, compiled.

A robot pays for each tick that it is in a resource (`joint/capacity`) or a group (`joint/group`): these are the
constraints, resources first, numbered as in `Graph`. It pays for each exchange row (r, s, t) if at t it
moves from r to s or from s to r, or is in r just before t and at t (`joint/exchange`). Prices end at the horizon.
"""

from typing import NamedTuple

from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, IntTable, Longs, LongTable
from carp_optimized.jit.references import dereference
from carp_optimized.state.arrays import NONE, Graph


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
    """Prices by constraint and tick, and by move (r, s) and tick for the exchange row (r, s).

    `present[r][t]` is the price of r with those of its groups. `back[move]` is
    the number of the move back, or `NONE`. `stay[r][t]` is the sum of what is paid in r before t, and `across[r][t]`
    that of all exchange rows of r. A search goes from tick to tick, so what a robot pays at a tick lies
    together: `waiting[t][r]` for being in r just before t and at t, `entering[t][move]` for moving at t, with the price
    of the target at t. From the horizon on these are 0.
    """

    limit: LongTable
    present: LongTable
    exchange: LongTable
    back: Ints
    stay: LongTable
    across: LongTable
    waiting: LongTable
    entering: LongTable


class Charges(NamedTuple):
    """The costs of delays, and the fees and places of robots that are seen.

    `cost[robot][delay]` is what an arrival costs: the ticks by the robot's weight, and the prices of the deadlines that
    it keeps. `least` is the least of that and of all greater delays; the last column is for delays that no node has. A
    robot that is in a resource at a tick, on its way, pays by the row of the robot and tick: `fee[row][resource]`,
    which is 0 in row 0, that of robots and ticks without claims. `place` is where the robots' ways have them at each
    tick: a resource, the number of resources for a robot that has come to its goal, and `NONE` before its release.
    """

    cost: LongTable
    least: LongTable
    row: IntTable
    fee: LongTable
    place: IntTable


class Ways(NamedTuple):
    """The way of each robot: `length` visits, each a resource and the tick of entering; none at first."""

    length: Ints
    resource: IntTable
    enter: IntTable


class Usage(NamedTuple):
    """The use of the ways: robots by constraint and tick, by move and tick, those in a resource before and at a tick.

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
    charges: Charges
    ways: Ways
    usage: Usage
    scratch: Scratch
    horizon: int
    delays: int
    parks: bool


market_at = dereference(Market)


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
def price_groups(market: Market) -> int:
    """Add the prices of groups to those of their resources: their worth beyond that of resources at these prices."""
    graph = market.graph
    resources = graph.duration.size
    for here in range(resources):
        for tick in range(market.horizon):
            market.prices.present[here][tick] = market.prices.limit[here][tick]
    worth = 0
    for group in range(graph.room.size - resources):
        room = int(graph.room[resources + group])
        members = range(int(graph.members_first[group]), int(graph.members_first[group + 1]))
        for k in members:
            room -= int(graph.capacity[graph.member[k]])
        prices = market.prices.limit[resources + group]
        for tick in range(market.horizon):
            price = int(prices[tick])
            if price != 0:
                worth += price * room
                for k in members:
                    present = market.prices.present[graph.member[k]]
                    present[tick] = int(present[tick]) + price
    return worth


@compiled
def add_up(market: Market) -> int:
    """Make the sums of the prices: the sum of all prices times their capacities."""
    graph = market.graph
    worth = price_groups(market)
    for here in range(graph.duration.size):
        stay = market.prices.stay[here]
        across = market.prices.across[here]
        price = market.prices.present[here]
        for tick in range(market.horizon):
            of_rows = 0
            for move in range(int(graph.first[here]), int(graph.first[here + 1])):
                of_rows += int(market.prices.exchange[move][tick])
            across[tick + 1] = int(across[tick]) + of_rows
            stay[tick + 1] = int(stay[tick]) + int(price[tick])
            market.prices.waiting[tick][here] = int(price[tick]) + of_rows
            for move in range(int(graph.first[here]), int(graph.first[here + 1])):
                target = int(graph.target[move])
                paid = move_price(market, move, tick) + int(market.prices.present[target][tick])
                market.prices.entering[tick][move] = paid
        worth += (int(stay[market.horizon]) + int(across[market.horizon])) * int(graph.capacity[here])
    return worth
