"""Smaller questions than one that fails: each edit takes one thing away, or several of a kind at once.

An edit gets the smallest question so far and returns a smaller one, or `None` where it has nothing to take away. The
edits of a kind go from coarse to fine, so that a question of hundreds of robots is small after a few.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeAlias, TypeVar

from msgspec import structs

from carp_reference.execution import order_of
from carp_spec import (
    Instance,
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

Edit: TypeAlias = Callable[[Case], Case | None]
T = TypeVar("T")
LONG_ID = 8


def smallest(case: Case, fails: Callable[[Case], bool], is_over: Callable[[], bool]) -> tuple[Case, bool]:
    """A question that fails, and whether it is minimal: no edit makes it smaller and keeps the failure.

    It is not known to be minimal if the time was over.
    """
    is_moving = True
    while is_moving:
        is_moving = False
        for kind in KINDS:
            for edit in kind(case):
                if is_over():
                    return case, False
                smaller = edit(case)
                if smaller is not None and smaller != case and is_question(smaller) and fails(smaller):
                    case, is_moving = smaller, True
    return case, True


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


def _made(case: Case, instance: Instance, plans: Sequence[Plan] | None = None) -> Case:
    """The question with another instance and some of its plans; a robot that loses its plan is unplanned."""
    plans = case.solution.plans if plans is None else plans
    kept = {plan.robot for plan in plans}
    lost = [plan.robot for plan in case.solution.plans if plan.robot not in kept]
    order = tuple(robot for robot in case.solution.order if robot in instance.robot and robot not in lost)
    unplanned = tuple(robot for robot in (*case.solution.unplanned, *lost) if robot in instance.robot)
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


def _fewer_robots(case: Case) -> Iterable[Edit]:
    def edit(gone: frozenset[RobotId], case: Case) -> Case:
        robots = tuple(each for each in case.instance.robots if each.id not in gone or each.id == case.robot)
        instance = replace(case.instance, robots=robots)
        return _made(case, instance, [plan for plan in case.solution.plans if plan.robot in instance.robot])

    return (partial(edit, gone) for gone in _chunks([*case.instance.robot]))


def _fewer_plans(case: Case) -> Iterable[Edit]:
    def edit(gone: frozenset[RobotId], case: Case) -> Case:
        return _made(case, case.instance, [plan for plan in case.solution.plans if plan.robot not in gone])

    return (partial(edit, gone) for gone in _chunks([plan.robot for plan in case.solution.plans]))


def _fewer_resources(case: Case) -> Iterable[Edit]:
    """Take away resources in which nobody starts, ends or stays."""

    def edit(some: frozenset[ResourceId], case: Case) -> Case:
        used = {robot.start for robot in case.instance.robots}
        used |= {stop.resource for robot in case.instance.robots for stop in robot.stops}
        used |= {visit.resource for plan in case.solution.plans for visit in plan.visits}
        stay = {id: id for id in case.instance.graph.index if id in used or id not in some}
        return _made(case, replace(case.instance, graph=_shrunk(case.instance.graph, stay)))

    return (partial(edit, some) for some in _chunks([*case.instance.graph.index]))


def _shorter_ways(case: Case) -> Iterable[Edit]:
    """Join resources with those beside them, single ones with each of them and with the first of all."""

    def edit(some: frozenset[ResourceId], into: ResourceId | None, case: Case) -> Case | None:
        graph = case.instance.graph
        gone = some & graph.index.keys()
        if not gone or (into is not None and into not in graph.index):
            return None
        became = _joined(graph, gone) if into is None else {id: into if id in gone else id for id in graph.index}
        return _moved(case, became) if len(became) == len(graph.index) else None

    graph, beside = case.instance.graph, _beside(case.instance.graph)
    yield from (partial(edit, some, None) for some in _chunks([*graph.index]) if len(some) > 1)
    for id in graph.index:
        targets = dict.fromkeys([*beside[id], *[*graph.index][:1]])
        yield from (partial(edit, frozenset([id]), into) for into in targets if into != id)


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
    """The question on the graph in which each resource became another one or stayed."""
    if any(visit.resource not in became for plan in case.solution.plans for visit in plan.visits):
        return None  # a plan to check may be anywhere
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


def _fewer_stops(case: Case) -> Iterable[Edit]:
    """Take stops but the last, then ticks of service."""

    def edit(robot: RobotId, place: int, step: int | None, case: Case) -> Case | None:
        stops = case.instance.robot[robot].stops if robot in case.instance.robot else ()
        if place >= len(stops) - (step is None):
            return None
        less = [] if step is None else [Stop(stops[place].resource, stops[place].service - step)]
        if any(stop.service < 0 for stop in less):
            return None
        return _made(case, _with_robot(case, robot, stops=(*stops[:place], *less, *stops[place + 1 :])))

    each = [(robot.id, place, stop) for robot in case.instance.robots for place, stop in enumerate(robot.stops)]
    yield from (partial(edit, robot, place, None) for robot, place, _ in reversed(each))
    yield from (partial(edit, robot, place, step) for robot, place, stop in each for step in _steps(stop.service, 0))


def _fewer_edges(case: Case) -> Iterable[Edit]:
    def edit(gone: frozenset[tuple[ResourceId, ResourceId]], case: Case) -> Case:
        return _with_graph(case, edges=tuple(edge for edge in case.instance.graph.edges if edge not in gone))

    return (partial(edit, gone) for gone in _chunks(case.instance.graph.edges))


def _simpler(case: Case) -> Iterable[Edit]:
    """Let robots vanish and edges go both ways; let a robot without plan end where it starts; shorten far ids."""

    def vanish(case: Case) -> Case:
        return _made(case, replace(case.instance, after_goal="vanish"))

    def both_ways(case: Case) -> Case:
        edges = {frozenset(edge): edge for edge in case.instance.graph.edges}
        return _with_graph(case, edges=tuple(edges.values()), directed=False)

    def stay(robot: RobotId, case: Case) -> Case | None:
        if robot not in case.instance.robot or any(plan.robot == robot for plan in case.solution.plans):
            return None
        return replace(case, instance=_with_robot(case, robot, stops=(Stop(case.instance.robot[robot].start),)))

    return (vanish, both_ways, *(partial(stay, robot) for robot in case.instance.robot), _numbered)


def _numbered(case: Case) -> Case | None:
    """The question with 0, 1, 2, ... for the ids of resources and of robots, if some are long."""
    instance, solution = case.instance, case.solution
    if all(len(str(id)) < LONG_ID for id in (*instance.graph.index, *instance.robot)):
        return None
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


def _smaller_numbers(case: Case) -> Iterable[Edit]:
    """Each number of resources and robots, for many at once and then alone."""
    for of in NUMBERS:
        values = of.values(case.instance)
        for some in _chunks([*values]):
            steps = _steps(max(values[id] for id in some), of.number.least)
            yield from (partial(_with_less, of, some, step) for step in steps)


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


def _sooner(case: Case) -> Iterable[Edit]:
    """Take ticks out of the times between events: all that comes later comes sooner."""

    def edit(number: int, step: int, case: Case) -> Case | None:
        events = _events(case)
        if number >= len(events) or events[number] - step < events[number - 1]:
            return None
        return _shifted(case, events[number], step)

    events = _events(case)
    for number in range(1, len(events)):
        yield from (partial(edit, number, step) for step in _steps(events[number], events[number - 1]))


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


def _fewer_visits(case: Case) -> Iterable[Edit]:
    """Let a robot with a plan start at its second place, or end at its last but one."""

    def edit(robot: RobotId, at_start: bool, case: Case) -> Case | None:
        visits = next((plan.visits for plan in case.solution.plans if plan.robot == robot), ())
        if len(visits) < 2 or any(late == robot for late, _, _ in case.delays):  # noqa: PLR2004 - one visit must stay
            return None
        left = visits[1:] if at_start else visits[:-1]
        ends = {"start": left[0].resource, "release": left[0].enter} if at_start else {"goal": left[-1].resource}
        plans = [Plan(robot, left) if plan.robot == robot else plan for plan in case.solution.plans]
        return _made(case, _with_robot(case, robot, **ends), plans)

    return (partial(edit, plan.robot, at_start) for plan in case.solution.plans for at_start in (False, True))


def _earlier_now(case: Case) -> Iterable[Edit]:
    def edit(step: int, case: Case) -> Case | None:
        return replace(case, now=case.now - step) if step <= case.now else None

    return (partial(edit, step) for step in _steps(case.now, 0))


def _fewer_delays(case: Case) -> Iterable[Edit]:
    def edit(number: int, step: int, case: Case) -> Case | None:
        if number >= len(case.delays):
            return None
        robot, visit, ticks = case.delays[number]
        less = ((robot, visit, ticks - step),) if ticks > step else ()
        return replace(case, delays=(*case.delays[:number], *less, *case.delays[number + 1 :]))

    steps = ((number, step) for number, each in enumerate(case.delays) for step in _steps(each[2], 0))
    return (partial(edit, number, step) for number, step in steps)


KINDS: Sequence[Callable[[Case], Iterable[Edit]]] = (
    _fewer_robots,
    _fewer_plans,
    _fewer_resources,
    _shorter_ways,
    _fewer_resources,
    _fewer_edges,
    _simpler,
    _fewer_stops,
    _smaller_numbers,
    _sooner,
    _fewer_visits,
    _earlier_now,
    _fewer_delays,
)
