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

    def text(self, data: bytes, file: str) -> str:
        """The data as text; raises its refusal with file and line if they are not UTF-8."""
        try:
            return data.decode()
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            raise self.refuse(f"{file}:{line}", "it must be UTF-8") from None
