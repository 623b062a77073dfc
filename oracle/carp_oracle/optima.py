"""The documents of an optimum and of a proof that was checked."""

from typing import TYPE_CHECKING

import msgspec

from carp_spec.documents import SolutionDocument, solution_document

if TYPE_CHECKING:
    from carp_verify.optimum import Optimum


class OptimumDocument(msgspec.Struct, frozen=True):
    """The result of a search for the optimum.

    Proved, and a cost of null: the robots cannot all be planned. Not proved: the solution is the best known, or
    null if none is.
    """

    cost: int | None
    lower: int
    proved: bool
    solution: SolutionDocument | None


def optimum_document(best: "Optimum") -> OptimumDocument:
    """The document of an optimum."""
    solution = None if best.solution is None else solution_document(best.solution)
    return OptimumDocument(best.cost, best.lower, best.proved, solution)


class ProofDocument(msgspec.Struct, frozen=True):
    """The result of checking a proof: the cost that is proved least, or why it is not."""

    proved: bool
    cost: int | None
    solution: SolutionDocument | None
    reason: str | None
