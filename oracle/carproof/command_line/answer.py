"""The answer of a command as its exit code: the same four for every command."""

from enum import IntEnum


class Answer(IntEnum):
    """The exit codes of every command."""

    YES = 0
    NO = 1
    BAD_INPUT = 2
    UNDECIDED = 3

    @classmethod
    def of(cls, holds: bool) -> "Answer":
        """Yes if the claim holds, else no."""
        return cls.YES if holds else cls.NO


PIPE_CLOSED = 141
INTERRUPTED = 130
INTERNAL_ERROR = 70
