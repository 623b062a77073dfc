"""The engine of the lemmas: z3 checks that a claim follows from premises, and that its mutants do not.

A formula is checked if z3 shows that the premises can hold and that the claim cannot fail under them. A mutant is a
formula with one planted error; it is refuted by a model in which its premises hold and its claim does not. This catches
premises that contradict each other and claims that are always true. z3's `unknown` is a failure.

z3 and the Python that writes the formulas are trusted. The induction from a step to the whole, and the link from the
formula to the program, are not checked here: each lemma's docstring names what is left.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from carp_verify.lemmas.smt import Bool, Model, Undecided, find_model, negation


@dataclass(frozen=True, slots=True)
class Formula:
    """A claim that follows from premises. The claim of a mutant does not, and its name is the planted error."""

    name: str
    premises: Sequence[Bool]
    claim: Bool


@dataclass(frozen=True, slots=True)
class Lemma:
    """A statement with the part left to argue by hand, the rules that it supports, its formulas and their mutants."""

    name: str
    statement: str
    rules: tuple[str, ...]
    formulas: Callable[[], Iterator[Formula]]
    mutants: Callable[[], Iterator[Formula]]


@dataclass(frozen=True, slots=True)
class LemmaReport:
    """z3's answers for a lemma: it is checked if there are formulas and mutants and no failure."""

    lemma: Lemma
    formulas: tuple[str, ...]
    refuted: tuple[tuple[str, str], ...]
    failures: tuple[str, ...]

    @property
    def checked(self) -> bool:
        """Whether every formula is proved and every mutant refuted, and there is at least one of each."""
        return bool(self.formulas) and bool(self.refuted) and not self.failures


class Unproved(Exception):  # noqa: N818 - like Refusal: nothing went wrong in the program
    """A formula that z3 does not prove or a mutant that it does not refute, and why."""


def prove(premises: Sequence[Bool], claim: Bool) -> None:
    """Have z3 prove that the premises imply the claim, whatever whole numbers the unknowns are, or raise `Unproved`."""
    try:
        if find_model(premises) is None:
            raise Unproved("the premises contradict each other")
        counterexample = find_model([*premises, negation(claim)])
    except Undecided as undecided:
        raise Unproved(str(undecided)) from undecided
    if counterexample is not None:
        raise Unproved(f"it fails where {counterexample}")


def refute(premises: Sequence[Bool], claim: Bool) -> Model:
    """Find a model in which the premises hold and the claim does not, or raise `Unproved`."""
    try:
        model = find_model([*premises, negation(claim)])
    except Undecided as undecided:
        raise Unproved(str(undecided)) from undecided
    if model is None:
        raise Unproved("it is no error: nothing refutes it")
    return model


def examine(lemma: Lemma) -> LemmaReport:
    """Have z3 prove every formula of the lemma and refute every mutant."""
    proved: list[str] = []
    refuted: list[tuple[str, str]] = []
    failures: list[str] = []
    for formula in lemma.formulas():
        try:
            prove(formula.premises, formula.claim)
            proved.append(formula.name)
        except Unproved as reason:
            failures.append(f"formula {formula.name!r} is not proved: {reason}")
    for mutant in lemma.mutants():
        try:
            refuted.append((mutant.name, str(refute(mutant.premises, mutant.claim))))
        except Unproved as reason:
            failures.append(f"mutant {mutant.name!r} is not refuted: {reason}")
    return LemmaReport(lemma, tuple(proved), tuple(refuted), tuple(failures))
