"""What a robot pays at least, searched for without a claim or shortcuts: the oracle of the search of the checker."""

from dataclasses import replace
from heapq import heappop, heappush

from carp_spec import Instance, ResourceId, Robot
from carp_verify.bound.least import Budget, RobotSearch
from carp_verify.bound.network import network_of
from carp_verify.bound.rules import LARGEST_SEARCH
from carp_verify.bound.tariff import Fees, Tariff
from carp_verify.routes import Before, Place, routes_of


def plain_least_cost(tariff: Tariff, robot: Robot, weight: int, fees: Fees) -> int | None:
    """What the robot pays at least, by this search."""
    return PlainSearch(tariff, robot, weight, predecessors(tariff.instance), fees).least_cost()


def least_cost_of(tariff: Tariff, robot: Robot, weight: int, fees: Fees) -> int | None:
    """The same, where the checker agrees about claims near it, with landmarks and without."""
    least = plain_least_cost(tariff, robot, weight, fees)
    network = network_of(tariff.instance)
    for shortcuts in (network, replace(network, marks=())):
        assert RobotSearch(tariff, robot, weight, shortcuts, Budget(LARGEST_SEARCH), fees).has_way() == (
            least is not None
        )
        for claimed in () if least is None else (0, least - 1, least, least + 1, 2 * least + 3):
            search = RobotSearch(tariff, robot, weight, shortcuts, Budget(LARGEST_SEARCH), fees)
            assert search.least_cost(claimed) == min(claimed, int(least or 0)), claimed
    return least


class PlainSearch:
    """A* for one robot, over the resources and the ticks at which it is free to leave them.

    The remaining cost is at least the weighted ticks of a shortest way, and from the horizon on exactly that: it is not
    before the last deadline, or the last tick at which the robot is seen. A robot that vanishes at its goal, and has no
    deadline, never gains by driving on, because neither ticks nor prices are negative.
    """

    def __init__(self, tariff: Tariff, robot: Robot, weight: int, before: Before, fees: Fees) -> None:
        self.tariff = tariff
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
