"""Checks the certificate of a lower bound: whole numbers, the standard library, and nothing of what found it.

The bound holds by weak duality of Lagrangian relaxation. Take any plans of all robots that break no rule together. They
pay at most the prices times the capacities (the rows of prices and their capacities are below). The weighted cost of
each robot, together with its payments, is at least the least that `least_cost` finds for it. With a cut, a part of its
robots' costs is counted in the cut instead, and their sum is at least the total that the cut proves. The
kernel's theorem is `accepted_bound_is_below_every_solution`.

- The price of a deadline is paid by each robot of its group that enters its goal for the last time at its tick or
  before: by all of the group but one, at most, because its formula has no model. To come late is free of it, so a
  robot that vanishes at its goal may gain by driving through the goal and on. Then it is searched for that, too.
- A robot that is seen at a tick pays if it has come by then, and by the deadline. On its way it pays if it is in one of
  its places at the tick: once, as it is in one place. One that is seen at more ticks pays for each.

- A price of a resource r at a tick t is paid by all who are in r at t: at most the capacity of r, by `joint/capacity`.
- A price of a group at a tick is paid by all who are in one of its resources at the tick: at most the capacity of the
  group, by `joint/group`. Who is in a resource pays the prices of all its groups.
- An exchange price of (r, s) at t is paid by all who move from r to s or from s to r at t, and by all who are in r both
  just before t and at t. No more of them than the capacity of r: by `joint/exchange` nobody makes one of the moves;
  those who make the other are in r just before t, or at t, together with those who stay.
- At the horizon the prices end, but plans need not: from there on a robot pays no more, so that its cheapest way to
  the goal is a shortest one. Every plan is bounded, however late it comes. The prices end after the last of them too,
  which is the horizon that counts here.

Tables that would be too large are refused before the first is made. The search for the least costs takes a bounded
number of steps.
"""

from bisect import bisect_left
from collections.abc import Collection, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from itertools import accumulate
from operator import itemgetter

from carp_spec import Instance, Refusal, ResourceGraph, ResourceId, Robot, RobotId, Rule
from carp_spec.documents.bounds import BoundDocument, CutDocument, DeadlinesDocument
from carp_spec.documents.instances import digest
from carp_spec.inputs.values import require_instance
from carp_spec.model import Group
from carp_spec.rule import is_whole
from carp_verify.bound.rules import (
    LARGEST_FORMULA,
    LARGEST_RESTS,
    LARGEST_SEARCH,
    LARGEST_TABLE,
    is_about,
    is_deadline,
    is_least,
    is_new,
    is_price,
    is_rounded_up,
    is_scale,
    is_weight,
    size_fits,
)
from carp_verify.routes import Before, Place, routes_of


class Fees:
    """The prices of a robot's deadlines.

    Each (tick, price) of `arrivals` is paid by a robot that arrives by the tick. Each (tick, places, price) of `sights`
    is paid by one that is in one of the places at the tick, on its way.
    """

    def __init__(
        self,
        arrivals: Sequence[tuple[int, int]] = (),
        sights: Sequence[tuple[int, Collection[ResourceId], int]] = (),
    ) -> None:
        self.arrivals = arrivals
        self._sights = sorted(sights, key=itemgetter(0))
        self._ticks = [tick for tick, _, _ in self._sights]
        self.last = max([-1, *(tick for tick, _ in arrivals), *self._ticks])
        """The last tick at which anything is paid, if it is not negative."""

    def on_the_way(self, resource: ResourceId, first: int, end: int) -> int:
        """The payment of a robot that is in the resource in [first, end), on its way."""
        seen = self._sights[bisect_left(self._ticks, first) : bisect_left(self._ticks, end)]
        return sum(price for _, places, price in seen if resource in places)

    def at_arrival(self, tick: int) -> int:
        """The payment of a robot that enters its goal for the last time at the tick."""
        return sum(price for last, price in self.arrivals if tick <= last)


def fees_of(instance: Instance, deadlines: Sequence[DeadlinesDocument]) -> Mapping[RobotId, Fees]:
    """The prices of each robot's deadlines."""
    arrivals: dict[RobotId, list[tuple[int, int]]] = {robot: [] for robot in instance.robot}
    sights: dict[RobotId, list[tuple[int, Collection[ResourceId], int]]] = {robot: [] for robot in instance.robot}
    for each in deadlines:
        for number, (robot, tick) in enumerate(zip(each.robots, each.ticks, strict=True)):
            seen, places = each.seen[number] if each.seen else (tick, ())
            arrivals.setdefault(robot, []).append((min(tick, seen), each.price))
            sights.setdefault(robot, []).append((seen, frozenset(places), each.price))
    return {robot: Fees(paid, sights[robot]) for robot, paid in arrivals.items()}


def verify_bound(instance: Instance, certificate: BoundDocument) -> int:
    """The bound that the certificate proves of the instance; raises `Refusal` with what is wrong with it.

    No plans of all robots that can reach their goals have a smaller total cost. Where one cannot, `robots` has null.
    Cuts and deadlines know groups too.
    """
    require_instance(instance)
    _require(is_about, is_about(certificate.instance, digest(instance)), "$.instance", "it is about another instance")
    scale = certificate.scale
    _require(is_scale, is_scale(scale), "$.scale", f"the scale must be a power of two, and is {scale!r}")
    if [robot for robot, _ in certificate.robots] != list(instance.robot):
        raise Refusal("document", "$.robots", is_least.id, "it must name each robot of the instance once, in its order")
    table = _places(instance, list(instance.robot))
    _require_size(table, LARGEST_RESTS, "$.robots", "the table of robots by resources")
    tariff = Tariff(instance, certificate)
    weights, proved, clauses = _weights(instance, certificate)
    worth = _worth(instance, certificate, clauses)
    fees = fees_of(instance, certificate.deadlines)
    before = predecessors(instance)
    parts = proved - tariff.worth - worth
    budget = Budget()
    for position, (robot, (_, claimed)) in enumerate(zip(instance.robots, certificate.robots, strict=True)):
        least = RobotSearch(tariff, robot, weights[position], before, budget, fees[robot.id]).least_cost()
        message = f"robot {robot.id} can have no more than {least}, the least of its cost and prices, not {claimed!r}"
        _require(is_least, is_least(claimed, least), f"$.robots[{position}]", message)
        parts += claimed or 0
    message = f"the bound must be {-(-parts // scale)}, the sum of all parts rounded up, and is {certificate.bound!r}"
    _require(is_rounded_up, is_rounded_up(certificate.bound, parts, scale), "$.bound", message)
    return certificate.bound


def _places(instance: Instance, robots: Sequence[RobotId]) -> int:
    """The places in which so many robots are searched for: resources, for each of their stops."""
    stops = [len(instance.robot[robot].stops) if robot in instance.robot else 1 for robot in robots]
    return sum(stops) * len(instance.graph.resources)


def _require_size(size: int, limit: int, path: str, what: str) -> None:
    _require(size_fits, size_fits(size, limit), path, f"{what} would be {size}, and at most {limit} are allowed")


def _require(rule: Rule[..., bool], kept: bool, path: str, message: str) -> None:
    if not kept:
        raise Refusal("document", path, rule.id, message)


def _weights(instance: Instance, certificate: BoundDocument) -> tuple[Sequence[int], int, int]:
    """The weight of a tick for each robot, the cuts' least totals by their multipliers, and their clauses."""
    left = dict.fromkeys(instance.robot, certificate.scale)
    size = sum(_places(instance, cut.robots) for cut in certificate.cuts)
    _require_size(size, LARGEST_TABLE, "$.cuts", "the resources that robots of cuts are searched in")
    proved = clauses = 0
    for number, cut in enumerate(certificate.cuts):
        path = f"$.cuts[{number}]"
        message = f"the multiplier must be a whole number of at least 0, and is {cut.multiplier!r}"
        _require(is_weight, is_whole(cut.multiplier) and cut.multiplier >= 0, f"{path}.multiplier", message)
        _require(is_weight, len(cut.robots) > 0, f"{path}.robots", "it must name at least one robot")
        seen: set[RobotId] = set()
        for robot in cut.robots:
            known = robot in left and robot not in seen
            seen.add(robot)
            _require(is_weight, known, f"{path}.robots", f"it must name robots of the instance once, also {robot!r}")
            left[robot] -= cut.multiplier
            message = f"the multipliers of robot {robot} must add up to {certificate.scale} at most"
            _require(is_weight, is_weight(0, -left[robot]), f"{path}.multiplier", message)
        clauses += _clauses_of(instance, cut, LARGEST_FORMULA - clauses, path)
        proved += cut.multiplier * cut.least
    return list(left.values()), proved, clauses


def _worth(instance: Instance, certificate: BoundDocument, clauses: int) -> int:
    """The most that all robots together can pay for their deadlines, which are checked.

    The formulas of the cuts have `clauses` clauses already.
    """
    size = sum(_places(instance, deadlines.robots) for deadlines in certificate.deadlines)
    _require_size(size, LARGEST_TABLE, "$.deadlines", "the resources that robots with deadlines are searched in")
    worth = 0
    for number, deadlines in enumerate(certificate.deadlines):
        path = f"$.deadlines[{number}]"
        price, robots = deadlines.price, deadlines.robots
        message = f"the price must be a whole number of at least 0, and is {price!r}"
        _require(is_deadline, is_whole(price) and price >= 0, f"{path}.price", message)
        message = "it must name robots of the instance, each once, or again where it is seen later"
        known = len(robots) > 0 and instance.robot.keys() >= set(robots)
        once = len(robots) == len(set(robots)) or len(deadlines.seen) > 0
        _require(is_deadline, known and once, f"{path}.robots", message)
        clauses += _clauses_of(instance, deadlines, LARGEST_FORMULA - clauses, path)
        worth += price * (len(robots) - 1)
    return worth


def _clauses_of(instance: Instance, group: CutDocument | DeadlinesDocument, most: int, path: str) -> int:
    """The number of clauses in the formula of a cut, or of deadlines; raises `Refusal` if its refutation fails."""
    from carp_verify.bound.cuts import require_cut, require_deadlines  # noqa: PLC0415 - only they need the encoder
    from carp_verify.optimum.refutation import NotRefutedError  # noqa: PLC0415

    rule = is_weight if isinstance(group, CutDocument) else is_deadline
    try:
        if isinstance(group, CutDocument):
            return require_cut(instance, group, most)
        return require_deadlines(instance, group, most)
    except NotRefutedError as error:
        raise Refusal("document", path, rule.id, f"its proof does not hold: {error}") from error
    except Refusal as refusal:
        message = (
            f"the formulas of all groups must have at most {LARGEST_FORMULA} clauses together, and would have more"
        )
        raise Refusal("document", path, size_fits.id, message) from refusal


class Tariff:
    """The prices of a certificate; `worth` is the most that all robots together can pay."""

    def __init__(self, instance: Instance, certificate: BoundDocument) -> None:
        """Raises `Refusal` for a price that is not valid."""
        self.instance = instance
        self.worth = 0
        self.horizon = 0
        self.moves: dict[tuple[ResourceId, ...], dict[int, int]] = {}
        present: dict[ResourceId, dict[int, int]] = {}
        across: dict[ResourceId, dict[int, int]] = {}
        graph = instance.graph
        groups = {group.id: group for group in graph.groups}
        for id, tick, price in self._group_prices(certificate, groups):
            self.horizon = max(self.horizon, tick + 1)
            for resource in groups[id].resources:
                of_groups = present.setdefault(resource, {})
                of_groups[tick] = of_groups.get(tick, 0) + price
            self.worth += price * groups[id].capacity
        for place, tick, price in self._prices(certificate):
            source = place[0]
            self.horizon = max(self.horizon, tick + 1)
            if len(place) == 1:
                of_resource = present.setdefault(source, {})
                of_resource[tick] = of_resource.get(tick, 0) + price
            else:
                of_rows = across.setdefault(source, {})
                of_rows[tick] = of_rows.get(tick, 0) + price
                self.moves.setdefault(place, {})[tick] = price
            self.worth += price * graph.resource[source].capacity
        size = self.horizon * len({*present, *across})
        _require_size(size, LARGEST_TABLE, "$.resources", "the prices by resource and tick, up to the last,")
        self.present = {resource: self._sums(prices) for resource, prices in present.items()}
        self.across = {resource: self._sums(prices) for resource, prices in across.items()}

    def _group_prices(
        self, certificate: BoundDocument, groups: Mapping[ResourceId, Group]
    ) -> Iterator[tuple[ResourceId, int, int]]:
        """The prices of groups, checked."""
        known: set[tuple[ResourceId, int]] = set()
        size = sum(len(groups[id].resources) for id, _, _ in certificate.groups if id in groups)
        _require_size(size, LARGEST_TABLE, "$.groups", "the resources of groups with prices")
        for number, (id, tick, price) in enumerate(certificate.groups):
            path = f"$.groups[{number}]"
            message = f"{price!r} at {tick!r} must be a price of at least 0 at a tick below {certificate.horizon}"
            _require(is_price, is_price(price, tick, certificate.horizon), path, message)
            _require(is_price, id in groups, path, f"{id} must be a group")
            _require(is_new, is_new((id, tick), known), path, f"{id} must have one price at tick {tick}")
            known.add((id, tick))
            yield id, tick, price

    def _prices(self, certificate: BoundDocument) -> Iterator[tuple[tuple[ResourceId, ...], int, int]]:
        """The prices with their places, checked: one resource, or the two of an exchange."""
        rows: list[tuple[tuple[ResourceId, ...], int, int]] = [
            ((resource,), tick, price) for resource, tick, price in certificate.resources
        ]
        pairs = [((source, target), tick, price) for source, target, tick, price in certificate.exchanges]
        graph = self.instance.graph
        known: set[tuple[tuple[ResourceId, ...], int]] = set()
        for number, (place, tick, price) in enumerate([*rows, *pairs]):
            path = f"$.resources[{number}]" if number < len(rows) else f"$.exchanges[{number - len(rows)}]"
            message = f"{price!r} at {tick!r} must be a price of at least 0 at a tick below {certificate.horizon}"
            _require(is_price, is_price(price, tick, certificate.horizon), path, message)
            exists = place[0] in graph.index if len(place) == 1 else is_both_ways(graph, *place)
            shown = " and ".join(map(str, place))
            _require(is_price, exists, path, f"{shown} must be a resource, or two with a move each way")
            _require(is_new, is_new((place, tick), known), path, f"{shown} must have one price at tick {tick}")
            known.add((place, tick))
            yield place, tick, price

    def _sums(self, prices: Mapping[int, int]) -> Sequence[int]:
        """The sum of the prices before each tick, up to the horizon."""
        return [0, *accumulate(prices.get(tick, 0) for tick in range(self.horizon))]

    def stay(self, resource: ResourceId, enter: int, leave: int) -> int:
        """The payment of a stay in [enter, leave)."""
        paid = 0
        for sums, first in ((self.present.get(resource), enter), (self.across.get(resource), enter + 1)):
            if sums is not None and first < leave:
                paid += sums[min(leave, self.horizon)] - sums[min(first, self.horizon)]
        return paid

    def move(self, source: ResourceId, target: ResourceId, tick: int) -> int:
        """The payment of a move at the tick."""
        there, back = self.moves.get((source, target), {}), self.moves.get((target, source), {})
        return there.get(tick, 0) + back.get(tick, 0)


def is_both_ways(graph: ResourceGraph, source: ResourceId, target: ResourceId) -> bool:
    """Whether moves lead from one to the other and back."""
    return {(source, target), (target, source)} <= graph.moves


class Budget:
    """The steps that the searches of all robots may still take."""

    def __init__(self) -> None:
        self.left = LARGEST_SEARCH

    def spend(self) -> None:
        """Take one step; raises `Refusal` if that is one too many."""
        self.left -= 1
        message = f"the search for the least costs takes more than {LARGEST_SEARCH} steps"
        _require(size_fits, self.left >= 0, "$.robots", message)


class RobotSearch:
    """A* for one robot, over the resources and the ticks at which it is free to leave them.

    The remaining cost is at least the weighted ticks of a shortest way, and from the horizon on exactly that: it is not
    before the last deadline, or the last tick at which the robot is seen. A robot that vanishes at its goal, and has no
    deadline, never gains by driving on, because neither ticks nor prices are negative.
    """

    def __init__(self, tariff: Tariff, robot: Robot, weight: int, before: Before, budget: Budget, fees: Fees) -> None:
        self.tariff = tariff
        self.budget = budget
        self.robot = robot
        self.weight = weight
        self.parks = tariff.instance.after_goal == "park"
        self.fees = fees
        self.horizon = max(tariff.horizon, fees.last + 1)
        self.routes = routes_of(tariff.instance, robot, before)
        self.drives_on = self.parks or len(fees.arrivals) > 0 or self.routes.must_pass
        self.rest = self.routes.rests()
        self.number = {place: number for number, place in enumerate(self.routes.duration)}
        self.queue: list[tuple[int, int, int, Place | None, int]] = []

    def least_cost(self) -> int | None:
        """The least weighted cost plus prices of all plans of the robot alone, or `None` if it has none."""
        release = self.robot.release
        if self.routes.is_there:
            self.arrive(release, 0)
        if not self.routes.is_there or self.drives_on:
            for start in self.routes.starts:
                self.enter(start, release, 0)
        settled: set[tuple[int, int]] = set()
        while self.queue:
            estimate, minus_tick, number, here, paid = heappop(self.queue)
            if here is None or -minus_tick >= self.horizon:
                return estimate
            if (number, minus_tick) not in settled:
                settled.add((number, minus_tick))
                self.leave(here, -minus_tick, paid)
        return None

    def leave(self, place: Place, tick: int, paid: int) -> None:
        """Wait in a place for a tick, or move on from it."""
        self.budget.spend()
        here = self.routes.resource(place)
        waiting = self.tariff.stay(here, tick - 1, tick + 1) - self.tariff.stay(here, tick - 1, tick)
        self.reach(place, tick + 1, paid + waiting + self.fees.on_the_way(here, tick, tick + 1))
        for target in self.routes.successors[place]:
            moved = paid + self.tariff.move(here, self.routes.resource(target), tick)
            if target == self.routes.there:
                self.arrive(tick, moved)
            if target != self.routes.there or self.drives_on:
                self.enter(target, tick, moved)

    def enter(self, place: Place, tick: int, paid: int) -> None:
        """Stay in a place for as long as it takes."""
        resource, ready = self.routes.resource(place), tick + self.routes.duration[place]
        staying = self.tariff.stay(resource, tick, ready) + self.fees.on_the_way(resource, tick, ready)
        self.reach(place, ready, paid + staying)

    def reach(self, place: Place, tick: int, paid: int) -> None:
        """Be free to leave at the tick."""
        if place in self.rest:
            estimate = paid + self.weight * (tick + self.rest[place] - self.robot.release)
            heappush(self.queue, (estimate, -tick, self.number[place], place, paid))

    def arrive(self, tick: int, paid: int) -> None:
        """Enter the goal for the last time."""
        leave = tick + self.routes.stay
        last = self.tariff.stay(self.robot.goal, tick, max(leave, self.tariff.horizon) if self.parks else leave)
        total = paid + last + self.fees.at_arrival(tick) + self.weight * (tick - self.robot.release)
        heappush(self.queue, (total, -tick, -1, None, total))


def predecessors(instance: Instance) -> Before:
    """The resources from which one move leads to a resource."""
    before: dict[ResourceId, list[ResourceId]] = {resource: [] for resource in instance.graph.index}
    for source, targets in instance.graph.successors.items():
        for target in targets:
            before[target].append(source)
    return before
