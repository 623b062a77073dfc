"""Experiment 2 of the paper: the time to find plans when the k-th robot is added to those before it.

The algorithms of the paper that have no way to add a robot (CARP, CARP10, CARP100, LF) plan all k robots again; the
neighbourhood planner adds one. Times are processor times, on a warm fleet that stays up.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from time import thread_time_ns

import msgspec

from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.paper.quality import ALGORITHMS, outcome, plan_first, seeded
from carp_experiments.report import ExperimentReport, Figure, Table
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import MEASURED, Row
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_spec import Neighbourhood, Planner

STEP = 5
SHOWN = (50, 100)
PAPER: Mapping[str, tuple[float, float]] = {
    "Proposed_4": (3.23, 7.6),
    "Proposed_5": (10.86, 19.48),
    "Proposed_6": (50.58, 75.81),
    "Proposed_10": (43.84, 54.10),
    "CARP": (0.63, 1.60),
    "CARP10": (5.29, 12.15),
    "CARP100": (52.08, 126.57),
    "LF": (0.85, 2.59),
}
"""The paper's milliseconds for the 50th robot and for the 100th, in its table I."""


def time_row(case: MapCase) -> Row:
    """Nanoseconds at the first robot, every fifth and the last, and the number of robots planned by each algorithm."""
    fleet = PlannedFleet(instance_of(case))
    planners = {name: seeded(ALGORITHMS[name], case.assignment) for name in PAPER}
    for planner in planners.values():
        warm_up(fleet, planner)
    measured, planned = {}, {}
    for name, planner in planners.items():
        measured[name] = times_of(fleet, planner)
        planned[name] = outcome(fleet)[0]
    return {"planned": planned, MEASURED: measured}


def warm_up(fleet: PlannedFleet, planner: Planner) -> None:
    """Load machine code and find the distances to all goals."""
    robots = len(fleet.instance.robots)
    carp(fleet, range(robots))
    plan_first(fleet, planner, min(planner.m + 1 if isinstance(planner, Neighbourhood) else 2, robots))


def times_of(fleet: PlannedFleet, planner: Planner) -> dict[str, int]:
    """The nanoseconds of the k-th robot, by k."""
    robots = len(fleet.instance.robots)
    wanted = [k for k in range(1, robots + 1) if k in (1, robots) or k % STEP == 0]
    fleet.clear()
    times = {}
    for k in range(1, robots + 1):
        if isinstance(planner, Neighbourhood):
            started = thread_time_ns()
            add(fleet, k - 1, 0, planner)
        elif k in wanted:
            started = thread_time_ns()
            plan_first(fleet, planner, k)
        else:
            continue
        if k in wanted:
            times[str(k)] = thread_time_ns() - started
    return times


@dataclass(frozen=True, slots=True)
class Time:
    """The mean milliseconds of an algorithm at the k-th robot, and their ratio to the mean of CARP."""

    algorithm: str
    k: int
    milliseconds: Interval
    ratio: Interval


class TimeRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    measured: dict[str, dict[int, int]]


def time_report(rows: Iterable[Row], _robots: int) -> ExperimentReport:
    """A table for the 50th and 100th robot (or half of them and all) beside the paper's."""
    times: dict[tuple[str, int], list[float]] = defaultdict(list)
    for row in rows:
        for name, by_k in msgspec.convert(row, TimeRow, strict=False).measured.items():
            for k, nanoseconds in by_k.items():
                times[name, k].append(nanoseconds / 1e6)
    carp = {k: fmean(values) for (name, k), values in times.items() if name == "CARP"}
    summary = tuple(
        Time(name, k, mean_interval(values), mean_interval([value / carp[k] for value in values]))
        for (name, k), values in sorted(times.items())
    )
    return ExperimentReport(summary, (time_table(summary),))


def time_figures(summary: Sequence[Time]) -> tuple[Figure, ...]:
    """The time of each algorithm over k, and how many times CARP's those with neighbours take."""
    lines = {name: [(each.k, each.milliseconds) for each in summary if each.algorithm == name] for name in PAPER}
    ratios = {
        name: [(each.k, each.ratio) for each in summary if each.algorithm == name]
        for name in PAPER
        if isinstance(ALGORITHMS[name], Neighbourhood)
    }
    papers = {name: tuple(zip(SHOWN, times, strict=True)) for name, times in PAPER.items()}
    cited = "(large, hollow: the paper's, in its table I)"
    title = "Time to plan when the k-th robot comes"
    return (
        Figure("time", title, ("robot", "milliseconds"), lines, True, papers, cited),
        Figure("time-ratios", f"{title}, over CARP's", ("robot", "times CARP's"), ratios, True),
    )


def time_table(summary: Sequence[Time]) -> Table:
    """Times, and ratios to CARP beside the paper's."""
    by_place = {(each.algorithm, each.k): each for each in summary}
    last = max(each.k for each in summary)
    shown = [k for k in SHOWN if k <= last] or [last]
    columns = ["algorithm"]
    for k in shown:
        columns += [f"k = {k}: ms", "paper's ms", f"k = {k}: times CARP", "the paper's"]
    rows = []
    for name, paper in PAPER.items():
        cells = [name]
        for k in shown:
            place = SHOWN.index(k) if k in SHOWN else 0
            each = by_place[name, k]
            times = f"{each.milliseconds:.2f}", f"{paper[place]:.2f}"
            cells += [*times, f"{each.ratio:.2f}", f"{paper[place] / PAPER['CARP'][place]:.1f}"]
        rows.append(tuple(cells))
    title = (
        "Time to plan when the k-th robot comes, in milliseconds and as a ratio to CARP's mean, with 95 % intervals, "
        "each beside the paper's (table I)"
    )
    return Table("time", title, tuple(columns), tuple(rows), tuple(columns[1:]))
