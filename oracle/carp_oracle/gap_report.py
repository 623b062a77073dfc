"""What `carproof gap` shows of a gap: rows for people, a document for programs."""

from collections.abc import Iterator, Sequence

import msgspec

from carp_verify.gap import Gap, PlannerGap


class PlannerGapDocument(msgspec.Struct, frozen=True):
    """What a planner reached; the total is of the robots that it planned."""

    planner: str
    unplanned: int
    total: int


class GapDocument(msgspec.Struct, frozen=True):
    """The optimum, or null and the lower bound; the least total over all orders, if known; and the planners."""

    optimum: int | None
    lower: int
    proved: bool
    best_order: int | None
    planners: tuple[PlannerGapDocument, ...]


def gap_document(gap: Gap) -> GapDocument:
    """The document of a gap."""
    planners = tuple(PlannerGapDocument(each.planner.name, each.unplanned, each.total) for each in gap.planners)
    cost = gap.optimum.cost if gap.optimum.proved else None
    return GapDocument(cost, gap.optimum.lower, gap.optimum.proved, gap.best_order, planners)


def gap_rows(gap: Gap) -> Iterator[Sequence[object]]:
    """A row of each planner, after those of the optimum and of the best order."""
    cost = gap.optimum.cost if gap.optimum.proved else None
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
