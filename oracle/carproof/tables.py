"""Output for people: tables and lines of text on standard output."""

from collections.abc import Iterable, Sequence

import click

from carproof.files import TAKEN

WIDEST = 10_000


def printable(value: object) -> str:
    """The value as text on one line: a control character in an id is shown, not obeyed."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(value))


def say(text: str = "") -> None:
    """Print text for people: on standard error where a document has standard output, as with `-o -`."""
    context = click.get_current_context(silent=True)
    click.echo(text, err=context is not None and TAKEN in context.meta)


def print_line(text: str) -> None:
    """Print one line."""
    say(printable(text))


def print_table(columns: Sequence[str], rows: Iterable[Sequence[object]], numbers: Sequence[str] = ()) -> None:
    """Print an aligned table; the columns that hold numbers are aligned at their right.

    On a terminal it is as wide as the terminal, elsewhere as wide as its content.
    """
    from rich import box  # noqa: PLC0415 - a command that prints no table need not load rich
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415
    from rich.text import Text  # noqa: PLC0415

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for column in columns:
        table.add_column(column, justify="right" if column in numbers else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDEST)
        console.width = console.measure(table).maximum
    with console.capture() as shown:
        console.print(table)
    for line in shown.get().splitlines():
        say(line.rstrip())
