"""Experiment 1 of the paper: the failures of each algorithm, and the number of actions of its plans.

100 robots on 21 maps from a spanning tree to the full grid; the same assignments on every map.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean

import msgspec

from carp_experiments.paper.map_cases import (
    FULL_MAP,
    MAP_AXIS,
    ROBOTS,
    TENTH_MAP,
    MapCase,
    instance_of,
    rows_by_map,
    shown_maps,
)
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_by_map
from carp_experiments.statistics import Interval, mean_interval, proportion_interval
from carp_experiments.store import Row
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp, shuffled
from carp_spec import Carp, LongestFirst, Neighbourhood, Planner, Shuffled, total_cost

ALGORITHMS: Mapping[str, Planner] = {
    "CARP": Carp(),
    "CARP10": Shuffled(attempts=10),
    "CARP100": Shuffled(attempts=100),
    "LF": LongestFirst(),
    "Proposed_4": Neighbourhood(m=4, baseline=False),
    "Proposed_5": Neighbourhood(m=5, baseline=False),
    "Proposed_6": Neighbourhood(m=6, baseline=False),
    "Proposed_10": Neighbourhood(m=10, sample=150, baseline=False),
    "Proposed_4 + baseline": Neighbourhood(m=4),
    "Proposed_5 + baseline": Neighbourhood(m=5),
    "Proposed_6 + baseline": Neighbourhood(m=6),
    "Proposed_10 + baseline": Neighbourhood(m=10, sample=150),
    "Proposed_4 + CARP100": Neighbourhood(m=4, baseline=False, fallback=100),
}
BEFORE_FALLBACK = {"Proposed_4 + CARP100": "Proposed_4"}
RIVALS = ("CARP", "CARP10", "CARP100", "Proposed_10")
PAPERS_SAVINGS: Mapping[str, Sequence[tuple[int, float]]] = {
    "Proposed_6": ((TENTH_MAP, 65), (FULL_MAP, 35)),
    "Proposed_10": ((FULL_MAP, 35),),
}
"""By algorithm: on which map how many fewer actions than CARP the paper has, in the text of its section IV."""
PAPERS_FAILURES = "Assignments that fail\n(the paper, section IV: Proposed between CARP and CARP10)"
FEWEST_SHOWN = 4  # a mean over less than a quarter of the assignments is no point in a figure


def quality_row(case: MapCase) -> Row:
    """For each algorithm the robots planned and the total cost; beside them the sum of shortest paths.

    An algorithm that adds robots one by one stops at the first that stays unplanned, because the assignment is a
    failure then.
    """
    fleet = PlannedFleet(instance_of(case))
    results: dict[str, tuple[int, int]] = {}
    for name, planner in ALGORITHMS.items():
        if name not in BEFORE_FALLBACK:
            plan_first(fleet, seeded(planner, case.assignment), case.robots)
            results[name] = outcome(fleet)
        for fallback in [other for other, before in BEFORE_FALLBACK.items() if before == name]:
            left = range(results[name][0], case.robots)
            add_until_failure(fleet, seeded(ALGORITHMS[fallback], case.assignment), left)
            results[fallback] = outcome(fleet)
    return {"shortest": sum(fleet.ticks_to_goal(robot) for robot in range(case.robots)), "results": results}


def plan_first(fleet: PlannedFleet, planner: Planner, count: int) -> None:
    """Plan the first robots alone, as `carp_optimized.plan` does, up to the first that cannot be added."""
    robots = range(count)
    match planner:
        case Shuffled():
            shuffled(fleet, planner, robots, lambda: None)
        case LongestFirst():
            carp(fleet, sorted(robots, key=lambda robot: -fleet.ticks_to_goal(robot)))
        case Neighbourhood():
            fleet.clear()
            add_until_failure(fleet, planner, robots)
        case _:
            carp(fleet, robots)


def add_until_failure(fleet: PlannedFleet, planner: Planner, robots: Iterable[int]) -> None:
    """Add robots until one stays unplanned."""
    assert isinstance(planner, Neighbourhood)  # noqa: S101 - a promise of ours
    for robot in robots:
        if not add(fleet, robot, 0, planner):
            return


def outcome(fleet: PlannedFleet) -> tuple[int, int]:
    """The number of planned robots, and the total cost of their plans."""
    return len(fleet.order), total_cost(fleet.instance, fleet.plans)


def seeded(planner: Planner, seed: int) -> Planner:
    """The planner with a seed of its own, if it draws orders."""
    return replace(planner, seed=seed) if isinstance(planner, Shuffled | Neighbourhood) else planner


@dataclass(frozen=True, slots=True)
class Summary:
    """An algorithm on one map: its failures among the assignments, and its mean total over the others.

    `total` is the mean with its 95 % interval, or `None` if it failed on all.
    """

    map: int
    algorithm: str
    failures: int
    assignments: int
    failure_rate: Interval
    total: Interval | None


@dataclass(frozen=True, slots=True)
class Saving:
    """The saving of an algorithm's total over a rival's, in the cases in which neither fails.

    Over all maps (`map` is `None`), the interval is that of the assignments' means over their maps. `total` is the
    rival's mean total in these cases.
    """

    map: int | None
    algorithm: str
    rival: str
    cases: int
    saving: Interval
    total: float


@dataclass(frozen=True, slots=True)
class FailureDifference:
    """The difference between the failure rates of an algorithm and a rival, over all maps.

    The interval is that of the assignments' means over their maps.
    """

    algorithm: str
    rival: str
    more: Interval


@dataclass(frozen=True, slots=True)
class QualitySummary:
    """All numbers of the experiment."""

    robots: int
    assignments: int
    algorithms: tuple[Summary, ...]
    savings: tuple[Saving, ...]
    failures: tuple[FailureDifference, ...]


class QualityRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    results: dict[str, tuple[int, int]]

    def total(self, algorithm: str, robots: int) -> int | None:
        """The total cost of an algorithm, or `None` if it failed."""
        planned, total = self.results[algorithm]
        return total if planned == robots else None


def summarise(rows: Iterable[Row], robots: int = ROBOTS) -> QualitySummary:
    """Summaries by map and algorithm; an assignment with an unplanned robot is a failure."""
    maps = rows_by_map(rows, QualityRow).items()
    everything = [row for _, each in maps for row in each]
    names = [name for name in ALGORITHMS if any(name in row.results for row in everything)]
    algorithms = [summary_of(map, name, each, robots) for map, each in maps for name in names]
    places: list[tuple[int | None, list[QualityRow]]] = [*maps, (None, everything)]
    savings = [saving for map, each in places for saving in savings_on(map, each, robots, names)]
    failures = [failure_difference(name, rival, everything, robots) for name, rival in pairs_of_rivals(names)]
    assignments = len({row.assignment for row in everything})
    return QualitySummary(robots, assignments, tuple(algorithms), tuple(savings), tuple(failures))


def summary_of(map: int, name: str, rows: Sequence[QualityRow], robots: int) -> Summary:
    """An algorithm on a map."""
    totals = [total for row in rows if (total := row.total(name, robots)) is not None]
    failures = len(rows) - len(totals)
    rate = proportion_interval(failures, len(rows))
    return Summary(map, name, failures, len(rows), rate, mean_interval(totals) if totals else None)


def pairs_of_rivals(names: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Each algorithm with each rival that it is compared with."""
    for name in names:
        yield from ((name, rival) for rival in RIVALS if rival != name)


def savings_on(map: int | None, rows: Sequence[QualityRow], robots: int, names: Sequence[str]) -> Iterator[Saving]:
    """The savings on a map, or on all, where there are cases on which neither fails."""
    for name, rival in pairs_of_rivals(names):
        saved: dict[int, list[int]] = defaultdict(list)
        totals = []
        for row in rows:
            ours, theirs = row.total(name, robots), row.total(rival, robots)
            if ours is not None and theirs is not None:
                saved[row.assignment].append(theirs - ours)
                totals.append(theirs)
        if saved:
            yield Saving(map, name, rival, len(totals), interval_of_means(saved.values()), fmean(totals))


def failure_difference(name: str, rival: str, rows: Sequence[QualityRow], robots: int) -> FailureDifference:
    """The difference between the failure rates of an algorithm and a rival, on the same assignments."""
    more: dict[int, list[int]] = defaultdict(list)
    for row in rows:
        more[row.assignment].append((row.total(name, robots) is None) - (row.total(rival, robots) is None))
    return FailureDifference(name, rival, interval_of_means(more.values()))


def interval_of_means(groups: Iterable[Sequence[float]]) -> Interval:
    """The mean of the groups' means, because measurements on the same assignment are not independent."""
    return mean_interval([fmean(group) for group in groups])


def quality_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """Failure rates in per cent, and mean totals over the assignments that did not fail, on some of the maps."""
    summary = summarise(rows, robots)
    maps = shown_maps(each.map for each in summary.algorithms)
    shown = [each for each in summary.algorithms if each.map in maps]
    failures = table_by_map(
        "quality-failures",
        "Failure rate in per cent, with its 95 % interval",
        "algorithm",
        {(each.algorithm, each.map): _percent(each.failure_rate) for each in shown},
    )
    totals = table_by_map(
        "quality-totals",
        "Mean total cost over the assignments that did not fail, with its 95 % interval",
        "algorithm",
        {(each.algorithm, each.map): "all failed" if each.total is None else f"{each.total:.1f}" for each in shown},
    )
    return ExperimentReport(summary, (failures, totals))


def quality_figures(summary: QualitySummary) -> tuple[Figure, ...]:
    """Failures, and the actions saved against CARP, over all maps."""
    savings = {
        name: [
            (each.map, each.saving)
            for each in summary.savings
            if (each.algorithm, each.rival) == (name, "CARP") and each.map is not None
            if each.cases * FEWEST_SHOWN >= summary.assignments
        ]
        for name in ALGORITHMS
        if name != "CARP"
    }
    failures = lines_of(summary.algorithms, lambda each: each.algorithm, lambda each: (each.map, each.failure_rate))
    return (
        Figure("quality-failures", PAPERS_FAILURES, (MAP_AXIS, "failure rate"), failures),
        Figure(
            "quality-savings",
            "Fewer actions than CARP, where neither fails",
            (MAP_AXIS, "actions"),
            savings,
            papers=PAPERS_SAVINGS if summary.robots == ROBOTS else {},
            cited="(large, hollow: the paper's, in its section IV)",
        ),
    )


def _percent(rate: Interval) -> str:
    return f"{100 * rate.estimate:.1f} ({100 * rate.low:.1f} to {100 * rate.high:.1f})"
