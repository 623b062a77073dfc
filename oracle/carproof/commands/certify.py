"""`carproof certify`: check a solution, and let z3 confirm that plans keep capacities and avoid exchanges."""

import json
from dataclasses import asdict
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document, require_following_in
from carproof.command_line.foreign import Problem, solution_files
from carproof.command_line.options import examples, json_option
from carproof.command_line.tables import counted, print_line, remark
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_verify.certificate import Certificate


@click.command(
    short_help="Check plans, with z3's second opinion.",
    epilog=examples(
        "carproof certify town.json plans.json",
        "carproof plan town.json --json | carproof certify town.json -",
        "carproof certify --map town.map --scen town.scen result.txt",
    ),
)
@solution_files
@json_option
def command(problem: Problem, as_json: bool) -> Answer:
    """Check SOLUTION, in any format, and let z3 confirm that its plans keep capacities and avoid exchanges.

    A solution that breaks a rule of single plans or of the list of plans is refused, as by check. Otherwise z3 shows
    for each resource that it is too full at no tick at all, and for each pair of resources that no two robots exchange
    it. This is a second opinion on the rules joint/capacity and joint/exchange, by other means than check. If there is
    such a tick, it is named, with the robots.

    Exit codes: 0 certified, 1 refused, 2 bad input, 3 z3 could not tell.
    """
    instance, solution = problem.read(as_named=True)
    require_following_in(problem.names[0], instance)
    from carp_verify.certificate import certify  # noqa: PLC0415 - loads z3
    from carp_verify.lemmas.smt import Undecided  # noqa: PLC0415

    visited = {visit.resource for plan in solution.plans for visit in plan.visits} & instance.graph.resource.keys()
    started = perf_counter()
    try:
        with progress("certifying", len(visited)) as advance:
            certificate = certify(instance, solution, advance)
    except Undecided as undecided:
        remark(f"Undecided: {undecided}.")
        return Answer.UNDECIDED
    if as_json:
        print_document(document(certificate))
    else:
        for broken in (*certificate.violations, *certificate.breaches):
            print_line(str(broken))
        print_line(f"{summary(certificate)} in {perf_counter() - started:.1f} s")
    return Answer.of(certificate.accepted)


def summary(certificate: "Certificate") -> str:
    """The outcome in a line."""
    asked = f"{certificate.resources} resources and {certificate.pairs} pairs of resources"
    if certificate.accepted:
        return f"certified: check finds no rule broken, and z3 no tick too full and no exchange in {asked}"
    if certificate.violations:
        return "REFUSED: check finds a rule broken, and z3 was not asked"
    return f"REFUSED: z3 finds {counted(len(certificate.breaches), 'tick')} at which a rule is broken in {asked}"


def document(certificate: "Certificate") -> bytes:
    """The certificate as one JSON document."""
    return json.dumps({"accepted": certificate.accepted, **asdict(certificate)}).encode() + b"\n"
