"""Draws the figures of the stored results again; `python -m carp_experiments.redrawing` writes them in their places."""

from collections.abc import Iterator, Sequence

from carp_experiments.adding_time import Time, time_figures
from carp_experiments.page import RESULTS, Run, read_run, summary_of
from carp_experiments.polishing import PolishSummary, polish_figures
from carp_experiments.quality import QualitySummary
from carp_experiments.quality_report import quality_figures
from carp_experiments.related_work import Related, related_figures
from carp_experiments.report import Figure, write_figure
from carp_experiments.small_gaps import GapOf, gap_figures


def stored_figures() -> Iterator[Figure]:
    """All figures of the results in the repository, by the numbers that were stored with them."""
    for name in ("quality", "time", "gap", "related", "polish"):
        run = read_run(name)
        yield from () if run is None else figures_of(run)


def figures_of(run: Run) -> Sequence[Figure]:
    """The figures of a run."""
    if run.experiment == "quality":
        return quality_figures(summary_of(run, QualitySummary))
    if run.experiment == "time":
        return time_figures(summary_of(run, tuple[Time, ...]))
    if run.experiment == "gap":
        return gap_figures(summary_of(run, tuple[GapOf, ...]))
    if run.experiment == "related":
        return related_figures(summary_of(run, tuple[Related, ...]))
    return polish_figures(summary_of(run, PolishSummary))


if __name__ == "__main__":
    for figure in stored_figures():
        write_figure(RESULTS, figure)
