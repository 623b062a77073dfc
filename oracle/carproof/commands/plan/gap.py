"""`carproof gap`: the distance of each planner from the optimum."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import click

from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, print_document, read_instance_file
from carproof.command_line.options import json_option, limit_option, listed
from carproof.command_line.tables import print_line, print_table
from carproof.engines import warm
from carproof.extras import require

if TYPE_CHECKING:
    from carp_optimum.gap import Gap

COLUMNS = ("planner", "unplanned", "total", "above optimum", "price of an order", "price of the search")


@listed(
    "Compare every planner with the optimum.", "carproof gap town.json", "carproof gap town.json --limit 300 --json"
)
@click.argument("instance", type=InputFile())
@limit_option
@json_option
def command(instance: str, limit: int, as_json: bool) -> Answer:
    """Plan INSTANCE with every planner, and show how far each is from the optimum, and why.

    The optimum is found by a search and not proved (see optimum).

    The price of an order is the distance of the best order from the optimum, if robots are planned one after the other;
    it is known for small fleets. The price of the search is the distance of the planner from the best order.

    Exit codes: 0 the optimum is found, 1 the robots cannot all be planned, 2 bad input, 3 undecided within the limit.
    """
    require("pysat")
    from carp_optimum.gap import PLANNERS, gap  # noqa: PLC0415 - loads the planners
    from carp_verify.optimum.unsolvable import describe  # noqa: PLC0415

    problem = read_instance_file(instance)
    warm()
    measured = gap(problem, PLANNERS, limit)
    best = measured.optimum
    if as_json:
        print_document(write(gap_document(measured)))
    else:
        print_table(COLUMNS, gap_rows(measured), numbers=COLUMNS[1:])
        if best.obstacle is not None:
            print_line(f"the robots cannot all be planned: {describe(problem, best.obstacle)}")
        elif not best.decided:
            print_line(f"the optimum was not found within {limit} s; it is at least {best.lower}")
    if not best.decided:
        return Answer.UNDECIDED
    return Answer.of(best.cost is not None)


def gap_document(gap: "Gap") -> dict[str, Any]:
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


def gap_rows(gap: "Gap") -> Iterator[Sequence[object]]:
    """A row for each planner, after those of the optimum and of the best order."""
    best = gap.best_order
    cost = gap.optimum.cost if gap.optimum.decided else None
    yield ("optimum", *(("-",) * 5 if cost is None else (0, cost, *("-",) * 3)))
    reached = [] if best is None else [("best order", 0, best)]
    reached += [(each.planner.name, each.unplanned, each.total) for each in gap.planners]
    for name, unplanned, total in reached:
        prices = (_difference(total, cost), _difference(best, cost), _difference(total, best))
        yield (name, unplanned, total, *(("-",) * 3 if unplanned else prices))


def _difference(total: int | None, least: int | None) -> str:
    """The excess of a total over another, in ticks and in per cent of it, with one digit."""
    if total is None or least is None:
        return "-"
    tenths = 1000 * (total - least) // least if least else 0
    return f"{total - least:+d} ({tenths // 10}.{tenths % 10} %)" if tenths >= 0 else f"{total - least:+d}"
