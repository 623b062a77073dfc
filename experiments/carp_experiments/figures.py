"""Figures as SVG, the same bytes for the same numbers."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from carp_experiments.statistics import Interval

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
STYLES = ("-", "--", ":")
SIZE_IN_INCHES = (9, 5)


def line_figure(
    path: Path,
    title: str,
    axes: tuple[str, str],
    lines: Mapping[str, Sequence[tuple[int, Interval | None]]],
    logarithmic: bool = False,
) -> None:
    """Draw a line with its band of 95 % for each name; a point without a value is left out."""
    import matplotlib as mpl  # noqa: PLC0415 - loaded only where a figure is drawn

    mpl.use("svg")
    import matplotlib.pyplot as plt  # noqa: PLC0415

    with plt.rc_context({"svg.hashsalt": "carproof", "svg.fonttype": "none", "font.size": 9}):
        figure, plot = plt.subplots(figsize=SIZE_IN_INCHES, layout="constrained")
        for number, (name, points) in enumerate(lines.items()):
            known = [(x, interval) for x, interval in points if interval is not None]
            xs = [x for x, _ in known]
            colour, style = COLOURS[number % len(COLOURS)], STYLES[number // len(COLOURS)]
            plot.plot(xs, [each.estimate for _, each in known], style, color=colour, label=name, marker=".")
            lows, highs = [each.low for _, each in known], [each.high for _, each in known]
            plot.fill_between(xs, lows, highs, color=colour, alpha=0.12, linewidth=0)
        plot.set(title=title, xlabel=axes[0], ylabel=axes[1], yscale="log" if logarithmic else "linear")
        plot.grid(alpha=0.3)
        figure.legend(loc="outside right upper", frameon=False)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)
