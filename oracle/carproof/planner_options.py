"""Planners by name, and their options: the same for documents, the command line and Python."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any, cast, get_args

from carp_spec import Planner, Refusal
from carp_spec.planners import LARGEST_SEED, PathKind
from carp_spec.rule import DESIGN, Found, fault_rule, is_between

LARGEST_SAMPLE = 1_000_000
PLANNERS: Mapping[str, type[Planner]] = {kind.name: kind for kind in get_args(Planner)}


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


def planner_named(name: object, options: Mapping[str, object]) -> Planner:
    """Make a planner from its name and options.

    Raises `Refusal` on an unknown name, an option that the planner does not have, or a value out of range.
    """
    if not isinstance(name, str) or name not in PLANNERS:
        message = f"there is no planner {name!r}; the planners are {', '.join(PLANNERS)}"
        raise Refusal("option", "$.planner", options_are_right.id, message)
    known = [field.name for field in fields(PLANNERS[name])]
    for option in options:
        if option not in known:
            has = f"its options are {', '.join(known)}" if known else "it has none"
            message = f"the planner {name} has no option {option}; {has}"
            raise Refusal("option", f"$.{option}", options_are_right.id, message)
    planner = PLANNERS[name](**cast("Mapping[str, Any]", options))
    for fault in options_are_right(planner):
        raise Refusal("option", fault.path, fault.rule, fault.message)
    return planner
