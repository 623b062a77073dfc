"""What `carproof gap` shows of gaps: rows for people, documents for programs."""

from collections.abc import Iterator, Sequence

import msgspec

from carp_optimum.gap import Gap, PlannerGap
from carp_spec import Carp, FixedPaths, Greedy, LongestFirst, Neighbourhood, Planner, Shuffled
from carproof.gap_family import Cell, Excess

PLANNERS: tuple[Planner, ...] = (Carp(), Shuffled(), LongestFirst(), Greedy(), FixedPaths(), Neighbourhood())


class PlannerGapDocument(msgspec.Struct, frozen=True):
    """What a planner reached; the total is of the robots that it planned."""

    planner: str
    unplanned: int
    total: int


class GapDocument(msgspec.Struct, frozen=True):
    """The optimum, or null and the lower bound; the least total over all orders, if known; and the planners.

    `proved` means that the search for the optimum ended with an answer, which rests on its solver.
    """

    optimum: int | None
    lower: int
    proved: bool
    best_order: int | None
    planners: tuple[PlannerGapDocument, ...]


class MeanDocument(msgspec.Struct, frozen=True):
    """A mean in per cent with the ends of its 95 % interval, and over how many instances."""

    instances: int
    mean: float | None
    low: float | None
    high: float | None


class PlannerMeansDocument(msgspec.Struct, frozen=True):
    """How far a planner is from the optimum and from the best order, in per cent of the optimum."""

    planner: str
    above_optimum: MeanDocument
    price_of_the_search: MeanDocument


class SeedGapDocument(msgspec.Struct, frozen=True):
    """The gap of the instance of a seed."""

    seed: int
    gap: GapDocument


class CellDocument(msgspec.Struct, frozen=True):
    """The instances of one size and map: means over those with a known optimum, and the gap of each."""

    size: int
    map: int
    robots: int
    decided: int
    delay: MeanDocument
    price_of_an_order: MeanDocument
    planners: tuple[PlannerMeansDocument, ...]
    instances: tuple[SeedGapDocument, ...]


class FamilyDocument(msgspec.Struct, frozen=True):
    """The cells of a family."""

    cells: tuple[CellDocument, ...]


def gap_document(gap: Gap) -> GapDocument:
    """The document of a gap."""
    planners = tuple(PlannerGapDocument(each.planner.name, each.unplanned, each.total) for each in gap.planners)
    cost = gap.optimum.cost if gap.optimum.decided else None
    return GapDocument(cost, gap.optimum.lower, gap.optimum.decided, gap.best_order, planners)


def gap_rows(gap: Gap) -> Iterator[Sequence[object]]:
    """A row of each planner, after those of the optimum and of the best order."""
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
    """How much a total exceeds another, in ticks and per cent of it, with one digit."""
    if total is None or least is None:
        return "-"
    tenths = 1000 * (total - least) // least if least else 0
    return f"{total - least:+d} ({tenths // 10}.{tenths % 10} %)" if tenths >= 0 else f"{total - least:+d}"


def family_document(cells: Sequence[Cell]) -> FamilyDocument:
    """The document of a family."""
    return FamilyDocument(tuple(map(_cell_document, cells)))


def _cell_document(cell: Cell) -> CellDocument:
    planners = (
        PlannerMeansDocument(
            planner.name, _mean(cell.above_optimum(position)), _mean(cell.price_of_the_search(position))
        )
        for position, planner in enumerate(PLANNERS)
    )
    return CellDocument(
        cell.size,
        cell.map,
        cell.robots,
        len(cell.decided),
        _mean(cell.delay),
        _mean(cell.price_of_an_order),
        tuple(planners),
        tuple(SeedGapDocument(seed, gap_document(gap)) for seed, gap in zip(cell.seeds, cell.gaps, strict=True)),
    )


def _mean(excess: Excess) -> MeanDocument:
    interval = excess.per_cent
    if interval is None:
        return MeanDocument(excess.instances, None, None, None)
    return MeanDocument(excess.instances, interval.estimate, interval.low, interval.high)


def cell_rows(cell: Cell) -> Iterator[Sequence[object]]:
    """A row of the optimum, of the best order and of each planner, in per cent of the optimum."""
    decided, order = cell.decided, cell.price_of_an_order
    grid = (f"{cell.size} x {cell.size}", cell.map, cell.robots)
    yield (*grid, "optimum", f"{len(decided)}/{len(cell.gaps)}", "-", "-")
    yield ("", "", "", "best order", f"{order.instances}/{len(decided)}", order, "-")
    for position, planner in enumerate(PLANNERS):
        above = cell.above_optimum(position)
        found = f"{above.instances}/{len(decided)}"
        yield ("", "", "", planner.name, found, above, cell.price_of_the_search(position))
