"""The document of an instance: `carproof-instance/1`. Reading refuses a broken `instance/...` rule too."""

from hashlib import sha256
from typing import Annotated, Any, Final, Literal

import msgspec

from carp_spec.documents.decoding import decode, without_collection, write
from carp_spec.documents.fields import all_converted, converted, describes
from carp_spec.inputs.values import require_instance
from carp_spec.model import AfterGoal, Instance, Resource, ResourceGraph, ResourceId, Robot, RobotId, Stop

INSTANCE_FORMAT: Final = "carproof-instance/1"


@describes(Resource)
class NodeDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A resource."""


class EdgeDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An edge of the resource graph."""

    source: ResourceId
    target: ResourceId


class GraphAttributesDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The attributes that networkx gives a graph; the name is for people and is not kept."""

    name: str = ""


@describes(ResourceGraph, "resources")
class GraphDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The resource graph as networkx node-link data, and its groups."""

    nodes: tuple[NodeDocument, ...]
    edges: tuple[EdgeDocument, ...]
    directed: bool = False
    multigraph: Annotated[bool, msgspec.Meta(extra_json_schema={"const": False})] = False
    graph: GraphAttributesDocument | msgspec.UnsetType = msgspec.UNSET

    def __post_init__(self) -> None:
        """Refuse parallel edges: a second edge between two resources would allow nothing more."""
        if self.multigraph:
            raise ValueError("expected multigraph to be false")


@describes(Stop)
class StopDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A place that a robot serves: it stays there for at least `service` ticks, whatever its pace."""


@describes(Robot)
class RobotDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A robot, with its stops, or with a goal alone, which is short for one stop there without service."""

    id: RobotId
    start: ResourceId
    goal: ResourceId | msgspec.UnsetType = msgspec.UNSET
    stops: tuple[StopDocument, ...] | msgspec.UnsetType = msgspec.UNSET

    def __post_init__(self) -> None:
        """Refuse both, and neither."""
        if (self.goal is msgspec.UNSET) == (self.stops is msgspec.UNSET):
            raise ValueError("expected either a goal or stops")


@describes(Instance)
class InstanceDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An instance; `$schema` is for editors and is not kept."""

    format: Literal["carproof-instance/1"]
    graph: GraphDocument
    after_goal: AfterGoal
    robots: tuple[RobotDocument, ...]
    schema: str | msgspec.UnsetType = msgspec.field(default=msgspec.UNSET, name="$schema")


def robot_of(robot: Any) -> Robot:  # noqa: ANN401 - its document, with fields that the model describes
    """The robot of a document."""
    stops = (Stop(robot.goal),) if robot.stops is msgspec.UNSET else all_converted(robot.stops, Stop)
    return converted(robot, Robot, stops=stops)


def robot_document(robot: Robot) -> RobotDocument:
    """The document of a robot."""
    if robot.has_goal_alone:
        return converted(robot, RobotDocument, goal=robot.goal, stops=msgspec.UNSET)
    return converted(robot, RobotDocument, goal=msgspec.UNSET, stops=all_converted(robot.stops, StopDocument))


@without_collection()
def read_instance(data: bytes) -> Instance:
    """Read an instance document; raises `Refusal` on its first fault."""
    document = decode(data, InstanceDocument, INSTANCE_FORMAT)
    graph = converted(
        document.graph,
        ResourceGraph,
        resources=all_converted(document.graph.nodes, Resource),
        edges=tuple((each.source, each.target) for each in document.graph.edges),
    )
    instance = converted(document, Instance, graph=graph, robots=tuple(map(robot_of, document.robots)))
    require_instance(instance)
    return instance


def instance_document(instance: Instance) -> InstanceDocument:
    """The document of an instance; raises `Refusal` with its first fault."""
    require_instance(instance)
    graph = converted(
        instance.graph,
        GraphDocument,
        nodes=all_converted(instance.graph.resources, NodeDocument),
        edges=tuple(EdgeDocument(source, target) for source, target in instance.graph.edges),
    )
    robots = tuple(map(robot_document, instance.robots))
    return converted(instance, InstanceDocument, format=INSTANCE_FORMAT, graph=graph, robots=robots)


def write_instance(instance: Instance) -> bytes:
    """Write an instance document."""
    return write(instance_document(instance))


def digest(instance: Instance) -> str:
    """The SHA-256 digest of the instance's document as carproof writes it."""
    return sha256(write_instance(instance)).hexdigest()
