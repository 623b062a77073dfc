"""Figures as SVG, the same bytes for the same numbers."""

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path

from carproof.statistics import Interval

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
    """The colour and the style of each line; the families that are known have theirs in every figure."""
    strokes = {}
    family_of = {name: name.partition(" + ")[0] for name in names}
    used = set(family_of.values())
    others = [family for family in dict.fromkeys(family_of.values()) if family not in FAMILIES]
    free = [colour for family, colour in zip_longest(FAMILIES, COLOURS) if family not in used]
    colours = {**dict(zip(FAMILIES, COLOURS, strict=False)), **dict(zip(others, free, strict=False))}
    members: dict[str, int] = {}
    for name, family in family_of.items():
        members[family] = members.get(family, -1) + 1
        strokes[name] = colours[family], STYLES[members[family] % len(STYLES)]
    return strokes
