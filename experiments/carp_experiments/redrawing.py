"""Draws the figures of the stored results again; `python -m carp_experiments.redrawing` writes them in their places."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from carp_experiments.adding_time import Time, time_figures
from carp_experiments.delayed import DriverOf, execution_figures
from carp_experiments.following import FollowingOf, following_figures
from carp_experiments.page import RESULTS, Run, read_run, summary_of
from carp_experiments.people import PeopleOf, people_figures
from carp_experiments.polishing import PolishSummary, polish_figures
from carp_experiments.quality import QualitySummary
from carp_experiments.quality_report import quality_figures
from carp_experiments.related_work import Related, related_figures
from carp_experiments.report import Figure, write_figure
from carp_experiments.small_gaps import GapOf, gap_figures
from carp_experiments.streams import StreamOf, stream_figures

FIGURES: Mapping[str, Callable[[Run], Sequence[Figure]]] = {
    "quality": lambda run: quality_figures(summary_of(run, QualitySummary)),
    "time": lambda run: time_figures(summary_of(run, tuple[Time, ...])),
    "gap": lambda run: gap_figures(summary_of(run, tuple[GapOf, ...])),
    "related": lambda run: related_figures(summary_of(run, tuple[Related, ...])),
    "polish": lambda run: polish_figures(summary_of(run, PolishSummary)),
    "execution": lambda run: execution_figures(summary_of(run, tuple[DriverOf, ...])),
    "following": lambda run: following_figures(summary_of(run, tuple[FollowingOf, ...])),
    "people": lambda run: people_figures(summary_of(run, tuple[PeopleOf, ...])),
    "stream": lambda run: stream_figures(summary_of(run, tuple[StreamOf, ...])),
}
"""The figures of a run, by the name of its experiment."""


def stored_figures() -> Iterator[Figure]:
    """All figures of the results in the repository, by the numbers that were stored with them."""
    for name, figures in FIGURES.items():
        run = read_run(name)
        yield from () if run is None else figures(run)


if __name__ == "__main__":
    for figure in stored_figures():
        write_figure(RESULTS, figure)
