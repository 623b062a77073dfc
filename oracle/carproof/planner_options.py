"""Planners by name, and their options: the same for documents, the command line and Python."""

from collections.abc import Mapping
from dataclasses import fields
from difflib import get_close_matches
from typing import Any, cast, get_args

from carp_spec import Planner, Refusal
from carp_spec.inputs.options import options_are_right, require_planner

PLANNERS: Mapping[str, type[Planner]] = {kind.name: kind for kind in get_args(Planner)}


def planner_named(name: object, options: Mapping[str, object]) -> Planner:
    """Make a planner from its name and options.

    Raises `Refusal` on an unknown name, an option that the planner does not have, or a value out of range.
    """
    if not isinstance(name, str) or name not in PLANNERS:
        near = get_close_matches(name, PLANNERS, 1) if isinstance(name, str) else []
        meant = f"did you mean {near[0]}? The" if near else "the"
        message = f"there is no planner {name!r}; {meant} planners are {', '.join(PLANNERS)}"
        raise Refusal("option", "$.planner", options_are_right.id, message)
    if not isinstance(cast("object", options), Mapping):
        raise Refusal("option", "$.options", options_are_right.id, f"it must map names to values, not {options!r}")
    known = [field.name for field in fields(PLANNERS[name])]
    for option in options:
        if option not in known:
            has = f"its options are {', '.join(known)}" if known else "it has none"
            message = f"the planner {name} has no option {option}; {has}"
            raise Refusal("option", f"$.{option}", options_are_right.id, message)
    planner = PLANNERS[name](**cast("Mapping[str, Any]", options))
    require_planner(planner)
    return planner
