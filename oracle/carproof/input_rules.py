"""Requirements that no predicate decides."""

from dataclasses import dataclass

from carp_spec import Refusal


@dataclass(frozen=True, slots=True)
class Code:
    """A requirement on input that is decided where the input is read, by no predicate; refusals quote its id."""

    id: str
    statement: str
    source: str

    def refuse(self, path: str, message: str) -> Refusal:
        """The refusal of a document that does not meet it, at a path or a line."""
        return Refusal("document", path, self.id, message)
