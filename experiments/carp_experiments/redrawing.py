"""The figures of stored runs; `python -m carp_experiments.redrawing` draws those of the stored results again."""

from collections.abc import Container
from pathlib import Path

from carp_experiments.experiments import EXPERIMENTS
from carp_experiments.figures import line_figure
from carp_experiments.page import RESULTS, of_summary, read_run

ALL = frozenset(each.name for each in EXPERIMENTS)


def draw_figures(stored: Path, folder: Path, ending: str = "svg", names: Container[str] = ALL) -> dict[str, Path]:
    """Draw the figures of these runs that are stored as `NAME.json`, from the rounded numbers; their files by name."""
    files = {}
    for each in EXPERIMENTS:
        run = stored / f"{each.name}.json"
        figures = each.figures if each.name in names and run.exists() else None
        if figures is not None:
            for figure in of_summary(figures, read_run(run)):
                files[figure.name] = folder / f"{figure.name}.{ending}"
                line_figure(files[figure.name], figure)
    return files


if __name__ == "__main__":
    draw_figures(RESULTS, RESULTS)
