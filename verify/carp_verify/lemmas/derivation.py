"""Terms derived from the Python functions that they are about, so that a changed function changes the lemma.

The function itself runs, with arguments that stand for any whole numbers. At each comparison one run continues as if it
held, and another as if it did not. The term says that a run that returned true assumed right. So the function may hold
any statement of Python; what is done to a number but adding, subtracting and comparing raises a `TypeError`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

from carp_verify.lemmas.smt import Bool, Int, all_of, any_of, equal, negation, never, number


@dataclass(slots=True)
class Way:
    """One run of a function: the answers planned for its first comparisons, all answers, and what they assume."""

    planned: list[bool]
    answers: list[bool] = field(default_factory=list)
    conditions: list[Bool] = field(default_factory=list)

    def goes(self, term: Bool) -> bool:
        """Assume that the term holds or not: as planned, and behind the plan that it holds."""
        place = len(self.answers)
        answer = place >= len(self.planned) or self.planned[place]
        self.answers.append(answer)
        self.conditions.append(term if answer else negation(term))
        return answer

    def number(self, term: Int) -> int:
        """An argument that stands for the term."""
        return cast("int", _Number(self, term))

    def number_unless(self, is_none: Bool, term: Int) -> int | None:
        """An argument that is `None` if that holds, else stands for the term."""
        return None if self.goes(is_none) else self.number(term)


@dataclass(frozen=True, slots=True, eq=False)
class _Number:
    """A whole number that stands for a term in one run of a function."""

    way: Way
    term: Int

    def __add__(self, other: "_Number | int") -> "_Number":
        return _Number(self.way, self.term + _term(other))

    def __radd__(self, other: int) -> "_Number":
        return self + other

    def __sub__(self, other: "_Number | int") -> "_Number":
        return _Number(self.way, self.term - _term(other))

    def __rsub__(self, other: int) -> "_Number":
        return _Number(self.way, number(other) - self.term)

    def __le__(self, other: "_Number | int") -> bool:
        return self.way.goes(self.term <= _term(other))

    def __lt__(self, other: "_Number | int") -> bool:
        return self.way.goes(self.term < _term(other))

    def __ge__(self, other: "_Number | int") -> bool:
        return self.way.goes(self.term >= _term(other))

    def __gt__(self, other: "_Number | int") -> bool:
        return self.way.goes(self.term > _term(other))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Number | int) and self.way.goes(equal(self.term, _term(other)))

    def __bool__(self) -> bool:
        return self != 0

    __hash__ = None  # type: ignore[assignment]


def _term(value: _Number | int) -> Int:
    return value.term if isinstance(value, _Number) else number(value)


def derived(function: Callable[[Way], object]) -> Bool:
    """When the function returns true, as a term; the function makes its arguments by the way that it is given."""
    ways: list[Bool] = []
    planned: list[bool] = []
    while True:
        way = Way(planned)
        if function(way):
            ways.append(all_of(*way.conditions) if way.conditions else negation(never()))
        planned = list(way.answers)
        while planned and not planned[-1]:
            planned.pop()
        if not planned:
            return any_of(*ways) if ways else never()
        planned[-1] = False
