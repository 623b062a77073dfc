"""Random cases: small instances, in most of which robots are in each other's way. Equal seeds give equal cases."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeAlias

from carp_reference.execution import order_of
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Instance,
    Neighbourhood,
    Planner,
    Resource,
    ResourceGraph,
    Robot,
    Solution,
    Stop,
    TimeExpanded,
)
from carp_spec.limits import goals_stand_alone
from carp_spec.permutations import shuffle
from carproof.conform.asking.ladder import PLANNERS, blocked_grid
from carproof.conform.cases import EXECUTION, NUMBERS, Case
from carproof.conform.judging.claims import EVERYTHING, Claims
from carproof.conform.levels import Level
from carproof.engines import engine_named
from carproof.execution.delays import stuck
from carproof.testing.mutations import MUTATIONS
from carproof.testing.random_instances import (
    POLICIES,
    Draw,
    Mix,
    draw_fleet,
    draw_groups,
    draw_instance,
    draw_numbers,
    draw_plans,
    draw_stops,
    last_tick,
)

MOST_ROBOTS = 4
MIX = Mix(robots=range(1, MOST_ROBOTS + 1))
MOST_STOPS = 3
SERVICES = (0, 0, 1, 2, 5)
LATEST = 4
"""The last tick at which a robot is replanned, if there are no plans."""
LONGEST_DELAY = 3
MOST_DELAYS = 4
EXACT_PLANNERS: tuple[Planner, ...] = (
    *PLANNERS,
    Greedy(),
    Neighbourhood(m=3, baseline=False),
    FixedPaths(),
    FixedPaths(paths="disjoint"),
    TimeExpanded(),
)
ADDING = tuple(planner for planner in EXACT_PLANNERS if isinstance(planner, Neighbourhood))
DrawCase: TypeAlias = Callable[[Draw], Case]
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


def _busy_instance(draw: Draw, mix: Mix, shapes: Sequence[Edges] = SHAPES) -> Instance:
    """Two or more robots on a small map, from different starts: most are in each other's way."""
    edges = draw.one_of(shapes)
    ids = range(1 + max(max(edge) for edge in edges))
    resources = tuple(Resource(id, **draw_numbers(draw, mix, Resource)) for id in ids)
    graph = ResourceGraph(resources, edges, groups=draw_groups(draw, ids, draw.one_of(mix.groups)))
    starts = shuffle(ids, draw.stream)[: draw.between(2, min(MOST_ROBOTS, len(ids)))]
    goals = [draw.one_of(ids) for _ in starts]
    robots = tuple(
        Robot(id, *ends, **draw_numbers(draw, mix, Robot)) for id, ends in enumerate(zip(starts, goals, strict=True))
    )
    robots = tuple(replace(robot, stops=draw_stops(draw, ids, robot, mix)) for robot in robots)
    return Instance(graph, robots, draw.one_of(POLICIES))


def _swap(draw: Draw, mix: Mix) -> Instance:
    """Two or three robots in a corridor, each going to where the next one starts."""
    instance = _busy_instance(draw, mix, (CORRIDOR,))
    robots = instance.robots[:3]
    following = (*robots[1:], robots[0])
    swapped = (replace(each, stops=(Stop(after.start),)) for each, after in zip(robots, following, strict=True))
    return replace(instance, robots=tuple(swapped))


def _instance(draw: Draw, mix: Mix) -> Instance:
    """An instance of any kind, or a busy one."""
    return draw_instance(draw, mix) if draw.happens(3) else _busy_instance(draw, mix)


def _query(mix: Mix, under_way: bool, draw: Draw) -> Case:
    """One robot against plans of some of the others; it may be under way itself, at a tick later than 0."""
    instance = _instance(draw, mix)
    robot = draw.one_of(instance.robots)
    is_new = not (under_way and draw.happens(4))
    planned = [each for each in instance.robots if each is not robot or not is_new]
    plans = draw_plans(draw, instance, shuffle(planned, draw.stream))
    now = draw.between(0, last_tick(plans) or LATEST) if under_way and draw.happens(2) else 0
    return Case("random", "query", "query", instance, Solution.of(instance, plans), robot.id, now)


def _plan(mix: Mix, planners: Sequence[Planner | None], draw: Draw) -> Case:
    """A whole instance; fixed paths are for goals alone."""
    instance = _instance(draw, mix)
    knows_stops = [planner for planner in planners if not isinstance(planner, FixedPaths)]
    planner = draw.one_of(planners if goals_stand_alone(instance) else knows_stops)
    return Case("random", "plan", "plan", instance, planner=planner)


def _addition(mix: Mix, under_way: bool, draw: Draw) -> Case:
    fleet = draw_fleet(draw, _instance(draw, mix))
    now = fleet.now if under_way else 0
    return Case("random", "add", "add", fleet.instance, fleet.solution, fleet.robot, now, draw.one_of(ADDING))


def _polish(mix: Mix, draw: Draw) -> Case:
    """Plans of some or all robots, most of them slower than they must be."""
    instance = _instance(draw, mix)
    plans = draw_plans(draw, instance, shuffle(instance.robots, draw.stream))
    return Case("random", "polish", "polish", instance, Solution.of(instance, plans))


def _check(mix: Mix, draw: Draw) -> Case:
    """Plans that break no rule, or that are wrong in one place."""
    case = replace(_polish(mix, draw), name="check", op="check")
    if draw.happens(2):
        return case
    mutants = [each for mutation in MUTATIONS if (each := [*mutation(case.instance, case.solution)])]
    broken = draw.one_of(draw.one_of(mutants))
    return replace(case, instance=broken.instance, solution=broken.solution)


def _execution(mix: Mix, draw: Draw) -> Case:
    """Plans by CARP whose dependency graph has no cycle, and visits that take longer than planned."""
    instance = _instance(draw, mix) if draw.happens(3) else _swap(draw, mix)
    solution = engine_named("reference").plan(instance, Carp())
    visits = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits))]
    if not visits or stuck(order_of(instance, solution)):
        return _execution(mix, draw)
    late = shuffle(visits, draw.stream)[: draw.between(0, MOST_DELAYS)]
    delays = tuple((*node, draw.between(1, LONGEST_DELAY)) for node in late)
    return Case("random", EXECUTION, EXECUTION, instance, solution, delays=delays)


def _best(op: str, mix: Mix, draw: Draw) -> Case:
    """A question about the best plans of a whole instance."""
    return Case("random", op, op, _instance(draw, mix))


def _claimed(mix: Mix, claims: Claims) -> Mix:
    """The mix with which few cases have features that are not claimed."""
    left_out = {each.number.feature: (each.number.least,) for each in NUMBERS if each.number.feature in claims.without}
    groups = {"groups": (0, 1, 2)} if claims.groups else {}
    stops = {"stops": MOST_STOPS, "services": SERVICES} if claims.stops else {}
    return replace(mix, **left_out, **groups, **stops)  # type: ignore[arg-type]


def execution_case(claims: Claims = EVERYTHING) -> DrawCase:
    """An execution for a program to drive."""
    return partial(_execution, _claimed(MIX, claims))


def random_cases(ops: Sequence[str], level: Level, whole: bool, claims: Claims = EVERYTHING) -> Mapping[str, DrawCase]:
    """What draws a case of each op that is offered."""
    mix = _claimed(MIX, claims)
    maybe_nobody = replace(mix, robots=(0, *mix.robots))
    if whole:
        return {"plan": partial(_plan, maybe_nobody, [None])}
    planners = EXACT_PLANNERS if level >= Level.EXACT else (Carp(),)
    under_way = "now" not in claims.without
    by_op: dict[str, DrawCase] = {
        "query": partial(_query, mix, under_way),
        "plan": partial(_plan, maybe_nobody, planners),
        "add": partial(_addition, mix, under_way),
        "check": partial(_check, mix),
        "polish": partial(_polish, mix),
        "bound": partial(_best, "bound", maybe_nobody),
    }
    if level >= Level.COMPLETE:
        by_op["optimum"] = partial(_best, "optimum", maybe_nobody)
    return {op: cases for op, cases in by_op.items() if op in ops}


def classical_case(draw: Draw) -> Case:
    """A grid with robots of different starts and different goals, to be planned by a planner of the program's own."""
    instance = blocked_grid(draw.between(1, MOST_ROBOTS), draw)
    return Case("random", "plan", "plan", instance, classical=True)
