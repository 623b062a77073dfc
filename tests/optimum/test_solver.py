"""The clock is read also while a solver works that does not count its conflicts."""

from collections import Counter
from contextlib import closing
from functools import partial

import pytest

from carp_optimum.deadline import TimeOver
from carp_optimum.sat.solver import CONFLICTS_BETWEEN_LOOKS, Solver
from carp_spec.permutations import splitmix64
from carp_verify.optimum.clauses import Formula

VARIABLES, CLAUSES = 400, 1704
LOOKS = 8


def hard_formula() -> Formula:
    """Three drawn literals in each clause, as many clauses as are hardest: minutes for a solver."""
    formula = Formula()
    variables = [formula.variable() for _ in range(VARIABLES)]
    drawn = splitmix64(1)
    for _ in range(CLAUSES):
        numbers = [next(drawn) for _ in range(3)]
        formula.add(*(variables[each // 2 % VARIABLES] * (-1) ** (each % 2) for each in numbers))
    return formula


def test_the_time_ends_a_stretch_of_many_conflicts() -> None:
    def over() -> None:
        raise TimeOver

    with closing(Solver(hard_formula(), lambda: None, glucose=True, watch=over)) as solver, pytest.raises(TimeOver):
        solver.satisfiable([], CONFLICTS_BETWEEN_LOOKS * LOOKS)


def test_looks_do_not_depend_on_how_long_a_stretch_takes() -> None:
    """So a limit of looks ends a search at the same place on a fast and on a slow machine."""
    calls: Counter[str] = Counter()
    look, watch = (partial(calls.update, [name]) for name in ("look", "watch"))
    with closing(Solver(hard_formula(), look, glucose=True, watch=watch)) as solver:
        assert solver.satisfiable([], CONFLICTS_BETWEEN_LOOKS * LOOKS) is None
    assert calls["look"] == LOOKS
    assert calls["watch"] > 0
