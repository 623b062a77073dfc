"""Requirements that no predicate decides."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Code:
    """A requirement on input that is decided where the input is read, by no predicate; refusals quote its id."""

    id: str
    statement: str
    source: str
