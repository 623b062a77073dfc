"""z3 with types: the few terms that lemmas and certificates need, and one question, `find_model`.

Importing this module loads z3. Comparisons of terms give terms, so Python's `==` and chained comparisons have no
meaning here: use `equal` and `between`.
"""

from collections.abc import Iterable, Sequence
from typing import NewType, Protocol

import z3

Bool = NewType("Bool", object)
Answer = int | bool

LIMIT_MILLISECONDS = 20_000


class Int(Protocol):
    """A term whose value is a whole number, of any size."""

    def __add__(self, other: "Int | int", /) -> "Int":
        """Sum."""

    def __sub__(self, other: "Int | int", /) -> "Int":
        """Difference."""

    def __mul__(self, other: "Int | int", /) -> "Int":
        """Product."""

    def __le__(self, other: "Int | int", /) -> Bool:
        """At most."""

    def __lt__(self, other: "Int | int", /) -> Bool:
        """Less than."""

    def __ge__(self, other: "Int | int", /) -> Bool:
        """At least."""

    def __gt__(self, other: "Int | int", /) -> Bool:
        """Greater than."""


class Undecided(Exception):  # noqa: N818 - z3's answer is `unknown`; that is no fault of the program
    """z3 could not decide within the limit."""


def integer(name: str) -> Int:
    """A whole number about which nothing is known."""
    term: Int = z3.Int(name)
    return term


def integers(names: str) -> Sequence[Int]:
    """Whole numbers by their names, parted by spaces."""
    return [integer(name) for name in names.split()]


def truth(name: str) -> Bool:
    """A truth value about which nothing is known."""
    return Bool(z3.Bool(name))


def never() -> Bool:
    """The term that never holds."""
    return Bool(z3.BoolVal(val=False))


def all_of(*terms: Bool) -> Bool:
    """Whether all hold."""
    return terms[0] if len(terms) == 1 else Bool(z3.And(*terms))


def any_of(*terms: Bool) -> Bool:
    """Whether any holds."""
    return terms[0] if len(terms) == 1 else Bool(z3.Or(*terms))


def negation(term: Bool) -> Bool:
    """Whether it does not hold."""
    return Bool(z3.Not(term))


def implies(premise: Bool, conclusion: Bool) -> Bool:
    """Whether the conclusion holds if the premise does."""
    return Bool(z3.Implies(premise, conclusion))


def same(one: Bool, other: Bool) -> Bool:
    """Whether both hold or neither."""
    return Bool(one == other)


def equal(one: Int, other: Int | int) -> Bool:
    """Whether two numbers are the same."""
    return Bool(one == other)


def between(least: Int | int, term: Int, end: Int | int) -> Bool:
    """Whether the term is in the half-open interval [least, end)."""
    return all_of(term >= least, term < end)


def choose(condition: Bool, yes: Int | int, no: Int | int) -> Int:
    """The first number if the condition holds, else the second."""
    term: Int = z3.If(condition, number(yes), number(no))
    return term


def number(value: Int | int) -> Int:
    """A known number as a term."""
    term: Int = z3.IntVal(value) if isinstance(value, int) else value
    return term


def counted(condition: Bool) -> Int:
    """One if the condition holds, else none."""
    return choose(condition, 1, 0)


def greater(one: Int | int, other: Int | int) -> Int:
    """The greater of two numbers."""
    return choose(number(one) >= other, one, other)


def at_least(count: int, terms: Sequence[Bool]) -> Bool:
    """Whether at least `count` of the terms hold.

    If `count` exceeds their number, they never do. z3 is not asked then; its C interface takes no count from 2^31 on.
    """
    if count > len(terms):
        return never()
    return Bool(z3.AtLeast(*terms, count))


def value_of(term: Int | Bool, values: dict[str, Answer]) -> Answer:
    """The value of a term once its unknowns have these values."""
    pairs = [
        (z3.Bool(name), z3.BoolVal(value)) if isinstance(value, bool) else (z3.Int(name), z3.IntVal(value))
        for name, value in values.items()
    ]
    return _python(z3.simplify(z3.substitute(term, *pairs)))


class Model:
    """Values for the unknowns, under which the formulas asked about hold."""

    def __init__(self, model: "z3.ModelRef") -> None:
        self._model = model

    def value(self, term: Int | Bool) -> Answer:
        """The term's value."""
        return _python(self._model.evaluate(term, model_completion=True))

    def __str__(self) -> str:
        """Print like `a = 0, b = 3`, by name."""
        shown = [(str(each), self._model[each]) for each in self._model.decls()]
        return ", ".join(f"{name} = {str(value).replace(chr(10), '')}" for name, value in sorted(shown))


class Solver:
    """Answers independent questions one after another; for many small ones this is faster than a solver for each."""

    def __init__(self, limit: int = LIMIT_MILLISECONDS) -> None:
        self._solver = z3.SimpleSolver()
        self._solver.set("timeout", limit)

    def find_model(self, formulas: Iterable[Bool]) -> Model | None:
        """A model of the formulas, or `None` if they contradict each other; raises `Undecided` on `unknown`."""
        self._solver.push()
        try:
            self._solver.add(*formulas)
            answer = self._solver.check()
            if answer == z3.unknown:
                raise Undecided(f"z3 answers unknown: {self._solver.reason_unknown()}")
            return Model(self._solver.model()) if answer == z3.sat else None
        finally:
            self._solver.pop()


def find_model(formulas: Iterable[Bool], limit: int = LIMIT_MILLISECONDS) -> Model | None:
    """Answer a single question: see `Solver.find_model`."""
    return Solver(limit).find_model(formulas)


def _python(value: object) -> Answer:
    if z3.is_true(value) or z3.is_false(value):
        return bool(z3.is_true(value))
    if z3.is_int_value(value):
        return int(str(value))
    raise ValueError(f"{value} is no known value")
