"""The report on conventions: how near each brings carproof's measurements to the paper's figures and comparisons."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import TypeAlias

import msgspec

from carp_experiments.paper.claims import quality_claims
from carp_experiments.paper.map_cases import FULL_MAP, TENTH_MAP
from carp_experiments.paper.quality import interval_of_means, summarise
from carp_experiments.report import ExperimentReport, Table, table_of
from carp_experiments.statistics import Interval
from carp_experiments.store import Row

PAPERS = {TENTH_MAP: (65, ("Proposed_6",)), FULL_MAP: (35, ("Proposed_6", "Proposed_10"))}
"""By map: fewer actions than CARP's, as the paper states them, and its algorithms of which it says so."""
VARIANTS = {"as published": "", "with the baseline": " + baseline"}
SHOWN = 24
"""The nearest conventions, which the table has."""
MEANS = ("neither fails", "own successes", "nobody fails")
Totals: TypeAlias = Mapping[str, int | None]
"""Of an assignment, by algorithm."""


@dataclass(frozen=True, slots=True)
class Nearness:
    """A convention and a variant of the algorithm beside the paper.

    `savings` are those of the paper's algorithms over CARP by map and kind of mean, `None` where there is no case;
    `intervals` are those where neither fails, of the assignments' means over these algorithms, if there are several.
    `broken` are the paper's comparisons that the measurements contradict; `distance` is as `conventions` defines it,
    with the mean over the assignments on which neither fails.
    """

    convention: str
    variant: str
    assignments: int
    savings: dict[str, dict[str, float | None]]
    intervals: dict[str, Interval | None]
    failures: dict[str, dict[str, int]]
    verdicts: dict[str, str]
    broken: int
    distance: float | None


class ConventionsRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    results: dict[str, dict[str, tuple[int, int]]]
    meetings: dict[str, dict[str, int]] = {}
    """Of conventions whose plans may break the law: how often robots meet, by algorithm."""


def conventions_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """The conventions by their distance, and for each comparison of the paper where it holds."""
    stored = [msgspec.convert(row, ConventionsRow) for row in rows]
    summary = [
        nearness_of(name, variant, [row for row in stored if name in row.results], robots)
        for name in dict.fromkeys(name for row in stored for name in row.results)
        for variant in VARIANTS
    ]
    ordered = sorted(summary, key=lambda each: (each.distance is None, each.distance or 0.0))
    met = [meetings_table(stored, robots)] if any(row.meetings for row in stored) else []
    return ExperimentReport(tuple(ordered), (distance_table(ordered), claims_table(ordered), *met))


def nearness_of(convention: str, variant: str, stored: Sequence[ConventionsRow], robots: int) -> Nearness:
    """One convention, with the algorithms as published or with the baseline."""
    rows: list[Row] = [
        {"map": row.map, "assignment": row.assignment, "results": row.results[convention]} for row in stored
    ]
    summary = summarise(rows, robots)
    claims = (claim for claim in quality_claims(summary) if not claim.claim.startswith("up to"))  # those name a number
    verdicts: dict[str, str] = {
        claim.claim: claim.with_baseline or claim.verdict if VARIANTS[variant] else claim.verdict for claim in claims
    }
    savings, intervals, failures = {}, {}, {}
    for map, (_, published) in PAPERS.items():
        names = [name + VARIANTS[variant] for name in published]
        totals = [totals_of(row.results[convention], robots) for row in stored if row.map == map]
        savings[str(map)] = savings_of(totals, names)
        intervals[str(map)] = interval_of(totals, names)
        failures[str(map)] = {
            each.algorithm: each.failures
            for each in summary.algorithms
            if each.map == map and (" + " in each.algorithm) in (False, bool(VARIANTS[variant]))
        }
    broken = sum(verdict == "not reproduced" for verdict in verdicts.values())
    saved = {map: savings[str(map)][MEANS[0]] for map in PAPERS}
    apart = [abs(each / PAPERS[map][0] - 1) for map, each in saved.items() if each is not None]
    distance = sum(apart) + broken if len(apart) == len(saved) else None
    assignments = len({row.assignment for row in stored})
    return Nearness(convention, variant, assignments, savings, intervals, failures, verdicts, broken, distance)


def totals_of(results: Mapping[str, tuple[int, int]], robots: int) -> Totals:
    """The total of each algorithm, `None` if it has failed."""
    return {name: total if planned == robots else None for name, (planned, total) in results.items()}


def savings_of(assignments: Sequence[Totals], names: Sequence[str]) -> dict[str, float | None]:
    """By kind of mean, the actions that these algorithms save against CARP: the mean of theirs."""
    everybody = {name for totals in assignments for name in totals}
    savings: dict[str, list[float]] = {means: [] for means in MEANS}
    for name in names:
        for means, needed in zip(MEANS, ({"CARP", name}, set[str](), everybody), strict=True):
            counted = [totals for totals in assignments if not any(totals[each] is None for each in needed)]
            carps, ours = ([each for totals in counted if (each := totals[of]) is not None] for of in ("CARP", name))
            if carps and ours:
                savings[means].append(fmean(carps) - fmean(ours))
    return {means: fmean(found) if found else None for means, found in savings.items()}


def interval_of(assignments: Sequence[Totals], names: Sequence[str]) -> Interval | None:
    """The interval of the actions saved, where CARP and the other plan all robots; of several assignments."""
    saved = [
        [totals["CARP"] - ours for name in names if (ours := totals[name]) is not None]
        for totals in assignments
        if totals["CARP"] is not None
    ]
    groups = [each for each in saved if each]
    return interval_of_means(groups) if len(groups) > 1 else None


def distance_table(ordered: Sequence[Nearness]) -> Table:
    """Each convention with its savings and failures, the nearest first."""
    title = (
        f"The conventions nearest to the paper, over {max((each.assignments for each in ordered), default=0)} "
        f"assignments: actions saved against CARP, where {', '.join(MEANS)} (the paper: 65 and 35); failures of CARP, "
        "CARP10, Proposed_6; comparisons that are contradicted"
    )
    cells: Mapping[str, Callable[[Nearness], object]] = {
        "convention": lambda each: each.convention,
        "variant": lambda each: each.variant,
        "saved, map 10": lambda each: saved_on(each, TENTH_MAP),
        "saved, map 20": lambda each: saved_on(each, FULL_MAP),
        "failures, map 10": failures_on_tenth,
        "broken": lambda each: each.broken,
        "distance": lambda each: number(each.distance, 2),
    }
    return table_of("conventions", title, ordered[:SHOWN], cells, names=2)


def saved_on(each: Nearness, map: int) -> str:
    """The savings on a map, by kind of mean."""
    first, *others = (number(each.savings[str(map)][means]) for means in MEANS)
    interval = each.intervals[str(map)]
    return " / ".join([first if interval is None else f"{interval:.0f}", *others])


def failures_on_tenth(each: Nearness) -> str:
    """The failures of three algorithms on the tenth map."""
    names = ("CARP", "CARP10", "Proposed_6" + VARIANTS[each.variant])
    return " / ".join(str(each.failures[str(TENTH_MAP)].get(name, "-")) for name in names)


def claims_table(ordered: Sequence[Nearness]) -> Table:
    """For each comparison, under how many conventions it is reproduced, and under which it is contradicted."""
    columns = ("comparison", "variant", "reproduced", "in part", "undecided", "contradicted", "contradicted under")
    rows = []
    for claim in dict.fromkeys(claim for each in ordered for claim in each.verdicts):
        for variant in VARIANTS:
            verdicts = {each.convention: each.verdicts[claim] for each in ordered if each.variant == variant}
            kinds = ("reproduced", "in part", "undecided", "not reproduced")
            counts = [sum(verdict == kind for verdict in verdicts.values()) for kind in kinds]
            where = sorted(name for name, verdict in verdicts.items() if verdict == kinds[-1])
            shown = "; ".join(where) if len(where) < len(verdicts) else "every convention"
            rows.append((claim, variant, *map(str, counts), shown))
    return Table(
        "conventions-claims", "The paper's comparisons over the conventions", columns, tuple(rows), columns[2:6]
    )


def meetings_table(stored: Sequence[ConventionsRow], robots: int) -> Table:
    """Of plans for all robots, in how many assignments two robots meet."""
    maps = sorted({row.map for row in stored})
    names = dict.fromkeys((name, each) for row in stored for name, met in row.meetings.items() for each in met)
    rows = []
    for name, algorithm in names:
        cells = []
        for map in maps:
            whole = [row for row in stored if row.map == map and row.results[name][algorithm][0] == robots]
            cells.append(f"{sum(row.meetings[name][algorithm] > 0 for row in whole)} of {len(whole)}")
        rows.append((name, algorithm, *cells))
    columns = ("convention", "algorithm", *(f"map {map}" for map in maps))
    title = "Assignments in which robots meet, of those in which all have a plan"
    return Table("conventions-meetings", title, columns, tuple(rows), columns[2:])


def number(value: float | None, digits: int = 0) -> str:
    """The number, or a dash."""
    return "-" if value is None else f"{value:.{digits}f}"
