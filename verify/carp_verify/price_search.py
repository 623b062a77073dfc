"""The search for good prices: what is done between the compiled steps of `carp_verify.price_steps`."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from carp_optimized.arrays import LARGEST, NONE, Graph, Longs
from carp_optimized.encoding import encode_graph, refuse_tick, refuse_what_is_too_large
from carp_optimized.references import Native
from carp_spec import Instance, Refusal, ResourceId, RobotId
from carp_verify.bound_rules import LARGEST_TABLE, table_fits
from carp_verify.price_steps import LARGEST_GAIN, take_step
from carp_verify.priced_ways import (
    Market,
    Prices,
    Requests,
    Scratch,
    Usage,
    Ways,
    find_rests,
    find_ways,
    least_cost,
)
from carp_verify.solver import Deadline, TimeOver

TICKS_BEYOND = 32  # of the horizon beyond the last arrival of a robot that nothing delays
DELAYS = 64
MOST_NODES = 1 << 21
PATIENCE = 60
FIRST_AIM = 50  # one part of the sum of shortest paths
LEAST_AIM = 64  # in parts of a tick


class PriceLists(NamedTuple):
    """The prices that are not 0, as a certificate has them."""

    resources: tuple[tuple[ResourceId, int, int], ...]
    exchanges: tuple[tuple[ResourceId, ResourceId, int, int], ...]


def refuse_table(path: str, what: str, entries: int) -> None:
    """Raise `Refusal` if a table would be too large."""
    if not table_fits(entries):
        message = f"{what} must be at most {LARGEST_TABLE}, the limit, and would be {entries}"
        raise Refusal("limit", path, table_fits.id, message)


class PriceSearch:
    """Prices of an instance; `best` is the bound, in parts of a tick, of the best that were found."""

    def __init__(self, instance: Instance, scale: int) -> None:
        refuse_what_is_too_large(instance)
        robots, resources = len(instance.robots), len(instance.graph.resources)
        refuse_table("$.robots", "robots times resources", robots * resources)
        self.instance = instance
        self.scale = scale
        graph = encode_graph(instance)
        graph = graph._replace(capacity=np.minimum(graph.capacity, robots).astype(np.int32))
        requests = _requests(instance, scale)
        longest = max((robot.pace for robot in instance.robots), default=1) * int(graph.duration.max(initial=1))
        market = _market(instance, graph, requests, longest)
        native = Native(market)
        find_rests(native)
        last = max(requests.earliest.tolist(), default=0)
        refuse_tick("$.graph", last)
        rows = resources + graph.target.size
        self.horizon = min(max(last, 0) + longest + TICKS_BEYOND, LARGEST_TABLE // max(rows, 1))
        delays = max(1, min(DELAYS * longest, MOST_NODES // max(resources, 1), LARGEST - last))
        self.market = _sized(market, self.horizon, delays)
        self.native = Native(self.market)
        self.best = find_ways(self.native)
        self._kept = self._copy()
        self.count = 0

    def _copy(self) -> tuple[Longs, Longs]:
        return self.market.prices.resource.copy(), self.market.prices.exchange.copy()

    def _restore(self) -> int:
        """Go back to the best prices, without a course: their bound."""
        self.market.prices.resource[:], self.market.prices.exchange[:] = self._kept
        self.market.usage.course[:] = 0
        self.market.usage.course_of_exchange[:] = 0
        return find_ways(self.native)

    def run(self, seconds: float | None, steps: int | None, on_step: Callable[[int, int], None]) -> None:
        """Take steps until the time or their number is over, or none gains anything."""
        deadline = None if seconds is None else Deadline(seconds)
        with suppress(TimeOver):
            self._climb(steps, deadline, on_step)
        self._restore()

    def _climb(self, steps: int | None, deadline: Deadline | None, on_step: Callable[[int, int], None]) -> None:
        bound = self.best
        aim = max(bound // FIRST_AIM, LEAST_AIM)
        failures = 0
        while aim >= LEAST_AIM and (steps is None or self.count < steps):
            if deadline is not None:
                deadline.check()
            gain = min(max(self.best + aim - bound, 0), LARGEST_GAIN)
            if take_step(self.native, gain) == 0:
                return
            self.count += 1
            bound = find_ways(self.native)
            failures += 1
            if bound > self.best:
                failures = 0 if bound > self.best + aim // 8 else failures
                self.best = bound
                self._kept = self._copy()
            if failures > PATIENCE:
                failures = 0
                aim = aim * 3 // 4
                bound = self._restore()
            on_step(self.count, self.best)

    def prices(self) -> PriceLists:
        """The prices that are not 0."""
        graph = self.instance.graph
        ids = [resource.id for resource in graph.resources]
        moves = [(source, target) for source in ids for target in graph.successors[source]]
        resource, exchange = self.market.prices.resource, self.market.prices.exchange
        return PriceLists(
            tuple((ids[here], int(tick), int(resource[here, tick])) for here, tick in np.argwhere(resource)),
            tuple((*moves[move], int(tick), int(exchange[move, tick])) for move, tick in np.argwhere(exchange)),
        )

    @property
    def worth(self) -> int:
        """The prices times the capacities."""
        prices = self.market.prices
        of_resource = prices.stay[:, self.horizon] + prices.across[:, self.horizon]
        return int((of_resource * self.market.graph.capacity).sum())

    def least_costs(self) -> tuple[tuple[RobotId, int | None], ...]:
        """The least priced cost of each robot, `None` where it cannot reach its goal."""
        earliest = self.market.requests.earliest
        return tuple(
            (robot.id, None if earliest[position] == NONE else least_cost(self.native, position))
            for position, robot in enumerate(self.instance.robots)
        )


def _requests(instance: Instance, scale: int) -> Requests:
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


def _market(instance: Instance, graph: Graph, requests: Requests, longest: int) -> Market:
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
    back = _moves_back(instance)
    prices = Prices(wide, wide, np.array([back.get(move, NONE) for move in range(edges)], np.int32), wide, wide)
    usage = Usage(empty, empty, empty, wide, wide)
    ways = Ways(np.zeros(0, np.int32), empty, empty)
    return Market(graph, requests, prices, ways, usage, scratch, 0, 1, instance.after_goal == "park")


def _moves_back(instance: Instance) -> Mapping[int, int]:
    """For each move that has a move back, the number of that."""
    moves = [(source, target) for source in instance.graph.index for target in instance.graph.successors[source]]
    number = {move: position for position, move in enumerate(moves)}
    return {
        position: number[target, source] for (source, target), position in number.items() if (target, source) in number
    }


def _sized(market: Market, horizon: int, delays: int) -> Market:
    """The market with tables for so many ticks and delays."""
    requests, graph = market.requests, market.graph
    robots, resources, edges = requests.start.size, graph.duration.size, graph.target.size
    ticks = int((requests.earliest - requests.release).max(initial=0)) + delays
    visits = ticks // int(graph.duration.min(initial=1)) + 2
    refuse_table("$.robots", "robots times the visits of a plan", robots * visits)
    nodes = resources * delays
    return market._replace(
        prices=market.prices._replace(
            resource=np.zeros((resources, horizon), np.int64),
            exchange=np.zeros((edges, horizon), np.int64),
            stay=np.zeros((resources, horizon + 1), np.int64),
            across=np.zeros((resources, horizon + 1), np.int64),
        ),
        ways=Ways(
            np.zeros(robots, np.int32), np.zeros((robots, visits), np.int32), np.zeros((robots, visits), np.int32)
        ),
        usage=Usage(
            present=np.zeros((resources, horizon), np.int32),
            moving=np.zeros((edges, horizon), np.int32),
            staying=np.zeros((resources, horizon), np.int32),
            course=np.zeros((resources, horizon), np.int64),
            course_of_exchange=np.zeros((edges, horizon), np.int64),
        ),
        scratch=market.scratch._replace(
            mark=np.zeros(nodes, np.int64),
            paid=np.zeros(nodes, np.int64),
            parent=np.zeros(nodes, np.int32),
            following=np.zeros(nodes, np.int32),
        ),
        horizon=horizon,
        delays=delays,
    )
