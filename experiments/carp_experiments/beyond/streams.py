"""A stream of robots: they come at random ticks, each is planned when it comes, and those before keep their histories.

The arrivals are drawn uniformly from the ticks of the stream: a Poisson process, given how many there are. Each robot
comes in a dock beside its start, with room for all, where it waits until its plan lets it out. So every robot gets a
plan, and those that the map cannot take at the rate wait in the docks.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import msgspec

from carp_experiments.paper.map_cases import MapCase, map_instance, place_name, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_spec import Instance, Neighbourhood, Plan, Resource, ResourceGraph, total_cost, violations_of
from carproof.generate import Fleet, Range

PLANNERS = ("CARP", "Proposed_4 + baseline")
TICKS = 100
"""A rate is the number of arrivals in this time."""
RATES = (100, 200, 400, 600, 800, 1000, 1200, 1600, 2000)


class Streamed(msgspec.Struct, frozen=True):
    """A stream: the ticks in which the middle half of the robots reach their goals, and ticks that all robots take.

    They take so long from their arrival to their goals in sum; on shortest paths, each alone, they would take
    `shortest`.
    """

    half: int
    taken: int
    shortest: int


class StreamRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment: the streams of each planner, one for each rate."""

    map: int
    planners: dict[str, tuple[Streamed, ...]]


def stream_row(case: MapCase) -> Row:
    """The streams of each planner."""
    return {"planners": {name: [streamed(case, name, rate) for rate in RATES] for name in PLANNERS}}


def streamed(case: MapCase, name: str, rate: int) -> Streamed:
    """Plan the robots of a stream, each when it comes; raises `AssertionError` if one has no plan or breaks a rule."""
    instance = stream_instance(case, rate)
    fleet = PlannedFleet(instance)
    planner = seeded(ALGORITHMS[name], case.assignment)
    if isinstance(planner, Neighbourhood):
        for place, robot in enumerate(instance.robots):
            add(fleet, place, robot.release, planner)
    else:
        carp(fleet, range(case.robots))
    broken = violations_of(instance, fleet.plans)
    if broken or len(fleet.order) < case.robots:
        raise AssertionError(broken)
    shortest = sum(fleet.ticks_to_goal(place) for place in range(case.robots))
    return Streamed(middle_half(fleet.plans), total_cost(instance, fleet.plans), shortest)


def middle_half(plans: Sequence[Plan]) -> int:
    """The ticks between the arrival of the first quarter at the goals and that of the third."""
    arrivals = sorted(plan.visits[-1].enter for plan in plans)
    return max(1, arrivals[3 * len(arrivals) // 4] - arrivals[len(arrivals) // 4])


def stream_instance(case: MapCase, rate: int) -> Instance:
    """The robots of a stream with that rate, each in the dock of its start."""
    last = max(0, case.robots * TICKS // rate - 1)
    fleet = Fleet(robots=case.robots, seed=case.assignment, distinct="none", release=Range(0, last))
    return docked(map_instance(case.map, fleet))


def docked(instance: Instance) -> Instance:
    """The instance with a dock beside each start: robots go from it to the start, and never back."""
    graph = instance.graph
    docks = {robot.start: f"dock of {robot.start}" for robot in instance.robots}
    resources = [
        Resource(dock, len(instance.robots), 1, graph.resource[start].x, graph.resource[start].y)
        for start, dock in docks.items()
    ]
    moves = [(each.id, target) for each in graph.resources for target in graph.successors[each.id]]
    ways = [(dock, start) for start, dock in docks.items()]
    return replace(
        instance,
        graph=ResourceGraph((*graph.resources, *resources), (*moves, *ways), directed=True, groups=graph.groups),
        robots=tuple(replace(robot, start=docks[robot.start]) for robot in instance.robots),
    )


@dataclass(frozen=True, slots=True)
class StreamOf:
    """Means over the streams of a planner on one map at a rate of arrivals in 100 ticks.

    `throughput` is how many reach their goals in 100 ticks; `taken` is how long a robot takes from its arrival to its
    goal, and `waited` by how much this is more than its shortest path, in ticks.
    """

    map: int
    planner: str
    rate: int
    streams: int
    throughput: Interval
    taken: Interval
    waited: Interval


def stream_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """A table of all maps."""
    summary = tuple(
        StreamOf(
            map,
            planner,
            rate,
            len(found),
            throughput_of([each.half for each in found], robots),
            mean_interval([each.taken / robots for each in found]),
            mean_interval([(each.taken - each.shortest) / robots for each in found]),
        )
        for map, stored in rows_by_map(rows, StreamRow).items()
        for planner in PLANNERS
        for place, rate in enumerate(RATES)
        if (found := [row.planners[planner][place] for row in stored])
    )
    title = (
        f"Streams of {robots} robots, means with 95 % intervals: arrivals in {TICKS} ticks, robots that reach their "
        "goals in as many, ticks from a robot's arrival to its goal, and how much more this is than its shortest path"
    )
    cells: Mapping[str, Callable[[StreamOf], object]] = {
        "place": lambda each: place_name(each.map),
        "planner": lambda each: each.planner,
        "rate": lambda each: each.rate,
        "throughput": lambda each: f"{each.throughput:.0f}",
        "ticks taken": lambda each: f"{each.taken:.1f}",
        "waited": lambda each: f"{each.waited:.1f}",
    }
    return ExperimentReport(summary, (table_of("stream", title, summary, cells, names=2),))


def throughput_of(halves: Sequence[int], robots: int) -> Interval:
    """How many robots are done in `TICKS`, by the ticks in which the middle half of each stream is."""
    return mean_interval([TICKS * (3 * robots // 4 - robots // 4) / half for half in halves])


def stream_figures(summary: Sequence[StreamOf]) -> tuple[Figure, ...]:
    """Throughput and waiting by the rate, a line for each planner and map."""

    def line(each: StreamOf) -> str:
        return f"{each.planner.partition(' ')[0]} + {place_name(each.map)}"

    throughput = lines_of(summary, line, lambda each: (each.rate, each.throughput))
    waited = lines_of(summary, line, lambda each: (each.rate, each.waited))
    axis = f"arrivals in {TICKS} ticks"
    return (
        Figure("stream-throughput", "Throughput of a stream", (axis, f"at goals in {TICKS} ticks"), throughput),
        Figure("stream-waiting", "Waiting in a stream", (axis, "ticks waited by a robot"), waited),
    )
