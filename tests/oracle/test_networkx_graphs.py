"""Instances on graphs of networkx."""

from typing import Any

import networkx as nx
import numpy as np
import pytest

import carp_reference
from carp_spec import Carp, Refusal, Resource, Robot, judge
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


def test_a_directed_graph_has_moves_one_way() -> None:
    instance = instance_from_networkx(nx.DiGraph([(1, 2), (2, 3), (3, 1)]), [Robot("r1", 1, 3)], "vanish")
    assert instance.graph.successors == {1: (2,), 2: (3,), 3: (1,)}
    assert instance.after_goal == "vanish"


def test_a_graph_from_networkx_can_be_planned() -> None:
    graph = nx.convert_node_labels_to_integers(nx.grid_2d_graph(3, 3), label_attribute="pos")
    instance = instance_from_networkx(graph, [Robot("r1", 0, 8), Robot("r2", 8, 0)])
    assert (instance.graph.resource[5].x, instance.graph.resource[5].y) == (1, 2)
    verdict = judge(instance, carp_reference.plan(instance, Carp()))
    assert (verdict.valid, verdict.cost, verdict.unplanned) == (True, 8, 0)


@pytest.mark.parametrize(
    ("node", "attributes", "attribute", "right"),
    [
        ((0, None), {}, "", "a string, a whole number or a tuple of these"),
        ((), {}, "", "a string, a whole number or a tuple of these"),
        (True, {}, "", "a string, a whole number or a tuple of these"),
        (1.0, {}, "", "a string, a whole number or a tuple of these"),
        ("a", {"capacity": 1.0}, ".capacity", "a whole number"),
        ("a", {"duration": True}, ".duration", "a whole number"),
        ("a", {"duration": np.float64(2)}, ".duration", "a whole number"),
        ("a", {"x": "1", "y": 1}, ".x", "a whole number"),
        ("a", {"x": 1, "y": 0.5}, ".y", "a scale, such as scale=100"),
        ("a", {"pos": (0.5, 1)}, ".pos", "a scale, such as scale=100"),
        ("a", {"pos": (1, 2, 3)}, ".pos", "a pair"),
        ("a", {"pos": "12"}, ".pos", "a pair"),
        ("a", {"pos": None}, ".pos", "a pair"),
    ],
)
def test_a_node_that_is_no_resource_is_refused(
    node: Any,  # noqa: ANN401 - nonsense too
    attributes: dict[str, Any],
    attribute: str,
    right: str,
) -> None:
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node(node, **attributes)
    with pytest.raises(Refusal, match="adapter/networkx") as refused:
        instance_from_networkx(graph, [])
    assert refused.value.path == f"node {node!r}{attribute}"
    assert right in refused.value.message


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


@pytest.mark.parametrize("position", [float("nan"), float("inf"), "1", None, True])
def test_what_is_no_number_is_refused_with_a_scale_too(position: object) -> None:
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node("a", x=position, y=1)
    with pytest.raises(Refusal, match="x must be a number") as refused:
        instance_from_networkx(graph, [], scale=100)
    assert refused.value.path == "node 'a'.x"


@pytest.mark.parametrize("scale", [0, -1, 0.5, True])
def test_a_scale_is_a_whole_number_of_at_least_1(scale: Any) -> None:  # noqa: ANN401 - nonsense too
    with pytest.raises(Refusal, match="at least 1") as refused:
        instance_from_networkx(nx.Graph(), [], scale=scale)
    assert refused.value.path == "$.scale"


def test_a_broken_rule_of_instances_names_the_node_or_the_edge() -> None:
    graph: nx.Graph[Any] = nx.Graph([((0, 0), (0, 1))])
    graph.add_node("0,1")
    with pytest.raises(Refusal, match="instance/resource-id") as refused:
        instance_from_networkx(graph, [])
    assert refused.value.path == "node '0,1'.id"
    with pytest.raises(Refusal, match="instance/edge") as refused:
        instance_from_networkx(nx.Graph([(1, 2), (2, 2)]), [])
    assert refused.value.path == "edge (2, 2)"


@pytest.mark.parametrize(
    ("graph", "robots", "path"),
    [(3, [], "graph"), ({"a": ["b"]}, [], "graph"), (nx.path_graph(2), [3], "$.robots[0]")],
)
def test_what_is_no_graph_or_no_robot_is_refused(graph: Any, robots: Any, path: str) -> None:  # noqa: ANN401 - nonsense
    with pytest.raises(Refusal) as caught:
        instance_from_networkx(graph, robots)
    assert caught.value.path == path


def test_parallel_edges_are_refused() -> None:
    with pytest.raises(Refusal, match="no parallel edges"):
        instance_from_networkx(nx.MultiGraph([(1, 2), (1, 2)]), [])
