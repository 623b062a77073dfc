"""The action dependency graph of a solution: which visits wait for which others if robots keep the planned order.

An edge leads to a visit that waits from the visit whose *entry* it waits for, with the least ticks between the two
entries. Source: Hönig et al. 2019.
"""

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from carp_spec.limits import refuse
from carp_spec.model import Instance, Plan, ResourceId, RobotId, Visit
from carp_spec.plan_rules import least_stays

Node: TypeAlias = tuple[RobotId, int]
"""A robot and the position of a visit in its plan."""


@dataclass(frozen=True, slots=True)
class Stay:
    """A visit of a lawful plan, and the resources before and after it."""

    node: Node
    visit: Visit
    source: ResourceId | None
    target: ResourceId | None


@dataclass(frozen=True, slots=True)
class Dependency:
    """The visit `after` is entered no earlier than `ticks` after the visit `before`.

    `travel` keeps a robot in a resource for the duration, or for the service of a stop. `order` lets a robot enter
    `resource` only after another has left it, by entering its next visit or by staying as long as its last takes.
    """

    kind: Literal["travel", "order"]
    before: Node
    after: Node
    ticks: int
    resource: ResourceId


def stays_by_resource(plans: Sequence[Plan]) -> dict[ResourceId, list[Stay]]:
    """The stays of all plans in each resource."""
    stays: dict[ResourceId, list[Stay]] = defaultdict(list)
    for plan in plans:
        ways = [None, *(visit.resource for visit in plan.visits), None]
        for place, visit in enumerate(plan.visits):
            stays[visit.resource].append(Stay((plan.robot, place), visit, ways[place], ways[place + 2]))
    return stays


def dependencies(instance: Instance, plans: Sequence[Plan]) -> Iterator[Dependency]:
    """The edges of the dependency graph of lawful plans, without those that follow from others."""
    refuse(instance, "groups")
    least = {plan.robot: least_stays(instance, plan) for plan in plans}
    for plan in plans:
        for place, visit in enumerate(plan.visits[:-1]):
            ticks = least[plan.robot][place]
            yield Dependency("travel", (plan.robot, place), (plan.robot, place + 1), ticks, visit.resource)
    for resource, stays in stays_by_resource(plans).items():
        for one, other in _direct(instance, stays):
            is_opposite = one.target is not None and one.target == other.source
            ticks = max(instance.gap, int(is_opposite))
            robot, place = one.node
            if one.target is None:
                yield Dependency("order", one.node, other.node, least[robot][place] + ticks, resource)
            else:
                yield Dependency("order", (robot, place + 1), other.node, ticks, resource)


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


def shortest_cycle(edges: Sequence[Dependency]) -> tuple[Dependency, ...]:
    """The edges of the first shortest cycle, if there is one; the cycles of lawful plans have edges of no ticks."""
    following: dict[Node, list[Dependency]] = defaultdict(list)
    for edge in edges:
        if edge.ticks == 0:
            following[edge.before].append(edge)
    return min(filter(None, (_way_back(following, start) for start in following)), key=len, default=())


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
