"""`carproof release`: which further resources robots may be granted so that everybody can still finish."""

import click

from carp_spec import Refusal
from carp_spec.documents.decoding import write
from carp_spec.documents.solutions import read_trace
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, naming, read_file, read_sound
from carproof.command_line.options import instance_argument, listed, output_options, solution_argument, trace_argument
from carproof.command_line.tables import counted, print_line, print_table
from carproof.command_line.time_left import time_left
from carproof.execution.release_documents import (
    GrantsVerdictDocument,
    ReleaseDocument,
    grants_verdict_document,
    read_grants,
    released_document,
)
from carproof.execution.releasing import MOST_STATES, Releasing, limit_of

MOST_SHOWN = 8
"""The resources of a grant that are printed."""
ANSWERS = {"safe": Answer.YES, "unsafe": Answer.NO, "undecided": Answer.UNDECIDED}


@listed(
    "Tell which resources robots may be granted next.",
    "carproof release town.json plans.json trace.json",
    "carproof release town.json plans.json trace.json --beyond",
    "carproof release town.json plans.json trace.json --grants wanted.json",
    "carproof release town.json plans.json trace.json --beyond --seconds 10",
)
@instance_argument
@solution_argument
@trace_argument
@click.option("--beyond", is_flag=True, help="Tell also what each robot may have alone, whatever the planned order.")
@click.option("--grants", type=InputFile(), help="Tell whether these grants, a document, are safe together.")
@click.option(
    "--states",
    type=click.IntRange(min=1),
    help=f"The most states of a search.  [default: {MOST_STATES}, or none with --seconds]",
)
@click.option("--seconds", type=float, help="The time of the whole command.")
@output_options
@click.pass_context
def command(  # noqa: PLR0913 - one parameter for each argument and option
    context: click.Context,
    *,
    instance: str,
    solution: str,
    trace: str,
    beyond: bool,
    grants: str | None,
    states: int | None,
    seconds: float | None,
    output: Output,
) -> Answer:
    """Tell which further resources of their plans robots may be granted at TRACE, so that everybody can still finish.

    Robots hold the resources that they are in and those that they have been granted; each drives along its plan of
    SOLUTION, in any order with the others. By the planned order all robots may have what is listed, together. With
    --beyond, a search decides what each robot may have alone while the others get nothing. With --grants, it decides
    whether grants are safe, and shows how everybody finishes, or which robots are in each other's way for ever.

    A search that would look at more than --states states for one question is cut off, and its answer is undecided. With
    --seconds, answers that are not found in this time are undecided; what the order grants is listed in any case.

    Exit codes: 0 listed, or the grants are safe, 1 they are not, 2 bad input, 3 undecided.
    """
    if beyond and grants is not None:
        raise click.UsageError("--beyond lists grants, and --grants asks about some: give one of them.")
    problem, sound = read_sound(instance, solution)
    done = read_file(trace, read_trace)
    limit = limit_of(states, time_left(context, seconds))
    try:
        situation = Releasing(problem, sound, done)
    except Refusal as refusal:
        with naming(solution if refusal.kind == "request" else trace):
            raise
    if grants is not None:
        wanted = read_file(grants, read_grants)
        with naming(grants):
            verdict = grants_verdict_document(problem, situation.check(wanted, *limit))
        if output.write(write(verdict)):
            print_line(_sentence(verdict, states, seconds))
        return ANSWERS[verdict.answer]
    robots = [plan.robot for plan in sound.plans] if beyond else []
    document = released_document(situation.released(robots, *limit))
    if output.write(write(document)):
        _show(document)
    is_decided = all(each.answer != "undecided" for each in document.beyond)
    return Answer.YES if is_decided else Answer.UNDECIDED


def _show(document: ReleaseDocument) -> None:
    columns, rows = ["robot", "by the order, all together"], []
    if document.beyond:
        columns += ["alone", "but not", "because of"]
    for number, grant in enumerate(document.in_order):
        row: list[object] = [grant.robot, _resources(grant.resources)]
        if document.beyond:
            alone = document.beyond[number]
            because = ", ".join(map(str, alone.robots)) or ("undecided" if alone.answer == "undecided" else "-")
            row += [_resources(alone.resources), "-" if alone.next is None else alone.next, because]
        rows.append(row)
    print_table(columns, rows)
    if not document.follows:
        print_line("the robots have left the planned order, which grants nothing more")


def _resources(resources: tuple[object, ...]) -> str:
    shown = ", ".join(map(str, resources[:MOST_SHOWN]))
    more = len(resources) - MOST_SHOWN
    return (shown or "-") + (f" and {more} more" if more > 0 else "")


def _sentence(document: GrantsVerdictDocument, states: int | None, seconds: float | None) -> str:
    if document.answer == "undecided":
        most = MOST_STATES if states is None and seconds is None else states
        limits = [*([] if most is None else [counted(most, "state")]), *([] if seconds is None else [f"{seconds:g} s"])]
        return f"undecided within {' and '.join(limits)}"
    if document.answer == "safe":
        how = "in the planned order" if document.by_order else f"by {counted(len(document.moves or ()), 'move')}"
        return f"safe: everybody can finish {how}"
    robots = ", ".join(map(str, document.robots or ()))
    if document.places is not None:
        return f"not safe: the robots {robots} never all finish, even without the others"
    places = ", ".join(map(str, document.resources or ()))
    return f"not safe: the robots {robots} are more than the {document.capacity} for whom there is room in {places}"
