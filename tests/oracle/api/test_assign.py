"""Robots under way or parked get further stops: by the command, by the op, and from Python."""

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.running import asked, solution, town

import carproof
from carp_spec import Refusal, Stop, check_update, judge
from carp_spec.plan_rules import has_ended
from carproof import read_instance, read_solution
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

PICK = {"id": "r1", "start": "a", "stops": [{"resource": "c", "service": 3}, {"resource": "a"}]}
SIDE = {"id": "r2", "start": "d", "goal": "p"}
HALL = town("ab bc cd bp", [PICK, SIDE], "park")
PLANS = solution(
    {
        "r2": [["d", 0, 1], ["c", 1, 2], ["b", 2, 3], ["p", 3, None]],
        "r1": [["a", 0, 3], ["b", 3, 4], ["c", 4, 7], ["b", 7, 8], ["a", 8, None]],
    }
)


@given(fleets_under_way(Sizes(stops=2, service=3)), st.data())
def test_a_robot_serves_further_stops_and_all_keep_their_histories(fleet: FleetUnderWay, data: st.DataObject) -> None:
    instance, before, now = fleet.instance, fleet.solution, fleet.now
    going = [plan.robot for plan in before.plans if not has_ended(plan, now)]
    if not going:
        return
    robot = data.draw(st.sampled_from(going))
    last = instance.robot[robot].goal
    places = [place for place in instance.graph.index if place != last]
    if not places:
        return
    stop = Stop(data.draw(st.sampled_from(places)), data.draw(st.integers(0, 3)))
    further, after = carproof.assign(instance, before, robot, [stop], now, carproof.Neighbourhood(m=2))
    if further is instance:
        assert after is before
    else:
        assert further.robot[robot].stops == (*instance.robot[robot].stops, stop)
        assert judge(further, after).violations == ()
        assert {plan.robot for plan in after.plans} == {plan.robot for plan in before.plans}
        assert check_update(before.plans, after.plans, now) == ()


def test_a_stop_to_which_no_way_leads_changes_nothing() -> None:
    blocked = {**HALL, "graph": {**HALL["graph"], "nodes": [*HALL["graph"]["nodes"], {"id": "far"}]}}
    result = asked("assign", instance=blocked, solution=PLANS, robot="r2", now=4, stops=[{"resource": "far"}])["result"]
    assert (result["instance"], result["solution"]) == (None, PLANS)


@pytest.mark.parametrize(
    ("robot", "stops", "now", "rule", "path"),
    [
        ("r2", [Stop("p")], 4, "instance/stops", "$.stops[0].resource"),
        ("r2", [Stop("d"), Stop("d")], 4, "instance/stops", "$.stops[1].resource"),
        ("r1", [Stop("d"), Stop("c"), Stop("nowhere")], 4, "instance/stops", "$.stops[2].resource"),
        ("r2", [Stop("d", -1)], 4, "instance/stops", "$.stops[0].service"),
        ("r2", [], 4, "instance/stops", "$.stops"),
        ("r2", ["d"], 4, "document/shape", "$.stops[0]"),
        ("r2", [Stop("d")], -1, "request/now", "$.now"),
        ("r9", [Stop("d")], 4, "request/robot", "$.robot"),
    ],
)
def test_wrong_stops_and_ticks_are_refused(robot: str, stops: list[Stop], now: int, rule: str, path: str) -> None:
    instance, plans = read_instance(json.dumps(HALL).encode()), read_solution(json.dumps(PLANS).encode())
    with pytest.raises(Refusal) as refused:
        carproof.assign(instance, plans, robot, stops, now)
    assert (refused.value.rule, refused.value.path) == (rule, path)


def test_plans_that_break_a_rule_get_no_further_stops() -> None:
    instance, plans = read_instance(json.dumps(HALL).encode()), read_solution(json.dumps(PLANS).encode())
    alone = replace(plans, plans=plans.plans[1:], order=("r1",), unplanned=("r2",))
    with pytest.raises(Refusal) as refused:
        carproof.assign(instance, alone, "r2", [Stop("d")], 4)
    assert refused.value.rule == "request/robot"
    jumps = replace(plans.plans[0], visits=(plans.plans[0].visits[0], *plans.plans[0].visits[2:]))
    with pytest.raises(Refusal) as refused:
        carproof.assign(instance, replace(plans, plans=(jumps, plans.plans[1])), "r2", [Stop("d")], 4)
    assert refused.value.rule == "plan/move"


def test_a_robot_that_has_left_is_refused() -> None:
    left = solution({"r2": [["d", 0, 1], ["c", 1, 2], ["b", 2, 3], ["p", 3, 4]]}, ["r1"])
    hall = {**HALL, "after_goal": "vanish"}
    error = asked("assign", instance=hall, solution=left, robot="r2", now=4, stops=[{"resource": "d"}])["error"]
    assert (error["rule"], error["message"]) == (
        "request/robot",
        "the robot must be under way or parked at 4, and 'r2' has left",
    )
