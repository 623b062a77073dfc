"""The results of an experiment: tables, figures, and its numbers for programs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from carp_experiments.figures import line_figure
from carproof.statistics import Interval


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of text under columns; `numbers` are the columns that are aligned at their right."""

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[str, ...] = ()

    @property
    def markdown(self) -> str:
        """The table in Markdown."""
        rule = ["---:" if column in self.numbers else "---" for column in self.columns]
        return "".join(f"| {' | '.join(line)} |\n" for line in (self.columns, rule, *self.rows))


@dataclass(frozen=True, slots=True)
class Figure:
    """Lines over numbers, each point with its 95 % interval; a point without a value is left out."""

    name: str
    title: str
    axes: tuple[str, str]
    lines: Mapping[str, Sequence[tuple[int, Interval | None]]]
    logarithmic: bool = False


@dataclass(frozen=True, slots=True)
class ExperimentReport:
    """The summary of an experiment's rows: numbers for programs, tables and figures for people, lines to print.

    `holds` is false if the rows contradict the claim of the experiment.
    """

    summary: object
    tables: tuple[Table, ...]
    figures: tuple[Figure, ...] = ()
    lines: tuple[str, ...] = ()
    holds: bool = True


def write_report(folder: Path, name: str, report: ExperimentReport, run: Mapping[str, object]) -> None:
    """Write `NAME.json`, with the facts of the run and all numbers, `NAME.md`, and a figure of each kind."""
    folder.mkdir(parents=True, exist_ok=True)
    summary = rounded(msgspec.to_builtins(report.summary))
    document = msgspec.json.encode({"experiment": name, **run, "summary": summary}, order="sorted")
    (folder / f"{name}.json").write_bytes(document + b"\n")
    text = "\n".join(f"{table.title}:\n\n{table.markdown}" for table in report.tables)
    (folder / f"{name}.md").write_text(text, encoding="utf-8")
    for figure in report.figures:
        write_figure(folder, figure)


def write_figure(folder: Path, figure: Figure) -> None:
    """Draw a figure into the folder, as `NAME.svg`."""
    line_figure(folder / f"{figure.name}.svg", figure.title, figure.axes, figure.lines, figure.logarithmic)


def rounded(value: Any) -> Any:  # noqa: ANN401 - whatever JSON holds
    """The same with significant digits only."""
    if isinstance(value, float):
        return round(value, 5)
    if isinstance(value, dict):
        return {name: rounded(each) for name, each in value.items()}
    return [rounded(each) for each in value] if isinstance(value, list | tuple) else value
