"""The results of an experiment: tables, figures, and its numbers for programs."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias, TypeVar

import msgspec

from carp_experiments.statistics import Interval
from carproof.markdown import markdown_table

T = TypeVar("T")
Point: TypeAlias = tuple[int, Interval | None]
Lines: TypeAlias = Mapping[str, Sequence[Point]]
ROUNDING = msgspec.json.Decoder(float_hook=lambda text: round(float(text), 5))


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
        return markdown_table(self.columns, self.rows, self.numbers)


def table_of(
    name: str, title: str, rows: Iterable[T], cells: Mapping[str, Callable[[T], object]], names: int = 0
) -> Table:
    """A table with a line for each row, and by column the cell of a row.

    But for the first columns, as many as `names`, all hold numbers.
    """
    lines = tuple(tuple(str(cell(row)) for cell in cells.values()) for row in rows)
    return Table(name, title, tuple(cells), lines, tuple(cells)[names:])


def table_by_map(name: str, title: str, head: str, cells: Mapping[tuple[str, int], str]) -> Table:
    """A table of the cells, with a line for each name and a column for each map."""
    names, maps = (dict.fromkeys(column) for column in zip(*cells, strict=True))
    columns = (head, *(f"map {map}" for map in maps))
    rows = tuple((each, *(cells[each, map] for map in maps)) for each in names)
    return Table(name, title, columns, rows, columns[1:])


@dataclass(frozen=True, slots=True)
class Figure:
    """Lines over numbers, each point with its 95 % interval; a point without a value is left out.

    `papers` are the values that the paper states, by the family of a line; `cited` says where it states them.
    """

    name: str
    title: str
    axes: tuple[str, str]
    lines: Lines
    logarithmic: bool = False
    papers: Mapping[str, Sequence[tuple[int, float]]] = field(default_factory=dict)
    cited: str = ""


def lines_of(summary: Iterable[T], line: Callable[[T], str], point: Callable[[T], Point]) -> Lines:
    """The points of each line, both in the order in which they come."""
    lines: dict[str, list[Point]] = {}
    for each in summary:
        lines.setdefault(line(each), []).append(point(each))
    return lines


@dataclass(frozen=True, slots=True)
class ExperimentReport:
    """The summary of an experiment's rows: numbers for programs, tables for people, lines to print.

    `holds` is false if the rows contradict the claim of the experiment.
    """

    summary: object
    tables: tuple[Table, ...]
    lines: tuple[str, ...] = ()
    holds: bool = True


def write_report(folder: Path, name: str, report: ExperimentReport, run: Mapping[str, object]) -> None:
    """Write `NAME.json`, with the facts of the run and all numbers, and `NAME.md` with the tables."""
    folder.mkdir(parents=True, exist_ok=True)
    summary = ROUNDING.decode(msgspec.json.encode(report.summary))
    document = msgspec.json.encode({"experiment": name, **run, "summary": summary}, order="sorted")
    (folder / f"{name}.json").write_bytes(document + b"\n")
    text = "\n".join(f"{table.title}:\n\n{table.markdown}" for table in report.tables)
    (folder / f"{name}.md").write_text(text, encoding="utf-8")
