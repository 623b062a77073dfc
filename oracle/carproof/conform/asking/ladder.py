"""Large cases: a ladder of sizes, on maps of several kinds and with large numbers, from small and cheap to large.

A planner that is right on maps of six resources may have a fixed number of robots, drop a check on large maps, or lose
a tick that needs more than 16 bits. Equal seeds give equal cases.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import isqrt

from carp_spec import (
    AfterGoal,
    Carp,
    Instance,
    LongestFirst,
    Neighbourhood,
    Planner,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    Shuffled,
    Solution,
)
from carp_spec.model import Group
from carp_spec.permutations import splitmix64
from carproof.conform.cases import Case, renamed
from carproof.conform.judging.claims import UNSOLVABLE, Claims
from carproof.conform.levels import Level
from carproof.engines import engine_named
from carproof.generate import Fleet, Grid, Range, Traits, Warehouse, grid_instance, warehouse_instance
from carproof.generate.fleet import random_robots
from carproof.generate.grid import cell_edges, cell_graph
from carproof.testing.random_instances import Draw, Mix, draw_stops

SIZES = (10, 30, 100, 300, 1000)
"""Numbers of robots."""
LARGE_OPS = ("plan", "query", "add", "polish", "check")
FAR_ID = 2**32
"""Far ids are multiples of it: all are equal if they are cut to 32 bits."""
SERVICES = (0, 1, 10, 1000)
SPARSE = 10
"""Resources for each group."""
DAYS = (0, 40_000, 200_000, 1_000_000)
"""Ticks about which robots are released: the second needs more than 15 bits, the third more than 17."""
PLANNERS: Sequence[Planner] = (
    Carp(),
    Neighbourhood(m=2),
    Shuffled(attempts=2),
    LongestFirst(),
    Neighbourhood(m=3, sample=2, seed=5, fallback=2),
)
"""The planners that large cases ask at `exact`; the compiled planner has them all."""


@dataclass(frozen=True, slots=True)
class Traffic:
    """The hard part of a large case besides its size."""

    name: str
    park: bool = False
    capacity: int = 1
    duration: int = 1
    pace: int = 1
    releases: bool = False
    far_ids: bool = False
    directed: bool = False
    stops: int = 1
    groups: bool = False


TRAFFIC: Sequence[Traffic] = (
    Traffic("plain"),
    Traffic("capacities", capacity=100, groups=True),
    Traffic("durations", duration=1000, stops=3),
    Traffic("park", park=True, stops=3),
    Traffic("paces", pace=1000, groups=True),
    Traffic("releases", releases=True),
    Traffic("far ids", far_ids=True),
    Traffic("one-way streets", directed=True, park=True, groups=True),
    Traffic(
        "all at once",
        capacity=10,
        duration=100,
        pace=10,
        releases=True,
        far_ids=True,
        directed=True,
        stops=2,
        groups=True,
    ),
)


@dataclass(frozen=True, slots=True)
class Rung:
    """A large case before it is made: its number of robots, its op, and what it is about."""

    robots: int
    op: str
    traffic: Traffic
    place: str
    seed: int
    planner: Planner | None


def rungs(ops: Sequence[str], level: Level, seed: int, whole: bool) -> Iterator[Rung]:
    """The ladder. Sizes alternate so that several cases of a size are asked before one of the next size."""
    stream = splitmix64(seed)
    asked = [op for op in LARGE_OPS if op in ops]
    places = (*PLACES,)
    for depth in range(len(SIZES) + len(places) - 1):
        for size, robots in enumerate(SIZES):
            if not 0 <= depth - size < len(places):
                continue
            for number, traffic in enumerate(TRAFFIC):
                for turn, op in enumerate(asked):
                    place = places[(number + turn + depth - size) % len(places)]
                    planners = PLANNERS if level >= Level.EXACT else PLANNERS[:1]
                    planner = None if whole else planners[(number + depth) % len(planners)]
                    yield Rung(robots, op, traffic, place, next(stream), planner)


def large_case(rung: Rung, claims: Claims, classical: bool) -> Case | None:
    """The case; `None` where a program does not claim it."""
    draw = Draw(splitmix64(rung.seed))
    traffic = _claimed(rung.traffic, claims)
    if classical:
        instance = blocked_grid(rung.robots, draw)
    else:
        traits = Traits(Range(1, traffic.capacity), Range(1, traffic.duration))
        instance = _with_traffic(PLACES[rung.place](rung.robots, traits, draw), traffic, claims, draw)
    try:
        solution = engine_named(None).plan(instance, Carp())
    except Refusal:  # a tick that the compiled planner does not hold
        return None
    if UNSOLVABLE in claims.left_out:
        planned = {plan.robot for plan in solution.plans}
        instance = replace(instance, robots=tuple(each for each in instance.robots if each.id in planned))
        solution = replace(solution, unplanned=())
    case = _asked(rung, instance, solution, draw, claims)
    if case is None or not classical:
        return case
    return replace(case, name=f"{len(instance.robots)} robots, grid with blocked cells", classical=True)


def _claimed(traffic: Traffic, claims: Claims) -> Traffic:
    """The traffic without what the program does not claim."""
    without = claims.without
    return replace(
        traffic,
        park=(traffic.park or "vanish" in without) and "park" not in without,
        capacity=1 if "capacities" in without else traffic.capacity,
        duration=1 if "durations" in without else traffic.duration,
        pace=1 if "paces" in without else traffic.pace,
        releases=traffic.releases and "releases" not in without,
        directed=traffic.directed and "directed" not in without,
        stops=traffic.stops if claims.stops else 1,
        groups=traffic.groups and claims.groups,
    )


def _fleet(robots: int, draw: Draw, distinct: bool = True) -> Fleet:
    return Fleet(robots, next(draw.stream), distinct="both" if distinct else "starts")


def _grid(robots: int, traits: Traits, draw: Draw) -> Instance:
    """A full grid with three cells for a robot."""
    side = _side(3 * robots)
    return grid_instance(Grid(side, side), _fleet(robots, draw), traits)


def _paper_map(robots: int, traits: Traits, draw: Draw) -> Instance:
    """A map of the paper, between a tree and a full grid, with four cells for a robot."""
    side = _side(4 * robots)
    grid = Grid(side, side, draw.between(3, 15), next(draw.stream))
    return grid_instance(grid, _fleet(robots, draw), traits)


def _warehouse(robots: int, traits: Traits, draw: Draw) -> Instance:
    """A warehouse whose robots bring goods to a few stations."""
    blocks = _side(robots // 3)
    plan = Warehouse(columns=max(1, blocks // 2), rows=2 * blocks, stations=max(2, robots // 8))
    return warehouse_instance(plan, _fleet(robots, draw, distinct=False), traits)


def _bottleneck(robots: int, traits: Traits, draw: Draw) -> Instance:
    """A short corridor, in which all robots meet; where its resources hold several, all start in the first of them."""
    length, room = draw.between(4, 12), traits.capacity.high
    if room == 1:
        return _row(length, robots, traits, draw)
    most = max(3, min(room, robots // 2))
    row = _row(length, robots, replace(traits, capacity=Range(3, most)), draw)
    first, *others = row.graph.resources
    graph = replace(row.graph, resources=(replace(first, capacity=min(robots, room)), *others))
    going = tuple(replace(each, start=0, release=draw.between(0, 3)) for each in row.robots)
    return replace(row, graph=graph, robots=going)


def _row(length: int, robots: int, traits: Traits, draw: Draw) -> Instance:
    """A corridor in which all go to the right."""
    resources = tuple(
        Resource(x, traits.capacity.draw(draw.stream), traits.duration.draw(draw.stream), x, 0) for x in range(length)
    )
    graph = ResourceGraph(resources, tuple((x, x + 1) for x in range(length - 1)))
    going = []
    for number in range(robots):
        start = draw.between(0, length - 2)
        going.append(Robot(f"r{number}", start, draw.between(start + 1, length - 1), draw.between(0, 2 * length)))
    return Instance(graph, tuple(going))


def blocked_grid(robots: int, draw: Draw) -> Instance:
    """A grid as files of classical planners have it, with blocked cells."""
    side, one_in = _side(4 * robots), draw.between(4, 9)
    cells = [(x, y) for y in range(side) for x in range(side) if y < side // 2 or not draw.happens(one_in)]
    graph = cell_graph(cells, list(cell_edges(cells)), Traits(), draw.stream)
    ids = [*graph.index]
    return Instance(graph, random_robots(_fleet(robots, draw), ids, ids), "park")


PLACES: dict[str, Callable[[int, Traits, Draw], Instance]] = {
    "grid": _grid,
    "bottleneck": _bottleneck,
    "warehouse": _warehouse,
    "map of the paper": _paper_map,
    "corridor": lambda robots, traits, draw: _row(4 * robots, robots, traits, draw),
}


def _side(cells: int) -> int:
    """The side of the least square with as many cells."""
    return 1 + isqrt(max(1, cells) - 1)


def _with_traffic(instance: Instance, traffic: Traffic, claims: Claims, draw: Draw) -> Instance:
    """The instance with releases, paces, one-way streets, stops, groups, far ids and a policy."""
    graph, robots = instance.graph, instance.robots
    if traffic.releases:
        robots = tuple(replace(each, release=draw.one_of(DAYS) + draw.between(0, 9)) for each in robots)
    elif "releases" in claims.without:
        robots = tuple(replace(each, release=0) for each in robots)
    robots = tuple(replace(each, pace=draw.between(1, traffic.pace)) for each in robots)
    if traffic.directed:
        back = [(target, source) for source, target in graph.edges if not draw.happens(4)]
        graph = ResourceGraph(graph.resources, (*graph.edges, *back), directed=True)
    if traffic.stops > 1:
        mix = Mix(stops=traffic.stops, services=SERVICES)
        robots = tuple(replace(each, stops=draw_stops(draw, [*graph.index], each, mix)) for each in robots)
    if traffic.groups:
        graph = replace(graph, groups=tuple(_groups(graph, robots, draw)))
    policy: AfterGoal = "park" if traffic.park else "vanish"
    made = Instance(graph, robots, policy)
    return _far(made, draw) if traffic.far_ids else made


def _groups(graph: ResourceGraph, robots: Sequence[Robot], draw: Draw) -> Iterator[Group]:
    """Groups of resources side by side, which overlap at times, with room for those that start in them."""
    starts = Counter(each.start for each in robots)
    for number in range(max(1, len(graph.resources) // SPARSE)):
        members = dict.fromkeys([draw.one_of(graph.resources).id])
        for _ in range(draw.between(1, 5)):
            beside = graph.successors[draw.one_of([*members])]
            members |= dict.fromkeys([draw.one_of(beside)] if beside else [])
        capacity = max(draw.between(1, 3), sum(starts[each] for each in members))
        yield Group(number, tuple(members), capacity)


def _far(instance: Instance, draw: Draw) -> Instance:
    """The instance with ids that need more than 32 bits, or are long texts."""
    is_text = draw.happens(3)
    return renamed(instance, lambda number: "x" * 200 + str(number) if is_text else (number + 1) * FAR_ID)


def _asked(rung: Rung, instance: Instance, solution: Solution, draw: Draw, claims: Claims) -> Case | None:
    name = f"{len(instance.robots)} robots, {rung.place}, {rung.traffic.name}"
    if rung.op == "plan":
        return Case("large", name, "plan", instance, planner=rung.planner)
    if not solution.plans:
        return None
    if rung.op in ("polish", "check"):
        given = _broken(instance, solution, draw) if rung.op == "check" and draw.happens(2) else solution
        return Case("large", name, rung.op, instance, given)
    robot = draw.one_of(solution.plans).robot
    others = Solution.of(instance, [plan for plan in solution.plans if plan.robot != robot])
    under_way = "now" not in claims.without and draw.happens(2)
    release = instance.robot[robot].release
    now = draw.between(release, release + 20) if under_way else 0
    if rung.op == "query":
        return Case("large", name, "query", instance, solution if under_way else others, robot, now)
    options = rung.planner if isinstance(rung.planner, Neighbourhood) else Neighbourhood(m=3)
    return Case("large", name, "add", instance, others, robot, now, options)


def _broken(instance: Instance, solution: Solution, draw: Draw) -> Solution:
    """The solution in which one robot goes as if it were alone."""
    robot = draw.one_of(solution.plans).robot
    alone = engine_named(None).query(instance, (), robot)
    plans = tuple(alone if plan.robot == robot and alone is not None else plan for plan in solution.plans)
    return replace(solution, plans=plans)
