"""Limits beyond which a planner may refuse an instance: `limit/...`. The law itself has no largest number."""

from typing import Any

from carp_spec.model import Instance
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, Rule, rule

LARGEST_TABLE = 5_000_000
LARGEST_COMPILED = 2**30


@rule(
    "limit/ticks",
    "A planner that keeps ticks in tables may refuse an instance that its tables cannot hold: the compiled engine "
    f"ticks, durations and positions beyond {LARGEST_COMPILED}, the time-expanded planner more than {LARGEST_TABLE} "
    "ticks.",
    DESIGN,
)
def ticks_are_held(ticks: int, most: int) -> bool:  # noqa: D103 - its statement stands in its decorator
    return ticks <= most


@rule(
    "limit/following",
    "Optima, lower bounds, certificates, proofs and the kernel know of no forbidden following, and refuse an instance "
    "that forbids it.",
    DESIGN,
)
def following_is_allowed(instance: Instance) -> bool:  # noqa: D103
    return instance.following == "allowed"


def require_following(instance: Instance) -> None:
    """Raise `Refusal` if the instance forbids following."""
    if not following_is_allowed(instance):
        message = "following must be allowed here: checks and planners alone know of instances that forbid it"
        raise Refusal("limit", "$.following", following_is_allowed.id, message)


LIMIT_RULES: tuple[Rule[..., Any], ...] = (ticks_are_held, following_is_allowed)
