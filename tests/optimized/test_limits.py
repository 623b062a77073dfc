"""Numbers that the arrays cannot hold are refused before planning, and none wraps around while planning."""

from dataclasses import replace

import pytest

import carp_optimized
import carp_reference
from carp_optimized.state import room
from carp_spec import Carp, Instance, Neighbourhood, Plan, Refusal, Resource, ResourceGraph, Robot, TimeExpanded, Visit

LARGEST = 2**30 - 1


def two_cells(duration: int = 1, release: int = 0, pace: int = 1, x: int = 0) -> Instance:
    graph = ResourceGraph((Resource("a", duration=duration, x=x, y=0), Resource("b")), (("a", "b"),))
    return Instance(graph, (Robot("r", "a", "b", release, pace),))


@pytest.mark.parametrize(
    ("instance", "path"),
    [
        (two_cells(duration=LARGEST + 1), "$.graph.nodes[0].duration"),
        (two_cells(release=LARGEST + 1), "$.robots[0].release"),
        (two_cells(duration=2**20, pace=2**10), "$.robots[0].pace"),
        (two_cells(x=2**29 + 1), "$.graph.nodes[0].x"),
    ],
)
def test_a_number_that_is_too_large_is_refused_with_its_path(instance: Instance, path: str) -> None:
    with pytest.raises(Refusal) as refused:
        carp_optimized.plan(instance, Carp())
    assert (refused.value.kind, refused.value.path) == ("limit", path)


@pytest.mark.parametrize("instance", [two_cells(duration=LARGEST), two_cells(release=LARGEST - 1)])
def test_the_largest_numbers_are_planned_like_any_other(instance: Instance) -> None:
    assert carp_optimized.plan(instance, Carp()) == carp_reference.plan(instance, Carp())


def test_a_plan_that_would_pass_the_largest_tick_is_refused_while_planning() -> None:
    instance = two_cells(duration=LARGEST)
    late = replace(instance, robots=(Robot("r", "a", "b", release=LARGEST),))
    for planner in (Carp(), Neighbourhood()):
        with pytest.raises(Refusal) as refused:
            carp_optimized.plan(late, planner)
        assert refused.value.kind == "limit"


def test_ticks_of_committed_plans_and_of_requests_are_refused_too() -> None:
    instance = replace(two_cells(), robots=(Robot("r", "a", "b"), Robot("s", "a", "b")))
    plan = Plan("s", (Visit("a", 0, LARGEST + 1), Visit("b", LARGEST + 1, LARGEST + 2)))
    with pytest.raises(Refusal):
        carp_optimized.query(instance, [plan], "r")
    with pytest.raises(Refusal):
        carp_optimized.query(instance, [], "r", now=LARGEST + 1)


def test_a_planner_that_only_the_reference_has_is_refused() -> None:
    with pytest.raises(Refusal) as refused:
        carp_optimized.plan(two_cells(), TimeExpanded())
    assert "reference" in refused.value.message


@pytest.mark.parametrize("last", [2**29, 1])
def test_a_goal_behind_resources_that_are_too_far_is_refused_and_not_called_out_of_reach(last: int) -> None:
    cells = (*(Resource(cell, duration=2**29) for cell in "abcde"), Resource("f", duration=last))
    graph = ResourceGraph(cells, tuple(zip("abcde", "bcdef", strict=True)))
    for start in "abcd":
        with pytest.raises(Refusal) as refused:
            carp_optimized.query(Instance(graph, (Robot("r", start, "f"),)), [], "r")
        assert refused.value.rule == "limit/ticks"


@pytest.mark.parametrize("detour", [0, LARGEST])
def test_a_detour_that_is_too_far_is_refused_where_no_other_way_is_free(
    monkeypatch: pytest.MonkeyPatch, detour: int
) -> None:
    monkeypatch.setattr(room, "DETOUR", detour)
    cells = (Resource("a"), Resource("b"), Resource("x", duration=2**29), Resource("y", duration=2**29))
    graph = ResourceGraph(cells, (("a", "b"), ("a", "x"), ("x", "y"), ("y", "b")), directed=True)
    instance = Instance(graph, (Robot("stays", "b", "b"), Robot("r", "a", "b")))
    with pytest.raises(Refusal) as refused:
        carp_optimized.find(instance, [Plan("stays", (Visit("b", 0, None),))], "r")
    assert refused.value.rule == "limit/ticks"
