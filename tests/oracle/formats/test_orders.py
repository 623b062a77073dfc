"""Orders of VDA 5050: well-formed, the whole plan in order, and a base that no robot can leave unsafely."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.layouts.layout_files import OPENTCS
from tests.oracle.running import Run
from tests.profiles import draws

import carproof
from carp_reference import plan as reference_plan
from carp_spec import Carp, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Stop, Visit
from carproof import Following, OrderSettings, read_instance, write_instance, write_orders, write_solution
from carproof.testing.strategies import PlannedInstance, Sizes, instances

NEEDED: Mapping[str, type | tuple[type, ...]] = {
    "headerId": int,
    "timestamp": str,
    "version": str,
    "manufacturer": str,
    "serialNumber": str,
    "orderId": str,
    "orderUpdateId": int,
    "nodes": list,
    "edges": list,
}
ELEMENT: Mapping[str, type] = {"sequenceId": int, "released": bool, "actions": list}
Order = Mapping[str, Any]


def orders(instance: Instance, solution: Solution, **options: object) -> dict[str, Order]:
    order_settings = OrderSettings(**options)  # type: ignore[arg-type]
    data = write_orders(instance, solution, order_settings)
    assert data == write_orders(instance, solution, order_settings)
    return {each["serialNumber"]: each for each in map(json.loads, data.splitlines())}


def check_form(order: Order) -> None:
    """What the versions 2 and 3 ask of an order."""
    assert all(isinstance(order[name], kind) for name, kind in NEEDED.items())
    assert (order["version"], order["timestamp"][-1], order["timestamp"][10]) in {
        ("2.1.0", "Z", "T"),
        ("3.0.0", "Z", "T"),
    }
    nodes, edges = order["nodes"], order["edges"]
    assert len(nodes) == len(edges) + 1
    elements = [each for pair in zip(nodes, [*edges, None], strict=True) for each in pair if each is not None]
    first = nodes[0]["sequenceId"]
    assert [each["sequenceId"] for each in elements] == [*range(first, first + len(elements))]
    assert first % 2 == 0
    released = [each["released"] for each in elements]
    assert released == sorted(released, reverse=True)
    assert sum(released) % 2 == 1, "the base begins and ends at a node"
    for each in elements:
        assert all(type(each[name]) is kind for name, kind in ELEMENT.items())
    for place, edge in enumerate(edges):
        ends = (nodes[place]["nodeId"], nodes[place + 1]["nodeId"])
        assert order["version"] == "3.0.0" or (edge["startNodeId"], edge["endNodeId"]) == ends
        assert isinstance(edge["edgeId"], str)
    actions = [action for node in nodes for action in node["actions"]]
    assert len({each["actionId"] for each in actions}) == len(actions)
    assert all(each["blockingType"] == "HARD" and each["actionType"] for each in actions)


def visited(instance: Instance, order: Order, *, base: bool = False) -> Iterator[str]:
    """The resources of an order, or of its base."""
    nodes, edges = order["nodes"], order["edges"]
    resources = {*map(str, instance.graph.index)}
    for node, edge in zip(nodes, [{"released": False, "edgeId": None}, *edges], strict=True):
        if edge["edgeId"] in resources and (edge["released"] or not base):
            yield edge["edgeId"]
        if node["released"] or not base:
            yield node["nodeId"]


CROWDED = Sizes(resources=4, robots=5, groups=2, stops=2, service=3)
PLANNED = (
    instances(CROWDED, least_robots=2)
    .filter(lambda each: all(len({*map(str, ids)}) == len(ids) for ids in (each.robot, each.graph.index)))
    .map(lambda each: PlannedInstance(each, reference_plan(each, Carp())))
)


@given(PLANNED, st.integers(0, 12), st.sampled_from(["2.1.0", "3.0.0"]))
@settings(max_examples=draws(1500))
def test_orders_hold_the_plans_and_release_no_more_robots_than_fit(
    planned: PlannedInstance, at: int, version: str
) -> None:
    instance, solution = planned.instance, planned.solution
    written = orders(instance, solution, at=at, version=version)
    holds: dict[str, set[str]] = {}
    for plan in solution.plans:
        entered = [visit for visit in plan.visits if visit.enter <= at]
        order = written.get(str(plan.robot))
        assert order is not None or not entered
        if order is None:
            continue
        check_form(order)
        assert [*visited(instance, order)] == [str(visit.resource) for visit in plan.visits]
        base = [*visited(instance, order, base=True)]
        nodes = [node["nodeId"] for node in order["nodes"]]
        assert all(str(visit.resource) in base for visit in entered if str(visit.resource) in nodes)
        for visit, resource in zip(plan.visits, base, strict=False):
            if visit.leave is None or visit.leave + instance.gap > at:
                holds.setdefault(resource, set()).add(order["serialNumber"])
        served = [each["actionParameters"][0]["value"] for node in order["nodes"] for each in node["actions"]]
        stops = instance.robot[plan.robot].stops
        assert served == [number for number, stop in enumerate(stops, start=1) if stop.service]
    for constraint in instance.graph.constraints:
        held = set().union(*(holds.get(str(each), set()) for each in constraint.resources))
        assert len(held) <= constraint.capacity


@given(PLANNED, st.integers(0, 8), st.integers(1, 6))
@settings(max_examples=draws(300))
def test_an_update_continues_the_order_from_the_last_node_of_its_base(
    planned: PlannedInstance, at: int, more: int
) -> None:
    instance, solution = planned.instance, planned.solution
    before, after = (orders(instance, solution, at=tick) for tick in (at, at + more))
    updates = orders(instance, solution, at=at + more, since=at)
    for robot, order in after.items():
        old = before.get(robot, {"nodes": [], "edges": [], "orderId": order["orderId"]})
        base = sum(node["released"] for node in old["nodes"])
        assert old["orderId"] == order["orderId"]
        if robot not in updates:
            assert order["nodes"] == old["nodes"]
            continue
        update = updates[robot]
        check_form(update)
        assert update["orderId"] == order["orderId"]
        assert (update["orderUpdateId"] > 0) == (base > 0)
        assert [*old["nodes"][: max(base - 1, 0)], *update["nodes"]] == order["nodes"]
        assert [*old["edges"][: max(base - 1, 0)], *update["edges"]] == order["edges"]
        assert sum(node["released"] for node in order["nodes"]) > base


@pytest.mark.parametrize(("gap", "left"), [("allowed", 5), ("forbidden", 6)])
def test_a_shared_place_is_released_when_the_first_robot_has_left_it(gap: Following, left: int) -> None:
    cross = ResourceGraph((Resource("x", duration=3), *map(Resource, "abcd")), tuple(("x", each) for each in "abcd"))
    instance = Instance(cross, (Robot("r", "a", "b"), Robot("s", "c", "d", release=1)), "park", gap)
    first = Plan("r", (Visit("a", 0, 2), Visit("x", 2, 5), Visit("b", 5, None)))
    second = Plan("s", (Visit("c", 1, left), Visit("x", left, left + 3), Visit("d", left + 3, None)))
    solution = Solution.of(instance, [first, second])
    bases = [
        {
            robot: sum(node["released"] for node in each["nodes"])
            for robot, each in orders(instance, solution, at=at).items()
        }
        for at in (0, 1, left - 1, left)
    ]
    assert bases == [{"r": 3}, {"r": 3, "s": 1}, {"r": 3, "s": 1}, {"r": 3, "s": 3}]


PLANT = carproof.import_layout(OPENTCS.encode()).instance
ROBOTS = (
    Robot("tow", "a", stops=(Stop("b", 4), Stop("c", 6))),
    Robot("car", "c", "b", release=30),
)
"""The first leaves c before the second comes."""


def test_lanes_are_edges_stops_are_actions_and_positions_are_in_metres(carproof: Run, elsewhere: Path) -> None:
    (elsewhere / "plant.xml").write_text(OPENTCS)
    assert carproof("convert plant.xml -o plant.json").code == 0
    plant = read_instance((elsewhere / "plant.json").read_bytes())
    instance = replace(plant, robots=ROBOTS[:1], after_goal="vanish")
    solution = Solution.of(
        instance,
        [Plan("tow", (Visit("a", 0, 1), Visit("ab", 1, 4), Visit("b", 4, 8), Visit("bc", 8, 12), Visit("c", 12, 18)))],
    )
    (elsewhere / "plant.json").write_bytes(write_instance(instance))
    (elsewhere / "plans.json").write_bytes(write_solution(solution))
    outcome = carproof("convert plant.json plans.json --to vda5050-3 --at 3 --tick 0.5s")
    assert outcome.code == 0, outcome.stderr
    order = json.loads(outcome.stdout)
    check_form(order)
    assert [edge["edgeId"] for edge in order["edges"]] == ["ab", "bc"]
    assert order["nodes"][2]["nodePosition"] == {"x": 3.0, "y": 4.0, "mapId": "map"}
    services = {node["nodeId"]: node["actions"][0]["actionParameters"][1]["value"] for node in order["nodes"][1:]}
    assert services == {"b": 2.0, "c": 3.0}
    assert order["nodes"][0]["actions"] == []
    assert order["timestamp"] == "1970-01-01T00:00:01.500Z"
    metres = carproof("convert plant.json plans.json --to vda5050-2 --unit 1m -o orders.jsonl")
    assert metres.code == 0
    assert json.loads((elsewhere / "orders.jsonl").read_bytes())["nodes"][2]["nodePosition"]["y"] == 4000.0


ROW = ResourceGraph((Resource("a"), Resource("b"), Resource(1), Resource("1")), (("a", "b"), ("b", 1), ("b", "1")))
STILL = Instance(ROW, (Robot("r", "a", "a"),), "park")
STAYS = Solution.of(STILL, [Plan("r", (Visit("a", 0, None),))])


@pytest.mark.parametrize(
    ("instance", "solution", "options", "rule"),
    [
        (STILL, STAYS, {}, "order/names"),
        (STILL, Solution.of(STILL, [Plan("r", (Visit("b", 0, None),))]), {}, "adapter/solution"),
        (PLANT, Solution((), (), ("v1",)), {"at": -1}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"at": True}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"at": 3, "since": 3}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"version": "1.1.0"}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"tick": Fraction(0)}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"unit": 0.5}, "order/settings"),
        (PLANT, Solution((), (), ("v1",)), {"at": 10**12}, "order/settings"),
    ],
)
def test_what_orders_cannot_express_is_refused(
    instance: Instance, solution: Solution, options: dict[str, Any], rule: str
) -> None:
    with pytest.raises(Refusal) as refused:
        write_orders(instance, solution, OrderSettings(**options))
    assert refused.value.rule == rule
