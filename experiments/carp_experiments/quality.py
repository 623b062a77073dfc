"""Experiment 1 of the paper: how often each algorithm fails, and how many actions its plans have.

100 robots on 21 maps from a spanning tree to the full grid; the same assignments on every map.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import msgspec

from carp_experiments.statistics import Interval, mean_interval, proportion_interval
from carp_experiments.store import Row
from carp_spec import Carp, LongestFirst, Neighbourhood, Planner, Shuffled, total_cost

FULL_MAP = 20
FULL_ASSIGNMENTS = 500
QUICK_ASSIGNMENTS = 20

ALGORITHMS: Mapping[str, Planner] = {
    "CARP": Carp(),
    "CARP10": Shuffled(attempts=10),
    "CARP100": Shuffled(attempts=100),
    "LF": LongestFirst(),
    "Proposed_4": Neighbourhood(m=4, baseline=False),
    "Proposed_5": Neighbourhood(m=5, baseline=False),
    "Proposed_6": Neighbourhood(m=6, baseline=False),
    "Proposed_10": Neighbourhood(m=10, sample=150, baseline=False),
    "Proposed_4 + baseline": Neighbourhood(m=4),
    "Proposed_5 + baseline": Neighbourhood(m=5),
    "Proposed_6 + baseline": Neighbourhood(m=6),
    "Proposed_10 + baseline": Neighbourhood(m=10, sample=150),
    "Proposed_4 + CARP100": Neighbourhood(m=4, baseline=False, fallback=100),
}


@dataclass(frozen=True, slots=True)
class QualityCase:
    """One assignment of start and goal nodes to robots, on one map, by every algorithm."""

    map: int
    assignment: int
    robots: int = 100
    map_seed: int = 0

    @property
    def key(self) -> str:
        """Maps and assignments in their order."""
        return f"map {self.map:02} assignment {self.assignment:03}"

    def run(self) -> Row:
        """For each algorithm the robots left unplanned and the total cost; beside them the sum of shortest paths."""
        import carp_optimized as engine  # noqa: PLC0415 - each worker loads it
        from carp_oracle.generate import Fleet, Grid, grid_instance  # noqa: PLC0415

        fleet = Fleet(robots=self.robots, seed=self.assignment)
        instance = grid_instance(Grid(map=self.map, map_seed=self.map_seed), fleet)
        results: dict[str, list[int]] = {}
        for name, planner in ALGORITHMS.items():
            solution = engine.plan(instance, seeded(planner, self.assignment))
            results[name] = [len(solution.unplanned), total_cost(instance, solution.plans)]
        alone = [engine.query(instance, (), robot.id) for robot in instance.robots]
        shortest = total_cost(instance, [plan for plan in alone if plan is not None])
        return {"map": self.map, "assignment": self.assignment, "shortest": shortest, "results": results}


def seeded(planner: Planner, seed: int) -> Planner:
    """The planner with a seed of its own, if it draws orders."""
    return replace(planner, seed=seed) if isinstance(planner, Shuffled | Neighbourhood) else planner


def quality_cases(assignments: int, maps: Sequence[int] = range(FULL_MAP + 1)) -> tuple[QualityCase, ...]:
    """The cases of the experiment, assignment by assignment, so that a run that is stopped has whole assignments."""
    return tuple(QualityCase(map, assignment) for assignment in range(assignments) for map in maps)


@dataclass(frozen=True, slots=True)
class Summary:
    """An algorithm on one map: how many assignments it failed on of how many, and its mean total over the others.

    `total` is the mean with its 95 % interval, or `None` if it failed on all.
    """

    map: int
    algorithm: str
    failures: int
    assignments: int
    failure_rate: Interval
    total: Interval | None


def summarise(rows: Iterable[Row]) -> list[Summary]:
    """Summaries by map and algorithm; an assignment with an unplanned robot is a failure."""
    results: dict[tuple[int, str], list[tuple[int, int]]] = defaultdict(list)
    for row in rows:
        measured = msgspec.convert(row, QualityRow)
        for name, (unplanned, total) in measured.results.items():
            results[measured.map, name].append((unplanned, total))
    summaries = []
    for (map, name), each in sorted(results.items(), key=lambda item: (item[0][0], [*ALGORITHMS].index(item[0][1]))):
        totals = [total for unplanned, total in each if unplanned == 0]
        failures = len(each) - len(totals)
        rate = proportion_interval(failures, len(each))
        summaries.append(Summary(map, name, failures, len(each), rate, mean_interval(totals) if totals else None))
    return summaries


class QualityRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    map: int
    assignment: int
    shortest: int
    results: dict[str, tuple[int, int]]
