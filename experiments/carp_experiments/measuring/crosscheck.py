"""The two planners against each other on random instances, until the first difference, which is shrunk."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain, repeat

import carp_optimized
import carp_reference
from carp_spec import Instance, Neighbourhood, Planner, RobotId, Solution
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


def first_difference(examples: int, seed: int, advance: Callable[[], None] = lambda: None) -> Difference | None:
    """Ask both engines random questions; returns the first on which they differ, shrunk by hypothesis."""
    import hypothesis  # noqa: PLC0415 - slow to load
    from hypothesis import strategies as st  # noqa: PLC0415

    found: list[Difference] = []
    options = hypothesis.settings(
        max_examples=examples,
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
