"""A pytest plugin for `make coverage`, which runs the compiled planner's tests uncompiled, hundreds of times as slowly.

A test ends after `SECONDS` of processor time, and counts as skipped; the lines that it has reached count.
"""

import signal
from collections.abc import Generator
from types import FrameType

import pytest

SECONDS = 20


def _end(_: int, frame: FrameType | None) -> None:
    """End the test, but not while coverage holds its lock, for which it would wait for ever."""
    while frame is not None:
        if frame.f_globals.get("__name__", "").startswith("coverage."):
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.01)
            return
        frame = frame.f_back
    pytest.skip(f"over after {SECONDS} s, as it runs uncompiled")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Generator[None, None, None]:
    """End the test when its time is over."""
    signal.signal(signal.SIGVTALRM, _end)
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
