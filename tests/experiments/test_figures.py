"""The figures: few lines a panel, names beside their lines, axes that end where the values do."""

from pathlib import Path

import pytest

from carp_experiments.figures import line_figure
from carp_experiments.page import RESULTS
from carp_experiments.redrawing import draw_figures
from carp_experiments.report import Figure


@pytest.mark.ci
def test_the_stored_figures_are_those_of_the_stored_numbers(tmp_path: Path) -> None:
    draw_figures(RESULTS, tmp_path)
    drawn = {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
    assert drawn == {path.name: path.read_bytes() for path in RESULTS.glob("*.svg")}


def test_a_figure_of_a_run_without_values_is_drawn_too(tmp_path: Path) -> None:
    path = tmp_path / "none.svg"
    line_figure(path, Figure("none", "Nothing", ("robots", "ms"), {"CARP": [(10, None)]}, papers={"CARP": [(10, 3)]}))
    assert "Nothing" in path.read_text(encoding="utf-8")
