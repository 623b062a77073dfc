"""The cheapest way of each robot under prices and deadlines, compiled.

A table has, for each robot and delay, what an arrival with that delay costs: the ticks by the robot's weight, and the
prices of the deadlines that it keeps. Another has the least of that and of all greater delays. Every way through a node
arrives with the node's delay or more, so a node is left out where what was paid and the least of its delay are no
cheaper than the best known. The last column is for delays that no node has. The search is that of
`carp_optimum.priced_ways`, but for the tables, and for ways through the goal: to be late can pay.
"""

from typing import NamedTuple

from carp_optimized.arrays import NONE, IntTable, LongTable
from carp_optimized.compiling import compiled, entry
from carp_optimized.references import Native, dereference
from carp_optimum.priced_ways import (
    ENDLESS,
    Market,
    add_up,
    begin,
    count_way,
    duration_of,
    further_price,
    goal_price,
    market_at,
    move_between,
    move_price,
    place_after,
    reach,
    stay_price,
    take_way,
)


class Charges(NamedTuple):
    """Costs with deadlines: by robot and delay that of an arrival, and the least of that and of all greater delays.

    A robot that is in a resource at a tick, on its way, pays by the row of the robot and tick: `fee[row][resource]`,
    which is 0 in row 0, that of robots and ticks without claims. `place` is where the robots' ways have them at each
    tick: a resource, the number of resources for a robot that has come to its goal, and `NONE` before its release.
    """

    cost: LongTable
    least: LongTable
    row: IntTable
    fee: LongTable
    place: IntTable


charges_at = dereference(Charges)


@entry
def find_late_ways(native: Native[Market], native_charges: Native[Charges]) -> int:
    """Give each robot a cheapest way: the sum of their least priced costs, less the prices times the capacities."""
    market = market_at(native)
    charges = charges_at(native_charges)
    total = -add_up(market)
    for robot in range(market.requests.start.size):
        if market.requests.earliest[robot] != NONE:
            count_way(market, robot, -1)
            total += find_late_way(market, charges, robot)
            count_way(market, robot, 1)
    return total


@entry
def least_late_cost(native: Native[Market], native_charges: Native[Charges], robot: int) -> int:
    """The least priced cost of a robot, once the prices have been added up."""
    return find_late_way(market_at(native), charges_at(native_charges), robot)


@compiled
def find_late_way(market: Market, charges: Charges, robot: int) -> int:
    """Give the robot a cheapest way: the least priced cost of all its ways, or less where a delay has no nodes."""
    requests = market.requests
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    best = price_of_way(market, charges, robot)
    if start == requests.goal[robot]:
        at_once = goal_price(market, robot, release) + int(charges.cost[robot][0])
        if at_once < best:
            best = at_once
            market.ways.length[robot] = 1
            market.ways.resource[robot][0] = start
            market.ways.enter[robot][0] = release
    if requests.rest[robot][start] != NONE:
        best = settle_late(market, charges, robot, best)
        best = min(best, int(charges.least[robot][market.delays]))
    return best


@compiled
def fee_of(charges: Charges, robot: int, here: int, tick: int) -> int:
    """The payment of a robot that is seen in the resource at the tick, which is before the horizon."""
    return int(charges.fee[int(charges.row[robot][tick])][here])


@compiled
def price_of_stay(market: Market, charges: Charges, robot: int, here: int, enter: int, leave: int) -> int:
    """The price of a stay in [enter, leave) on the way, where the robot is seen included."""
    paid = stay_price(market, here, enter, leave)
    for tick in range(enter, min(leave, market.horizon)):
        paid += fee_of(charges, robot, here, tick)
    return paid


@compiled
def price_of_way(market: Market, charges: Charges, robot: int) -> int:
    """The priced cost of the way that the robot has; endless if it has none."""
    resources = market.ways.resource[robot]
    enters = market.ways.enter[robot]
    last = int(market.ways.length[robot]) - 1
    if last < 0:
        return ENDLESS
    paid = 0
    for visit in range(last):
        here = int(resources[visit])
        leaves = int(enters[visit + 1])
        paid += price_of_stay(market, charges, robot, here, int(enters[visit]), leaves)
        paid += move_price(market, move_between(market, here, int(resources[visit + 1])), leaves)
    arrival = int(enters[last])
    delay = arrival - int(market.requests.earliest[robot])
    return paid + goal_price(market, robot, arrival) + int(charges.cost[robot][delay])


@compiled
def settle_late(market: Market, charges: Charges, robot: int, best: int) -> int:
    """Search for a way that costs less than the best known, and take it; the least priced cost."""
    requests = market.requests
    scratch = market.scratch
    start = int(requests.start[robot])
    release = int(requests.release[robot])
    earliest = int(requests.earliest[robot])
    rest = requests.rest[robot]
    least = charges.least[robot]
    tick = release + duration_of(market, robot, start)
    delay = tick + int(rest[start]) - earliest
    if delay >= market.delays:
        return best
    pending = begin(market, robot, tick, price_of_stay(market, charges, robot, start, release, tick))
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
            if paid + int(least[tick + int(rest[here]) - earliest]) < best:
                if rest[here] == 0:  # a move from here enters the goal
                    price = price_of_arrival(market, charges, robot, here, tick, paid)
                    if price < best:
                        best = price
                        found = node
                pending += drive_on(market, charges, robot, node, tick, paid)
            slot = following
        tick += 1
    if found != NONE:
        take_way(market, robot, found)
    return best


@compiled
def drive_on(market: Market, charges: Charges, robot: int, node: int, tick: int, paid: int) -> int:
    """Wait or move from a node, also through the goal, to come late: how many new nodes are reached."""
    graph = market.graph
    rest = market.requests.rest[robot]
    earliest = int(market.requests.earliest[robot])
    waiting = market.prices.waiting[min(tick, market.horizon)]
    entering = market.prices.entering[min(tick, market.horizon)]
    fee = charges.fee[int(charges.row[robot][tick]) if tick < market.horizon else 0]
    scratch = market.scratch
    size = graph.duration.size
    here = node - (tick - int(market.requests.release[robot])) * size
    now = tick % scratch.head.size
    reached = 0
    if tick + int(rest[here]) - earliest + 1 < market.delays:
        place = place_after(scratch, now, 1)
        waited = paid + int(waiting[here]) + int(fee[here])
        reached += reach(scratch, place, place * size + here, node + size, waited, node)
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        target = int(graph.target[move])
        if rest[target] != NONE:
            ready = tick + duration_of(market, robot, target)
            delay = ready + int(rest[target]) - earliest
            if delay < market.delays:
                moved = paid + int(entering[move]) + int(fee[target])
                moved += further_price(market, target, tick + 1, ready)
                for later in range(tick + 1, min(ready, market.horizon)):
                    moved += fee_of(charges, robot, target, later)
                place = place_after(scratch, now, ready - tick)
                after = node - here + (ready - tick) * size + target
                reached += reach(scratch, place, place * size + target, after, moved, node)
    return reached


@compiled
def price_of_arrival(market: Market, charges: Charges, robot: int, here: int, tick: int, paid: int) -> int:
    """The priced cost of moving to the goal now; endless if no move leads there."""
    graph = market.graph
    goal = int(market.requests.goal[robot])
    for move in range(int(graph.first[here]), int(graph.first[here + 1])):
        if graph.target[move] == goal:
            delay = tick - int(market.requests.earliest[robot])
            arrived = paid + move_price(market, move, tick) + goal_price(market, robot, tick)
            return arrived + int(charges.cost[robot][delay])
    return ENDLESS


@entry
def see_ways(native: Native[Market], native_charges: Native[Charges]) -> None:
    """Fill in where the ways have the robots at each tick."""
    market = market_at(native)
    place = charges_at(native_charges).place
    for robot in range(market.requests.start.size):
        tick = 0
        here = NONE
        for visit in range(int(market.ways.length[robot])):
            enter = min(int(market.ways.enter[robot][visit]), market.horizon)
            while tick < enter:
                place[robot][tick] = here
                tick += 1
            here = int(market.ways.resource[robot][visit])
        if market.ways.length[robot] > 0:
            here = market.graph.duration.size
        while tick < market.horizon:
            place[robot][tick] = here
            tick += 1
