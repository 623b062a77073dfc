"""Where the neighbourhood planner helps: by density, kind of instance and M, and against polish for the same time.

Every robot waits in a dock beside its start until its plan lets it out, so that every planner plans all robots and no
mean leaves out an assignment. Times are processor times of one process that runs the planners in turn, and only their
ratios are used.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean
from time import thread_time_ns
from typing import TypeAlias

import msgspec

from carp_experiments.beyond.streams import docked
from carp_experiments.paper.map_cases import MAP_AXIS, MapCase, rows_by_map
from carp_experiments.report import ExperimentReport, Figure, Table, lines_of, table_by_map
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import MEASURED, Row
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_optimized.polishing import play, to_polish
from carp_spec import Group, Instance, Neighbourhood
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

Point: TypeAlias = tuple[int, int]
"""A total, and the nanoseconds that it took."""
CARP, POLISH, PLAIN = "CARP", "polish", "plain"
KINDS: Mapping[str, str] = {
    PLAIN: "the paper's cells and robots",
    "durations": "a cell takes 1 to 3 ticks",
    "capacities": "a cell has room for 1 or 2",
    "paces": "a robot takes 1 or 2 times as long",
    "groups": "two robots in each block of 2 x 2 cells",
    "stops": "each robot picks something up on its way, which takes 3 ticks",
}
SIDE, BLOCK, ROOM, SERVICE = 20, 2, 2, 3
SAMPLE = 150
USUAL = 4
SIZES = (2, 3, 4, 5, 6, 10)
DRAWN_FROM = 10
"""From this M on, orders are drawn, as the paper does."""
PASSES = 5
"""CARP takes so little time that it is measured over several passes."""
ROUNDS = (10, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 1500, 2000, 3000, 5000, 7000, 10_000)
ROUNDS_OF_KINDS = ROUNDS[:12]
BUDGET_MAPS = (5, 10, 20)


def neighbours_row(case: MapCase) -> Row:
    """For each kind of instance the total of CARP, of each M, and of a polish after some numbers of rounds.

    `measured` has their nanoseconds, those of a polish with the plans of CARP that it begins with.
    """
    totals, measured = {}, {}
    for kind in KINDS:
        by_method = compared(case, kind)
        totals[kind] = {name: [total for total, _ in points] for name, points in by_method.items()}
        measured[kind] = {name: [spent for _, spent in points] for name, points in by_method.items()}
    return {"totals": totals, MEASURED: measured}


def compared(case: MapCase, kind: str) -> Mapping[str, Sequence[Point]]:
    """Total and nanoseconds of each method on one kind; raises `AssertionError` if a robot stays unplanned."""
    fleet = PlannedFleet(kind_instance(case, kind))
    sizes = SIZES if kind == PLAIN else (USUAL,)
    for m in sizes:  # what is loaded once is not counted
        add_all(fleet, case, m)
    polished(fleet, case, ROUNDS[:1])
    found: dict[str, Sequence[Point]] = {}
    for m in sizes:
        started = thread_time_ns()
        add_all(fleet, case, m)
        found[named(m)] = [(total_of(fleet), thread_time_ns() - started)]
    started = thread_time_ns()
    for _ in range(PASSES):
        carp(fleet, range(case.robots))
    spent = (thread_time_ns() - started) // PASSES
    found[CARP] = [(total_of(fleet), spent)]
    curve = polished(fleet, case, ROUNDS if kind == PLAIN else ROUNDS_OF_KINDS)
    return {**found, POLISH: [(total, spent + further) for total, further in curve]}


def add_all(fleet: PlannedFleet, case: MapCase, m: int) -> None:
    """Add the robots in turn."""
    planner = Neighbourhood(m=m, sample=SAMPLE if m >= DRAWN_FROM else None, seed=case.assignment)
    fleet.clear()
    for robot in range(case.robots):
        add(fleet, robot, 0, planner)


def polished(fleet: PlannedFleet, case: MapCase, rounds: Sequence[int]) -> list[Point]:
    """The totals after these numbers of rounds from the plans of CARP, and the nanoseconds until then."""
    carp(fleet, range(case.robots))
    began = thread_time_ns()
    polishing = to_polish(fleet, case.assignment)
    curve, played = [], 0
    for wanted in rounds:
        play(fleet, polishing, wanted - played)
        played = wanted
        curve.append((total_of(fleet), thread_time_ns() - began))
    return curve


def total_of(fleet: PlannedFleet) -> int:
    """The total of a fleet that is planned whole."""
    unplanned, total = fleet.worth
    if unplanned:
        raise AssertionError(unplanned)
    return total


def kind_instance(case: MapCase, kind: str) -> Instance:
    """The robots of a case on a map of one kind, each in the dock of its start."""
    fleet, traits = Fleet(robots=case.robots, seed=case.assignment), Traits()
    match kind:
        case "durations":
            traits = Traits(duration=Range(1, 3))
        case "capacities":
            traits = Traits(capacity=Range(1, 2))
        case "paces":
            fleet = replace(fleet, pace=Range(1, 2))
        case "stops":
            fleet = replace(fleet, orders="pick-and-drop", service=Range(SERVICE, SERVICE))
    instance = docked(grid_instance(Grid(SIDE, SIDE, case.map), fleet, traits))
    return replace(instance, graph=replace(instance.graph, groups=blocks())) if kind == "groups" else instance


def blocks() -> tuple[Group, ...]:
    """The grid in blocks of 2 x 2 cells."""
    corners = [(x, y) for x in range(0, SIDE, BLOCK) for y in range(0, SIDE, BLOCK)]
    near = range(BLOCK)
    return tuple(
        Group(f"block {x},{y}", tuple(f"{x + right},{y + down}" for right in near for down in near), ROOM)
        for x, y in corners
    )


class NeighboursRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    totals: dict[str, dict[str, tuple[int, ...]]]
    measured: dict[str, dict[str, tuple[int, ...]]]


@dataclass(frozen=True, slots=True)
class Helped:
    """On one map and kind of instance, means over the assignments of what M robots planned together save.

    `saved` is per cent of CARP's total, `polished` what a polish of CARP's plans saves in the time that this M takes,
    `more` how much more that is, and `times` the ratio of that time to CARP's.
    """

    map: int
    kind: str
    m: int
    assignments: int
    saved: Interval
    polished: Interval
    more: Interval
    times: float


def neighbours_report(rows: Iterable[Row], _robots: int) -> ExperimentReport:
    """Tables by kind and by M."""
    summary = tuple(
        helped(map, kind, m, stored)
        for map, stored in rows_by_map(rows, NeighboursRow).items()
        for kind in KINDS
        for m in SIZES
        if named(m) in stored[0].totals[kind]
    )
    return ExperimentReport(summary, (kinds_table(summary), sizes_table(summary)))


def helped(map: int, kind: str, m: int, rows: Sequence[NeighboursRow]) -> Helped:
    """One kind and M on a map."""
    ours = [per_cent_saved(row, kind, row.totals[kind][named(m)][0]) for row in rows]
    theirs = [per_cent_saved(row, kind, polished_as_long(row, kind, m)) for row in rows]
    more = [their - our for our, their in zip(ours, theirs, strict=True)]
    spent = [fmean(row.measured[kind][name][0] for row in rows) for name in (named(m), CARP)]
    saved, in_its_time, further = (mean_interval(each) for each in (ours, theirs, more))
    return Helped(map, kind, m, len(rows), saved, in_its_time, further, spent[0] / spent[1])


def per_cent_saved(row: NeighboursRow, kind: str, total: int) -> float:
    """By how many per cent of CARP's total another is smaller."""
    carp = row.totals[kind][CARP][0]
    return 100 * (carp - total) / max(carp, 1)


def polished_as_long(row: NeighboursRow, kind: str, m: int) -> int:
    """The total of a polish that had the time of M: after the most rounds measured that it had time for, or none."""
    limit = row.measured[kind][named(m)][0]
    curve = zip(row.totals[kind][POLISH], row.measured[kind][POLISH], strict=True)
    within = [total for total, spent in curve if spent <= limit]
    return within[-1] if within else row.totals[kind][CARP][0]


def named(m: int) -> str:
    """The planner with this M."""
    return f"Proposed_{m} + baseline"


def kinds_table(summary: Sequence[Helped]) -> Table:
    """Of M = 4: savings of each kind on each map, and those of polish."""
    cells = {
        (f"{each.kind}: {KINDS[each.kind]}", each.map): f"{each.saved:.1f}; {each.polished:.1f}"
        for each in summary
        if each.m == USUAL
    }
    title = f"Per cent of CARP's total saved by {named(USUAL)}; by polish of CARP's plans in the same processor time"
    return table_by_map("neighbours", title, "kind", cells)


def sizes_table(summary: Sequence[Helped]) -> Table:
    """Of the plain kind: savings and time of each M on each map."""
    cells = {
        (str(each.m), each.map): f"{each.saved:.1f}; {each.polished:.1f}; {each.times:.0f}"
        for each in summary
        if each.kind == PLAIN
    }
    title = (
        "Plain instances: per cent saved by each M; by polish in the same processor time; that time over the time in "
        "which CARP plans all robots"
    )
    table = table_by_map("neighbours-sizes", title, "M", cells)
    return replace(table, numbers=table.columns)


def neighbours_figures(summary: Sequence[Helped]) -> tuple[Figure, ...]:
    """Savings by kind, polish beside them, and savings by M with polish beside them."""
    usual = [each for each in summary if each.m == USUAL]
    saved = lines_of(usual, lambda each: each.kind, lambda each: (each.map, each.saved))
    more = lines_of(usual, lambda each: each.kind, lambda each: (each.map, each.more))
    plain = [each for each in summary if each.kind == PLAIN and each.map in BUDGET_MAPS]
    by_size = {
        **lines_of(plain, lambda each: f"map {each.map}", lambda each: (each.m, each.saved)),
        **lines_of(plain, lambda each: f"map {each.map} + polish", lambda each: (each.m, each.polished)),
    }
    by_size = {name: by_size[name] for name in sorted(by_size, key=lambda name: (int(name.split()[1]), name))}
    per_cent = "per cent of CARP's total"
    return (
        Figure("neighbours-kinds", "Saved by four robots planned together", (MAP_AXIS, per_cent), saved),
        Figure("neighbours-polish", "Saved by polish beyond M = 4, in as much time", (MAP_AXIS, per_cent), more),
        Figure("neighbours-sizes", "Saved by M robots together, and by polish in their time", ("M", per_cent), by_size),
    )
