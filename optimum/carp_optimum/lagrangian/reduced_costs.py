"""The reduced costs of a robot's nodes and delays: what plans with them cost above the robot's least, with prices.

Take a certificate of a lower bound, and plans of all robots with a total of at most K. Weak duality counts all costs:
the excess of each robot's priced cost over its least, and the price of each capacity that is not used up, add up to the
total less the bound. So they are at most K less the bound, the *gap*. A node with a greater reduced cost is in none of
these plans (*reduced cost fixing*), and the robots share the gap.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping

from carp_spec import Instance, ResourceId, RobotId
from carp_spec.documents.bounds import BoundDocument
from carp_verify.bound.tariff import Tariff, fees_of
from carp_verify.optimum.robot_clauses import Node, RobotClauses


class PricedBound:
    """A certificate without cuts, ready to give reduced costs; `parts` is its bound in parts of a tick."""

    def __init__(self, instance: Instance, certificate: BoundDocument) -> None:
        self.instance = instance
        self.certificate = certificate
        self.scale = certificate.scale
        self.tariff = Tariff(instance, certificate)
        self.least = {robot: least or 0 for robot, least in certificate.robots}
        self.fees = fees_of(instance, certificate.deadlines)
        self.parts = sum(self.least.values()) - self.tariff.worth
        for deadlines in certificate.deadlines:
            self.parts -= deadlines.price * (len(deadlines.robots) - 1)

    def gap(self, cost: int) -> int:
        """The parts of a tick by which plans of this total cost more than the bound."""
        return cost * self.scale - self.parts


class ReducedCosts:
    """The reduced costs of a robot's `nodes` and `delays`, in parts of a tick; those left out exceed the gap.

    They are payments from the start on, tick by tick, and then those up to the goal.
    """

    def __init__(self, bound: PricedBound, robot: RobotClauses, shortest: Mapping[RobotId, int], cost: int) -> None:
        """Find them for plans of at most this total; `shortest` has the costs of all robots alone."""
        name = robot.robot.id
        self.bound = bound
        self.robot = robot
        self.goal = robot.robot.goal
        self.parks = bound.instance.after_goal == "park"
        self.gap = bound.gap(cost)
        self.fees = bound.fees[name]
        self.longest = cost - sum(shortest.values())
        self.shortest = shortest[name]
        self.paid: dict[Node, int] = {}
        self.ways: dict[Node, list[tuple[Node | None, int]]] = {}
        self.all_delays: dict[int, int] = {}
        release, start = robot.robot.release, robot.robot.start
        if start == self.goal:
            self.all_delays[0] = self.excess(0, self.stay_at_goal(release))
        if start != self.goal or robot.nodes_within(self.longest) > 0:
            ready = release + self._duration(start)
            self.pay((start, ready), self.stay(start, release, ready))
        rests: dict[Node | None, int] = {None: 0}
        for node in reversed(self.paid):
            rests[node] = min((price + rests[to] for to, price in self.ways[node] if to in rests), default=self.gap + 1)
        reduced = ((node, paid + rests[node]) for node, paid in self.paid.items())
        self.nodes = {node: cost for node, cost in reduced if cost <= self.gap}
        self.delays = {delay: cost for delay, cost in sorted(self.all_delays.items()) if cost <= self.gap}

    def pay(self, first: Node, payment: int) -> None:
        """Find the least payments from the first node up to each, in the order of ticks."""
        queue: dict[int, dict[ResourceId, int]] = defaultdict(dict)
        queue[first[1]][first[0]] = payment
        for tick in range(first[1], self.robot.earliest + self.longest + 1):
            for resource, paid in queue.pop(tick, {}).items():
                node = (resource, tick)
                delay = self.robot.least_delay(node)
                if delay > self.longest or self.excess(delay, paid) > self.gap:
                    continue
                self.paid[node] = paid
                self.ways[node] = list(self.ways_from(node, paid))
                for following, price in self.ways[node]:
                    if following is not None:
                        target, later = following
                        queue[later][target] = min(paid + price, queue[later].get(target, paid + price))

    def ways_from(self, node: Node, paid: int) -> Iterator[tuple[Node | None, int]]:
        """The following nodes with the payments on the way, and arrival with all costs less the robot's least."""
        resource, tick = node
        tariff = self.bound.tariff
        for following in self.robot.leads_to(node):
            target, later = following
            if target == resource:
                yield following, self.stay(resource, tick - 1, later) - self.stay(resource, tick - 1, tick)
            else:
                yield following, tariff.move(resource, target, tick) + self.stay(target, tick, later)
        if self.goal in self.bound.instance.graph.successors[resource]:
            delay = tick - self.robot.earliest
            last = self.excess(delay, tariff.move(resource, self.goal, tick) + self.stay_at_goal(tick))
            self.all_delays[delay] = min(paid + last, self.all_delays.get(delay, paid + last))
            yield None, last

    def excess(self, delay: int, paid: int) -> int:
        """The cost of a plan of this delay and payment above the robot's least."""
        return paid + self.bound.scale * (self.shortest + delay) - self.bound.least[self.robot.robot.id]

    def stay(self, resource: ResourceId, enter: int, leave: int) -> int:
        """The payment of a stay in [enter, leave) on the way."""
        return self.bound.tariff.stay(resource, enter, leave) + self.fees.on_the_way(resource, enter, leave)

    def stay_at_goal(self, tick: int) -> int:
        """The payment of a robot that enters its goal at the tick for the last time."""
        leave = tick + self._duration(self.goal)
        tariff = self.bound.tariff
        return self.fees.at_arrival(tick) + tariff.stay(
            self.goal, tick, max(leave, tariff.horizon) if self.parks else leave
        )

    def _duration(self, resource: ResourceId) -> int:
        return self.bound.instance.duration(self.robot.robot.id, resource)
