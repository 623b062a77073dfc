"""Drivers of late robots: lateness, arrivals per tick and collisions, by the share of visits that are delayed.

Rotations are removed first, so that every driver has the same plans. All drivers of a solution have the same delays.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import msgspec

import carp_optimized as engine
from carp_experiments.paper.map_cases import FULL_MAP, MapCase, instance_of, place_name, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_spec import Instance, Solution, violations_of
from carproof.execution.simulation import DRIVERS, TOGETHER, Driver, execute, random_delays
from carproof.execution.untangling import untangle

PLANNERS = ("CARP", "Proposed_4")
PER_CENT = (0, 1, 2, 5, 10, 20)
MOST_TICKS = 3
A_PER_CENT = 10_000
"""One per cent in millionths."""


class Executed(msgspec.Struct, frozen=True):
    """An execution: robots that arrived, the tick of the last arrival, ticks late in sum and at worst.

    `collisions` has the breaches of the rules of robots together.
    """

    arrived: int
    last: int
    late: int
    worst: int
    collisions: int
    standing: int
    switches: int


class Driven(msgspec.Struct, frozen=True):
    """The executions of one planner's solution: those of each driver, one for each share of delayed visits.

    `removed` rotations were removed; `rotation` is whether one stayed.
    """

    removed: int
    rotation: bool
    drivers: dict[Driver, tuple[Executed, ...]]


class ExecutionRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    planners: dict[str, Driven]


def execution_row(case: MapCase) -> Row:
    """The executions of each planner's solution."""
    instance = instance_of(case)
    found = {}
    for name in PLANNERS:
        given = engine.plan(instance, seeded(ALGORITHMS[name], case.assignment))
        untangled = untangle(instance, given, engine)
        drivers = {
            driver: tuple(
                driven(instance, untangled.solution, driver, share, (case.assignment << 8) + share)
                for share in PER_CENT
            )
            for driver in DRIVERS
        }
        found[name] = Driven(untangled.rounds, bool(untangled.rotation), drivers)
    return {"planners": found}


def driven(instance: Instance, solution: Solution, driver: Driver, share: int, seed: int) -> Executed:
    """Execute a solution with this share of its visits delayed, in per cent."""
    execution = execute(instance, solution, driver, random_delays(solution, share * A_PER_CENT, MOST_TICKS, seed))
    late = execution.late
    broken = violations_of(instance, execution.trace.plans, most=None)
    return Executed(
        arrived=len(late),
        last=max((plan.visits[-1].enter for plan in execution.trace.plans if plan.robot in late), default=0),
        late=sum(late.values()),
        worst=max(late.values(), default=0),
        collisions=sum(violation.rule in TOGETHER for violation in broken),
        standing=len(execution.standing),
        switches=execution.switches,
    )


@dataclass(frozen=True, slots=True)
class DriverOf:
    """Means over the executions of a planner's solutions by one driver, on one map with a share of delayed visits.

    `late` and `worst` are the mean and the largest lateness of an execution, in ticks; `arrivals` are those in a
    hundred ticks until the last one; `standing` is the number of robots that stood for ever in all executions.
    """

    map: int
    planner: str
    driver: str
    share: int
    executions: int
    late: Interval
    worst: Interval
    arrivals: Interval
    collisions: Interval
    standing: int
    switches: Interval


def execution_report(rows: Iterable[Row], _robots: int) -> ExperimentReport:
    """A table of each map."""
    summary = tuple(
        DriverOf(
            map,
            planner,
            driver,
            share,
            len(found),
            mean_interval([each.late / max(1, each.arrived) for each in found]),
            mean_interval([each.worst for each in found]),
            mean_interval([100 * each.arrived / max(1, each.last) for each in found]),
            mean_interval([each.collisions for each in found]),
            sum(each.standing for each in found),
            mean_interval([each.switches for each in found]),
        )
        for map, stored in rows_by_map(rows, ExecutionRow).items()
        for planner in PLANNERS
        for driver in DRIVERS
        for place, share in enumerate(PER_CENT)
        if (found := [row.planners[planner].drivers[driver][place] for row in stored])
    )
    tables = tuple(
        table_of(
            f"execution-{map}",
            f"On {place_name(map)}, means of {executions} executions with 95 % intervals: the ticks by which robots "
            "are late, and the latest is; arrivals in 100 ticks; collisions; robots that stand for ever; switches",
            [each for each in summary if each.map == map],
            {
                "planner": lambda each: each.planner,
                "driver": lambda each: each.driver,
                "delayed, %": lambda each: each.share,
                "late": lambda each: f"{each.late:.1f}",
                "worst": lambda each: f"{each.worst:.1f}",
                "arrivals": lambda each: f"{each.arrivals:.1f}",
                "collisions": lambda each: f"{each.collisions:.1f}",
                "standing": lambda each: each.standing,
                "switches": lambda each: f"{each.switches:.1f}",
            },
            names=2,
        )
        for map, executions in sorted({(each.map, each.executions) for each in summary})
    )
    return ExperimentReport(summary, tables)


def execution_figures(summary: Sequence[DriverOf]) -> tuple[Figure, ...]:
    """Lateness, throughput and collisions on the full grid, or the last map, by the share of delayed visits."""
    maps = {each.map for each in summary}
    map = FULL_MAP if FULL_MAP in maps else max(maps)
    here = [each for each in summary if each.map == map]

    def figure(name: str, title: str, unit: str, value: Callable[[DriverOf], Interval]) -> Figure:
        drawn = lines_of(here, lambda each: f"{each.planner} + {each.driver}", lambda each: (each.share, value(each)))
        return Figure(f"execution-{name}", f"{title} on {place_name(map)}", ("delayed visits, per cent", unit), drawn)

    return (
        figure("late", "Mean lateness", "ticks", lambda each: each.late),
        figure("worst", "Worst lateness", "ticks", lambda each: each.worst),
        figure("arrivals", "Throughput", "arrivals in 100 ticks", lambda each: each.arrivals),
        figure("collisions", "Collisions", "collisions", lambda each: each.collisions),
    )
