"""Instances on graphs of networkx."""

from typing import Any

import networkx as nx
import numpy as np
import pytest

import carp_reference
from carp_spec import Carp, Refusal, Resource, Robot
from carproof import instance_from_networkx, read_instance, write_instance


def test_nodes_are_resources_and_edges_moves() -> None:
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node("a", capacity=2, duration=3, pos=(4, 5), colour="red")
    graph.add_node(1, x=0, y=-1)
    graph.add_node("c")
    graph.add_edge("a", 1, weight=0.5)
    instance = instance_from_networkx(graph, [Robot("r1", "a", 1)])
    assert instance.graph.resources == (Resource("a", 2, 3, 4, 5), Resource(1, x=0, y=-1), Resource("c"))
    assert instance.graph.successors == {"a": (1,), 1: ("a",), "c": ()}
    assert (instance.after_goal, instance.graph.directed) == ("park", False)


def test_tuples_and_numbers_of_numpy_are_taken() -> None:
    graph = nx.grid_2d_graph(2, 2)
    graph.add_node((0, 0), capacity=np.int64(2), duration=np.uint8(3), pos=np.array([4, 5]))
    graph.add_edge((0, 0), np.int32(7))
    robot = Robot(np.int64(1), (1, 1), np.int64(7), release=np.int16(2))  # type: ignore[arg-type]
    instance = instance_from_networkx(graph, [robot])
    assert instance.graph.resource["0,0"] == Resource("0,0", 2, 3, 4, 5)
    assert instance.robots == (Robot(1, "1,1", 7, release=2),)
    assert read_instance(write_instance(instance)) == instance
    assert carp_reference.plan(instance, Carp()).unplanned == ()


def test_metric_positions_are_taken_with_a_scale() -> None:
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node("a", pos=(0.125, -1.996))
    graph.add_node("b", x=np.float32(0.5), y=2)
    instance = instance_from_networkx(graph, [], scale=100)
    assert [(each.x, each.y) for each in instance.graph.resources] == [(12, -200), (50, 200)]


def node(id: object, **attributes: object) -> "nx.Graph[Any]":
    """A graph of one node."""
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node(id, **attributes)
    return graph


DIGRAPH: Any = nx.DiGraph([(1, 2), (2, 3), (3, 1)])


@pytest.mark.parametrize(
    ("graph", "options", "path"),
    [
        (3, {}, "graph"),
        ({"a": ["b"]}, {}, "graph"),
        (nx.MultiGraph([(1, 2), (1, 2)]), {}, "graph"),
        (DIGRAPH, {"robots": [3]}, "$.robots[0]"),
        (DIGRAPH, {"scale": 0}, "$.scale"),
        (DIGRAPH, {"scale": 0.5}, "$.scale"),
        (DIGRAPH, {"scale": True}, "$.scale"),
        (node((0, None)), {}, "node (0, None)"),
        (node(()), {}, "node ()"),
        (node(True), {}, "node True"),
        (node(1.0), {}, "node 1.0"),
        (node("a", capacity=1.0), {}, "node 'a'.capacity"),
        (node("a", duration=True), {}, "node 'a'.duration"),
        (node("a", duration=np.float64(2)), {}, "node 'a'.duration"),
        (node("a", x="1", y=1), {}, "node 'a'.x"),
        (node("a", x=1, y=0.5), {}, "node 'a'.y"),
        (node("a", x=float("nan"), y=1), {"scale": 100}, "node 'a'.x"),
        (node("a", x="1", y=1), {"scale": 100}, "node 'a'.x"),
        (node("a", x=True, y=1), {"scale": 100}, "node 'a'.x"),
        (node("a", pos=(0.5, 1)), {}, "node 'a'.pos"),
        (node("a", pos=(1, 2, 3)), {}, "node 'a'.pos"),
        (node("a", pos="12"), {}, "node 'a'.pos"),
        (node("a", pos=None), {}, "node 'a'.pos"),
    ],
)
def test_what_is_no_graph_node_robot_or_scale_is_refused(graph: Any, options: dict[str, Any], path: str) -> None:  # noqa: ANN401
    with pytest.raises(Refusal) as caught:
        instance_from_networkx(graph, **{"robots": [], **options})
    assert caught.value.path == path
    assert caught.value.rule == ("document/shape" if "robots" in options else "adapter/networkx")


def test_a_broken_rule_of_instances_names_the_node_or_the_edge() -> None:
    graph: nx.Graph[Any] = nx.Graph([((0, 0), (0, 1))])
    graph.add_node("0,1")
    with pytest.raises(Refusal, match="instance/resource-id") as refused:
        instance_from_networkx(graph, [])
    assert refused.value.path == "node '0,1'.id"
    with pytest.raises(Refusal, match="instance/edge") as refused:
        instance_from_networkx(nx.Graph([(1, 2), (2, 2)]), [])
    assert refused.value.path == "edge (2, 2)"
