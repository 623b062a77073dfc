"""Figures as SVG, the same bytes for the same numbers."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from carp_experiments.statistics import Interval

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
STYLES = ("-", "--", ":")
SIZE_IN_INCHES = (9, 5)


def line_figure(
    path: Path,
    title: str,
    axes: tuple[str, str],
    lines: Mapping[str, Sequence[tuple[int, Interval | None]]],
    logarithmic: bool = False,
) -> None:
    """Draw a line with its intervals of 95 % for each name; a point without a value is left out.

    Names that differ only behind a plus, such as `CARP` and `CARP + more`, have one colour and different strokes.
    """
    import matplotlib as mpl  # noqa: PLC0415 - loaded only where a figure is drawn

    mpl.use("svg")
    import matplotlib.pyplot as plt  # noqa: PLC0415
    from matplotlib.ticker import MaxNLocator  # noqa: PLC0415

    with plt.rc_context({"svg.hashsalt": "carproof", "svg.fonttype": "none", "font.size": 9}):
        figure, plot = plt.subplots(figsize=SIZE_IN_INCHES, layout="constrained")
        strokes = strokes_of([*lines])
        for name, points in lines.items():
            known = [(x, interval) for x, interval in points if interval is not None]
            xs = [x for x, _ in known]
            colour, style = strokes[name]
            estimates = [each.estimate for _, each in known]
            plot.plot(xs, estimates, style, color=colour, label=name, marker=".", markersize=4, linewidth=1.2)
            lows, highs = [each.low for _, each in known], [each.high for _, each in known]
            plot.vlines(xs, lows, highs, color=colour, alpha=0.35, linewidth=0.8)
        plot.set(title=title, xlabel=axes[0], ylabel=axes[1], yscale="log" if logarithmic else "linear")
        plot.xaxis.set_major_locator(MaxNLocator(integer=True))
        plot.grid(alpha=0.3)
        figure.legend(loc="outside right upper", frameon=False)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)


def strokes_of(names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """The colour and the style of each line."""
    strokes = {}
    families: dict[str, int] = {}
    for name in names:
        family = name.partition(" + ")[0]
        number = families[family] = families.get(family, -1) + 1
        colour = [*families].index(family)
        strokes[name] = COLOURS[colour % len(COLOURS)], STYLES[number % len(STYLES)]
    return strokes
