"""The documents of plans: solutions, `carproof-solution/1`, and traces, `carproof-trace/1`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from types import GenericAlias
from typing import Annotated, Final, Literal, TypeAlias, TypeVar, cast

import msgspec

from carp_spec.documents.decoding import decode, without_collection, write
from carp_spec.execution.traces import Trace
from carp_spec.model import Plan, ResourceId, RobotId, Solution, Visit
from carp_spec.shapes import require_shape

SOLUTION_FORMAT: Final = "carproof-solution/1"
TRACE_FORMAT: Final = "carproof-trace/1"
D = TypeVar("D", bound=msgspec.Struct)

VisitDocument: TypeAlias = tuple[ResourceId, int, int | None]


class PlanDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan: each visit is [resource, enter, leave], and a leave of null means for ever."""

    robot: RobotId
    visits: tuple[Visit, ...]

    @property
    def plan(self) -> Plan:
        """The plan."""
        return Plan(self.robot, self.visits)


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


def _of(kind: type[D], name: str, item: object) -> type[D]:
    """The class, with a tuple of these items in the field of that name."""
    items = [(name, GenericAlias(tuple, (item, ...)))]
    said = {"__doc__": kind.__doc__}
    exact = msgspec.defstruct(
        kind.__name__, items, bases=(kind,), namespace=said, forbid_unknown_fields=True, frozen=True
    )
    return cast("type[D]", exact)


_EXACT_PLAN = _of(PlanDocument, "visits", VisitDocument)
EXACT_SOLUTION = _of(SolutionDocument, "plans", _EXACT_PLAN)
EXACT_TRACE = _of(TraceDocument, "plans", _EXACT_PLAN)
"""As the documents, but for a visit, which is an array; they tell where an array is too long."""


@without_collection()
def read_solution(data: bytes) -> Solution:
    """Read a solution document; raises `Refusal` if it is malformed. The checker decides whether it is right."""
    return solution_of(decode(data, SolutionDocument, SOLUTION_FORMAT, EXACT_SOLUTION))


def solution_of(document: SolutionDocument) -> Solution:
    """The solution of a document."""
    return Solution(tuple(each.plan for each in document.plans), document.order, document.unplanned)


@without_collection()
def read_trace(data: bytes) -> Trace:
    """Read a trace; raises `Refusal` if it is malformed. `trace_violations` decides whether it follows a solution."""
    document = decode(data, TraceDocument, TRACE_FORMAT, EXACT_TRACE)
    return Trace(document.now, tuple(each.plan for each in document.plans))


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
        leaves = (*self.enters[1:], self.leave)
        return Plan(self.robot, tuple(map(Visit, self.resources, self.enters, leaves)))

    @property
    def document(self) -> PlanDocument:
        """The document of the plan."""
        return PlanDocument(self.robot, self.plan.visits)


def plan_documents(plans: Sequence[Plan]) -> tuple[PlanDocument, ...]:
    """The documents of plans."""
    return tuple(PlanDocument(plan.robot, plan.visits) for plan in plans)


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
