"""The documents: instances, solutions and verdicts as JSON.

Reading is strict. It refuses an unknown field, a boolean or 1.0 in place of a whole number, and a broken `instance/...`
rule, and names the path and the rule. A value that is written and read again stays equal.
"""

import json
from collections import Counter
from contextlib import suppress
from typing import Annotated, Final, Literal, TypeAlias, TypeVar

import msgspec

from carp_spec.check import Verdict
from carp_spec.instance_rules import instance_faults
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
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, Violation, rule

INSTANCE_FORMAT: Final = "carproof-instance/1"
SOLUTION_FORMAT: Final = "carproof-solution/1"
VERDICT_FORMAT: Final = "carproof-verdict/1"

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


def _json_error(data: bytes) -> str | None:
    try:
        msgspec.json.decode(data)
        _parsed(data)
    except (*UNREADABLE, ValueError) as error:
        return str(error)
    return None


@rule(
    "document/json",
    "A document is one JSON value in UTF-8; no object in it has a name twice, and no whole number has more than "
    f"{MOST_DIGITS} digits.",
    DESIGN,
)
def is_json(data: bytes) -> bool:
    return _json_error(data) is None


@rule("document/format", "A document's format names its kind and version, like carproof-instance/1.", DESIGN)
def has_format(data: bytes, format: str) -> bool:
    try:
        return msgspec.json.decode(data, type=_Headed).format == format
    except UNREADABLE:
        return False


def uncapitalized(sentence: str) -> str:
    """The sentence as part of another: with a small first letter, unless its first word is an abbreviation."""
    return sentence if sentence[1:2].isupper() else sentence[:1].lower() + sentence[1:]


def _shape_error(data: bytes, kind: type[D]) -> tuple[str, str] | None:
    """Where the document departs from its kind: the path, and what would be right there."""
    try:
        msgspec.json.decode(data, type=kind)
    except UNREADABLE as error:
        message, found, path = str(error).rpartition(" - at `")
        reason = message if found else path
        return (path.rstrip("`") if found else "$", uncapitalized(reason).replace("`", ""))
    return None


@rule(
    "document/shape",
    "A document has exactly the fields and types of its JSON Schema; true, 1.0 and 1e3 are no whole numbers.",
    DESIGN,
)
def has_shape(data: bytes, kind: type[Document]) -> bool:
    return _shape_error(data, kind) is None


def require_json(data: bytes) -> None:
    """Raise `Refusal` if the data is no JSON."""
    malformed = _json_error(data)
    if malformed is not None:
        raise Refusal("document", "$", "document/json", f"the document must be JSON in UTF-8: {malformed}")


def decode(data: bytes, kind: type[D], format: str) -> D:
    """Decode a document of the kind, or raise `Refusal` with its first error."""
    if ESCAPE not in data:
        with suppress(*UNREADABLE, ValueError):
            return msgspec.convert(_parsed(data), kind)
    return _decode_step_by_step(data, kind, format)


def _instead(data: bytes) -> str:
    """The end of a sentence that names the format of a document that has the wrong one; empty if it has none."""
    try:
        found = msgspec.json.decode(data, type=_Headed).format
    except UNREADABLE:
        return ""
    return f", and is {found}" if found.isprintable() and len(found) <= MOST_DIGITS else ""


def _decode_step_by_step(data: bytes, kind: type[D], format: str) -> D:
    """Apply one rule after the other, to name the first that is broken."""
    require_json(data)
    if not has_format(data, format):
        raise Refusal("document", "$.format", "document/format", f"the format must be {format}{_instead(data)}")
    wrong = _shape_error(data, kind)
    if wrong is not None:
        path, expected = wrong
        raise Refusal("document", path, "document/shape", expected)
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
    for fault in instance_faults(instance):
        raise Refusal("document", fault.path, fault.rule, fault.message)
    return instance


def _unset(value: int | None) -> int | msgspec.UnsetType:
    return msgspec.UNSET if value is None else value


def instance_document(instance: Instance) -> InstanceDocument:
    """The document of an instance."""
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
    plans = tuple(Plan(each.robot, tuple(Visit(*visit) for visit in each.visits)) for each in document.plans)
    return Solution(plans, document.order, document.unplanned)


def visits_document(plan: Plan) -> tuple[tuple[ResourceId, int, int | None], ...]:
    """The visits of a plan as documents write them."""
    return tuple((visit.resource, visit.enter, visit.leave) for visit in plan.visits)


def solution_document(solution: Solution) -> SolutionDocument:
    """The document of a solution."""
    plans = tuple(PlanDocument(plan.robot, visits_document(plan)) for plan in solution.plans)
    return SolutionDocument(SOLUTION_FORMAT, plans, solution.order, solution.unplanned)


def verdict_document(verdict: Verdict) -> VerdictDocument:
    """The document of a verdict."""
    return VerdictDocument(
        format=VERDICT_FORMAT,
        valid=verdict.valid,
        cost=verdict.cost,
        unplanned=verdict.unplanned,
        violations=tuple(_violation_document(violation) for violation in verdict.violations),
    )


def _violation_document(violation: Violation) -> ViolationDocument:
    return ViolationDocument(
        violation.rule,
        violation.robots,
        violation.resource,
        violation.start,
        violation.end,
        violation.message,
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
