"""The one exception that carproof raises for bad input."""

from typing import Literal, TypeAlias

RefusalKind: TypeAlias = Literal["document", "request", "option", "limit"]

MOST_SHOWN = 1000  # characters of a message; of a longer one, which repeats a long value, the middle is left out


class Refusal(Exception):  # noqa: N818 - the input is refused; nothing went wrong here
    """Input that is refused: its kind, the path in the document, the broken rule, and what would be right.

    The kind `limit` is for a size that would exhaust memory.
    """

    def __init__(self, kind: RefusalKind, path: str, rule: str, message: str) -> None:
        super().__init__(kind, path, rule, message)
        if len(message) > MOST_SHOWN:
            half = MOST_SHOWN // 2 - len("...")
            message = f"{message[:half]} ... {message[-half:]}"
        self.kind = kind
        self.path = path
        self.rule = rule
        self.message = message

    def __str__(self) -> str:
        """One sentence with path and rule."""
        return f"{self.path}: {self.message} [{self.rule}]"
