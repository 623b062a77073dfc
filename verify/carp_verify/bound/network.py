"""The places where robots can be, by number, and the least ticks between them without prices.

Landmarks are some places from and to which all distances are known. By the triangle inequality a place v is at least
as far from s as the distance to v from a landmark less that to s, and as the distance from s to a landmark less that
from v. Along a move this bound grows by no more than the ticks in the place that is left.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from operator import sub
from typing import TypeVar, overload

from carp_spec import Instance, ResourceId, Robot

LANDMARKS = 8


T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _Made(Sequence[T]):
    """What a function makes of each number below the size."""

    size: int
    make: Callable[[int], T]

    def __len__(self) -> int:
        return self.size

    @overload
    def __getitem__(self, place: int) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[T]: ...
    def __getitem__(self, place: int | slice) -> T | Sequence[T]:
        if isinstance(place, slice):
            return [self.make(each) for each in range(*place.indices(self.size))]
        return self.make(place)


@dataclass(frozen=True, slots=True)
class Network:
    """Places by number: their resources, the ticks that each takes at least, and where moves lead to and come from.

    `marks` has for each place its distance from each landmark, and 0 less that to it with the ticks in the landmark,
    which are the same for all places; and 0. `endless` is above all distances, which are sums of different places'
    ticks, and of those of a landmark; and stands for that where no way leads.
    """

    resource: Sequence[ResourceId]
    duration: Sequence[int]
    successors: Sequence[Sequence[int]]
    predecessors: Sequence[Sequence[int]]
    endless: int
    marks: Sequence[Sequence[int]] = ()

    def apart(self, source: int) -> Callable[[int], int]:
        """A lower bound on the distance from the source to a place: 0 without landmarks."""
        marks = self.marks
        if not marks:
            return lambda _: 0
        of_source = marks[source]
        return lambda place: max(map(sub, marks[place], of_source))

    def leads(self, source: int, target: int) -> bool:
        """Whether a way leads from the source to a landmark, and on to the target; if not, one may lead elsewhere."""
        if not self.marks:
            return False
        after, before = self.marks[target][:-1:2], self.marks[source][1::2]
        return any(there < self.endless and -back < self.endless for there, back in zip(after, before, strict=True))


def distances(
    network: Network,
    first: Iterable[int],
    neighbours: Sequence[Sequence[int]],
    is_wanted: Callable[[int, int], bool] = lambda _place, _ticks: True,
) -> Mapping[int, int]:
    """Dijkstra: 0 for the first places, and for each neighbour the place's own ticks more, by wanted places alone."""
    settled: dict[int, int] = {}
    waiting: dict[int, list[int]] = {0: list(first)}
    queue = [0]
    while queue:
        ticks = heappop(queue)
        for place in waiting.pop(ticks):
            if place not in settled and is_wanted(place, ticks):
                settled[place] = ticks
                later = ticks + network.duration[place]
                if later not in waiting:
                    waiting[later] = []
                    heappush(queue, later)
                waiting[later] += neighbours[place]
    return settled


def network_of(instance: Instance) -> Network:
    """The places of robots with goals alone, which are the resources, for a pace of 1."""
    graph = instance.graph
    successors = [[graph.index[target] for target in graph.successors[each]] for each in graph.index]
    predecessors: list[list[int]] = [[] for _ in successors]
    for source, targets in enumerate(successors):
        for target in targets:
            predecessors[target].append(source)
    durations = [each.duration for each in graph.resources]
    network = Network(list(graph.index), durations, successors, predecessors, 2 * sum(durations) + 1)
    return (
        replace(network, marks=_marks(network, graph.index[instance.robots[0].start])) if instance.robots else network
    )


def _marks(network: Network, place: int) -> Sequence[Sequence[int]]:
    """The distances of landmarks, each as far from those before it as can be: the first from the place."""
    columns: list[list[int]] = []
    nearest = distances(network, [place], network.successors)
    for _ in range(LANDMARKS):
        mark = max(nearest, key=nearest.__getitem__)
        after = distances(network, [mark], network.successors)
        before = distances(network, [mark], network.predecessors)
        places = range(len(network.duration))
        columns.append([after.get(each, network.endless) for each in places])
        columns.append([-before.get(each, network.endless) - network.duration[each] for each in places])
        nearest = {each: min(ticks, after[each]) for each, ticks in nearest.items() if each in after}
    return list(zip(*columns, [0] * len(network.duration), strict=True))


def network_over(network: Network, instance: Instance, robot: Robot) -> tuple[Network, Sequence[int], int]:
    """The places of a robot with several stops, for that robot alone; those where it begins, and that of its goal.

    For each number of stops served there is a layer of all resources. After the layers, each stop but the last has the
    place of the visit in which it is served. They are made as they are asked for.
    """
    index, size, last = instance.graph.index, len(network.resource), len(robot.stops) - 1
    stops = [index[stop.resource] for stop in robot.stops]
    services = [instance.stay(robot.id, stop) for stop in robot.stops[:last]]
    layers = size * (last + 1)

    def at(place: int) -> tuple[int, int]:
        """How many stops are served once the place is left, and its resource."""
        return divmod(place, size) if place < layers else (place - layers + 1, stops[place - layers])

    def entered(served: int, here: int) -> list[int]:
        """The places that a robot enters with a resource, with so many stops served before."""
        serving = [layers + served] if served < last and stops[served] == here else []
        return [served * size + here, *serving]

    def left(served: int, here: int) -> list[int]:
        """The places that a robot leaves with a resource, with so many stops served by then."""
        serving = [layers + served - 1] if served > 0 and stops[served - 1] == here else []
        return [served * size + here, *serving]

    def duration(place: int) -> int:
        return services[place - layers] if place >= layers else robot.pace * network.duration[place % size]

    def successors(place: int) -> list[int]:
        served, here = at(place)
        return [each for target in network.successors[here] for each in entered(served, target)]

    def predecessors(place: int) -> list[int]:
        served, here = at(place)
        before = served - (place >= layers)
        return [each for source in network.predecessors[here] for each in left(before, source)]

    ticks = robot.pace * sum(network.duration) * (last + 1) + sum(services)
    over = Network(
        _Made(layers + last, lambda place: network.resource[at(place)[1]]),
        _Made(layers + last, duration),
        _Made(layers + last, successors),
        _Made(layers + last, predecessors),
        2 * ticks + 1,
    )
    return over, entered(0, index[robot.start]), last * size + stops[last]
