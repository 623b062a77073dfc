"""A lower bound, and the best plans known above it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from carp_spec import Instance, Plan, total_cost


@dataclass(frozen=True, slots=True)
class Between:
    """No plans of all robots cost less than `lower` ticks, and `plans`, if any, are the best known."""

    instance: Instance
    lower: int = 0
    plans: Sequence[Plan] | None = None

    @property
    def total(self) -> int | None:
        """The total cost of the plans."""
        return None if self.plans is None else total_cost(self.instance, self.plans)

    @property
    def is_optimum(self) -> bool:
        """Whether no plans cost less than these."""
        return self.total is not None and self.total <= self.lower

    def with_plans(self, plans: Sequence[Plan] | None) -> "Between":
        """These plans instead, if they cost less."""
        better = plans is not None and (self.total is None or total_cost(self.instance, plans) < self.total)
        return replace(self, plans=plans) if better else self

    def sharpened(self, other: "Between") -> "Between":
        """The better bound and the better plans."""
        return replace(self.with_plans(other.plans), lower=max(self.lower, other.lower))

    def of_all(self, other: "Between") -> "Between":
        """The better plans, and the bound of all, where each of the two holds for one half of the plans."""
        return replace(self.with_plans(other.plans), lower=min(self.lower, other.lower))
