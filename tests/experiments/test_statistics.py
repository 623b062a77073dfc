"""The intervals of the reports, against worked examples."""

import pytest

from carp_experiments.statistics import mean_interval, proportion_interval


def test_the_mean_and_its_interval() -> None:
    interval = mean_interval([1, 2, 3, 4])
    assert interval.estimate == 2.5
    assert interval.high - interval.estimate == pytest.approx(1.959964 * 1.2909944 / 2, abs=1e-6)
    assert mean_interval([7]).low == mean_interval([7]).high == 7


def test_wilsons_interval() -> None:
    interval = proportion_interval(2, 10)
    assert interval.low == pytest.approx(0.0567, abs=1e-4)
    assert interval.high == pytest.approx(0.5098, abs=1e-4)
    assert proportion_interval(0, 10).low == pytest.approx(0)
    assert proportion_interval(10, 10).high == 1
