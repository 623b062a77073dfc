"""What the robots' ways use, counted compiled, and the cells that become active by it.

Rows where robots have not met yet are not counted. They are asked for (`met`) when a way exceeds a capacity, or when it
moves between two resources into which another may have moved the other way. No other exchange row has a surplus while
no capacity is exceeded: of more robots than the capacity of r that stay in r, leave it for s or come from there, those
who leave and stay are in r just before the tick, and those who come and stay are in r at it.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.state import Cells, Dual, dual_at, duration_of, move_between


@entry
def count_ways(native: Native[Dual]) -> None:
    """Count all ways, after all counts were set to 0."""
    dual = dual_at(native)
    for robot in range(dual.requests.start.size):
        count_way(dual, robot, 1)


@compiled
def count_way(dual: Dual, robot: int, sign: int) -> None:
    """Add what the robot's way uses, or take it off again."""
    graph = dual.graph
    resources = dual.ways.resource[robot]
    enters = dual.ways.enter[robot]
    last = int(dual.ways.length[robot]) - 1
    for visit in range(last + 1):
        here = int(resources[visit])
        enter = int(enters[visit])
        end = dual.horizon
        if visit < last:
            end = int(enters[visit + 1])
        elif not dual.parks:
            end = enter + duration_of(dual, robot, here)
        end = min(end, dual.horizon)
        count_stay(dual, here, enter, end, sign)
        for k in range(int(graph.groups_first[here]), int(graph.groups_first[here + 1])):
            count_stay(dual, graph.duration.size + int(graph.group[k]), enter, end, sign)
        count_waiting(dual, here, enter, end, sign)
        if visit < last and enters[visit + 1] < dual.horizon:
            count_move(dual, move_between(dual, here, int(resources[visit + 1])), here, end, sign)


@compiled
def count_stay(dual: Dual, limit: int, enter: int, end: int, sign: int) -> None:
    """Count a stay in [enter, end) under a constraint."""
    present = dual.usage.present[limit]
    room = int(dual.graph.room[limit])
    for tick in range(enter, end):
        present[tick] = int(present[tick]) + sign
        if sign > 0 and present[tick] > room:
            if dual.limits.row[limit] == 0:
                meet(dual, limit)
            else:
                list_cell(dual, dual.limits, limit, tick)


@compiled
def meet(dual: Dual, limit: int) -> None:
    """Ask for a row of the constraint."""
    dual.usage.met[limit] = 1
    dual.usage.met_anew[0] = 1


@compiled
def count_waiting(dual: Dual, here: int, enter: int, end: int, sign: int) -> None:
    """Count a robot that is in the resource before and at each tick between the first and the end."""
    row = int(dual.limits.row[here])
    if row == 0:
        return
    staying = dual.usage.staying[row]
    for tick in range(enter + 1, end):
        staying[tick] = int(staying[tick]) + sign
        if sign > 0:
            for move in range(int(dual.graph.first[here]), int(dual.graph.first[here + 1])):
                look_at_exchange(dual, move, tick)


@compiled
def count_move(dual: Dual, move: int, here: int, tick: int, sign: int) -> None:
    """Count a move at the tick."""
    usage = dual.usage
    back = int(dual.prices.back[move])
    if back == NONE:
        return
    moving = usage.moving[int(dual.exchanges.row[move])]
    moving[tick] = int(moving[tick]) + sign
    if sign > 0:
        target = int(dual.graph.target[move])
        if usage.present[target][tick - 1] > 0 and usage.present[here][tick] > 0:
            for each in (here, target):
                if dual.limits.row[each] == 0:
                    meet(dual, each)
        look_at_exchange(dual, move, tick)
        look_at_exchange(dual, back, tick)


@compiled
def surplus_of_exchange(dual: Dual, move: int, tick: int) -> int:
    """How many more robots use the exchange row of a move than it has room for; the move's source has a row."""
    usage, row = dual.usage, dual.exchanges.row
    back = int(dual.prices.back[move])
    here = int(dual.graph.target[back])
    moving = int(usage.moving[int(row[move])][tick]) + int(usage.moving[int(row[back])][tick])
    return moving + int(usage.staying[int(dual.limits.row[here])][tick]) - int(dual.graph.capacity[here])


@compiled
def look_at_exchange(dual: Dual, move: int, tick: int) -> None:
    """Make the cell of an exchange active if it has a surplus."""
    back = int(dual.prices.back[move])
    if back == NONE or dual.limits.row[int(dual.graph.target[back])] == 0:
        return
    if surplus_of_exchange(dual, move, tick) > 0:
        list_cell(dual, dual.exchanges, move, tick)


@compiled
def list_cell(dual: Dual, cells: Cells, number: int, tick: int) -> None:
    """Make the cell of a constraint, or of an exchange, active."""
    listed = cells.listed[int(cells.row[number])]
    if listed[tick] == 0:
        listed[tick] = 1
        cells.active[int(cells.size[0])] = number * dual.horizon + tick
        cells.size[0] = int(cells.size[0]) + 1
