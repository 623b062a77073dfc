"""The figures: few lines a panel, names beside their lines, axes that end where the values do."""

import shutil
from pathlib import Path

import pytest

from carp_experiments.figures import line_figure
from carp_experiments.page import RESULTS
from carp_experiments.redrawing import FIGURES, draw_figures
from carp_experiments.report import Figure
from carp_experiments.statistics import Interval


def at(value: float) -> Interval:
    return Interval(value, value - 1, value + 1)


def test_a_figure_names_its_lines_and_is_drawn_again_the_same(tmp_path: Path) -> None:
    lines: dict[str, list[tuple[int, Interval | None]]] = {
        "one": [(0, at(60)), (1, at(30)), (2, None)],
        "other": [(0, at(20)), (1, at(10))],
    }
    figure = Figure("figure", "Totals", ("map (0: tree)", "actions"), lines)
    line_figure(tmp_path / "figure.svg", figure)
    drawn = (tmp_path / "figure.svg").read_text()
    assert all(f">{text}</text>" in drawn for text in ("one", "other"))
    assert "legend" not in drawn
    line_figure(tmp_path / "again.svg", figure)
    assert (tmp_path / "again.svg").read_text() == drawn


def test_the_papers_values_are_hollow_and_within_the_axes(tmp_path: Path) -> None:
    lines: dict[str, list[tuple[int, Interval | None]]] = {"one": [(0, at(60)), (1, at(30))]}
    papers = {"one": [(1, 95), (7, 200)]}  # there is nothing at 7 to be compared with
    line_figure(tmp_path / "with.svg", Figure("with", "Totals", ("map", "actions"), lines, papers=papers))
    line_figure(tmp_path / "without.svg", Figure("without", "Totals", ("map", "actions"), lines))
    drawn, plain = ((tmp_path / name).read_text() for name in ("with.svg", "without.svg"))
    hollow = "fill: #ffffff; stroke: #000000"
    assert drawn.count(hollow) == plain.count(hollow) + 1
    assert ">90</text>" in drawn
    assert ">100</text>" not in drawn
    assert ">90</text>" not in plain


@pytest.mark.ci
def test_the_stored_figures_are_those_of_the_stored_numbers(tmp_path: Path) -> None:
    for name in FIGURES:
        shutil.copy(RESULTS / f"{name}.json", tmp_path)
        draw_figures(tmp_path, name, tmp_path)
    drawn = {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
    assert drawn == {path.name: path.read_bytes() for path in RESULTS.glob("*.svg")}
