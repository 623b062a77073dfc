"""The model's look-ups."""

import dataclasses

import pytest
from hypothesis import given
from tests.spec.making import VANISHING
from tests.spec.strategies import FEWER, graphs

from carp_spec import Instance, Resource, ResourceGraph, Robot, Solution


@FEWER
@given(graph=graphs())
def test_a_move_is_an_edge_or_in_an_undirected_graph_its_reverse(graph: ResourceGraph) -> None:
    for source in graph.index:
        for target in graph.index:
            edge = (source, target) in graph.edges
            back = (target, source) in graph.edges and not graph.directed
            assert graph.has_move(source, target) == (edge or back)


@FEWER
@given(graph=graphs())
def test_successors_stand_in_the_order_of_the_resources(graph: ResourceGraph) -> None:
    for source in graph.index:
        reached = [each.id for each in graph.resources if graph.has_move(source, each.id)]
        assert list(graph.successors[source]) == reached


@FEWER
@given(graph=graphs())
def test_resources_are_found_by_id_and_by_index(graph: ResourceGraph) -> None:
    for position, resource in enumerate(graph.resources):
        assert graph.resource[resource.id] is resource
        assert graph.index[resource.id] == position


def test_edges_to_unknown_resources_are_no_moves() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "x"), ("x", "b"), ("a", "b")))
    assert graph.successors == {"a": ("b",), "b": ("a",)}
    assert not graph.has_move("x", "b")
    assert not graph.has_move("a", "x")


def test_a_robot_needs_its_pace_times_the_duration() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b", duration=3)), ())
    instance = Instance(graph, (Robot("quick", "a", "b"), Robot("slow", "a", "b", pace=2)))
    assert [instance.duration(robot, "b") for robot in ("quick", "slow")] == [3, 6]
    assert [instance.duration(robot, "a") for robot in ("quick", "slow")] == [1, 2]


def test_look_ups_are_no_part_of_equality() -> None:
    assert Instance(VANISHING.graph, VANISHING.robots) == VANISHING
    assert dataclasses.replace(VANISHING, after_goal="park") != VANISHING
    assert hash(Solution((), ())) == hash(Solution((), (), ()))


def test_look_ups_are_no_part_of_the_hash_or_of_what_is_printed() -> None:
    twin = Instance(ResourceGraph(VANISHING.graph.resources, VANISHING.graph.edges), VANISHING.robots)
    assert hash(twin) == hash(VANISHING)
    printed = repr(VANISHING)
    assert not any(f"{look_up}=" in printed for look_up in ("resource", "index", "successors", "robot"))


def test_the_model_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        VANISHING.robots[0].pace = 2  # type: ignore[misc] # that is what is tried
