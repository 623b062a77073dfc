"""z3 proves the formulas of the lemmas and refutes their mutants, and the engine accepts nothing else."""

import re
from collections.abc import Callable
from functools import partial
from importlib.resources import files
from pathlib import Path

import pytest
from tests.oracle.running import Run

from carp_verify.lemmas import MODULES, engine, lemma_named
from carp_verify.lemmas.engine import Formula, Lemma, Unproved, examine, prove, refute
from carp_verify.lemmas.smt import Undecided, equal, find_model, integers
from carp_verify.theorems import THEOREMS

KERNEL = Path(__file__).parents[3] / "verify/kernel"


@pytest.mark.parametrize("module", MODULES)
def test_every_formula_is_proved_and_every_mutant_is_refuted(module: str) -> None:
    report = examine(lemma_named(module))
    assert report.failures == ()
    assert report.checked
    assert "\nBy hand: " in report.lemma.statement, "it says what is left to argue"


A, B = integers("a b")


@pytest.mark.parametrize(
    ("decide", "reason"),
    [
        (lambda: prove([A < B], B <= A), "it fails where"),
        (lambda: prove([A < B, B < A], equal(A, B)), "contradict"),
        (lambda: refute([A < B], A <= B), "no error"),
    ],
)
def test_what_fails_has_no_premises_or_is_no_error_is_not_decided(decide: Callable[[], object], reason: str) -> None:
    with pytest.raises(Unproved, match=reason):
        decide()


def test_unknown_is_a_failure() -> None:
    (c,) = integers("c")
    hard = [A > 0, B > 0, c > 0, equal(A * A * A + B * B * B, c * c * c)]
    with pytest.raises(Undecided):
        find_model(hard, limit=100)


def test_what_z3_cannot_decide_is_neither_proved_nor_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    def puzzled(_: object) -> None:
        raise Undecided("z3 answers unknown: timeout")

    monkeypatch.setattr(engine, "find_model", puzzled)
    for decide in (prove, refute):
        with pytest.raises(Unproved, match=r"^z3 answers unknown: timeout$"):
            decide([A < B], A <= B)
    failures = examine(lemma_of([Formula("f", [A < B], A <= B)], [Formula("m", [], A < B)])).failures
    assert [each.partition(":")[0] for each in failures] == ["formula 'f' is not proved", "mutant 'm' is not refuted"]


def lemma_of(formulas: list[Formula], mutants: list[Formula]) -> Lemma:
    return Lemma("t", "s", (), partial(iter, formulas), partial(iter, mutants))


def test_a_lemma_is_checked_by_formulas_and_mutants_without_a_failure() -> None:
    formula, mutant = Formula("f", [A < B], A <= B), Formula("m", [A <= B], A < B)
    for formulas, mutants, checked in (
        ([formula], [mutant], True),
        ([formula], [], False),
        ([], [mutant], False),
        ([formula, mutant], [mutant], False),
        ([formula], [mutant, formula], False),
    ):
        report = examine(lemma_of(formulas, mutants))
        assert report.checked is checked
        assert len(report.failures) == len(formulas[1:]) + len(mutants[1:])
        assert report.formulas == ("f",) * len(formulas[:1])
        assert [(name, shown.partition("=")[0]) for name, shown in report.refuted] == [("m", "a ")] * len(mutants[:1])


def test_the_theorems_are_those_that_coq_is_asked_about() -> None:
    text = files("carp_verify").joinpath("theorems.txt").read_text()
    assert [f"{each.module}.{each.name}" for each in THEOREMS] == re.findall(r"^[A-Z].*", text, re.MULTILINE)
    assert not {each.name for each in THEOREMS} & set(MODULES)


def test_the_file_of_a_theorem_holds_it_with_its_proof() -> None:
    texts = {each.file: (KERNEL.parents[1] / each.file).read_text() for each in THEOREMS}
    for each in THEOREMS:
        assert re.search(rf"^(Theorem|Lemma) {each.name}\b", texts[each.file], re.MULTILINE), each.name


def test_the_command_checks_all_lemmas_and_names_theorems_with_their_files(carproof: Run) -> None:
    everything = carproof("theorems")
    assert (everything.code, everything.stderr) == (0, "")
    assert all(each in everything.stdout for each in MODULES)
    assert all(each.name in everything.stdout and each.file in everything.stdout for each in THEOREMS)
    assert f"{len(MODULES)} of {len(MODULES)} lemmas checked by z3" in everything.stdout
    one = carproof("theorems", "free-windows-are-unique")
    assert one.code == 0
    assert all(each in one.stdout for each in ("window/free", "verify/kernel/QueryOptimal.v"))
