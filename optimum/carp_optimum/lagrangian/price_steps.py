"""A step of all prices along the course of the rows' surplus, compiled: subgradient ascent with momentum, in ints.

The surplus of a row is how many robots more than its capacity use it; it is a subgradient of the bound. The course is
the surplus and a part of the course before. The step is Polyak's: what is still to be gained, by the course's square.

A stay counts in the row of its resource, and in those of all its groups and of all exchanges there. If each of these
took the whole step, the stay's price would change by several steps. So the rows of groups and exchanges take a smaller
step, by `LESS`, and count for as much less in the square: the gain stays the same.

Only active cells are looked at (`carp_optimum.lagrangian.state.Courses`): no price of another can change.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.references import Native
from carp_optimum.lagrangian.state import Market, change_exchange, change_limit, market_at
from carp_optimum.lagrangian.usage import list_exchange, list_limit, surplus_of_exchange

UNIT = 64  # of a course
KEPT, PARTS = 15, 16  # of the course before
LESS = 16  # the steps of the rows of exchanges and groups are smaller by this
MOST_SURPLUS = 100
LARGEST_GAIN = 1 << 34
LARGEST_PRICE = 1 << 40


@entry
def turn_all(native: Native[Market]) -> int:
    """Turn the course of all prices, and leave out cells that are active no longer: the square of the course."""
    market = market_at(native)
    return turn_limits(market) + turn_exchanges(market)


@compiled
def turn_limits(market: Market) -> int:
    """Turn the course of the prices of constraints; its square."""
    courses, graph = market.courses, market.graph
    kept = 0
    square = 0
    of_groups = 0
    for k in range(int(courses.size[0])):
        cell = int(courses.limits[k])
        limit, tick = cell // market.horizon, cell % market.horizon
        row = int(market.prices.row[limit])
        price = int(market.prices.limit[row][tick])
        surplus = int(market.usage.present[limit][tick]) - int(graph.room[limit])
        after = turned(int(courses.limit[row][tick]), surplus, price)
        courses.limit[row][tick] = after
        if limit < graph.duration.size:
            square += after * after
        else:
            of_groups += after * after
        if after == 0 and price == 0 and surplus <= 0:
            courses.listed[row][tick] = 0
        else:
            courses.limits[kept] = cell
            kept += 1
    courses.size[0] = kept
    return square + of_groups // LESS


@compiled
def turn_exchanges(market: Market) -> int:
    """Turn the course of the prices of exchanges; its square."""
    courses = market.courses
    kept = 0
    square = 0
    for k in range(int(courses.size[1])):
        cell = int(courses.exchanges[k])
        move, tick = cell // market.horizon, cell % market.horizon
        entry = int(market.prices.entry[move])
        price = int(market.prices.exchange[entry][tick])
        surplus = surplus_of_exchange(market, move, tick)
        after = turned(int(courses.exchange[entry][tick]), surplus, price)
        courses.exchange[entry][tick] = after
        square += after * after
        if after == 0 and price == 0 and surplus <= 0:
            courses.listed_exchange[entry][tick] = 0
        else:
            courses.exchanges[kept] = cell
            kept += 1
    courses.size[1] = kept
    return square // LESS


@compiled
def turned(course: int, surplus: int, price: int) -> int:
    """The course of a row; one whose price is 0 does not fall."""
    after = course * KEPT // PARTS + UNIT * max(min(surplus, MOST_SURPLUS), -MOST_SURPLUS)
    return 0 if after < 0 and price == 0 else after


@entry
def walk_all(native: Native[Market], gain: int, square: int) -> None:
    """Change all prices along their course, of that square together with whatever else is changed, to gain so much."""
    market = market_at(native)
    courses, prices = market.courses, market.prices
    for k in range(int(courses.size[0])):
        cell = int(courses.limits[k])
        limit, tick = cell // market.horizon, cell % market.horizon
        row = int(prices.row[limit])
        less = 1 if limit < market.graph.duration.size else LESS
        more = change(int(prices.limit[row][tick]), int(courses.limit[row][tick]), gain, square * less)
        if more != 0:
            change_limit(market, limit, tick, more)
    for k in range(int(courses.size[1])):
        cell = int(courses.exchanges[k])
        move, tick = cell // market.horizon, cell % market.horizon
        entry = int(prices.entry[move])
        more = change(int(prices.exchange[entry][tick]), int(courses.exchange[entry][tick]), gain, square * LESS)
        if more != 0:
            change_exchange(market, move, tick, more)


@compiled
def change(price: int, course: int, gain: int, square: int) -> int:
    """How much a price rises along its course."""
    return min(max(price + gain * UNIT * course // square, 0), LARGEST_PRICE) - price


@entry
def forget_prices(native: Native[Market]) -> None:
    """Set all prices and courses to 0."""
    market = market_at(native)
    courses, prices = market.courses, market.prices
    for k in range(int(courses.size[0])):
        cell = int(courses.limits[k])
        limit, tick = cell // market.horizon, cell % market.horizon
        row = int(prices.row[limit])
        courses.limit[row][tick] = 0
        change_limit(market, limit, tick, -int(prices.limit[row][tick]))
    for k in range(int(courses.size[1])):
        cell = int(courses.exchanges[k])
        move, tick = cell // market.horizon, cell % market.horizon
        entry = int(prices.entry[move])
        courses.exchange[entry][tick] = 0
        change_exchange(market, move, tick, -int(prices.exchange[entry][tick]))


@entry
def price_limit(native: Native[Market], cell: int, price: int) -> None:
    """Set the price of a constraint's cell that had none."""
    market = market_at(native)
    change_limit(market, cell // market.horizon, cell % market.horizon, price)
    list_limit(market, cell // market.horizon, cell % market.horizon)


@entry
def price_exchange(native: Native[Market], cell: int, price: int) -> None:
    """Set the price of an exchange's cell that had none."""
    market = market_at(native)
    change_exchange(market, cell // market.horizon, cell % market.horizon, price)
    list_exchange(market, cell // market.horizon, cell % market.horizon)
