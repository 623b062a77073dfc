"""The rules of a certificate of a lower bound: `bound/...`."""

from typing import Any

from carp_spec import Refusal, Rule
from carp_spec.rule import DESIGN, is_whole, rule

LARGEST_TABLE = 20_000_000
LARGEST_RESTS = 400_000_000
LARGEST_SEARCH = 5_000_000
LARGEST_FORMULA = 5_000_000
LONGEST_STAY = 100_000


@rule("bound/instance", "A certificate of a bound names the SHA-256 digest of its instance's document.", DESIGN)
def is_about(named: str, digest: str) -> bool:
    """Whether the digest is the instance's."""
    return named == digest


@rule("bound/scale", "The scale is a power of two: this many parts of a tick are counted as 1.", DESIGN)
def is_scale(scale: object) -> bool:
    """Whether it is a power of two."""
    return is_whole(scale) and scale > 0 and scale & (scale - 1) == 0


@rule(
    "bound/price",
    "A price is a whole number of at least 0, for a resource, a group, or a move with a move back, at a tick from 0 "
    "up to, not including, the horizon.",
    DESIGN,
)
def is_price(price: object, tick: object, horizon: int) -> bool:
    """Whether price and tick are in their ranges."""
    return is_whole(price) and price >= 0 and is_whole(tick) and 0 <= tick < horizon


@rule("bound/once", "No price is given twice for the same place and tick.", DESIGN)
def is_new(place: object, known: Any) -> bool:  # noqa: ANN401 - any collection
    """Whether the place and tick have no price yet."""
    return place not in known


@rule(
    "bound/robots",
    "A certificate names each robot once, in the instance's order, with no more than the least of its weighted cost "
    "and its prices; null just where no way leads to its goal.",
    DESIGN,
)
def is_least(claimed: object, least: int | None) -> bool:
    """Whether the claim is no more than the least cost."""
    return claimed is None if least is None else is_whole(claimed) and claimed <= least


@rule(
    "bound/cut",
    "A cut is a group of one or more distinct robots, a whole multiplier and a whole total of at least 0, and a "
    "refutation of a smaller total of the group's costs, with horizons no more than it; the multipliers of a robot's "
    "cuts are no more than the scale together.",
    DESIGN,
)
def is_weight(scale: int, multipliers: int) -> bool:
    """Whether the multipliers of a robot's cuts leave its cost a weight of at least 0."""
    return multipliers <= scale


@rule(
    "bound/deadline",
    "Deadlines are those of a group of one or more robots, each with a whole tick, and if they are seen, each with "
    "another and with places, which are resources; a robot is named once, or again where it is seen later. Their price "
    "is a whole number of at least 0, and a refutation shows that no plans of the group keep all of them.",
    DESIGN,
)
def is_deadline(tick: object, earliest: int | None) -> bool:
    """Whether the deadline is not before the tick at which the robot can be at its goal, `None` if it never can."""
    return earliest is not None and is_whole(tick) and tick >= earliest


@rule(
    "bound/total",
    "The bound is the sum of the robots' least costs and of the cuts' least totals by their multipliers, less the sum "
    "of prices by capacities, and less the price of each group's deadlines by all of them but one, divided by the "
    "scale and rounded up.",
    DESIGN,
)
def is_rounded_up(bound: object, parts: int, scale: int) -> bool:
    """Whether the bound is the sum, in whole ticks."""
    return is_whole(bound) and bound == -(-parts // scale)


@rule(
    "bound/size",
    f"Robots by resources are at most {LARGEST_RESTS}; tables by resource and tick, by a robot's stop and resource, or "
    f"by a cut's robot and resource, have at most {LARGEST_TABLE} entries; the search for the robots' least costs "
    f"takes at most {LARGEST_SEARCH} steps, and the formulas of all cuts and deadlines have at most {LARGEST_FORMULA} "
    "clauses together.",
    DESIGN,
)
def size_fits(size: int, limit: int) -> bool:
    """Whether a size is within its limit."""
    return size <= limit


@rule(
    "bound/stay",
    f"A search for prices goes from tick to tick, and so through no stay that takes more than {LONGEST_STAY} of them.",
    DESIGN,
)
def stay_is_searched(ticks: int) -> bool:
    """Whether the longest stay that a robot needs is short enough."""
    return ticks <= LONGEST_STAY


class ContradictionError(RuntimeError):
    """Plans that break no rule cost less than an accepted bound: one of the two checkers is wrong."""


def require_size(size: int, limit: int, path: str, what: str) -> None:
    """Raise `Refusal` if what the path names would have a size above the limit."""
    require(size_fits, size_fits(size, limit), path, f"{what} would be {size}, and at most {limit} are allowed")


def require(rule: Rule[..., bool], kept: bool, path: str, message: str) -> None:
    """Raise `Refusal` if the rule is not kept at the path."""
    if not kept:
        raise Refusal("document", path, rule.id, message)


def require_kept(bound: int, cost: int) -> None:
    """Raise `ContradictionError` if plans of all robots, which break no rule, cost less than the bound."""
    if cost < bound:
        raise ContradictionError(f"plans that break no rule cost {cost}, less than the lower bound {bound}")


BOUND_RULES: tuple[Rule[..., Any], ...] = (
    is_about,
    is_scale,
    is_price,
    is_new,
    is_least,
    is_weight,
    is_deadline,
    is_rounded_up,
    size_fits,
    stay_is_searched,
)
