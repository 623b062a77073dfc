"""`carproof dev crosscheck`: both planners asked random questions up to the first difference, which is made smaller."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import click
import msgspec

import carp_optimized
import carp_reference
from carp_spec import Instance, Solution
from carp_spec.documents.solutions import solution_document
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, print_document
from carproof.command_line.options import listed, output_options
from carproof.command_line.tables import print_line
from carproof.conform.cases import Case, planned_by, request_fields
from carproof.conform.smaller import smallest
from carproof.progress import progress
from carproof.testing.random_instances import Question, question


@dataclass(frozen=True, slots=True)
class Answers:
    """What both planners answer to a question: `plan`, or `add` for a robot in a fleet under way."""

    case: Case
    reference: Solution
    optimized: Solution


@listed(
    "Ask both engines the same random questions.",
    "carproof dev crosscheck --examples 10000",
    "carproof dev crosscheck --seed 7 -o difference.json",
)
@click.option("--examples", "count", type=click.IntRange(min=1), default=1000, help="The number of random questions.")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="The seed of the questions.")
@output_options
def command(count: int, seed: int, output: Output) -> Answer:
    """Ask both engines the same questions, and stop at the first difference.

    Random instances are planned by every planner that both engines have, and robots are added to fleets under way. A
    difference is made smaller; its document holds the question, as a request, and both answers.

    Exit codes: 0 no difference, 1 a difference, 2 bad usage.
    """
    with progress("asking both engines", count) as advance:
        difference = first_difference(count, seed, advance)
    written = msgspec.json.encode(document(difference)) + b"\n"
    if output.write(written):
        print_line(f"{count} questions: " + ("no difference" if difference is None else "A DIFFERENCE"))
        if difference is not None and output.file is None:
            print_document(written)
    return Answer.of(difference is None)


def first_difference(count: int, seed: int, advance: Callable[[], None] = lambda: None) -> Answers | None:
    """Ask both engines random questions; returns the first on which they differ, made as small as it goes."""
    for number in range(count):
        case = case_of(question(seed, number))
        if differ(case):
            return ask(smallest(case, differ, lambda: False)[0])
        advance()
    return None


def differ(case: Case) -> bool:
    """Whether the engines answer differently."""
    answers = ask(case)
    return answers.reference != answers.optimized


def case_of(question: Question) -> Case:
    """The question as a request."""
    subject, planner = question
    if isinstance(subject, Instance):
        return Case("random", "plan", "plan", subject, planner=planner)
    return Case("random", "add", "add", subject.instance, subject.solution, subject.robot, subject.now, planner)


def ask(case: Case) -> Answers:
    """Ask both engines."""
    return Answers(case, planned_by(carp_reference, case), planned_by(carp_optimized, case))


def document(answers: Answers | None) -> dict[str, Any]:
    """The question as a request, and both answers; `agree` alone where there is no difference."""
    if answers is None:
        return {"agree": True}
    return {
        "agree": False,
        "question": {"op": answers.case.op, **request_fields(answers.case)},
        "reference": solution_document(answers.reference),
        "optimized": solution_document(answers.optimized),
    }
