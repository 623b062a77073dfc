"""The methods that the paper compares by citation: fixed paths, as in ter Mors' comparison, and greedy best-first.

With 100 robots, fixed paths nearly always leave some without a plan. So totals are compared over the first robots, up
to the first that one of the two methods leaves unplanned. As each robot is planned after those before it, these plans
are those of an instance with these robots alone.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile

import msgspec

from carp_experiments.paper.map_cases import MAP_AXIS, MapCase, instance_of, rows_by_map, shown_maps
from carp_experiments.paper.quality import plan_first
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_by_map
from carp_experiments.statistics import Interval, mean_interval, proportion_interval
from carp_experiments.store import Row
from carp_optimized.fixed_paths import PathMoves, paths_of
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp, greedy
from carp_spec import FixedPaths, Instance, LongestFirst, Plan, plan_cost

FIXED: Mapping[str, FixedPaths] = {
    "the shortest path": FixedPaths(1),
    "3 shortest paths": FixedPaths(3),
    "10 shortest paths": FixedPaths(10),
    "3 disjoint paths": FixedPaths(3, "disjoint"),
}
CHOSEN = ("10 shortest paths", "3 disjoint paths")
"""The widest choices of each kind: fewer shortest paths are the first of more."""
ONE_BY_ONE = (*FIXED, "CARP")
ORDERED = ("LF", "greedy")
METHODS = (*ONE_BY_ONE, *ORDERED)


def related_row(case: MapCase) -> Row:
    """For each method the cost of each robot's plan, or `None` for a robot without one.

    Robots are planned in the order given, but by LF and greedy.
    """
    fleet = PlannedFleet(instance_of(case))
    plans: dict[str, Sequence[Plan]] = {}
    everyone = range(case.robots)
    paths = {FIXED[name].paths: [paths_of(fleet, robot, FIXED[name]) for robot in everyone] for name in CHOSEN}
    moves = PathMoves(fleet)
    for name, options in FIXED.items():
        fleet.clear()
        for robot, choice in zip(everyone, paths[options.paths], strict=True):
            moves.add(robot, choice[: options.k])
        plans[name] = fleet.plans
    carp(fleet, everyone)
    plans["CARP"] = fleet.plans
    plan_first(fleet, LongestFirst(), case.robots)
    plans["LF"] = fleet.plans
    greedy(fleet, lambda: None)
    plans["greedy"] = fleet.plans
    return {"costs": {name: costs_of(fleet.instance, found) for name, found in plans.items()}}


def costs_of(instance: Instance, plans: Sequence[Plan]) -> list[int | None]:
    """The cost of the plan of each robot, in the order of the instance."""
    cost = {plan.robot: plan_cost(instance, plan) for plan in plans}
    return [cost.get(robot.id) for robot in instance.robots]


@dataclass(frozen=True, slots=True)
class Related:
    """A method on one map.

    `unplanned` is the mean number of robots without a plan, `more_unplanned` its excess over that of CARP, and
    `failure_rate` the share of assignments with such a robot. `above_carp` is the excess of its total over CARP's for
    the same robots (`same_robots`) in per cent, over the `compared` assignments that have some.
    """

    map: int
    method: str
    assignments: int
    unplanned: Interval
    more_unplanned: Interval
    failure_rate: Interval
    compared: int
    above_carp: Interval | None


class RelatedRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    costs: dict[str, list[int | None]]


def related_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """Tables over some of the maps."""
    by_map = rows_by_map(rows, RelatedRow)
    summary = tuple(related_of(map, name, each) for map, each in by_map.items() for name in METHODS)
    shown = [each for each in summary if each.map in shown_maps(by_map)]
    unplanned = table_by_map(
        "related-unplanned",
        f"Robots of {robots} without a plan, means with 95 % intervals",
        "method",
        {(each.method, each.map): f"{each.unplanned:.1f}" for each in shown},
    )
    totals = table_by_map(
        "related-totals",
        "Total above CARP's for the same robots in per cent: for fixed paths, of the first robots up to the one that "
        "either leaves without a plan; for LF and greedy, of all, in the assignments in which both plan all",
        "method",
        {(each.method, each.map): _compared(each) for each in shown if each.method != "CARP"},
    )
    return ExperimentReport(summary, (unplanned, totals))


def related_figures(summary: Sequence[Related]) -> tuple[Figure, ...]:
    """The robots that fixed paths and CARP leave without a plan, and how many more the other orders leave than CARP."""
    fixed = [each for each in summary if each.method in ONE_BY_ONE]
    others = [each for each in summary if each.method in ORDERED]
    unplanned = lines_of(fixed, lambda each: each.method, lambda each: (each.map, each.unplanned))
    more = lines_of(others, lambda each: each.method, lambda each: (each.map, each.more_unplanned))
    axes = (MAP_AXIS, "robots")
    return (
        Figure("related", "Robots without a plan", axes, unplanned),
        Figure("related-orders", "Robots without a plan, more than with CARP", axes, more),
    )


def related_of(map: int, name: str, rows: Sequence[RelatedRow]) -> Related:
    """A method on a map."""
    missing = [row.costs[name].count(None) for row in rows]
    above = [
        100 * (sum(ours) - sum(carps)) / sum(carps)
        for row in rows
        for ours, carps in [same_robots(row.costs[name], row.costs["CARP"], name in ONE_BY_ONE)]
        if sum(carps)
    ]
    rate = proportion_interval(sum(count > 0 for count in missing), len(rows))
    interval = mean_interval(above) if above else None
    more = mean_interval([count - row.costs["CARP"].count(None) for count, row in zip(missing, rows, strict=True)])
    return Related(map, name, len(rows), mean_interval(missing), more, rate, len(above), interval)


def same_robots(
    ours: Sequence[int | None], theirs: Sequence[int | None], one_by_one: bool
) -> tuple[list[int], list[int]]:
    """The costs of both for the first robots, up to one without a plan; of all or of none if not `one_by_one`."""
    both = list(takewhile(lambda pair: None not in pair, zip(ours, theirs, strict=True)))
    if not one_by_one and len(both) < len(ours):
        return [], []
    return [our for our, _ in both if our is not None], [their for _, their in both if their is not None]


def _compared(related: Related) -> str:
    if related.above_carp is None:
        return "-"
    of = "" if related.compared == related.assignments else f" ({related.compared} of {related.assignments})"
    return f"{related.above_carp:.1f}{of}"
