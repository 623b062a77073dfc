"""Instances on graphs of networkx.

A node is a resource, with the attributes `capacity` and `duration` (default 1), and `x` and `y`, or `pos` as a pair of
them. An edge is a move, or two moves in an undirected graph. The attribute `groups` of the graph, if it is there, is a
tuple of `Group`. Other attributes are not read. Whole numbers may be those
of NumPy. A node that is a tuple, such as `(3, 4)` of `networkx.grid_2d_graph`, is the resource `3,4`. With `park`, the
default of `after_goal`, and no attributes, an instance is classical multi-agent path finding (MAPF).
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from math import isfinite
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

from carp_spec import AfterGoal, Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.inputs.values import require_instance
from carp_spec.model import Group
from carp_spec.rule import DESIGN, Found, fault_rule, is_between

if TYPE_CHECKING:
    import networkx as nx

_PAIR = 2


def _is_whole(value: Any) -> bool:  # noqa: ANN401 - whatever stands in a graph
    return isinstance(value, Integral) and not isinstance(value, bool)


def _is_number(value: Any) -> bool:  # noqa: ANN401 - whatever stands in a graph
    return not isinstance(value, bool) and isinstance(value, Real) and isfinite(value)


def _is_name(node: object) -> bool:
    return _is_whole(node) or isinstance(node, str)


@fault_rule(
    "adapter/networkx",
    "A node of a networkx graph is a string, a whole number, or a tuple of these; its capacity and duration, if it has "
    "them, are whole numbers, and so are its x and y, or the pair pos. With a scale, the steps of a unit, they are "
    "any numbers. The graph has no parallel edges.",
    DESIGN,
)
def node_is_right(node: object, attributes: Mapping[str, object], scale: int | None = None) -> Found:
    """Yield the faults of a node, each with the attribute, or nothing for the node itself."""
    if not (_is_name(node) or (isinstance(node, tuple) and node and all(map(_is_name, node)))):
        yield "", f"it must be a string, a whole number or a tuple of these, not {node!r}"
    for name in ("capacity", "duration"):
        if name in attributes and not _is_whole(attributes[name]):
            yield f".{name}", f"the {name} must be a whole number, not {attributes[name]!r}"
    are_right, right = (_is_number, "a number") if scale is not None else (_is_whole, "a whole number")
    hint = "" if scale is not None else "; a scale, such as scale=100 for steps of 1 cm in positions in m, takes others"
    for name in ("x", "y"):
        if name in attributes and not are_right(attributes[name]):
            yield f".{name}", f"{name} must be {right}, not {attributes[name]!r}{hint}"
    pos: Any = attributes.get("pos", (0, 0))
    try:
        pair = tuple(pos)
    except TypeError:
        pair = ()
    if isinstance(pos, str) or len(pair) != _PAIR or not all(map(are_right, pair)):
        yield ".pos", f"pos must be a pair, each {right}, not {pos!r}{hint}"


def instance_from_networkx(
    graph: "nx.Graph[Any]", robots: Iterable[Robot], after_goal: AfterGoal = "park", scale: int | None = None
) -> Instance:
    """Make an instance; robots name their starts and goals as the graph names its nodes.

    `scale` is how many steps of `x` and `y` a unit of the graph's positions has: with positions in metres, `scale=100`
    makes steps of a centimetre. Positions are rounded to the nearest step. Without a scale they are whole numbers.
    Raises `Refusal` with the node, edge or robot that is wrong, and what would be right.
    """
    if scale is not None and not is_between(scale, 1):
        raise Refusal("option", "$.scale", node_is_right.id, f"it must be a whole number of at least 1, not {scale!r}")
    if not all(hasattr(graph, each) for each in ("nodes", "edges", "is_directed", "is_multigraph")):
        message = f"it must be a graph of networkx, not of the class {type(graph).__name__}"
        raise Refusal("document", "graph", node_is_right.id, message)
    if graph.is_multigraph():
        raise Refusal(
            "document", "graph", node_is_right.id, "the graph must have no parallel edges; it is a multigraph"
        )
    for node, attributes in graph.nodes(data=True):
        for fault in node_is_right(node, attributes, scale):
            raise Refusal("document", f"node {node!r}{fault.path}", fault.rule, fault.message)
    resources = tuple(_resource(node, attributes, scale) for node, attributes in graph.nodes(data=True))
    edges = tuple((_named(source), _named(target)) for source, target in graph.edges)
    asked = tuple(_robot(robot) for robot in robots)
    groups = tuple(_group(group) for group in graph.graph.get("groups", ()))
    instance = Instance(ResourceGraph(resources, edges, graph.is_directed(), groups), asked, after_goal)
    try:
        require_instance(instance)
    except Refusal as refusal:
        raise Refusal(refusal.kind, _path_in(graph, refusal.path), refusal.rule, refusal.message) from None
    return instance


def graph_of(instance: Instance) -> "nx.Graph[Any]":
    """The resource graph as a graph of networkx, from which `instance_from_networkx` makes the same moves.

    It is a `DiGraph` if the edges are directed. Nodes have `capacity` and `duration`, and `x` and `y`
    if they have a position; the graph has `groups` if there are some.
    """
    import networkx as nx  # noqa: PLC0415 - slow to load

    require_instance(instance)
    graph: nx.Graph[Any] = nx.DiGraph() if instance.graph.directed else nx.Graph()
    for each in instance.graph.resources:
        place = {name: value for name, value in (("x", each.x), ("y", each.y)) if value is not None}
        graph.add_node(each.id, capacity=each.capacity, duration=each.duration, **place)
    graph.add_edges_from(instance.graph.edges)
    if instance.graph.groups:
        graph.graph["groups"] = instance.graph.groups
    return graph


def _plain(value: Any) -> Any:  # noqa: ANN401 - whatever stands in a graph
    """The value, as an int of Python if it is a whole number of NumPy."""
    return int(value) if _is_whole(value) else value


def _named(node: Any) -> Any:  # noqa: ANN401 - a node; if it is none, a rule of instances says so
    return ",".join(map(str, node)) if isinstance(node, tuple) else _plain(node)


def _group(group: Any) -> Any:  # noqa: ANN401 - if it is no group, `document/shape` says so
    return replace(group, resources=tuple(map(_named, group.resources))) if type(group) is Group else group


def _robot(robot: Any) -> Any:  # noqa: ANN401 - if it is no robot, `document/shape` says so
    if type(robot) is not Robot:
        return robot
    numbers = {name: _plain(getattr(robot, name)) for name in ("id", "release", "pace")}
    return replace(robot.in_names(_named), **numbers)


def _resource(node: Any, attributes: Mapping[str, Any], scale: int | None) -> Resource:  # noqa: ANN401 - `node_is_right`
    x, y = attributes.get("pos", (None, None))
    return Resource(
        _named(node),
        _plain(attributes.get("capacity", 1)),
        _plain(attributes.get("duration", 1)),
        _place(attributes.get("x", x), scale),
        _place(attributes.get("y", y), scale),
    )


def _place(value: Any, scale: int | None) -> int | None:  # noqa: ANN401 - `node_is_right` checks it
    """The position in steps."""
    if value is None:
        return None
    return int(value) if scale is None else round(Fraction(int(value) if _is_whole(value) else float(value)) * scale)


def _path_in(graph: "nx.Graph[Any]", path: str) -> str:
    """The path in an instance's document as a place in the graph."""
    for what, prefix, entries in (("node", "$.graph.nodes[", graph.nodes), ("edge", "$.graph.edges[", graph.edges)):
        if path.startswith(prefix):
            number, _, rest = path.removeprefix(prefix).partition("]")
            return f"{what} {list(entries)[int(number)]!r}{rest}"
    return path
