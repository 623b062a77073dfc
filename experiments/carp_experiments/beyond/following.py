"""The price of plans that can be executed in order: following forbidden, or allowed and rotations removed."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import msgspec

import carp_optimized as engine
from carp_experiments.beyond.delayed import PLANNERS
from carp_experiments.paper.map_cases import MAP_AXIS, WAREHOUSE, MapCase, instance_of, place_name, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Figure, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_spec import total_cost
from carproof.execution.untangling import untangle


class Priced(msgspec.Struct, frozen=True):
    """Robots without a plan, and the total of the robots with one both ways, with following allowed and forbidden.

    To remove the `rotations` of the former, with all its robots of cost `whole`, takes `extra` ticks; `left` is whether
    one could not be removed.
    """

    unplanned: tuple[int, int]
    totals: tuple[int, int]
    whole: int
    rotations: int
    extra: int
    left: bool


class FollowingRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    planners: dict[str, Priced]


def following_row(case: MapCase) -> Row:
    """Both prices, for the solution of each planner."""
    allowed = instance_of(case)
    forbidden = replace(allowed, following="forbidden")
    found = {}
    for name in PLANNERS:
        planner = seeded(ALGORITHMS[name], case.assignment)
        given, other = engine.plan(allowed, planner), engine.plan(forbidden, planner)
        both = {plan.robot for plan in given.plans} & {plan.robot for plan in other.plans}
        totals = [total_cost(allowed, [plan for plan in each.plans if plan.robot in both]) for each in (given, other)]
        untangled = untangle(allowed, given, engine)
        found[name] = Priced(
            (len(given.unplanned), len(other.unplanned)),
            (totals[0], totals[1]),
            total_cost(allowed, given.plans),
            untangled.rounds,
            untangled.extra,
            bool(untangled.rotation),
        )
    return {"planners": found}


@dataclass(frozen=True, slots=True)
class FollowingOf:
    """A planner on one map.

    `unplanned` robots are means with following allowed and forbidden. `forbidden` is the excess of the total of the
    robots with plans both ways, in per cent. `tangled` assignments had a rotation, and some stayed in `left`;
    `rotations` and the `extra` cost in per cent are means over all.
    """

    map: int
    planner: str
    assignments: int
    unplanned: tuple[Interval, Interval]
    forbidden: Interval
    tangled: int
    left: int
    rotations: Interval
    extra: Interval


def following_report(rows: Iterable[Row], _robots: int) -> ExperimentReport:
    """A table of all maps."""
    summary = tuple(
        FollowingOf(
            map,
            name,
            len(found),
            (
                mean_interval([each.unplanned[0] for each in found]),
                mean_interval([each.unplanned[1] for each in found]),
            ),
            mean_interval([100 * (each.totals[1] / (each.totals[0] or 1) - 1) for each in found]),
            sum(each.rotations > 0 or each.left for each in found),
            sum(each.left for each in found),
            mean_interval([each.rotations for each in found]),
            mean_interval([100 * each.extra / (each.whole or 1) for each in found]),
        )
        for map, stored in rows_by_map(rows, FollowingRow).items()
        for name in PLANNERS
        if (found := [row.planners[name] for row in stored])
    )
    title = (
        "Means with 95 % intervals: robots without a plan with following allowed and forbidden; the excess of the "
        "total where it is forbidden, over the robots that have plans both ways; assignments with a rotation, "
        "and those in which one stays; rotations removed, and the excess of the total by this"
    )
    cells: Mapping[str, Callable[[FollowingOf], object]] = {
        "place": lambda each: place_name(each.map),
        "planner": lambda each: each.planner,
        "unplanned, allowed": lambda each: f"{each.unplanned[0]:.1f}",
        "unplanned, forbidden": lambda each: f"{each.unplanned[1]:.1f}",
        "forbidden, %": lambda each: f"{each.forbidden:.2f}",
        "tangled": lambda each: f"{each.tangled}/{each.assignments}",
        "left": lambda each: each.left,
        "rotations": lambda each: f"{each.rotations:.1f}",
        "removed, %": lambda each: f"{each.extra:.3f}",
    }
    return ExperimentReport(summary, (table_of("following", title, summary, cells, names=2),))


def following_figures(summary: Sequence[FollowingOf]) -> tuple[Figure, ...]:
    """Both prices on the grids, by the map."""
    lines: dict[str, list[tuple[int, Interval]]] = {}
    for each in summary:
        if each.map == WAREHOUSE:
            continue
        lines.setdefault(f"{each.planner} + forbidden", []).append((each.map, each.forbidden))
        lines.setdefault(f"{each.planner} + removed", []).append((each.map, each.extra))
    axes = (MAP_AXIS, "total cost more, per cent")
    return (Figure("following", "The price of plans without rotations", axes, lines),) if lines else ()
