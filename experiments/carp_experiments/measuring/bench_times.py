"""The times of `carproof dev bench`: queries, passes of CARP and additions on a warm fleet."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import fmean, median
from time import thread_time_ns

from carp_optimized import passes
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_spec import Neighbourhood
from carproof.generate import Fleet, Grid, grid_instance

ROBOTS = 100
REPETITIONS = 7
GROWTH_REPETITIONS = 3
PROPOSED = {
    "4": Neighbourhood(m=4),
    "5": Neighbourhood(m=5),
    "6": Neighbourhood(m=6),
    "10": Neighbourhood(m=10, sample=150),
}
QUERIED = 20
PARTS = 3 + GROWTH_REPETITIONS


@dataclass(frozen=True, slots=True)
class Added:
    """Adding the k-th robot with a neighbourhood: time, ratio to a pass over all robots, and queries."""

    k: int
    neighbourhood: str
    add_us: float
    ratio: float
    asked: float
    avoided: dict[str, float]


@dataclass(frozen=True, slots=True)
class OnMap:
    """The times on one of the paper's maps."""

    map: int
    query_us: float
    pass_us: float
    added: Sequence[Added]


@dataclass(frozen=True, slots=True)
class OnGrid:
    """The times on a full grid with a robot to every four nodes; the time of a query is the mean over the last robots.

    The more robots there are, the more queries meet them: most queries are as fast as on an empty grid, and a few take
    most of the time. `asked` counts the queries of adding the last robot.
    """

    side: int
    robots: int
    query_us: float
    pass_us: float
    add_us: float
    asked: int


def microseconds(work: Callable[[], object], prepare: Callable[[], object] = lambda: None) -> float:
    """The median time of some work, after a first run that does not count."""
    times = []
    for _ in range(REPETITIONS + 1):
        prepare()
        started = thread_time_ns()
        work()
        times.append((thread_time_ns() - started) / 1000)
    return median(times[1:])


def query_time(fleet: PlannedFleet, robot: int, times: int = 200) -> float:
    """The time of one query of a robot against the fleet, asked again and again."""
    return microseconds(lambda: fleet.call(lambda: passes.repeat_query(fleet.native, robot, times))) / times


def on_map(map: int, assignments: int, advance: Callable[[], None]) -> OnMap:
    """Measure on a map of the paper."""
    queries, passes_us = [], []
    added: dict[tuple[int, str], list[Added]] = {(k, name): [] for k in (ROBOTS // 2, ROBOTS) for name in PROPOSED}
    for seed in range(assignments):
        fleet = PlannedFleet(grid_instance(Grid(map=map, map_seed=seed), Fleet(robots=ROBOTS, seed=seed)))
        pass_us = microseconds(partial(carp, fleet, range(ROBOTS)), fleet.clear)
        carp(fleet, range(ROBOTS - 1))
        queries.append(query_time(fleet, ROBOTS - 1))
        passes_us.append(pass_us)
        for (k, name), measured in added.items():
            measured.append(add_robot(fleet, k, name, pass_us))
        advance()
    return OnMap(map, median(queries), median(passes_us), [medians(each) for each in added.values()])


def add_robot(fleet: PlannedFleet, k: int, name: str, pass_us: float) -> Added:
    """Add the k-th robot to those before it, planned by CARP."""
    carp(fleet, range(k - 1))
    before = fleet.queries
    add(fleet, k - 1, 0, PROPOSED[name])
    after = fleet.queries
    avoided = {kind: getattr(after, kind) - getattr(before, kind) for kind in after.avoided}
    add_us = microseconds(partial(add, fleet, k - 1, 0, PROPOSED[name]), partial(carp, fleet, range(k - 1)))
    return Added(k, name, add_us, add_us / pass_us, after.asked - before.asked, avoided)


def medians(all_added: Sequence[Added]) -> Added:
    """The medians over assignments."""
    kinds = all_added[0].avoided
    return Added(
        all_added[0].k,
        all_added[0].neighbourhood,
        median(each.add_us for each in all_added),
        median(each.ratio for each in all_added),
        median(each.asked for each in all_added),
        {kind: median(each.avoided[kind] for each in all_added) for kind in kinds},
    )


def on_grid(side: int, advance: Callable[[], None]) -> OnGrid:
    """Measure how the times grow with the grid."""
    robots = side * side // 4
    last = robots - 1
    fleet = PlannedFleet(grid_instance(Grid(width=side, height=side), Fleet(robots=robots)))

    def timed(work: Callable[[], object]) -> float:
        started = thread_time_ns()
        work()
        time_us = (thread_time_ns() - started) / 1000
        for _ in range(weight(side)):
            advance()
        return time_us

    timed(partial(carp, fleet, range(last)))
    pass_us = timed(partial(carp, fleet, range(last)))
    carp(fleet, range(robots - QUERIED))
    queries: list[float] = []
    timed(lambda: queries.extend(query_time(fleet, robot, 10) for robot in range(robots - QUERIED, robots)))
    times, asked = [], 0
    for _ in range(GROWTH_REPETITIONS):
        carp(fleet, range(last))
        before = fleet.queries.asked
        times.append(timed(partial(add, fleet, last, 0, PROPOSED["4"])))
        asked = fleet.queries.asked - before
    return OnGrid(side, robots, fmean(queries), pass_us, median(times), asked)


def weight(side: int) -> int:
    """The number of assignments on a map that take about as long as one of the `PARTS` of measuring a grid."""
    return max(1, (side // 40) ** 3)
