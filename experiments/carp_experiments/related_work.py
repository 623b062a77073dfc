"""The methods that the paper compares by citation: fixed paths, as in ter Mors' comparison, and greedy best-first."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import msgspec

from carp_experiments.campaign import key_on_map
from carp_experiments.quality import ROBOTS, grid_fleet, outcome
from carp_experiments.quality_report import MAP_AXIS, SHOWN_MAPS
from carp_experiments.report import Figure, Report, Table
from carp_experiments.statistics import Interval, mean_interval, proportion_interval
from carp_experiments.store import Row
from carp_spec import Instance, Plan, ResourceId, Robot, plan_cost, total_cost

Path = tuple[ResourceId, ...]
MOST_SHORTEST = 10
MOST_DISJOINT = 3
FIXED: Mapping[str, tuple[str, int]] = {
    "the shortest path": ("shortest", 1),
    "3 shortest paths": ("shortest", 3),
    "10 shortest paths": ("shortest", MOST_SHORTEST),
    "3 disjoint paths": ("disjoint", MOST_DISJOINT),
}
METHODS = (*FIXED, "CARP", "greedy")


@dataclass(frozen=True, slots=True)
class RelatedCase:
    """One assignment on one map, by every method; robots are planned in the order given, greedy chooses its own."""

    map: int
    assignment: int
    robots: int = ROBOTS

    @property
    def key(self) -> str:
        """Assignments and maps in their order."""
        return key_on_map(self.map, self.assignment)

    def run(self) -> Row:
        """For each method the robots planned and the total cost; beside them the cost of each planned robot alone."""
        fleet = grid_fleet(self.map, 0, self.robots, self.assignment)
        results = fixed_results(fleet.instance)
        fleet.carp(range(self.robots))
        results["CARP"] = outcome(fleet)
        fleet.greedy(lambda: None)
        results["greedy"] = outcome(fleet)
        shortest = sum(fleet.ticks_to_goal(robot) for robot in range(self.robots))
        return {"map": self.map, "assignment": self.assignment, "shortest": shortest, "results": results}


def fixed_results(instance: Instance) -> dict[str, tuple[int, int]]:
    """What each kind of fixed paths reaches; the k shortest paths are the first k of the most."""
    from carp_reference.fixed_paths import disjoint_paths, shortest_paths  # noqa: PLC0415 - each worker loads it
    from carp_reference.problem import prepare  # noqa: PLC0415

    problem = prepare(instance, 0)
    paths: dict[str, list[list[Path]]] = {
        "shortest": [shortest_paths(problem, robot, MOST_SHORTEST) for robot in instance.robots],
        "disjoint": [disjoint_paths(problem, robot, MOST_DISJOINT) for robot in instance.robots],
    }
    return {name: schedule(instance, [of_robot[:k] for of_robot in paths[kind]]) for name, (kind, k) in FIXED.items()}


def schedule(instance: Instance, paths: Sequence[Sequence[Path]]) -> tuple[int, int]:
    """Plan each robot on the path on which it arrives first; how many get a plan, and the total cost."""
    from carp_reference.fixed_paths import find_on_path  # noqa: PLC0415
    from carp_reference.problem import prepare  # noqa: PLC0415

    problem = prepare(instance, 0)
    plans: list[Plan] = []

    def on_path(robot: Robot) -> Callable[[Path], Plan | None]:
        return lambda path: find_on_path(problem, plans, robot, path)

    for robot, of_robot in zip(instance.robots, paths, strict=True):
        found = [plan for plan in map(on_path(robot), of_robot) if plan is not None]
        if found:
            plans.append(min(found, key=lambda plan: plan_cost(instance, plan)))
    return len(plans), total_cost(instance, plans)


@dataclass(frozen=True, slots=True)
class Related:
    """A method on one map.

    `unplanned` is the mean number of robots without a plan, `failure_rate` the share of assignments with such a robot,
    `above` the total above the sum of shortest paths in per cent, over the assignments without one.
    """

    map: int
    method: str
    assignments: int
    unplanned: Interval
    failure_rate: Interval
    above: Interval | None


class RelatedRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    shortest: int
    results: dict[str, tuple[int, int]]


def related_report(rows: Iterable[Row], robots: int) -> Report:
    """Tables over some of the maps, a figure over all."""
    by_map: dict[int, list[RelatedRow]] = defaultdict(list)
    for row in rows:
        measured = msgspec.convert(row, RelatedRow)
        by_map[measured.map].append(measured)
    summary = tuple(related_of(map, name, each, robots) for map, each in sorted(by_map.items()) for name in METHODS)
    maps = [map for map in SHOWN_MAPS if map in by_map] or sorted(by_map)
    by_place = {(each.method, each.map): each for each in summary}
    columns = ("method", *(f"map {map}" for map in maps))
    unplanned = [(name, *(_plain(by_place[name, map].unplanned) for map in maps)) for name in METHODS]
    above = [(name, *(_plain(by_place[name, map].above) for map in maps)) for name in METHODS]
    tables = (
        Table(
            "related-unplanned",
            f"Robots of {robots} without a plan, means with 95 % intervals",
            columns,
            tuple(unplanned),
            columns[1:],
        ),
        Table(
            "related-totals",
            "Total above the sum of shortest paths in per cent, over the assignments without such a robot",
            columns,
            tuple(above),
            columns[1:],
        ),
    )
    lines = {name: [(each.map, each.unplanned) for each in summary if each.method == name] for name in METHODS}
    figure = Figure("related", "Robots without a plan", (MAP_AXIS, f"robots of {robots}"), lines)
    return Report(summary, tables, (figure,))


def related_of(map: int, name: str, rows: Sequence[RelatedRow], robots: int) -> Related:
    """A method on a map."""
    reached = [(*row.results[name], row.shortest) for row in rows]
    missing = [robots - planned for planned, _, _ in reached]
    above = [100 * (total - alone) / alone for planned, total, alone in reached if planned == robots and alone]
    rate = proportion_interval(sum(count > 0 for count in missing), len(rows))
    return Related(map, name, len(rows), mean_interval(missing), rate, mean_interval(above) if above else None)


def _plain(interval: Interval | None) -> str:
    return "-" if interval is None else f"{interval.estimate:.1f} ± {interval.high - interval.estimate:.1f}"
