"""Means and proportions with 95 % intervals. They report; they decide nothing, so they may be floats."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import NormalDist, fmean, stdev

Z95 = NormalDist().inv_cdf(0.975)


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate and the ends of its 95 % interval."""

    estimate: float
    low: float
    high: float

    def __format__(self, digits: str) -> str:
        """Print like `1.9 ± 1.6`: the estimate and half the interval, each formatted as a number."""
        return f"{self.estimate:{digits}} ± {self.high - self.estimate:{digits}}"


def mean_interval(values: Sequence[float]) -> Interval:
    """The mean of at least one value, with the interval of the normal distribution."""
    mean = fmean(values)
    margin = Z95 * stdev(values) / len(values) ** 0.5 if len(values) > 1 else 0.0
    return Interval(mean, mean - margin, mean + margin)


@dataclass(frozen=True, slots=True)
class Excess:
    """The number of instances that have a value, and the mean in per cent of the optimum; `None` without any."""

    instances: int
    per_cent: Interval | None

    def __str__(self) -> str:
        """Print like `1.9 ± 1.6`."""
        return "-" if self.per_cent is None else f"{self.per_cent:.1f}"


def excess(totals: Iterable[tuple[int | None, int | None, int | None]]) -> Excess:
    """The mean over those that are known of how much a total exceeds another, in per cent of a third."""
    values = [
        100 * (total - other) / (whole or 1)
        for total, other, whole in totals
        if total is not None and other is not None and whole is not None
    ]
    return Excess(len(values), mean_interval(values) if values else None)


def proportion_interval(hits: int, trials: int) -> Interval:
    """The proportion of at least one trial, with Wilson's interval."""
    share = hits / trials
    scale = 1 + Z95**2 / trials
    centre = (share + Z95**2 / (2 * trials)) / scale
    margin = Z95 * (share * (1 - share) / trials + Z95**2 / (4 * trials**2)) ** 0.5 / scale
    return Interval(share, max(0.0, centre - margin), min(1.0, centre + margin))
