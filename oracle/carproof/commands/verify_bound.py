"""`carproof verify-bound`: check what `carproof bound` wrote."""

import click

from carp_verify.bounds import read_bound
from carp_verify.documents import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import (
    InputFile,
    print_document,
    read_file,
    read_instance_file,
    refuse_two_standard_inputs,
    require_following_in,
)
from carproof.command_line.options import examples, instance_argument, json_option, kernel_option
from carproof.command_line.tables import print_line, print_table
from carproof.judging.verdicts import verify_bound

COLUMNS = ("lower bound", "robots", "prices", "cuts", "deadlines", "horizon", "decided by")


@click.command(
    short_help="Check the certificate of a lower bound.",
    epilog=examples(
        "carproof verify-bound town.json certificate.json",
        "carproof bound town.json --json | carproof verify-bound town.json -",
    ),
)
@instance_argument
@click.argument("certificate", type=InputFile())
@kernel_option
@json_option
def command(*, instance: str, certificate: str, kernel: bool, as_json: bool) -> Answer:
    """Check that CERTIFICATE proves its lower bound on the total cost of plans for all robots of INSTANCE.

    The least priced cost of each robot is computed again, in whole numbers, by code that shares nothing with the search
    for the prices. The proved kernel (--kernel) makes the formulas of cuts and deadlines itself.

    Exit codes: 0 the bound is proved, 1 it is not, 2 bad input, 3 the kernel cannot decide.
    """
    refuse_two_standard_inputs(instance, certificate)
    problem = read_instance_file(instance)
    require_following_in(instance, problem)
    document = read_file(certificate, read_bound)
    verdict = verify_bound(problem, document, kernel)
    if as_json:
        print_document(write(verdict))
    elif verdict.bound is None:
        print_line(f"not proved: {verdict.path}: {verdict.reason} [{verdict.rule}]")
    else:
        prices = len(document.resources) + len(document.exchanges)
        groups = [len(document.cuts), len(document.deadlines)]
        row = [verdict.bound, len(document.robots), prices, *groups, document.horizon, verdict.by]
        print_table(COLUMNS, [row], numbers=COLUMNS[:-1])
        for robot, least in document.robots:
            if least is None:
                print_line(f"robot {robot} has no way to its goal: the bound is that of the others")
    return Answer.of(verdict.bound is not None)
