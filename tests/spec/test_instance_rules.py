"""The faults of an instance, each with its path and a sentence."""

from dataclasses import replace

import pytest
from hypothesis import given
from tests.spec.making import PARKING, VANISHING, instance_on, line
from tests.spec.strategies import FEWER, SIZES

from carp_spec import Fault, Instance, Resource, ResourceGraph, Robot
from carp_spec.instance_rules import INSTANCE_RULES, instance_faults
from carproof.testing.strategies import instances


@FEWER
@given(instance=instances(SIZES))
def test_a_right_instance_has_no_faults(instance: Instance) -> None:
    assert instance_faults(instance) == ()


@pytest.mark.parametrize("instance", [VANISHING, PARKING, Instance(ResourceGraph((), ()), ())])
def test_hand_made_instances_have_no_faults(instance: Instance) -> None:
    assert instance_faults(instance) == ()


def faults_with_edges(*edges: tuple[str, str], directed: bool = False) -> list[str]:
    graph = ResourceGraph(line("abc").resources, edges, directed)
    return [f"{fault.path} {fault.message}" for fault in instance_faults(Instance(graph, ()))]


def test_edges_have_ends_in_the_graph() -> None:
    assert faults_with_edges(("a", "b"), ("x", "y")) == [
        "$.graph.edges[1].source 'x' must be the id of a resource, and is not",
        "$.graph.edges[1].target 'y' must be the id of a resource, and is not",
    ]


def test_edges_are_listed_once_and_the_first_place_is_named() -> None:
    once = "it must be listed once, and is entry 0 too"
    assert faults_with_edges(("a", "b"), ("b", "c"), ("a", "b"), ("b", "a")) == [
        f"$.graph.edges[2] {once}",
        f"$.graph.edges[3] {once}",
    ]
    assert faults_with_edges(("a", "b"), ("b", "a"), directed=True) == []
    assert faults_with_edges(("a", "b"), ("a", "b"), directed=True) == [f"$.graph.edges[1] {once}"]


def test_a_resource_is_not_joined_to_itself() -> None:
    assert faults_with_edges(("c", "c")) == [
        "$.graph.edges[0] it must join two different resources, and joins 'c' to itself"
    ]


def test_ids_are_unique_among_robots_and_the_first_place_is_named() -> None:
    robots = [Robot(id, "a", "b") for id in ("r", "s", "r", None, "s")]  # type: ignore[arg-type] # nonsense too
    assert [(fault.path, fault.message) for fault in instance_faults(instance_on(line("ab"), *robots))] == [
        ("$.robots[2].id", "'r' is the id of entry 0 too; ids must be unique"),
        ("$.robots[3].id", "the id must be a string or a whole number, not None"),
        ("$.robots[4].id", "'s' is the id of entry 1 too; ids must be unique"),
    ]


def test_ids_of_resources_and_of_robots_are_apart_and_1_is_not_the_text_1() -> None:
    graph = ResourceGraph((Resource(1), Resource("1")), ((1, "1"),))
    assert instance_faults(Instance(graph, (Robot(1, 1, "1"), Robot("1", "1", 1)))) == ()


def test_numbers_name_the_least_that_would_be_right() -> None:
    graph = ResourceGraph((Resource("a", capacity=0, duration=True, x=1),), ())
    instance = Instance(graph, (Robot("r", "a", "z", release=-1, pace=0),), "stay")  # type: ignore[arg-type]
    assert instance_faults(instance) == (
        Fault(
            "instance/capacity", "$.graph.nodes[0].capacity", "the capacity must be a whole number of at least 1, not 0"
        ),
        Fault(
            "instance/duration",
            "$.graph.nodes[0].duration",
            "the duration must be a whole number of at least 1, not True",
        ),
        Fault(
            "instance/position",
            "$.graph.nodes[0]",
            "x and y must both be whole numbers or both be absent, not 1 and None",
        ),
        Fault("instance/endpoint", "$.robots[0].goal", "the goal must be the id of a resource, and 'z' is not"),
        Fault("instance/release", "$.robots[0].release", "the release must be a whole number of at least 0, not -1"),
        Fault("instance/pace", "$.robots[0].pace", "the pace must be a whole number of at least 1, not 0"),
        Fault("instance/after-goal", "$.after_goal", 'it must be "vanish" or "park", not \'stay\''),
    )


def test_start_and_goal_may_be_the_same_and_shared() -> None:
    assert instance_faults(instance_on(line("a"), Robot("r", "a", "a"), Robot("s", "a", "a"))) == ()


def test_faults_come_in_the_order_of_the_rules() -> None:
    reported = [rule.id for rule in INSTANCE_RULES]
    wrong = replace(VANISHING, robots=(Robot("r1", "x", "a", pace=0), Robot("r1", "a", "y", release=-1)))
    order = [reported.index(fault.rule) for fault in instance_faults(wrong)]
    assert order == sorted(order)
    assert len(order) == 5
