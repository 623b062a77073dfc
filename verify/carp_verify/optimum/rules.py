"""The rules of requests to the search for an optimum: `optimum/...`."""

from typing import Any

from carp_spec import Refusal, Rule
from carp_spec.rule import DESIGN, rule

LARGEST_FORMULA = 20_000_000
LARGEST_PROOF = 5_000_000
LARGEST_SEARCH = 2_000_000
LARGEST_STEPS = 10_000_000
LARGEST_TABLE = 20_000_000
MOST_ORDERED = 9


@rule(
    "optimum/size",
    f"The formula of an optimum has at most {LARGEST_FORMULA} clauses, a search over the states of all robots together "
    f"looks at no more than {LARGEST_SEARCH}, and at {LARGEST_STEPS} steps to them, each counted with the most "
    f"constraints that a resource has, and all orders are tried of at most {MOST_ORDERED} robots. A proof is checked "
    f"of at most {LARGEST_TABLE} pairs of a robot's stop and a resource: all this fits into memory and time.",
    DESIGN,
)
def size_is_bounded(size: int, limit: int) -> bool:
    """Whether the size is within the limit."""
    return size <= limit


@rule(
    "optimum/proof", "A proof is written of an answer that a search has found and that its formulas bear out.", DESIGN
)
def is_provable(decided: bool) -> bool:
    """Whether the search has found an answer: an optimum, or that no plan set exists."""
    return decided


OPTIMUM_RULES: tuple[Rule[..., Any], ...] = (size_is_bounded, is_provable)


def refuse_size(what: str, size: int, limit: int) -> None:
    """Raise `Refusal` if the size is beyond the limit."""
    if not size_is_bounded(size, limit):
        message = f"{what} must be at most {limit}, the limit, and would be more"
        raise Refusal("limit", "$.robots", size_is_bounded.id, message)
