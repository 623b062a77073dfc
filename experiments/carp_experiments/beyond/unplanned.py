"""Robots that polish leaves unplanned on sparse maps, and whether they could be planned.

If some robot stays without a plan after all rounds, robots are removed as long as the others still cannot all be
planned. For the few that are left, every order is tried and the optimum is searched for. Either the search finds that
they, and so all robots, can have no plans together; or their plans are kept and the other robots are planned around
them.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from math import factorial
from statistics import fmean

import msgspec

from carp_experiments.paper.map_cases import MapCase, instance_of, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row
from carp_spec import Carp, Instance, Plan, RobotId, Solution, judge, total_cost
from carp_spec.permutations import shuffle, splitmix64

GIVEN = "Proposed_4"
ROUNDS = (2_000, 20_000, 60_000)
PART = 2_000  # rounds between two looks at whether a robot is still unplanned
ROUNDS_OF_A_GROUP = 1_000
MOST_ORDERED = 6
LIMIT_IN_SECONDS = 60
ATTEMPTS = 5


def unplanned_row(case: MapCase) -> Row:
    """The robots unplanned before, the rounds after which none is, and the groups of those that stay unplanned.

    Only a search for a group's optimum that takes nearly a minute can end differently on another machine.
    """
    import carp_optimized as engine  # noqa: PLC0415 - each worker loads it

    instance = instance_of(case)
    solution = engine.plan(instance, seeded(ALGORITHMS[GIVEN], case.assignment))
    better, rounds = repaired(instance, solution, ROUNDS[-1], case.assignment)
    row = {"before": len(solution.unplanned), "rounds": rounds}
    if not better.unplanned:
        return {**row, "left": [], "groups": [], "whole": total_cost(instance, better.plans)}
    groups = [group_facts(instance, group) for group in blocking_groups(instance, case.assignment)]
    whole = planned_around(instance, [robot for group in groups for robot in group.robots], case.assignment)
    return {
        **row,
        "left": better.unplanned,
        "groups": [msgspec.to_builtins(group) for group in groups],
        "whole": None if whole is None else total_cost(instance, whole.plans),
    }


class Group(msgspec.Struct, frozen=True):
    """Robots that block each other: some stay unplanned even without the others, and none can be left out.

    In `failing` of `orders` orders CARP leaves one of them unplanned; of more than `MOST_ORDERED` robots no order is
    tried. `cost` is the least total, `None` if none exists or it was not found; `proved`: the search ended.
    """

    robots: tuple[RobotId, ...]
    orders: int
    failing: int
    shortest: int
    cost: int | None
    proved: bool


def repaired(instance: Instance, solution: Solution, rounds: int, seed: int) -> tuple[Solution, int]:
    """Polish until every robot has a plan, for this many rounds at most; the solution and the rounds played."""
    import carp_optimized as engine  # noqa: PLC0415

    played = 0
    while solution.unplanned and played < rounds:
        part = min(PART, rounds - played)
        solution = engine.polish(instance, solution, iterations=part, seed=(seed << 16) + played)
        played += part
    return solution, played


def part_of(instance: Instance, robots: Sequence[RobotId]) -> Instance:
    """The instance with these of its robots alone, in this order."""
    return replace(instance, robots=tuple(instance.robot[robot] for robot in robots))


def is_stuck(instance: Instance, robots: Sequence[RobotId], rounds: int, seed: int) -> bool:
    """Whether some robot of these stays without a plan."""
    import carp_optimized as engine  # noqa: PLC0415

    alone = part_of(instance, robots)
    return bool(repaired(alone, engine.plan(alone, Carp()), rounds, seed)[0].unplanned)


def blocking_groups(instance: Instance, seed: int) -> Iterator[tuple[RobotId, ...]]:
    """Groups without a common robot, until the robots in none can all be planned."""
    rest = [*instance.robot]
    rounds = ROUNDS[-1]
    while is_stuck(instance, rest, rounds, seed):
        group = blocking_group(instance, rest, seed)
        yield group
        rest = [robot for robot in rest if robot not in group]
        rounds = ROUNDS[1]


def blocking_group(instance: Instance, robots: Sequence[RobotId], seed: int) -> tuple[RobotId, ...]:
    """Take robots away, first half of them at a time and in the end single ones, while the others stay stuck."""
    group = [*robots]
    size = len(group) // 2
    while size:
        for first in range(0, len(group), size):
            others = group[:first] + group[first + size :]
            if others and is_stuck(instance, others, ROUNDS_OF_A_GROUP, seed):
                group = others
                break
        else:
            size //= 2
    return tuple(group)


def group_facts(instance: Instance, robots: tuple[RobotId, ...]) -> Group:
    """The known facts about a group."""
    import carp_optimized as engine  # noqa: PLC0415
    from carp_optimum.optimum import optimum  # noqa: PLC0415

    orders = list(permutations(robots)) if len(robots) <= MOST_ORDERED else []
    failing = sum(bool(engine.plan(part_of(instance, order), Carp()).unplanned) for order in orders)
    best = optimum(part_of(instance, robots), LIMIT_IN_SECONDS)
    return Group(robots, len(orders), failing, best.shortest or 0, best.cost, best.decided)


def planned_around(instance: Instance, robots: Sequence[RobotId], seed: int) -> Solution | None:
    """Plans of all robots, found around the best plans of some of them; `None` if none were found."""
    from carp_optimum.optimum import optimum  # noqa: PLC0415

    best = optimum(part_of(instance, robots), LIMIT_IN_SECONDS).solution
    if best is None:
        return None
    others = [robot for robot in instance.robot if robot not in robots]
    stream = splitmix64(seed)
    for attempt in range(ATTEMPTS):
        others = others if attempt == 0 else [*shuffle(others, stream)]
        whole, _ = repaired(instance, one_by_one(instance, best.plans, others), ROUNDS[1], seed)
        if not whole.unplanned and judge(instance, whole).valid:
            return whole
    return None


def one_by_one(instance: Instance, plans: Sequence[Plan], robots: Sequence[RobotId]) -> Solution:
    """The plans, and the robots planned around them in this order."""
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415

    fleet = PlannedFleet(instance)
    fleet.commit(plans)
    for robot in robots:
        plan = fleet.find(fleet.index(robot), None, 0)
        if plan is not None:
            fleet.commit([plan])
    return Solution.of(instance, fleet.plans)


class UnplannedRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    before: int
    rounds: int
    left: tuple[RobotId, ...]
    groups: tuple[Group, ...]
    whole: int | None

    def fails_after(self, rounds: int) -> bool:
        """Whether some robot is still unplanned after this many rounds."""
        return bool(self.left) or self.rounds > rounds

    @property
    def is_unsolvable(self) -> bool:
        """Whether the search found that not all robots can have plans."""
        return any(group.proved and group.cost is None for group in self.groups)


@dataclass(frozen=True, slots=True)
class Unplanned:
    """The results of the assignments on one map.

    `before` are those with an unplanned robot before polish, `unplanned` the mean number of these robots; `after` those
    with one after this many rounds. Of the last, `unordered` are those in which a group of robots can be planned in no
    order, `unsolvable` those in which the search found that they cannot be planned at all, and `planned` those for
    which plans of all robots were found around the optimum of the group.
    """

    map: int
    assignments: int
    before: int
    unplanned: float
    after: tuple[int, ...]
    unordered: int
    unsolvable: int
    planned: int


@dataclass(frozen=True, slots=True)
class UnplannedSummary:
    """All numbers of the experiment."""

    maps: tuple[Unplanned, ...]
    stuck: tuple[UnplannedRow, ...]


def unplanned_report(rows: Iterable[Row]) -> ExperimentReport:
    """A table of the maps, and one of the groups."""
    by_map = rows_by_map(rows, UnplannedRow)
    maps = tuple(unplanned_on(map, each) for map, each in by_map.items())
    stuck = tuple(row for each in by_map.values() for row in each if row.left)
    tables = (maps_table(maps), groups_table(stuck)) if stuck else (maps_table(maps),)
    return ExperimentReport(UnplannedSummary(maps, stuck), tables)


def unplanned_on(map: int, rows: Sequence[UnplannedRow]) -> Unplanned:
    """The results of the assignments on a map."""
    stuck = [row for row in rows if row.left]
    return Unplanned(
        map,
        len(rows),
        sum(row.before > 0 for row in rows),
        fmean(row.before for row in rows),
        tuple(sum(row.fails_after(rounds) for row in rows) for rounds in ROUNDS),
        sum(any(group.orders and group.failing == group.orders for group in row.groups) for row in stuck),
        sum(row.is_unsolvable for row in stuck),
        sum(row.whole is not None for row in stuck),
    )


def maps_table(maps: Sequence[Unplanned]) -> Table:
    """Assignments with an unplanned robot, and what is known of those that stay so."""
    after = tuple(f"{rounds:,} rounds" for rounds in ROUNDS)
    columns = ("map", GIVEN, *after, "no order works", "found unsolvable", "planned all the same")
    rows = [
        (
            str(each.map),
            f"{each.before}/{each.assignments} ({each.unplanned:.2f})",
            *(f"{failing}/{each.assignments}" for failing in each.after),
            *(f"{count}/{each.after[-1]}" for count in (each.unordered, each.unsolvable, each.planned)),
        )
        for each in maps
    ]
    title = (
        f"Assignments with an unplanned robot, after {GIVEN} (and the mean number of such robots) and after rounds "
        "of polish; of the last, in how many a few robots by themselves can be planned in no order one after "
        "the other, in how many the search found that they cannot be planned at all, and for how many plans of all "
        "robots were found around the optimum of these few"
    )
    return Table("unplanned", title, columns, tuple(rows), columns)


def groups_table(stuck: Sequence[UnplannedRow]) -> Table:
    """The groups of robots that block each other."""
    columns = ("map", "assignment", "left", "robots", "orders that fail", "shortest", "optimum", "total of all")
    rows = [
        (
            str(row.map),
            str(row.assignment),
            " ".join(map(str, row.left)),
            " ".join(map(str, group.robots)),
            f"{group.failing}/{group.orders}" if group.orders else f"of {factorial(len(group.robots)):,} none tried",
            str(group.shortest),
            cost_of(group),
            "-" if row.whole is None else str(row.whole),
        )
        for row in stuck
        for group in row.groups
    ]
    title = (
        "Robots that stay unplanned after the last round; the robots that block each other, and none can be left "
        "out; in how many of their orders CARP plans not all of them; the sum of their shortest paths, the "
        "optimum, and the total of plans of all robots found around it"
    )
    return Table("unplanned-groups", title, columns, tuple(rows), columns[:2] + columns[4:])


def cost_of(group: Group) -> str:
    """The optimum of a group, in words."""
    if group.cost is None:
        return "none exists" if group.proved else "not found"
    return f"{group.cost}" if group.proved else f"at most {group.cost}"
