"""Progress of long work: a bar on standard error, if that is a terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter

from carp_verify.bound.rules import require_kept

WIDTH = 16  # of a bar beside words, so that totals of seven digits fit into eighty columns


@contextmanager
def progress(label: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a bar; the function that it yields is to be called at each step."""
    if not sys.stderr.isatty():
        yield lambda: None
        return
    from rich.console import Console  # noqa: PLC0415 - loaded only where there is a bar to show
    from rich.progress import Progress  # noqa: PLC0415

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=steps)
        yield lambda: bar.advance(task)


@contextmanager
def search_progress(label: str, most: int | None, seconds: float | None) -> Iterator[Callable[[int, str], None]]:
    """Show a bar of steps, or of seconds if given; yields a function that takes the steps and a text."""
    if not sys.stderr.isatty():
        yield lambda _, __: None
        return
    from rich.console import Console  # noqa: PLC0415 - loaded only where there is a bar to show
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    columns = (TextColumn(label), BarColumn(WIDTH), TimeRemainingColumn(), TextColumn("{task.description}"))
    started = perf_counter()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=most if seconds is None else seconds)

        def advance(steps: int, found: str) -> None:
            done = steps if seconds is None else perf_counter() - started
            bar.update(task, completed=done, description=found)

        yield advance


def found_so_far(total: int | None, bound: int, unplanned: int = 0) -> str:
    """The best total known, if any, the bound, and the gap between them, in a few words."""
    if total is None:
        return f"bound {bound}"
    near = f"{unplanned} unplanned" if unplanned else f"gap {gap(total, bound)}"
    return f"total {total}, bound {bound}, {near}"


def gap(total: int, bound: int) -> str:
    """By how much the total is above the bound; raises `ContradictionError` if it is below."""
    require_kept(bound, total)
    return f"{100 * (total - bound) / bound:.2f} %" if bound else "-"
