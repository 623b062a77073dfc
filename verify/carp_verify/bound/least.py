"""The least that one robot can pay, in ticks and in prices, as far as a certificate claims it.

A robot is free to leave a place at a tick, and has paid an amount. Its estimate is the amount and the weighted ticks of
a shortest way from there: no plan through it costs less, as neither ticks nor prices are negative. So where the
estimate is not below the claim, nothing that follows refutes the claim, and the search does not go there. Three things
follow.

- A claim that is no more than the weighted ticks of a shortest way needs no step at all.
- Of the ways without time, only those are looked for that are shorter than the claim by themselves. A place that is not
  on one of them has no rest, and is not entered.
- All that is left is gone through tick by tick. Each step leads to a later tick, so that the least amounts at a tick
  are known once it is reached.

From the horizon on nothing is paid, so that the estimate is then what the robot costs. The horizon is not before the
last price, the last deadline, or the last tick at which the robot is seen. A robot that vanishes at its goal never
gains by driving on if it has no deadline.
"""

from collections.abc import Mapping, Sequence
from heapq import heappop, heappush
from itertools import pairwise

from carp_spec import Robot
from carp_verify.bound.network import Network, distances, network_over
from carp_verify.bound.rules import require, size_fits
from carp_verify.bound.tariff import Fees, Tariff


class Budget:
    """The steps that the searches of all robots may still take."""

    def __init__(self, most: int) -> None:
        self.most = self.left = most

    def spend(self, steps: int) -> None:
        """Take so many steps; raises `Refusal` if they are too many."""
        self.left -= steps
        if self.left < 0:
            message = f"the search for the least costs takes more than {self.most} steps"
            require(size_fits, size_fits(self.most - self.left, self.most), "$.robots", message)


class RobotSearch:
    """The search for what one robot pays at least, with this weight of a tick."""

    def __init__(self, tariff: Tariff, robot: Robot, weight: int, network: Network, budget: Budget, fees: Fees) -> None:
        """`network` is that of robots with goals alone."""
        self.tariff = tariff
        self.budget = budget
        self.robot = robot
        self.weight = weight
        self.fees = fees
        self.horizon = max(tariff.horizon, fees.last + 1)
        self.parks = tariff.instance.after_goal == "park"
        self.stay = tariff.instance.stay(robot.id, robot.stops[-1])
        self._locate(network)
        must_pass = self.stay > self.pace * self.network.duration[self.there]
        self.drives_on = self.parks or len(fees.arrivals) > 0 or must_pass
        self.least = 0
        self.ahead: Mapping[int, int] = {}
        self.through: Mapping[int, int] = {}
        self.reached: dict[int, dict[int, int]] = {}
        self.ticks: list[int] = []

    def _locate(self, network: Network) -> None:
        """Find the places where the plan begins, and that of the goal; of several stops, in a network of their own."""
        robot, index = self.robot, self.tariff.instance.graph.index
        self.of_goals_alone = network
        self.network, self.pace = network, robot.pace
        self.starts: Sequence[int] = (index[robot.start],)
        self.there = index[robot.goal]
        self.is_there = len(robot.stops) == 1 and robot.start == robot.goal
        if len(robot.stops) > 1:
            self.network, self.starts, self.there = network_over(network, self.tariff.instance, robot)
            self.pace = 1

    def has_way(self) -> bool:
        """Whether a way leads to the goal, past all stops."""
        index = self.tariff.instance.graph.index
        places = [index[self.robot.start], *(index[stop.resource] for stop in self.robot.stops)]
        serves_at_start = len(self.robot.stops) > 1 and places[0] == places[1]
        legs = dict.fromkeys(pairwise(places[1:] if serves_at_start else places))
        return self.is_there or all(self._leads(*leg) for leg in legs)

    def _leads(self, one: int, other: int) -> bool:
        """Whether one or more moves lead from one resource to the other."""
        network = self.of_goals_alone
        if one != other and network.leads(one, other):
            return True
        return one in distances(network, network.predecessors[other], network.predecessors)

    def least_cost(self, claimed: int) -> int:
        """The least weighted cost plus prices of all plans of the robot alone, or the claimed cost if that is less."""
        self.least = claimed
        self.ahead = self._ahead(claimed)
        takes, each = self.network.duration, self.weight * self.pace
        self.through = {place: ticks + each * takes[place] for place, ticks in self.ahead.items()}
        release = self.robot.release
        if self.is_there:
            self.arrive(release, 0)
        if not self.is_there or self.drives_on:
            for start in self.starts:
                self.enter(start, release, 0)
        while self.ticks:
            tick = heappop(self.ticks)
            reached = self.reached.pop(tick)
            if tick >= self.horizon:
                self.least = min(self.least, *(cost + self.ahead[place] for place, cost in reached.items()))
            else:
                self.budget.spend(len(reached))
                for place, cost in reached.items():
                    self.leave(place, tick, cost)
        return self.least

    def _ahead(self, claimed: int) -> Mapping[int, int]:
        """The weighted ticks of a shortest way from leaving each place to the goal, if it costs less than claimed.

        From the start to the place a way takes at least what the landmarks say. Along a move that grows by no more than
        the ticks in the place that is left. So a shortest way from a wanted place goes on through wanted places alone.
        """
        if claimed <= 0:
            return {}
        network, each = self.network, self.weight * self.pace
        most = -(-claimed // each) if each > 0 else network.endless * 2
        apart = network.apart(self.starts[0])

        def is_wanted(place: int, rest: int) -> bool:
            return rest + network.duration[place] + apart(place) < most

        first = network.predecessors[self.there]
        return {
            place: each * rest for place, rest in distances(network, first, network.predecessors, is_wanted).items()
        }

    def leave(self, place: int, tick: int, cost: int) -> None:
        """Wait in a place for a tick, or move on from it. Prices are looked up where it costs less than claimed."""
        here = self.network.resource[place]
        if cost + self.weight + self.ahead[place] < self.least:
            waiting = self.tariff.wait(here, tick) + self.fees.on_the_way(here, tick, tick + 1)
            self.reach(place, tick + 1, cost + self.weight + waiting)
        for target in self.network.successors[place]:
            is_there = target == self.there
            goes_on = cost + self.through.get(target, self.least) < self.least and (self.drives_on or not is_there)
            if is_there or goes_on:
                moved = cost + self.tariff.move(here, self.network.resource[target], tick)
                if is_there:
                    self.arrive(tick, moved)
                if goes_on:
                    self.enter(target, tick, moved)

    def enter(self, place: int, tick: int, cost: int) -> None:
        """Stay in a place for as long as it takes."""
        resource, takes = self.network.resource[place], self.pace * self.network.duration[place]
        staying = self.tariff.stay(resource, tick, tick + takes) + self.fees.on_the_way(resource, tick, tick + takes)
        self.reach(place, tick + takes, cost + self.weight * takes + staying)

    def reach(self, place: int, tick: int, cost: int) -> None:
        """Be free to leave at the tick."""
        if place in self.ahead and cost + self.ahead[place] < self.least:
            if tick not in self.reached:
                self.reached[tick] = {}
                heappush(self.ticks, tick)
            at = self.reached[tick]
            at[place] = min(cost, at.get(place, cost))

    def arrive(self, tick: int, cost: int) -> None:
        """Enter the goal for the last time."""
        leave = tick + self.stay
        last = self.tariff.stay(self.robot.goal, tick, max(leave, self.tariff.horizon) if self.parks else leave)
        self.least = min(self.least, cost + last + self.fees.at_arrival(tick))
