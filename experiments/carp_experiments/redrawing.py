"""The figures of stored runs; `python -m carp_experiments.redrawing` draws those of the stored results again."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from carp_experiments.beyond.delayed import DriverOf, execution_figures
from carp_experiments.beyond.following import FollowingOf, following_figures
from carp_experiments.beyond.neighbours import Helped, neighbours_figures
from carp_experiments.beyond.people import PeopleOf, people_figures
from carp_experiments.beyond.streams import StreamOf, stream_figures
from carp_experiments.figures import line_figure
from carp_experiments.page import RESULTS, Run, read_run, summary_of
from carp_experiments.paper.adding_time import Time, time_figures
from carp_experiments.paper.polishing import PolishSummary, polish_figures
from carp_experiments.paper.quality import QualitySummary, quality_figures
from carp_experiments.paper.related_work import Related, related_figures
from carp_experiments.paper.small_gaps import GapOf, gap_figures
from carp_experiments.report import Figure

FIGURES: Mapping[str, Callable[[Run], Sequence[Figure]]] = {
    "quality": lambda run: quality_figures(summary_of(run, QualitySummary)),
    "time": lambda run: time_figures(summary_of(run, tuple[Time, ...])),
    "gap": lambda run: gap_figures(summary_of(run, tuple[GapOf, ...])),
    "related": lambda run: related_figures(summary_of(run, tuple[Related, ...])),
    "polish": lambda run: polish_figures(summary_of(run, PolishSummary)),
    "neighbours": lambda run: neighbours_figures(summary_of(run, tuple[Helped, ...])),
    "execution": lambda run: execution_figures(summary_of(run, tuple[DriverOf, ...])),
    "following": lambda run: following_figures(summary_of(run, tuple[FollowingOf, ...])),
    "people": lambda run: people_figures(summary_of(run, tuple[PeopleOf, ...])),
    "stream": lambda run: stream_figures(summary_of(run, tuple[StreamOf, ...])),
}
"""The figures of a run, by the name of its experiment."""


def draw_figures(stored: Path, folder: Path, ending: str = "svg", names: Iterable[str] = FIGURES) -> dict[str, Path]:
    """Draw the figures of these runs that are stored as `NAME.json`, from the rounded numbers; their files by name."""
    files = {}
    for name in names:
        if name in FIGURES and (stored / f"{name}.json").exists():
            for figure in FIGURES[name](read_run(stored / f"{name}.json")):
                files[figure.name] = folder / f"{figure.name}.{ending}"
                line_figure(files[figure.name], figure)
    return files


if __name__ == "__main__":
    draw_figures(RESULTS, RESULTS)
