"""The documents of an optimum and of a proof that was checked."""

from typing import TYPE_CHECKING, Literal

import msgspec

from carp_spec.documents.solutions import SolutionDocument, solution_document

if TYPE_CHECKING:
    from carp_optimum.sat.core_guided import Optimum
    from carp_verify.optimum.proof import Verified


class OptimumDocument(msgspec.Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """The least total cost, a lower bound, and the solution that has it.

    `decided` means that the search ended with an answer, which rests on the solver. If it is true and the cost is null,
    the robots cannot all be planned. If it is false, the solution is the best known, or null. `proved` is present, and
    true, if a proof of the answer was written and checked as by `carproof verify`.
    """

    cost: int | None
    lower: int | None
    decided: bool
    solution: SolutionDocument | None
    proved: bool = False


def optimum_document(best: "Optimum", is_proved: bool = False) -> OptimumDocument:
    """The document of an optimum."""
    solution = None if best.solution is None else solution_document(best.solution)
    return OptimumDocument(best.cost, best.lower, best.decided, solution, is_proved)


class ProofDocument(msgspec.Struct, frozen=True):
    """The result of checking a proof: the least cost, or the reason why there are no plans of all robots.

    If nothing is proved, `reason` is why not. `by` is the proved kernel, if it was demanded.
    """

    proved: bool
    claim: Literal["optimum", "unsolvable"] | None = None
    cost: int | None = None
    solution: SolutionDocument | None = None
    obstacle: str | None = None
    reason: str | None = None
    by: str | None = None


def proof_document(verified: "Verified", reason: str | None, by: str | None) -> ProofDocument:
    """The document of a proof that holds or, with a reason, of one that z3 did not decide."""
    solution = None if verified.solution is None else solution_document(verified.solution)
    claim: Literal["optimum", "unsolvable"] = "unsolvable" if solution is None else "optimum"
    return ProofDocument(verified.is_decided, claim, verified.cost, solution, verified.obstacle, reason, by)
