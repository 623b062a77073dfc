"""What a robot pays by the prices of a certificate: in resources, for moves, and for the deadlines that it keeps."""

from bisect import bisect_left
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate, chain
from typing import TypeAlias

from carp_spec import Instance, ResourceId, RobotId
from carp_spec.documents.bounds import BoundDocument, DeadlinesDocument
from carp_verify.bound.rules import LARGEST_TABLE, is_new, is_price, require, require_size

Row: TypeAlias = tuple[tuple[ResourceId, ...], int, int]
"""A group, a resource or the two of an exchange, with a tick and a price."""


class Payments:
    """Prices at ticks, each with the sum of all before it."""

    def __init__(self, paid: Iterable[tuple[int, int]]) -> None:
        by_tick = sorted(paid)
        self._ticks = [tick for tick, _ in by_tick]
        self._sums = [0, *accumulate(price for _, price in by_tick)]
        self.total = self._sums[-1]

    def before(self, tick: int) -> int:
        """The sum of the prices before the tick."""
        return self._sums[bisect_left(self._ticks, tick)]


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
        self._arrived = Payments(arrivals)
        seen: dict[ResourceId, list[tuple[int, int]]] = {}
        for tick, places, price in sights:
            for place in {*places}:
                seen.setdefault(place, []).append((tick, price))
        self._seen = {place: Payments(paid) for place, paid in seen.items()}
        self.last = max([-1, *(tick for tick, _ in arrivals), *(tick for tick, _, _ in sights)])
        """The last tick at which anything is paid, if it is not negative."""

    def on_the_way(self, resource: ResourceId, first: int, end: int) -> int:
        """The payment of a robot that is in the resource in [first, end), on its way."""
        if resource not in self._seen:
            return 0
        seen = self._seen[resource]
        return seen.before(max(first, end)) - seen.before(first)

    def at_arrival(self, tick: int) -> int:
        """The payment of a robot that enters its goal for the last time at the tick."""
        return self._arrived.total - self._arrived.before(tick)


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
        size = sum(len(groups[id].resources) for id, _, _ in certificate.groups if id in groups)
        require_size(size, LARGEST_TABLE, "$.groups", "the resources of groups with prices")
        horizon, either = certificate.horizon, "a resource, or two with a move each way"
        of_groups: Iterator[Row] = (((id,), tick, price) for id, tick, price in certificate.groups)
        for (id,), tick, price in _checked("groups", of_groups, horizon, lambda place: place[0] in groups, "a group"):
            self.horizon = max(self.horizon, tick + 1)
            for resource in groups[id].resources:
                of_resource = present.setdefault(resource, {})
                of_resource[tick] = of_resource.get(tick, 0) + price
            self.worth += price * groups[id].capacity
        alone: Iterator[Row] = (((resource,), tick, price) for resource, tick, price in certificate.resources)
        pairs: Iterator[Row] = (((one, other), tick, price) for one, other, tick, price in certificate.exchanges)
        for place, tick, price in chain(
            _checked("resources", alone, horizon, lambda place: place[0] in graph.index, either),
            _checked("exchanges", pairs, horizon, lambda place: {place, place[::-1]} <= graph.moves, either),
        ):
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
        require_size(size, LARGEST_TABLE, "$.resources", "the prices by resource and tick, up to the last,")
        self.present = {resource: self._sums(prices) for resource, prices in present.items()}
        self.across = {resource: self._sums(prices) for resource, prices in across.items()}

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

    def wait(self, resource: ResourceId, tick: int) -> int:
        """The payment of a tick of waiting: that of a stay that goes on for the tick."""
        paid = 0
        for sums in (self.present.get(resource), self.across.get(resource)):
            if sums is not None and tick < self.horizon:
                paid += sums[tick + 1] - sums[tick]
        return paid

    def move(self, source: ResourceId, target: ResourceId, tick: int) -> int:
        """The payment of a move at the tick."""
        paid = 0
        for prices in (self.moves.get((source, target)), self.moves.get((target, source))):
            if prices is not None:
                paid += prices.get(tick, 0)
        return paid


def _checked(
    field: str, rows: Iterable[Row], horizon: int, exists: Callable[[tuple[ResourceId, ...]], bool], right: str
) -> Iterator[Row]:
    """The prices of a field of a certificate, each checked before it is given."""
    known: set[tuple[tuple[ResourceId, ...], int]] = set()
    for number, (place, tick, price) in enumerate(rows):
        path, shown = f"$.{field}[{number}]", " and ".join(map(str, place))
        message = f"{price!r} at {tick!r} must be a price of at least 0 at a tick below {horizon}"
        require(is_price, is_price(price, tick, horizon), path, message)
        require(is_price, exists(place), path, f"{shown} must be {right}")
        require(is_new, is_new((place, tick), known), path, f"{shown} must have one price at tick {tick}")
        known.add((place, tick))
        yield place, tick, price
