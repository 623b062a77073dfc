"""The output of `carproof gap`: rows for people, documents for programs."""

from collections.abc import Iterator, Sequence
from typing import Any

from carp_optimum.gap import PLANNERS, Gap, PlannerGap
from carproof.gap.family import Cell
from carproof.gap.statistics import Excess


def gap_document(gap: Gap) -> dict[str, Any]:
    """The optimum, or null and the lower bound; the least total over all orders, if known; and the planners.

    `decided` means that the search for the optimum ended with an answer, which rests on its solver. The total of a
    planner covers the robots that it planned.
    """
    best = gap.optimum
    planners = [
        {"planner": each.planner.name, "unplanned": each.unplanned, "total": each.total} for each in gap.planners
    ]
    return {
        "optimum": best.cost if best.decided else None,
        "lower": best.lower,
        "decided": best.decided,
        "best_order": gap.best_order,
        "planners": planners,
    }


def gap_rows(gap: Gap) -> Iterator[Sequence[object]]:
    """A row for each planner, after those of the optimum and of the best order."""
    cost = gap.optimum.cost if gap.optimum.decided else None
    yield ("optimum", *(("-",) * 5 if cost is None else (0, cost, *("-",) * 3)))
    order_price = _difference(gap.best_order, cost)
    if gap.best_order is not None:
        yield ("best order", 0, gap.best_order, order_price, order_price, _difference(gap.best_order, gap.best_order))
    for each in gap.planners:
        yield _planner_row(each, cost, gap.best_order)


def _planner_row(reached: PlannerGap, cost: int | None, best_order: int | None) -> Sequence[object]:
    if reached.unplanned:
        return (reached.planner.name, reached.unplanned, reached.total, "-", "-", "-")
    prices = (
        _difference(reached.total, cost),
        _difference(best_order, cost),
        _difference(reached.total, best_order),
    )
    return (reached.planner.name, 0, reached.total, *prices)


def _difference(total: int | None, least: int | None) -> str:
    """The excess of a total over another, in ticks and in per cent of it, with one digit."""
    if total is None or least is None:
        return "-"
    tenths = 1000 * (total - least) // least if least else 0
    return f"{total - least:+d} ({tenths // 10}.{tenths % 10} %)" if tenths >= 0 else f"{total - least:+d}"


def family_document(cells: Sequence[Cell]) -> dict[str, Any]:
    """The cells of a family: for each size and map means in per cent, and the gap of each instance."""
    return {"cells": [_cell_document(cell) for cell in cells]}


def _cell_document(cell: Cell) -> dict[str, Any]:
    planners = [
        {
            "planner": planner.name,
            "above_optimum": _mean(cell.above_optimum(position)),
            "price_of_the_search": _mean(cell.price_of_the_search(position)),
        }
        for position, planner in enumerate(PLANNERS)
    ]
    return {
        "size": cell.size,
        "map": cell.map,
        "robots": cell.robots,
        "decided": len(cell.decided),
        "delay": _mean(cell.delay),
        "price_of_an_order": _mean(cell.price_of_an_order),
        "planners": planners,
        "instances": [
            {"seed": seed, "gap": gap_document(gap)} for seed, gap in zip(cell.seeds, cell.gaps, strict=True)
        ],
    }


def _mean(excess: Excess) -> dict[str, float | None]:
    """A mean with the ends of its 95 % interval, and the number of instances."""
    found = excess.per_cent
    mean, low, high = (None,) * 3 if found is None else (found.estimate, found.low, found.high)
    return {"instances": excess.instances, "mean": mean, "low": low, "high": high}


def cell_rows(cell: Cell) -> Iterator[Sequence[object]]:
    """Rows of the optimum, of the best order and of each planner, in per cent of the optimum."""
    decided, order = cell.decided, cell.price_of_an_order
    grid = (f"{cell.size} x {cell.size}", cell.map, cell.robots)
    yield (*grid, "optimum", f"{len(decided)}/{len(cell.gaps)}", "-", "-")
    yield ("", "", "", "best order", f"{order.instances}/{len(decided)}", order, "-")
    for position, planner in enumerate(PLANNERS):
        above = cell.above_optimum(position)
        found = f"{above.instances}/{len(decided)}"
        yield ("", "", "", planner.name, found, above, cell.price_of_the_search(position))
