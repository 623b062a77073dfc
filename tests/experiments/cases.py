"""Cases for tests of the campaign engine, in a module of their own so that workers can load it."""

import os
import time
from dataclasses import dataclass

from carp_experiments.store import Row


@dataclass(frozen=True, slots=True)
class Square:
    """A case that squares a number, after a while."""

    number: int
    seconds: float = 0.0

    @property
    def key(self) -> str:
        return f"{self.number:04}"

    def run(self) -> Row:
        time.sleep(self.seconds)
        return {"square": self.number**2}


@dataclass(frozen=True, slots=True)
class Lost:
    """A case whose worker dies."""

    key: str = "lost"

    def run(self) -> Row:
        os._exit(1)
