"""The document of an instance: `carproof-instance/1`. Reading refuses a broken `instance/...` rule too."""

from hashlib import sha256
from typing import Annotated, Final, Literal

import msgspec

from carp_spec.documents.decoding import Positive, Tick, decode, write
from carp_spec.inputs.values import require_instance
from carp_spec.model import AfterGoal, Following, Instance, Resource, ResourceGraph, ResourceId, Robot, RobotId

INSTANCE_FORMAT: Final = "carproof-instance/1"


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
    """A robot."""  # a field is also one of `Robot`, of the same name and default

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
        robots=msgspec.convert(document.robots, tuple[Robot, ...], from_attributes=True),
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
        robots=msgspec.convert(instance.robots, tuple[RobotDocument, ...], from_attributes=True),
        following=msgspec.UNSET if instance.following == "allowed" else instance.following,
    )


def write_instance(instance: Instance) -> bytes:
    """Write an instance document."""
    return write(instance_document(instance))


def digest(instance: Instance) -> str:
    """The SHA-256 digest of the instance's document as carproof writes it."""
    return sha256(write_instance(instance)).hexdigest()
