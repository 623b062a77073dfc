"""Hypothesis strategies: resource graphs, instances, sound solutions, broken ones, and fleets under way.

For tests of planners and of checkers:

    from hypothesis import given
    from carproof.testing.strategies import fleets_under_way

    @given(fleets_under_way())
    def test_my_planner_adds_robots(fleet): ...

Drawn instances obey every rule `instance/...`, and drawn plans break no rule unless stated otherwise. Nothing is
filtered out, so drawing is fast. Examples shrink to few resources, few robots, short plans and small numbers.
"""

from dataclasses import dataclass, replace
from itertools import permutations
from typing import Any

from hypothesis import strategies as st

from carp_spec import (
    AfterGoal,
    Group,
    Instance,
    Move,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Stop,
)
from carp_spec.shapes import numbers_of
from carproof.testing.mutations import MUTATIONS, BrokenSolution
from carproof.testing.random_instances import FleetUnderWay
from carproof.testing.timing import path_over, timed_plan

__all__ = [
    "BrokenSolution",
    "FleetUnderWay",
    "PlannedInstance",
    "Sizes",
    "broken_solutions",
    "committed_plans",
    "fleets_under_way",
    "instances",
    "planned_instances",
    "resource_graphs",
    "solutions",
]


@dataclass(frozen=True, slots=True)
class Sizes:
    """The largest values that are drawn.

    `wait` is the most ticks that a drawn plan stays in a resource beyond the need. Only planners that know groups are
    asked with `groups`, and those that know stops with more than one stop, or with service.
    """

    resources: int = 5
    robots: int = 4
    capacity: int = 2
    duration: int = 3
    release: int = 4
    pace: int = 2
    wait: int = 2
    groups: int = 0
    stops: int = 1
    service: int = 0


SMALL = Sizes()


@dataclass(frozen=True, slots=True)
class PlannedInstance:
    """An instance and a solution of it that breaks no rule; robots may be unplanned."""

    instance: Instance
    solution: Solution


def _ids(count: int) -> st.SearchStrategy[list[str | int]]:
    """Distinct ids of both kinds, among them such traps as 1 beside "1"; the simplest are 0, 1, 2, ..."""
    pool: list[str | int] = [*range(count), *map(str, range(count))]
    return st.permutations(pool).map(lambda ids: ids[:count])


def _numbers(kind: type[Resource | Robot], sizes: Sizes) -> st.SearchStrategy[dict[str, Any]]:
    """The numbers of a resource or a robot, by their names."""
    numbers = numbers_of(kind).items()
    return st.fixed_dictionaries({name: st.integers(each.least, getattr(sizes, name)) for name, each in numbers})


def _positions(count: int) -> st.SearchStrategy[list[tuple[int | None, int | None]]]:
    """Positions for none, all or some of the resources."""
    absent: st.SearchStrategy[tuple[int | None, int | None]] = st.just((None, None))
    present = st.tuples(st.integers(-2, 3), st.integers(-2, 3))
    return st.one_of(*(st.lists(each, min_size=count, max_size=count) for each in (absent, present, absent | present)))


@st.composite
def resource_graphs(draw: st.DrawFn, sizes: Sizes = SMALL) -> ResourceGraph:
    """Resource graphs, most of them connected, from trees to complete ones, directed and undirected."""
    count = draw(st.integers(1, sizes.resources))
    attributes = draw(st.lists(_numbers(Resource, sizes), min_size=count, max_size=count))
    ids = draw(_ids(count))
    resources = tuple(
        Resource(id, x=x, y=y, **numbers)
        for id, numbers, (x, y) in zip(ids, attributes, draw(_positions(count)), strict=True)
    )
    pairs = draw(_pairs(ids))
    groups = draw(_groups(ids, sizes)) if sizes.groups else ()
    if not draw(st.booleans()):
        return ResourceGraph(resources, pairs, groups=groups)
    directions = draw(st.lists(st.integers(0, 2), min_size=len(pairs), max_size=len(pairs)))
    edges = [
        move
        for (source, target), direction in zip(pairs, directions, strict=True)
        for move in [[(source, target), (target, source)], [(source, target)], [(target, source)]][direction]
    ]
    return ResourceGraph(resources, tuple(edges), directed=True, groups=groups)


@st.composite
def _groups(draw: st.DrawFn, ids: list[ResourceId], sizes: Sizes) -> tuple[Group, ...]:
    """Groups, which may overlap."""
    members = st.lists(st.sampled_from(ids), min_size=1, unique=True).map(tuple)
    drawn = draw(st.lists(st.tuples(members, st.integers(1, sizes.capacity)), max_size=sizes.groups))
    names = draw(_ids(len(drawn)))
    return tuple(Group(id, *each) for id, each in zip(names, drawn, strict=True))


@st.composite
def _pairs(draw: st.DrawFn, ids: list[ResourceId]) -> tuple[Move, ...]:
    """Pairs to join: each resource but the first with one before it or, seldom, with none; and some more."""
    parents = [draw(st.sampled_from([*reversed(ids[:position]), None])) for position in range(1, len(ids))]
    forest = [(parent, id) for parent, id in zip(parents, ids[1:], strict=True) if parent is not None]
    more = st.lists(st.sampled_from([*permutations(ids, 2)]), max_size=len(ids)) if len(ids) > 1 else st.just([])
    return tuple({frozenset(pair): pair for pair in [*forest, *draw(more)]}.values())


@st.composite
def instances(
    draw: st.DrawFn,
    sizes: Sizes = SMALL,
    graphs: st.SearchStrategy[ResourceGraph] | None = None,
    least_robots: int = 0,
    *,
    starts_apart: bool = False,
    goals_apart: bool = False,
) -> Instance:
    """Instances on drawn graphs: the goal of a robot may be its start, or out of reach.

    Robots may share starts and goals, unless these are kept apart.
    """
    graph = draw(resource_graphs(sizes) if graphs is None else graphs)
    places = [resource.id for resource in graph.resources]
    most = min(sizes.robots, len(places)) if starts_apart or goals_apart else sizes.robots
    ids = draw(_ids(draw(st.integers(least_robots, most))))

    def ends(apart: bool) -> list[ResourceId]:
        alike = st.lists(st.sampled_from(places), min_size=len(ids), max_size=len(ids))
        return draw(st.permutations(places) if apart else alike)

    starts, goals = ends(starts_apart), ends(goals_apart)
    numbers = _numbers(Robot, sizes)
    robots = tuple(Robot(id, start, goal, **draw(numbers)) for id, start, goal in zip(ids, starts, goals, strict=False))
    if (sizes.stops, sizes.service) != (1, 0):
        robots = tuple(replace(robot, stops=draw(_stops(places, robot, sizes))) for robot in robots)
    policies: list[AfterGoal] = ["vanish", "park"]
    return Instance(graph, robots, draw(st.sampled_from(policies)))


@st.composite
def _stops(draw: st.DrawFn, places: list[ResourceId], robot: Robot, sizes: Sizes) -> tuple[Stop, ...]:
    """Stops of which the last is at the robot's goal."""
    order = [robot.goal]
    for _ in range(draw(st.integers(0, sizes.stops - 1 if len(places) > 1 else 0))):
        order.append(draw(st.sampled_from([place for place in places if place != order[-1]])))
    return tuple(Stop(place, draw(st.integers(0, sizes.service))) for place in reversed(order))


@st.composite
def committed_plans(
    draw: st.DrawFn, instance: Instance, sizes: Sizes = SMALL, without: RobotId | None = None
) -> tuple[Plan, ...]:
    """Sets of plans of some of the robots that break no rule together, in planning order.

    They make detours and wait longer than they need to, as plans of any planner might.
    `without` names a robot that gets no plan.
    """
    plans: tuple[Plan, ...] = ()
    for robot in draw(st.permutations([robot for robot in instance.robots if robot.id != without])):
        path = draw(_paths(instance.graph, robot))
        waits = draw(st.lists(st.integers(0, sizes.wait), min_size=len(path), max_size=len(path)))
        plan = timed_plan(instance, plans, robot, path, [*waits[:-1], 0])
        plans = plans if plan is None else (*plans, plan)
    return plans


@st.composite
def _paths(draw: st.DrawFn, graph: ResourceGraph, robot: Robot) -> tuple[ResourceId, ...]:
    """A path over the robot's stops, and before them over a drawn resource if one exists, or no resource."""
    over = draw(st.sampled_from([robot.start, *graph.index]))
    return path_over(graph, robot, over)


def solutions(instance: Instance, sizes: Sizes = SMALL) -> st.SearchStrategy[Solution]:
    """Solutions of the instance that break no rule; robots may be unplanned."""
    return committed_plans(instance, sizes).map(lambda plans: Solution.of(instance, plans))


@st.composite
def planned_instances(
    draw: st.DrawFn, sizes: Sizes = SMALL, instances_to_plan: st.SearchStrategy[Instance] | None = None
) -> PlannedInstance:
    """Instances with a solution that breaks no rule."""
    instance = draw(instances(sizes) if instances_to_plan is None else instances_to_plan)
    return PlannedInstance(instance, draw(solutions(instance, sizes)))


@st.composite
def broken_solutions(
    draw: st.DrawFn, sizes: Sizes = SMALL, planned: st.SearchStrategy[PlannedInstance] | None = None
) -> BrokenSolution:
    """Solutions that are sound but for one place, with the rules that they must break by that."""
    sound = draw(planned_instances(sizes) if planned is None else planned)
    mutants = [list(mutation(sound.instance, sound.solution)) for mutation in MUTATIONS]
    return draw(st.sampled_from(draw(st.sampled_from([each for each in mutants if each]))))


@st.composite
def fleets_under_way(
    draw: st.DrawFn, sizes: Sizes = SMALL, instances_to_plan: st.SearchStrategy[Instance] | None = None
) -> FleetUnderWay:
    """Fleets at a tick between 0 and the end of the last plan, with one robot to add.

    The instances given must have robots.
    """
    instance = draw(instances(sizes, least_robots=1) if instances_to_plan is None else instances_to_plan)
    robot = draw(st.sampled_from(instance.robots)).id
    plans = draw(committed_plans(instance, sizes, without=robot))
    ticks = [tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave) if tick is not None]
    return FleetUnderWay(instance, Solution.of(instance, plans), robot, draw(st.integers(0, max(ticks, default=0))))
