"""Figures as SVG, the same bytes for the same numbers."""

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from carp_experiments.report import Figure
from carp_experiments.statistics import Interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = (
    "#000000",
    "#0072b2",
    "#56b4e9",
    "#cc79a7",
    "#e69f00",
    "#009e73",
    "#d55e00",
    "#7f3c8d",
    "#8a8a8a",
    "#a5aa22",
)
FAMILIES = ("CARP", "CARP10", "CARP100", "LF", "Proposed_4", "Proposed_5", "Proposed_6", "Proposed_10", "greedy")
MARKERS = ("o", "s", "D", "^", "v", "<", ">", "X", "P", "*")
"""As many as colours, so that lines of one panel differ in grey too."""
STYLES = ("-", "--", ":")
MOST_LINES = 7
"""The most lines of a panel; what has more is drawn in panels, each with the references to compare with."""
REFERENCES = ("CARP", "CARP10")
"""The paper states failures between those of these two, and totals below both."""
WIDTH, HEIGHT = 5.0, 2.9
"""Inches: those of a column, names beside the lines included, and of a panel."""
MOST_TICKS = 6
NARROW = 50
"""From this ratio of the largest value to the least on, a logarithmic axis is labelled with powers of ten."""
HOLLOW = 3
"""Above the lines."""
LABEL_DISTANCE = 0.085
"""The least distance of labels, as a part of a panel's height."""

Known: TypeAlias = dict[str, list[tuple[int, Interval]]]


def line_figure(path: Path, drawn: Figure) -> None:
    """Draw a line with its intervals of 95 % for each name; a point without a value is left out.

    Names that differ only behind a plus, such as `CARP` and `CARP + more`, have one colour and different strokes.
    The axes end where the values do. Panels stand above each other, so that a figure is as wide as a column.
    """
    import matplotlib as mpl  # noqa: PLC0415 - loaded only where a figure is drawn

    mpl.use("svg")
    import matplotlib.pyplot as plt  # noqa: PLC0415

    panels = panels_of([*drawn.lines])
    strokes = strokes_of([*drawn.lines])
    shown = known_points(drawn)
    papers = papers_within(drawn, shown)
    with plt.rc_context({"svg.hashsalt": "carproof", "svg.fonttype": "none", "pdf.fonttype": 42, "font.size": 9}):
        size = (WIDTH, HEIGHT * len(panels) + 0.3)
        figure, plots = plt.subplots(len(panels), figsize=size, squeeze=False, layout="constrained")
        for (plot,), (heading, names) in zip(plots, panels.items(), strict=True):
            plot.set_title(heading, fontsize="medium", loc="left")
            plot.set(ylabel=drawn.axes[1], yscale="log" if drawn.logarithmic else "linear")
            end_where_values_do(plot, shown, [value for each in papers.values() for _, value in each])
            of_panel = {name: shown[name] for name in names if shown[name]}
            for name, points in of_panel.items():
                draw_line(plot, points, *strokes[name])
            draw_papers(plot, papers, {family_of(name): strokes[name] for name in of_panel})
            write_names(plot, of_panel, {name: strokes[name][0] for name in of_panel})
        plots[-1][0].set_xlabel(drawn.axes[0])
        figure.suptitle("\n".join((drawn.title, drawn.cited) if papers else (drawn.title,)))
        figure.savefig(path, metadata={"Creator": None, "CreationDate" if path.suffix == ".pdf" else "Date": None})
        plt.close(figure)


def panels_of(names: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """The names of each panel by its heading: one without a heading, or one for each kind of planner.

    Raises `ValueError` if that leaves a panel with more lines than can be distinguished.
    """
    if len(names) <= MOST_LINES:
        return {"": tuple(names)}
    proposed = [name for name in names if name.startswith("Proposed")]
    kinds = {
        "one robot after the other": [name for name in names if name not in proposed],
        "with neighbours, as published": [name for name in proposed if "+" not in name],
        "with neighbours, and more": [name for name in proposed if "+" in name],
    }
    compared = [name for name in names if name in REFERENCES]
    panels = {heading: tuple(dict.fromkeys([*compared, *kind])) for heading, kind in kinds.items() if kind}
    if max(map(len, panels.values())) > MOST_LINES:
        message = f"a panel has at most {MOST_LINES} lines"
        raise ValueError(message)
    return panels


def known_points(drawn: Figure) -> Known:
    """The points that have a value, and on a logarithmic axis a positive one."""
    return {
        name: [(x, each) for x, each in points if each is not None and (each.low > 0 or not drawn.logarithmic)]
        for name, points in drawn.lines.items()
    }


def papers_within(drawn: Figure, lines: Known) -> Mapping[str, Sequence[tuple[int, float]]]:
    """The paper's values beside which there are values of ours: a small run has fewer maps, or robots."""
    xs = [x for line in lines.values() for x, _ in line]
    within = {
        family: [(x, value) for x, value in points if min(xs, default=x + 1) <= x <= max(xs)]
        for family, points in drawn.papers.items()
    }
    return {family: points for family, points in within.items() if points}


def end_where_values_do(plot: "Axes", lines: Known, papers: Sequence[float]) -> None:
    """Let both axes begin and end with the values, if there are any, intervals and the paper's values included."""
    points = [point for line in lines.values() for point in line]
    if not points:
        return
    first, last = min(x for x, _ in points), max(x for x, _ in points)
    plot.set_xlim(first, max(last, first + 1))
    plot.set_xticks(round_ticks(first, last))
    low = min([*(each.low for _, each in points), *papers])
    high = max([*(each.high for _, each in points), *papers])
    if low < high:
        plot.set_ylim(low, high)
        if plot.get_yscale() == "log" and high < NARROW * low:
            label_few_decades(plot)
    plot.spines[["top", "right"]].set_visible(False)
    plot.grid(alpha=0.3)


def label_few_decades(plot: "Axes") -> None:
    """Write 0.5, 1, 2 and 5 beside a logarithmic axis, which has too few powers of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter  # noqa: PLC0415 - loaded only where a figure is drawn

    plot.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    plot.yaxis.set_major_formatter("{x:g}")
    plot.yaxis.set_minor_formatter(NullFormatter())


def round_ticks(first: int, last: int) -> list[int]:
    """The first number, the last, and round ones between that are not close to these."""
    steps = (digit * 10**power for power in range(9) for digit in (1, 2, 5))
    step = next(step for step in steps if step * MOST_TICKS >= last - first)
    between = [x for x in range(first - first % step, last, step) if min(x - first, last - x) * 2 >= step]
    return sorted({first, *between, last})


def draw_line(plot: "Axes", points: Sequence[tuple[int, Interval]], colour: str, marker: str, style: str) -> None:
    """Draw a line and the intervals of its points."""
    xs = [x for x, _ in points]
    plot.vlines(xs, [each.low for _, each in points], [each.high for _, each in points], colour, alpha=0.3, lw=0.8)
    ys = [each.estimate for _, each in points]
    plot.plot(xs, ys, style, color=colour, marker=marker, markersize=3, linewidth=1.2, clip_on=False)


def draw_papers(
    plot: "Axes", papers: Mapping[str, Sequence[tuple[int, float]]], strokes: Mapping[str, tuple[str, str, str]]
) -> None:
    """Draw the paper's values of the families in this panel, with their markers, large and hollow."""
    for family, (colour, marker, _) in strokes.items():
        for x, value in papers.get(family, ()):
            plot.plot(
                x, value, marker, color=colour, markerfacecolor="white", markersize=8, clip_on=False, zorder=HOLLOW
            )


def write_names(plot: "Axes", lines: Known, colours: Mapping[str, str]) -> None:
    """Write the name of each line at its right end, as far from the others as it needs to be."""
    to_part = plot.transData + plot.transAxes.inverted()
    ends = {name: points[-1] for name, points in lines.items()}
    heights = {name: float(to_part.transform((x, each.estimate))[1]) for name, (x, each) in ends.items()}
    means = {name: sum(each.estimate for _, each in points) / len(points) for name, points in lines.items()}
    ordered = sorted(ends, key=lambda name: (heights[name], means[name]))
    for name, height in zip(ordered, spread([heights[name] for name in ordered]), strict=True):
        colour, places = colours[name], plot.transAxes
        plot.plot([1, 1.03], [heights[name], height], color=colour, linewidth=0.5, transform=places, clip_on=False)
        plot.text(1.04, height, name, verticalalignment="center", transform=places, clip_on=False)


def spread(heights: Sequence[float]) -> list[float]:
    """Rising heights moved apart to the least distance of labels, and none above the panel if all have room in it."""
    placed: list[float] = []
    for height in heights:
        placed.append(max([height, *(each + LABEL_DISTANCE for each in placed[-1:])]))
    top = max(1.0, LABEL_DISTANCE * (len(placed) - 1))
    for at in reversed(range(len(placed))):
        placed[at] = min(placed[at], top)
        top = placed[at] - LABEL_DISTANCE
    return placed


def strokes_of(names: Sequence[str]) -> dict[str, tuple[str, str, str]]:
    """The colour, marker and style of each line; the families that are known have theirs in every figure."""
    families = {name: family_of(name) for name in names}
    used = set(families.values())
    others = [family for family in dict.fromkeys(families.values()) if family not in FAMILIES]
    looks = list(zip(COLOURS, MARKERS, strict=True))
    free = [look for family, look in zip_longest(FAMILIES, looks) if family not in used]
    look_of = {**dict(zip(FAMILIES, looks, strict=False)), **dict(zip(others, free, strict=False))}
    strokes = {}
    members: dict[str, int] = {}
    for name, family in families.items():
        members[family] = members.get(family, -1) + 1
        strokes[name] = *look_of[family], STYLES[members[family] % len(STYLES)]
    return strokes


def family_of(name: str) -> str:
    """What names that differ only behind a plus have in common."""
    return name.partition(" + ")[0]
