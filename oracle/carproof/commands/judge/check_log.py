"""`carproof check-log`: whether what robots did breaks a rule, with no plans to compare it with."""

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import astuple

import click
import msgspec

from carp_spec.check import MOST_LISTED
from carp_spec.documents.decoding import write
from carp_spec.documents.verdicts import ViolationDocument
from carp_spec.execution.logs import judge_log
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, naming, print_document, read_bytes, read_instance_file, shown
from carproof.command_line.options import json_option, listed
from carproof.command_line.output import show_violations
from carproof.command_line.tables import print_line, print_table, say
from carproof.formats.logs import LOGS, read_log, read_log_on_map
from carproof.formats.movingai import read_map

FORMATS = "; ".join(f"{name}: {about}" for name, about in LOGS.items())


@listed(
    "Check what robots did, without plans.",
    "carproof check-log town.json log.json",
    "carproof check-log town.json log.csv --from csv",
    "carproof check-log --map random-32-32-20.map output.json --from league",
    "carproof check-log --map sorting.map paths.txt --from rhcr --served",
)
@click.argument("files", metavar="[INSTANCE] LOG", nargs=-1, required=True, type=InputFile())
@click.option("--from", "format", type=click.Choice([*LOGS]), default="trace", help=f"The format of LOG. {FORMATS}.")
@click.option(
    "--map", type=InputFile(), help="A MovingAI map, in place of INSTANCE; robots and stops are those of LOG."
)
@click.option("--served", is_flag=True, help="List the stops served.")
@click.option("--all", "everything", is_flag=True, help="List every violation, however many there are.")
@json_option
def command(
    *, files: Sequence[str], format: str, map: str | None, served: bool, everything: bool, as_json: bool
) -> Answer:
    """Check what robots did up to a tick, from whatever system: LOG, against INSTANCE or on a map.

    Robots keep the rules of plans, but may be under way. For each violation it says who, where, when and by which
    rule, and it counts the stops served so far.

    Exit codes: 0 no rule is broken, 1 a rule is broken, 2 bad input.
    """
    if len(files) != 1 + (map is None):
        raise click.UsageError("Give INSTANCE and LOG, or --map and LOG.")
    data, name = read_bytes(files[-1]), shown(files[-1])
    if map is None:
        instance = read_instance_file(files[0])
        with naming(files[-1]) if format == "trace" else nullcontext():  # the others name it with the line
            log = read_log(data, instance, format, name)
    else:
        instance, log = read_log_on_map(data, read_map(read_bytes(map, map=True), shown(map)), format, name)
    most = None if everything else MOST_LISTED
    with naming(files[-1]):
        verdict = judge_log(instance, log, most)
    rows = [astuple(each) for each in verdict.served]
    if as_json:
        violations = msgspec.convert(verdict.violations, tuple[ViolationDocument, ...], from_attributes=True)
        document = {"valid": verdict.valid, "now": log.now, "done": verdict.done, "cost": verdict.cost}
        print_document(write({**document, "served": rows, "violations": violations}))
        return Answer.of(verdict.valid)
    show_violations(verdict.violations, most)
    if served:
        table = [(*others, "-" if leave is None else leave) for *others, leave in rows]
        print_table(["robot", "stop", "resource", "from", "to"], table, numbers=["stop", "from", "to"])
        say()
    stops = sum(len(robot.stops) for robot in instance.robots)
    found = f"{len(rows)} of {stops} stops served, {verdict.done} of {len(instance.robots)} robots done"
    print_line(f"{'no rule is broken' if verdict.valid else 'INVALID'} by tick {log.now}: {found}")
    return Answer.of(verdict.valid)
