"""`carproof dev bench`: a query, a pass of CARP, a robot added, on the paper's maps and larger ones.

All times are processor times and medians over assignments, on a warm fleet that stays up: guides, arrays and machine
code exist. A pass is CARP over all robots, on an empty fleet and in the same run, so the ratios hold on any machine.
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from statistics import fmean, median
from time import thread_time_ns

import click

from carp_optimized import passes
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_spec import Neighbourhood
from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.options import json_option, listed
from carproof.command_line.tables import print_table
from carproof.generate import Fleet, Grid, grid_instance
from carproof.progress import progress

MAPS = (10, 20)
ROBOTS = 100
REPETITIONS = 7
GROWTH_REPETITIONS = 3
PROPOSED = {
    "4": Neighbourhood(m=4),
    "5": Neighbourhood(m=5),
    "6": Neighbourhood(m=6),
    "10": Neighbourhood(m=10, sample=150),
}
GROWTH = (20, 40, 80, 160)
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


@listed(
    "Measure queries, passes of CARP and additions.",
    "carproof dev bench",
    "carproof dev bench --assignments 5 --json > bench.json",
)
@click.option("--assignments", type=click.IntRange(min=1), default=20, help="The number of random assignments per map.")
@click.option("--growth/--no-growth", default=True, help="Measure larger and larger grids too.")
@json_option
def command(assignments: int, growth: bool, as_json: bool) -> Answer:
    """Measure one query, one pass of CARP and the adding of a robot.

    It uses the paper's maps 10 and 20 with 100 robots and, with --growth, full grids of 20 x 20 to 160 x 160 with a
    robot to every four nodes. Times are processor times, warm, and medians; on the grids the time of one query is a
    mean. Ratios are to a pass of CARP over all robots in the same run. The last columns count the queries asked, and
    those that each kind of reuse avoided: kept plans of robots before the one taken out; queries that cannot have
    changed; orders that begin alike; answers shared between orders; orders that cannot be better. If orders are drawn,
    only those drawn count.

    Exit codes: 0 done, 2 bad usage.
    """
    sides = GROWTH if growth else ()
    steps = len(MAPS) * assignments + PARTS * sum(map(weight, sides))
    with progress("measuring", steps) as advance:
        maps = [on_map(number, assignments, advance) for number in MAPS]
        grids = [on_grid(side, advance) for side in sides]
    if as_json:
        full = maps[-1]
        found = {
            "query_us": full.query_us,
            "pass_us": full.pass_us,
            "ratios": {each.neighbourhood: each.ratio for each in full.added if each.k == ROBOTS},
            "maps": [asdict(each) for each in maps],
            "growth": [asdict(each) for each in grids],
        }
        print_document(write(found))
    else:
        show(maps, grids)
    return Answer.YES


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


def show(maps: Sequence[OnMap], grids: Sequence[OnGrid]) -> None:
    """Print tables."""
    columns = ["map", "query", "pass"]
    times = [(each.map, f"{each.query_us:.1f} us", f"{each.pass_us:.0f} us") for each in maps]
    print_table(columns, times, numbers=columns)
    columns = ["map", "robot", "M", "add us", "ratio", "asked", *maps[0].added[0].avoided]
    added = [_cells(each.map, one) for each in maps for one in each.added]
    click.echo()
    print_table(columns, added, numbers=columns)
    if grids:
        columns = ["grid", "robots", "query", "pass", "add", "asked"]
        growth = [
            (f"{each.side}^2", each.robots, f"{each.query_us:.1f} us", _ms(each.pass_us), _ms(each.add_us), each.asked)
            for each in grids
        ]
        click.echo()
        print_table(columns, growth, numbers=columns)


def _cells(map: int, one: Added) -> tuple[object, ...]:
    avoided = [f"{count:.0f}" for count in one.avoided.values()]
    return (map, one.k, one.neighbourhood, f"{one.add_us:.0f}", f"{one.ratio:.2f}", f"{one.asked:.0f}", *avoided)


def _ms(time_us: float) -> str:
    return f"{time_us / 1000:.2f} ms"
