"""Means and proportions with 95 % intervals. They report; they decide nothing, so they may be floats."""

from collections.abc import Sequence
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


def proportion_interval(hits: int, trials: int) -> Interval:
    """The proportion of at least one trial, with Wilson's interval."""
    share = hits / trials
    scale = 1 + Z95**2 / trials
    centre = (share + Z95**2 / (2 * trials)) / scale
    margin = Z95 * (share * (1 - share) / trials + Z95**2 / (4 * trials**2)) ** 0.5 / scale
    return Interval(share, max(0.0, centre - margin), min(1.0, centre + margin))
