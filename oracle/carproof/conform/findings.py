"""Faults of answers, and the rules of programs besides those of plans: `program/...`."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from carp_spec import RobotId, Rule, Violation
from carp_spec.rule import DESIGN, rule
from carproof.input_rules import Code

LEAST_ANSWERED = 90
"""In 100 random cases of an op. The cases are small, so a program that offers the op can answer nearly all of them. Two
in three have two robots or more, so a program that answers only the easy ones stays far below."""
LEAST_TRIED = 50
"""In 100 random cases of an op in which there is something to do. A sound planner may miss plans; one that misses most
of them, where four robots at most are on a map of six resources, has shown nothing."""


class Category(StrEnum):
    """The ways in which a program fails a case."""

    WRONG_ANSWER = "wrong answer"
    CRASH = "crash"
    TIMEOUT = "timeout"
    PROTOCOL_ERROR = "protocol error"


@dataclass(frozen=True, slots=True)
class Finding:
    """A fault: its category, its rule and one sentence; of a process also the end of its standard error."""

    category: Category
    rule: str
    message: str
    stderr: str = ""

    @property
    def key(self) -> tuple[Category, str]:
        """The part that two findings of one fault share."""
        return (self.category, self.rule)


class Fault(Exception):  # noqa: N818 - a program's fault, not an error of ours
    """A program gave no answer that can be judged."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding)
        self.finding = finding


def wrong(rule: str, message: str) -> Finding:
    """A wrong answer."""
    return Finding(Category.WRONG_ANSWER, rule, message)


def broken(violations: Iterable[Violation]) -> Iterator[Finding]:
    """Plans that break rules, as wrong answers."""
    return (wrong(violation.rule, violation.message) for violation in violations)


@rule("program/alive", "A program answers until it is asked to stop, and then it ends with 0.", DESIGN)
def is_alive(code: int) -> bool:
    """Whether a process that ended with this exit code, once it was asked to stop, has kept it."""
    return code == 0


IN_TIME = Code("program/in-time", "Each answer is complete within the time limit, however it arrives.", DESIGN)


@rule(
    "program/response",
    "A response is one line of JSON: an object with the request's id and one of result, skipped and error.",
    DESIGN,
)
def is_response(fields: set[str]) -> bool:
    """Whether these are the fields of a response."""
    return fields in ({"id", "result"}, {"id", "skipped"}, {"id", "error"})


RIGHT_RESULT = Code(
    "program/result",
    "A result has the fields and types of its op; documents obey document/shape, other formats their own rules.",
    DESIGN,
)


@rule("program/accepts", "A right request is answered by a result or skipped, never by an error.", DESIGN)
def is_accepted(error: object) -> bool:
    """Whether there is no error."""
    return error is None


@rule("program/optimal", "The cost given as the optimum is the least total cost of plans for all robots.", DESIGN)
def is_optimal(cost: int | None, least: int | None) -> bool:
    """Whether the cost is the least; `None` is that there are no plans for all robots."""
    return cost == least


@rule(
    "program/complete",
    "A planner of whole instances leaves robots without a plan only where not all robots can have one.",
    DESIGN,
)
def is_complete(unplanned: int, least: int | None) -> bool:
    """Whether this many robots may be unplanned; `least` is the least total cost, `None` if not all can have plans."""
    return unplanned == 0 or least is None


@rule(
    "program/lower",
    "A lower bound that a program gives is at most the least total cost of plans for all robots.",
    DESIGN,
)
def is_lower(bound: int, least: int | None) -> bool:
    """Whether the bound is not above the least total cost; `None` is that there are no plans for all robots."""
    return least is None or bound <= least


@rule(
    "program/answers",
    "A program shows a level by answering all smoke cases that it can be asked, and at least "
    f"{LEAST_ANSWERED} in 100 random cases of each op that it offers. To skip a case or to leave it undecided is no "
    "answer.",
    DESIGN,
)
def answers_enough(answered: int, asked: int) -> bool:
    """Whether this many answers are enough of this many random cases of one op."""
    return 100 * answered >= LEAST_ANSWERED * asked


@rule(
    "program/tries",
    f"A program gives up at most {100 - LEAST_TRIED} in 100 random cases of each op in which there is something to do. "
    "To give up is to have no plan where there is one, to plan at most half as many robots as CARP, to better no "
    "plan where carproof does, or to have a bound below what the robots need alone.",
    DESIGN,
)
def tries_enough(tried: int, gave_up: int) -> bool:
    """Whether this many tries are enough of the random cases of one op that have an answer."""
    return 100 * tried >= LEAST_TRIED * (tried + gave_up)


@rule("program/ready", "An executor lets only robots enter that are ready to go on, each of them once.", DESIGN)
def are_ready(entering: Sequence[RobotId], ready: Sequence[RobotId]) -> bool:
    """Whether these robots may be named."""
    return set(entering) <= set(ready) and len(set(entering)) == len(entering)


@rule(
    "program/arrives",
    "An executor lets each robot arrive: until all have, some robot enters a visit within as many ticks as the plans "
    "and all delays take together, in which all arrive in the planned order.",
    DESIGN,
)
def all_arrive(standing: Sequence[RobotId]) -> bool:
    """Whether no robot stands for ever."""
    return not standing


RIGHT_QUESTIONS = Code(
    "program/questions",
    "A function is judged; the level and the features left out are known ones, and the number of examples and the seed "
    "are whole numbers of at least 0.",
    DESIGN,
)
PROGRAM_RULES: tuple[Rule[..., Any] | Code, ...] = (
    is_alive,
    RIGHT_QUESTIONS,
    IN_TIME,
    is_response,
    RIGHT_RESULT,
    is_accepted,
    is_optimal,
    is_complete,
    is_lower,
    answers_enough,
    tries_enough,
    are_ready,
    all_arrive,
)
