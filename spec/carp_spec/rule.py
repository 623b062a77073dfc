"""Rules, and the reports of broken ones.

A rule has a stable id, one statement, a source and one predicate, the function that decides it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial, wraps
from typing import Generic, ParamSpec, TypeAlias, TypeGuard, TypeVar

from carp_spec.model import ResourceId, RobotId, Visit

P = ParamSpec("P")
R = TypeVar("R")

DESIGN = "decision of carproof"
MORS = "ter Mors 2010"
MOST_NAMED = 5


@dataclass(frozen=True, slots=True)
class Rule(Generic[P, R]):
    """A rule; if its predicate yields violations or faults, it is kept when there are none."""

    id: str
    statement: str
    source: str
    predicate: Callable[P, R]

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Ask the predicate."""
        return self.predicate(*args, **kwargs)


def rule(id: str, statement: str, source: str) -> Callable[[Callable[P, R]], Rule[P, R]]:
    """Make the decorated predicate a rule."""
    return lambda predicate: Rule(id, statement, source, predicate)


@dataclass(frozen=True, slots=True)
class Violation:
    """A broken rule of plans.

    It happened at `resource` in the ticks [start, end); a start of `None` means that no resource or tick is to blame. A
    resource that is too full is one violation for as long as it stays too full, with all `robots` in it at any of these
    ticks.
    """

    rule: str
    robots: tuple[RobotId, ...]
    resource: ResourceId | None
    start: int | None
    end: int | None
    reason: str

    @property
    def message(self) -> str:
        """The violation as one sentence, without the rule's id."""
        robots = named(self.robots)
        if self.start is None:
            return f"{robots} ({self.reason})"
        return f"resource {self.resource} in {interval(self.start, self.end)}: {robots} ({self.reason})"

    def __str__(self) -> str:
        """Print like `[joint/capacity] resource 3,4 in [5,7): robots r1, r9 (capacity 1)`."""
        return f"[{self.rule}] {self.message}"


@dataclass(frozen=True, slots=True)
class Fault:
    """A broken rule of an instance or of options, at a path in the document."""

    rule: str
    path: str
    message: str


def is_whole(value: object) -> TypeGuard[int]:
    """Whether the value is a whole number; `True` and `1.0` are not."""
    return isinstance(value, int) and not isinstance(value, bool)


def is_between(value: object, least: int, most: int | None = None) -> bool:
    """Whether the value is a whole number between the two, both included."""
    return is_whole(value) and value >= least and (most is None or value <= most)


def interval(start: int, end: int | None) -> str:
    """Print a half-open interval of ticks; an end of `None` means for ever."""
    return f"[{start},{'for ever' if end is None else end})"


def named(robots: Sequence[RobotId]) -> str:
    """Print like `robot r1` or `robots r1, r2 and 3 more`."""
    names = ", ".join(map(str, robots[:MOST_NAMED]))
    others = f" and {len(robots) - MOST_NAMED} more" if len(robots) > MOST_NAMED else ""
    return f"{'robot' if len(robots) == 1 else 'robots'} {names}{others}"


Found: TypeAlias = Iterator[tuple[str, str]]
"""Faults without their rule: path and message."""

Breach: TypeAlias = tuple[tuple[RobotId, ...], ResourceId | None, int | None, int | None, str]
"""A violation without the rule: robots, resource, start, end and reason."""


def at_visit(robot: RobotId, visit: Visit, reason: str) -> Breach:
    """Blame one visit of one robot."""
    return (robot,), visit.resource, visit.enter, visit.leave, reason


def of_robots(robots: Sequence[RobotId], reason: str) -> Breach:
    """Blame robots, but no resource and no tick."""
    return tuple(robots), None, None, None, reason


def violation_rule(
    id: str, statement: str, source: str
) -> Callable[[Callable[P, Iterator[Breach]]], Rule[P, Iterator[Violation]]]:
    """Make the decorated predicate, which yields breaches, a rule that yields violations."""
    return lambda predicate: Rule(id, statement, source, _reporting(partial(Violation, id), predicate))


def fault_rule(id: str, statement: str, source: str) -> Callable[[Callable[P, Found]], Rule[P, Iterator[Fault]]]:
    """Make the decorated predicate, which yields paths and messages, a rule that yields faults."""
    return lambda predicate: Rule(id, statement, source, _reporting(partial(Fault, id), predicate))


def _reporting(
    report: Callable[..., R], predicate: Callable[P, Iterator[tuple[object, ...]]]
) -> Callable[P, Iterator[R]]:
    @wraps(predicate)
    def reports(*args: P.args, **kwargs: P.kwargs) -> Iterator[R]:
        return (report(*found) for found in predicate(*args, **kwargs))

    return reports
