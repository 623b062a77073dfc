"""Instances on graphs of networkx.

A node is a resource, with the attributes `capacity` and `duration` (default 1), and `x` and `y`, or `pos` as a pair of
them. An edge is a move, or two moves in an undirected graph. Other attributes are not read. With `park`, the default of
`after_goal`, and no attributes, an instance is classical multi-agent path finding (MAPF).
"""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from carp_spec import AfterGoal, Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.instance_rules import instance_faults
from carp_spec.rule import DESIGN, is_whole, rule

if TYPE_CHECKING:
    import networkx as nx

_POSITION = 2


@rule(
    "adapter/networkx",
    "A node of a networkx graph is a string or a whole number; its capacity, duration, x and y, if it has them, are "
    "whole numbers, and its pos a pair of them. The graph has no parallel edges.",
    DESIGN,
)
def node_is_right(node: object, attributes: Mapping[str, object]) -> bool:
    """Whether the node is a resource."""
    pos = attributes.get("pos", (0, 0))
    pair = isinstance(pos, tuple | list) and len(pos) == _POSITION and all(map(is_whole, pos))
    numbers = [attributes[name] for name in ("capacity", "duration", "x", "y") if name in attributes]
    return (is_whole(node) or isinstance(node, str)) and all(map(is_whole, numbers)) and pair


def instance_from_networkx(graph: "nx.Graph[Any]", robots: Iterable[Robot], after_goal: AfterGoal = "park") -> Instance:
    """Make an instance; raises `Refusal` if the graph or the robots are not right.

    Nodes of other kinds, such as the pairs of `networkx.grid_2d_graph`, are renamed by
    `networkx.convert_node_labels_to_integers` or `networkx.relabel_nodes` first.
    """
    if graph.is_multigraph():
        raise Refusal(
            "document", "graph", node_is_right.id, "the graph must have no parallel edges; it is a multigraph"
        )
    for node, attributes in graph.nodes(data=True):
        if not node_is_right(node, attributes):
            message = f"its id must be a string or a whole number and its numbers whole, not {attributes!r}"
            raise Refusal("document", f"node {node!r}", node_is_right.id, message)
    resources = tuple(_resource(node, attributes) for node, attributes in graph.nodes(data=True))
    edges = tuple((source, target) for source, target in graph.edges)
    instance = Instance(ResourceGraph(resources, edges, graph.is_directed()), tuple(robots), after_goal)
    for fault in instance_faults(instance):
        raise Refusal("document", fault.path, fault.rule, fault.message)
    return instance


def _resource(node: Any, attributes: Mapping[str, Any]) -> Resource:  # noqa: ANN401 - `node_is_right` checks them
    x, y = attributes.get("pos", (None, None))
    return Resource(
        node,
        attributes.get("capacity", 1),
        attributes.get("duration", 1),
        attributes.get("x", x),
        attributes.get("y", y),
    )
