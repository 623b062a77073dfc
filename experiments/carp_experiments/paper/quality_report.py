"""The report of the quality experiment."""

from collections.abc import Iterable, Mapping, Sequence

from carp_experiments.paper.map_cases import FULL_MAP, MAP_AXIS, ROBOTS, TENTH_MAP, shown_maps
from carp_experiments.paper.quality import ALGORITHMS, QualitySummary, summarise
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_by_map
from carp_experiments.statistics import Interval
from carp_experiments.store import Row

PAPERS_SAVINGS: Mapping[str, Sequence[tuple[int, float]]] = {
    "Proposed_6": ((TENTH_MAP, 65), (FULL_MAP, 35)),
    "Proposed_10": ((FULL_MAP, 35),),
}
"""By algorithm: on which map how many fewer actions than CARP the paper has, in the text of its section IV."""
PAPERS_FAILURES = "Assignments that fail\n(the paper, section IV: Proposed between CARP and CARP10)"
FEWEST_SHOWN = 4  # a mean over less than a quarter of the assignments is no point in a figure


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
        {(each.algorithm, each.map): _mean(each.total) for each in shown},
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


def _mean(total: Interval | None) -> str:
    return "all failed" if total is None else f"{total:.1f}"
