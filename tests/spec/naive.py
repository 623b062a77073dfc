"""The rules once more, tick by tick and pair by pair: slow, short, and written without looking at the checker."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations
from typing import TypeAlias

from carp_spec import Instance, Move, Plan, ResourceGraph, ResourceId, Stop, Visit

FIRST, HORIZON = -15, 45
Blamed: TypeAlias = tuple[str, Plan, Visit | None]
Crowded: TypeAlias = tuple[ResourceId, Sequence[ResourceId], int]
"""A resource or a group, its resources, and its capacity."""


def broken_plan_rules(instance: Instance, plan: Plan) -> Iterator[Blamed]:
    robot = instance.robot[plan.robot]
    graph = instance.graph
    known = {resource.id: resource.duration * robot.pace for resource in graph.resources}
    moves = set(graph.edges) if graph.directed else {*graph.edges, *((s, r) for r, s in graph.edges)}
    yield from [] if serves_all(robot.stops[:-1], plan.visits[:-1]) else [("plan/stops", plan, None)]
    if not plan.visits:
        yield from (("plan/start", plan, None), ("plan/goal", plan, None))
        return
    first, last = plan.visits[0], plan.visits[-1]
    if not (first.resource == robot.start and first.enter == robot.release):
        yield "plan/start", plan, first
    ends = {"vanish": last.enter + max(known[robot.goal], robot.stops[-1].service), "park": None}
    if not (last.resource == robot.goal and last.leave == ends[instance.after_goal]):
        yield "plan/goal", plan, last
    for visit in plan.visits:
        if visit.resource not in known:
            yield "plan/resource", plan, visit
        elif visit.leave is not None and len(range(visit.enter, visit.leave)) < known[visit.resource]:
            yield "plan/duration", plan, visit
    for visit, following in zip(plan.visits, plan.visits[1:], strict=False):
        step = (visit.resource, following.resource)
        if set(step) <= known.keys() and step not in moves:
            yield "plan/move", plan, following
        if visit.leave != following.enter:
            yield "plan/contiguous", plan, following


def serves_all(stops: Sequence[Stop], visits: Sequence[Visit]) -> bool:
    """Whether some of the visits, in order, serve one stop each."""
    return any(
        all(
            visit.resource == stop.resource and visit.leave is not None and visit.leave >= visit.enter + stop.service
            for stop, visit in zip(stops, chosen, strict=True)
        )
        for chosen in combinations(visits, len(stops))
    )


def occupies(plan: Plan, resources: Sequence[ResourceId], tick: int) -> bool:
    return any(
        visit.resource in resources and tick >= visit.enter and (visit.leave is None or tick < visit.leave)
        for visit in plan.visits
    )


def places_of(graph: ResourceGraph) -> Iterator[Crowded]:
    for resource in graph.resources:
        yield resource.id, [resource.id], resource.capacity


def groups_of(graph: ResourceGraph) -> Iterator[Crowded]:
    for group in graph.groups:
        yield group.id, group.resources, group.capacity


def crowds(places: Iterable[Crowded], plans: Sequence[Plan]) -> Iterator[tuple[ResourceId, int, frozenset[object]]]:
    """Each place and tick with too many robots, and which."""
    for place, resources, capacity in places:
        for tick in range(FIRST, HORIZON):
            robots = frozenset(plan.robot for plan in plans if occupies(plan, resources, tick))
            if len(robots) > capacity:
                yield place, tick, robots


def moves_at(instance: Instance, plan: Plan, tick: int) -> set[tuple[ResourceId, ResourceId]]:
    pairs = zip(plan.visits, plan.visits[1:], strict=False)
    steps = {(visit.resource, following.resource) for visit, following in pairs if following.enter == tick}
    return {step for step in steps if set(step) <= instance.graph.index.keys() and len(set(step)) == 2}


def close(instance: Instance, one: ResourceId, other: ResourceId) -> bool:
    return one == other or any(
        group.capacity == 1 and one in group.resources and other in group.resources for group in instance.graph.groups
    )


def exchanges(instance: Instance, plans: Sequence[Plan]) -> Iterator[tuple[int, frozenset[Move]]]:
    """Each tick and two moves, as a set, by which two robots exchange places."""
    for tick in range(FIRST, HORIZON):
        for one, other in combinations(plans, 2):
            if one.robot != other.robot:
                for r, s in moves_at(instance, one, tick):
                    for away, to in moves_at(instance, other, tick):
                        if close(instance, r, to) and close(instance, s, away):
                            yield tick, frozenset({(r, s), (away, to)})
