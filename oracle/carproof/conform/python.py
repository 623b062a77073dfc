"""Python functions that plan, judged: for tests and scripts."""

from collections.abc import Callable, Collection, Sequence
from typing import Any, Literal, TypeAlias, cast

from carp_spec import Instance, Refusal, Solution
from carp_spec.inputs.options import require_limits
from carp_spec.rule import is_between
from carp_spec.shapes import require_each
from carproof.conform.cases import Case
from carproof.conform.findings import RIGHT_QUESTIONS
from carproof.conform.judging.claims import FEATURES, Claims
from carproof.conform.levels import EXAMPLES, LARGE_SECONDS, LEVELS, WHOLE_LEVELS
from carproof.conform.programs.function import Function
from carproof.conform.run import Options, Report, conform

LevelName: TypeAlias = Literal["sound", "complete-in-context", "context-optimal", "complete", "optimal"]
"""The levels of functions, which plan whole instances."""


def conforms(  # noqa: PLR0913 - the options of the command
    planner: Callable[[Instance], Solution] | Callable[[dict[str, Any]], dict[str, Any]],
    level: LevelName = "sound",
    examples: int = EXAMPLES,
    seed: int = 0,
    documents: bool = False,
    *,
    without: Collection[str] = (),
    solvable: bool = False,
    groups: bool = False,
    stops: bool = False,
    large: float = LARGE_SECONDS,
    saved: Sequence[Case] = (),
) -> Report:
    """Judge a planner that takes an `Instance` and returns a `Solution`, as `carproof conform` judges a program.

    With `documents`, it takes and returns the documents, as dictionaries. `without` names features that it is not
    asked, and with `solvable` all robots can have plans. Only with `groups` instances have groups, and only
    with `stops` robots have several stops or service. For `large` seconds it is also asked about 10 to 1,000 robots; no
    other time limits it. `saved` are cases to ask first. The report's `conforms` is the answer, and its `failures` have
    the smallest cases found. Raises `Refusal` for what cannot be called, and for an unknown level or feature.
    """
    if not callable(planner):
        raise Refusal("option", "$.planner", RIGHT_QUESTIONS.id, f"it must be a function, not {planner!r}")
    require_each([*without] if isinstance(cast("object", without), Collection) else without, str, "$.without")
    require_limits(large=large)
    levels = [each.label for each in WHOLE_LEVELS]
    for option, each, known in (("level", level, levels), *(("without", each, [*FEATURES]) for each in without)):
        if each not in known:
            message = f"it must be one of {', '.join(known)}, not {each!r}"
            raise Refusal("option", f"$.{option}", RIGHT_QUESTIONS.id, message)
    for option, number in (("examples", examples), ("seed", seed)):
        if not is_between(number, 0):
            message = f"it must be a whole number of at least 0, not {number!r}"
            raise Refusal("option", f"$.{option}", RIGHT_QUESTIONS.id, message)
    name = getattr(planner, "__name__", type(planner).__name__)
    claims = Claims(frozenset(without), solvable, groups, stops)
    options = Options(LEVELS[level], examples, seed, whole=True, claims=claims, large=large)
    return conform(Function(planner, name, documents), options, saved=saved)
