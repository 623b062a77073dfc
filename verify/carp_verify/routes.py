"""Where a robot can be on its way: in a resource or, over several stops, at a stage in one.

A stage tells how many stops are served, and whether the last of these is served in this very visit, which then takes as
long as the service. So each plan goes through stages, and whoever goes through stages, long enough in each, has a plan.
A robot with a goal alone is at no stages: it is in resources.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from typing import NamedTuple, TypeAlias

from carp_spec import Instance, ResourceId, Robot


class Stage(NamedTuple):
    """A visit to a resource with so many stops served, the last of them in this visit if it `serves`."""

    resource: ResourceId
    served: int
    serves: bool


Place: TypeAlias = ResourceId
"""A resource; of a robot with several stops the number of a stage."""
Before: TypeAlias = Mapping[ResourceId, Sequence[ResourceId]]


@dataclass(frozen=True, slots=True)
class Routes:
    """The places of a robot in visits that are not the last, and the moves between them.

    Its plan begins at one of the `starts`, or with the last visit if it `is_there`. A visit takes `duration` ticks at
    least, the last one takes `stay`. From a place of `last` a move leads to the last visit. In the place `there` the
    robot could make its last visit instead. A robot with a goal alone has no `stages`.
    """

    starts: tuple[Place, ...]
    duration: Mapping[Place, int]
    successors: Mapping[Place, Sequence[Place]]
    predecessors: Mapping[Place, Sequence[Place]]
    last: Sequence[Place]
    there: Place
    stay: int
    is_there: bool
    stages: Sequence[Stage] = ()
    by_resource: Mapping[ResourceId, Sequence[Place]] = field(default_factory=dict)

    @property
    def must_pass(self) -> bool:
        """Whether the robot may have to pass its goal, as the last visit is longer than another one there."""
        return self.stay > self.duration[self.there]

    def resource(self, place: Place) -> ResourceId:
        """The resource of a place."""
        return self.stages[int(place)].resource if self.stages else place

    def at(self, resource: ResourceId) -> Sequence[Place]:
        """The places in the resource."""
        return self.by_resource[resource] if self.stages else (resource,)

    def rests(self) -> Mapping[Place, int]:
        """The least ticks from leaving a place to entering the goal for the last time: Dijkstra."""
        number = {place: position for position, place in enumerate(self.duration)}
        rests: dict[Place, int] = {}
        queue = [(0, number[place], place) for place in self.last]
        while queue:
            rest, _, place = heappop(queue)
            if place not in rests:
                rests[place] = rest
                for source in self.predecessors[place]:
                    heappush(queue, (rest + self.duration[place], number[source], source))
        return rests

    def shortest(self, rests: Mapping[Place, int]) -> int | None:
        """The robot's cost on the empty graph, or `None` if no way leads to its goal."""
        if self.is_there:
            return 0
        return min((self.duration[place] + rests[place] for place in self.starts if place in rests), default=None)


def routes_of(instance: Instance, robot: Robot, before: Before) -> Routes:
    """The places of the robot; `before` has the resources from which one move leads to each."""
    stay = instance.stay(robot.id, robot.stops[-1])
    if len(robot.stops) > 1:
        return _over_stops(instance, robot, stay)
    duration = {each.id: instance.duration(robot.id, each.id) for each in instance.graph.resources}
    successors, goal = instance.graph.successors, robot.goal
    return Routes((robot.start,), duration, successors, before, before[goal], goal, stay, robot.start == goal)


def _over_stops(instance: Instance, robot: Robot, stay: int) -> Routes:
    *stops, _ = robot.stops
    stages = [Stage(each, served, False) for served in range(len(stops) + 1) for each in instance.graph.index]
    stages += [Stage(stop.resource, served, True) for served, stop in enumerate(stops, 1)]
    number = {stage: position for position, stage in enumerate(stages)}
    duration: dict[Place, int] = {}
    by_resource: dict[ResourceId, list[Place]] = {each: [] for each in instance.graph.index}
    for place, stage in enumerate(stages):
        by_resource[stage.resource].append(place)
        least = instance.duration(robot.id, stage.resource)
        duration[place] = instance.stay(robot.id, stops[stage.served - 1]) if stage.serves else least

    def entered(resource: ResourceId, served: int) -> list[Place]:
        """The places that a robot enters with the resource, with so many stops served before."""
        may_serve = served < len(stops) and stops[served].resource == resource
        serving = [number[Stage(resource, served + 1, True)]] if may_serve else []
        return [number[Stage(resource, served, False)], *serving]

    successors: dict[Place, list[Place]] = {}
    predecessors: dict[Place, list[Place]] = {place: [] for place in duration}
    for source, stage in enumerate(stages):
        targets = instance.graph.successors[stage.resource]
        successors[source] = [place for each in targets for place in entered(each, stage.served)]
        for target in successors[source]:
            predecessors[target].append(source)
    there = number[Stage(robot.goal, len(stops), False)]
    return Routes(
        starts=tuple(entered(robot.start, 0)),
        duration=duration,
        successors=successors,
        predecessors=predecessors,
        last=predecessors[there],
        there=there,
        stay=stay,
        is_there=False,
        stages=stages,
        by_resource=by_resource,
    )
