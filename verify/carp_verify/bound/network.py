"""The places where robots can be, by number, and the least ticks between them without prices.

Landmarks are some places from and to which all distances are known. By the triangle inequality a place v is at least
as far from s as the distance to v from a landmark less that to s, and as the distance from s to a landmark less that
from v. Along a move this bound grows by no more than the ticks in the place that is left.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush
from operator import sub

from carp_spec import Instance, ResourceId
from carp_verify.routes import Routes

LANDMARKS = 8


@dataclass(frozen=True, slots=True)
class Network:
    """Places by number: their resources, the ticks that each takes at least, and where moves lead to and come from.

    `marks` has for each place its distance from each landmark, and 0 less that to it with the ticks in the landmark,
    which are the same for all places; and 0. `endless` is above all distances, and stands for that where no way leads.
    """

    resource: Sequence[ResourceId]
    duration: Sequence[int]
    successors: Sequence[Sequence[int]]
    predecessors: Sequence[Sequence[int]]
    marks: Sequence[Sequence[int]] = ()
    endless: int = field(init=False)

    def __post_init__(self) -> None:
        """Distances are sums of different places' ticks, and of those of a landmark."""
        object.__setattr__(self, "endless", 2 * sum(self.duration) + 1)

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
    network = Network(list(graph.index), [each.duration for each in graph.resources], successors, predecessors)
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


def network_over(routes: Routes) -> Network:
    """The places of a robot with several stops, which are stages, for that robot alone."""
    places = range(len(routes.stages))
    return Network(
        [routes.resource(place) for place in places],
        [routes.duration[place] for place in places],
        [[int(each) for each in routes.successors[place]] for place in places],
        [[int(each) for each in routes.predecessors[place]] for place in places],
    )
