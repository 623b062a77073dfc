"""`carproof optimum`: the least total cost of plans for all robots, with a proof if one is asked for."""

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carp_oracle.answer import Answer
from carp_oracle.extras import require
from carp_oracle.files import print_document, read_instance_file, write_whole
from carp_oracle.optima import optimum_document
from carp_oracle.options import examples, instance_argument, json_option, limit_option, output_option
from carp_oracle.tables import print_line, print_table
from carp_spec import Instance, write_solution
from carp_spec.documents import write

if TYPE_CHECKING:
    from carp_verify.optimum import Optimum

COLUMNS = ("robots", "shortest paths", "lower bound", "cost", "proved", "time")


@click.command(
    epilog=examples(
        "carproof optimum town.json",
        "carproof optimum town.json --limit 300 -o best.json",
        "carproof optimum town.json --proof proof && carproof verify-proof proof",
    )
)
@instance_argument
@limit_option
@click.option("--proof", type=click.Path(file_okay=False, path_type=Path), help="Write a proof into this folder.")
@output_option
@json_option
def command(instance: str, limit: int, proof: Path | None, output: Path | None, as_json: bool) -> Answer:
    """Find the least total cost of plans for all robots of INSTANCE, and plans that have it.

    --output writes the plans as a solution, --json prints cost, lower bound and solution. --proof writes files
    with which others can check the cost (see verify-proof), for at most --limit seconds more.

    Exit codes: 0 here is the optimum, 1 the robots cannot all be planned, 2 bad input, 3 undecided within the limit.
    """
    require("pysat")
    from carp_verify.optimum import optimum  # noqa: PLC0415 - loads the planners

    problem = read_instance_file(instance)
    started = perf_counter()
    best = optimum(problem, limit)
    seconds = perf_counter() - started
    if output is not None and best.solution is not None:
        write_whole(output, write_solution(best.solution))
    if as_json:
        print_document(write(optimum_document(best)))
    else:
        numbers = [len(problem.robots), best.shortest, best.lower, best.cost]
        row = ["-" if number is None else number for number in numbers]
        print_table(COLUMNS, [[*row, "yes" if best.proved else "no", f"{seconds:.2f} s"]], numbers=COLUMNS)
        if best.reason is not None:
            print_line(f"the robots cannot all be planned: {best.reason}")
        if not best.proved:
            print_line(_undecided(best, limit))
    if not best.proved:
        return Answer.UNDECIDED
    if proof is not None and best.cost is not None:
        return _prove(proof, problem, best, limit)
    return Answer.of(best.cost is not None)


def _undecided(best: "Optimum", limit: int) -> str:
    """What is known of the optimum, in a line."""
    known = f"undecided after {limit} s: plans of all robots cost at least {best.lower}"
    if best.cost is None:
        return f"{known}; no plans of all robots found yet"
    return f"{known}, and the best found {best.cost}"


def _prove(folder: Path, instance: Instance, best: "Optimum", limit: int) -> Answer:
    from carp_verify.proof import write_proof  # noqa: PLC0415 - only for those who ask for a proof
    from carp_verify.solver import TimeOver  # noqa: PLC0415

    try:
        write_proof(instance, best, folder, limit)
    except TimeOver:
        click.echo(f"The proof takes longer than the limit of {limit} s; nothing was written.", err=True)
        return Answer.UNDECIDED
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be written: {error.strerror}") from error
    return Answer.YES
