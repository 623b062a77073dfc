"""The options of planners, and limits of searches."""

from dataclasses import asdict
from reprlib import repr as shown
from sys import float_info, maxsize
from typing import Any, cast, get_args

from carp_spec.planners import LARGEST_SEED, PathKind, Planner
from carp_spec.polish_rules import options_are_right as polish_options_are_right
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, Found, fault_rule, is_between

LARGEST_SAMPLE = 1_000_000
SEARCH_SECONDS = 60
"""The time of a search for an optimum where none is given."""
PROCESSES, MOST_PROCESSES = 1, 2
"""The processes of a search for an optimum, unless two are asked for, which is the most."""
BOUND_SECONDS = 10
"""The time of a search for a bound where neither a time nor a number of steps is given."""


@fault_rule(
    "planner/options",
    f"Counts (m, k, attempts, fallback, sample) are whole numbers of at least 1, a sample at most {LARGEST_SAMPLE}; "
    "a seed is between 0 and 2^64 - 1; baseline is true or false; paths is shortest or disjoint; sample and fallback "
    "may be null.",
    DESIGN,
)
def options_are_right(planner: Planner) -> Found:  # noqa: D103 - its statement stands in its decorator
    limits = {"seed": (0, LARGEST_SEED), "sample": (1, LARGEST_SAMPLE)}
    for name, value in asdict(planner).items():
        least, most = limits.get(name, (1, None))
        right = f"a whole number of at least {least}" if most is None else f"a whole number between {least} and {most}"
        is_right = is_between(value, least, most) or (value is None and name in ("sample", "fallback"))
        if name == "baseline":
            right, is_right = "true or false", isinstance(value, bool)
        elif name == "paths":
            right, is_right = '"shortest" or "disjoint"', value in get_args(PathKind)
        if not is_right:
            yield f"$.{name}", f"the {name} must be {right}, not {value!r}"


def require_planner(planner: Planner, kind: Any = Planner) -> None:  # noqa: ANN401 - a class or several
    """Raise `Refusal` unless it is a planner of the kind, with options that are right."""
    if not isinstance(planner, kind):
        names = ", ".join(each.__name__ for each in get_args(kind) or (kind,))
        message = f"it must be a value of {names}, not {planner!r}"
        raise Refusal("option", "$.planner", options_are_right.id, message)
    for fault in options_are_right(planner):
        raise Refusal("option", fault.path, fault.rule, fault.message)


def require_polish_options(iterations: object, seconds: object, seed: object) -> None:
    """Raise `Refusal` for wrong options."""
    for fault in polish_options_are_right(iterations, seconds, seed):
        raise Refusal("option", fault.path, fault.rule, fault.message)


def require_limits(**limits: object) -> None:
    """Raise `Refusal` unless each limit, by its name, is a number of at least 0, or `None` but for `limit` and `large`.

    Steps and the most violations are whole numbers, and the latter at least 1. With a limit of 0, which the protocol
    refuses, a search ends at once.
    """
    for name, limit in limits.items():
        is_whole = name in ("steps", "most")
        kinds, largest = ((int,), maxsize) if is_whole else ((int, float), float_info.max)
        least = int(name == "most")
        is_free = limit is None and name not in ("limit", "large")
        if not (is_free or (type(limit) in kinds and least <= cast("float", limit) <= largest)):
            message = f"it must be a {'whole ' if is_whole else ''}number of at least {least}, not {shown(limit)}"
            raise Refusal("request", f"$.{name}", "request/limit", message)
