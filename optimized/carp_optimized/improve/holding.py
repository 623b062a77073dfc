"""Plans in an order by which nobody is walled in: each robot holds its start until it is planned.

CARP lets a robot pass through, wait in or end at the start of another that is planned later, and may so leave that one
no way out. Here each start is held by the robot that stands there, for ever, until its turn comes. A robot that stands
where another ends is planned before that one. Where robots vanish, and ways lead past the starts, each can then wait at
its start until those before it have gone. Robots that stand in a circle, each where the next one ends, may still fail:
one of them finds another's plan at its start. So circles are planned first.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence

from carp_optimized.fleet import PlannedFleet
from carp_optimized.settling import plan_again
from carp_optimized.state.arrays import ALONE
from carp_spec import Instance, Plan, Visit


def plan_holding_starts(
    instance: Instance, order: Sequence[int], goes_on: Callable[[int], bool], asked: int = ALONE
) -> PlannedFleet:
    """A fleet with the plans of one pass over the robots of the order, as long as it goes on after so many visits."""
    fleet = PlannedFleet(instance)
    held = _Held(instance, order)
    fleet.commit([_standing(instance, robot) for robot in held.robots])
    for robot in _standing_first(held, order):
        if not goes_on(fleet.visits):
            break
        fleet.withdraw(held.give_up(robot))
        plan_again(fleet, robot, asked=asked)
    fleet.withdraw([*held.robots])
    return fleet


def _standing(instance: Instance, robot: int) -> Plan:
    each = instance.robots[robot]
    return Plan(each.id, (Visit(each.start, each.release, None),))


class _Held:
    """The robots that hold their starts, and by resource and group those that do; as many as it has room for."""

    def __init__(self, instance: Instance, order: Sequence[int]) -> None:
        self._graph, self._robots = instance.graph, instance.robots
        self._room = [each.capacity for each in instance.graph.constraints]
        self._inside: dict[int, dict[int, None]] = defaultdict(dict)
        self.robots: dict[int, None] = {}
        for robot in order:
            places = self._graph.constraints_of(self._robots[robot].start)
            if all(len(self._inside[place]) < self._room[place] for place in places):
                self.robots[robot] = None
                for place in places:
                    self._inside[place][robot] = None

    def in_the_way(self, robot: int) -> list[int]:
        """The others that hold places at which the robot must stop, and that have no room left."""
        stops = dict.fromkeys(stop.resource for stop in self._robots[robot].stops)
        full = [
            place
            for stop in stops
            for place in self._graph.constraints_of(stop)
            if len(self._inside[place].keys() - {robot}) == self._room[place]
        ]
        return [each for place in full for each in self._inside[place] if each != robot]

    def give_up(self, robot: int) -> list[int]:
        """The robot, and those still in its way, no longer hold their starts; those that did."""
        gone = [each for each in dict.fromkeys([robot, *self.in_the_way(robot)]) if each in self.robots]
        for each in gone:
            del self.robots[each]
            for place in self._graph.constraints_of(self._robots[each].start):
                del self._inside[place][each]
        return gone


def _standing_first(held: _Held, order: Sequence[int]) -> list[int]:
    """The order, changed so that who is in the way of another comes before it; who stand in circles come first."""
    others = {robot: held.in_the_way(robot) for robot in order}
    changed = _others_first(others, order)
    place = {robot: number for number, robot in enumerate(changed)}
    circles = [each for robot in changed for each in others[robot] if place[each] > place[robot]]
    return _others_first(others, [*circles, *order])


def _others_first(others: Mapping[int, Sequence[int]], order: Sequence[int]) -> list[int]:
    """The order, changed so that its others come before each robot, but for one of each circle."""
    seen: set[int] = set()
    changed: list[int] = []
    for first in order:
        stack = [] if first in seen else [first]
        while stack:
            seen.add(stack[-1])
            following = next((each for each in others[stack[-1]] if each not in seen), None)
            if following is None:
                changed.append(stack.pop())
            else:
                stack.append(following)
    return changed
