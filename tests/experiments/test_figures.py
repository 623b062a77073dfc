"""The figures: few lines a panel, names beside their lines, axes that end where the values do."""

import shutil
from itertools import pairwise
from pathlib import Path

import pytest

from carp_experiments.figures import (
    LABEL_DISTANCE,
    MOST_LINES,
    Lines,
    line_figure,
    panels_of,
    round_ticks,
    spread,
    without_outliers,
)
from carp_experiments.page import RESULTS
from carp_experiments.paper.quality import ALGORITHMS
from carp_experiments.redrawing import FIGURES, draw_figures
from carproof.gap.statistics import Interval


def at(value: float) -> Interval:
    return Interval(value, value - 1, value + 1)


def test_panels_have_at_most_seven_lines_and_every_name() -> None:
    panels = panels_of(tuple(ALGORITHMS))
    assert max(map(len, panels.values())) <= MOST_LINES < len(ALGORITHMS)
    assert {name for names in panels.values() for name in names} == set(ALGORITHMS)
    assert all("CARP" in names for names in panels.values())
    few = tuple(ALGORITHMS)[:MOST_LINES]
    assert panels_of(few) == {"": few}
    with pytest.raises(ValueError, match="at most 7 lines"):
        panels_of([f"planner {number}" for number in range(8)])


def test_a_lone_point_far_above_all_others_is_left_out_and_named() -> None:
    lines = {"low": [(1, at(6000)), (2, at(3100))], "high": [(2, at(3000))]}
    shown, outside = without_outliers(lines, logarithmic=False)
    assert shown == {"low": [(2, at(3100))], "high": [(2, at(3000))]}
    assert outside == [("low", 1, 6000)]
    assert without_outliers(lines, logarithmic=True) == (lines, [])
    assert without_outliers(shown, logarithmic=False) == (shown, [])


def test_names_beside_lines_do_not_overlap_and_stay_in_the_panel() -> None:
    heights = spread([0, 0, 0.01, 0.5, 0.99, 1, 1])
    gaps = [above - below for below, above in pairwise(heights)]
    assert min(gaps) >= LABEL_DISTANCE - 1e-9
    assert 0 <= heights[0] <= heights[-1] <= 1


@pytest.mark.parametrize(
    ("first", "last", "ticks"),
    [(0, 20, [0, 5, 10, 15, 20]), (1, 100, [1, 20, 40, 60, 80, 100]), (2, 20, [2, 5, 10, 15, 20]), (3, 3, [3])],
)
def test_the_axis_of_numbers_begins_and_ends_with_the_values(first: int, last: int, ticks: list[int]) -> None:
    assert round_ticks(first, last) == ticks


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
