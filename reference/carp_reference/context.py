"""The context of a query: free time windows, and moves of the committed plans."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from carp_spec import Instance, Move, Plan, ResourceId, Visit
from carp_spec.windows import Occupation, Window, free_windows


@dataclass(frozen=True, slots=True)
class Context:
    """The stays of committed plans by resource, and their moves with the ticks."""

    instance: Instance
    occupations: Mapping[ResourceId, Sequence[Occupation]]
    moves: frozenset[tuple[int, Move]]

    def windows(self, resource: ResourceId) -> tuple[Window, ...]:
        """The free windows of the resource, in order of time."""
        capacity = self.instance.graph.resource[resource].capacity
        return free_windows(self.occupations.get(resource, ()), capacity, self.instance.gap)

    def window_around(self, visit: Visit) -> Window | None:
        """The free window that holds the whole visit, if there is one."""
        windows = self.windows(visit.resource)
        return next((each for each in windows if each.start <= visit.enter and each.lasts_until(visit.leave)), None)

    def is_exchange(self, tick: int, source: ResourceId, target: ResourceId) -> bool:
        """Whether a committed robot makes the opposite move at the tick."""
        return (tick, (target, source)) in self.moves

    def allows(self, visits: Sequence[Visit]) -> bool:
        """Whether a robot can make these visits together with the committed plans."""
        free = all(self.window_around(visit) is not None for visit in visits)
        return free and not any(self.is_exchange(to.enter, at.resource, to.resource) for at, to in pairwise(visits))


def context_of(instance: Instance, committed: Sequence[Plan]) -> Context:
    """Collect the stays and the moves of the committed plans."""
    occupations: dict[ResourceId, list[Occupation]] = defaultdict(list)
    for plan in committed:
        for visit in plan.visits:
            occupations[visit.resource].append((visit.enter, visit.leave))
    moves = ((to.enter, (at.resource, to.resource)) for plan in committed for at, to in pairwise(plan.visits))
    return Context(instance, occupations, frozenset(moves))
