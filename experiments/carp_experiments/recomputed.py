"""Random cases of a stored run computed again with the reference planner, one algorithm at a time.

The quick algorithms come first. The reference takes a minute for CARP100 and for four neighbours with 100 robots, so it
plans few cases of these, and none of larger neighbourhoods. Of `polish` it adds the last robots to the plans that the
compiled planner finds for the others. Of `reuse` its calls are counted: it has the paper's two reductions. What has no
reference is left out: bounds, optima, times, long polishes and the planner of `conventions`.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias, cast
from unittest.mock import patch

import carp_optimized
import carp_reference
import carp_reference.neighbourhood
from carp_experiments.beyond.neighbours import CARP, KINDS, PLAIN, POLISH, ROUNDS, kind_instance, named
from carp_experiments.paper.conventions import LONGEST_FIRST, Convention, longest_first, one_pass, world_of
from carp_experiments.paper.map_cases import MapCase, instance_of, map_instance
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.paper.related_work import FIXED, costs_of
from carp_experiments.paper.small_gaps import COMPARED, small_instance
from carp_experiments.paper.space_time import World
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row
from carp_reference.query import find_plan
from carp_spec import Carp, Greedy, Instance, LongestFirst, Neighbourhood, Plan, Planner, Solution, Visit, total_cost
from carp_spec.permutations import shuffle, splitmix64
from carproof.generate import Fleet

Found: TypeAlias = Sequence[int | None]
POLISHED = f": {CARP}, and {ROUNDS[0]} rounds of polish"
PAIRS = f"{PLAIN}: {named(2)}"
ADDED = "Proposed_"
LAST = 5
ADDED_LAST = f"{ADDED}4: the last {LAST} robots"
LAWFUL = {each.name: each for each in (Convention(), Convention(goals_repeated=True))}
"""Conventions of `nearest` that the law has, on maps of the generator."""
FEW = 2
RELATED: Mapping[str, Planner] = {**FIXED, "CARP": Carp(), "LF": LongestFirst(), "greedy": Greedy()}
AGAIN: Mapping[str, Sequence[str]] = {
    "gap": (
        *("CARP", "LF", "greedy", "CARP10", "Proposed_4", "Proposed_4 + baseline", "Proposed_5", "CARP100"),
        *("Proposed_6", "Proposed_10", "Proposed_6 + baseline", "Proposed_10 + baseline"),
    ),
    "related": tuple(RELATED),
    "quality": ("CARP", "LF", "CARP10"),
    "time": ("CARP", "LF", "CARP10"),
    "polish": (ADDED_LAST,),
    "reuse": (f"{ADDED}3", f"{ADDED}4"),
    "neighbours": tuple(f"{kind}{POLISHED}" for kind in KINDS),
    "nearest": tuple(f"{name}: {each}" for name in LAWFUL for each in (CARP, LONGEST_FIRST)),
}
"""By experiment: the algorithms that are computed again in each case drawn."""
AGAIN_IN_FEW: Mapping[str, Sequence[str]] = {
    "gap": (),
    "related": (),
    "quality": ("CARP100", "Proposed_4", "Proposed_4 + baseline"),
    "time": ("CARP100", "Proposed_4"),
    "polish": ("Proposed_4",),
    "reuse": (f"{ADDED}5", f"{ADDED}6"),
    "neighbours": (PAIRS,),
    "nearest": (),
}
"""The slow ones, which are computed again in few of the cases."""


@dataclass(frozen=True, slots=True)
class Again:
    """A case of a stored run, an algorithm, and what the run found."""

    experiment: str
    case: MapCase
    algorithm: str
    place: int
    stored: Found

    @property
    def key(self) -> str:
        """The algorithms in their order, so that a run that is stopped has the quick ones."""
        return f"{self.place:02} {self.algorithm} {self.case.key}"

    def run(self) -> Row:
        """Whether the reference finds the same."""
        found = again(self.experiment, self.case, self.algorithm, self.stored)
        return {"algorithm": self.algorithm, "case": self.case.key, "equal": [*found] == [*self.stored]}


def again(experiment: str, case: MapCase, algorithm: str, stored: Found) -> Found:
    """What the reference finds, as `results_of` has it."""
    if experiment == "related":
        instance = instance_of(case)
        return costs_of(instance, carp_reference.plan(instance, RELATED[algorithm]).plans)
    if experiment == "reuse":
        return [queries_asked(case, int(algorithm.removeprefix(ADDED)))]
    if experiment == "neighbours":
        return neighbours_again(case, algorithm)
    if experiment == "nearest":
        return nearest_again(case, algorithm)
    if algorithm == ADDED_LAST:
        return added_last(case)
    instance = small_instance(case) if experiment == "gap" else instance_of(case)
    planner = seeded(COMPARED[algorithm] if experiment == "gap" else ALGORITHMS[algorithm], case.assignment)
    if isinstance(planner, Neighbourhood) and experiment not in {"polish", "time"}:
        instance = first_robots(instance, cast("int", stored[0]) + 1)  # the run stopped at the first without a plan
    plans = carp_reference.plan(instance, planner).plans
    return [len(plans)] if experiment == "time" else [len(plans), total_cost(instance, plans)]


def queries_asked(case: MapCase, m: int) -> int:
    """The queries that the reference asks to add the last robot to the plans of CARP for the others."""
    instance = instance_of(case)
    *others, last = instance.robots
    committed = carp_reference.plan(first_robots(instance, len(others)), Carp())
    solution = Solution.of(instance, committed.plans)
    adding = Neighbourhood(m, None, case.assignment, baseline=False)
    with patch.object(carp_reference.neighbourhood, "find_plan", wraps=find_plan) as asked:
        carp_reference.add(instance, solution, last.id, 0, adding)
    return asked.call_count


def added_last(case: MapCase) -> Found:
    """The robots planned and their total, the reference adding the last ones to the compiled plans of the others."""
    instance = instance_of(case)
    planner = cast("Neighbourhood", seeded(ALGORITHMS[f"{ADDED}4"], case.assignment))
    first = first_robots(instance, max(len(instance.robots) - LAST, 0))
    solution = Solution.of(instance, carp_optimized.plan(first, planner).plans)
    for robot in instance.robots[len(first.robots) :]:
        solution = carp_reference.add(instance, solution, robot.id, 0, planner)
    return [len(solution.plans), total_cost(instance, solution.plans)]


def neighbours_again(case: MapCase, algorithm: str) -> Found:
    """The totals of CARP and of a short polish of its plans on one kind of instance, or of pairs planned together."""
    instance = kind_instance(case, algorithm.partition(":")[0])
    if algorithm == PAIRS:
        return [total_cost(instance, carp_reference.plan(instance, Neighbourhood(m=2, seed=case.assignment)).plans)]
    solution = carp_reference.plan(instance, Carp())
    polished = carp_reference.polish(instance, solution, iterations=ROUNDS[0], seed=case.assignment)
    return [total_cost(instance, solution.plans), total_cost(instance, polished.plans)]


def nearest_again(case: MapCase, algorithm: str) -> Found:
    """The pass of CARP repeated, up to the first robot of which the reference says another arrival, or none.

    Ties are broken in another way than by the reference, so this takes over the plans of the robots before.
    """
    name, _, which = algorithm.partition(": ")
    instance, world = law_of(case, LAWFUL[name]), world_of(case, LAWFUL[name])
    order = range(case.robots) if which == CARP else longest_first(world)
    planned, cost = one_pass(world, order)
    plans = plans_of(world, instance, order[:planned])
    for number, robot in enumerate(order[: planned + 1]):
        best = carp_reference.query(instance, plans[:number], instance.robots[robot].id)
        arrival = plans[number].visits[-1].enter if number < planned else None
        if (None if best is None else best.visits[-1].enter) != arrival:
            return [number, None]
    return [planned, cost]


def law_of(case: MapCase, convention: Convention) -> Instance:
    """The instance of a convention that the law has."""
    fleet = Fleet(robots=case.robots, seed=case.assignment)
    return map_instance(case.map, replace(fleet, distinct="starts") if convention.goals_repeated else fleet)


def plans_of(world: World, instance: Instance, order: Sequence[int]) -> list[Plan]:
    """The plans of the planner of `conventions` as the law reads them."""
    plans = []
    for robot in order:
        first, last = int(world.entered[robot]), int(world.arrival[robot])
        cells = [int(cell) for cell in world.path[robot, first : last + 1]]
        enters = [first, *(first + at for at in range(1, len(cells)) if cells[at] != cells[at - 1])]
        ends = [*(end for _, end in pairwise(enters)), None if instance.after_goal == "park" else enters[-1] + 1]
        ids = [instance.graph.resources[cells[enter - first]].id for enter in enters]
        visits = tuple(Visit(*each) for each in zip(ids, enters, ends, strict=True))
        plans.append(Plan(instance.robots[robot].id, visits))
    return plans


def first_robots(instance: Instance, count: int) -> Instance:
    """The instance with its first robots alone."""
    return replace(instance, robots=instance.robots[:count])


def cases_again(experiment: str, rows: Mapping[str, Row], robots: int, count: int, seed: int) -> Sequence[Again]:
    """The cases to compute again, drawn from the rows of a store by their keys."""
    drawn = shuffle(sorted(rows), splitmix64(seed))[:count]
    algorithms = [
        *((name, drawn) for name in AGAIN[experiment]),
        *((name, drawn[:FEW]) for name in AGAIN_IN_FEW[experiment]),
    ]
    return [
        Again(experiment, case_of(rows[key], robots), name, place, results_of(rows[key])[name])
        for place, (name, keys) in enumerate(algorithms)
        for key in keys
    ]


def results_of(row: Row) -> Mapping[str, Found]:
    """What a stored row has by algorithm.

    All robots' costs (`related`), robots planned (`time`), queries asked (`reuse`), totals (`neighbours`), or robots
    planned and their total.
    """
    if "asked" in row:
        asked = cast("Mapping[str, Mapping[str, int]]", row["asked"])["the paper's"]
        return {f"{ADDED}{m}": [count] for m, count in asked.items()}
    if "totals" in row:
        totals = cast("Mapping[str, Mapping[str, Sequence[int]]]", row["totals"])
        polished = {f"{kind}{POLISHED}": [each[CARP][0], each[POLISH][0]] for kind, each in totals.items()}
        return {**polished, PAIRS: totals[PLAIN][named(2)]}
    if LAWFUL.keys() <= cast("Row", row.get("results", {})).keys():
        by_name = cast("Mapping[str, Mapping[str, Found]]", row["results"])
        return {f"{name}: {each}": found for name in LAWFUL for each, found in by_name[name].items()}
    if "planned" in row:
        return {name: [count] for name, count in cast("Mapping[str, int]", row["planned"]).items()}
    found = cast("Mapping[str, Found]", row["costs"] if "costs" in row else row["results"])
    return {**found, ADDED_LAST: found[f"{ADDED}4"]} if "left" in row else found


def case_of(row: Row, robots: int) -> MapCase:
    """The case of a stored row."""
    return MapCase(no_row, cast("int", row["map"]), cast("int", row["assignment"]), robots)


def no_row(case: MapCase) -> Row:
    """Nothing: the case names a map and an assignment alone."""
    return {"case": case.key}


def again_report(rows: Iterable[Row]) -> ExperimentReport:
    """How many cases of each algorithm are equal; it holds if all are."""
    stored = [*rows]
    names = dict.fromkeys(str(row["algorithm"]) for row in stored)
    equal = {name: [bool(row["equal"]) for row in stored if row["algorithm"] == name] for name in names}
    cells = tuple((name, str(len(each)), str(sum(each))) for name, each in equal.items())
    columns = ("algorithm", "cases", "equal")
    table = Table("recomputed", "Cases computed again with the reference planner", columns, cells, columns[1:])
    summary = {name: {"cases": len(each), "equal": sum(each)} for name, each in equal.items()}
    others = tuple(f"not equal: {row['algorithm']}, {row['case']}" for row in stored if not row["equal"])
    return ExperimentReport(summary, (table,), others, holds=not others)
