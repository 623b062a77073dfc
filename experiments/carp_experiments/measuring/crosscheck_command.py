"""`carproof dev crosscheck`: the optimised planner against the reference."""

from dataclasses import asdict
from typing import Any

import click
import msgspec

from carp_experiments.measuring.crosscheck import Difference, first_difference
from carp_spec.documents.instances import instance_document
from carp_spec.documents.solutions import solution_document
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, hypothesis_elsewhere, print_document
from carproof.command_line.options import examples, output_options
from carproof.command_line.tables import print_line
from carproof.extras import require
from carproof.progress import progress


@click.command(
    short_help="Ask both engines the same random questions.",
    epilog=examples("carproof dev crosscheck --examples 10000", "carproof dev crosscheck --seed 7 -o difference.json"),
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


def document(difference: Difference | None) -> dict[str, Any]:
    """The question and both answers; `agree` alone where there is no difference."""
    if difference is None:
        return {"agree": True}
    planner = {"planner": difference.planner.name, **asdict(difference.planner)}
    question = {"instance": instance_document(difference.instance), **planner}
    if difference.before is not None:
        before = solution_document(difference.before)
        question |= {"solution": before, "robot": difference.robot, "now": difference.now}
    answers = {
        "reference": solution_document(difference.reference),
        "optimized": solution_document(difference.optimized),
    }
    return {"agree": False, "question": question, **answers}
