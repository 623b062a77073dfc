"""A step of all prices along the course of the rows' surplus, compiled: subgradient ascent with momentum, in ints.

The surplus of a row is how many robots more than its capacity use it; it is a subgradient of the bound. The course is
the surplus and a part of the course before. The step is Polyak's: what is still to be gained, by the course's square.

A stay counts in the row of its resource, and in those of all its groups and of all exchanges there. If each of these
took the whole step, the stay's price would change by several steps. So the rows of groups and exchanges take a smaller
step, by `LESS`, and count for as much less in the square: the gain stays the same.

Only active cells are looked at (`carp_optimum.lagrangian.state.Cells`): no price of another can change. Each function
is for the prices of constraints, or of exchanges.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimum.lagrangian.state import Dual, cells_of, change_price, dual_at
from carp_optimum.lagrangian.usage import list_cell, surplus_of_exchange

UNIT = 64  # of a course
KEPT, PARTS = 15, 16  # of the course before
LESS = 16  # the steps of the rows of exchanges and groups are smaller by this
MOST_SURPLUS = 100
LARGEST_GAIN = 1 << 34
LARGEST_PRICE = 1 << 40


@entry
def turn(native: Native[Dual], is_exchange: bool) -> int:
    """Turn the course of the prices, and leave out cells that are active no longer: the square of the course."""
    dual = dual_at(native)
    cells = cells_of(dual, is_exchange)
    kept = 0
    square = 0
    less = 0
    for k in range(int(cells.size[0])):
        cell = int(cells.active[k])
        number, tick = cell // dual.horizon, cell % dual.horizon
        row = int(cells.row[number])
        price = int(cells.price[row][tick])
        if is_exchange:
            surplus = surplus_of_exchange(dual, number, tick)
        else:
            surplus = int(dual.usage.present[number][tick]) - int(dual.graph.room[number])
        after = int(cells.course[row][tick]) * KEPT // PARTS + UNIT * max(min(surplus, MOST_SURPLUS), -MOST_SURPLUS)
        if after < 0 and price == 0:  # no price falls below 0
            after = 0
        cells.course[row][tick] = after
        if takes_less(dual, is_exchange, number):
            less += after * after
        else:
            square += after * after
        if after == 0 and price == 0 and surplus <= 0:
            cells.listed[row][tick] = 0
        else:
            cells.active[kept] = cell
            kept += 1
    cells.size[0] = kept
    return square + less // LESS


@compiled
def takes_less(dual: Dual, is_exchange: bool, number: int) -> bool:
    """Whether the row is that of a group or of an exchange."""
    return is_exchange or number >= dual.graph.duration.size


@entry
def walk(native: Native[Dual], is_exchange: bool, gain: int, square: int) -> None:
    """Change the prices along their course, of that square together with whatever else is changed, to gain so much."""
    dual = dual_at(native)
    cells = cells_of(dual, is_exchange)
    for k in range(int(cells.size[0])):
        cell = int(cells.active[k])
        number, tick = cell // dual.horizon, cell % dual.horizon
        row = int(cells.row[number])
        less = LESS if takes_less(dual, is_exchange, number) else 1
        price = int(cells.price[row][tick])
        after = price + gain * UNIT * int(cells.course[row][tick]) // (square * less)
        more = min(max(after, 0), LARGEST_PRICE) - price
        if more != 0:
            change_price(dual, is_exchange, number, tick, more)


@entry
def forget(native: Native[Dual], is_exchange: bool) -> None:
    """Set the prices and courses to 0."""
    dual = dual_at(native)
    cells = cells_of(dual, is_exchange)
    for k in range(int(cells.size[0])):
        number, tick = int(cells.active[k]) // dual.horizon, int(cells.active[k]) % dual.horizon
        row = int(cells.row[number])
        cells.course[row][tick] = 0
        change_price(dual, is_exchange, number, tick, -int(cells.price[row][tick]))


@entry
def set_price(native: Native[Dual], is_exchange: bool, cell: int, price: int) -> None:
    """Set the price of a cell that had none."""
    dual = dual_at(native)
    number, tick = cell // dual.horizon, cell % dual.horizon
    change_price(dual, is_exchange, number, tick, price)
    list_cell(dual, cells_of(dual, is_exchange), number, tick)
