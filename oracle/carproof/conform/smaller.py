"""Smaller questions than one that fails: each takes one thing away, or several of a kind at once.

The questions of a kind are made one after the other, each of the smallest that is known by then. They go from coarse to
fine, so that a question of hundreds of robots is small after a few.
"""

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import TypeVar

from msgspec import structs

from carp_reference.execution import order_of
from carp_spec import (
    Carp,
    Group,
    Instance,
    Neighbourhood,
    Plan,
    Refusal,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Stop,
    Visit,
)
from carp_spec.requests import sound_solution
from carproof.conform.cases import EXECUTION, NUMBERS, Case, NumberOf, renamed
from carproof.execution.delays import stuck

T = TypeVar("T")
LONG_ID = 8


@dataclass(slots=True)
class Smallest:
    """The smallest question so far that fails."""

    case: Case


def smallest(case: Case, fails: Callable[[Case], bool], is_over: Callable[[], bool]) -> tuple[Case, bool]:
    """A question that fails, and whether it is minimal: none that is made of it is smaller and fails.

    It is not known to be minimal if the time was over.
    """
    best = Smallest(case)
    is_moving = True
    while is_moving:
        is_moving = False
        for kind in KINDS:
            for smaller in kind(best):
                if is_over():
                    return best.case, False
                if smaller is not None and smaller != best.case and is_question(smaller) and fails(smaller):
                    best.case, is_moving = smaller, True
    return best.case, True


def is_question(case: Case) -> bool:
    """Whether a program may be asked it: the plans given break no rule, unless they are to be checked."""
    try:
        if case.op in ("query", "add", "polish", EXECUTION):
            sound_solution(case.instance, case.solution, case.robot if case.op == "query" else None)
    except Refusal:
        return False
    return case.op != EXECUTION or not stuck(order_of(case.instance, case.solution))


def _chunks(items: Sequence[T]) -> Iterator[frozenset[T]]:
    """All items, then halves, quarters, and so on to single ones."""
    size = len(items)
    while size:
        yield from (frozenset(items[first : first + size]) for first in range(0, len(items), size))
        size //= 2


def _steps(value: int, least: int) -> Iterator[int]:
    """How much to take from a number: all, then half of it, and so on to one."""
    step = value - least
    while step > 0:
        yield step
        step //= 2


def _made(
    case: Case, instance: Instance, plans: Sequence[Plan] | None = None, gone: AbstractSet[RobotId] = frozenset()
) -> Case:
    """The question with another instance and some of its plans; a robot that loses its plan is unplanned.

    Of a solution to check, the robots that are `gone` are those that it names and the instance does not have.
    """
    plans = case.solution.plans if plans is None else plans
    kept = {plan.robot for plan in plans}
    gone = gone | (case.instance.robot.keys() - instance.robot.keys())
    lost = [plan.robot for plan in case.solution.plans if plan.robot not in kept]
    order = tuple(robot for robot in case.solution.order if robot not in gone and robot not in lost)
    unplanned = tuple(robot for robot in (*case.solution.unplanned, *lost) if robot not in gone)
    ended = tuple(plans) if case.op == "check" else tuple(_ended(instance, plan) for plan in plans)
    delays = tuple(delay for delay in case.delays if delay[0] in kept)
    solution = replace(case.solution, plans=ended, order=order, unplanned=unplanned)
    return replace(case, instance=instance, solution=solution, delays=delays)


def _ended(instance: Instance, plan: Plan) -> Plan:
    """The plan with the end of its last visit that the instance asks for."""
    *visits, last = plan.visits
    stay = instance.stay(plan.robot, instance.robot[plan.robot].stops[-1])
    leave = None if instance.after_goal == "park" else last.enter + stay
    return Plan(plan.robot, (*visits, Visit(last.resource, last.enter, leave)))


def _with_graph(case: Case, **changes: object) -> Case:
    return _made(case, replace(case.instance, graph=replace(case.instance.graph, **changes)))  # type: ignore[arg-type]


def _with_robot(case: Case, robot: RobotId, **changes: object) -> Instance:
    changed = (replace(r, **changes) if r.id == robot else r for r in case.instance.robots)  # type: ignore[arg-type]
    return replace(case.instance, robots=tuple(map(_once, changed)))


def _once(robot: Robot) -> Robot:
    """The robot with one stop where neighbouring ones came to be at one place."""
    stops = robot.stops
    kept = tuple(stop for place, stop in enumerate(stops) if stop.resource != stops[max(place - 1, 0)].resource)
    return replace(robot, stops=(stops[0], *kept))


def _with_visits(case: Case, change: Callable[[Visit], Visit]) -> list[Plan]:
    return [Plan(plan.robot, tuple(map(change, plan.visits))) for plan in case.solution.plans]


def _fewer_robots(best: Smallest) -> Iterator[Case]:
    named = best.case.solution
    for some in _chunks([*dict.fromkeys((*best.case.instance.robot, *named.order, *named.unplanned))]):
        case = best.case
        gone = some - {case.robot}
        instance = replace(case.instance, robots=tuple(each for each in case.instance.robots if each.id not in gone))
        yield _made(case, instance, [plan for plan in case.solution.plans if plan.robot not in gone], gone)


def _fewer_plans(best: Smallest) -> Iterator[Case]:
    for gone in _chunks([plan.robot for plan in best.case.solution.plans]):
        case = best.case
        yield _made(case, case.instance, [plan for plan in case.solution.plans if plan.robot not in gone])


def _fewer_resources(best: Smallest) -> Iterator[Case]:
    """Take away resources in which nobody starts, ends or stays."""
    for some in _chunks([*best.case.instance.graph.index]):
        case, graph = best.case, best.case.instance.graph
        used = {robot.start for robot in case.instance.robots}
        used |= {stop.resource for robot in case.instance.robots for stop in robot.stops}
        used |= {visit.resource for plan in case.solution.plans for visit in plan.visits}
        stay = {id: id for id in graph.index if id in used or id not in some}
        yield _made(case, replace(case.instance, graph=_shrunk(graph, stay)))


def _shorter_ways(best: Smallest) -> Iterator[Case | None]:
    """Join resources with those beside them, single ones with each of them and with the first of all."""
    ids, beside = [*best.case.instance.graph.index], _beside(best.case.instance.graph)
    for some in _chunks(ids):
        graph = best.case.instance.graph
        gone = some & graph.index.keys()
        if len(some) > 1 and gone:
            yield _moved(best.case, _joined(graph, gone))
    for id in ids:
        for into in dict.fromkeys([*beside[id], *ids[:1]]):
            graph = best.case.instance.graph
            if into != id and {id, into} <= graph.index.keys():
                yield _moved(best.case, {each: into if each == id else each for each in graph.index})


def _beside(graph: ResourceGraph) -> Mapping[ResourceId, list[ResourceId]]:
    """The resources that an edge joins with each, in either direction."""
    beside: dict[ResourceId, list[ResourceId]] = {id: [] for id in graph.index}
    for source, target in graph.edges:
        beside[source].append(target)
        beside[target].append(source)
    return beside


def _joined(graph: ResourceGraph, gone: frozenset[ResourceId]) -> dict[ResourceId, ResourceId]:
    """For each resource the nearest one that stays; one without any is left out."""
    became = {id: id for id in graph.index if id not in gone}
    beside, reached = _beside(graph), deque(became)
    while reached:
        at = reached.popleft()
        for id in beside[at]:
            if id not in became:
                became[id] = became[at]
                reached.append(id)
    return became


def _shrunk(graph: ResourceGraph, became: Mapping[ResourceId, ResourceId]) -> ResourceGraph:
    """The graph in which each resource became another one or stayed; those left out are gone."""
    edges = [(became[a], became[b]) for a, b in graph.edges if a in became and b in became and became[a] != became[b]]
    distinct = {(edge if graph.directed else frozenset(edge)): edge for edge in edges}
    groups = (
        replace(group, resources=tuple(dict.fromkeys(became[each] for each in group.resources if each in became)))
        for group in graph.groups
    )
    resources = tuple(each for each in graph.resources if became.get(each.id) == each.id)
    kept = tuple(group for group in groups if group.resources)
    return ResourceGraph(resources, tuple(distinct.values()), graph.directed, kept)


def _moved(case: Case, became: Mapping[ResourceId, ResourceId]) -> Case | None:
    """The question on the graph in which each resource became another one or stayed; `None` if something is lost."""
    visited = {visit.resource for plan in case.solution.plans for visit in plan.visits}
    if not became.keys() >= visited | case.instance.graph.index.keys():
        return None  # a resource has no other one, or a plan to check is anywhere
    robots = tuple(_once(each.in_names(became.__getitem__)) for each in case.instance.robots)
    places: dict[tuple[RobotId, int], int] = {}
    plans = []
    for plan in case.solution.plans:
        visits: list[Visit] = []
        for place, visit in enumerate(plan.visits):
            resource = became[visit.resource]
            if visits and visits[-1].resource == resource:
                visits[-1] = structs.replace(visits[-1], leave=visit.leave)
            else:
                visits.append(structs.replace(visit, resource=resource))
            places[plan.robot, place] = len(visits) - 1
        plans.append(Plan(plan.robot, tuple(visits)))
    delays = {(robot, places[robot, place]): ticks for robot, place, ticks in case.delays}
    joined = replace(case, delays=tuple((*node, ticks) for node, ticks in delays.items()))
    return _made(joined, replace(case.instance, graph=_shrunk(case.instance.graph, became), robots=robots), plans)


def _fewer_stops(best: Smallest) -> Iterator[Case]:
    """Take stops but the last, then ticks of service."""
    each = [(robot.id, place, stop) for robot in best.case.instance.robots for place, stop in enumerate(robot.stops)]
    for id, place, _ in reversed(each):
        stops = _stops_of(best.case, id)
        if place < len(stops) - 1:
            yield _made(best.case, _with_robot(best.case, id, stops=(*stops[:place], *stops[place + 1 :])))
    for id, place, stop in each:
        for step in _steps(stop.service, 0):
            stops = _stops_of(best.case, id)
            if place < len(stops) and stops[place].service >= step:
                less = replace(stops[place], service=stops[place].service - step)
                yield _made(best.case, _with_robot(best.case, id, stops=(*stops[:place], less, *stops[place + 1 :])))


def _stops_of(case: Case, id: RobotId) -> Sequence[Stop]:
    return case.instance.robot[id].stops if id in case.instance.robot else ()


def _fewer_edges(best: Smallest) -> Iterator[Case]:
    for gone in _chunks(best.case.instance.graph.edges):
        yield _with_graph(best.case, edges=tuple(edge for edge in best.case.instance.graph.edges if edge not in gone))


def _fewer_groups(best: Smallest) -> Iterator[Case]:
    """Take groups, then resources of one, then units of its capacity."""
    groups = best.case.instance.graph.groups
    for gone in _chunks([group.id for group in groups]):
        yield _with_graph(
            best.case, groups=tuple(each for each in best.case.instance.graph.groups if each.id not in gone)
        )
    for group in groups:
        for gone in _chunks(group.resources):
            yield _with_group(best.case, group.id, partial(_without, gone=gone))
        for step in _steps(group.capacity, 1):
            yield _with_group(best.case, group.id, partial(_with_less_room, step=step))


def _with_group(case: Case, id: ResourceId, change: Callable[[Group], Group]) -> Case:
    groups = (change(each) if each.id == id else each for each in case.instance.graph.groups)
    return _with_graph(case, groups=tuple(groups))


def _without(group: Group, gone: frozenset[ResourceId]) -> Group:
    """The group without some resources; one stays at least."""
    left = tuple(each for each in group.resources if each not in gone)
    return replace(group, resources=left or group.resources)


def _with_less_room(group: Group, step: int) -> Group:
    return replace(group, capacity=max(1, group.capacity - step))


def _simpler(best: Smallest) -> Iterator[Case]:
    """Ask for CARP or usual options; let robots vanish, edges go both ways, who has no plan stay; number from 0 on."""
    robots = [*best.case.instance.robot]
    if best.case.planner is not None:
        yield replace(best.case, planner=Carp() if best.case.op == "plan" else Neighbourhood())
    yield _made(best.case, replace(best.case.instance, after_goal="vanish"))
    edges = {frozenset(edge): edge for edge in best.case.instance.graph.edges}
    yield _with_graph(best.case, edges=tuple(edges.values()), directed=False)
    for id in robots:
        if id in best.case.instance.robot and all(plan.robot != id for plan in best.case.solution.plans):
            stays = (Stop(best.case.instance.robot[id].start),)
            yield replace(best.case, instance=_with_robot(best.case, id, stops=stays))
    ids = (*best.case.instance.graph.index, *best.case.instance.robot)
    if any(isinstance(id, int) or len(id) >= LONG_ID for id in ids):
        yield _numbered(best.case)


def _numbered(case: Case) -> Case:
    """The question with 0, 1, 2, ... for the ids of resources and of robots."""
    instance, solution = case.instance, case.solution
    place: dict[ResourceId, ResourceId] = {**instance.graph.index}
    number: dict[RobotId, RobotId] = {robot: position for position, robot in enumerate(instance.robot)}

    def name(robot: RobotId) -> RobotId:
        return number.get(robot, robot)

    plans = _with_visits(case, lambda visit: structs.replace(visit, resource=place.get(visit.resource, visit.resource)))
    named = Solution(
        tuple(Plan(name(plan.robot), plan.visits) for plan in plans),
        tuple(map(name, solution.order)),
        tuple(map(name, solution.unplanned)),
    )
    return replace(
        case,
        instance=renamed(instance, lambda position: position),
        solution=named,
        robot=None if case.robot is None else number[case.robot],
        delays=tuple((number[robot], visit, ticks) for robot, visit, ticks in case.delays),
    )


def _smaller_numbers(best: Smallest) -> Iterator[Case]:
    """Each number of resources and robots, for many at once and then alone."""
    instance = best.case.instance
    for of in NUMBERS:
        values = of.values(instance)
        for some in _chunks([*values]):
            for step in _steps(max(values[id] for id in some), of.number.least):
                yield _with_less(of, some, step, best.case)


def _with_less(of: NumberOf, some: frozenset[ResourceId], step: int, case: Case) -> Case:
    """The question with some numbers smaller, no lower than the least; who is released sooner waits at the start."""

    def less(each: T) -> T:
        value = max(of.number.least, getattr(each, of.name) - step)
        return replace(each, **{of.name: value})  # type: ignore[type-var]

    changed = tuple(less(each) if each.id in some else each for each in of.parts(case.instance))
    if of.kind is Resource:
        return _with_graph(case, resources=changed)
    instance = replace(case.instance, robots=changed)  # type: ignore[arg-type]
    if of.name != "release" or case.op == "check":
        return _made(case, instance)
    plans = []
    for plan in case.solution.plans:
        first, *others = plan.visits
        plans.append(Plan(plan.robot, (structs.replace(first, enter=instance.robot[plan.robot].release), *others)))
    return _made(case, instance, plans)


def _sooner(best: Smallest) -> Iterator[Case]:
    """Take ticks out of the times between events: all that comes later comes sooner."""
    before = _events(best.case)
    for number in range(1, len(before)):
        for step in _steps(before[number], before[number - 1]):
            events = _events(best.case)
            if number < len(events) and events[number] - step >= events[number - 1]:
                yield _shifted(best.case, events[number], step)


def _events(case: Case) -> list[int]:
    ticks = {0, case.now, *(robot.release for robot in case.instance.robots)}
    visits = [visit for plan in case.solution.plans for visit in plan.visits]
    return sorted({*ticks, *(tick for visit in visits for tick in (visit.enter, visit.leave) if tick is not None)})


def _shifted(case: Case, since: int, step: int) -> Case:
    """The question in which all that is at a tick or later comes sooner."""

    def sooner(tick: int) -> int:
        return tick - step if tick >= since else tick

    def moved(visit: Visit) -> Visit:
        return Visit(visit.resource, sooner(visit.enter), None if visit.leave is None else sooner(visit.leave))

    robots = tuple(replace(robot, release=sooner(robot.release)) for robot in case.instance.robots)
    solution = replace(case.solution, plans=tuple(_with_visits(case, moved)))
    return replace(case, now=sooner(case.now), solution=solution, instance=replace(case.instance, robots=robots))


def _fewer_visits(best: Smallest) -> Iterator[Case]:
    """Let a robot with a plan start at its second place, or end at its last but one."""
    for id, at_start in product([plan.robot for plan in best.case.solution.plans], (False, True)):
        case = best.case
        visits = next((plan.visits for plan in case.solution.plans if plan.robot == id), ())
        if len(visits) < 2 or any(late == id for late, _, _ in case.delays):  # noqa: PLR2004 - one visit must stay
            continue
        left = visits[1:] if at_start else visits[:-1]
        if left[0 if at_start else -1].resource not in case.instance.graph.index:
            continue  # a plan to check is anywhere
        ends = {"start": left[0].resource, "release": left[0].enter} if at_start else {"goal": left[-1].resource}
        plans = [Plan(id, left) if plan.robot == id else plan for plan in case.solution.plans]
        yield _made(case, _with_robot(case, id, **ends), plans)


def _earlier_now(best: Smallest) -> Iterator[Case]:
    for step in _steps(best.case.now, 0):
        if step <= best.case.now:
            yield replace(best.case, now=best.case.now - step)


def _fewer_delays(best: Smallest) -> Iterator[Case]:
    for number, (_, _, most) in enumerate(best.case.delays):
        for step in _steps(most, 0):
            delays = best.case.delays
            if number < len(delays):
                robot, visit, ticks = delays[number]
                less = ((robot, visit, ticks - step),) if ticks > step else ()
                yield replace(best.case, delays=(*delays[:number], *less, *delays[number + 1 :]))


KINDS: Sequence[Callable[[Smallest], Iterator[Case | None]]] = (
    _fewer_robots,
    _fewer_plans,
    _fewer_resources,
    _shorter_ways,
    _fewer_resources,
    _fewer_edges,
    _fewer_groups,
    _simpler,
    _fewer_stops,
    _smaller_numbers,
    _sooner,
    _fewer_visits,
    _earlier_now,
    _fewer_delays,
)
