"""The document of a verdict: `carproof-verdict/1`."""

from typing import Final, Literal

import msgspec

from carp_spec.check import Verdict
from carp_spec.documents.decoding import write
from carp_spec.model import ResourceId, RobotId
from carp_spec.shapes import require_shape

VERDICT_FORMAT: Final = "carproof-verdict/1"


class ViolationDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename={"start": "from", "end": "to"}):
    """A broken rule, in the ticks [from, to); a to of null means for ever, a from of null means no tick."""

    rule: str
    robots: tuple[RobotId, ...]
    resource: ResourceId | None
    start: int | None
    end: int | None
    message: str


class VerdictDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The checker's answer for a solution, with at most the first 100 violations of each rule."""

    format: Literal["carproof-verdict/1"]
    valid: bool
    cost: int
    unplanned: int
    violations: tuple[ViolationDocument, ...]


def verdict_document(verdict: Verdict) -> VerdictDocument:
    """The document of a verdict."""
    return VerdictDocument(
        format=VERDICT_FORMAT,
        valid=verdict.valid,
        cost=verdict.cost,
        unplanned=verdict.unplanned,
        violations=msgspec.convert(verdict.violations, tuple[ViolationDocument, ...], from_attributes=True),
    )


def write_verdict(verdict: Verdict) -> bytes:
    """Write a verdict document."""
    require_shape(verdict, Verdict)
    return write(verdict_document(verdict))
