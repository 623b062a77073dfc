"""The theorems are proved, their mutants are refuted, and the engine cannot be talked into anything."""

import json

import pytest
from tests.oracle.conftest import carproof
from tests.oracle.running import Run

from carp_spec import RULES
from carp_verify.engine import Lemma, Theorem, Unproved, examine, prove, refute
from carp_verify.smt import Undecided, equal, find_model, integers, negation
from carp_verify.support import WITHOUT_THEOREM, theorems_of_rules
from carp_verify.theorems import MODULES, theorem_named

__all__ = ["carproof"]


@pytest.mark.parametrize("module", MODULES)
def test_every_theorem_is_proved_and_its_mutants_are_refuted(module: str) -> None:
    report = examine(theorem_named(module))
    assert report.failures == ()
    assert report.proved
    assert report.theorem.statement.strip()


def test_every_theorem_is_listed_once() -> None:
    assert len(set(MODULES)) == len(MODULES)
    assert len({theorem_named(module).name for module in MODULES}) == len(MODULES)


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


def test_a_theorem_without_mutants_is_not_proved() -> None:
    a, b = integers("a b")
    theorem = Theorem("t", "s", (), lambda: iter([Lemma("l", [a < b], a <= b)]), lambda: iter([]))
    assert not examine(theorem).proved


def test_every_failure_is_told() -> None:
    a, b = integers("a b")
    wrong, right = Lemma("wrong", [a < b], negation(a < b)), Lemma("right", [a < b], a <= b)
    report = examine(Theorem("t", "s", (), lambda: iter([wrong]), lambda: iter([right])))
    assert len(report.failures) == 2
    assert not report.proved


def test_every_rule_has_a_theorem_or_a_reason_for_having_none() -> None:
    supported = theorems_of_rules()
    assert {rule.id for rule in RULES} == supported.keys() | WITHOUT_THEOREM.keys()
    assert not supported.keys() & WITHOUT_THEOREM.keys()


def test_the_command_proves_them_all(carproof: Run) -> None:
    outcome = carproof("theorems")
    assert outcome.code == 0
    assert all(module in outcome.stdout for module in MODULES)
    assert f"{len(MODULES)} of {len(MODULES)} theorems proved" in outcome.stdout
    assert outcome.stderr == ""


def test_the_command_tells_one_in_full(carproof: Run) -> None:
    outcome = carproof("theorems", "free-windows-are-unique")
    assert outcome.code == 0
    assert "Maximal: every tick in it is free" in outcome.stdout
    assert "one of the windows is not maximal" in outcome.stdout


def test_the_command_prints_one_document(carproof: Run) -> None:
    outcome = carproof("theorems", "first_pop_is_final", "--json")
    document = json.loads(outcome.stdout)
    assert outcome.code == 0
    assert document["proved"] is True
    assert [theorem["theorem"] for theorem in document["theorems"]] == ["first_pop_is_final"]


def test_an_unknown_theorem_is_bad_input_with_a_suggestion(carproof: Run) -> None:
    outcome = carproof("theorems", "earliest_entry_wins")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert "earliest_entry_dominates" in outcome.stderr
