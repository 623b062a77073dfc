"""A step of all prices along the course of the rows' surplus, compiled: subgradient ascent with momentum, in ints.

The surplus of a row is how many robots more than its capacity use it; it is a subgradient of the bound. The course is
the surplus and a part of the course before. The step is Polyak's: what is still to be gained, by the course's square.

A stay counts in the row of its resource, and in those of all its groups and of all exchanges there. If each of these
took the whole step, the stay's price would change by several steps. So the rows of groups and exchanges take a smaller
step, by `LESS`, and count for as much less in the square: the gain stays the same.
"""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.state import Market, market_at

UNIT = 64  # of a course
KEPT, PARTS = 15, 16  # of the course before
LESS = 16  # the steps of the rows of exchanges and groups are smaller by this
MOST_SURPLUS = 100
LARGEST_GAIN = 1 << 34
LARGEST_PRICE = 1 << 40


@entry
def turn_all(native: Native[Market]) -> int:
    """Turn the course of all prices: its square."""
    market = market_at(native)
    graph = market.graph
    square = 0
    for limit in range(graph.room.size):
        course, present = market.usage.course[limit], market.usage.present[limit]
        turned_by = turn(market.prices.limit[limit], course, present, int(graph.room[limit]), market.horizon)
        square += turned_by if limit < graph.duration.size else turned_by // LESS
    for here in range(graph.duration.size):
        for move in range(int(graph.first[here]), int(graph.first[here + 1])):
            if market.prices.back[move] != NONE:
                square += turn_exchange(market, here, move) // LESS
    return square


@entry
def walk_all(native: Native[Market], gain: int, square: int) -> None:
    """Change all prices along their course, of that square together with whatever else is changed, to gain so much."""
    market = market_at(native)
    for limit in range(market.graph.room.size):
        less = 1 if limit < market.graph.duration.size else LESS
        walk(market.prices.limit[limit], market.usage.course[limit], gain, square * less, market.horizon)
    for move in range(market.graph.target.size):
        if market.prices.back[move] != NONE:
            course = market.usage.course_of_exchange[move]
            walk(market.prices.exchange[move], course, gain, square * LESS, market.horizon)


@compiled
def turned(course: int, surplus: int, price: int) -> int:
    """The course of a row; one whose price is 0 does not fall."""
    after = course * KEPT // PARTS + UNIT * max(min(surplus, MOST_SURPLUS), -MOST_SURPLUS)
    return 0 if after < 0 and price == 0 else after


@compiled
def turn(prices: Longs, course: Longs, present: Ints, capacity: int, horizon: int) -> int:
    """Turn the course of a resource's rows; its square."""
    square = 0
    for tick in range(horizon):
        after = turned(int(course[tick]), int(present[tick]) - capacity, int(prices[tick]))
        course[tick] = after
        square += after * after
    return square


@compiled
def turn_exchange(market: Market, here: int, move: int) -> int:
    """Turn the course of the exchange rows of a move from here; its square."""
    there = market.usage.moving[move]
    again = market.usage.moving[int(market.prices.back[move])]
    staying = market.usage.staying[here]
    prices = market.prices.exchange[move]
    course = market.usage.course_of_exchange[move]
    capacity = int(market.graph.capacity[here])
    square = 0
    for tick in range(market.horizon):
        surplus = int(there[tick]) + int(again[tick]) + int(staying[tick]) - capacity
        after = turned(int(course[tick]), surplus, int(prices[tick]))
        course[tick] = after
        square += after * after
    return square


@compiled
def walk(prices: Longs, course: Longs, gain: int, square: int, horizon: int) -> None:
    """Change prices along their course."""
    for tick in range(horizon):
        if course[tick] != 0:
            after = int(prices[tick]) + gain * UNIT * int(course[tick]) // square
            prices[tick] = min(max(after, 0), LARGEST_PRICE)
