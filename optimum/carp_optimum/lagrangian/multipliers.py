"""The arrays of the search for prices (`carp_optimum.lagrangian.state`), made from an instance."""

from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from carp_optimized.jit.kinds import IntTable, LongTable
from carp_optimized.state.arrays import NONE, Graph
from carp_optimum.lagrangian.state import Charges, Courses, Market, Prices, Requests, Scratch, Usage, Ways
from carp_spec import Instance, Refusal
from carp_verify.bound.rules import LARGEST_TABLE, size_fits

LARGEST_ARRAY = 100_000_000  # entries of a table of counts
LARGEST_PRICED = 15_000_000  # entries of a table of prices, of which there are about a dozen
N = TypeVar("N", bound=np.generic)


def refuse_table(path: str, what: str, entries: int, most: int = LARGEST_TABLE) -> None:
    """Raise `Refusal` if a table would be too large."""
    if not size_fits(entries, most):
        message = f"{what} must be at most {most}, the limit, and would be {entries}"
        raise Refusal("limit", path, size_fits.id, message)


def requests_of(instance: Instance, scale: int) -> Requests:
    """The robots' requests; a tick weighs `scale`, and how far they are from their goals is to be found."""
    index, robots = instance.graph.index, instance.robots
    return Requests(
        start=np.array([index[robot.start] for robot in robots], np.int32),
        goal=np.array([index[robot.goal] for robot in robots], np.int32),
        release=np.array([robot.release for robot in robots], np.int32),
        pace=np.array([robot.pace for robot in robots], np.int32),
        earliest=np.zeros(len(robots), np.int64),
        rest=np.full((len(robots), len(index)), NONE, np.int32),
        weight=np.full(len(robots), scale, np.int64),
    )


def market_of(instance: Instance, graph: Graph, requests: Requests, longest: int) -> Market:
    """A market without ticks."""
    empty = np.zeros((0, 0), np.int32)
    wide = np.zeros((0, 0), np.int64)
    short = np.zeros((0, 0), np.int16)
    edges = graph.target.size
    scratch = Scratch(
        generation=np.zeros(1, np.int64),
        mark=np.zeros(0, np.int64),
        paid=np.zeros(0, np.int64),
        parent=np.zeros(0, np.int32),
        following=np.zeros(0, np.int32),
        head=np.full(longest + 1, NONE, np.int32),
        keys=np.zeros(edges + 1, np.int64),
        nodes=np.zeros(edges + 1, np.int32),
        steps=np.zeros(1, np.int64),
    )
    back = moves_back(instance)
    prices = Prices(
        row=np.zeros(graph.room.size, np.int32),
        entry=np.zeros(edges, np.int32),
        back=np.array([back.get(move, NONE) for move in range(edges)], np.int32),
        into=np.argsort(graph.target, kind="stable").astype(np.int32),
        limit=wide,
        exchange=wide,
        present=wide,
        crossing=wide,
        stay=wide,
        across=wide,
        changed=np.zeros(0, np.int32),
        waiting=wide,
        entering=wide,
        worth=np.zeros(1, np.int64),
    )
    usage = Usage(empty, empty, empty, np.zeros(graph.room.size, np.int32), np.zeros(1, np.int64))
    courses = Courses(wide, wide, short, short, np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(2, np.int64))
    ways = Ways(np.zeros(0, np.int32), empty, empty)
    charges = Charges(wide, wide, empty, wide, empty)
    is_even = bool((graph.duration == graph.duration[:1]).all())
    return Market(
        graph, requests, prices, charges, ways, usage, courses, scratch, 0, 1, instance.after_goal == "park", is_even
    )


def moves_back(instance: Instance) -> Mapping[int, int]:
    """For each move that has a move back, the number of that."""
    moves = [(source, target) for source in instance.graph.index for target in instance.graph.successors[source]]
    number = {move: position for position, move in enumerate(moves)}
    return {
        position: number[target, source] for (source, target), position in number.items() if (target, source) in number
    }


def sized(market: Market, horizon: int, delays: int) -> Market:
    """The market with tables for this many ticks and delays, and no rows."""
    requests, graph = market.requests, market.graph
    robots, resources = requests.start.size, graph.duration.size
    ticks = int((requests.earliest - requests.release).max(initial=0)) + delays
    visits = ticks // int(graph.duration.min(initial=1)) + 2
    refuse_table("$.robots", "robots times the visits of a plan", robots * visits, LARGEST_ARRAY)
    slots = resources * market.scratch.head.size
    market = market._replace(
        charges=charges_of(np.zeros((robots, horizon), np.int32), np.zeros((1, resources), np.int64), delays),
        ways=Ways(
            np.zeros(robots, np.int32), np.zeros((robots, visits), np.int32), np.zeros((robots, visits), np.int32)
        ),
        usage=market.usage._replace(present=np.zeros((graph.room.size, horizon), np.int32)),
        scratch=market.scratch._replace(
            mark=np.zeros(slots, np.int64),
            paid=np.zeros(slots, np.int64),
            parent=np.zeros(resources * ticks, np.int32),
            following=np.zeros(slots, np.int32),
        ),
        horizon=horizon,
        delays=delays,
    )
    return with_room(market, 1, 1)


def with_rows(market: Market, constraints: Sequence[int]) -> Market:
    """The market with rows for these constraints without one, and entries for the moves of their resources.

    There are no more rows once the tables would be too large.
    """
    row, entry = market.prices.row, market.prices.entry
    graph = market.graph
    rows, entries = int(row.max(initial=0)) + 1, int(entry.max(initial=0)) + 1
    for constraint in constraints:
        moves: list[int] = []
        if constraint < graph.duration.size:
            leaving = range(graph.first[constraint], graph.first[constraint + 1])
            coming = market.prices.into[graph.backward_first[constraint] : graph.backward_first[constraint + 1]]
            moves = [move for move in (*leaving, *coming.tolist()) if entry[move] == 0]
        if max(rows + 1, entries + len(moves)) * market.horizon > LARGEST_PRICED:
            break
        row[constraint] = rows
        rows += 1
        entry[np.array(moves, np.int64)] = range(entries, entries + len(moves))
        entries += len(moves)
    rows_there, entries_there = len(market.prices.limit), len(market.prices.exchange)
    if rows <= rows_there and entries <= entries_there:
        return market
    most = LARGEST_PRICED // max(market.horizon, 1)
    return with_room(market, max(rows, min(2 * rows_there, most)), max(entries, min(2 * entries_there, most)))


def with_room(market: Market, rows: int, entries: int) -> Market:
    """The market with tables for so many rows and entries, which are no fewer than before."""
    horizon = market.horizon
    prices, usage, courses = market.prices, market.usage, market.courses
    return market._replace(
        prices=prices._replace(
            limit=larger(prices.limit, rows, horizon),
            present=larger(prices.present, rows, horizon),
            crossing=larger(prices.crossing, rows, horizon),
            stay=larger(prices.stay, rows, horizon + 1),
            across=larger(prices.across, rows, horizon + 1),
            changed=np.concatenate([prices.changed, np.full(rows - prices.changed.size, horizon, np.int32)]),
            waiting=larger(prices.waiting, horizon + 1, rows),
            exchange=larger(prices.exchange, entries, horizon),
            entering=larger(prices.entering, horizon + 1, entries),
        ),
        usage=usage._replace(
            moving=larger(usage.moving, entries, horizon), staying=larger(usage.staying, rows, horizon)
        ),
        courses=courses._replace(
            limit=larger(courses.limit, rows, horizon),
            listed=larger(courses.listed, rows, horizon),
            limits=larger(courses.limits, rows * horizon),
            exchange=larger(courses.exchange, entries, horizon),
            listed_exchange=larger(courses.listed_exchange, entries, horizon),
            exchanges=larger(courses.exchanges, entries * horizon),
        ),
    )


def larger(table: npt.NDArray[N], *shape: int) -> npt.NDArray[N]:
    """The table with zeros behind its rows and columns."""
    after = np.zeros(shape, table.dtype)
    after[tuple(map(slice, table.shape))] = table
    return after


def charges_of(row: IntTable, fee: LongTable, delays: int) -> Charges:
    """Charges with these rows and fees, and with tables for this many delays."""
    robots, _ = row.shape
    costs = (robots, delays + 1)
    return Charges(np.zeros(costs, np.int64), np.zeros(costs, np.int64), row, fee, np.zeros_like(row))
