"""The time of a search, by a clock that gives nanoseconds."""

from collections.abc import Callable
from itertools import count
from time import monotonic_ns

NANOSECONDS = 1_000_000_000
LONGEST = 10**9  # more seconds than anybody waits


class TimeOver(Exception):  # noqa: N818 - no error: the limit that the user gave
    """The deadline has passed."""


class Deadline:
    """A moment some seconds from now."""

    __slots__ = ("_clock", "_end", "_start")

    def __init__(self, seconds: float, clock: Callable[[], int] = monotonic_ns) -> None:
        """Begin now; `clock` gives nanoseconds."""
        self._clock = clock
        self._start = clock()
        self._end = self._start + int(min(seconds, LONGEST) * NANOSECONDS)

    def check(self, ahead: int = 0) -> None:
        """Raise `TimeOver` if it has passed, or will have in that many nanoseconds."""
        if self._clock() + ahead >= self._end:
            raise TimeOver

    def is_past(self, of: int) -> bool:
        """Whether one of a number of equal parts of the time until it has gone by."""
        return (self._clock() - self._start) * of >= self._end - self._start

    def clock(self) -> float:
        """Its clock, in seconds."""
        return self._clock() / NANOSECONDS

    def left(self) -> float:
        """The seconds until it, or fewer than 0."""
        return (self._end - self._clock()) / NANOSECONDS

    def part(self, of: int) -> "Deadline":
        """A deadline after one of a number of equal parts of the same time, from now."""
        return Deadline((self._end - self._start) / NANOSECONDS / of, self._clock)


LOOKS = 400
"""The seconds after which a search is given up that goes by `clock_of`."""


def clock_of(check: Callable[[], None]) -> Callable[[], int]:
    """A clock that goes a second with each look at it, so the same on every machine; `check` is called at each."""
    looks = count()

    def clock() -> int:
        check()
        return next(looks) * NANOSECONDS

    return clock
