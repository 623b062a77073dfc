"""The arrays of the search for prices, and what they say: what robots pay for stays, moves and arrivals, compiled.

A robot pays for each tick that it is in a resource (`joint/capacity`) or a group (`joint/group`): these are the
constraints, resources first, numbered as in `Graph`. It pays for each exchange row (r, s, t) if at t it
moves from r to s or from s to r, or is in r just before t and at t (`joint/exchange`). Prices end at the horizon.
"""

from typing import NamedTuple

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, IntTable, Longs, LongTable, ShortTable
from carp_optimized.jit.references import Native, dereference
from carp_optimized.state.arrays import NONE, Graph


class Requests(NamedTuple):
    """The robots.

    `rest[robot][r]` is the least ticks from leaving r to entering the goal, `NONE` where no way leads there;
    `earliest` is the tick at which the robot enters its goal if nothing delays it, `NONE` if it never can.
    """

    start: Ints
    goal: Ints
    release: Ints
    pace: Ints
    earliest: Longs
    rest: IntTable


class Cells(NamedTuple):
    """Prices by constraint and tick, or by move (r, s) and tick for the exchange row (r, s).

    Tables have rows only for places where robots have met: `row` has that of each constraint or move, 0 for all others.
    Row 0 is without prices. `course` is the direction in which prices were changed last. A cell is the number of a
    constraint or move by the horizon, and a tick. The first `size[0]` of `active` are active, and just these are marked
    as `listed`: of no other cell is the price, the course or the surplus above 0.
    """

    row: Ints
    price: LongTable
    course: LongTable
    listed: ShortTable
    active: Longs
    size: Longs


class Prices(NamedTuple):
    """What robots pay, by the prices in `Cells`.

    `back[move]` is the number of the move back, or `NONE`, and the moves to r are `into[backward_first[r]:...]`.

    `present` is the price of a resource with those of its groups, and `crossing` that of all exchange rows of it.
    `stay[row][t]` and `across[row][t]` are the sums of these before t, up to date but for ticks from `changed[row]` on.
    A search goes from tick to tick, so what a robot pays at a tick lies together: `waiting[t]` for being in r just
    before t and at t, by row, `entering[t]` for moving at t, by the move's row, with the price of the target at t. From
    the horizon on these are 0. `worth[0]` is the sum of all prices times their capacities.
    """

    back: Ints
    into: Ints
    present: LongTable
    crossing: LongTable
    stay: LongTable
    across: LongTable
    changed: Ints
    waiting: LongTable
    entering: LongTable
    worth: Longs


class Charges(NamedTuple):
    """The costs of delays, and the fees and places of robots that are seen.

    `cost[robot][delay]` is what an arrival costs: the ticks by the scale, and the prices of the deadlines that
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
    """The use of the ways: robots by constraint and tick, by move and tick, those in a row before and at a tick.

    `met` is 1 for constraints without a row where robots have met, and `met_anew[0]` if there is one.
    """

    present: IntTable
    moving: IntTable
    staying: IntTable
    met: Ints
    met_anew: Longs


class Scratch(NamedTuple):
    """The scratch of a search.

    `parent[node]` is the node before. A tick has a place: the tick modulo one more than the longest stay. A place and a
    resource are a slot, which keeps what was paid on the way to the node, the slot of the next node of the tick, and as
    `mark` the sum of the search's `generation` and the node. `head` is the first slot of each place. `keys` and `nodes`
    are a heap. `steps` counts the nodes that were left.
    """

    generation: Longs
    mark: Longs
    paid: Longs
    parent: Ints
    following: Ints
    head: Ints
    keys: Longs
    nodes: Ints
    steps: Longs


class Dual(NamedTuple):
    """The Lagrangian dual: all arrays that the compiled functions read and write; nodes have delays below `delays`.

    It is even if all stays of a robot take equally long.
    """

    graph: Graph
    requests: Requests
    limits: Cells
    exchanges: Cells
    prices: Prices
    charges: Charges
    ways: Ways
    usage: Usage
    scratch: Scratch
    horizon: int
    delays: int
    parks: bool
    is_even: bool


dual_at = dereference(Dual)


@compiled
def duration_of(dual: Dual, robot: int, resource: int) -> int:
    """The least ticks of the robot's stay."""
    return int(dual.requests.pace[robot]) * int(dual.graph.duration[resource])


@compiled
def stay_price(dual: Dual, resource: int, enter: int, leave: int) -> int:
    """The price of a stay in [enter, leave)."""
    stay = dual.prices.stay[int(dual.limits.row[resource])]
    at_first = int(stay[min(enter + 1, dual.horizon)]) - int(stay[min(enter, dual.horizon)])
    return at_first + further_price(dual, resource, enter + 1, leave)


@compiled
def further_price(dual: Dual, resource: int, tick: int, leave: int) -> int:
    """The price of staying in [tick, leave) in a resource that the robot is in just before the tick, and later ones."""
    if tick >= leave:
        return 0
    row = int(dual.limits.row[resource])
    stay = dual.prices.stay[row]
    across = dual.prices.across[row]
    begin = min(tick, dual.horizon)
    end = min(leave, dual.horizon)
    return int(stay[end]) - int(stay[begin]) + int(across[end]) - int(across[begin])


@compiled
def move_price(dual: Dual, move: int, tick: int) -> int:
    """The price of a move at the tick."""
    exchanges = dual.exchanges
    back = int(dual.prices.back[move])
    if tick >= dual.horizon or back == NONE:
        return 0
    return int(exchanges.price[int(exchanges.row[move])][tick]) + int(exchanges.price[int(exchanges.row[back])][tick])


@compiled
def goal_price(dual: Dual, robot: int, tick: int) -> int:
    """The price of the last stay of a robot that arrives at the tick."""
    goal = int(dual.requests.goal[robot])
    leave = dual.horizon if dual.parks else tick + duration_of(dual, robot, goal)
    return stay_price(dual, goal, tick, leave)


@compiled
def move_between(dual: Dual, source: int, target: int) -> int:
    """The number of the move."""
    move = int(dual.graph.first[source])
    while dual.graph.target[move] != target:
        move += 1
    return move


@compiled
def cells_of(dual: Dual, is_exchange: bool) -> Cells:
    """The cells of exchanges, or those of constraints."""
    return dual.exchanges if is_exchange else dual.limits


@compiled
def change_price(dual: Dual, is_exchange: bool, number: int, tick: int, more: int) -> None:
    """Raise the price of a constraint with a row, or of the exchange row of a move from a resource with a row."""
    cells = cells_of(dual, is_exchange)
    price = cells.price[int(cells.row[number])]
    price[tick] = int(price[tick]) + more
    if is_exchange:
        change_exchange(dual, number, tick, more)
        return
    graph = dual.graph
    dual.prices.worth[0] = int(dual.prices.worth[0]) + more * int(graph.room[number])
    group = number - graph.duration.size
    if group < 0:
        change_present(dual, number, tick, more)
    else:
        for k in range(int(graph.members_first[group]), int(graph.members_first[group + 1])):
            change_present(dual, int(graph.member[k]), tick, more)


@compiled
def change_present(dual: Dual, here: int, tick: int, more: int) -> None:
    """Raise what robots in the resource pay at the tick."""
    prices = dual.prices
    row = int(dual.limits.row[here])
    present = prices.present[row]
    present[tick] = int(present[tick]) + more
    change_waiting(dual, row, tick, more)
    entering = prices.entering[tick]
    for k in range(int(dual.graph.backward_first[here]), int(dual.graph.backward_first[here + 1])):
        row = int(dual.exchanges.row[int(prices.into[k])])
        entering[row] = int(entering[row]) + more


@compiled
def change_exchange(dual: Dual, move: int, tick: int, more: int) -> None:
    """Raise what robots pay that make a move or its move back at the tick, or stay in its source."""
    prices = dual.prices
    back = int(prices.back[move])
    here = int(dual.graph.target[back])
    row = int(dual.limits.row[here])
    crossing, entering = prices.crossing[row], prices.entering[tick]
    crossing[tick] = int(crossing[tick]) + more
    prices.worth[0] = int(prices.worth[0]) + more * int(dual.graph.capacity[here])
    change_waiting(dual, row, tick, more)
    for each in (move, back):
        row = int(dual.exchanges.row[each])
        entering[row] = int(entering[row]) + more


@compiled
def change_waiting(dual: Dual, row: int, tick: int, more: int) -> None:
    """Raise what robots pay that wait in the resource of the row."""
    waiting = dual.prices.waiting[tick]
    waiting[row] = int(waiting[row]) + more
    dual.prices.changed[row] = min(int(dual.prices.changed[row]), tick)


@entry
def add_up(native: Native[Dual]) -> int:
    """Bring the sums of the prices up to date: the sum of all prices times their capacities."""
    dual = dual_at(native)
    prices = dual.prices
    for row in range(prices.changed.size):
        if prices.changed[row] < dual.horizon:
            stay, across = prices.stay[row], prices.across[row]
            present, crossing = prices.present[row], prices.crossing[row]
            for tick in range(int(prices.changed[row]), dual.horizon):
                stay[tick + 1] = int(stay[tick]) + int(present[tick])
                across[tick + 1] = int(across[tick]) + int(crossing[tick])
            prices.changed[row] = dual.horizon
    return int(prices.worth[0])
