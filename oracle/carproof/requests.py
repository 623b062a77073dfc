"""The rules of requests, which command line and protocol check before a planner sees them: `request/...`.

Refusals name paths in the wrong document: `$.plans[2].visits[0]`.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from time import perf_counter

from carp_spec import Instance, Refusal, RobotId, Solution
from carp_spec.requests import require_robot, sound_solution
from carp_spec.rule import DESIGN
from carproof.input_rules import Code

KNOWN_ROBOT = Code(
    "request/robot",
    "The robot asked for is one of the instance; one to be added has no plan yet, and one to get stops has not left.",
    DESIGN,
)
TICK = Code("request/now", "The tick now is a whole number of at least 0.", DESIGN)
SOUND_PLANS = Code(
    "request/plans",
    "The plans to which a query or a new robot is put break no rule; of the robot itself that a query is for, only "
    "the plan alone. A robot that the solution does not name counts as unplanned.",
    DESIGN,
)
POSITIVE_LIMIT = Code(
    "request/limit",
    "The limit of a search, in seconds or steps, is a number above 0. Functions for optima, bounds and gaps also take "
    "0, and end at once. Of processes there are one or two.",
    DESIGN,
)
PAST_LOG = Code("log/now", "Nothing in a log happens after its tick now.", DESIGN)
REQUEST_RULES: tuple[Code, ...] = (KNOWN_ROBOT, TICK, SOUND_PLANS, POSITIVE_LIMIT, PAST_LOG)

LONGEST = 10**9
"""More seconds than anybody waits; a float cannot hold each larger number."""


def deadline(seconds: object) -> float:
    """The tick of `perf_counter` at which so many seconds are over (`None`: never); raises `Refusal` for wrong ones."""
    if seconds is None:
        return inf
    if (type(seconds) is int or type(seconds) is float) and 0 < seconds < inf:
        return perf_counter() + min(seconds, LONGEST)
    raise Refusal("option", "$.seconds", POSITIVE_LIMIT.id, f"it must be a number above 0, not {seconds!r}")


def robot_called(instance: Instance, name: str) -> RobotId:
    """The robot whose id prints like the name; raises `Refusal` if none exists, or if `1` and `"1"` both do."""
    called = [robot.id for robot in instance.robots if str(robot.id) == name]
    if len(called) > 1:
        message = f"a robot's id must differ from the others when printed, and {len(called)} print as {name}"
        raise Refusal("request", "ROBOT", KNOWN_ROBOT.id, message)
    id = called[0] if called else name
    require_robot(instance, id, "ROBOT")
    return id


def whole_number(text: str) -> int | None:
    """The number that a text of digits stands for; `None` for other text, and for more digits than Python reads."""
    try:
        return int(text) if text.isascii() and text.isdigit() else None
    except ValueError:
        return None


@contextmanager
def inside(prefix: str) -> Iterator[None]:
    """Put the paths of refusals below a prefix: `$.graph` inside `$.instance` is `$.instance.graph`."""
    try:
        yield
    except Refusal as refusal:
        raise below(prefix, refusal) from refusal


def below(prefix: str, refusal: Refusal) -> Refusal:
    """The refusal with its path below a prefix; one of an option stays, because options stand beside the documents."""
    if refusal.kind == "option":
        return refusal
    path = prefix + refusal.path.removeprefix("$")
    return Refusal(refusal.kind, path, refusal.rule, refusal.message)


def document_of(refusal: Refusal) -> str | None:
    """The document that a planner refuses; `None` if it is a field of the request beside the documents."""
    part = re.match(r"\$\.(graph|robots|plans)\b", refusal.path)
    return None if part is None else "solution" if part[1] == "plans" else "instance"


@contextmanager
def inside_documents() -> Iterator[None]:
    """Put the paths of a planner's refusals below the instance or the solution of the request, where they are of one.

    `$.graph` becomes `$.instance.graph`, and `$.now` stays.
    """
    try:
        yield
    except Refusal as refusal:
        document = document_of(refusal)
        raise below("$" if document is None else f"$.{document}", refusal) from refusal


def sound_within(instance: Instance, solution: Solution, asked: RobotId | None = None) -> Solution:
    """The completed solution of a request's field `solution`, as `sound_solution` has it."""
    with inside("$.solution"):
        return sound_solution(instance, solution, asked)
