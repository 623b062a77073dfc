"""`carproof verify-query`: check what `carproof query --certificate` wrote."""

import click

from carp_verify.documents import read_query_certificate, write
from carproof.command_line.answer import Answer
from carproof.command_line.files import (
    InputFile,
    print_document,
    read_file,
    read_instance_file,
    read_solution_file,
    refuse_two_standard_inputs,
    require_following_in,
)
from carproof.command_line.options import examples, instance_argument, json_option, kernel_option, solution_argument
from carproof.command_line.tables import print_line, print_table
from carproof.judging.verdicts import verify_query

COLUMNS = ("robot", "now", "earliest arrival", "labels", "decided by")


@click.command(
    short_help="Check the certificate of a query.",
    epilog=examples(
        "carproof verify-query town.json plans.json r7.json",
        "carproof verify-query town.json plans.json r7.json --kernel",
    ),
)
@instance_argument
@solution_argument
@click.argument("certificate", type=InputFile())
@kernel_option
@json_option
def command(*, instance: str, solution: str, certificate: str, kernel: bool, as_json: bool) -> Answer:
    """Check that CERTIFICATE proves how early its robot can arrive beside the plans of SOLUTION.

    It proves that no lawful plan of the robot beside the plans of the others arrives before the bound of the
    certificate, or that no such plan exists. A lawful plan keeps the visits that the robot has made of its own plan.

    Exit codes: 0 the bound is proved, 1 it is not, 2 bad input.
    """
    refuse_two_standard_inputs(instance, solution, certificate)
    problem, given = read_instance_file(instance), read_solution_file(solution)
    require_following_in(instance, problem)
    document = read_file(certificate, read_query_certificate)
    verdict = verify_query(problem, given, document, kernel)
    if as_json:
        print_document(write(verdict))
    elif verdict.proved:
        arrival = "never" if document.bound is None else document.bound
        row = [document.robot, document.now, arrival, len(document.labels), verdict.by]
        print_table(COLUMNS, [row], numbers=COLUMNS[1:4])
    else:
        print_line(f"not proved: {verdict.path}: {verdict.reason} [{verdict.rule}]")
    return Answer.of(verdict.proved)
