"""The model: resources, robots, visits, plans, instances and solutions.

Ticks are `int`, from 0. Intervals are half-open: a robot that leaves at t and one that enters at t never
share the resource. An end of `None` means for ever.

The classes may hold nonsense, which `instance_rules` and `check` find. A visit is no data class: fleets have millions,
so it is the array that documents have, read as it stands. `msgspec.structs.replace` makes one with other values.
Source: the paper, section II; ter Mors 2010 for capacities and durations.
"""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Annotated, Literal, TypeAlias

import msgspec

from carp_spec.shapes import Number, of_shape

ResourceId: TypeAlias = str | int
RobotId: TypeAlias = str | int
Move: TypeAlias = tuple[ResourceId, ResourceId]
AfterGoal: TypeAlias = Literal["vanish", "park"]
Following: TypeAlias = Literal["allowed", "forbidden"]
SEEN = 16
"""How many solutions an instance remembers."""


@dataclass(frozen=True, slots=True)
class Resource:
    """A place that robots occupy: a cell, a lane, a crossing.

    `capacity` robots fit in at a time, and each needs `duration` ticks, times its own pace, to traverse it. Its
    position, `x` and `y`, is for distances and pictures.
    """

    id: ResourceId
    capacity: Annotated[int, Number(1, "capacities")] = 1
    duration: Annotated[int, Number(1, "durations")] = 1
    x: int | None = None
    y: int | None = None


@dataclass(frozen=True, slots=True)
class Group:
    """Resources that `capacity` robots fit in together, whatever the capacity of each: a block, an intersection."""

    id: ResourceId
    resources: tuple[ResourceId, ...]
    capacity: Annotated[int, Number(1, "capacities")] = 1


@dataclass(frozen=True, slots=True)
class ResourceGraph:
    """The resources, the edges between them and groups of resources.

    An edge (r, s) of a directed graph is the move from r to s; of an undirected one, also the move back. The order of
    `resources` breaks ties. The next five fields are look-ups: resources by id, indices, where one move leads in that
    order, all moves, and for each resource of a group the indices of its groups. `seen` is of `inputs`.
    """

    resources: tuple[Resource, ...]
    edges: tuple[Move, ...]
    directed: bool = False
    groups: tuple[Group, ...] = ()
    resource: Mapping[ResourceId, Resource] = field(init=False, repr=False, compare=False)
    index: Mapping[ResourceId, int] = field(init=False, repr=False, compare=False)
    successors: Mapping[ResourceId, tuple[ResourceId, ...]] = field(init=False, repr=False, compare=False)
    moves: frozenset[Move] = field(init=False, repr=False, compare=False)
    groups_of: Mapping[ResourceId, tuple[int, ...]] = field(init=False, repr=False, compare=False)
    seen: list[Literal["right"]] = field(init=False, repr=False, compare=False)

    @of_shape("$.graph")
    def __post_init__(self) -> None:
        """Make the look-ups; edges of unknown resources are left to the rules."""
        groups_of: dict[ResourceId, tuple[int, ...]] = {}
        for place, group in enumerate(self.groups):
            for resource in group.resources:
                groups_of[resource] = (*groups_of.get(resource, ()), place)
        index = {each.id: position for position, each in enumerate(self.resources)}
        backward = () if self.directed else ((target, source) for source, target in self.edges)
        moves = [move for move in (*self.edges, *backward) if move[0] in index and move[1] in index]
        successors: dict[ResourceId, list[ResourceId]] = {each.id: [] for each in self.resources}
        for source, target in sorted(moves, key=lambda move: index[move[1]]):
            successors[source].append(target)
        object.__setattr__(self, "resource", MappingProxyType({each.id: each for each in self.resources}))
        object.__setattr__(self, "index", MappingProxyType(index))
        in_order = {source: tuple(targets) for source, targets in successors.items()}
        object.__setattr__(self, "successors", MappingProxyType(in_order))
        object.__setattr__(self, "moves", frozenset(moves))
        object.__setattr__(self, "groups_of", MappingProxyType(groups_of))
        object.__setattr__(self, "seen", [])

    def __reduce__(self) -> tuple[type["ResourceGraph"], tuple[object, ...]]:
        """Pickle the fields alone."""
        return type(self), (self.resources, self.edges, self.directed, self.groups)

    @property
    def constraints(self) -> tuple[Group, ...]:
        """What limits the robots: each resource's own capacity, as a group of it alone, then the groups."""
        return tuple(map(self.constraint, range(len(self.resources) + len(self.groups))))

    def constraint(self, index: int) -> Group:
        """The constraint of that index."""
        if index >= len(self.resources):
            return self.groups[index - len(self.resources)]
        resource = self.resources[index]
        return Group(resource.id, (resource.id,), resource.capacity)

    def constraints_of(self, resource: ResourceId) -> tuple[int, ...]:
        """The indices of the constraints on a resource: of its own capacity, and of its groups."""
        if resource not in self.groups_of:
            return (self.index[resource],)
        count = len(self.resources)
        return (self.index[resource], *(count + group for group in self.groups_of[resource]))

    def areas_of(self, resource: ResourceId) -> tuple[int, ...]:
        """Of these, the resource's own and the groups of capacity 1: resources that share one are close."""
        if resource not in self.groups_of:
            return (self.index[resource],)
        return tuple(each for each in self.constraints_of(resource) if self.is_area(each))

    def is_area(self, constraint: int) -> bool:
        """Whether the constraint of that index is a resource's own, or a group of capacity 1."""
        group = constraint - len(self.resources)
        return group < 0 or self.groups[group].capacity == 1

    def are_close(self, one: ResourceId, other: ResourceId) -> bool:
        """Whether two resources are the same or lie in one group of capacity 1."""
        return one == other or not {*self.areas_of(one)}.isdisjoint(self.areas_of(other))


@dataclass(frozen=True, slots=True)
class Stop:
    """A place that a robot serves: it stays there for at least `service` ticks, whatever its pace."""

    resource: ResourceId
    service: Annotated[int, Number(0, "stops")] = 0


@dataclass(frozen=True, slots=True, init=False)
class Robot:
    """A request: serve `stops` in order, from `start`, not before the tick `release`, at `pace` times each duration.

    A `goal` in place of stops is short for one stop there without service.
    """

    id: RobotId
    start: ResourceId
    stops: tuple[Stop, ...]
    release: Annotated[int, Number(0, "releases")] = 0
    pace: Annotated[int, Number(1, "paces")] = 1

    def __init__(
        self,
        id: RobotId,
        start: ResourceId,
        goal: ResourceId | None = None,
        release: int = 0,
        pace: int = 1,
        *,
        stops: tuple[Stop, ...] = (),
    ) -> None:
        values = (id, start, stops if goal is None else (Stop(goal),), release, pace)
        for name, value in zip(self.__match_args__, values, strict=True):
            object.__setattr__(self, name, value)

    @property
    def goal(self) -> ResourceId:
        """The resource of the last stop."""
        return self.stops[-1].resource

    def in_names(self, name: Callable[[ResourceId], ResourceId]) -> "Robot":
        """The robot with other names of resources."""
        stops = tuple(Stop(name(stop.resource), stop.service) for stop in self.stops)
        return replace(self, start=name(self.start), stops=stops)

    @property
    def has_goal_alone(self) -> bool:
        """Whether it has one stop without service."""
        return len(self.stops) == 1 and self.stops[0].service == 0


@dataclass(frozen=True, slots=True)
class Instance:
    """A resource graph, robots in the order of their arrival, and what a robot does after its goal.

    `vanish`: it leaves the system once it has served its last stop, the goal: at the earliest tick after its last
    entry. `park`: it stays. Where `following` is forbidden, a robot enters a resource only after a free tick. `robot`
    is a look-up by id, `seen` of `inputs`.
    """

    graph: ResourceGraph
    robots: tuple[Robot, ...]
    after_goal: AfterGoal = "vanish"
    following: Following = "allowed"
    robot: Mapping[RobotId, Robot] = field(init=False, repr=False, compare=False)
    seen: deque[tuple[Callable[[], "Solution | None"], bool]] = field(init=False, repr=False, compare=False)

    @of_shape("$")
    def __post_init__(self) -> None:
        """Make the look-up."""
        object.__setattr__(self, "seen", deque(maxlen=SEEN))
        object.__setattr__(self, "robot", MappingProxyType({each.id: each for each in self.robots}))

    def __reduce__(self) -> tuple[type["Instance"], tuple[object, ...]]:
        """Pickle the fields alone."""
        return type(self), (self.graph, self.robots, self.after_goal, self.following)

    def duration(self, robot: RobotId, resource: ResourceId) -> int:
        """The least ticks that the robot needs in the resource."""
        return self.robot[robot].pace * self.graph.resource[resource].duration

    def stay(self, robot: RobotId, stop: Stop) -> int:
        """The least ticks of a visit in which the robot serves the stop."""
        return max(self.duration(robot, stop.resource), stop.service)

    @property
    def gap(self) -> int:
        """The ticks for which a resource stays free after a robot: 1 where following is forbidden."""
        return int(self.following == "forbidden")


class Visit(msgspec.Struct, frozen=True, array_like=True, forbid_unknown_fields=True, gc=False):
    """A stay in a resource from the tick `enter` up to, not including, the tick `leave` (`None`: for ever)."""

    resource: ResourceId
    enter: int
    leave: int | None


@dataclass(frozen=True, slots=True)
class Plan:
    """A robot's visits in order."""

    robot: RobotId
    visits: tuple[Visit, ...]


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Solution:
    """Plans, the order in which they were made, and the robots that have none."""

    plans: tuple[Plan, ...]
    order: tuple[RobotId, ...]
    unplanned: tuple[RobotId, ...] = ()

    def plan_of(self, robot: RobotId) -> Plan | None:
        """The robot's plan, if any."""
        return next((plan for plan in self.plans if plan.robot == robot), None)

    @classmethod
    def of(cls, instance: Instance, plans: Iterable[Plan]) -> "Solution":
        """The plans in their order; all other robots of the instance are unplanned."""
        made = tuple(plans)
        order = tuple(plan.robot for plan in made)
        planned = set(order)
        return cls(made, order, tuple(robot for robot in instance.robot if robot not in planned))
