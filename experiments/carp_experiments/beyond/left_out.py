"""Robots that `carproof plan` leaves out, as a user first calls it: before and after its repair."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import msgspec

import carp_optimized as engine
from carp_experiments.paper.map_cases import MapCase, instance_of, rows_by_map
from carp_experiments.report import ExperimentReport, table_of
from carp_experiments.store import Row
from carp_optimized.improve.repair import repair
from carp_spec import RobotId, total_cost, violations_of


def left_out_row(case: MapCase) -> Row:
    """How many robots the default planner leaves out, which the repair leaves out, and the total in the end."""
    instance = instance_of(case)
    given = engine.plan(instance)
    repaired = repair(instance, given)
    for violation in violations_of(instance, repaired.plans):
        raise AssertionError(violation)
    return {"before": len(given.unplanned), "left": repaired.unplanned, "total": total_cost(instance, repaired.plans)}


class LeftOutRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    before: int
    left: tuple[RobotId, ...]
    total: int


@dataclass(frozen=True, slots=True)
class LeftOut:
    """On a map, the assignments, and those in which somebody is left out before and after the repair."""

    map: int
    assignments: int
    before: int
    after: int


def left_out_report(rows: Iterable[Row], _robots: int) -> ExperimentReport:
    """A table of the maps, and a line for each assignment in which the repair leaves somebody out."""
    by_map = rows_by_map(rows, LeftOutRow)
    maps = tuple(
        LeftOut(number, len(each), sum(row.before > 0 for row in each), sum(bool(row.left) for row in each))
        for number, each in by_map.items()
    )
    lines = tuple(
        f"map {row.map}, assignment {row.assignment}: {', '.join(map(str, row.left))}"
        for each in by_map.values()
        for row in each
        if row.left
    )
    title = "Assignments with a robot left out by the planner, and after the repair"
    cells: Mapping[str, Callable[[LeftOut], object]] = {
        "map": lambda each: each.map,
        "assignments": lambda each: each.assignments,
        "planner": lambda each: each.before,
        "repaired": lambda each: each.after,
    }
    table = table_of("left-out", title, maps, cells)
    return ExperimentReport(maps, (table,), lines=lines, holds=not lines)
