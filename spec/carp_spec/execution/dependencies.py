"""The action dependency graph of a solution: which visits wait for which others if robots keep the planned order.

An edge leads to a visit that waits from the visit whose *entry* it waits for, with the least ticks between the two
entries. Source: Hönig et al. 2019.
"""

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias, cast

from msgspec import structs

from carp_spec.model import Instance, Plan, ResourceGraph, ResourceId, RobotId, Visit
from carp_spec.plan_rules import least_stays

Node: TypeAlias = tuple[RobotId, int]
"""A robot and the position of a visit in its plan."""


@dataclass(frozen=True, slots=True)
class Stay:
    """The visits of a lawful plan, one after the other, to a resource or a group, and the resources before and after.

    `node` is the first of them, `last` the last. `visit` is to the resource of the first, and is left with the last.
    """

    node: Node
    last: Node
    visit: Visit
    source: ResourceId | None
    target: ResourceId | None


@dataclass(frozen=True, slots=True)
class Dependency:
    """The visit `after` is entered no earlier than `ticks` after the visit `before`.

    `travel` keeps a robot in a resource for the duration, or for the service of a stop. `order` lets a robot enter
    `resource` only after another has left it, or a group that both lie in, by entering its next visit or by staying as
    long as its last takes. `constraint` is the index of that resource or group. `holds` tells whether the ticks hold
    the least stay of the visit `before`; else they count from the move into it.
    """

    kind: Literal["travel", "order"]
    before: Node
    after: Node
    ticks: int
    resource: ResourceId
    constraint: int = 0
    holds: bool = False


def stays_by_constraint(graph: ResourceGraph, plans: Sequence[Plan]) -> dict[int, list[Stay]]:
    """The stays of all plans in each resource and each group."""
    stays: dict[int, list[Stay]] = defaultdict(list)
    for plan in plans:
        _add_stays(stays, graph, plan)
    return stays


def _add_stays(stays: dict[int, list[Stay]], graph: ResourceGraph, plan: Plan) -> None:
    """Add the stays of one more plan."""
    ways = [None, *(visit.resource for visit in plan.visits), None]
    before: Sequence[int] = ()
    for place, visit in enumerate(plan.visits):
        node, target = (plan.robot, place), ways[place + 2]
        constraints = graph.constraints_of(visit.resource)
        for each in constraints:
            stay = Stay(node, node, visit, ways[place], target)
            if each in before:
                one = stays[each].pop()
                whole = structs.replace(one.visit, leave=visit.leave)
                stay = replace(one, last=node, visit=whole, target=target)
            stays[each].append(stay)
        before = constraints


def dependencies(instance: Instance, plans: Sequence[Plan]) -> Iterator[Dependency]:
    """The edges of the dependency graph of lawful plans, without those that follow from others."""
    graph, index = instance.graph, instance.graph.index
    least: dict[RobotId, Sequence[int]] = {}
    stays: dict[int, list[Stay]] = defaultdict(list)
    for plan in plans:
        least[plan.robot] = least_stays(instance, plan)
        _add_stays(stays, graph, plan)
        for place, visit in enumerate(plan.visits[:-1]):
            ticks = least[plan.robot][place]
            following = (plan.robot, place + 1)
            yield Dependency(
                "travel", (plan.robot, place), following, ticks, visit.resource, index[visit.resource], True
            )
    for constraint, there in stays.items():
        for one, other in _direct(instance, there):
            robot, place = one.last
            yield waiting(instance, constraint, one, other, least[robot][place])


def waiting(instance: Instance, constraint: int, one: Stay, other: Stay, least: int) -> Dependency:
    """The edge by which the other stay in the constraint begins after one, whose last visit takes `least` ticks."""
    graph = instance.graph
    opposite = one.target is not None and other.source is not None and graph.is_area(constraint)
    is_opposite = opposite and graph.are_close(cast("ResourceId", one.target), cast("ResourceId", other.source))
    ticks = max(instance.gap, int(is_opposite))
    if one.target is None:
        return Dependency("order", one.last, other.node, least + ticks, other.visit.resource, constraint, True)
    robot, place = one.last
    return Dependency("order", (robot, place + 1), other.node, ticks, other.visit.resource, constraint)


def _direct(instance: Instance, stays: Sequence[Stay]) -> Iterator[tuple[Stay, Stay]]:
    """The pairs of stays, the first before the second, with none between."""
    left = sorted(
        ((stay.visit.leave + instance.gap, place) for place, stay in enumerate(stays) if stay.visit.leave is not None),
    )
    ends = [end for end, _ in left]
    latest: list[int] = []
    for _, place in left:
        latest.append(max(stays[place].visit.enter, latest[-1] if latest else 0))
    for other in stays:
        count = bisect_right(ends, other.visit.enter)
        if count:
            for _, place in left[bisect_right(ends, latest[count - 1]) : count]:
                yield stays[place], other


def shortest_cycle(edges: Iterable[Dependency]) -> tuple[Dependency, ...]:
    """The edges of the first shortest cycle, if there is one; the cycles of lawful plans have edges of no ticks."""
    return shortest(cycles(edges))


def shortest(found: Iterable[tuple[Dependency, ...]]) -> tuple[Dependency, ...]:
    """The first shortest of some cycles; those without edges do not count."""
    return min(filter(None, found), key=len, default=())


def cycles(edges: Iterable[Dependency]) -> Iterator[tuple[Dependency, ...]]:
    """For each visit that an edge of no ticks leads from, the shortest cycle through it; without edges if none is."""
    following: dict[Node, list[Dependency]] = defaultdict(list)
    for edge in edges:
        if edge.ticks == 0:
            following[edge.before].append(edge)
    for start in following:
        yield _way_back(following, start)


def _way_back(following: dict[Node, list[Dependency]], start: Node) -> tuple[Dependency, ...]:
    """The shortest way from a node back to it."""
    reached: set[Node] = set()
    ways: list[tuple[Dependency, ...]] = [()]
    for way in ways:
        for edge in following.get(way[-1].after if way else start, ()):
            if edge.after == start:
                return (*way, edge)
            if edge.after not in reached:
                reached.add(edge.after)
                ways.append((*way, edge))
    return ()
