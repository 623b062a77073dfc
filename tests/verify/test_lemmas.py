"""z3 proves the formulas of the lemmas and refutes their mutants, and the engine accepts nothing else."""

import re
from functools import partial
from importlib.resources import files
from pathlib import Path

import pytest
from tests.oracle.running import Run

from carp_verify.lemmas import MODULES, engine, lemma_named
from carp_verify.lemmas.engine import Formula, Lemma, Unproved, examine, prove, refute
from carp_verify.lemmas.smt import Undecided, equal, find_model, integers, negation
from carp_verify.theorems import THEOREMS

KERNEL = Path(__file__).parents[2] / "verify/kernel"


@pytest.mark.parametrize("module", MODULES)
def test_every_formula_is_proved_and_every_mutant_is_refuted(module: str) -> None:
    report = examine(lemma_named(module))
    assert report.failures == ()
    assert report.checked
    assert "\nBy hand: " in report.lemma.statement, "it says what is left to argue"


def test_a_claim_that_fails_is_not_proved() -> None:
    a, b = integers("a b")
    with pytest.raises(Unproved, match="it fails where"):
        prove([a < b], b <= a)


def test_premises_that_contradict_each_other_prove_nothing() -> None:
    a, b = integers("a b")
    with pytest.raises(Unproved, match="contradict"):
        prove([a < b, b < a], equal(a, b))


def test_a_mutant_that_holds_is_not_refuted() -> None:
    a, b = integers("a b")
    with pytest.raises(Unproved, match="no error"):
        refute([a < b], a <= b)


def test_unknown_is_a_failure() -> None:
    a, b, c = integers("a b c")
    fermat = equal(a * a * a + b * b * b, c * c * c)
    hard = [a > 0, b > 0, c > 0, fermat]
    with pytest.raises(Undecided):
        find_model(hard, limit=100)


def test_what_z3_cannot_decide_is_neither_proved_nor_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    def puzzled(_: object) -> None:
        raise Undecided("z3 answers unknown: timeout")

    a, b = integers("a b")
    monkeypatch.setattr(engine, "find_model", puzzled)
    for decide in (prove, refute):
        with pytest.raises(Unproved, match=r"^z3 answers unknown: timeout$"):
            decide([a < b], a <= b)
    lemma = Lemma("t", "s", (), lambda: iter([Formula("f", [a < b], a <= b)]), lambda: iter([Formula("m", [], a < b)]))
    assert [failure.partition(":")[0] for failure in examine(lemma).failures] == (
        ["formula 'f' is not proved", "mutant 'm' is not refuted"]
    )


def test_a_lemma_is_checked_by_formulas_and_mutants_without_a_failure() -> None:
    a, b = integers("a b")
    formula, mutant = Formula("f", [a < b], a <= b), Formula("m", [a <= b], a < b)
    for formulas, mutants, checked in (
        ([formula], [mutant], True),
        ([formula], [], False),
        ([], [mutant], False),
        ([formula, mutant], [mutant], False),
        ([formula], [mutant, formula], False),
    ):
        report = examine(Lemma("t", "s", (), partial(iter, formulas), partial(iter, mutants)))
        assert report.checked is checked
        assert report.formulas == ("f",) * len(formulas[:1])
        assert [(name, shown.partition("=")[0]) for name, shown in report.refuted] == [("m", "a ")] * len(mutants[:1])


def test_every_failure_is_reported() -> None:
    a, b = integers("a b")
    wrong, right = Formula("wrong", [a < b], negation(a < b)), Formula("right", [a < b], a <= b)
    report = examine(Lemma("t", "s", (), lambda: iter([wrong]), lambda: iter([right])))
    assert len(report.failures) == 2
    assert not report.checked


def test_the_theorems_are_those_that_coq_is_asked_about() -> None:
    text = files("carp_verify").joinpath("theorems.txt").read_text()
    assert [f"{each.module}.{each.name}" for each in THEOREMS] == re.findall(r"^[A-Z].*", text, re.MULTILINE)
    assert not {each.name for each in THEOREMS} & set(MODULES)


def test_the_file_of_a_theorem_holds_it_with_its_proof() -> None:
    texts = {each.file: (KERNEL.parents[1] / each.file).read_text() for each in THEOREMS}
    for each in THEOREMS:
        assert re.search(rf"^(Theorem|Lemma) {each.name}\b", texts[each.file], re.MULTILINE), each.name


def test_the_command_checks_them_all(carproof: Run) -> None:
    outcome = carproof("theorems")
    assert outcome.code == 0
    assert all(module in outcome.stdout for module in MODULES)
    assert f"{len(MODULES)} of {len(MODULES)} lemmas checked by z3" in outcome.stdout
    assert outcome.stderr == ""


def test_the_command_names_the_theorem_of_a_claim_and_its_file(carproof: Run) -> None:
    outcome = carproof("theorems", "free-windows-are-unique")
    assert outcome.code == 0
    assert "window/free" in outcome.stdout
    assert "verify/kernel/QueryOptimal.v" in outcome.stdout
    everything = carproof("theorems").stdout
    assert all(each.name in everything and each.file in everything for each in THEOREMS)
