"""The faults of an instance, each with its path."""

from dataclasses import replace
from typing import Any

import pytest
from tests.spec.making import PARKING, VANISHING, instance_on, line

from carp_spec import Group, Instance, Resource, ResourceGraph, Robot
from carp_spec.instance_rules import INSTANCE_RULES, instance_faults


def on_edges(*edges: tuple[str, str], directed: bool = False) -> Instance:
    return Instance(ResourceGraph(line("abc").resources, edges, directed), ())


def with_groups(*groups: Group) -> Instance:
    return Instance(replace(line("ab"), groups=groups), ())


def with_robots(*ids: Any) -> Instance:  # noqa: ANN401 - nonsense too
    return instance_on(line("ab"), *(Robot(id, "a", "b") for id in ids))


@pytest.mark.parametrize(
    ("instance", "paths"),
    [
        (VANISHING, []),
        (PARKING, []),
        (Instance(ResourceGraph((), ()), ()), []),
        (
            Instance(ResourceGraph((Resource(1), Resource("1")), ((1, "1"),)), (Robot(1, 1, "1"), Robot("1", "1", 1))),
            [],
        ),
        (instance_on(line("a"), Robot("r", "a", "a"), Robot("s", "a", "a")), []),
        (on_edges(("a", "b"), ("x", "y")), ["graph.edges[1].source", "graph.edges[1].target"]),
        (on_edges(("a", "b"), ("b", "c"), ("a", "b"), ("b", "a")), ["graph.edges[2]", "graph.edges[3]"]),
        (on_edges(("a", "b"), ("b", "a"), directed=True), []),
        (on_edges(("a", "b"), ("a", "b"), directed=True), ["graph.edges[1]"]),
        (on_edges(("c", "c")), ["graph.edges[0]"]),
        (with_groups(Group("g", ("a",)), Group("g", ("a", "b"))), ["graph.groups[1].id"]),
        (with_groups(Group("g", ())), ["graph.groups[0].resources"]),
        (
            with_groups(Group("g", ("a", "x", "b", "a"), 0)),
            [f"graph.groups[0].{each}" for each in ("capacity", "resources[1]", "resources[3]")],
        ),
        (with_robots("r", "s", "r", None, "s"), ["robots[2].id", "robots[3].id", "robots[4].id"]),
    ],
)
def test_each_fault_is_named_with_its_path(instance: Instance, paths: list[str]) -> None:
    assert [fault.path for fault in instance_faults(instance)] == [f"$.{path}" for path in paths]


def test_a_list_names_the_first_place_of_what_is_in_it_twice() -> None:
    for instance in (on_edges(("b", "c"), ("a", "b"), ("a", "b")), with_robots("s", "r", "r")):
        (fault,) = instance_faults(instance)
        assert "entry 1 too" in fault.message


def test_numbers_name_the_least_that_would_be_right() -> None:
    graph = ResourceGraph((Resource("a", capacity=0, duration=True, x=1),), ())
    instance = Instance(graph, (Robot("r", "a", "z", release=-1, pace=0),), "stay")  # type: ignore[arg-type]
    assert [(fault.rule, fault.path, "at least" in fault.message) for fault in instance_faults(instance)] == [
        ("instance/capacity", "$.graph.nodes[0].capacity", True),
        ("instance/duration", "$.graph.nodes[0].duration", True),
        ("instance/position", "$.graph.nodes[0]", False),
        ("instance/endpoint", "$.robots[0].goal", False),
        ("instance/release", "$.robots[0].release", True),
        ("instance/pace", "$.robots[0].pace", True),
        ("instance/after-goal", "$.after_goal", False),
    ]


def test_faults_come_in_the_order_of_the_rules() -> None:
    reported = [rule.id for rule in INSTANCE_RULES]
    wrong = replace(VANISHING, robots=(Robot("r1", "x", "a", pace=0), Robot("r1", "a", "y", release=-1)))
    order = [reported.index(fault.rule) for fault in instance_faults(wrong)]
    assert order == sorted(order)
    assert len(order) == 5
