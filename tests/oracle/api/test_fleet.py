"""A fleet in memory: the plans are those of `add`, whatever has left; what is refused or fails changes nothing."""

from collections.abc import Callable
from dataclasses import replace
from pkgutil import resolve_name

import pytest
from msgspec import structs
from tests.optimized.neighbourhood.arrivals import CROWDED, ROOMS, Arrivals, arrivals, draw_options
from tests.profiles import rest_in

import carp_optimized
from carp_spec.permutations import splitmix64
from carp_spec.plan_rules import has_ended
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
    RobotId,
    Solution,
    Stop,
    Trace,
    Visit,
    audit,
    check,
    check_update,
)
from carproof.testing.random_instances import Draw, draw_instance

QUESTIONS = 240


def question(number: int) -> Arrivals:
    """Robots that come while time goes on, none released before it comes."""
    drawn = arrivals(number, ROOMS if number % 2 else CROWDED)
    coming = dict(drawn.robots)
    robots = (replace(robot, release=max(robot.release, coming.get(robot.id, 0))) for robot in drawn.instance.robots)
    ids = [*(plan.robot for plan in drawn.before), *coming]
    numbered = sorted((robot for robot in robots if robot.id in ids), key=lambda robot: ids.index(robot.id))
    return replace(drawn, instance=replace(drawn.instance, robots=tuple(numbered)))


@pytest.mark.parametrize("number", range(6, QUESTIONS, 16))
def test_robots_added_at_once_to_plans_that_are_there_have_the_plans_of_one_after_the_other(
    number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(carp_optimized.fleet, "MANY", 0)  # old plans are forgotten in between, as of large fleets
    asked = question(number)
    whole = Solution(asked.before, tuple(plan.robot for plan in asked.before))
    first = replace(asked.instance, robots=tuple(asked.instance.robot[id] for id in whole.order))
    robots = [asked.instance.robot[id] for id, _ in asked.robots]
    at_once, in_turn = Fleet(first, whole, planner=asked.options), Fleet(first, whole, planner=asked.options)
    at_once.add(*robots)
    for robot in robots:
        in_turn.add(robot)
        whole = carp_optimized.add(asked.instance, whole, robot.id, 0, asked.options)
    assert at_once.solution == in_turn.solution
    assert ({*in_turn.solution.plans}, in_turn.solution.order) == ({*whole.plans}, whole.order)


@pytest.mark.parametrize("part", rest_in("ci", range(4), 0))
def test_news_of_every_kind_has_the_plans_of_whole_solutions(part: int) -> None:
    polished = 0
    for number in range(part, QUESTIONS, 4):
        draw = Draw(splitmix64(next(splitmix64(40)) + number))
        mix = replace(CROWDED if number % 3 else ROOMS, stops=draw.one_of((1, 3)), services=(0, 0, 1, 4))
        drawn = draw_instance(draw, mix)
        options = replace(draw_options(draw), fallback=None)  # which would shuffle those that have left too
        instance, whole, now, told_at = replace(drawn, robots=()), Solution((), ()), 0, -1
        fleet = Fleet(instance, planner=options)
        for each in drawn.robots:
            now += draw.one_of((0, 1, 2))
            robot = replace(each, release=max(each.release, now))
            instance = replace(instance, robots=(*instance.robots, robot))
            change, at = fleet.add(robot, now=now, audit=True), max(now, told_at + 1)
            before, whole = whole, carp_optimized.add(instance, whole, robot.id, at, options)
            assert_news(fleet, change, before, whole)
            going = [each for each in fleet.instance.robots if not has_ended(plan_of(fleet, each.id), at)]
            if going and draw.happens(2):
                chosen = draw.one_of(going)
                places = [place for place in instance.graph.index if place != chosen.goal]
                stops = [Stop(draw.one_of(places), draw.one_of((0, 3)))]
                change = fleet.assign(chosen.id, stops, now, audit=True)
                before = whole
                further, whole = carp_optimized.assign(instance, whole, chosen.id, stops, at, options)
                assert (chosen.id in change.unplanned) == (further is instance)
                instance = further
                assert_news(fleet, change, before, whole)
            late = late_plan(fleet, now)
            if late and draw.happens(2):
                after = {plan.robot: plan for plan in told(fleet, Trace(now, (late,)))}
                told_at = now if after else told_at
                whole = replace(whole, plans=tuple(after.get(plan.robot, plan) for plan in whole.plans))
            if draw.happens(3):
                after = {plan.robot: plan for plan in fleet.polish(iterations=4, seed=number).plans}
                polished += bool(after)
                gone = (id for id in whole.order if id not in fleet.instance.robot)
                plans = tuple(after.get(plan.robot, plan) for plan in whole.plans)
                whole = replace(whole, plans=plans, order=(*gone, *fleet.solution.order))
            if whole.plans and draw.happens(4) and fleet.instance.robots:
                removed = draw.one_of(fleet.instance.robots).id
                assert fleet.remove(removed).plans == ()
                plans = tuple(plan for plan in whole.plans if plan.robot != removed)
                whole = replace(whole, plans=plans, order=tuple(id for id in whole.order if id != removed))
            assert check(*fleet.rest()).valid
        known = fleet.rest()
        fleet.forget()
        assert fleet.rest() == known
    assert polished > 2


def assert_news(fleet: Fleet, change: Change, before: Solution, whole: Solution) -> None:
    """The fleet holds the plans of a solution of all robots that ever came, and has named those that changed."""
    assert change.audit is None or not change.audit.late
    held = fleet.instance.robot
    assert {*fleet.solution.plans} == {plan for plan in whole.plans if plan.robot in held}
    assert fleet.solution.order == tuple(id for id in whole.order if id in held)
    assert {*change.plans} == {*whole.plans} - {*before.plans}
    assert check(fleet.instance, fleet.solution).valid


def plan_of(fleet: Fleet, robot: RobotId) -> Plan:
    plan = fleet.solution.plan_of(robot)
    assert plan is not None
    return plan


def told(fleet: Fleet, trace: Trace) -> tuple[Plan, ...]:
    """The plans that a trace changes; none if a robot could not appear at its release."""
    try:
        return fleet.trace(trace).plans
    except Refusal as refusal:
        if refusal.rule != "plan/start":
            raise
        return ()


def late_plan(fleet: Fleet, now: int) -> Plan | None:
    """What a robot has done if it has not yet moved as it was to at the tick now."""
    for plan in fleet.solution.plans:
        done = [visit for visit in plan.visits if visit.enter <= now]
        if len(done) > 1 and done[-1].enter == now and not has_ended(plan, now):
            return replace(plan, visits=(*done[:-2], structs.replace(done[-2], leave=None)))
    return None


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


def test_a_trace_keeps_what_traces_before_it_told() -> None:
    fleet = Fleet(row())
    fleet.trace(Trace(2, (Plan("x", (Visit("b", 0, 1), Visit("c", 1, None))),)))
    fleet.trace(Trace(2, (Plan("y", (Visit("a", 0, 1), Visit("b", 1, None))),)))
    fleet.add(Robot("z", "g", "h", release=2))
    known = fleet.solution
    for visits in (
        (Visit("b", 0, None),),
        (Visit("b", 0, 2), Visit("c", 2, None)),
        (Visit("b", 0, 1), Visit("c", 1, 2), Visit("d", 2, None)),
    ):
        with pytest.raises(Refusal) as refusal:
            fleet.trace(Trace(4, (Plan("z", (Visit("g", 2, None),)), Plan("x", visits))))
        assert (refusal.value.rule, refusal.value.path) == ("fleet/now", "$.plans[1]")
        assert fleet.solution == known
    at_last = Plan("x", (Visit("b", 0, 1), Visit("c", 1, 4), Visit("d", 4, None)))
    assert not check_update(known.plans, fleet.trace(Trace(4, (at_last,))).plans, 2)


def test_what_one_trace_told_of_a_robot_holds_for_those_that_were_ahead_of_it() -> None:
    fleet = Fleet(row())
    fleet.trace(Trace(2, (Plan("y", (Visit("a", 0, 1), Visit("b", 1, 2), Visit("c", 2, None))),)))
    with pytest.raises(Refusal) as refusal:
        fleet.trace(Trace(2, (Plan("x", (Visit("b", 0, None),)),)))
    assert (refusal.value.rule, refusal.value.path) == ("fleet/now", "$.plans")


def test_news_that_make_another_robot_appear_late_name_no_plan() -> None:
    fleet = Fleet(replace(lane(), robots=(Robot("x", "b", "f"), Robot("y", "b", "a", release=2))))
    with pytest.raises(Refusal) as refusal:
        fleet.trace(Trace(3, (Plan("x", (Visit("b", 0, None),)),)))
    assert (refusal.value.rule, refusal.value.path) == ("plan/start", "$.plans")


def test_who_leaves_at_the_tick_after_a_trace_gets_no_further_stops() -> None:
    fleet = Fleet(lane())
    fleet.add(Robot("r", "a", "c"))
    fleet.trace(Trace(2, ()))
    with pytest.raises(Refusal) as refusal:
        fleet.assign("r", [Stop("h")])
    assert refusal.value.rule == "fleet/robot"
    assert check(fleet.instance, fleet.solution).valid


def test_a_robot_that_is_removed_is_in_nobodys_way_any_more() -> None:
    fleet = Fleet(replace(lane(after="park"), robots=(Robot("x", "b", "f"), Robot("y", "a", "e"))))
    fleet.trace(Trace(3, (Plan("x", (Visit("b", 0, None),)),)))
    before = plan_of(fleet, "y")
    change = fleet.remove("x", 5)
    assert (change.now, change.plans, change.left) == (5, (), ("x",))
    assert fleet.solution.plans == (before,)
    assert check(*fleet.rest()).valid
    assert fleet.add(Robot("x", "h", "f", release=6), audit=True).unplanned == (), (
        "the id is free, and so is its history"
    )
    fleet.trace(Trace(6, (Plan("x", (Visit("h", 6, None),)),)))
    fleet.remove("y", 7)
    twin = Fleet(*fleet.rest(), now=7)
    late = Robot("z", "a", "e", release=8)
    assert fleet.add(late).plans == twin.add(late).plans != ()


def test_who_has_left_by_the_tick_of_its_removal_has_left_once() -> None:
    fleet = Fleet(row())
    assert fleet.remove("x", 30).left == ("x", "y")


def test_who_was_told_to_stand_somewhere_has_not_left_by_then() -> None:
    fleet = Fleet(lane(capacity=2))
    fleet.add(Robot("r", "a", "g"))
    fleet.trace(Trace(3, (Plan("r", (Visit("a", 0, 1), Visit("b", 1, None))),)))
    news: tuple[Callable[[], Change], ...] = (
        lambda: fleet.polish(iterations=5, audit=True),
        lambda: fleet.add(Robot("s", "h", "a", release=3), audit=True),
        lambda: fleet.assign("r", [Stop("h")], audit=True),
    )
    for each in news:
        change = each()
        assert change.audit is not None
        assert not change.audit.late
        assert plan_of(fleet, "r").visits[1] == Visit("b", 1, 4)
    fleet.trace(Trace(3, (Plan("s", (Visit("h", 3, None),)),)))
    assert plan_of(fleet, "r").visits[1] == Visit("b", 1, 4)


def town(edges: str, slow: str = "") -> Instance:
    """Places with names of one letter, joined by edges such as `ab`; a slow one takes three ticks."""
    places = dict.fromkeys(edges.replace(" ", ""))
    cells = tuple(Resource(place, duration=3 if place in slow else 1) for place in places)
    return Instance(ResourceGraph(cells, tuple((each[0], each[1]) for each in edges.split())), (), "vanish")


def test_who_need_not_wait_any_more_for_one_that_is_late_may_get_another_plan() -> None:
    hall = town("pq qr ij jc ck uc cv ua ab bd dv")
    waits, late, goes = Robot("p", "p", "r", pace=20), Robot("x", "i", "k", pace=10), Robot("y", "u", "v", release=20)
    fleet = Fleet(hall, planner=Neighbourhood(m=2))
    for robot in (waits, late, goes):
        fleet.add(robot)
    assert [visit.resource for visit in plan_of(fleet, "y").visits] == [*"uabdv"], "c is taken"
    fleet.trace(Trace(18, (Plan("x", (Visit("i", 0, None),)),)))
    near = Robot("z", "q", "r", release=70)
    whole = carp_optimized.add(
        replace(hall, robots=(waits, late, goes, near)), fleet.solution, "z", 19, Neighbourhood(m=2)
    )
    fleet.add(near, now=18)
    assert {*fleet.solution.plans} == {*whole.plans}
    assert [visit.resource for visit in plan_of(fleet, "y").visits] == [*"ucv"]


def test_who_leaves_a_stop_unserved_to_give_way_serves_it_whole_later() -> None:
    fleet = Fleet(town("as st ax ay", slow="s"), planner=Neighbourhood(m=3))
    fleet.add(Robot("q", "s", "t"), Robot("r", "a", stops=(Stop("a", 20), Stop("t"))))
    change = fleet.add(Robot("z", "x", "y", release=2), now=1, audit=True)
    assert plan_of(fleet, "r").visits[:3] == (Visit("a", 0, 3), Visit("s", 3, 6), Visit("a", 6, 26))
    assert change.audit is not None
    assert change.audit.holds
    instance, solution = fleet.rest()
    assert instance.robot["r"].stops[0] == Stop("a", 20)
    assert check(instance, solution).valid
    assert audit(instance, solution, find_order=True).holds
    fleet.advance(8)
    instance, solution = fleet.rest()
    assert instance.robot["r"].stops[0] == Stop("a", 18), "it is served now"
    assert check(instance, solution).valid


def test_a_polish_and_forgetting_keep_services_under_way() -> None:
    mix = replace(CROWDED, stops=3, services=(0, 2, 6, 9))
    changed = under_way = 0
    for number in range(150):
        draw = Draw(splitmix64(next(splitmix64(41)) + number))
        instance = draw_instance(draw, mix)
        fleet = Fleet(instance, planner=Neighbourhood(m=1))
        now = draw.between(1, 9)
        fleet.advance(now)
        instance, before = fleet.instance, fleet.solution.plans
        if draw.happens(2):
            fleet.forget()
        fleet.polish(iterations=20, seed=number)
        robot = draw_instance(draw, mix).robots[0]
        places = [*instance.graph.index]
        stops = tuple(Stop(place, 2) for place in dict.fromkeys([draw.one_of(places), draw.one_of(places)]))
        added = replace(robot, id="new", start=draw.one_of(places), release=now + 1, stops=stops)
        fleet.add(added)
        made = {plan.robot: plan for plan in fleet.solution.plans}
        whole = [whole_of(plan, made[plan.robot]) for plan in before]
        assert not check_update(before, whole, now), number
        everyone = replace(instance, robots=(*instance.robots, *([added] if "new" in made else [])))
        both = [*whole, *(plan for plan in made.values() if plan.robot == "new")]
        assert check(everyone, Solution.of(everyone, both)).valid, number
        changed += whole != [*before]
        under_way += any(
            visit.enter < now < (visit.leave or 0) and (visit.leave or 0) - visit.enter > 4
            for plan in before
            for visit in plan.visits
        )
    assert changed > 10
    assert under_way > 10


def whole_of(before: Plan, after: Plan) -> Plan:
    """The plan with the visits that have been forgotten."""
    first = after.visits[0]
    count = next(place for place, visit in enumerate(before.visits) if visit.enter == first.enter)
    return replace(after, visits=(*before.visits[:count], *after.visits))


def test_a_polish_keeps_what_was_done() -> None:
    drawn = [question(number) for number in range(60)]
    changed = 0
    for asked in drawn:
        fleet = Fleet(asked.instance, planner=Neighbourhood(m=1))
        fleet.advance(3)
        given, before = (fleet.instance, fleet.solution), fleet.solution.plans
        change = fleet.polish(iterations=20)
        changed += len(change.plans)
        whole = carp_optimized.polish(*given, iterations=20, now=3)
        assert ({*fleet.solution.plans}, fleet.solution.order) == ({*whole.plans}, whole.order)
        assert check(fleet.instance, fleet.solution).valid
        assert not check_update(before, fleet.solution.plans, 3)
    assert changed > 0


def news() -> dict[str, Callable[[Fleet], Change]]:
    robot = Robot("z", "a", "h", release=5)
    stays = Plan("x", (Visit("b", 0, None),))
    return {
        "fleet/now advance": lambda fleet: fleet.advance(1),
        "fleet/now add": lambda fleet: fleet.add(robot, now=1),
        "fleet/now release": lambda fleet: fleet.add(replace(robot, release=1)),
        "fleet/now trace": lambda fleet: fleet.trace(Trace(1, (stays,))),
        "fleet/now remove": lambda fleet: fleet.remove("x", 1),
        "fleet/robot remove": lambda fleet: fleet.remove("gone", 30),
        "document/shape remove": lambda fleet: fleet.remove(None),  # type: ignore[arg-type]
        "fleet/robot add": lambda fleet: fleet.add(replace(robot, id="x")),
        "limit/ticks advance": lambda fleet: fleet.advance(2**40),
        "fleet/now assign": lambda fleet: fleet.assign("x", [Stop("a")], 1),
        "fleet/robot assign": lambda fleet: fleet.assign("gone", [Stop("a")]),
        "fleet/robot ended": lambda fleet: fleet.assign("x", [Stop("a")], 30),
        "fleet/size stops": lambda fleet: fleet.assign("x", [Stop("a"), Stop("b")] * 32),
        "instance/stops same": lambda fleet: fleet.assign("x", [Stop("f")]),
        "instance/stops none": lambda fleet: fleet.assign("x", []),
        "limit/ticks service": lambda fleet: fleet.assign("x", [Stop("a", 2**30)]),
        "fleet/robot trace": lambda fleet: fleet.trace(Trace(3, (replace(stays, robot="gone"),))),
        "fleet/size many": lambda fleet: fleet.add(*(replace(robot, id=n) for n in range(20))),
        "instance/robot-id twice": lambda fleet: fleet.add(robot, robot),
        "instance/endpoint goal": lambda fleet: fleet.add(Robot("z", "a", "nowhere", release=5)),
        "instance/pace zero": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=0)),
        "document/shape text": lambda fleet: fleet.add(replace(robot, release="5")),  # type: ignore[arg-type]
        "document/shape plan": lambda fleet: fleet.add(stays),  # type: ignore[arg-type]
        "limit/ticks pace": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=2**31)),
        "limit/ticks late": lambda fleet: fleet.add(robot, replace(robot, id="v", pace=2**29)),
        "limit/ticks trace": lambda fleet: fleet.trace(
            Trace(3, (replace(stays, visits=(*stays.visits, Visit("b", 10**20, None))),))
        ),
        "trace/prefix trace": lambda fleet: fleet.trace(Trace(3, (replace(stays, visits=(Visit("c", 0, None),)),))),
        "request/now negative": lambda fleet: fleet.advance(-1),
        "request/now none": lambda fleet: fleet.advance(None),  # type: ignore[arg-type]
        "document/shape stop": lambda fleet: fleet.assign("x", Stop("a")),  # type: ignore[arg-type]
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
    if name == "limit/ticks service":
        assert refusal.value.path == "$.stops"
    if name == "limit/ticks trace":
        assert refusal.value.path == "$.plans"
    assert_alike(fleet, twin)


ODD: tuple[object, ...] = (
    True,
    1.0,
    -1,
    0,
    1,
    "a",
    "nowhere",
    None,
    (),
    [],
    (Stop("b", -1),),
    (Stop("q"),),
    [Stop("b")],
)


@pytest.mark.parametrize("field", ["id", "start", "stops", "release", "pace"])
def test_one_robot_is_refused_as_several_are(field: str) -> None:
    for value in ODD:
        odd = Robot("x", "a", "b")
        object.__setattr__(odd, field, value)
        refusals = []
        for others in ((), (Robot("y", "a", "b"),)):
            try:
                Fleet(lane()).add(odd, *others)
            except Refusal as refusal:
                refusals.append((refusal.rule, refusal.path, refusal.message))
        assert refusals in ([], 2 * refusals[:1]), value


def assert_alike(fleet: Fleet, twin: Fleet) -> None:
    """Both know the same, and answer alike."""
    assert (fleet.now, fleet.instance, fleet.solution) == (twin.now, twin.instance, twin.solution)
    robot = Robot("w", "h", "b", release=4)
    assert fleet.add(robot, now=3) == twin.add(robot, now=3)
    assert fleet.solution == twin.solution


@pytest.mark.parametrize(
    "place",
    [
        *(f"carp_optimized.fleet.PlannedFleet.{name}" for name in ("changed", "dismiss", "enlist", "replan")),
        "carp_optimized.adding.add",
        "carproof.api.fleet.audit_in_order",
    ],
)
def test_a_failure_in_the_middle_changes_nothing(monkeypatch: pytest.MonkeyPatch, place: str) -> None:
    fleet, twin = Fleet(row()), Fleet(row())
    real = resolve_name(place)

    def failing(*arguments: object, **named: object) -> None:
        real(*arguments, **named)
        raise MemoryError

    def tell(fleet: Fleet) -> None:
        if place.endswith("replan"):
            fleet.trace(Trace(2, (Plan("x", (Visit("b", 0, 1), Visit("c", 1, None))),)))
        else:
            fleet.add(Robot("v", "h", "a", release=1), Robot("u", "b", "c", release=8), now=1, audit=True)

    monkeypatch.setattr(place, failing)
    with pytest.raises(MemoryError):
        tell(fleet)
    monkeypatch.undo()
    assert_alike(fleet, twin)
