"""The documents of verdicts on certificates and of audits."""

import msgspec

from carp_spec import Plan, ResourceId, RobotId, Solution
from carp_spec.documents.solutions import visits_document
from carproof.judging.audit import Audit


class VerifiedBoundDocument(msgspec.Struct, frozen=True):
    """The bound that a certificate proves, or null with the path, the rule and the reason why it proves none.

    `by` is the checker that decided; `assumed` lists the facts that it did not check: none.
    """

    bound: int | None
    path: str | None
    rule: str | None
    reason: str | None
    by: str
    assumed: tuple[str, ...] = ()


class VerifiedQueryDocument(msgspec.Struct, frozen=True):
    """Whether a certificate proves its bound (null: no plan); if not, the path, the rule and the reason."""

    proved: bool
    bound: int | None
    path: str | None
    rule: str | None
    reason: str | None
    by: str


class LateDocument(msgspec.Struct, frozen=True):
    """A robot with the arrival of its plan, and a plan with which it arrives earlier."""

    robot: RobotId
    arrival: int
    earliest: int
    plan: tuple[tuple[ResourceId, int, int | None], ...]


class AuditDocument(msgspec.Struct, frozen=True):
    """The robots whose plans are certified, in order, those whose plans are late, and the checker that decided.

    Robots are undecided that the audit had no time to look at.
    """

    certified: tuple[RobotId, ...]
    late: tuple[LateDocument, ...]
    undecided: tuple[RobotId, ...]
    unplanned: int
    by: str


def audit_document(audit: Audit, solution: Solution) -> AuditDocument:
    """The document of an audit."""
    late = (
        LateDocument(each.plan.robot, arrival_of(each.plan), arrival_of(each.earlier), visits_document(each.earlier))
        for each in audit.late
    )
    return AuditDocument(
        certified=tuple(plan.robot for plan in audit.certified),
        late=tuple(late),
        undecided=tuple(plan.robot for plan in audit.undecided),
        unplanned=len(solution.unplanned),
        by=audit.by,
    )


def arrival_of(plan: Plan) -> int:
    """The tick at which a plan enters its goal for the last time."""
    return plan.visits[-1].enter
