"""One line on standard error, written anew, that tells how far an open-ended search is; only on a terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def gauge() -> Iterator[Callable[[str], None]]:
    """What it yields shows a line; the line is gone at the end."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console  # noqa: PLC0415 - loaded only where there is a line to show

    with Console(stderr=True).status("searching ...") as line:
        yield line.update
