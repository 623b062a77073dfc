"""Checks refutations with hints: that no assignment satisfies a formula.

The text is LRAT without RAT steps. The clauses of the formula have the numbers 1, 2, ... A line

    NUMBER LITERAL ... 0 HINT ... 0

adds a clause under a new number. Its hints show that it follows from the clauses before it: assume that all its
literals are false; then the clause of each hint has at most one literal that is not false, which must be true, and the
clause of the last hint has none. A line `NUMBER d HINT ... 0` deletes clauses. The refutation ends with the empty
clause, and nothing follows it. Source of the format: Cruz-Filipe, Heule, Hunt, Kaufmann and Schneider-Kamp 2017.

The author of the steps is not trusted. The literals that the hints look at are counted before the first step is
checked, and the time is proportional to their number.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from carp_verify.optimum.clauses import Clause

LARGEST_REFUTATION: Final = 50_000_000
"""The most literals that the hints of a refutation may look at together."""

_NUMBER = "[1-9][0-9]{0,17}"
_LINE = re.compile(rf"({_NUMBER}) ((?:-?{_NUMBER} )*)0 ((?:{_NUMBER} )*)0")
_FORGETTING = re.compile(rf"{_NUMBER} d ((?:{_NUMBER} )*)0")
_DRAT = re.compile(rf"(?:d )?(?:-?{_NUMBER} )*0")


class NotRefutedError(ValueError):
    """The reason why a text does not show that a formula has no model."""


@dataclass(frozen=True, slots=True)
class Step:
    """A line: a clause to add with its hints, or, where `clause` is `None`, the numbers of clauses to forget."""

    line: int
    number: int
    clause: Clause | None
    hints: tuple[int, ...]


def require_refutation(clauses: Sequence[Clause], text: str) -> None:
    """Raise `NotRefutedError` unless the text refutes the clauses."""
    steps = read_steps(text)
    _require_size(clauses, steps)
    known = {number: frozenset(clause) for number, clause in enumerate(clauses, start=1)}
    last = len(known)
    for step in steps:
        if step.clause is None:
            for number in step.hints:
                known.pop(number, None)
            continue
        if step.number <= last:
            raise NotRefutedError(f"line {step.line} must have a number above {last}")
        _require_step(step, step.clause, known)
        if not step.clause and step is steps[-1]:
            return
        if not step.clause:
            raise NotRefutedError(f"line {step.line + 1} must not follow the empty clause")
        last = step.number
        known[last] = frozenset(step.clause)
    raise NotRefutedError("it does not end with the empty clause")


def read_steps(text: str) -> list[Step]:
    """The lines of a refutation; raises `NotRefutedError` for one that is malformed."""
    lines = text.removesuffix("\n").split("\n") if text else []
    return [_step(line, content) for line, content in enumerate(lines, start=1)]


def _step(line: int, content: str) -> Step:
    if added := _LINE.fullmatch(content):
        number, literals, hints = added.groups()
        return Step(line, int(number), tuple(map(int, literals.split())), tuple(map(int, hints.split())))
    if forgetting := _FORGETTING.fullmatch(content):
        return Step(line, 0, None, tuple(map(int, forgetting[1].split())))
    if _DRAT.fullmatch(content):
        message = f"line {line} has no hints: refutations without hints (DRAT), as carproof 0.1 wrote, are not accepted"
        raise NotRefutedError(message)
    raise NotRefutedError(f"line {line} must be a clause with its hints, or numbers to forget, of at most 18 digits")


def _require_size(clauses: Sequence[Clause], steps: Sequence[Step]) -> None:
    length = {number: len(clause) for number, clause in enumerate(clauses, start=1)}
    size = 0
    for step in steps:
        if step.clause is not None:
            size += len(step.clause) + sum(length.get(hint, 0) for hint in step.hints)
            length[step.number] = len(step.clause)
    if size > LARGEST_REFUTATION:
        raise NotRefutedError(f"its hints look at {size} literals, and at most {LARGEST_REFUTATION} are allowed")


def _require_step(step: Step, clause: Clause, known: Mapping[int, frozenset[int]]) -> None:
    """Raise `NotRefutedError` unless the clause follows from known ones along its hints."""
    true = {-literal for literal in clause}
    for hint in step.hints:
        if hint not in known:
            raise NotRefutedError(f"line {step.line} has the hint {hint}, which is the number of no clause there")
        possible = [literal for literal in known[hint] if -literal not in true]
        if not possible:
            return
        if len(possible) > 1:
            raise NotRefutedError(f"line {step.line} has the hint {hint}, whose clause leaves several literals open")
        true.add(possible[0])
    raise NotRefutedError(f"line {step.line} does not follow from its hints")
