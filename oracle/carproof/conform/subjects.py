"""Who is asked: whatever can answer a case."""

from typing import Protocol

from carproof.conform.answers import Reply
from carproof.conform.cases import Case


class Subject(Protocol):
    """Somebody who answers cases; `ops` are the ops that it offers."""

    @property
    def name(self) -> str:
        """What it is called in reports."""

    @property
    def ops(self) -> tuple[str, ...]:
        """The ops that it offers."""

    def start(self) -> None:
        """Get ready; raises `Fault` if that goes wrong."""

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Its reply, within this many seconds (`None`: the usual limit); raises `Fault` if none exists to judge."""

    def finish(self) -> None:
        """Bid farewell; raises `Fault` if that goes wrong."""

    def kill(self) -> None:
        """Leave nothing behind."""
