"""What robots hold on their way: whether there is room for it, and which moves are open.

A robot holds the resource that it is in and those that it has been granted, which come next in its plan. A resource or
a group has room for as many robots as its capacity, each counted once. A robot moves on once it holds the next
resource, and gives back what it leaves. Time does not matter: a robot that may move can take as long as it likes.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from carp_spec import Instance, Plan, RobotId
from carp_spec.execution.traces import Trace

State: TypeAlias = Mapping[RobotId, int]
"""For each robot the position of the visit that it is in; -1 is before its plan, the number of visits after it."""


@dataclass(frozen=True, slots=True)
class Ways:
    """The ways of robots: for each visit of a plan the constraints on its resource, and the capacities of all.

    `stays` is whether robots stay at the end of their plans.
    """

    constraints: Mapping[RobotId, Sequence[Sequence[int]]]
    capacity: Sequence[int]
    stays: bool

    @classmethod
    def of(cls, instance: Instance, plans: Sequence[Plan]) -> "Ways":
        """The ways of the robots that have plans."""
        graph = instance.graph
        constraints = {plan.robot: [graph.constraints_of(each.resource) for each in plan.visits] for plan in plans}
        return cls(constraints, [each.capacity for each in graph.constraints], instance.after_goal == "park")

    def only(self, robots: Collection[RobotId]) -> "Ways":
        """The ways of these robots alone."""
        kept = {robot: way for robot, way in self.constraints.items() if robot in robots}
        return Ways(kept, self.capacity, self.stays)

    def held(self, robot: RobotId, first: int, last: int) -> set[int]:
        """The constraints on the resources of the visits from `first` up to and with `last`."""
        way = self.constraints[robot]
        return {each for place in range(max(first, 0), min(last + 1, len(way))) for each in way[place]}

    def has_ended(self, robot: RobotId, place: int) -> bool:
        """Whether the robot has nowhere left to go."""
        return place == len(self.constraints[robot]) - self.stays

    def overfull(self, first: State, last: State) -> Iterator[tuple[int, tuple[RobotId, ...]]]:
        """The constraints without room for the robots that hold them, with these robots."""
        holders: dict[int, list[RobotId]] = {}
        for robot in self.constraints:
            for each in self.held(robot, first[robot], last[robot]):
                holders.setdefault(each, []).append(robot)
        yield from ((each, tuple(by)) for each, by in sorted(holders.items()) if len(by) > self.capacity[each])

    def used(self, state: State) -> Counter[int]:
        """How many robots are in each constraint."""
        return Counter(each for robot, place in state.items() for each in self.held(robot, place, place))

    def is_open(self, robot: RobotId, place: int, used: Mapping[int, int]) -> bool:
        """Whether the robot may move on: it has a way to go, and there is room for it in its next resource."""
        if self.has_ended(robot, place):
            return False
        new = self.held(robot, place + 1, place + 1) - self.held(robot, place, place)
        return all(used.get(each, 0) < self.capacity[each] for each in new)


def places_of(trace: Trace, plans: Sequence[Plan]) -> State:
    """Where robots are by a trace."""
    done = {plan.robot: plan.visits for plan in trace.plans}
    gone = {robot: bool(visits) and visits[-1].leave is not None for robot, visits in done.items()}
    return {each.robot: len(done.get(each.robot, ())) - 1 + gone.get(each.robot, False) for each in plans}
