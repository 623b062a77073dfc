"""`carproof gap`: how far each planner is from the optimum."""

import click

from carp_oracle.answer import Answer
from carp_oracle.files import print_document, read_instance_file
from carp_oracle.gap_report import gap_document, gap_rows
from carp_oracle.options import examples, instance_argument, json_option, limit_option
from carp_oracle.tables import print_line, print_table
from carp_spec import Carp, FixedPaths, Greedy, LongestFirst, Neighbourhood, Planner, Shuffled
from carp_spec.documents import write

PLANNERS: tuple[Planner, ...] = (
    Carp(),
    Shuffled(),
    LongestFirst(),
    Greedy(),
    FixedPaths(),
    Neighbourhood(),
)
COLUMNS = ("planner", "unplanned", "total", "above optimum", "price of an order", "price of the search")


@click.command(epilog=examples("carproof gap town.json", "carproof gap town.json --limit 300 --json"))
@instance_argument
@limit_option
@json_option
def command(instance: str, limit: int, as_json: bool) -> Answer:
    """Plan INSTANCE with every planner, and tell how far each is from the optimum, and why.

    The price of an order is how far the best of all orders is from the optimum, if robots are planned one after
    the other; it is known for small fleets. The price of the search is how far the planner is from the best order.

    Exit codes: 0 the optimum is known, 1 the robots cannot all be planned, 2 bad input, 3 undecided within the limit.
    """
    from carp_verify.gap import gap  # noqa: PLC0415 - loads the planners

    problem = read_instance_file(instance)
    measured = gap(problem, PLANNERS, limit)
    best = measured.optimum
    if as_json:
        print_document(write(gap_document(measured)))
    else:
        print_table(COLUMNS, gap_rows(measured), numbers=COLUMNS[1:])
        if best.reason is not None:
            print_line(f"the robots cannot all be planned: {best.reason}")
        elif not best.proved:
            print_line(f"the optimum was not found within {limit} s; it is at least {best.lower}")
    if not best.proved:
        return Answer.UNDECIDED
    return Answer.of(best.cost is not None)
