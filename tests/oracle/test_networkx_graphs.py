"""Instances on graphs of networkx."""

from typing import Any

import networkx as nx
import pytest

import carp_reference
from carp_spec import Carp, Refusal, Resource, Robot, judge
from carproof.adapters import instance_from_networkx
from carproof.adapters.networkx_graphs import node_is_right


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
    ("node", "attributes"),
    [
        ((0, 1), {}),
        (True, {}),
        (1.0, {}),
        ("a", {"capacity": 1.0}),
        ("a", {"duration": True}),
        ("a", {"x": "1", "y": 1}),
        ("a", {"pos": (0.5, 1)}),
        ("a", {"pos": (1, 2, 3)}),
        ("a", {"pos": "12"}),
    ],
)
def test_a_node_that_is_no_resource_is_refused(node: Any, attributes: dict[str, Any]) -> None:  # noqa: ANN401 - nonsense too
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node(node, **attributes)
    assert not node_is_right(node, attributes)
    with pytest.raises(Refusal, match="adapter/networkx") as refused:
        instance_from_networkx(graph, [])
    assert refused.value.path == f"node {node!r}"


def test_parallel_edges_are_refused() -> None:
    with pytest.raises(Refusal, match="no parallel edges"):
        instance_from_networkx(nx.MultiGraph([(1, 2), (1, 2)]), [])


@pytest.mark.parametrize(
    ("edges", "robots", "rule"),
    [
        ([(1, 1)], [], "instance/edge"),
        ([(1, 2)], [Robot("r1", 1, 3)], "instance/endpoint"),
        ([(1, 2)], [Robot("r1", 1, 2, pace=0)], "instance/pace"),
    ],
)
def test_what_breaks_a_rule_of_instances_is_refused(
    edges: list[tuple[int, int]], robots: list[Robot], rule: str
) -> None:
    with pytest.raises(Refusal, match=rule):
        instance_from_networkx(nx.Graph(edges), robots)
