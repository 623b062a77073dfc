"""Why a robot is unplanned."""

from typing import Any

import pytest
from tests.oracle.running import Document, Run, save, solution, town
from tests.spec.making import instance, line, plan_of

from carp_spec import Instance, Resource, ResourceGraph, Robot, Stop
from carproof.judging.unplanned import why_unplanned

LANE = line("abc")
THERE_AND_BACK = (Stop("f"), Stop("b"))
NO_WAY = "the committed plans leave no way to its goal"


@pytest.mark.parametrize(
    ("asked", "plans", "reason"),
    [
        (
            instance(ResourceGraph((Resource("a"), Resource("b")), ()), ("a", "b")),
            (),
            "no moves lead from its start a to its goal b",
        ),
        (
            Instance(ResourceGraph(line("abf").resources, (("a", "b"),)), (Robot("r0", "a", stops=THERE_AND_BACK),)),
            (),
            "no moves lead from its start a to its stop f",
        ),
        (instance(LANE, ("a", "c"), ("a", "a")), (("a", 0, 1),), "its start a is taken in [0,1), from its release on"),
        (instance(LANE, ("a", "b"), ("b", "b"), after_goal="park"), (("b", 0, None),), "its goal b is taken for ever"),
        (
            instance(LANE, ("a", "b"), ("c", "b"), after_goal="park"),
            (("c", 0, 1), ("b", 1, None)),
            "its goal b is taken for ever",
        ),
        (instance(LANE, ("a", "c"), ("b", "b"), after_goal="park"), (("b", 0, None),), NO_WAY),
        (instance(LANE, ("a", "c"), ("c", "a")), (("c", 0, 1), ("b", 1, 2), ("a", 2, 3)), NO_WAY),
    ],
)
def test_the_reason_is_told(asked: Instance, plans: tuple[tuple[str, int, int | None], ...], reason: str) -> None:
    assert why_unplanned(asked, [plan_of("r1", *plans)] if plans else [], "r0") == reason


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(("goal", "reason"), [("g", "its goal g is taken for ever"), ("h", NO_WAY)])
def test_a_robot_under_way_is_not_asked_for_at_its_start(carproof: Run, goal: str, reason: str) -> None:
    robots: list[Document] = [
        {"id": "r1", "start": "a", "goal": goal},
        {"id": "r2", "start": "g", "goal": "g"},
        {"id": "r3", "start": "a", "goal": "a", "release": 3},
    ]
    ways: dict[str, list[list[Any]]] = {
        "r1": [["a", 0, 1], ["b", 1, 9], ["g", 9, None]],
        "r2": [["g", 0, None]],
        "r3": [["a", 3, None]],
    }
    if goal == "h":
        ways["r1"][2:] = [["g", 9, 10], ["h", 10, None]]
    save(way=town("ab bg gh", robots, "park"), plans=solution(ways))
    assert carproof("query way.json plans.json r1 --now 5").stdout == f"no plan: {reason}\n"
