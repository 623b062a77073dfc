"""The table of gaps over small maps, from spanning tree to full grid, in verify/README.md; `make gap` makes it anew.

Everything but the limit of a search is decided by seeds. Intervals are 95 % of the normal approximation of the mean.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, stdev

from carp_oracle.generate import Fleet, Grid, grid_instance
from carp_oracle.progress import progress
from carp_spec import Carp, Greedy, LongestFirst, Neighbourhood, Planner, Shuffled
from carp_verify.gap import Gap, gap

SIZES = range(3, 9)
MAPS = (0, 5, 10, 20)
INSTANCES = 20
LIMIT = 1
PLANNERS: tuple[Planner, ...] = (Carp(), Shuffled(), LongestFirst(), Greedy(), Neighbourhood())
NAMES = ("CARP", "CARP10", "longest-first", "greedy", "neighbourhood")
COLUMNS = ("grid", "map", "robots", "decided", "delay", "best order", *NAMES)
BEGIN, END = "<!-- gap table: begin -->\n", "<!-- gap table: end -->\n"
NORMAL_95 = 1.96


@dataclass(frozen=True, slots=True)
class Cell:
    """The instances of one map size and map number; those whose optimum was not found count only as undecided."""

    size: int
    map: int
    gaps: tuple[Gap, ...]

    @property
    def decided(self) -> list[Gap]:
        """The gaps of instances that have an optimum, and it is known."""
        return [each for each in self.gaps if each.optimum.proved and each.optimum.cost is not None]


def cells(advance: Callable[[], None]) -> Iterator[Cell]:
    """Measure every cell; as many robots as the grid is wide, on a map of their own."""
    for size in SIZES:
        for map in MAPS:
            measured = []
            for seed in range(INSTANCES):
                instance = grid_instance(Grid(size, size, map, map_seed=seed), Fleet(robots=size, seed=seed))
                measured.append(gap(instance, PLANNERS, LIMIT))
                advance()
            yield Cell(size, map, tuple(measured))


def row(cell: Cell) -> Sequence[str]:
    """A row of the table, in per cent of the optimum."""
    decided = cell.decided
    delays = [_excess(each.optimum.cost, each.optimum.shortest) for each in decided]
    orders = [_excess(each.best_order, each.optimum.cost) for each in decided if each.best_order is not None]
    of_planners = []
    for position in range(len(PLANNERS)):
        reached = [(each.planners[position], each.optimum.cost) for each in decided]
        excesses = [_excess(planner.total, cost) for planner, cost in reached if not planner.unplanned]
        of_planners.append(_mean(excesses, len(decided)))
    head = (f"{cell.size} x {cell.size}", str(cell.map), str(cell.size), f"{len(decided)}/{len(cell.gaps)}")
    return (*head, _mean(delays, len(decided)), _mean(orders, len(decided), "open"), *of_planners)


def _excess(total: int | None, least: int | None) -> float:
    """By how many per cent a total exceeds the least one."""
    return 100 * ((total or 0) - (least or 0)) / (least or 1)


def _mean(values: Sequence[float], of: int, without: str = "failed") -> str:
    """The mean with its interval, and how many of the instances have none."""
    failed = f" ({of - len(values)} {without})" if len(values) < of else ""
    if not values:
        return f"-{failed}"
    half = NORMAL_95 * stdev(values) / len(values) ** 0.5 if len(values) > 1 else 0
    return f"{fmean(values):.1f} ± {half:.1f}{failed}"


def table(rows: Sequence[Sequence[str]]) -> str:
    """The rows as a table in Markdown."""
    lines = [COLUMNS, ["---", *(["---:"] * (len(COLUMNS) - 1))], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def write_table(page: Path) -> None:
    """Measure, and put the table between its marks on the page."""
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    with progress("measuring gaps", len(SIZES) * len(MAPS) * INSTANCES) as advance:
        rows = [row(cell) for cell in cells(advance)]
    page.write_text(f"{before}{BEGIN}{table(rows)}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    write_table(Path(__file__).parents[2] / "verify" / "README.md")
