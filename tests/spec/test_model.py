"""The model's look-ups."""

import copy
import dataclasses
import pickle
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from tests.spec.making import VANISHING
from tests.spec.strategies import FEWER, SIZES

from carp_spec import Instance, Plan, Resource, ResourceGraph, Solution
from carproof.testing.strategies import resource_graphs


@FEWER
@given(graph=resource_graphs(SIZES))
def test_resources_are_found_with_their_moves_in_the_order_of_the_graph(graph: ResourceGraph) -> None:
    for position, resource in enumerate(graph.resources):
        assert graph.resource[resource.id] is resource
        assert graph.index[resource.id] == position
    for source in graph.index:
        for target in graph.index:
            edge = (source, target) in graph.edges
            back = (target, source) in graph.edges and not graph.directed
            assert ((source, target) in graph.moves) == (edge or back)
        reached = [target for target in graph.index if (source, target) in graph.moves]
        assert list(graph.successors[source]) == reached


def test_edges_to_unknown_resources_are_no_moves() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "x"), ("x", "b"), ("a", "b")))
    assert graph.successors == {"a": ("b",), "b": ("a",)}
    assert not {("x", "b"), ("a", "x")} & graph.moves


def test_look_ups_are_no_part_of_equality() -> None:
    assert Instance(VANISHING.graph, VANISHING.robots) == VANISHING
    assert dataclasses.replace(VANISHING, after_goal="park") != VANISHING
    assert hash(Solution((), ())) == hash(Solution((), (), ()))


def test_robots_without_a_plan_are_unplanned_in_the_solution_of_some_plans() -> None:
    last = Plan(VANISHING.robots[-1].id, ())
    others = tuple(robot.id for robot in VANISHING.robots[:-1])
    assert Solution.of(VANISHING, [last]) == Solution((last,), (last.robot,), others)


LOOK_UPS = {
    "resource": VANISHING.graph.resource,
    "index": VANISHING.graph.index,
    "successors": VANISHING.graph.successors,
    "robot": VANISHING.robot,
}


@pytest.mark.parametrize("name", LOOK_UPS)
def test_a_look_up_cannot_be_changed(name: str) -> None:
    look_up: Any = LOOK_UPS[name]
    before, key = dict(look_up), next(iter(look_up))
    with pytest.raises(TypeError):
        look_up[key] = None
    with pytest.raises(TypeError):
        del look_up[key]
    for change in ("clear", "pop", "popitem", "setdefault", "update"):
        assert not hasattr(look_up, change)
    assert look_up == before


@pytest.mark.parametrize("again", [lambda each: pickle.loads(pickle.dumps(each)), copy.deepcopy, copy.copy])  # noqa: S301
def test_an_instance_survives_pickling_and_copying_with_its_look_ups(again: Callable[[Instance], Instance]) -> None:
    twin = again(VANISHING)
    assert (twin, hash(twin)) == (VANISHING, hash(VANISHING))
    assert (twin.robot, twin.graph.resource) == (VANISHING.robot, VANISHING.graph.resource)
    assert (twin.graph.index, twin.graph.successors) == (VANISHING.graph.index, VANISHING.graph.successors)
    assert not hasattr(twin.robot, "clear")
