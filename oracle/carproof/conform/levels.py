"""The levels of conformance; each asks all that the ones before it ask."""

from collections.abc import Mapping
from enum import IntEnum

from carproof.conform.cases import Op


class Level(IntEnum):
    """What is asked of a program."""

    SOUND = 1
    COMPLETE = 2
    CONTEXT_OPTIMAL = 3
    OPTIMAL = 4
    EXACT = 5

    @property
    def label(self) -> str:
        """The name on the command line and in reports."""
        return self.name.lower().replace("_", "-")

    @property
    def statement(self) -> str:
        """What a program of the level does."""
        return _STATEMENTS[self]


_STATEMENTS = {
    Level.SOUND: "no plan breaks a rule",
    Level.COMPLETE: "a robot is left without a plan only where there is none",
    Level.CONTEXT_OPTIMAL: "each query arrives as early as the plans before it allow",
    Level.OPTIMAL: "the total cost is the optimum that carproof's search finds",
    Level.EXACT: "the plans are carproof's, visit for visit",
}
CLASSICAL_LEVELS = (Level.SOUND, Level.COMPLETE, Level.OPTIMAL)
"""The levels of planners whose answers do not tell in which order the plans were made."""
LEVELS = {level.label: level for level in Level}
JUDGED_OPS: Mapping[Level, tuple[Op, ...]] = {
    Level.SOUND: ("check", "query", "plan", "add", "polish", "bound"),
    Level.COMPLETE: ("query", "plan", "add"),
    Level.CONTEXT_OPTIMAL: ("query", "plan"),
    Level.OPTIMAL: ("optimum",),
    Level.EXACT: ("query", "plan", "add", "polish"),
}
"""The ops by which a level is shown: a program that offers none of them has not reached it. `optimum` is asked from
`optimal` on; `check`, `polish` and `bound` are asked at all levels, but show `complete` of nobody."""
