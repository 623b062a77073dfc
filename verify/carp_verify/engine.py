"""The engine of the theorems: a claim is proved from premises, and its mutants are refuted.

To prove is to show that the premises can hold and that the claim cannot fail under them. A mutant is a lemma
with one planted error; to refute it is to show a model in which its premises hold and its claim does not. So a
theorem whose premises contradict each other, or whose claim says nothing, is caught. z3's `unknown` is a failure.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from carp_verify.smt import Bool, Model, Undecided, find_model, negation


@dataclass(frozen=True, slots=True)
class Lemma:
    """A claim that follows from premises; of a mutant, one that does not, and its name tells the planted error."""

    name: str
    premises: Sequence[Bool]
    claim: Bool


@dataclass(frozen=True, slots=True)
class Theorem:
    """A statement proved by its lemmas together, the rules that it supports, and mutants of it."""

    name: str
    statement: str
    rules: tuple[str, ...]
    lemmas: Callable[[], Iterator[Lemma]]
    mutants: Callable[[], Iterator[Lemma]]


@dataclass(frozen=True, slots=True)
class Report:
    """What came of a theorem: it is proved if there are lemmas and mutants and no failure."""

    theorem: Theorem
    lemmas: tuple[str, ...]
    refuted: tuple[tuple[str, str], ...]
    failures: tuple[str, ...]

    @property
    def proved(self) -> bool:
        """Whether every lemma is proved and every mutant refuted, and there is at least one of each."""
        return bool(self.lemmas) and bool(self.refuted) and not self.failures


class Unproved(Exception):  # noqa: N818 - like Refusal: nothing went wrong in the program
    """A lemma that is not proved or a mutant that is not refuted, and why."""


def prove(premises: Sequence[Bool], claim: Bool) -> None:
    """Prove the claim for all whole numbers, or raise `Unproved`."""
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


def examine(theorem: Theorem) -> Report:
    """Prove every lemma of the theorem and refute every mutant."""
    proved: list[str] = []
    refuted: list[tuple[str, str]] = []
    failures: list[str] = []
    for lemma in theorem.lemmas():
        try:
            prove(lemma.premises, lemma.claim)
            proved.append(lemma.name)
        except Unproved as reason:
            failures.append(f"lemma {lemma.name!r} is not proved: {reason}")
    for mutant in theorem.mutants():
        try:
            refuted.append((mutant.name, str(refute(mutant.premises, mutant.claim))))
        except Unproved as reason:
            failures.append(f"mutant {mutant.name!r} is not refuted: {reason}")
    return Report(theorem, tuple(proved), tuple(refuted), tuple(failures))
