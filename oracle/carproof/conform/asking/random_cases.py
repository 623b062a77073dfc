"""Random cases by hypothesis' strategies, which shrink to few robots, few resources and small numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from hypothesis import assume
from hypothesis import strategies as st

from carp_reference.execution import order_of
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Group,
    Instance,
    LongestFirst,
    Neighbourhood,
    Planner,
    Resource,
    ResourceGraph,
    RobotId,
    Shuffled,
    Solution,
    Stop,
    TimeExpanded,
)
from carp_spec.limits import goals_stand_alone
from carproof.conform.cases import EXECUTION, NUMBERS, Case
from carproof.conform.judging.claims import EVERYTHING, Claims
from carproof.conform.levels import Level
from carproof.engines import engine_named
from carproof.execution.delays import stuck
from carproof.formats.movingai import BLOCKED, PASSABLE, GridMap, movingai_instance
from carproof.generate.grid import cell_id
from carproof.testing.strategies import Sizes, broken_solutions, committed_plans, fleets_under_way, instances, solutions

SIZES = Sizes(resources=6, robots=4)
OPTIMUM_SIZES = Sizes(resources=5, robots=3, duration=2, release=2)
WIDTH, HEIGHT = 4, 3
CLASSICAL_SIZES = Sizes(robots=4, release=0, pace=1)
MOST_GROUPS = 2
MOST_STOPS = 3
LONGEST_SERVICE = 5
LONGEST_DELAY = 3
MOST_DELAYS = 4
EXACT_PLANNERS: tuple[Planner, ...] = (
    Carp(),
    Shuffled(attempts=3),
    LongestFirst(),
    Greedy(),
    Neighbourhood(m=3),
    Neighbourhood(m=3, baseline=False),
    Neighbourhood(m=3, sample=2, seed=5, fallback=2),
    FixedPaths(),
    FixedPaths(paths="disjoint"),
    TimeExpanded(),
)
ADDING = tuple(planner for planner in EXACT_PLANNERS if isinstance(planner, Neighbourhood))
Edges: TypeAlias = tuple[tuple[int, int], ...]
SHAPES: tuple[Edges, ...] = (
    ((0, 1), (1, 2)),
    ((0, 1), (1, 2), (2, 3)),
    ((0, 1), (1, 2), (2, 0)),
    ((0, 1), (1, 2), (2, 3), (1, 4)),
    ((0, 1), (1, 2), (2, 3), (3, 0)),
    ((0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)),
)
"""Edges of small maps: two rows of cells, a triangle, a row with a place to pass, a ring, a grid."""
CORRIDOR: Edges = ((0, 4), (1, 5), (2, 4), (3, 5), (4, 5))
"""A corridor from 4 to 5; two places are at each end."""


@st.composite
def _shaped_graphs(draw: st.DrawFn, sizes: Sizes, shapes: Sequence[Edges] = SHAPES) -> ResourceGraph:
    edges = draw(st.sampled_from(shapes))
    count = 1 + max(max(edge) for edge in edges)
    numbers = st.tuples(st.sampled_from([1, 1, 1, sizes.capacity]), st.integers(1, sizes.duration))
    attributes = draw(st.lists(numbers, min_size=count, max_size=count))
    resources = tuple(Resource(id, capacity, duration) for id, (capacity, duration) in enumerate(attributes))
    if not sizes.groups:
        return ResourceGraph(resources, edges)
    members = st.lists(st.sampled_from(range(count)), min_size=2, max_size=3, unique=True).map(tuple)
    drawn = draw(st.lists(st.tuples(members, st.integers(1, sizes.capacity)), max_size=sizes.groups))
    return ResourceGraph(resources, edges, groups=tuple(Group(id, *each) for id, each in enumerate(drawn)))


def _swaps(sizes: Sizes) -> st.SearchStrategy[Instance]:
    """Two or three robots in a corridor, each going to where the next one starts."""
    corridor = _shaped_graphs(sizes, (CORRIDOR,))
    return instances(replace(sizes, robots=3), corridor, 2, starts_apart=True).map(_swapped)


def _swapped(instance: Instance) -> Instance:
    following = (*instance.robots[1:], instance.robots[0])
    robots = (replace(each, stops=(Stop(after.start),)) for each, after in zip(instance.robots, following, strict=True))
    return replace(instance, robots=tuple(robots))


def _busy_instances(sizes: Sizes) -> st.SearchStrategy[Instance]:
    """Two or more robots on a small map, from different starts: most are in each other's way."""
    return instances(sizes, _shaped_graphs(sizes), 2, starts_apart=True)


def _instances(sizes: Sizes, least_robots: int = 0) -> st.SearchStrategy[Instance]:
    """Instances of every kind; busy ones are added, because hypothesis prefers those in which robots do not meet."""
    any_instance = instances(sizes, least_robots=least_robots)
    return st.one_of(any_instance, _busy_instances(sizes), _busy_instances(sizes))


@st.composite
def _queries(draw: st.DrawFn, sizes: Sizes, under_way: bool) -> Case:
    """One robot against plans of some of the others; it may be under way itself, at a tick later than 0."""
    instance = draw(_instances(sizes, least_robots=1))
    robot: RobotId = draw(st.sampled_from(instance.robots)).id
    is_new = draw(st.sampled_from([True, True, True, not under_way]))
    plans = draw(committed_plans(instance, sizes, without=robot if is_new else None))
    ends = [visit.leave or visit.enter for plan in plans for visit in plan.visits]
    now = draw(st.just(0) | st.integers(0, max(ends, default=sizes.release) if under_way else 0))
    return Case("random", "query", "query", instance, Solution.of(instance, plans), robot, now)


@st.composite
def _plans(draw: st.DrawFn, planners: Sequence[Planner | None], sizes: Sizes) -> Case:
    """Whole instances; fixed paths are for goals alone."""
    instance = draw(_instances(sizes))
    knows_stops = [planner for planner in planners if not isinstance(planner, FixedPaths)]
    planner = draw(st.sampled_from(planners if goals_stand_alone(instance) else knows_stops))
    return Case("random", "plan", "plan", instance, planner=planner)


@st.composite
def _additions(draw: st.DrawFn, sizes: Sizes, under_way: bool) -> Case:
    fleet = draw(fleets_under_way(sizes, _instances(sizes, least_robots=1)))
    options = draw(st.sampled_from(ADDING))
    now = fleet.now if under_way else 0
    return Case("random", "add", "add", fleet.instance, fleet.solution, fleet.robot, now, options)


@st.composite
def _solved(draw: st.DrawFn, op: str, sizes: Sizes) -> Case:
    """Plans of some or all robots, most of them slower than they must be."""
    instance = draw(_instances(sizes))
    return Case("random", op, op, instance, draw(solutions(instance, sizes)))


@st.composite
def _checks(draw: st.DrawFn, sizes: Sizes) -> Case:
    if draw(st.booleans()):
        broken = draw(broken_solutions(sizes))
        return Case("random", "check", "check", broken.instance, broken.solution)
    return draw(_solved("check", sizes))


@st.composite
def _executions(draw: st.DrawFn, sizes: Sizes) -> Case:
    """Plans by CARP whose dependency graph has no cycle, and visits that take longer than planned."""
    instance = draw(st.one_of(_instances(sizes, least_robots=1), _swaps(sizes), _swaps(sizes)))
    solution = engine_named("reference").plan(instance, Carp())
    visits = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits))]
    assume(visits and not stuck(order_of(instance, solution)))
    count = min(draw(st.integers(0, MOST_DELAYS)), len(visits))
    late = draw(st.lists(st.sampled_from(visits), min_size=count, max_size=count, unique=True))
    delays = tuple((*node, draw(st.integers(1, LONGEST_DELAY))) for node in late)
    return Case("random", EXECUTION, EXECUTION, instance, solution, delays=delays)


def execution_cases(claims: Claims = EVERYTHING) -> st.SearchStrategy[Case]:
    """Executions for a program to drive."""
    return _executions(_claimed(SIZES, claims))


def _claimed(sizes: Sizes, claims: Claims) -> Sizes:
    """The sizes with which few cases have features that are not claimed."""
    left_out = {each.name: each.number.least for each in NUMBERS if each.number.feature in claims.without}
    groups = MOST_GROUPS if claims.groups else 0
    if not claims.stops:
        return replace(sizes, **left_out, groups=groups)
    return replace(sizes, **left_out, groups=groups, stops=MOST_STOPS, service=LONGEST_SERVICE)


def random_cases(
    ops: Sequence[str], level: Level, whole: bool, claims: Claims = EVERYTHING
) -> Mapping[str, st.SearchStrategy[Case]]:
    """Cases of each op that is offered."""
    sizes = _claimed(SIZES, claims)
    if whole:
        return {"plan": _plans([None], sizes)}
    planners = EXACT_PLANNERS if level >= Level.EXACT else (Carp(),)
    under_way = "now" not in claims.without
    small = st.one_of(instances(_claimed(OPTIMUM_SIZES, claims)), _busy_instances(sizes), _busy_instances(sizes))
    by_op: dict[str, st.SearchStrategy[Case]] = {
        "query": _queries(sizes, under_way),
        "plan": _plans(planners, sizes),
        "add": _additions(sizes, under_way),
        "check": _checks(sizes),
        "polish": _solved("polish", sizes),
        "bound": small.map(lambda instance: Case("random", "bound", "bound", instance)),
    }
    if level >= Level.COMPLETE:
        by_op["optimum"] = small.map(lambda instance: Case("random", "optimum", "optimum", instance))
    return {op: cases for op, cases in by_op.items() if op in ops}


@st.composite
def _grids(draw: st.DrawFn) -> ResourceGraph:
    """Small grids, some cells blocked."""
    width, height = draw(st.integers(1, WIDTH)), draw(st.integers(1, HEIGHT))
    kinds = st.sampled_from([PASSABLE[0], PASSABLE[0], PASSABLE[0], BLOCKED[0]])
    rows = tuple("".join(draw(st.lists(kinds, min_size=width, max_size=width))) for _ in range(height))
    graph = movingai_instance(GridMap(width, height, rows), (), "park").graph
    return graph if graph.resources else ResourceGraph((Resource(cell_id(0, 0), x=0, y=0),), ())


def classical_instances() -> st.SearchStrategy[Instance]:
    """Grids with robots of different starts and different goals; most meet."""
    return instances(CLASSICAL_SIZES, _grids(), 1, starts_apart=True, goals_apart=True).map(_classical)


def _classical(instance: Instance) -> Instance:
    robots = (replace(robot, id=f"r{number}") for number, robot in enumerate(instance.robots, start=1))
    return replace(instance, robots=tuple(robots), after_goal="park")


def classical_cases() -> st.SearchStrategy[Case]:
    """Whole instances, to be planned by a planner of the program's own."""
    return classical_instances().map(lambda instance: Case("random", "plan", "plan", instance, classical=True))
