"""`carproof gap`: the distance of each planner from the optimum."""

from typing import TYPE_CHECKING, get_args

import click

from carp_spec import AfterGoal
from carp_spec.documents.decoding import write
from carp_spec.planners import LARGEST_SEED
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, print_document, read_instance_file, refuse_in
from carproof.command_line.options import RangeType, examples, json_option, limit_option
from carproof.command_line.tables import print_line, print_table
from carproof.engines import warm
from carproof.extras import require
from carproof.generate import Range
from carproof.progress import progress

if TYPE_CHECKING:
    from carproof.gap.family import Family

COLUMNS = ("planner", "unplanned", "total", "above optimum", "price of an order", "price of the search")
FAMILY_COLUMNS = ("grid", "map", "robots", "planner", "found", "above optimum", "price of the search")
FULL_MAP = 20
WIDEST = 100
MOST_INSTANCES = 10_000


@click.command(
    short_help="Compare every planner with the optimum.",
    epilog=examples(
        "carproof gap town.json",
        "carproof gap town.json --limit 300 --json",
        "carproof gap --size 3..6 --map 0 --map 20 --limit 1",
        "carproof gap --size 5 --robots 7 --after-goal park --count 100 --seed 1",
    ),
)
@click.argument("instance", type=InputFile(), required=False)
@limit_option
@json_option
@click.option("--size", type=RangeType(), help="Generate square grids of this width, like 3..8.")
@click.option(
    "--map",
    "maps",
    type=click.IntRange(0, FULL_MAP),
    multiple=True,
    help="The paper's map, of a spanning tree (0) to the full grid (20); may be repeated.  [default: 20]",
)
@click.option("--robots", type=click.IntRange(min=0), help="Robots on each grid.  [default: as many as it is wide]")
@click.option("--count", type=click.IntRange(1, MOST_INSTANCES), default=20, help="Instances of each size and map.")
@click.option(
    "--seed", type=click.IntRange(0, LARGEST_SEED - MOST_INSTANCES), default=0, help="The seed of the first instance."
)
@click.option(
    "--after-goal",
    type=click.Choice(get_args(AfterGoal)),
    default="vanish",
    help="Robots vanish or park after their goals.",
)
def command(  # noqa: PLR0913 - one parameter for each argument and option
    *,
    instance: str | None,
    limit: int,
    as_json: bool,
    size: Range | None,
    maps: tuple[int, ...],
    robots: int | None,
    count: int,
    seed: int,
    after_goal: AfterGoal,
) -> Answer:
    """Plan INSTANCE with every planner, and show how far each is from the optimum, and why.

    The optimum is found by a search and not proved (see optimum).

    The price of an order is the distance of the best order from the optimum, if robots are planned one after the other;
    it is known for small fleets. The price of the search is the distance of the planner from the best order.

    With --size instead of INSTANCE, grids are generated, and the table shows means in per cent of the optimum with 95 %
    intervals. The price of an order is the excess of the best order over the optimum. `found` is the number of
    instances in which that order is known, or in which the planner plans all robots. Other instances are in no mean.

    Exit codes: 0 the optimum is found, 1 the robots cannot all be planned, 2 bad input, 3 undecided within the limit. A
    family has the worst code of its instances.
    """
    require("pysat")
    if (instance is None) == (size is None):
        raise click.UsageError("Give an INSTANCE or a --size, one of them.")
    if instance is not None:
        return _gap_of(instance, limit, as_json)
    from carproof.gap.family import Family  # noqa: PLC0415 - loads the planners

    assert size is not None  # noqa: S101 - asked above
    if not 1 <= size.low <= size.high <= WIDEST:
        raise click.BadParameter(f"{size} must be a range within 1..{WIDEST}.", param_hint="'--size'")
    return _gaps_of(Family(size, maps or (FULL_MAP,), robots, count, seed, after_goal), limit, as_json)


def _gap_of(path: str, limit: int, as_json: bool) -> Answer:
    from carp_optimum.gap import PLANNERS, gap  # noqa: PLC0415
    from carp_verify.optimum.unsolvable import describe  # noqa: PLC0415
    from carproof.gap.report import gap_document, gap_rows  # noqa: PLC0415 - loads the planners

    problem = read_instance_file(path)
    refuse_in(path, problem, "stops")
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


def _gaps_of(family: "Family", limit: int, as_json: bool) -> Answer:
    from carp_optimum.gap import PLANNERS  # noqa: PLC0415
    from carproof.gap.family import measured  # noqa: PLC0415 - loads the planners
    from carproof.gap.report import cell_rows, family_document  # noqa: PLC0415

    warm()
    with progress("measuring gaps", len(family.cells) * family.count) as advance:
        cells = list(measured(family, PLANNERS, limit, advance))
    if as_json:
        print_document(write(family_document(cells)))
    else:
        rows = (row for cell in cells for row in cell_rows(cell))
        print_table(FAMILY_COLUMNS, rows, numbers=("map", "robots", *FAMILY_COLUMNS[4:]))
        print_line("means in per cent of the optimum, with 95 % intervals")
    optima = [gap.optimum for cell in cells for gap in cell.gaps]
    if not all(each.decided for each in optima):
        return Answer.UNDECIDED
    return Answer.of(all(each.cost is not None for each in optima))
