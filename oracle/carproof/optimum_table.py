"""The table of times of the search for an optimum, in optimum/README.md; `make optimum-figures` makes it anew.

Everything but the clock is decided by seeds.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

from carp_optimum.optimum import optimum
from carp_spec import AfterGoal, Instance
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.generate.options import JUST_ONE
from carproof.progress import progress

LIMIT = 30
FULL, SPARSE = 20, 5
COLUMNS = ("map", "robots", "after the goal", "decided", "median s", "worst s")
BEGIN, END = "<!-- optimum table: begin -->\n", "<!-- optimum table: end -->\n"


@dataclass(frozen=True, slots=True)
class Family:
    """So many instances of one kind, each with a map, starts and goals of its own."""

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
    Family(6, FULL, 20, "vanish"),
    Family(8, FULL, 16, "vanish"),
    Family(8, FULL, 16, "park"),
    Family(8, SPARSE, 10, "vanish"),
    Family(8, SPARSE, 10, "park"),
    Family(5, FULL, 6, "vanish", Range(1, 3)),
    Family(8, FULL, 24, "vanish"),
    Family(8, FULL, 24, "park"),
    Family(20, FULL, 60, "vanish"),
    Family(20, FULL, 60, "park"),
    Family(20, FULL, 150, "vanish", instances=2),
    Family(20, FULL, 100, "park", instances=2),
    Family(6, FULL, 36, "vanish", instances=2),
    Family(8, FULL, 32, "park", instances=2),
)


@dataclass(frozen=True, slots=True)
class Search:
    """How long a search took, and whether it decided the instance."""

    seconds: float
    is_decided: bool


def searches(family: Family, advance: Callable[[], None]) -> Iterator[Search]:
    """Search for the optimum of every instance of the family."""
    for seed in range(family.instances):
        instance = family.instance(seed)
        started = perf_counter()
        best = optimum(instance, LIMIT)
        yield Search(perf_counter() - started, best.decided)
        advance()


def row(family: Family, measured: Sequence[Search]) -> Sequence[str]:
    """A row of the table; an undecided search counts as one that takes longer than the limit."""
    decided = sum(search.is_decided for search in measured)
    times = [search.seconds if search.is_decided else float("inf") for search in measured]
    head = (str(family), str(family.robots), family.after_goal, f"{decided}/{len(measured)}")
    return (*head, _seconds(median(times)), _seconds(max(times)))


def _seconds(time: float) -> str:
    return f"{time:.2f}" if time <= LIMIT else f"over {LIMIT}"


def table(rows: Sequence[Sequence[str]]) -> str:
    """The rows as a table in Markdown."""
    lines = [COLUMNS, ["---", "---:", "---", *["---:"] * (len(COLUMNS) - 3)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def write_table(page: Path) -> str:
    """Measure, and put the table between its marks on the page."""
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    optimum(FAMILIES[0].instance(0), LIMIT)  # loads the solver
    with progress("searching for optima", sum(family.instances for family in FAMILIES)) as advance:
        rows = [row(family, list(searches(family, advance))) for family in FAMILIES]
    page.write_text(f"{before}{BEGIN}{table(rows)}{END}{after}", encoding="utf-8")
    return table(rows)


if __name__ == "__main__":
    print(write_table(Path(__file__).parents[2] / "optimum" / "README.md"), end="")  # noqa: T201 - the command's output
