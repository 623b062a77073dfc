"""The distance to the optimum at the paper's size: shortest paths, a lower bound, the planner, and polished plans.

The bound is that of `carp_optimum.bound`, which no plans of all robots can beat. The polish is `carp_optimized.polish`,
which also tries to plan unplanned robots. Both run for a number of steps, not by the clock, so the numbers are the same
on any machine. On the paper's maps this is 4 to 49 s of the bound on average, and 1 to 12 s of the long polish.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from time import process_time_ns

import msgspec

import carp_optimized as engine
from carp_experiments.paper.map_cases import MAP_AXIS, MapCase, instance_of, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Figure, Table, lines_of, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import MEASURED, Row
from carp_optimum.bound import lower_bound
from carp_spec import Instance, RobotId, Solution, total_cost
from carp_verify.bound.rules import require_kept

STEPS = 2000
POLISHED = {"Proposed_4": {"polish": 20_000, "long polish": 60_000}, "Proposed_10": {"polish": 20_000}}
METHODS = tuple(
    name
    for planner, lengths in POLISHED.items()
    for name in (planner, *(f"{planner} + {length}" for length in lengths))
)
LONGEST_OF = "Proposed_4"
LONGEST = f"{LONGEST_OF} + long polish"
USUAL = f"{LONGEST_OF} + polish"
ALIKE = (LONGEST, "Proposed_10 + polish")
"""Methods whose totals are so near the usual polish that figures show them as differences from it."""
CLOSE_PER_CENT = 1.0
NANOSECONDS = 1_000_000_000


def polish_row(case: MapCase) -> Row:
    """The sum of shortest paths, the bound, and of each method the robots planned and the total cost.

    Also the robots that the longest polish leaves unplanned, and the processor time of the bound, and of a
    polish, in nanoseconds.
    """
    instance = instance_of(case)
    results: dict[str, tuple[int, int]] = {}
    left: dict[str, Sequence[RobotId]] = {}
    measured = {}
    for name, lengths in POLISHED.items():
        solution = engine.plan(instance, seeded(ALGORITHMS[name], case.assignment))
        started = process_time_ns()
        better, at = polish_to(instance, solution, [*lengths.values()], case.assignment)
        measured[name] = process_time_ns() - started
        results |= dict(zip((name, *(f"{name} + {length}" for length in lengths)), at, strict=True))
        left[name] = better.unplanned
    started = process_time_ns()
    certificate = lower_bound(instance, steps=STEPS)
    measured["bound"] = process_time_ns() - started
    for planned, total in results.values():
        if planned == len(instance.robots):
            require_kept(certificate.bound, total)
    return {
        "shortest": lower_bound(instance, steps=0).bound,
        "bound": certificate.bound,
        "cuts": len(certificate.cuts),
        "results": results,
        "left": left,
        MEASURED: measured,
    }


def polish_to(
    instance: Instance, solution: Solution, rounds: Sequence[int], seed: int
) -> tuple[Solution, list[tuple[int, int]]]:
    """Polish for the last of these numbers of rounds; the results before the first and after each of them.

    The numbers rise, and are multiples of the engine's rounds in one compiled call.
    """
    at = [reached(instance, solution)] * (len(rounds) + 1)

    def keep(played: int, unplanned: int, total: int) -> None:
        for place, length in enumerate(rounds, 1):
            if played <= length:
                at[place] = len(instance.robots) - unplanned, total

    return engine.polish(instance, solution, iterations=rounds[-1], seed=seed, advance=keep), at


def reached(instance: Instance, solution: Solution) -> tuple[int, int]:
    """The number of planned robots, and the total cost of their plans."""
    return len(solution.plans), total_cost(instance, solution.plans)


class PolishRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    shortest: int
    bound: int
    results: dict[str, tuple[int, int]]
    measured: dict[str, int]


@dataclass(frozen=True, slots=True)
class Polished:
    """A method on one map.

    `failures` counts the assignments with an unplanned robot; `unplanned` is the mean number of such robots. The other
    fields are about the other assignments: `total` is the mean total, `gap` its excess over the bound and `above` its
    excess over the sum of shortest paths, in per cent with their intervals; `close` counts those at most 1 % above the
    bound, and `proved` those at the bound, which are optimal. `beyond` is how much less its total is than that of the
    usual polish, in per cent of that, over the assignments that both plan whole.
    """

    map: int
    method: str
    assignments: int
    failures: int
    unplanned: float
    total: float | None
    gap: Interval | None
    above: Interval | None
    close: int
    proved: int
    beyond: Interval | None


@dataclass(frozen=True, slots=True)
class Floor:
    """On one map: the mean sum of shortest paths, the mean bound, and its excess over that sum in per cent.

    `bounding` and `polishing` are the mean seconds of processor time of the bound, and of the longest polish.
    """

    map: int
    shortest: float
    bound: float
    above: Interval
    bounding: float
    polishing: float


@dataclass(frozen=True, slots=True)
class PolishSummary:
    """All numbers of the experiment."""

    floors: tuple[Floor, ...]
    methods: tuple[Polished, ...]


def polish_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """Tables of gaps, of bounds and of failures."""
    maps = rows_by_map(rows, PolishRow).items()
    floors = tuple(floor(map, each) for map, each in maps)
    methods = tuple(polished(map, name, each, robots) for map, each in maps for name in METHODS)
    gaps = methods_table(
        "polish-gaps",
        "Of each method the mean total over the assignments without an unplanned robot, and by how many per cent it is "
        "above the lower bound, with its 95 % interval if there are several",
        methods,
        _gap,
    )
    failures = methods_table(
        "polish-failures",
        "Assignments with an unplanned robot, and how many such robots an assignment has on average",
        methods,
        lambda each: f"{each.failures}/{each.assignments} ({each.unplanned:.2f})",
    )
    return ExperimentReport(PolishSummary(floors, methods), (gaps, bounds_table(floors, methods), failures))


def floor(map: int, rows: Sequence[PolishRow]) -> Floor:
    """The lower bound on a map."""
    return Floor(
        map,
        fmean(row.shortest for row in rows),
        fmean(row.bound for row in rows),
        mean_interval([per_cent_above(row.bound, row.shortest) for row in rows]),
        fmean(row.measured["bound"] for row in rows) / NANOSECONDS,
        fmean(row.measured[LONGEST_OF] for row in rows) / NANOSECONDS,
    )


def polished(map: int, name: str, rows: Sequence[PolishRow], robots: int) -> Polished:
    """A method on a map."""
    everyone = [(row.results[name][1], row) for row in rows if row.results[name][0] == robots]
    gaps = [per_cent_above(total, row.bound) for total, row in everyone]
    above = [per_cent_above(total, row.shortest) for total, row in everyone]
    both = [(total, row.results[USUAL][1]) for total, row in everyone if row.results[USUAL][0] == robots]
    beyond = [-per_cent_above(total, usual) for total, usual in both]
    return Polished(
        map,
        name,
        len(rows),
        len(rows) - len(everyone),
        fmean(robots - row.results[name][0] for row in rows),
        fmean(total for total, _ in everyone) if everyone else None,
        mean_interval(gaps) if gaps else None,
        mean_interval(above) if above else None,
        sum(gap <= CLOSE_PER_CENT for gap in gaps),
        sum(total == row.bound for total, row in everyone),
        mean_interval(beyond) if beyond else None,
    )


def per_cent_above(total: int, least: int) -> float:
    """The excess of a total over a positive one, in per cent; 0 over a total of 0 that is reached."""
    return 100 * (total - least) / max(least, 1)


def methods_table(name: str, title: str, methods: Sequence[Polished], cell: Callable[[Polished], str]) -> Table:
    """A row for each map, a column for each method."""
    columns = ("map", *METHODS)
    maps = sorted({each.map for each in methods})
    rows = [(str(map), *(cell(each) for each in methods if each.map == map)) for map in maps]
    return Table(name, title, columns, tuple(rows), columns)


def bounds_table(floors: Sequence[Floor], methods: Sequence[Polished]) -> Table:
    """The bound, and the number of assignments that the longest polish brings to within 1 % of it, and to it."""
    title = (
        "Mean sum of shortest paths, mean lower bound and by how many per cent it is above that sum; of the "
        f"assignments without an unplanned robot after {LONGEST}, how many are at most 1 % above the bound, and how "
        "many at it, so that the optimum is proved; mean processor time of the bound, and of this polish"
    )
    longest = {each.map: each for each in methods if each.method == LONGEST}
    planned = {each.map: each.assignments - each.failures for each in longest.values()}
    cells: Mapping[str, Callable[[Floor], object]] = {
        "map": lambda each: each.map,
        "shortest": lambda each: f"{each.shortest:.0f}",
        "bound": lambda each: f"{each.bound:.0f}",
        "above it": lambda each: _per_cent(each.above),
        "within 1 %": lambda each: f"{longest[each.map].close}/{planned[each.map]}",
        "proved": lambda each: f"{longest[each.map].proved}/{planned[each.map]}",
        "bound, s": lambda each: f"{each.bounding:.1f}",
        "polish, s": lambda each: f"{each.polishing:.1f}",
    }
    return table_of("polish-bounds", title, floors, cells)


def polish_figures(summary: PolishSummary) -> tuple[Figure, ...]:
    """The excess of the methods over the bound, and that of both over the sum of shortest paths.

    The optimum lies between the methods and the bound. What more rounds add, or a polish of other plans, is drawn as
    differences.
    """
    apart = [each for each in summary.methods if each.method not in ALIKE]
    alike = [each for each in summary.methods if each.method in ALIKE]
    gaps = lines_of(apart, lambda each: each.method, lambda each: (each.map, each.gap))
    above = lines_of(apart, lambda each: each.method, lambda each: (each.map, each.above))
    beyond = lines_of(alike, lambda each: each.method, lambda each: (each.map, each.beyond))
    totals = {**above, "lower bound": [(each.map, each.above) for each in summary.floors]}
    axes = (MAP_AXIS, "per cent")
    return (
        Figure("polish", "Total above the lower bound", axes, gaps, logarithmic=True),
        Figure("polish-totals", "Total and bound above the sum of shortest paths", axes, totals, logarithmic=True),
        Figure("polish-beyond", f"Total below that of {USUAL}", axes, beyond),
    )


def _gap(each: Polished) -> str:
    return "all failed" if each.gap is None or each.total is None else f"{each.total:.0f}: {_per_cent(each.gap)}"


def _per_cent(interval: Interval) -> str:
    return f"{interval:.2f}" if interval.high > interval.estimate else f"{interval.estimate:.2f}"
