"""The distance to the optimum at the paper's size: shortest paths, a lower bound, the planner, and what is polished.

The bound is that of `carp_verify.bound`, which no plans of all robots can beat; the polish is `carp_optimized.polish`,
which also tries to plan robots that have no plan. Both by a number of steps, not by the clock.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import fmean

import msgspec

from carp_experiments.quality import ALGORITHMS, ROBOTS, seeded
from carp_experiments.quality_report import MAP_AXIS
from carp_experiments.report import Figure, Report, Table
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_spec import Instance, Solution, total_cost

STEPS = 1000
ROUNDS = 20_000
PLANNERS = ("Proposed_4", "Proposed_10")
METHODS = tuple(name for planner in PLANNERS for name in (planner, f"{planner} + polish"))
CLOSE_PER_CENT = 1.0


@dataclass(frozen=True, slots=True)
class PolishCase:
    """One assignment on one map, bounded, planned and polished."""

    map: int
    assignment: int
    robots: int = ROBOTS

    @property
    def key(self) -> str:
        """Assignments and maps in their order."""
        return f"assignment {self.assignment:03} map {self.map:02}"

    def run(self) -> Row:
        """The sum of shortest paths, the bound, and of each method the robots planned and the total cost."""
        import carp_optimized as engine  # noqa: PLC0415 - each worker loads it
        from carp_oracle.generate import Fleet, Grid, grid_instance  # noqa: PLC0415
        from carp_verify.bound import lower_bound  # noqa: PLC0415

        instance = grid_instance(Grid(map=self.map), Fleet(robots=self.robots, seed=self.assignment))
        results = {}
        for name in PLANNERS:
            solution = engine.plan(instance, seeded(ALGORITHMS[name], self.assignment))
            better = engine.polish(instance, solution, iterations=ROUNDS, seed=self.assignment)
            results[name] = reached(instance, solution)
            results[f"{name} + polish"] = reached(instance, better)
        shortest = lower_bound(instance, steps=0).bound
        bound = lower_bound(instance, steps=STEPS).bound
        return {
            "map": self.map,
            "assignment": self.assignment,
            "shortest": shortest,
            "bound": bound,
            "results": results,
        }


def reached(instance: Instance, solution: Solution) -> tuple[int, int]:
    """How many robots have a plan, and the total cost of these plans."""
    return len(solution.plans), total_cost(instance, solution.plans)


def polish_cases(assignments: int, maps: Sequence[int], robots: int) -> tuple[PolishCase, ...]:
    """The cases of the experiment, assignment by assignment."""
    return tuple(PolishCase(map, assignment, robots) for assignment in range(assignments) for map in maps)


class PolishRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    shortest: int
    bound: int
    results: dict[str, tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Polished:
    """A method on one map.

    `failures` are the assignments with an unplanned robot, `unplanned` the mean number of such robots; over the other
    assignments, `total` is the mean total and `gap` what it is above the bound in per cent, with its interval, `close`
    how many are at most 1 % above it, and `proved` how many are at the bound, and so the optimum.
    """

    map: int
    method: str
    assignments: int
    failures: int
    unplanned: float
    total: float | None
    gap: Interval | None
    close: int
    proved: int


@dataclass(frozen=True, slots=True)
class Floor:
    """The mean sum of shortest paths and the mean bound on one map."""

    map: int
    shortest: float
    bound: float


@dataclass(frozen=True, slots=True)
class PolishSummary:
    """All numbers of the experiment."""

    floors: tuple[Floor, ...]
    methods: tuple[Polished, ...]


def polish_report(rows: Iterable[Row], robots: int) -> Report:
    """Two tables, of totals and gaps and of failures, and a figure of the gaps."""
    by_map: dict[int, list[PolishRow]] = defaultdict(list)
    for row in rows:
        measured = msgspec.convert(row, PolishRow)
        by_map[measured.map].append(measured)
    maps = sorted(by_map.items())
    floors = tuple(
        Floor(map, fmean(row.shortest for row in each), fmean(row.bound for row in each)) for map, each in maps
    )
    methods = tuple(polished(map, name, each, robots) for map, each in maps for name in METHODS)
    lines = {name: [(each.map, each.gap) for each in methods if each.method == name] for name in METHODS}
    figure = Figure("polish", "Total above the lower bound", (MAP_AXIS, "per cent"), lines, logarithmic=True)
    return Report(PolishSummary(floors, methods), (gaps_table(floors, methods), failures_table(methods)), (figure,))


def polished(map: int, name: str, rows: Sequence[PolishRow], robots: int) -> Polished:
    """A method on a map."""
    everyone = [(row.results[name][1], row.bound) for row in rows if row.results[name][0] == robots]
    gaps = [100 * (total - bound) / bound for total, bound in everyone if bound]
    return Polished(
        map,
        name,
        len(rows),
        len(rows) - len(everyone),
        fmean(robots - row.results[name][0] for row in rows),
        fmean(total for total, _ in everyone) if everyone else None,
        mean_interval(gaps) if gaps else None,
        sum(gap <= CLOSE_PER_CENT for gap in gaps),
        sum(total == bound for total, bound in everyone),
    )


def gaps_table(floors: Sequence[Floor], methods: Sequence[Polished]) -> Table:
    """Means and gaps; of the polished, how many are close to the bound and at it."""
    last = METHODS[-1]
    columns = ("map", "shortest", "bound", *METHODS, f"{last}: within 1 %", "optimum proved")
    rows = []
    for floor in floors:
        here = {each.method: each for each in methods if each.map == floor.map}
        planned = here[last].assignments - here[last].failures
        cells = [str(floor.map), f"{floor.shortest:.0f}", f"{floor.bound:.0f}", *(_gap(here[name]) for name in METHODS)]
        rows.append((*cells, f"{here[last].close}/{planned}", f"{here[last].proved}/{planned}"))
    title = (
        "Mean sum of shortest paths and mean lower bound; of each method the mean total over the assignments "
        "without an unplanned robot, and by how many per cent it is above the bound, with its 95 % interval"
    )
    return Table("polish-gaps", title, columns, tuple(rows), columns)


def failures_table(methods: Sequence[Polished]) -> Table:
    """Assignments with an unplanned robot, and how many such robots there are on average."""
    columns = ("map", *METHODS)
    maps = sorted({each.map for each in methods})
    rows = [
        (
            str(map),
            *(f"{each.failures}/{each.assignments} ({each.unplanned:.2f})" for each in methods if each.map == map),
        )
        for map in maps
    ]
    title = "Assignments with an unplanned robot, and how many such robots an assignment has on average"
    return Table("polish-failures", title, columns, tuple(rows), columns)


def _gap(each: Polished) -> str:
    if each.gap is None or each.total is None:
        return "all failed"
    return f"{each.total:.0f}: {each.gap.estimate:.2f} ± {each.gap.high - each.gap.estimate:.2f}"
