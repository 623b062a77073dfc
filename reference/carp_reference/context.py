"""The context of a query: free time windows, and moves of the committed plans."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

from carp_spec import Instance, Plan, ResourceId, Visit
from carp_spec.windows import Occupation, Window, free_windows


@dataclass(frozen=True, slots=True)
class Context:
    """The stays of committed plans by constraint, and their moves from area to area with the ticks."""

    instance: Instance
    capacities: Sequence[int]
    occupations: Mapping[int, Sequence[Occupation]]
    moves: frozenset[tuple[int, int, int]]

    def windows(self, resource: ResourceId) -> tuple[Window, ...]:
        """The free windows of the resource, in order of time."""
        constraints = self.instance.graph.constraints_of(resource)
        limits = [(self.occupations.get(each, ()), self.capacities[each]) for each in constraints]
        return free_windows(limits, self.instance.gap)

    def window_around(self, visit: Visit) -> Window | None:
        """The free window that holds the whole visit, if there is one."""
        windows = self.windows(visit.resource)
        return next((each for each in windows if each.start <= visit.enter and each.lasts_until(visit.leave)), None)

    def is_exchange(self, tick: int, source: ResourceId, target: ResourceId) -> bool:
        """Whether a committed robot moves at the tick from an area of the target to one of the source."""
        graph = self.instance.graph
        back = product(graph.areas_of(target), graph.areas_of(source))
        return any((tick, *areas) in self.moves for areas in back)

    def allows(self, visits: Sequence[Visit]) -> bool:
        """Whether a robot can make these visits together with the committed plans."""
        free = all(self.window_around(visit) is not None for visit in visits)
        return free and not any(self.is_exchange(to.enter, at.resource, to.resource) for at, to in pairwise(visits))


def context_of(instance: Instance, committed: Sequence[Plan]) -> Context:
    """Collect the stays and the moves of the committed plans; within a constraint, a robot that moves on stays."""
    graph = instance.graph
    occupations: dict[int, list[Occupation]] = defaultdict(list)
    for plan in committed:
        before: Sequence[int] = ()
        for visit in plan.visits:
            constraints = graph.constraints_of(visit.resource)
            for each in constraints:
                enter = occupations[each].pop()[0] if each in before else visit.enter
                occupations[each].append((enter, visit.leave))
            before = constraints
    moves = (
        (to.enter, *areas)
        for plan in committed
        for at, to in pairwise(plan.visits)
        for areas in product(graph.areas_of(at.resource), graph.areas_of(to.resource))
    )
    capacities = [constraint.capacity for constraint in graph.constraints]
    return Context(instance, capacities, occupations, frozenset(moves))
