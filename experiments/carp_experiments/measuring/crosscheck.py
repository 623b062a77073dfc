"""`carproof dev crosscheck`: both planners asked random questions, until the first difference, which is shrunk."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from itertools import chain, repeat
from typing import Any

import click
import msgspec

import carp_optimized
import carp_reference
from carp_spec import Instance, Neighbourhood, Planner, RobotId, Solution
from carp_spec.documents.instances import instance_document
from carp_spec.documents.solutions import solution_document
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, hypothesis_elsewhere, print_document
from carproof.command_line.options import listed, output_options
from carproof.command_line.tables import print_line
from carproof.extras import require
from carproof.progress import progress
from carproof.testing.random_instances import Draw, Question, draw_question

MOST_NUMBERS = 400  # a question is drawn with fewer


@dataclass(frozen=True, slots=True)
class Difference:
    """A question and the two answers: `plan` if there is no robot, else `add` to `before` at `now`."""

    instance: Instance
    planner: Planner
    robot: RobotId | None
    before: Solution | None
    now: int
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
    difference is shrunk; its document holds the question and both answers.

    Exit codes: 0 no difference, 1 a difference, 2 bad usage.
    """
    require("hypothesis")
    with hypothesis_elsewhere(), progress("asking both engines", count) as advance:
        difference = first_difference(count, seed, advance)
    written = msgspec.json.encode(document(difference)) + b"\n"
    if output.write(written):
        print_line(f"{count} questions: " + ("no difference" if difference is None else "A DIFFERENCE"))
        if difference is not None and output.file is None:
            print_document(written)
    return Answer.of(difference is None)


def first_difference(count: int, seed: int, advance: Callable[[], None] = lambda: None) -> Difference | None:
    """Ask both engines random questions; returns the first on which they differ, shrunk by hypothesis."""
    import hypothesis  # noqa: PLC0415 - slow to load
    from hypothesis import strategies as st  # noqa: PLC0415

    found: list[Difference] = []
    options = hypothesis.settings(
        max_examples=count,
        deadline=None,
        database=None,
        derandomize=False,
        suppress_health_check=list(hypothesis.HealthCheck),
        report_multiple_bugs=False,
    )

    @hypothesis.seed(seed)
    @options
    @hypothesis.given(st.binary(max_size=MOST_NUMBERS))
    def agree(numbers: bytes) -> None:
        difference = ask(draw_question(Draw(chain(numbers, repeat(0)))))
        advance()
        if difference.reference != difference.optimized:
            found.append(difference)
            raise AssertionError

    try:
        agree()
    except AssertionError:
        return found[-1]
    return None


def ask(question: Question) -> Difference:
    """Ask both engines."""
    subject, planner = question
    if isinstance(subject, Instance):
        answers = carp_reference.plan(subject, planner), carp_optimized.plan(subject, planner)
        return Difference(subject, planner, None, None, 0, *answers)
    assert isinstance(planner, Neighbourhood)  # noqa: S101 - a promise of ours
    asked = (subject.instance, subject.solution, subject.robot, subject.now, planner)
    answers = carp_reference.add(*asked), carp_optimized.add(*asked)
    return Difference(subject.instance, planner, subject.robot, subject.solution, subject.now, *answers)


def document(difference: Difference | None) -> dict[str, Any]:
    """The question and both answers; `agree` alone where there is no difference."""
    if difference is None:
        return {"agree": True}
    planner = {"planner": difference.planner.name, **asdict(difference.planner)}
    question = {"instance": instance_document(difference.instance), **planner}
    if difference.before is not None:
        before = solution_document(difference.before)
        question |= {"solution": before, "robot": difference.robot, "now": difference.now}
    return {
        "agree": False,
        "question": question,
        "reference": solution_document(difference.reference),
        "optimized": solution_document(difference.optimized),
    }
