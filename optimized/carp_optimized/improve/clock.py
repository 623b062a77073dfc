"""The time that is over, and how much of what is left each part of a search may take.

A clock is looked at after each few milliseconds of work.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

ALL = 8
"""All eighths of the time."""


@dataclass(slots=True)
class Clock:
    """The time that is over, as far as it counts: none where rounds are counted."""

    seconds: float | None
    now: Callable[[], float]
    started: float
    visit: float = 0.0
    """The seconds that each visit takes at the end."""
    reserved: float = 0.0
    begun: float = 0.0
    """When the phases began that share the rest of the time by eighths."""

    @property
    def spent(self) -> float:
        """The seconds since the start."""
        return self.now() - self.started

    def left(self, eighths: int = ALL) -> float:
        """The seconds that are left of so many eighths of the time."""
        spent = self.spent  # also where rounds are counted: `now` may end the search by an exception
        if self.seconds is None:
            return inf
        return self.begun + (self.seconds - self.reserved - self.begun) * eighths / ALL - spent

    def goes_on(self, eighths: int = ALL) -> bool:
        """Whether so many eighths of the time are not over."""
        return self.left(eighths) > 0

    def reserve(self, visits: int) -> None:
        """Leave time for that many visits."""
        self.reserved = self.visit * visits
