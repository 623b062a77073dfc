"""The arrays of the search for prices (`carp_optimum.lagrangian.state`), made from an instance."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from carp_optimized.jit.kinds import Ints, IntTable, LongTable
from carp_optimized.state.arrays import NONE, Graph
from carp_optimum.lagrangian.state import Cells, Charges, Dual, Prices, Requests, Scratch, Usage, Ways
from carp_spec import Instance, Refusal
from carp_verify.bound.rules import size_fits

LARGEST_ARRAY = 100_000_000  # entries of a table of counts
LARGEST_PRICED = 15_000_000  # entries of a table of prices, of which there are about a dozen
N = TypeVar("N", bound=np.generic)


def refuse_table(path: str, what: str, entries: int, most: int) -> None:
    """Raise `Refusal` if a table would be too large."""
    if not size_fits(entries, most):
        message = f"{what} must be at most {most}, the limit, and would be {entries}"
        raise Refusal("limit", path, size_fits.id, message)


def requests_of(instance: Instance) -> Requests:
    """The robots' requests; until the ways to their goals are found, they arrive at their release."""
    index, robots = instance.graph.index, instance.robots
    return Requests(
        start=np.array([index[robot.start] for robot in robots], np.int32),
        goal=np.array([index[robot.goal] for robot in robots], np.int32),
        release=np.array([robot.release for robot in robots], np.int32),
        pace=np.array([robot.pace for robot in robots], np.int32),
        earliest=np.array([robot.release for robot in robots], np.int64),
        rest=np.full((len(robots), len(index)), NONE, np.int32),
    )


def dual_of(instance: Instance, graph: Graph, requests: Requests, longest: int, horizon: int, delays: int) -> Dual:
    """The dual with tables for this many ticks and delays, and no rows."""
    robots, resources, edges = requests.start.size, graph.duration.size, graph.target.size
    ticks = int((requests.earliest - requests.release).max(initial=0)) + delays
    visits = ticks // int(graph.duration.min(initial=1)) + 2
    refuse_table("$.robots", "robots times the visits of a plan", robots * visits, LARGEST_ARRAY)
    slots = resources * (longest + 1)
    scratch = Scratch(
        generation=np.zeros(1, np.int64),
        mark=np.zeros(slots, np.int64),
        paid=np.zeros(slots, np.int64),
        parent=np.zeros(resources * ticks, np.int32),
        following=np.zeros(slots, np.int32),
        head=np.full(longest + 1, NONE, np.int32),
        keys=np.zeros(edges + 1, np.int64),
        nodes=np.zeros(edges + 1, np.int32),
        steps=np.zeros(1, np.int64),
    )
    empty, wide = np.zeros((0, 0), np.int32), np.zeros((0, 0), np.int64)
    met = np.zeros(graph.room.size, np.int32)
    dual = Dual(
        graph=graph,
        requests=requests,
        limits=no_cells(graph.room.size),
        exchanges=no_cells(edges),
        prices=Prices(
            back=moves_back(instance),
            into=np.argsort(graph.target, kind="stable").astype(np.int32),
            present=wide,
            crossing=wide,
            stay=wide,
            across=wide,
            changed=np.zeros(0, np.int32),
            waiting=wide,
            entering=wide,
            worth=np.zeros(1, np.int64),
        ),
        charges=charges_of(np.zeros((robots, horizon), np.int32), np.zeros((1, resources), np.int64), delays),
        ways=Ways(np.zeros(robots, np.int32), *np.zeros((2, robots, visits), np.int32)),
        usage=Usage(np.zeros((graph.room.size, horizon), np.int32), empty, empty, met, np.zeros(1, np.int64)),
        scratch=scratch,
        horizon=horizon,
        delays=delays,
        parks=instance.after_goal == "park",
        is_even=bool((graph.duration == graph.duration[:1]).all()),
    )
    return with_room(dual, 1, 1)


def no_cells(numbers: int) -> Cells:
    """Cells of so many constraints or moves, none of which has a row."""
    price, course = np.zeros((2, 0, 0), np.int64)
    listed, active = np.zeros((0, 0), np.int16), np.zeros(0, np.int64)
    return Cells(np.zeros(numbers, np.int32), price, course, listed, active, np.zeros(1, np.int64))


def moves_back(instance: Instance) -> Ints:
    """For each move the number of the move back, or `NONE`."""
    moves = [(source, target) for source in instance.graph.index for target in instance.graph.successors[source]]
    number = {move: position for position, move in enumerate(moves)}
    return np.array([number.get((target, source), NONE) for source, target in moves], np.int32)


def with_rows(dual: Dual, constraints: Sequence[int]) -> Dual:
    """The dual with rows for these constraints without one, and for the moves of their resources.

    There are no more rows once the tables would be too large.
    """
    row, entry = dual.limits.row, dual.exchanges.row
    graph = dual.graph
    rows, entries = int(row.max(initial=0)) + 1, int(entry.max(initial=0)) + 1
    for constraint in constraints:
        moves: list[int] = []
        if constraint < graph.duration.size:
            leaving = range(graph.first[constraint], graph.first[constraint + 1])
            coming = dual.prices.into[graph.backward_first[constraint] : graph.backward_first[constraint + 1]]
            moves = [move for move in (*leaving, *coming.tolist()) if entry[move] == 0]
        if max(rows + 1, entries + len(moves)) * dual.horizon > LARGEST_PRICED:
            break
        row[constraint] = rows
        rows += 1
        entry[np.array(moves, np.int64)] = range(entries, entries + len(moves))
        entries += len(moves)
    rows_there, entries_there = len(dual.limits.price), len(dual.exchanges.price)
    if rows <= rows_there and entries <= entries_there:
        return dual
    most = LARGEST_PRICED // max(dual.horizon, 1)
    return with_room(dual, max(rows, min(2 * rows_there, most)), max(entries, min(2 * entries_there, most)))


def with_room(dual: Dual, rows: int, entries: int) -> Dual:
    """The dual with tables for so many rows of constraints and of moves, which are no fewer than before."""
    horizon, prices, usage = dual.horizon, dual.prices, dual.usage
    changed = np.full(rows - prices.changed.size, horizon, np.int32)
    return dual._replace(
        limits=larger_cells(dual.limits, rows, horizon),
        exchanges=larger_cells(dual.exchanges, entries, horizon),
        prices=prices._replace(
            present=larger(prices.present, rows, horizon),
            crossing=larger(prices.crossing, rows, horizon),
            stay=larger(prices.stay, rows, horizon + 1),
            across=larger(prices.across, rows, horizon + 1),
            changed=np.concatenate([prices.changed, changed]),
            waiting=larger(prices.waiting, horizon + 1, rows),
            entering=larger(prices.entering, horizon + 1, entries),
        ),
        usage=usage._replace(
            moving=larger(usage.moving, entries, horizon), staying=larger(usage.staying, rows, horizon)
        ),
    )


def larger_cells(cells: Cells, rows: int, horizon: int) -> Cells:
    """The cells with tables for so many rows."""
    return cells._replace(
        price=larger(cells.price, rows, horizon),
        course=larger(cells.course, rows, horizon),
        listed=larger(cells.listed, rows, horizon),
        active=larger(cells.active, rows * horizon),
    )


def larger(table: npt.NDArray[N], *shape: int) -> npt.NDArray[N]:
    """The table with zeros behind its rows and columns."""
    after = np.zeros(shape, table.dtype)
    after[tuple(map(slice, table.shape))] = table
    return after


def charges_of(row: IntTable, fee: LongTable, delays: int) -> Charges:
    """Charges with these rows and fees, and with tables for this many delays."""
    cost, least = np.zeros((2, len(row), delays + 1), np.int64)
    return Charges(cost, least, row, fee, np.zeros_like(row))
