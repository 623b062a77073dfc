"""The levels of conformance.

There are two kinds of completeness. A prioritized planner can find each robot's plan beside the plans before it
(complete in context), and still leave out a robot that would have a plan if the others made room (not complete).
"""

from collections.abc import Mapping
from enum import IntEnum

EXAMPLES = 200
"""The number of random cases, unless one is given."""
LARGE_SECONDS = 30.0
"""The time for large cases, unless one is given."""


class Level(IntEnum):
    """The level at which a program is judged; each level demands everything that the lower ones demand.

    Planners of whole instances are judged either in the order of their plans, up to `CONTEXT_OPTIMAL`, or on all robots
    together; then the order of their plans does not count.
    """

    SOUND = 1
    COMPLETE_IN_CONTEXT = 2
    CONTEXT_OPTIMAL = 3
    COMPLETE = 4
    OPTIMAL = 5
    EXACT = 6

    @property
    def label(self) -> str:
        """The name on the command line and in reports."""
        return self.name.lower().replace("_", "-")

    @property
    def statement(self) -> str:
        """The claim that a program of the level makes."""
        return _STATEMENTS[self]


_STATEMENTS = {
    Level.SOUND: "no plan breaks a rule",
    Level.COMPLETE_IN_CONTEXT: "a robot is left out only if earlier plans leave no plan",
    Level.CONTEXT_OPTIMAL: "each plan arrives as early as the plans before it allow",
    Level.COMPLETE: "no robot is left out where all can have plans",
    Level.OPTIMAL: "the total cost is the least that carproof's search finds",
    Level.EXACT: "the plans are carproof's, visit for visit",
}
LEVELS = {level.label: level for level in Level}
WHOLE_LEVELS = tuple(level for level in Level if level != Level.EXACT)
"""The levels of planners of whole instances, which choose planner and order themselves."""
CLASSICAL_LEVELS = (Level.SOUND, Level.COMPLETE, Level.OPTIMAL)
"""The levels of planners whose answers do not tell in which order the plans were made."""
EXECUTOR_LEVELS: Mapping[Level, str] = {
    Level.SOUND: "robots do not collide, and all arrive",
    Level.EXACT: "robots do not collide, all arrive, and each resource is entered in the planned order",
}
"""The levels of executors, and what they claim."""
JUDGED_OPS: Mapping[Level, tuple[str, ...]] = {
    Level.SOUND: ("check", "query", "plan", "add", "polish", "bound"),
    Level.COMPLETE_IN_CONTEXT: ("query", "plan", "add"),
    Level.CONTEXT_OPTIMAL: ("query", "plan"),
    Level.COMPLETE: ("optimum",),
    Level.OPTIMAL: ("optimum",),
    Level.EXACT: ("query", "plan", "add", "polish"),
}
"""The ops by which a level is shown: a program that offers none of them has not reached it. `optimum` is asked from
`complete` on; `check`, `polish` and `bound` are asked at all levels, but show completeness of nobody."""
