"""Output for people: tables and lines of text on standard output."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from textwrap import wrap

import click

from carproof.command_line.files import TAKEN

WIDEST = 10_000


def printable(value: object) -> str:
    """The value as text on one line: a control character in an id is shown, not obeyed."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(value))


def counted(number: int, noun: str) -> str:
    """A number of things: `1 robot`, `2,000 robots`."""
    return f"{number:,} {noun}" + ("" if number == 1 else "s")


def say(text: str = "") -> None:
    """Print text for people: on standard error where a document has standard output, as with `-o -`."""
    context = click.get_current_context(silent=True)
    if context is not None and TAKEN in context.meta:
        remark(text)
    else:
        click.echo(text)


def remark(text: str) -> None:
    """Print text for people on standard error, if it can be written: the answer does not depend on it."""
    with suppress(OSError):
        click.echo(text, err=True)


def print_line(text: str) -> None:
    """Print one line."""
    say(printable(text))


def print_table(columns: Sequence[str], rows: Iterable[Sequence[object]], numbers: Sequence[str] = ()) -> None:
    """Print an aligned table; the columns that hold numbers are aligned at their right.

    Elsewhere than on a terminal it is as wide as its content. A terminal that is too narrow for the longest words of
    each column gets a line for each cell, with the name of its column.
    """
    from rich import box  # noqa: PLC0415 - a command that prints no table need not load rich
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415
    from rich.text import Text  # noqa: PLC0415

    cells = [[printable(cell) for cell in row] for row in rows]
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for column in columns:
        table.add_column(column, justify="right" if column in numbers else "left", overflow="fold")
    for row in cells:
        table.add_row(*map(Text, row))
    console = Console(highlight=False)
    widths = Console(highlight=False, width=WIDEST).measure(table)
    if console.is_terminal and widths.minimum > console.width:
        _print_records(columns, cells, console.width)
        return
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDEST)
        console.width = widths.maximum
    with console.capture() as shown:
        console.print(table)
    for line in shown.get().splitlines():
        say(line.rstrip())


def _print_records(columns: Sequence[str], rows: Iterable[Sequence[str]], width: int) -> None:
    """Print a paragraph for each row, with a line for each cell that is not empty."""
    for number, row in enumerate(rows):
        if number:
            say()
        for column, cell in zip(columns, row, strict=False):
            for line in (
                wrap(f"{column}: {cell}", width, subsequent_indent="  ", break_on_hyphens=False) if cell else ()
            ):
                say(line)
