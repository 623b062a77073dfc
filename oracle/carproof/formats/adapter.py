"""Adapters: formats of other planners' solutions, read and written."""

from collections.abc import Callable
from dataclasses import dataclass

from carp_spec import Instance, Solution

LONGEST_HEAD = 10_000
"""The characters of a line that names columns."""


@dataclass(frozen=True, slots=True)
class Adapter:
    """A format: how it is recognised, read and written.

    `read` takes the text, the instance and the name of the file, and raises `Refusal` with file and line. `agent` is
    the name of agents in a file, before their number; `None` if the format has no names for them.
    """

    name: str
    description: str
    looks_like: Callable[[str], bool]
    read: Callable[[str, Instance, str], Solution]
    write: Callable[[Instance, Solution], str]
    agent: str | None = None


def first_line(text: str) -> str:
    """The first line, or as much of it as names columns: a document may be one line of millions of characters."""
    return text[:LONGEST_HEAD].partition("\n")[0]
