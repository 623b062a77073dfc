"""Finds a good lower bound on the total cost, with a certificate that `carp_verify.verify_bound` checks.

Prices are raised where the robots' cheapest ways need more than there is, and lowered where they need less, step by
step (`carp_verify.price_steps`). The search aims a little above the best bound known, less and less so as it fails to
get there. Source: the target level method of Goffin and Kiwiel 1999, over the Lagrangian relaxation of all rules of
plans together.
"""

from collections.abc import Callable
from dataclasses import dataclass

from carp_spec import Instance
from carp_spec.bounds import BOUND_FORMAT, BoundDocument, digest

SCALE = 1 << 16


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the search is: steps taken, and the best bound so far, in whole ticks."""

    steps: int
    bound: int


def lower_bound(
    instance: Instance,
    seconds: float | None = None,
    steps: int | None = None,
    on_step: Callable[[Progress], None] = lambda _: None,
) -> BoundDocument:
    """Search for so many seconds or steps, whichever is over first, or until no step gains anything.

    With steps alone, the same instance gives the same certificate. `on_step` is called after each step. Raises
    `Refusal` for numbers that are too large.
    """
    from carp_verify.price_search import PriceSearch  # noqa: PLC0415 - numba is slow to load

    search = PriceSearch(instance, SCALE)
    on_step(Progress(0, -(-search.best // SCALE)))
    search.run(seconds, steps, lambda count, best: on_step(Progress(count, -(-best // SCALE))))
    prices = search.prices()
    robots = search.least_costs()
    parts = sum(least or 0 for _, least in robots) - search.worth
    return BoundDocument(
        format=BOUND_FORMAT,
        instance=digest(instance),
        bound=-(-parts // SCALE),
        scale=SCALE,
        horizon=search.horizon,
        resources=prices.resources,
        exchanges=prices.exchanges,
        cuts=(),
        robots=robots,
    )
