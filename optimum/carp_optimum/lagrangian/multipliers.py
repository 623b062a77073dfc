"""The arrays of the search for prices (`carp_optimum.lagrangian.state`), made from an instance."""

from collections.abc import Mapping

import numpy as np

from carp_optimized.jit.kinds import IntTable, LongTable
from carp_optimized.state.arrays import NONE, Graph
from carp_optimum.lagrangian.state import Charges, Market, Prices, Requests, Scratch, Usage, Ways
from carp_spec import Instance, Refusal
from carp_verify.bound.rules import LARGEST_TABLE, size_fits


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
    )
    back = moves_back(instance)
    numbers = np.array([back.get(move, NONE) for move in range(edges)], np.int32)
    prices = Prices(wide, wide, wide, numbers, wide, wide, wide, wide)
    usage = Usage(empty, empty, empty, wide, wide)
    ways = Ways(np.zeros(0, np.int32), empty, empty)
    charges = Charges(wide, wide, empty, wide, empty)
    return Market(graph, requests, prices, charges, ways, usage, scratch, 0, 1, instance.after_goal == "park")


def moves_back(instance: Instance) -> Mapping[int, int]:
    """For each move that has a move back, the number of that."""
    moves = [(source, target) for source in instance.graph.index for target in instance.graph.successors[source]]
    number = {move: position for position, move in enumerate(moves)}
    return {
        position: number[target, source] for (source, target), position in number.items() if (target, source) in number
    }


def sized(market: Market, horizon: int, delays: int) -> Market:
    """The market with tables for this many ticks and delays."""
    requests, graph = market.requests, market.graph
    robots, resources, edges = requests.start.size, graph.duration.size, graph.target.size
    ticks = int((requests.earliest - requests.release).max(initial=0)) + delays
    visits = ticks // int(graph.duration.min(initial=1)) + 2
    refuse_table("$.robots", "robots times the visits of a plan", robots * visits)
    slots = resources * market.scratch.head.size
    limits = graph.room.size
    return market._replace(
        prices=market.prices._replace(
            limit=np.zeros((limits, horizon), np.int64),
            present=np.zeros((resources, horizon), np.int64),
            exchange=np.zeros((edges, horizon), np.int64),
            stay=np.zeros((resources, horizon + 1), np.int64),
            across=np.zeros((resources, horizon + 1), np.int64),
            waiting=np.zeros((horizon + 1, resources), np.int64),
            entering=np.zeros((horizon + 1, edges), np.int64),
        ),
        charges=charges_of(np.zeros((robots, horizon), np.int32), np.zeros((1, resources), np.int64), delays),
        ways=Ways(
            np.zeros(robots, np.int32), np.zeros((robots, visits), np.int32), np.zeros((robots, visits), np.int32)
        ),
        usage=Usage(
            present=np.zeros((limits, horizon), np.int32),
            moving=np.zeros((edges, horizon), np.int32),
            staying=np.zeros((resources, horizon), np.int32),
            course=np.zeros((limits, horizon), np.int64),
            course_of_exchange=np.zeros((edges, horizon), np.int64),
        ),
        scratch=market.scratch._replace(
            mark=np.zeros(slots, np.int64),
            paid=np.zeros(slots, np.int64),
            parent=np.zeros(resources * ticks, np.int32),
            following=np.zeros(slots, np.int32),
        ),
        horizon=horizon,
        delays=delays,
    )


def charges_of(row: IntTable, fee: LongTable, delays: int) -> Charges:
    """Charges with these rows and fees, and with tables for this many delays."""
    robots, _ = row.shape
    costs = (robots, delays + 1)
    return Charges(np.zeros(costs, np.int64), np.zeros(costs, np.int64), row, fee, np.zeros_like(row))
