"""Subjects: anything that can answer a case."""

from typing import Protocol

from carproof.conform.answers import Reply
from carproof.conform.cases import Case


class Subject(Protocol):
    """A subject that answers cases; `ops` are the ops that it offers."""

    @property
    def name(self) -> str:
        """Its name in reports."""

    @property
    def ops(self) -> tuple[str, ...]:
        """The ops that it offers."""

    def start(self) -> None:
        """Get ready; raises `Fault` if that fails."""

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Its reply, within this many seconds (`None`: the usual limit); raises `Fault` without a reply to judge."""

    def finish(self) -> None:
        """End; raises `Fault` if that fails."""

    def kill(self) -> None:
        """Leave nothing behind."""
