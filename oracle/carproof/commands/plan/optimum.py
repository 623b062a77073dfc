"""`carproof optimum`: the least total cost of plans for all robots, with a proof if asked for."""

import os
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carp_spec import Instance, Refusal
from carp_spec.documents.decoding import write
from carp_spec.documents.solutions import write_solution
from carp_spec.inputs.options import MOST_PROCESSES, PROCESSES
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, print_document, read_instance_file, write_whole
from carproof.command_line.options import instance_argument, limit_option, listed, output_options
from carproof.command_line.tables import print_line, print_table, remark
from carproof.command_line.time_left import time_left, time_of_compiling
from carproof.extras import require
from carproof.judging.verdicts import verify_proof
from carproof.optima import optimum_document

if TYPE_CHECKING:
    from carp_optimum.sat.core_guided import Optimum

COLUMNS = ("robots", "shortest paths", "lower bound", "cost", "answer", "time")


@listed(
    "Find the least total cost, and plans that have it.",
    "carproof optimum town.json",
    "carproof optimum town.json --limit 300 -o best.json",
    "carproof optimum town.json --proof proof && carproof verify proof",
)
@instance_argument
@limit_option
@click.option(
    "--processes", type=click.IntRange(1, MOST_PROCESSES), default=PROCESSES, help="Two search faster on two cores."
)
@click.option(
    "--proof",
    type=click.Path(file_okay=False, path_type=Path),
    callback=lambda _, __, folder: folder and _writable(folder),
    help="Write a proof into this folder.",
)
@output_options
@click.pass_context
def command(
    context: click.Context, *, instance: str, limit: int, processes: int, proof: Path | None, output: Output
) -> Answer:
    """Find the least total cost of plans for all robots of INSTANCE, and plans that have it.

    The answer comes from a search and is not proved: it rests on the solver. With --proof it is proved: the command
    writes files with which others can check the least cost, or that the robots cannot all be planned. Writing takes at
    most --limit seconds more, and the files are checked at once (see carproof verify).

    --output writes the plans as a solution; --json prints cost, lower bound and solution. In the document, "decided" is
    true if the search ended with an answer, and "proved" if the proof of --proof was checked.

    Exit codes: 0 optimum found, 1 the robots cannot all be planned, 2 bad input, 3 undecided within the limit.
    """
    require("pysat")
    from carp_optimum.optimum import optimum  # noqa: PLC0415 - loads the planners
    from carp_verify.optimum.unsolvable import describe  # noqa: PLC0415

    problem = read_instance_file(instance)
    compiling = time_of_compiling()
    started = perf_counter()
    best = optimum(problem, time_left(context, limit, compiling), processes=processes)
    seconds = perf_counter() - started
    if output.file is not None and best.solution is not None:
        write_whole(output.file, write_solution(best.solution))
    is_proved = proof is not None and best.decided and _prove(proof, problem, best, limit)
    if output.as_json:
        print_document(write(optimum_document(best, is_proved)))
    else:
        answer = "undecided" if not best.decided else "proved" if is_proved else "found, not proved"
        numbers = [len(problem.robots), best.shortest, best.lower, best.cost]
        row = ["-" if number is None else number for number in numbers]
        print_table(COLUMNS, [[*row, answer, f"{seconds:.2f} s"]], numbers=COLUMNS)
        if best.obstacle is not None:
            print_line(f"the robots cannot all be planned: {describe(problem, best.obstacle)}")
        if not best.decided:
            found = "; no plans of all robots found yet" if best.cost is None else f", and the best found {best.cost}"
            print_line(f"undecided after {limit} s: plans of all robots cost at least {best.lower}{found}")
    if not best.decided or (proof is not None and not is_proved):
        return Answer.UNDECIDED
    return Answer.of(best.cost is not None)


def _writable(folder: Path) -> Path:
    """The folder of the proof; one that can be neither made nor written into is refused before the search."""
    try:
        nearest = next(each for each in (folder, *folder.absolute().parents) if os.path.lexists(each))
        TemporaryDirectory(dir=nearest).cleanup()
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be written: {error.strerror}") from error
    return folder


def _prove(folder: Path, instance: Instance, best: "Optimum", limit: int) -> bool:
    """Write a proof and check it; whether the limits sufficed."""
    from carp_optimum.deadline import TimeOver  # noqa: PLC0415
    from carp_optimum.sat.proving import write_proof  # noqa: PLC0415 - only for those who ask for a proof

    try:
        write_proof(instance, best, folder, limit)
    except TimeOver:
        remark(f"The proof takes longer than the limit of {limit} s; nothing was written.")
        return False
    except Refusal as refusal:
        if refusal.kind != "limit":
            raise
        remark(f"The proof is too large to be checked: {refusal.message}; nothing was written.")
        return False
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be written: {error.strerror}") from error
    verified, _ = verify_proof(folder, instance, kernel=False)
    return verified.is_decided
