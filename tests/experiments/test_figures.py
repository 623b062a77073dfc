"""The figures: few lines a panel, names beside their lines, axes that end where the values do."""

import shutil
from pathlib import Path

import pytest

from carp_experiments.figures import (
    Lines,
    line_figure,
    without_outliers,
)
from carp_experiments.page import RESULTS
from carp_experiments.redrawing import FIGURES, draw_figures
from carproof.gap.statistics import Interval


def at(value: float) -> Interval:
    return Interval(value, value - 1, value + 1)


def test_a_lone_point_far_above_all_others_is_left_out_and_named() -> None:
    lines = {"low": [(1, at(6000)), (2, at(3100))], "high": [(2, at(3000))]}
    shown, outside = without_outliers(lines, logarithmic=False)
    assert shown == {"low": [(2, at(3100))], "high": [(2, at(3000))]}
    assert outside == [("low", 1, 6000)]
    assert without_outliers(lines, logarithmic=True) == (lines, [])
    assert without_outliers(shown, logarithmic=False) == (shown, [])


def test_a_figure_names_its_lines_and_what_lies_outside(tmp_path: Path) -> None:
    lines: Lines = {"one": [(0, at(6000)), (1, at(30)), (2, None)], "other": [(0, at(20)), (1, at(10))]}
    line_figure(tmp_path / "figure.svg", "Totals", ("map (0: tree)", "actions"), lines)
    drawn = (tmp_path / "figure.svg").read_text()
    assert all(f">{text}</text>" in drawn for text in ("one", "other", "outside: 6,000 of one at map 0"))
    assert "legend" not in drawn
    line_figure(tmp_path / "again.svg", "Totals", ("map (0: tree)", "actions"), lines)
    assert (tmp_path / "again.svg").read_text() == drawn


@pytest.mark.ci
def test_the_stored_figures_are_those_of_the_stored_numbers(tmp_path: Path) -> None:
    for name in FIGURES:
        shutil.copy(RESULTS / f"{name}.json", tmp_path)
        draw_figures(tmp_path, name)
    drawn = {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
    assert drawn == {path.name: path.read_bytes() for path in RESULTS.glob("*.svg")}
