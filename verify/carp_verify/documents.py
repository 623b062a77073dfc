"""The documents: instances, solutions, verdicts and traces as JSON; the law in `carp_spec` knows values alone.

Reading is strict. It refuses an unknown field, a boolean or 1.0 in place of a whole number, and a broken `instance/...`
rule, and names the path and the rule. A value that is written and read again stays equal.
"""

import json
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Annotated, Final, Literal, TypeAlias, TypeVar

import msgspec

from carp_spec.check import Verdict
from carp_spec.execution.traces import Trace
from carp_spec.inputs.values import require_instance
from carp_spec.model import (
    AfterGoal,
    Following,
    Instance,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Visit,
)
from carp_spec.query_certificates import QUERY_FORMAT, QueryCertificateDocument
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, rule
from carp_spec.shapes import SHAPE, require_shape

INSTANCE_FORMAT: Final = "carproof-instance/1"
SOLUTION_FORMAT: Final = "carproof-solution/1"
VERDICT_FORMAT: Final = "carproof-verdict/1"
TRACE_FORMAT: Final = "carproof-trace/1"

MOST_DIGITS: Final = 100
ESCAPE: Final = b"\\u"  # the escape of half a surrogate pair is not text, though Python's parser accepts it
UNREADABLE: Final = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)

Tick: TypeAlias = Annotated[int, msgspec.Meta(extra_json_schema={"minimum": 0})]
Positive: TypeAlias = Annotated[int, msgspec.Meta(extra_json_schema={"minimum": 1})]


class NodeDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A resource."""

    id: ResourceId
    capacity: Positive = 1
    duration: Positive = 1
    x: int | msgspec.UnsetType = msgspec.UNSET
    y: int | msgspec.UnsetType = msgspec.UNSET


class EdgeDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An edge of the resource graph."""

    source: ResourceId
    target: ResourceId


class GraphAttributesDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The attributes that networkx gives a graph; the name is for people and is not kept."""

    name: str = ""


class GraphDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The resource graph as networkx node-link data."""

    nodes: tuple[NodeDocument, ...]
    edges: tuple[EdgeDocument, ...]
    directed: bool = False
    multigraph: Annotated[bool, msgspec.Meta(extra_json_schema={"const": False})] = False
    graph: GraphAttributesDocument | msgspec.UnsetType = msgspec.UNSET

    def __post_init__(self) -> None:
        """Refuse parallel edges: a second edge between two resources would allow nothing more."""
        if self.multigraph:
            raise ValueError("expected multigraph to be false")


class RobotDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A robot."""

    id: RobotId
    start: ResourceId
    goal: ResourceId
    release: Tick = 0
    pace: Positive = 1


class InstanceDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An instance; `$schema` is for editors and is not kept."""

    format: Literal["carproof-instance/1"]
    graph: GraphDocument
    after_goal: AfterGoal
    robots: tuple[RobotDocument, ...]
    following: Following | msgspec.UnsetType = msgspec.UNSET
    schema: str | msgspec.UnsetType = msgspec.field(default=msgspec.UNSET, name="$schema")


class PlanDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan: each visit is [resource, enter, leave], and a leave of null means for ever."""

    robot: RobotId
    visits: tuple[tuple[ResourceId, int, int | None], ...]


class SolutionDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A solution: plans, the order in which they were made, and the robots without a plan; `$schema` is not kept."""

    format: Literal["carproof-solution/1"]
    plans: tuple[PlanDocument, ...]
    order: tuple[RobotId, ...]
    unplanned: tuple[RobotId, ...]
    schema: str | msgspec.UnsetType = msgspec.field(default=msgspec.UNSET, name="$schema")


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


class TraceDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The visits that robots have entered by the tick now, the last with a leave of null if it is not left."""

    format: Literal["carproof-trace/1"]
    now: Annotated[int, msgspec.Meta(ge=0)]
    plans: tuple[PlanDocument, ...]


Document: TypeAlias = InstanceDocument | SolutionDocument | VerdictDocument
D = TypeVar("D", bound=msgspec.Struct)


class _Headed(msgspec.Struct, frozen=True):
    format: str


def _members(members: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(members)
    if len(found) < len(members):
        counts = Counter(name for name, _ in members)
        name = next(name for name in found if counts[name] > 1)
        raise ValueError(f"an object has the name {name!r} {counts[name]} times")
    return found


def _whole_number(digits: str) -> int:
    if len(digits) > MOST_DIGITS and len(digits.removeprefix("-")) > MOST_DIGITS:
        raise ValueError(f"a whole number has more than {MOST_DIGITS} digits")
    return int(digits)


def _parsed(data: bytes) -> object:
    return json.loads(data.decode(), object_pairs_hook=_members, parse_int=_whole_number)


def _place(data: bytes, error: str) -> str:
    """Line and column of a syntax error, each counted from 1, as a part of a sentence."""
    position = re.search(r"\(byte (\d+)\)", error)
    try:
        data.decode()
    except UnicodeDecodeError as undecoded:
        end = undecoded.start
    else:
        if position is None and "truncated" not in error:
            return ""
        end = len(data) if position is None else int(position[1])
    lines = data[:end].decode(errors="replace").split("\n")
    return f", and is not at line {len(lines)}, column {len(lines[-1]) + 1}"


def require_json(data: bytes) -> None:
    """Raise `Refusal` if the data is no JSON."""
    try:
        msgspec.json.decode(data)
        _parsed(data)
    except (*UNREADABLE, ValueError) as error:
        message = f"the document must be JSON in UTF-8{_place(data, str(error))}: {error}"
        raise Refusal("document", "$", is_json.id, message) from error


@rule(
    "document/json",
    "A document is one JSON value in UTF-8; no object in it has a name twice, and no whole number has more than "
    f"{MOST_DIGITS} digits.",
    DESIGN,
)
def is_json(data: bytes) -> bool:
    try:
        require_json(data)
    except Refusal:
        return False
    return True


def _format(data: bytes) -> str | None:
    try:
        return msgspec.json.decode(data, type=_Headed).format
    except UNREADABLE:
        return None


@rule("document/format", "A document's format names its kind and version, like carproof-instance/1.", DESIGN)
def has_format(data: bytes, format: str) -> bool:
    return _format(data) == format


def uncapitalized(sentence: str) -> str:
    """The sentence as part of another: with a small first letter, unless its first word is an abbreviation."""
    return sentence if sentence[1:2].isupper() else sentence[:1].lower() + sentence[1:]


def with_values(message: str, kind: object, path: str) -> str:
    """Msgspec's message about a value of the kind; about one of a few allowed values, it lists these."""
    if not message.startswith("Invalid enum value"):
        return message
    from msgspec import inspect  # noqa: PLC0415 - most documents are right

    def values(kind: inspect.Type, names: Sequence[str]) -> Iterator[object]:
        if isinstance(kind, inspect.LiteralType):
            yield from kind.values
        elif isinstance(kind, inspect.UnionType):
            for each in kind.types:
                yield from values(each, names)
        elif isinstance(kind, inspect.VarTupleType):
            yield from values(kind.item_type, names)
        elif isinstance(kind, inspect.StructType):
            for field in kind.fields:
                if names and field.encode_name == names[0]:
                    yield from values(field.type, names[1:])

    allowed = " or ".join(map(str, values(inspect.type_info(kind), re.findall(r"\.(\w+)", path))))
    return f"{message}, it must be {allowed}" if allowed else message


def _shape_error(data: bytes, kind: type[D]) -> tuple[str, str] | None:
    """Where the document departs from its kind: the path, and what would be right there."""
    try:
        msgspec.json.decode(data, type=kind)
    except UNREADABLE as error:
        message, found, path = str(error).rpartition(" - at `")
        reason = with_values(message if found else path, kind, path if found else "$")
        return (path.rstrip("`") if found else "$", uncapitalized(reason).replace("`", ""))
    return None


@rule(
    SHAPE,
    "A document has exactly the fields and types of its JSON Schema; true, 1.0 and 1e3 are no whole numbers.",
    DESIGN,
)
def has_shape(data: bytes, kind: type[Document]) -> bool:
    return _shape_error(data, kind) is None


def decode(data: bytes, kind: type[D], format: str) -> D:
    """Decode a document of the kind, or raise `Refusal` with its first error."""
    if ESCAPE not in data:
        with suppress(*UNREADABLE, ValueError):
            return msgspec.convert(_parsed(data), kind)
    require_json(data)
    found = _format(data)
    if found != format:
        instead = f", and is {found}" if found and found.isprintable() and len(found) <= MOST_DIGITS else ""
        raise Refusal("document", "$.format", has_format.id, f"the format must be {format}{instead}")
    wrong = _shape_error(data, kind)
    if wrong is not None:
        raise Refusal("document", wrong[0], has_shape.id, wrong[1])
    return msgspec.json.decode(data, type=kind)


def _set(value: int | msgspec.UnsetType) -> int | None:
    return None if value is msgspec.UNSET else value


def read_instance(data: bytes) -> Instance:
    """Read an instance document; raises `Refusal` on its first fault."""
    document = decode(data, InstanceDocument, INSTANCE_FORMAT)
    instance = Instance(
        graph=ResourceGraph(
            resources=tuple(
                Resource(node.id, node.capacity, node.duration, _set(node.x), _set(node.y))
                for node in document.graph.nodes
            ),
            edges=tuple((edge.source, edge.target) for edge in document.graph.edges),
            directed=document.graph.directed,
        ),
        robots=tuple(Robot(each.id, each.start, each.goal, each.release, each.pace) for each in document.robots),
        after_goal=document.after_goal,
        following="allowed" if document.following is msgspec.UNSET else document.following,
    )
    require_instance(instance)
    return instance


def _unset(value: int | None) -> int | msgspec.UnsetType:
    return msgspec.UNSET if value is None else value


def instance_document(instance: Instance) -> InstanceDocument:
    """The document of an instance; raises `Refusal` with its first fault."""
    require_instance(instance)
    graph = instance.graph
    return InstanceDocument(
        format=INSTANCE_FORMAT,
        graph=GraphDocument(
            nodes=tuple(
                NodeDocument(each.id, each.capacity, each.duration, _unset(each.x), _unset(each.y))
                for each in graph.resources
            ),
            edges=tuple(EdgeDocument(source, target) for source, target in graph.edges),
            directed=graph.directed,
        ),
        after_goal=instance.after_goal,
        robots=tuple(
            RobotDocument(each.id, each.start, each.goal, each.release, each.pace) for each in instance.robots
        ),
        following=msgspec.UNSET if instance.following == "allowed" else instance.following,
    )


def read_solution(data: bytes) -> Solution:
    """Read a solution document; raises `Refusal` if it is malformed. The checker decides whether it is right."""
    return solution_of(decode(data, SolutionDocument, SOLUTION_FORMAT))


def solution_of(document: SolutionDocument) -> Solution:
    """The solution of a document."""
    return Solution(_plans(document.plans), document.order, document.unplanned)


def _plans(documents: Sequence[PlanDocument]) -> tuple[Plan, ...]:
    return tuple(Plan(each.robot, tuple(Visit(*visit) for visit in each.visits)) for each in documents)


def read_trace(data: bytes) -> Trace:
    """Read a trace; raises `Refusal` if it is malformed. `trace_violations` decides whether it follows a solution."""
    document = decode(data, TraceDocument, TRACE_FORMAT)
    return Trace(document.now, _plans(document.plans))


def read_query_certificate(data: bytes) -> QueryCertificateDocument:
    """Read a query certificate; raises `Refusal` if it is malformed."""
    return decode(data, QueryCertificateDocument, QUERY_FORMAT)


def visits_document(plan: Plan) -> tuple[tuple[ResourceId, int, int | None], ...]:
    """The visits of a plan as documents write them."""
    return tuple((visit.resource, visit.enter, visit.leave) for visit in plan.visits)


def _plan_documents(plans: Sequence[Plan]) -> tuple[PlanDocument, ...]:
    return tuple(PlanDocument(plan.robot, visits_document(plan)) for plan in plans)


def solution_document(solution: Solution) -> SolutionDocument:
    """The document of a solution; raises `Refusal` if it is malformed."""
    require_shape(solution, Solution)
    return SolutionDocument(SOLUTION_FORMAT, _plan_documents(solution.plans), solution.order, solution.unplanned)


def trace_document(trace: Trace) -> TraceDocument:
    """The document of a trace; raises `Refusal` if it is malformed."""
    require_shape(trace, Trace)
    return TraceDocument(TRACE_FORMAT, trace.now, _plan_documents(trace.plans))


def verdict_document(verdict: Verdict) -> VerdictDocument:
    """The document of a verdict."""
    return VerdictDocument(
        format=VERDICT_FORMAT,
        valid=verdict.valid,
        cost=verdict.cost,
        unplanned=verdict.unplanned,
        violations=msgspec.convert(verdict.violations, tuple[ViolationDocument, ...], from_attributes=True),
    )


def write(document: object) -> bytes:
    """Write a document as one line of JSON."""
    return msgspec.json.encode(document) + b"\n"


def write_instance(instance: Instance) -> bytes:
    """Write an instance document."""
    return write(instance_document(instance))


def write_solution(solution: Solution) -> bytes:
    """Write a solution document."""
    return write(solution_document(solution))


def write_verdict(verdict: Verdict) -> bytes:
    """Write a verdict document."""
    return write(verdict_document(verdict))


def write_trace(trace: Trace) -> bytes:
    """Write a trace document."""
    return write(trace_document(trace))
