"""`carproof verify-proof`: check what `carproof optimum --proof` wrote."""

from pathlib import Path

import click

from carp_verify.documents import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, print_document, read_instance_file
from carproof.command_line.options import examples, json_option, kernel_option
from carproof.command_line.tables import print_line, print_table
from carproof.extras import require
from carproof.judging.verdicts import verify_proof
from carproof.optima import ProofDocument, proof_document


@click.command(
    short_help="Check the files that prove an optimum.",
    epilog=examples("carproof verify-proof proof", "carproof verify-proof proof --instance town.json"),
)
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--instance", type=InputFile(), help="The instance that the proof must be about.")
@kernel_option
@json_option
def command(*, folder: Path, instance: str | None, kernel: bool, as_json: bool) -> Answer:
    """Check that the files in FOLDER prove the least total cost of their instance, or that there are no plans of all.

    Both formulas are made again from the instance and compared. The model's plans are judged. The refutation of a
    smaller cost is checked step by step, and z3 is asked about both formulas. If the robots cannot all be planned, the
    obstacle is checked: a robot without a way, a goal where too many robots park, a refutation of plans of any cost, or
    a complete search over few joint states.

    Where the proved kernel is built, it makes the formula of a smaller cost too and must accept the refutation. With
    --kernel it must be there, and the answer names it.

    Exit codes: 0 the claim is proved, 1 it is not, 2 bad input, 3 undecided, because z3 or the kernel did not decide.
    """
    require("z3")
    from carp_verify.optimum.proof import ProofError  # noqa: PLC0415 - loads the encoder

    given = None if instance is None else read_instance_file(instance)
    try:
        verified, by = verify_proof(folder, given, kernel)
    except ProofError as error:
        if as_json:
            print_document(write(ProofDocument(proved=False, reason=str(error))))
        else:
            print_line(f"not proved: {error}")
        return Answer.NO
    reason = None if verified.is_decided else "z3 did not answer in time about one of the formulas"
    if as_json:
        print_document(write(proof_document(verified, reason, by if kernel else None)))
    elif verified.solution is None and reason is None:
        print_line(f"proved: the robots cannot all be planned: {verified.obstacle}")
    elif verified.solution is not None:
        columns = ["least cost", "robots", "refutation", "z3 at the cost", "z3 below it"]
        row = [verified.cost, len(verified.solution.plans), "checked", verified.z3_reach, verified.z3_beat]
        print_table(columns, [row], numbers=columns[:2])
    if kernel and not as_json:
        print_line(f"decided by {by}")
    if reason is not None and not as_json:
        print_line(f"undecided: {reason}")
    return Answer.YES if verified.is_decided else Answer.UNDECIDED
