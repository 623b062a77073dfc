"""The report of the quality experiment: tables as Markdown, figures as SVG."""

from collections.abc import Sequence
from pathlib import Path

from carp_experiments.figures import line_figure
from carp_experiments.quality import ALGORITHMS, FULL_MAP, Summary
from carp_experiments.statistics import Interval

SHOWN_MAPS = (0, 5, 10, 15, 20)


def write_report(folder: Path, summaries: Sequence[Summary]) -> None:
    """Write `quality.md`, `quality-failures.svg` and `quality-totals.svg` into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    failures = {
        name: [(each.map, each.failure_rate) for each in summaries if each.algorithm == name] for name in ALGORITHMS
    }
    totals = {name: [(each.map, each.total) for each in summaries if each.algorithm == name] for name in ALGORITHMS}
    maps = f"map (0: spanning tree, {FULL_MAP}: full grid)"
    line_figure(folder / "quality-failures.svg", "Assignments that fail", (maps, "failure rate"), failures)
    line_figure(folder / "quality-totals.svg", "Actions of all robots", (maps, "mean total cost"), totals)
    (folder / "quality.md").write_text(markdown(summaries), encoding="utf-8")


def markdown(summaries: Sequence[Summary]) -> str:
    """Two tables: failure rates in per cent, and mean totals over the assignments that did not fail."""
    maps = [map for map in SHOWN_MAPS if any(each.map == map for each in summaries)]
    by_place = {(each.algorithm, each.map): each for each in summaries}
    heads = [f"map {map}" for map in maps]
    rates = [[_percent(by_place[name, map].failure_rate) for map in maps] for name in ALGORITHMS]
    totals = [[_mean(by_place[name, map].total) for map in maps] for name in ALGORITHMS]
    return (
        "Failure rate in per cent, with its 95 % interval:\n\n"
        + _table(heads, rates)
        + "\nMean total cost over the assignments that did not fail, with its 95 % interval:\n\n"
        + _table(heads, totals)
    )


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [["algorithm", *heads], ["---", *("---:" for _ in heads)]]
    lines += [[name, *row] for name, row in zip(ALGORITHMS, rows, strict=True)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _percent(rate: Interval) -> str:
    return f"{100 * rate.estimate:.1f} ({100 * rate.low:.1f} to {100 * rate.high:.1f})"


def _mean(total: Interval | None) -> str:
    return "all failed" if total is None else f"{total.estimate:.1f} ± {total.high - total.estimate:.1f}"
