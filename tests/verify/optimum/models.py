"""Models of formulas, found by the solver of the searches."""

from collections.abc import Sequence

from carp_optimum.sat.solver import Solver
from carp_verify.optimum.clauses import Formula


def model_of(formula: Formula) -> Sequence[bool] | None:
    """Whether each variable holds in a model, from 1 on; `None` if the formula has none."""
    if () in formula.clauses:
        return None
    solver = Solver(formula, lambda: None)
    try:
        return solver.model() if solver.satisfiable([]) else None
    finally:
        solver.close()


def has_model(formula: Formula) -> bool:
    return model_of(formula) is not None
