"""Campaigns of random questions to two programs, which must agree on all.

A case is a block of questions, so that a row stands for a second of work. A row counts answers, and has the questions
on which the programs differ in its `differences`.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import msgspec

from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row

BLOCK = 1000
SHOWN = 3


@dataclass(frozen=True, slots=True)
class BlockCase:
    """The questions of a seed numbered from `first` on; `what` they are, and `ask` makes their row."""

    ask: "Callable[[BlockCase], msgspec.Struct]"
    what: str
    first: int
    count: int = BLOCK
    seed: int = 0

    @property
    def key(self) -> str:
        """Blocks in their order."""
        return f"seed {self.seed} {self.what} {self.first:09} to {self.first + self.count - 1:09}"

    def run(self) -> Row:
        """What `ask` counts."""
        return msgspec.to_builtins(self.ask(self))  # type: ignore[no-any-return] # a struct becomes a dict


@dataclass(frozen=True, slots=True)
class Questions:
    """A campaign: `what` is asked, how a block of it is asked, the class of its rows, and their sums in a table.

    `full` and `quick` are how many are asked, and `of_kernel` is whether the kernel is. `kinds` are other questions
    that can be asked, each with what is said of it; `ask` then takes one of them.
    """

    name: str
    about: str
    what: str
    title: str
    ask: Callable[..., msgspec.Struct]
    row: type[Any]
    sums: Mapping[str, Callable[[Any], int]]
    kinds: Mapping[str, str] = field(default_factory=dict)
    of_kernel: bool = True
    full: int = 1_000_000
    quick: int = 20_000

    def cases(self, number: int, seed: int, kind: str | None = None) -> tuple[BlockCase, ...]:
        """That many questions, in blocks."""
        ask, what = (self.ask, self.what) if kind is None else (partial(self.ask, kind=kind), f"{kind} {self.what}")
        firsts = range(0, number, BLOCK)
        return tuple(BlockCase(ask, what, first, min(BLOCK, number - first), seed) for first in firsts)

    def report(self, rows: Iterable[Row]) -> ExperimentReport:
        """The sums, and the questions on which the programs differ."""
        stored = [msgspec.convert(row, self.row) for row in rows]
        differences = [each for row in stored for each in row.differences]
        columns = (*self.sums, "differences")
        cells = [sum(map(count, stored)) for count in self.sums.values()]
        lines = tuple(f"A DIFFERENCE: {msgspec.json.encode(each).decode()}" for each in differences[:SHOWN])
        table = Table(self.name, self.title, columns, (tuple(map(str, (*cells, len(differences)))),), columns)
        return ExperimentReport({"differences": differences}, (table,), lines, holds=not differences)
