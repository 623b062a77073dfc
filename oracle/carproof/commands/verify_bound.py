"""`carproof verify-bound`: check what `carproof bound` wrote."""

import click

from carp_spec import Refusal
from carp_spec.bounds import read_bound
from carp_spec.documents import write
from carproof.answer import Answer
from carproof.files import (
    InputFile,
    naming,
    print_document,
    read_bytes,
    read_instance_file,
    refuse_two_standard_inputs,
)
from carproof.options import examples, instance_argument, json_option
from carproof.results import VerifiedBoundDocument
from carproof.tables import print_line, print_table

COLUMNS = ("lower bound", "robots", "prices", "cuts", "horizon")


@click.command(
    epilog=examples(
        "carproof verify-bound town.json certificate.json",
        "carproof bound town.json --json | carproof verify-bound town.json -",
    )
)
@instance_argument
@click.argument("certificate", type=InputFile())
@json_option
def command(instance: str, certificate: str, as_json: bool) -> Answer:
    """Check that CERTIFICATE proves its lower bound on the total cost of plans for all robots of INSTANCE.

    The least cost with prices of each robot is found anew, in whole numbers, by code that shares nothing with the
    search for the prices.

    Exit codes: 0 the bound is proved, 1 it is not, 2 bad input.
    """
    from carp_verify.verify_bound import verify_bound  # noqa: PLC0415 - only for those who ask

    refuse_two_standard_inputs(instance, certificate)
    problem = read_instance_file(instance)
    data = read_bytes(certificate)
    with naming(certificate):
        document = read_bound(data)
    try:
        bound = verify_bound(problem, document)
    except Refusal as refusal:
        if as_json:
            print_document(write(VerifiedBoundDocument(None, refusal.path, refusal.rule, refusal.message)))
        else:
            print_line(f"not proved: {refusal}")
        return Answer.NO
    if as_json:
        print_document(write(VerifiedBoundDocument(bound, None, None, None)))
        return Answer.YES
    prices = len(document.resources) + len(document.exchanges)
    row = [bound, len(document.robots), prices, len(document.cuts), document.horizon]
    print_table(COLUMNS, [row], numbers=COLUMNS)
    for robot, least in document.robots:
        if least is None:
            print_line(f"robot {robot} has no way to its goal: the bound is that of the others")
    return Answer.YES
