"""Sums and limits written as clauses, beside counting; how a formula is written; and how large it may get."""

from itertools import chain, product

import pytest

from carp_spec import Refusal
from carp_verify.optimum.clauses import Formula, dimacs


def is_model(formula: Formula, values: tuple[bool, ...]) -> bool:
    return all(any((literal > 0) == values[abs(literal) - 1] for literal in clause) for clause in formula.clauses)


def models(formula: Formula, inputs: int) -> set[tuple[bool, ...]]:
    """The values of the first variables in models of the formula."""
    drawn = product((False, True), repeat=formula.variables)
    return {values[:inputs] for values in drawn if is_model(formula, values)}


@pytest.mark.parametrize("most", [1, 2, 3])
@pytest.mark.parametrize("inputs", [1, 2, 3, 4])
def test_at_most_so_many_of_the_literals_hold(inputs: int, most: int) -> None:
    formula = Formula()
    formula.at_most([formula.variable() for _ in range(inputs)], most)
    assert models(formula, inputs) == {each for each in product((False, True), repeat=inputs) if sum(each) <= most}


@pytest.mark.parametrize("most", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("sizes", [(1,), (3,), (2, 2), (3, 0, 1), (1, 1, 2), (0, 0), ()])
def test_a_sum_is_at_least_that_of_its_addends(sizes: tuple[int, ...], most: int) -> None:
    formula = Formula()
    addends = [[formula.variable() for _ in range(size)] for size in sizes]
    inputs = formula.variables
    total = formula.at_least(addends, most)
    assert len(total) == min(sum(sizes), most)
    for least, literal in enumerate(total, start=1):
        bounded = Formula()
        bounded.variables = formula.variables
        bounded.clauses = [*formula.clauses, (-literal,)]
        found = models(bounded, inputs)
        assert {each for each in counted(sizes) if each in found} == {
            each for each in counted(sizes) if sum(each) < least
        }


def counted(sizes: tuple[int, ...]) -> set[tuple[bool, ...]]:
    """All unary numbers of these sizes, one after the other."""
    numbers = [[(True,) * count + (False,) * (size - count) for count in range(size + 1)] for size in sizes]
    return {tuple(chain(*each)) for each in product(*numbers)}


def test_a_formula_is_written_with_its_variables_and_clauses_and_a_0_after_each() -> None:
    formula = Formula()
    first, second = formula.variable(), formula.variable()
    formula.add(first, -second)
    formula.add(second)
    formula.add()
    assert dimacs(formula) == "p cnf 2 3\n1 -2 0\n2 0\n0\n"


def test_a_formula_has_at_most_so_many_clauses() -> None:
    formula = Formula(2)
    formula.add(1)
    formula.add(1)
    with pytest.raises(Refusal, match="the clauses of the formula must be at most 2, the limit"):
        formula.add(1)


def test_a_sum_that_would_be_too_large_is_refused_before_it_is_made() -> None:
    formula = Formula(4 * 3)
    numbers = [[formula.variable() for _ in range(size)] for size in (4, 3)]
    formula.add(1)
    with pytest.raises(Refusal, match="must be at most 12"):
        formula.at_least(numbers, 9)
    assert formula.clauses == [(1,)]
