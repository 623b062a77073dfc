"""The figures: few lines a panel, names beside their lines, axes that end where the values do."""

import shutil
from pathlib import Path

import pytest

from carp_experiments.page import RESULTS
from carp_experiments.redrawing import FIGURES, draw_figures


@pytest.mark.ci
def test_the_stored_figures_are_those_of_the_stored_numbers(tmp_path: Path) -> None:
    for name in FIGURES:
        shutil.copy(RESULTS / f"{name}.json", tmp_path)
        draw_figures(tmp_path, name, tmp_path)
    drawn = {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
    assert drawn == {path.name: path.read_bytes() for path in RESULTS.glob("*.svg")}
