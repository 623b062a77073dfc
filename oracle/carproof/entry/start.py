"""The entry of the command `carproof`: heeds SIGINT and SIGTERM before anything else is loaded."""

import _signal  # type: ignore[import-not-found] # Python has loaded it already; signal is slow to load
import os
import sys
from time import perf_counter

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType


def main() -> int:
    """Run the command line of this process, and return its exit code."""
    began = perf_counter()
    for number in (_signal.SIGINT, _signal.SIGTERM):
        if _signal.getsignal(number) != _signal.SIG_IGN:
            _signal.signal(number, leave)
    from carproof.entry import cli  # noqa: PLC0415 - an interruption while it is loaded must show no traceback

    return cli.main(began=began)


def leave(number: int, _: "FrameType | None") -> None:
    """End the process, which has no file and no child yet."""
    if sys.stderr is not None:
        os.write(2, b"Interrupted.\n")
    os._exit(128 + number)
