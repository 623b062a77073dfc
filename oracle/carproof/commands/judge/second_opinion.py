"""The second opinion of `carproof check --z3`: z3 confirms that plans keep capacities and avoid exchanges."""

import json
from dataclasses import asdict
from time import perf_counter
from typing import TYPE_CHECKING

from carp_spec import Instance, Solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.tables import counted, print_line, remark
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_verify.certificate import Certificate


def certified(instance: Instance, solution: Solution, as_json: bool) -> Answer:
    """Print what z3 says of a solution that `check` accepts: too full at no tick at all, and no exchange."""
    from carp_verify.certificate import certify, visited  # noqa: PLC0415 - loads z3
    from carp_verify.lemmas.smt import Undecided  # noqa: PLC0415

    started = perf_counter()
    try:
        with progress("certifying", len(visited(instance, solution.plans))) as advance:
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
    asked = f"{certificate.resources} resources and groups and {certificate.pairs} pairs of them"
    if certificate.accepted:
        return f"certified: check finds no rule broken, and z3 no tick too full and no exchange in {asked}"
    if certificate.violations:
        return "REFUSED: check finds a rule broken, and z3 was not asked"
    return f"REFUSED: z3 finds {counted(len(certificate.breaches), 'tick')} at which a rule is broken in {asked}"


def document(certificate: "Certificate") -> bytes:
    """The certificate as one JSON document."""
    return json.dumps({"accepted": certificate.accepted, **asdict(certificate)}).encode() + b"\n"
