"""The table of gaps over small maps, from spanning tree to full grid, in docs/results/gaps.md, made by `make gap`."""

from collections.abc import Sequence
from pathlib import Path

from carp_spec.readme import markdown_table, write_section
from carproof.gap_family import Cell, Excess, Family, measured
from carproof.gap_report import PLANNERS
from carproof.generate import Range
from carproof.progress import progress

FAMILY = Family(Range(3, 8), (0, 5, 10, 20))
LIMIT = 1
COLUMNS = ("grid", "map", "robots", "decided", "delay", "best order", *(planner.name for planner in PLANNERS))


def row(cell: Cell) -> Sequence[str]:
    """A row of the table, in per cent of the optimum."""
    decided = len(cell.decided)
    head = (f"{cell.size} x {cell.size}", str(cell.map), str(cell.robots), f"{decided}/{len(cell.gaps)}")
    of_planners = (_shown(cell.above_optimum(planner), decided, "failed") for planner in range(len(PLANNERS)))
    return (*head, str(cell.delay), _shown(cell.price_of_an_order, decided, "open"), *of_planners)


def _shown(excess: Excess, of: int, without: str) -> str:
    """The mean with its interval, and how many of the instances have none."""
    return f"{excess} ({of - excess.instances} {without})" if excess.instances < of else str(excess)


def gap_table(family: Family) -> str:
    """Measure a family, and lay its cells out in Markdown."""
    with progress("measuring gaps", len(family.cells) * family.count) as advance:
        rows = [row(cell) for cell in measured(family, PLANNERS, LIMIT, advance)]
    return markdown_table(COLUMNS, rows, numbers=COLUMNS[1:])


if __name__ == "__main__":
    write_section(Path(__file__).parents[2] / "docs" / "results" / "gaps.md", "gap table", gap_table(FAMILY))
