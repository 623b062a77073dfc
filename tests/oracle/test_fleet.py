"""A fleet in memory: the plans are those of `add`, whatever has left; what is refused or fails changes nothing."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from tests.optimized.arrivals import CROWDED, ROOMS, Arrivals, arrivals
from tests.profiles import rest_in

import carp_optimized
from carproof import (
    Change,
    Fleet,
    Instance,
    Neighbourhood,
    Plan,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    Solution,
    Trace,
    Visit,
    audit,
    check,
    check_update,
)

QUESTIONS = 240


def question(number: int) -> Arrivals:
    """Robots that come while time goes on, none released before it comes."""
    drawn = arrivals(number, ROOMS if number % 2 else CROWDED)
    coming = dict(drawn.robots)
    robots = (replace(robot, release=max(robot.release, coming.get(robot.id, 0))) for robot in drawn.instance.robots)
    ids = [*(plan.robot for plan in drawn.before), *coming]
    numbered = sorted((robot for robot in robots if robot.id in ids), key=lambda robot: ids.index(robot.id))
    return replace(drawn, instance=replace(drawn.instance, robots=tuple(numbered)))


@pytest.mark.parametrize("part", rest_in("ci", range(4), 0))
def test_plans_are_those_that_add_makes_with_all_robots_that_ever_came(part: int) -> None:
    for number in range(part, QUESTIONS, 4):
        asked = question(number)
        instance = asked.instance
        whole = Solution(asked.before, tuple(plan.robot for plan in asked.before))
        first = replace(instance, robots=tuple(instance.robot[id] for id in whole.order))
        fleet = Fleet(first, whole, planner=asked.options)
        known = {plan.robot: plan for plan in whole.plans}
        for robot, now in asked.robots:
            change = fleet.add(instance.robot[robot], now=now, audit=instance.following == "allowed")
            before, whole = whole, carp_optimized.add(instance, whole, robot, now, asked.options)
            known |= {plan.robot: plan for plan in change.plans}
            assert known == {plan.robot: plan for plan in whole.plans}, number
            assert fleet.solution.order == tuple(id for id in whole.order if id in fleet.instance.robot)
            assert {*change.plans} == {*whole.plans} - {*before.plans}
            assert change.audit is None or not change.audit.late
        assert check(fleet.instance, fleet.solution).valid


def lane(capacity: int = 1, after: str = "vanish") -> Instance:
    cells = tuple(Resource(cell, capacity, x=x, y=0) for x, cell in enumerate("abcdefgh"))
    edges = tuple(zip("abcdefg", "bcdefgh", strict=True))
    return Instance(ResourceGraph(cells, edges), (), "park" if after == "park" else "vanish")


def test_a_fleet_grows_to_more_robots_and_paces_than_it_had_room_for() -> None:
    fleet = Fleet(lane(capacity=300), planner=Neighbourhood(m=2))
    for n in range(300):
        robot = Robot(n, "a", "abcdefgh"[n % 7 + 1], pace=n % 5 + 1 if n < 290 else 2**26 + n)
        assert fleet.add(robot).plans == carp_optimized.plan(replace(fleet.instance, robots=(robot,))).plans
    assert check(fleet.instance, fleet.solution).valid
    assert fleet.advance(4).left == tuple(n for n in range(290) if (n % 7 + 2) * (n % 5 + 1) <= 4)


def row() -> Instance:
    """Two robots one behind the other on a lane."""
    return replace(lane(), robots=(Robot("x", "b", "f"), Robot("y", "a", "e")))


def test_robots_that_are_late_make_others_wait_and_keep_what_was_done() -> None:
    fleet = Fleet(row())
    late = Plan("x", (Visit("b", 0, 1), Visit("c", 1, None)))
    change = fleet.trace(Trace(4, (late,)), audit=True)
    assert {plan.robot: plan.visits[-1].enter for plan in change.plans} == {"x": 7, "y": 7}
    assert check(fleet.instance, fleet.solution).valid
    assert fleet.trace(Trace(4, ())).plans == (), "all is as planned now"
    assert fleet.advance(9).left == ("x", "y")


def test_a_polish_keeps_what_was_done() -> None:
    drawn = [question(number) for number in range(60)]
    changed = 0
    for asked in drawn:
        fleet = Fleet(asked.instance, planner=Neighbourhood(m=1))
        fleet.advance(3)
        before = fleet.solution.plans
        change = fleet.polish(iterations=20)
        changed += len(change.plans)
        assert check(fleet.instance, fleet.solution).valid
        assert not check_update(before, fleet.solution.plans, 3)
        assert fleet.solution.order == tuple(dict.fromkeys(fleet.solution.order))
    assert changed > 0


def test_the_rest_is_an_instance_of_its_own() -> None:
    fleet = Fleet(row(), now=0)
    fleet.advance(2)
    instance, solution = fleet.rest()
    assert [(robot.start, robot.release) for robot in instance.robots] == [("d", 2), ("c", 2)]
    assert check(instance, solution).valid
    assert audit(instance, solution).holds


def news() -> dict[str, Callable[[Fleet], Change]]:
    robot = Robot("z", "a", "h", release=5)
    stays = Plan("x", (Visit("b", 0, None),))
    return {
        "fleet/now advance": lambda fleet: fleet.advance(1),
        "fleet/now add": lambda fleet: fleet.add(robot, now=1),
        "fleet/now release": lambda fleet: fleet.add(replace(robot, release=1)),
        "fleet/now trace": lambda fleet: fleet.trace(Trace(1, (stays,))),
        "fleet/robot add": lambda fleet: fleet.add(replace(robot, id="x")),
        "fleet/robot trace": lambda fleet: fleet.trace(Trace(3, (replace(stays, robot="gone"),))),
        "fleet/size many": lambda fleet: fleet.add(*(replace(robot, id=n) for n in range(20))),
        "instance/robot-id twice": lambda fleet: fleet.add(robot, robot),
        "instance/endpoint goal": lambda fleet: fleet.add(Robot("z", "a", "nowhere", release=5)),
        "instance/pace zero": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=0)),
        "document/shape text": lambda fleet: fleet.add(replace(robot, release="5")),  # type: ignore[arg-type]
        "document/shape plan": lambda fleet: fleet.add(stays),  # type: ignore[arg-type]
        "limit/ticks pace": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=2**31)),
        "limit/ticks late": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=2**29)),
        "trace/prefix trace": lambda fleet: fleet.trace(Trace(3, (replace(stays, visits=(Visit("c", 0, None),)),))),
        "request/now negative": lambda fleet: fleet.advance(-1),
        "polish/options iterations": lambda fleet: fleet.polish(iterations=-1),
    }


@pytest.mark.parametrize("name", news())
def test_what_is_refused_changes_nothing(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr("carproof.api.fleet.MOST_ROBOTS", 10)
    fleet, twin = Fleet(row()), Fleet(row())
    for each in (fleet, twin):
        each.advance(2)
    with pytest.raises(Refusal) as refusal:
        news()[name](fleet)
    assert refusal.value.rule == name.partition(" ")[0]
    assert_alike(fleet, twin)


def assert_alike(fleet: Fleet, twin: Fleet) -> None:
    """Both know the same, and answer alike."""
    assert (fleet.now, fleet.instance, fleet.solution) == (twin.now, twin.instance, twin.solution)
    robot = Robot("w", "h", "b", release=4)
    assert fleet.add(robot, now=3) == twin.add(robot, now=3)
    assert fleet.solution == twin.solution


@pytest.mark.parametrize("place", ["add", "changed_since", "dismiss", "enlist", "replan"])
def test_a_failure_in_the_middle_changes_nothing(monkeypatch: pytest.MonkeyPatch, place: str) -> None:
    from carp_optimized.fleet import PlannedFleet

    fleet, twin = Fleet(row()), Fleet(row())
    real = getattr(PlannedFleet, place)

    def failing(*arguments: object, **named: object) -> None:
        real(*arguments, **named)
        raise MemoryError

    def tell(fleet: Fleet) -> None:
        if place == "replan":
            fleet.trace(Trace(2, (Plan("x", (Visit("b", 0, 1), Visit("c", 1, None))),)))
        else:
            fleet.add(Robot("v", "h", "a", release=1), Robot("u", "b", "c", release=8), now=1)

    monkeypatch.setattr(PlannedFleet, place, failing)
    with pytest.raises(MemoryError):
        tell(fleet)
    monkeypatch.undo()
    assert_alike(fleet, twin)


def test_a_change_whose_proof_fails_is_no_change(monkeypatch: pytest.MonkeyPatch) -> None:
    fleet, twin = Fleet(row()), Fleet(row())
    monkeypatch.setattr("carproof.api.fleet.audit_in_order", raising)
    with pytest.raises(Refusal):
        fleet.add(Robot("v", "a", "b", release=9), audit=True)
    assert_alike(fleet, twin)


def raising(*_: object, **__: object) -> None:
    raise Refusal("limit", "$", "query/size", "planted")
