"""The search for good prices: the work between the compiled steps of `carp_optimum.lagrangian.price_steps`."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from fractions import Fraction
from operator import itemgetter
from time import monotonic_ns
from typing import NamedTuple

import numpy as np

from carp_optimized.jit.kinds import IntTable, Longs
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import LARGEST, NONE
from carp_optimized.state.encoding import encode_graph
from carp_optimized.state.limits import refuse_tick, refuse_what_is_too_large
from carp_optimum.deadline import TimeOver
from carp_optimum.lagrangian.deadlines import Deadlines, flattened
from carp_optimum.lagrangian.multipliers import (
    LARGEST_ARRAY,
    charges_of,
    dual_of,
    refuse_table,
    requests_of,
    with_rows,
)
from carp_optimum.lagrangian.price_steps import KEPT, LARGEST_GAIN, PARTS, UNIT, forget, set_price, turn, walk
from carp_optimum.lagrangian.priced_paths import find_rests, find_ways, see_ways
from carp_optimum.lagrangian.state import Cells, add_up
from carp_optimum.lagrangian.usage import count_ways
from carp_spec import Instance, Refusal, ResourceId, RobotId
from carp_spec.documents.bounds import DeadlinesDocument
from carp_verify.bound.rules import LARGEST_RESTS, LARGEST_SEARCH, LARGEST_TABLE, LONGEST_STAY, stay_is_searched

TICKS_BEYOND = 32  # of the horizon beyond the last arrival of a robot that nothing delays
DELAYS = 64  # longest stays by which a robot may be late
MOST_NODES = 1 << 21  # resources times delays of a table
LAST_TICK = 20_000  # of prices, so that a step does not take long
PATIENCE = 35  # steps without a gain, after which the aim is lowered
ENOUGH, LEAST_ENOUGH = 32, 4096
"""Parts of the aim, and of the best bound: patience begins again where both are gained.

On a spanning tree the bound converges slowly, in steps that are small beside the aim.
"""
OVERSHOT, LEAST_PARTS = 4, 8192
"""A first step that loses more than one of `OVERSHOT` parts of the aim shows that the aim is too high.

Then that part is aimed for, but no less than one of `LEAST_PARTS` parts of the bound.

On a large map robots have many ways that are as short, and prices that are much too high chase them from one to others.
"""
SPAN = 200  # steps
PART = 32  # robots between two looks at the clock
ENOUGH_OF_SPAN = 16  # parts of the aim
MOST_STEPS = LARGEST_SEARCH * 3 // 4
"""What the checker may take for all claims: less than it allows, as it takes a few more where deadlines have prices."""


class PriceLists(NamedTuple):
    """The prices that are not 0, as a certificate has them."""

    resources: tuple[tuple[ResourceId, int, int], ...]
    exchanges: tuple[tuple[ResourceId, ResourceId, int, int], ...]
    groups: tuple[tuple[ResourceId, int, int], ...]


class Point(NamedTuple):
    """The cells of constraints and of exchanges that have a price, with it, and the prices of deadlines."""

    limits: tuple[Longs, Longs]
    exchanges: tuple[Longs, Longs]
    fees: Longs


class PriceSearch:
    """Prices of an instance; `best` is the best bound found with them, in parts of a tick, `shortest` that without.

    Deadlines say that one of their members does not keep its own; `fees` are their prices. `within` is called during
    each step of `climb` and `roam`, and may raise `TimeOver`.
    """

    def __init__(
        self,
        instance: Instance,
        scale: int,
        clock: Callable[[], int] = monotonic_ns,
        within: Callable[[], None] = lambda: None,
    ) -> None:
        """`clock` gives nanoseconds, of which `longest` is what all ways together have taken at most.

        Where `within` raises `TimeOver` here already, the search has not `begun`, and knows `shortest_costs` alone.
        """
        self._clock = clock
        self.within = within
        self.longest = 0
        self.horizon = 0
        refuse_what_is_too_large(instance)
        robots, resources = len(instance.robots), len(instance.graph.resources)
        refuse_table("$.robots", "robots times resources", robots * resources, LARGEST_RESTS)
        self.instance = instance
        self.scale = scale
        graph = encode_graph(instance)
        room = np.minimum(graph.room, robots).astype(np.int32)
        graph = graph._replace(capacity=room[:resources].copy(), room=room)
        requests = requests_of(instance)
        longest = max((robot.pace for robot in instance.robots), default=1) * int(graph.duration.max(initial=1))
        if not stay_is_searched(longest):
            message = f"the pace times the duration must be at most {LONGEST_STAY}, the limit, and is {longest}"
            raise Refusal("limit", "$.graph", stay_is_searched.id, message)
        self.dual = dual_of(instance, graph, requests, longest, 0, 1)
        self.native = Native(self.dual)
        self.deadlines: list[Deadlines] = []
        self.fees = np.zeros(0, np.int64)
        self._course_of_fees = np.zeros(0, np.int64)
        self._flat, _ = flattened([], 0)
        self._is_charged = False
        self.count = 0
        self.best = self.shortest = 0
        self._kept = self._point()
        self.begun = False
        with suppress(TimeOver):
            self._begin(longest)
            self.begun = True
        if not self.begun:
            self.best = self.shortest = sum(least or 0 for _, least in self.shortest_costs())

    def _begin(self, longest: int) -> None:
        """Find how far all are from their goals, and the tables and the first bound that follow; may raise `TimeOver`.

        `longest` is the longest stay of a move.
        """
        graph, requests, robots = self.dual.graph, self.dual.requests, len(self.instance.robots)
        for first in range(0, robots, PART):
            if first > 0:
                self.within()
            find_rests(self.native, first, min(first + PART, robots))
        last = max(requests.earliest.tolist(), default=0)
        refuse_tick("$.graph", last)
        most = min(LARGEST_ARRAY // max(graph.room.size, 1), LARGEST_TABLE // max(robots, 1))
        self.horizon = min(max(last, 0) + longest + TICKS_BEYOND, most, LAST_TICK)
        wanted = min(max(DELAYS * longest, self.horizon + longest), LARGEST_TABLE // max(robots, 1))
        delays = max(1, min(wanted, MOST_NODES // max(graph.duration.size, 1), LARGEST - last))
        self.dual = dual_of(self.instance, graph, requests, longest, self.horizon, delays)
        self.native = Native(self.dual)
        self.best = self.shortest = self._bound(self.within)
        self._kept = self._point()

    def _point(self) -> Point:
        return Point(self._priced(self.dual.limits), self._priced(self.dual.exchanges), self.fees.copy())

    def _priced(self, cells: Cells) -> tuple[Longs, Longs]:
        active = cells.active[: cells.size[0]]
        price = cells.price[cells.row[active // self.horizon], active % self.horizon]
        return active[price > 0], price[price > 0]

    def _bound(self, check: Callable[[], None] = lambda: None) -> int:
        """The bound that the prices prove; gives each robot a cheapest way.

        `check` is called after every few robots, and may raise `TimeOver`: then only `restore` makes all whole again.
        """
        began = self._clock()
        worth = int((self.fees * (self._flat.sizes - 1)).sum())
        self._charge()
        total = -worth - add_up(self.native)
        robots = len(self.instance.robots)
        for first in range(0, robots, PART):
            check()
            total += find_ways(self.native, first, min(first + PART, robots))
        if self.dual.usage.met_anew[0] > 0:
            self._add_rows()
        self.longest = max(self.longest, self._clock() - began)
        return total

    def _add_rows(self) -> None:
        """Give rows to the constraints where robots met without one, and to the resources of groups among them."""
        usage, graph = self.dual.usage, self.dual.graph
        for group in np.flatnonzero(usage.met[graph.duration.size :]).tolist():
            usage.met[graph.member[graph.members_first[group] : graph.members_first[group + 1]]] = 1
        self.dual = with_rows(self.dual, np.flatnonzero((usage.met > 0) & (self.dual.limits.row == 0)).tolist())
        self.native = Native(self.dual)
        usage = self.dual.usage
        for counts in (usage.present, usage.moving, usage.staying, usage.met, usage.met_anew):
            counts[...] = 0
        count_ways(self.native)
        usage.met_anew[0] = 0

    def _charge(self) -> None:
        """Fill the tables of what an arrival costs each robot, by its delay, and of what it pays on its way."""
        requests, flat = self.dual.requests, self._flat
        if len(self.deadlines) == 0 and self._is_charged:
            return  # nothing has changed
        self._is_charged = True
        cost, least, _, fee, _ = self.dual.charges
        cost[:] = 0
        delay = np.minimum(flat.arrival - requests.earliest[flat.robot], self.dual.delays)
        can = delay >= 0
        np.add.at(cost, (flat.robot[can], delay[can]), self.fees[flat.group[can]])
        cost[:] = np.cumsum(cost[:, ::-1], axis=1)[:, ::-1]
        ticks = np.arange(cost.shape[1]) + (requests.earliest - requests.release)[:, None]
        cost += self.scale * ticks
        least[:] = np.minimum.accumulate(cost[:, ::-1], axis=1)[:, ::-1]
        fee[:] = 0
        np.add.at(fee, (flat.row, flat.place), self.fees[flat.group_of_place])

    def _set_prices(self, *priced: tuple[Longs, Longs]) -> None:
        """Let these cells of constraints and of exchanges have these prices, and no others any."""
        for is_exchange, cells_and_prices in enumerate(priced):
            forget(self.native, bool(is_exchange))
            for cell, price in np.column_stack(cells_and_prices).tolist():
                set_price(self.native, bool(is_exchange), cell, price)

    def restore(self) -> int:
        """Go back to the best prices, without a course: their bound."""
        kept = self._kept
        self._set_prices(kept.limits, kept.exchanges)
        self.fees = kept.fees.copy()
        self._course_of_fees[:] = 0
        return self._bound()

    def add_deadlines(self, deadlines: Sequence[Deadlines]) -> None:
        """Add deadlines with prices of 0."""
        none = np.zeros(len(deadlines), np.int64)
        self._set_deadlines([*self.deadlines, *deadlines], lambda each: np.concatenate([each, none]))

    def keep_deadlines(self, numbers: Sequence[int]) -> None:
        """Keep the deadlines with these numbers alone, with their prices; the best bound is then what they prove."""
        self._select(numbers)
        self.best = self.restore()

    def drop_idle_deadlines(self) -> None:
        """Drop the deadlines without proof that have no price, neither now nor among the best prices."""
        is_proved = np.array([each.refutation != "" for each in self.deadlines], np.bool_)
        self._select(np.flatnonzero(is_proved | (self.fees > 0) | (self._kept.fees > 0)).tolist())

    def _select(self, numbers: Sequence[int]) -> None:
        places = np.array(numbers, np.int64)
        self._set_deadlines([self.deadlines[each] for each in numbers], lambda each: each[places])

    def _set_deadlines(self, deadlines: list[Deadlines], changed: Callable[[Longs], Longs]) -> None:
        """Let there be these deadlines, with their prices, courses and best prices, which are changed alike."""
        self.deadlines = deadlines
        self.fees, self._course_of_fees = changed(self.fees), changed(self._course_of_fees)
        self._kept = self._kept._replace(fees=changed(self._kept.fees))
        robots, resources = len(self.instance.robots), len(self.instance.graph.resources)
        self._flat, rows = flattened(self.deadlines, resources)
        row = np.zeros((robots, self.horizon), np.int32)
        for place, number in rows.items():
            row[place] = number
        fee = np.zeros((len(rows) + 1, resources), np.int64)
        self.dual = self.dual._replace(charges=charges_of(row, fee, self.dual.delays))
        self.native = Native(self.dual)
        self._is_charged = False

    def priced_deadlines(self) -> tuple[DeadlinesDocument, ...]:
        """The deadlines that have a price, with it."""
        priced = zip(self.deadlines, self.fees.tolist(), strict=True)
        return tuple(each.document(self.instance, fee) for each, fee in priced if fee > 0)

    def _kept_by(self) -> Longs:
        """How many members of each deadlines keep their own in the robots' cheapest ways."""
        flat = self._flat
        keeps = self.delays()[flat.robot] <= flat.arrival - self.dual.requests.earliest[flat.robot]
        if flat.place.size > 0:
            see_ways(self.native)
            places = self.dual.charges.place[flat.robot, flat.seen]
            keeps |= flat.inside[np.arange(len(places)), places]
        return np.bincount(flat.group, keeps, len(flat.sizes)).astype(np.int64)

    def delays(self) -> Longs:
        """The delays of the robots' cheapest ways; 0 for one that has none."""
        requests, ways = self.dual.requests, self.dual.ways
        last = np.maximum(ways.length - 1, 0)
        delays: Longs = np.where(ways.length > 0, ways.enter[np.arange(len(last)), last] - requests.earliest, 0)
        return np.maximum(delays, 0)

    def _step(self, aim: int, bound: int) -> bool:
        """Change prices that prove this bound to be so much above the best; false if there is nothing to be gained."""
        gain = min(max(self.best + aim - bound, 0), LARGEST_GAIN)
        surplus = self._kept_by() - self._flat.sizes + 1
        self._course_of_fees = self._course_of_fees * KEPT // PARTS + UNIT * surplus
        self._course_of_fees[(self._course_of_fees < 0) & (self.fees == 0)] = 0
        square = turn(self.native, False) + turn(self.native, True) + int((self._course_of_fees**2).sum())
        if square == 0:
            return False
        for is_exchange in (False, True):
            walk(self.native, is_exchange, gain, square)
        self.fees = np.maximum(self.fees + gain * UNIT * self._course_of_fees // square, 0)
        self.count += 1
        return True

    def _new_bound(self) -> int:
        """The bound after a step; if it is the best, its prices are kept."""
        bound = self._bound(self.within)
        if bound > self.best:
            self.best = bound
            self._kept = self._point()
        return bound

    def try_prices(self, cells: Longs, prices: Longs, fees: Longs) -> int:
        """The bound that prices of cells and fees of deadlines prove in place of all others; the best are kept.

        A cell is a number times the horizon, and a tick; constraints are numbered first, then moves.
        """
        dual = self.dual
        cells, prices = cells[prices > 0], prices[prices > 0]
        place = cells // self.horizon
        of_exchange = place >= dual.graph.room.size
        place[of_exchange] = dual.graph.target[dual.prices.back[place[of_exchange] - dual.graph.room.size]]
        dual.usage.met[place[dual.limits.row[place] == 0]] = 1
        self._add_rows()
        has_row = self.dual.limits.row[place] > 0
        cells[of_exchange] -= dual.graph.room.size * self.horizon
        limits, exchanges = has_row & ~of_exchange, has_row & of_exchange
        self._set_prices((cells[limits], prices[limits]), (cells[exchanges], prices[exchanges]))
        self.fees = fees
        self._is_charged = False
        self.count += 1
        return self._new_bound()

    def climb(self, first_aim: int, last_aim: int, check: Callable[[], None]) -> None:
        """Take steps that aim closer and closer to the best bound, from the first aim to the last, in parts of a tick.

        `check` is called before each, and may raise `TimeOver`.
        """
        check()
        bound = self.restore()
        self.best = max(self.best, bound)
        aim = max(first_aim, last_aim)
        failures = 0
        before = self.best
        while aim >= last_aim:
            check()
            if not self._step(aim, bound):
                break
            bound = self._new_bound()
            failures += 1
            if self.best - before > max(aim // ENOUGH, self.best // LEAST_ENOUGH):
                failures = 0
                before = self.best
            is_high = aim > self.best // LEAST_PARTS
            overshot = is_high and self.best == self.shortest and (self.best - bound) * OVERSHOT > aim
            if overshot or failures > PATIENCE:
                failures = 0
                before = self.best
                aim = min(aim, max(aim // OVERSHOT, self.best // LEAST_PARTS)) if overshot else aim * 3 // 4
                bound = self.restore()

    def roam(self, first_aim: int, last_aim: int, check: Callable[[], None], on_step: Callable[[], None]) -> None:
        """Take steps as `climb` does, but never back to the best prices, while `on_step` may add deadlines.

        New deadlines would lose the prices that they have gained since. In each span of `SPAN` steps an aim above a
        tick falls to a tick, as the square of the steps left: large aims explore; small ones refine. The next span
        begins with twice the aim if enough of it was gained, and with half if not; the steps end when that is below the
        last aim.
        """
        bound = self.restore()
        aim = max(first_aim, last_aim)
        while aim >= last_aim:
            before = self.best
            for left in range(SPAN, 0, -1):
                check()
                if not self._step(max(aim * left * left // (SPAN * SPAN), min(aim, self.scale)), bound):
                    return
                bound = self._new_bound()
                on_step()
            aim = aim * 2 if (self.best - before) * ENOUGH_OF_SPAN > aim else aim // 2

    def wander(self, steps: int, check: Callable[[], None]) -> Iterator[None]:
        """Take this many steps near the best prices, one by one; `check` may raise `TimeOver` after each."""
        bound = self.restore()
        for _ in range(steps):
            self._step(self.scale // 4, bound)
            bound = self._bound()
            check()
            yield

    def places(self) -> IntTable:
        """Where the cheapest ways have the robots, by robot and tick."""
        see_ways(self.native)
        return self.dual.charges.place.astype(np.int16)

    def prices(self) -> PriceLists:
        """The prices that are not 0."""
        graph = self.instance.graph
        ids = [each.id for each in graph.constraints]
        size = len(graph.resources)
        moves = [(source, target) for source in graph.index for target in graph.successors[source]]
        limits, exchanges = (
            [(*divmod(cell, self.horizon), price) for cell, price in sorted(np.column_stack(priced).tolist())]
            for priced in self._point()[:2]
        )
        return PriceLists(
            tuple((ids[number], tick, price) for number, tick, price in limits if number < size),
            tuple((*moves[number], tick, price) for number, tick, price in exchanges),
            tuple((ids[number], tick, price) for number, tick, price in limits if number >= size),
        )

    def least_costs(self) -> tuple[tuple[RobotId, int | None], ...]:
        """What each robot claims: its least priced cost, `None` where it cannot reach its goal.

        Where the checker would take more than `MOST_STEPS`, those robots that gain least by a step claim their shortest
        ways alone, which takes it no step.
        """
        costs = dict(self.shortest_costs())
        claims: list[tuple[Fraction, int, RobotId, int]] = []
        steps = self.dual.scratch.steps
        for position, (robot, shortest) in enumerate(costs.items()):
            if shortest is not None:
                steps[0] = 0
                least = find_ways(self.native, position, position + 1)
                taken = int(steps[0])
                claims.append((Fraction(taken, max(least - shortest, 1)), taken, robot, least))
        left = MOST_STEPS
        for _, taken, robot, least in sorted(claims, key=itemgetter(0)):
            if taken <= left:
                left -= taken
                costs[robot] = least
        return tuple(costs.items())

    def shortest_costs(self) -> tuple[tuple[RobotId, int | None], ...]:
        """The cost of each robot's shortest way, in parts of a tick; 0 where there was no time to find it."""
        robots = zip(self.instance.robots, self.dual.requests.earliest.tolist(), strict=True)
        return tuple((each.id, None if at == NONE else self.scale * (at - each.release)) for each, at in robots)
