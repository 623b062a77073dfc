"""The kinds of reuse of the neighbourhood planner, and how many queries each avoided."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Reuse:
    """The queries that are not repeated; no kind of reuse changes a plan.

    `kept`: robots before the one taken out keep their plans (the paper's first reduction).
    `unchanged`: a query whose outcome cannot have changed is not asked (`carp_optimized.neighbourhood.replanning`).
    `prefixes`: orders that begin alike share the plans of their beginning (the paper's second reduction).
    `shared`: a query is answered by one asked against fewer plans, if the others leave room for its plan.
    `bounds`: orders that cannot be strictly better than the best are not planned
    (`carp_optimized.neighbourhood.order_search`).
    """

    kept: bool = True
    unchanged: bool = True
    prefixes: bool = True
    shared: bool = True
    bounds: bool = True


@dataclass(frozen=True, slots=True)
class Queries:
    """The number of queries asked, and of those that each kind of reuse avoided.

    `bounds` counts the queries of the orders that were cut, with beginnings shared if `prefixes` is on; if orders are
    drawn, it counts only those drawn. A last neighbourhood that is left out before its orders are drawn is not counted.
    """

    asked: int
    kept: int
    unchanged: int
    prefixes: int
    shared: int
    bounds: int

    @property
    def avoided(self) -> tuple[str, ...]:
        """The kinds of reuse that have a count."""
        return ("kept", "unchanged", "prefixes", "shared", "bounds")
