"""The table of times of the search for an optimum, in docs/results/optima.md; `make optimum-figures` makes it again.

Seeds decide everything but the times.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from statistics import median
from time import perf_counter

from carp_optimum.optimum import optimum
from carp_spec import AfterGoal, Instance
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.generate.options import JUST_ONE
from carproof.markdown import markdown_table, write_section
from carproof.progress import progress

LIMIT = 60
FULL, SPARSE = 20, 5
COLUMNS = ("map", "robots", "after the goal", "decided", "median s", "worst s")


@dataclass(frozen=True, slots=True)
class Family:
    """Instances of one kind, each with a map, starts and goals of its own."""

    size: int
    map: int
    robots: int
    after_goal: AfterGoal
    duration: Range = JUST_ONE
    instances: int = 10

    def __str__(self) -> str:
        """Print like `8 x 8, map 5` or `5 x 5, full grid, durations 1..3`."""
        edges = "full grid" if self.map == FULL else f"map {self.map}"
        durations = "" if self.duration == JUST_ONE else f", durations {self.duration}"
        return f"{self.size} x {self.size}, {edges}{durations}"

    def instance(self, seed: int) -> Instance:
        """The instance of a seed."""
        grid = Grid(self.size, self.size, self.map, map_seed=seed)
        fleet = Fleet(self.robots, seed, self.after_goal)
        return grid_instance(grid, fleet, Traits(duration=self.duration))


FAMILIES = (
    Family(8, SPARSE, 10, "park"),
    Family(5, FULL, 6, "vanish", Range(1, 3)),
    Family(8, FULL, 24, "park"),
    Family(20, FULL, 60, "vanish"),
    Family(20, FULL, 60, "park"),
    Family(20, FULL, 150, "vanish", instances=2),
    Family(20, FULL, 100, "park"),
    Family(6, FULL, 36, "vanish", instances=5),
    Family(8, FULL, 32, "park", instances=5),
)


def seconds_of(family: Family, advance: Callable[[], None]) -> Iterator[float]:
    """The seconds by the clock that the optimum of each instance of the family takes; infinite if it ends undecided."""
    for seed in range(family.instances):
        instance = family.instance(seed)
        started = perf_counter()
        best = optimum(instance, LIMIT, processes=2)
        yield perf_counter() - started if best.decided else inf
        advance()


def row(family: Family, seconds: Sequence[float]) -> Sequence[str]:
    """A row of the table."""
    decided = sum(each < inf for each in seconds)
    head = (str(family), str(family.robots), family.after_goal, f"{decided}/{len(seconds)}")
    return (*head, *(f"{each:.2f}" if each <= LIMIT else f"over {LIMIT}" for each in (median(seconds), max(seconds))))


def optimum_table(families: Sequence[Family]) -> str:
    """Measure families, and lay the times out in Markdown."""
    optimum(families[0].instance(0), LIMIT)  # loads the solver
    with progress("searching for optima", sum(family.instances for family in families)) as advance:
        rows = [row(family, list(seconds_of(family, advance))) for family in families]
    return markdown_table(COLUMNS, rows, numbers=("robots", *COLUMNS[3:]))


if __name__ == "__main__":
    page = Path(__file__).parents[3] / "docs" / "results" / "optima.md"
    write_section(page, "optimum table", optimum_table(FAMILIES))
