"""The document of what has happened: `carproof-trace/1`. Its rules are in `carp_spec.execution_rules`."""

from dataclasses import dataclass
from typing import Final, Literal

import msgspec

from carp_spec.documents import PlanDocument, Tick, decode, visits_document, write
from carp_spec.model import Plan, Visit
from carp_spec.refusal import Refusal

TRACE_FORMAT: Final = "carproof-trace/1"


@dataclass(frozen=True, slots=True)
class Trace:
    """The visits that robots have entered by the tick `now`, that tick included.

    A visit that is not left yet has a leave of `None`. A robot that has not appeared yet has no visits.
    """

    now: int
    plans: tuple[Plan, ...]


class TraceDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The visits that robots have entered by the tick now, the last with a leave of null if it is not left."""

    format: Literal["carproof-trace/1"]
    now: Tick
    plans: tuple[PlanDocument, ...]


def read_trace(data: bytes) -> Trace:
    """Read a trace; raises `Refusal` if it is malformed. `trace_violations` decides whether it follows a solution."""
    document = decode(data, TraceDocument, TRACE_FORMAT)
    if document.now < 0:
        raise Refusal("document", "$.now", "document/shape", "now must be at least 0")
    return Trace(
        document.now, tuple(Plan(each.robot, tuple(Visit(*visit) for visit in each.visits)) for each in document.plans)
    )


def trace_document(trace: Trace) -> TraceDocument:
    """The document of a trace."""
    plans = tuple(PlanDocument(plan.robot, visits_document(plan)) for plan in trace.plans)
    return TraceDocument(TRACE_FORMAT, trace.now, plans)


def write_trace(trace: Trace) -> bytes:
    """Write a trace document."""
    return write(trace_document(trace))
