"""The documents of plans: solutions, `carproof-solution/1`, and traces, `carproof-trace/1`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from types import GenericAlias
from typing import Annotated, Final, Literal, TypeAlias

import msgspec

from carp_spec.documents.decoding import decode, decode_quickly, without_collection, write
from carp_spec.execution.traces import Trace
from carp_spec.model import Plan, ResourceId, RobotId, Solution, Visit
from carp_spec.shapes import require_shape

SOLUTION_FORMAT: Final = "carproof-solution/1"
TRACE_FORMAT: Final = "carproof-trace/1"


VisitDocument: TypeAlias = tuple[ResourceId, int, int | None]


class PlanDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan: each visit is [resource, enter, leave], and a leave of null means for ever."""

    robot: RobotId
    visits: tuple[VisitDocument, ...]


class SolutionDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A solution: plans, the order in which they were made, and the robots without a plan; `$schema` is not kept."""

    format: Literal["carproof-solution/1"]
    plans: tuple[PlanDocument, ...]
    order: tuple[RobotId, ...]
    unplanned: tuple[RobotId, ...]
    schema: str | msgspec.UnsetType = msgspec.field(default=msgspec.UNSET, name="$schema")


class TraceDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The visits that robots have entered by the tick now, the last with a leave of null if it is not left."""

    format: Literal["carproof-trace/1"]
    now: Annotated[int, msgspec.Meta(ge=0)]
    plans: tuple[PlanDocument, ...]


def _of(kind: type[msgspec.Struct], name: str, item: type[msgspec.Struct]) -> type[msgspec.Struct]:
    """The class, with a tuple of these items in the field of that name."""
    items = [(name, GenericAlias(tuple, (item, ...)))]
    return msgspec.defstruct(kind.__name__, items, bases=(kind,), forbid_unknown_fields=True, frozen=True)


_PLAN = _of(PlanDocument, "visits", Visit)
_SOLUTION = _of(SolutionDocument, "plans", _PLAN)
_TRACE = _of(TraceDocument, "plans", _PLAN)
"""As in the documents, but for a visit, which is that of the model. The documents tell where an array is too long."""


@without_collection()
def read_solution(data: bytes) -> Solution:
    """Read a solution document; raises `Refusal` if it is malformed. The checker decides whether it is right."""
    quick = decode_quickly(data, _SOLUTION)
    if quick is not None:
        return msgspec.convert(quick, Solution, from_attributes=True)
    return solution_of(decode(data, SolutionDocument, SOLUTION_FORMAT))


def solution_of(document: SolutionDocument) -> Solution:
    """The solution of a document."""
    return Solution(_plans(document.plans), document.order, document.unplanned)


def _plans(documents: Sequence[PlanDocument]) -> tuple[Plan, ...]:
    return tuple(Plan(each.robot, tuple(Visit(*visit) for visit in each.visits)) for each in documents)


@without_collection()
def read_trace(data: bytes) -> Trace:
    """Read a trace; raises `Refusal` if it is malformed. `trace_violations` decides whether it follows a solution."""
    quick = decode_quickly(data, _TRACE)
    if quick is not None:
        return msgspec.convert(quick, Trace, from_attributes=True)
    document = decode(data, TraceDocument, TRACE_FORMAT)
    return Trace(document.now, _plans(document.plans))


_RESOURCE, _ENTER = attrgetter("resource"), attrgetter("enter")
_FIELDS_OF_VISIT: Callable[[Visit], VisitDocument] = attrgetter("resource", "enter", "leave")


def visits_document(plan: Plan) -> tuple[VisitDocument, ...]:
    """The visits of a plan as documents write them."""
    return tuple(map(_FIELDS_OF_VISIT, plan.visits))


@dataclass(frozen=True)
class PlanColumns:
    """A plan by columns: all resources, all ticks of entry, and the tick at which the last visit is left.

    Where nobody asks for the plan, its visits are never made.
    """

    robot: RobotId
    resources: tuple[ResourceId, ...]
    enters: tuple[int, ...]
    leave: int | None

    @classmethod
    def of(cls, plan: Plan) -> "PlanColumns":
        """The columns of a plan of right visits, at least one, each entered when the one before is left."""
        visits = plan.visits
        columns = cls(plan.robot, tuple(map(_RESOURCE, visits)), tuple(map(_ENTER, visits)), visits[-1].leave)
        vars(columns)["plan"] = plan
        return columns

    @cached_property
    def plan(self) -> Plan:
        """The plan, made once."""
        return Plan(self.robot, tuple(map(Visit, self.resources, self.enters, self._leaves)))

    @property
    def document(self) -> PlanDocument:
        """The document of the plan."""
        return PlanDocument(self.robot, tuple(zip(self.resources, self.enters, self._leaves, strict=True)))

    @property
    def _leaves(self) -> tuple[int | None, ...]:
        return (*self.enters[1:], self.leave)


def plan_documents(plans: Sequence[Plan]) -> tuple[PlanDocument, ...]:
    """The documents of plans."""
    return tuple(PlanDocument(plan.robot, visits_document(plan)) for plan in plans)


def solution_document(solution: Solution) -> SolutionDocument:
    """The document of a solution; raises `Refusal` if it is malformed."""
    require_shape(solution, Solution)
    return SolutionDocument(SOLUTION_FORMAT, plan_documents(solution.plans), solution.order, solution.unplanned)


def trace_document(trace: Trace) -> TraceDocument:
    """The document of a trace; raises `Refusal` if it is malformed."""
    require_shape(trace, Trace)
    return TraceDocument(TRACE_FORMAT, trace.now, plan_documents(trace.plans))


def write_solution(solution: Solution) -> bytes:
    """Write a solution document."""
    return write(solution_document(solution))


def write_trace(trace: Trace) -> bytes:
    """Write a trace document."""
    return write(trace_document(trace))
