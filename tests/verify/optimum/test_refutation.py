"""Refutations with hints: what is accepted has no model, and what a solver proves is accepted."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.verify.bound.examples import UNSOUND_DRAT

from carp_optimum.sat.lrat_hints import NoHintsError, refutation_with_hints
from carp_optimum.sat.solver import Solver
from carp_verify.optimum import refutation
from carp_verify.optimum.clauses import Clause, Formula
from carp_verify.optimum.refutation import NotRefutedError, require_refutation

SQUARE = ((1, 2), (1, -2), (-1, 2), (-1, -2))
REFUTED = "5 1 0 1 2 0\n6 0 5 3 4 0\n"
LITERALS = st.integers(1, 4).flatmap(lambda variable: st.sampled_from([variable, -variable]))
CLAUSES = st.lists(st.lists(LITERALS, max_size=3).map(tuple), max_size=12).map(tuple)


def is_satisfiable(clauses: tuple[Clause, ...]) -> bool:
    return any(
        all(any((literal > 0) == values[abs(literal) - 1] for literal in clause) for clause in clauses)
        for values in product((False, True), repeat=4)
    )


def test_clauses_that_are_forgotten_may_have_served_before() -> None:
    require_refutation(SQUARE, "5 1 0 1 2 0\n5 d 1 2 0\n6 0 5 3 4 0\n")
    with pytest.raises(NotRefutedError, match="line 3 has the hint 1, which is the number of no clause there"):
        require_refutation(SQUARE, "5 1 0 1 2 0\n5 d 1 2 0\n6 0 1 3 4 0\n")


REFUSED = (
    ("", "it does not end with the empty clause"),
    ("5 1 0 1 2 0\n", "it does not end with the empty clause"),
    (f"{REFUTED}7 1 0 5 0\n", "must not follow the empty clause"),
    (f"{REFUTED}7 d 5 0\n", "must not follow the empty clause"),
    (f"{REFUTED}\n", "line 3 must be"),
    ("6 0 3 4 0\n", "line 1 has the hint 3, whose clause leaves several literals open"),
    ("5 1 0 1 0\n6 0 5 3 4 0\n", "line 1 does not follow from its hints"),
    ("5 1 0 1 2 0\n5 0 5 3 4 0\n", "line 2 must have a number above 5"),
    ("4 1 0 1 2 0\n", "line 1 must have a number above 4"),
    ("3 1 0 1 2 0\n", "line 1 must have a number above 4"),
    ("5 1 0 9 2 0\n", "line 1 has the hint 9"),
    ("5 0 5 0\n", "line 1 has the hint 5"),
    ("5 1 0 -1 2 0\n", "line 1 must be a clause with its hints"),
    ("5 1 0 1 2\n", "line 1 must be"),
    ("5 1 0 1 2 0 0\n", "line 1 must be"),
    ("5 1 0 1  2 0\n", "line 1 must be"),
    ("5 1 0 \uff11 2 0\n", "line 1 must be"),
    ("5 --1 0 1 2 0\n", "line 1 must be"),
    (f"5 {'1' * 5000} 0 1 2 0\n", "line 1 must be"),
    ("1 0\n0\n", "line 1 has no hints: refutations without hints"),
    ("d 1 2 0\n", "line 1 has no hints"),
    (UNSOUND_DRAT, "line 1 has no hints"),
    ("5 1 0 1 2 0\n6 0 3 5 4 0\n", "line 2 has the hint 3, whose clause leaves several literals open"),
    ("5 1 0 1 2 0\n5 d 5 0\n5 1 0 1 2 0\n6 0 5 3 4 0\n", "line 3 must have a number above 5"),
    ("0 1 0 1 2 0\n6 0 5 3 4 0\n", "line 1 must"),
    ("5 0 0 1 2 0\n6 0 5 3 4 0\n", "line 1 must be"),
    ("5 1 0 1 2 0\n5 d -1 0\n6 0 5 3 4 0\n", "line 2 must be"),
)
"""Texts that are no refutation of the square, and why; the kernel refuses them too."""


@pytest.mark.parametrize(("text", "reason"), REFUSED)
def test_anything_else_is_refused(text: str, reason: str) -> None:
    with pytest.raises(NotRefutedError, match=reason):
        require_refutation(SQUARE, text)


def test_the_five_lines_that_refuted_every_formula_are_refused_in_this_form_too() -> None:
    for hints in ("", "1 ", "1 2 ", "5 ", "5 6 "):
        lines = [f"5 91 0 {hints}0", f"6 92 -91 0 {hints}0", "6 d 6 0", f"7 -92 0 {hints}0", f"8 0 {hints}0"]
        with pytest.raises(NotRefutedError):
            require_refutation(((1, 2),), "\n".join(lines))


def test_a_refutation_that_looks_at_too_much_is_refused_before_its_first_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refutation, "LARGEST_REFUTATION", 10)
    with pytest.raises(NotRefutedError, match="its hints look at 21 literals, and at most 10"):
        require_refutation(SQUARE, "9 1 0 4 4 4 4 4 0\n" + REFUTED)
    never_read = REFUTED.replace("3 4 0", "3 4 99 99 0")
    require_refutation(SQUARE, never_read)
    monkeypatch.setattr(refutation, "LARGEST_REFUTATION", 9)
    with pytest.raises(NotRefutedError, match="its hints look at 10 literals, and at most 9"):
        require_refutation(SQUARE, never_read)


@given(CLAUSES, st.data())
def test_no_steps_at_all_refute_what_has_a_model(clauses: tuple[Clause, ...], data: st.DataObject) -> None:
    numbers = st.integers(1, len(clauses) + 6)
    steps = data.draw(st.lists(st.tuples(st.lists(LITERALS, max_size=3), st.lists(numbers, max_size=6)), max_size=6))
    text = ""
    for number, (literals, hints) in enumerate([*steps, ([], data.draw(st.lists(numbers, max_size=8)))], start=1):
        text += " ".join(map(str, (len(clauses) + number, *literals, 0, *hints, 0))) + "\n"
    try:
        require_refutation(clauses, text)
    except NotRefutedError:
        return
    assert not is_satisfiable(clauses)


@given(CLAUSES)
def test_what_the_solver_proves_gets_hints_that_are_accepted(clauses: tuple[Clause, ...]) -> None:
    formula = Formula()
    formula.variables = 4
    for clause in clauses:
        formula.add(*clause)
    proof = []
    if () not in clauses:
        solver = Solver(formula, lambda: None, with_proof=True)
        if solver.satisfiable([]):
            return
        proof = solver.proof()
    require_refutation(clauses, refutation_with_hints(clauses, proof, lambda: None))


def test_a_step_without_hints_has_none_to_be_found() -> None:
    with pytest.raises(NoHintsError, match=r"the clause \(91,\) does not follow by unit propagation"):
        refutation_with_hints(SQUARE, UNSOUND_DRAT.splitlines(), lambda: None)
    with pytest.raises(NoHintsError, match=r"the clause \(\) does not follow"):
        refutation_with_hints(((1, 2),), [], lambda: None)
