"""Progress of long work: a bar on standard error, if that is a terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter


@contextmanager
def progress(label: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a bar; what it yields is to be called at each step."""
    if not sys.stderr.isatty():
        yield lambda: None
        return
    from rich.console import Console  # noqa: PLC0415 - loaded only where there is a bar to show
    from rich.progress import Progress  # noqa: PLC0415

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=steps)
        yield lambda: bar.advance(task)


@contextmanager
def polish_progress(
    iterations: int | None, seconds: float | None, bound: int
) -> Iterator[Callable[[int, int, int], None]]:
    """Show a bar, and how near the total has come to the bound; what it yields is told rounds, unplanned, total."""
    if not sys.stderr.isatty():
        yield lambda _, __, ___: None
        return
    from rich.console import Console  # noqa: PLC0415 - loaded only where there is a bar to show
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    columns = (TextColumn("polishing"), BarColumn(20), TimeRemainingColumn(), TextColumn("{task.description}"))
    started = perf_counter()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=iterations if seconds is None else seconds)

        def advance(rounds: int, unplanned: int, total: int) -> None:
            near = f"{unplanned} unplanned" if unplanned else f"gap {gap(total, bound)}"
            done = rounds if seconds is None else perf_counter() - started
            bar.update(task, completed=done, description=f"total {total}, bound {bound}, {near}")

        yield advance


def gap(total: int, bound: int) -> str:
    """By how much the total is above the bound."""
    return f"{100 * (total - bound) / bound:.2f} %" if bound else "-"
