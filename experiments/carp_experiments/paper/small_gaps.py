"""Small maps against the optimum: the distance of each algorithm from it, over the density of the map.

Also the distance of polished plans of Proposed_4, and of the lower bound of `carp_optimum.bound`.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import msgspec

import carp_optimized as engine
from carp_experiments.paper.map_cases import MAP_AXIS, MapCase, rows_by_map, shown_maps
from carp_experiments.paper.quality import ALGORITHMS, outcome, plan_first, seeded
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_by_map
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import greedy
from carp_optimum.bound import lower_bound
from carp_optimum.optimum import optimum
from carp_spec import Greedy, Instance, Planner, total_cost
from carp_verify.bound.rules import require_kept
from carproof.generate import Fleet, Grid, grid_instance

SIDE = 8
LIMIT_IN_SECONDS = 60
COMPARED: Mapping[str, Planner] = {
    **{name: planner for name, planner in ALGORITHMS.items() if name != "Proposed_4 + CARP100"},
    "greedy": Greedy(),
}
GIVEN = "Proposed_4"
POLISHED = f"{GIVEN} + polish"
BOUND = "lower bound"
REPORTED = (*COMPARED, POLISHED, BOUND)
ROUNDS = 2_000
STEPS = 1_000


def gap_row(case: MapCase) -> Row:
    """The optimum (`None` if it was not found in a minute or none exists), robots planned, and total cost.

    Each assignment has a small map of its own. Only a search that takes nearly a minute can end differently on another
    machine.
    """
    instance = small_instance(case)
    fleet = PlannedFleet(instance)
    results = {}
    for name, planner in COMPARED.items():
        if isinstance(planner, Greedy):
            greedy(fleet, lambda: None)
        else:
            plan_first(fleet, seeded(planner, case.assignment), case.robots)
        results[name] = outcome(fleet)
    solution = engine.plan(instance, seeded(COMPARED[GIVEN], case.assignment))
    polished = engine.polish(instance, solution, iterations=ROUNDS, seed=case.assignment)
    results[POLISHED] = len(polished.plans), total_cost(instance, polished.plans)
    best = optimum(instance, LIMIT_IN_SECONDS)
    bound = lower_bound(instance, steps=STEPS).bound
    for planned, total in results.values():
        if planned == len(instance.robots):
            require_kept(max(best.lower, bound), total)
    return {
        "shortest": best.shortest,
        "bound": bound,
        "optimum": best.cost if best.decided else None,
        "decided": best.decided,
        "results": results,
    }


def small_instance(case: MapCase) -> Instance:
    """The map of an assignment with its robots."""
    grid = Grid(SIDE, SIDE, case.map, map_seed=case.assignment)
    return grid_instance(grid, Fleet(robots=case.robots, seed=case.assignment))


@dataclass(frozen=True, slots=True)
class GapOf:
    """An algorithm on the maps of one density: in per cent above the optimum, over the assignments that it plans.

    `solvable` are the assignments with a known optimum, `failures` those of them that the algorithm fails on.
    """

    map: int
    algorithm: str
    solvable: int
    failures: int
    gap: Interval | None


class GapRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    shortest: int | None
    bound: int
    optimum: int | None
    decided: bool
    results: dict[str, tuple[int, int]]


def gap_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """A table over some of the maps."""
    by_map = rows_by_map(rows, GapRow)
    summary = tuple(gap_of(map, name, each, robots) for map, each in by_map.items() for name in REPORTED)
    shown = [each for each in summary if each.map in shown_maps(by_map)]
    known = {("optimum known", each.map): f"{each.solvable}/{len(by_map[each.map])}" for each in shown}
    title = (
        f"Above the optimum that the search found, {robots} robots on {SIDE} x {SIDE} maps: in per cent, means with "
        "95 % intervals"
    )
    cells = {(each.algorithm, each.map): _cell(each) for each in shown}
    table = table_by_map("gap", title, "algorithm", {**known, **cells})
    return ExperimentReport(summary, (table,))


def gap_figures(summary: Sequence[GapOf]) -> tuple[Figure, ...]:
    """The gap of each algorithm over the maps."""
    lines = lines_of(summary, lambda each: each.algorithm, lambda each: (each.map, each.gap))
    title = f"Above the optimum that the search found, on {SIDE} x {SIDE} maps"
    return (Figure("gap", title, (MAP_AXIS, "per cent above the optimum"), lines),)


def gap_of(map: int, name: str, rows: Sequence[GapRow], robots: int) -> GapOf:
    """An algorithm, or the bound, on the maps of one density."""
    known = [row for row in rows if row.optimum is not None]
    reached = [(robots, row.bound) if name == BOUND else row.results[name] for row in known]
    above = [
        100 * (total - row.optimum) / (row.optimum or 1)
        for (planned, total), row in zip(reached, known, strict=True)
        if planned == robots and row.optimum is not None
    ]
    return GapOf(map, name, len(known), len(known) - len(above), mean_interval(above) if above else None)


def _cell(each: GapOf) -> str:
    failed = f" ({each.failures} failed)" if each.failures else ""
    return f"-{failed}" if each.gap is None else f"{each.gap:.2f}{failed}"
