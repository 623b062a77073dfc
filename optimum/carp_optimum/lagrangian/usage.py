"""What the robots' ways use, counted compiled, and the cells that become active by it.

Rows where robots have not met yet are not counted. They are asked for (`met`) when a way exceeds a capacity, or when it
moves between two resources into which another may have moved the other way. No other exchange row has a surplus while
no capacity is exceeded: of more robots than the capacity of r that stay in r, leave it for s or come from there, those
who leave and stay are in r just before the tick, and those who come and stay are in r at it.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.state import Cells, Market, duration_of, market_at, move_between


@entry
def count_ways(native: Native[Market]) -> None:
    """Count all ways, after all counts were set to 0."""
    market = market_at(native)
    for robot in range(market.requests.start.size):
        count_way(market, robot, 1)


@compiled
def count_way(market: Market, robot: int, sign: int) -> None:
    """Add what the robot's way uses, or take it off again."""
    graph = market.graph
    resources = market.ways.resource[robot]
    enters = market.ways.enter[robot]
    last = int(market.ways.length[robot]) - 1
    for visit in range(last + 1):
        here = int(resources[visit])
        enter = int(enters[visit])
        end = market.horizon
        if visit < last:
            end = int(enters[visit + 1])
        elif not market.parks:
            end = enter + duration_of(market, robot, here)
        end = min(end, market.horizon)
        count_stay(market, here, enter, end, sign)
        for k in range(int(graph.groups_first[here]), int(graph.groups_first[here + 1])):
            count_stay(market, graph.duration.size + int(graph.group[k]), enter, end, sign)
        count_waiting(market, here, enter, end, sign)
        if visit < last and enters[visit + 1] < market.horizon:
            count_move(market, move_between(market, here, int(resources[visit + 1])), here, end, sign)


@compiled
def count_stay(market: Market, limit: int, enter: int, end: int, sign: int) -> None:
    """Count a stay in [enter, end) under a constraint."""
    present = market.usage.present[limit]
    room = int(market.graph.room[limit])
    for tick in range(enter, end):
        present[tick] = int(present[tick]) + sign
        if sign > 0 and present[tick] > room:
            if market.limits.row[limit] == 0:
                meet(market, limit)
            else:
                list_cell(market, market.limits, limit, tick)


@compiled
def meet(market: Market, limit: int) -> None:
    """Ask for a row of the constraint."""
    market.usage.met[limit] = 1
    market.usage.met_anew[0] = 1


@compiled
def count_waiting(market: Market, here: int, enter: int, end: int, sign: int) -> None:
    """Count a robot that is in the resource before and at each tick between the first and the end."""
    row = int(market.limits.row[here])
    if row == 0:
        return
    staying = market.usage.staying[row]
    for tick in range(enter + 1, end):
        staying[tick] = int(staying[tick]) + sign
        if sign > 0:
            for move in range(int(market.graph.first[here]), int(market.graph.first[here + 1])):
                look_at_exchange(market, move, tick)


@compiled
def count_move(market: Market, move: int, here: int, tick: int, sign: int) -> None:
    """Count a move at the tick."""
    usage = market.usage
    back = int(market.prices.back[move])
    if back == NONE:
        return
    moving = usage.moving[int(market.exchanges.row[move])]
    moving[tick] = int(moving[tick]) + sign
    if sign > 0:
        target = int(market.graph.target[move])
        if usage.present[target][tick - 1] > 0 and usage.present[here][tick] > 0:
            for each in (here, target):
                if market.limits.row[each] == 0:
                    meet(market, each)
        look_at_exchange(market, move, tick)
        look_at_exchange(market, back, tick)


@compiled
def surplus_of_exchange(market: Market, move: int, tick: int) -> int:
    """How many more robots use the exchange row of a move than it has room for; the move's source has a row."""
    usage, row = market.usage, market.exchanges.row
    back = int(market.prices.back[move])
    here = int(market.graph.target[back])
    moving = int(usage.moving[int(row[move])][tick]) + int(usage.moving[int(row[back])][tick])
    return moving + int(usage.staying[int(market.limits.row[here])][tick]) - int(market.graph.capacity[here])


@compiled
def look_at_exchange(market: Market, move: int, tick: int) -> None:
    """Make the cell of an exchange active if it has a surplus."""
    back = int(market.prices.back[move])
    if back == NONE or market.limits.row[int(market.graph.target[back])] == 0:
        return
    if surplus_of_exchange(market, move, tick) > 0:
        list_cell(market, market.exchanges, move, tick)


@compiled
def list_cell(market: Market, cells: Cells, number: int, tick: int) -> None:
    """Make the cell of a constraint, or of an exchange, active."""
    listed = cells.listed[int(cells.row[number])]
    if listed[tick] == 0:
        listed[tick] = 1
        cells.active[int(cells.size[0])] = number * market.horizon + tick
        cells.size[0] = int(cells.size[0]) + 1
