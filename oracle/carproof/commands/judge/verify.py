"""`carproof verify`: check a certificate or a proof that a command or another program wrote."""

from pathlib import Path
from typing import NoReturn

import click

from carp_spec import Instance
from carp_spec.documents.bounds import read_bound
from carp_spec.documents.decoding import write
from carp_spec.documents.query_certificates import read_query_certificate
from carp_spec.limits import refuse_stops
from carproof.command_line.answer import Answer
from carproof.command_line.files import (
    InputFile,
    naming,
    print_document,
    read_file,
    read_instance_file,
    read_solution_file,
)
from carproof.command_line.options import json_option, kernel_option, listed
from carproof.command_line.tables import print_line, print_table
from carproof.extras import require
from carproof.judging.verdicts import verify_bound, verify_proof, verify_query
from carproof.optima import ProofDocument, proof_document

OF_BOUND = ("lower bound", "robots", "prices", "cuts", "deadlines", "horizon", "decided by")
OF_QUERY = ("robot", "now", "earliest arrival", "labels", "decided by")
OF_OPTIMUM = ("least cost", "robots", "refutation", "z3 at the cost", "z3 below it")
MOST_FILES = 3
FORMS = "carproof verify FOLDER, INSTANCE BOUND, or INSTANCE SOLUTION QUERY-CERTIFICATE"


@listed(
    "Check a certificate or a proof directory.",
    "carproof verify town.json bound.json",
    "carproof verify town.json plans.json r7.json --kernel",
    "carproof verify proof",
    "carproof bound town.json --json | carproof verify town.json -",
)
@click.argument("files", nargs=-1, required=True, type=InputFile(folders=True), metavar="[INSTANCE [SOLUTION]] FILE")
@click.option("--instance", type=InputFile(), hidden=True)
@kernel_option
@json_option
def command(*, files: tuple[str, ...], instance: str | None, kernel: bool, as_json: bool) -> Answer:
    """Check that FILE proves what it claims.

    A lower bound (`carproof bound -o`) is about INSTANCE: no plans of all its robots cost less. The least priced cost
    of each robot is computed again by code that shares nothing with the search for the prices.

    The certificate of a query (`carproof query --certificate`) is about INSTANCE and SOLUTION: no lawful plan of its
    robot beside the others' plans arrives before its bound. Such a plan keeps the visits that the robot has made.

    A folder (`carproof optimum --proof`) proves the least total cost of its own instance, or that there are no plans
    of all; with INSTANCE it must be about that one. Its formulas are made again, its plans are judged, its refutation
    is checked step by step, and z3 is asked too. Where the proved kernel is built, it must accept the refutation too.

    With --kernel the proved kernel decides too, and must agree.

    Exit codes: 0 proved, 1 not proved, 2 bad input, 3 undecided.
    """
    files = (*(() if instance is None else (instance,)), *files)
    *others, file = files
    if len(files) > MOST_FILES:
        _refuse(f"there are {len(files)} files")
    if Path(file).is_dir():
        if len(others) > 1:
            _refuse("a proof directory needs no solution")
        return _proof(Path(file), read_instance_file(others[0]) if others else None, kernel, as_json)
    if not others:
        _refuse("a certificate needs its instance")
    problem = read_instance_file(others[0])
    if kernel and len(others) == 1:
        with naming(others[0]):
            refuse_stops(problem)
    if len(others) > 1:
        return _query(problem, others[1], file, kernel, as_json)
    return _bound(problem, file, kernel, as_json)


def _refuse(what: str) -> NoReturn:
    raise click.UsageError(f"{what}; write {FORMS}.", click.get_current_context())


def _bound(problem: Instance, file: str, kernel: bool, as_json: bool) -> Answer:
    document = read_file(file, read_bound)
    verdict = verify_bound(problem, document, kernel)
    if as_json:
        print_document(write(verdict))
    elif verdict.bound is None:
        print_line(f"not proved: {verdict.path}: {verdict.reason} [{verdict.rule}]")
    else:
        prices = len(document.resources) + len(document.exchanges) + len(document.groups)
        groups = [len(document.cuts), len(document.deadlines)]
        row = [verdict.bound, len(document.robots), prices, *groups, document.horizon, verdict.by]
        print_table(OF_BOUND, [row], numbers=OF_BOUND[:-1])
        for robot, least in document.robots:
            if least is None:
                print_line(f"robot {robot} has no way to its goal: the bound is that of the others")
    return Answer.of(verdict.bound is not None)


def _query(problem: Instance, solution: str, file: str, kernel: bool, as_json: bool) -> Answer:
    given = read_solution_file(solution)
    document = read_file(file, read_query_certificate)
    verdict = verify_query(problem, given, document, kernel)
    if as_json:
        print_document(write(verdict))
    elif verdict.proved:
        arrival = "never" if document.bound is None else document.bound
        row = [document.robot, document.now, arrival, sum(len(layer.labels) for layer in document.layers), verdict.by]
        print_table(OF_QUERY, [row], numbers=OF_QUERY[1:4])
    else:
        print_line(f"not proved: {verdict.path}: {verdict.reason} [{verdict.rule}]")
    return Answer.of(verdict.proved)


def _proof(folder: Path, given: Instance | None, kernel: bool, as_json: bool) -> Answer:
    require("z3")
    from carp_verify.optimum.proof import ProofError  # noqa: PLC0415 - loads the encoder

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
        row = [verified.cost, len(verified.solution.plans), "checked", verified.z3_reach, verified.z3_beat]
        print_table(OF_OPTIMUM, [row], numbers=OF_OPTIMUM[:2])
    if kernel and not as_json:
        print_line(f"decided by {by}")
    if reason is not None and not as_json:
        print_line(f"undecided: {reason}")
    return Answer.YES if verified.is_decided else Answer.UNDECIDED
