"""A planner is asked only what it claims to plan, and the verdict lists what was left out."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from msgspec import structs
from tests.oracle.conform.judging.test_judges import Tampered, as_it_is

import carp_reference
from carp_spec.limits import goals_stand_alone
from carproof import Carp, Greedy, Group, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Stop, conforms
from carproof.conform.asking.smoke import EAST, FIRST, FIRST_GOES, WEST, committed, passing_place, row
from carproof.conform.cases import ASKED_OPS, Case
from carproof.conform.judging.claims import FEATURES, Claims, features, is_solvable
from carproof.conform.levels import Level
from carproof.conform.programs.function import Function
from carproof.conform.run import Options, conform
from carproof.engines import engine_named


def of(claims: Claims, examples: int = 24) -> Options:
    return Options(Level.SOUND, examples, shrink_seconds=1, claims=claims)


def whole(claims: Claims) -> Options:
    return Options(Level.SOUND, 60, shrink_seconds=1, whole=True, claims=claims)


def fails_where(is_hard: Callable[[Instance], bool]) -> Function:
    def plan(instance: Instance) -> Solution:
        if is_hard(instance):
            raise RuntimeError
        return carp_reference.plan(instance, Carp())

    return Function(plan, "simple")


@pytest.mark.parametrize("feature", ["capacities", "directed", "vanish"])
def test_a_planner_without_a_feature_conforms_where_it_is_not_claimed(feature: str) -> None:
    planner = fails_where(lambda instance: FEATURES[feature](Case("smoke", "one", "plan", instance)))
    assert conform(planner, whole(Claims())).conforms is False
    assert conform(planner, whole(Claims(frozenset([feature])))).conforms


def test_a_planner_that_fails_where_a_goal_cannot_be_reached_is_asked_only_for_plans_that_exist() -> None:
    planner = fails_where(lambda instance: bool(carp_reference.plan(instance, Carp()).unplanned))
    assert conform(planner, whole(Claims())).conforms is False
    subject = Tampered(as_it_is)
    asked = subject.cases
    assert conform(subject, of(Claims(solvable=True))).conforms
    assert {case.op for case in asked} == {*ASKED_OPS} - {"optimum"}
    assert all(is_solvable(case) for case in asked)


def test_a_planner_that_fails_where_there_is_no_robot_does_not_conform() -> None:
    assert conform(fails_where(lambda instance: not instance.robots), whole(Claims())).conforms is False


def test_only_a_claimed_feature_is_in_a_random_case() -> None:
    subject = Tampered(as_it_is)
    asked = subject.cases
    assert conform(subject, of(Claims(frozenset({*FEATURES} - {"park"})))).conforms
    assert sum(case.stage == "random" for case in asked) == 24
    assert not [case for case in asked for name in {*FEATURES} - {"park"} if FEATURES[name](case)]


PLAIN = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("new", "a", "b"),))
MANY = replace(PLAIN, robots=(Robot("first", "b", "b", pace=2, release=1), *PLAIN.robots))
ISLANDS = replace(PLAIN, graph=ResourceGraph(PLAIN.graph.resources, ()))
BLOCKED, ASIDE = row([FIRST, WEST]), passing_place([FIRST, Robot("new", "b", "p")])
ONE_BY_ONE = passing_place([Robot("first", "a", "c"), Robot("new", "c", "a")], "park")


@pytest.mark.parametrize(
    ("feature", "without", "having"),
    [
        ("capacities", PLAIN, replace(PLAIN, graph=ResourceGraph((Resource("a"), Resource("b", 2)), (("a", "b"),)))),
        ("durations", PLAIN, replace(PLAIN, graph=ResourceGraph((Resource("a"), Resource("b", 1, 2)), (("a", "b"),)))),
        ("paces", PLAIN, MANY),
        ("releases", PLAIN, MANY),
        ("directed", PLAIN, replace(PLAIN, graph=replace(PLAIN.graph, directed=True))),
        ("park", PLAIN, replace(PLAIN, after_goal="park")),
        ("vanish", replace(PLAIN, after_goal="park"), PLAIN),
    ],
)
def test_a_case_is_left_out_where_it_has_a_feature_that_is_not_claimed(
    feature: str, without: Instance, having: Instance
) -> None:
    for solvable in (False, True):
        claims = Claims(frozenset([feature]), solvable)
        assert claims.why_not(Case("smoke", "one", "plan", without)) is None
        assert claims.why_not(Case("smoke", "one", "plan", having)) == f"it does not claim {feature}"
        assert claims.left_out == [feature, *["robots without a plan"] * solvable, "groups", "stops and service"]
    cases = [Case("smoke", "one", "plan", instance) for instance in (having, without)]
    assert [feature in features(case) for case in cases] == [feature != "vanish", False]


@pytest.mark.parametrize(
    ("feature", "claims", "having"),
    [
        ("groups", Claims(groups=True), replace(PLAIN, graph=replace(PLAIN.graph, groups=(Group("g", ("a", "b")),)))),
        ("stops", Claims(stops=True), replace(PLAIN, robots=(Robot("new", "a", stops=(Stop("b", service=1),)),))),
        ("stops", Claims(stops=True), replace(PLAIN, robots=(Robot("new", "a", stops=(Stop("a"), Stop("b"))),))),
    ],
)
def test_groups_and_stops_are_left_out_where_they_are_not_claimed(
    feature: str, claims: Claims, having: Instance
) -> None:
    case = Case("smoke", "one", "plan", having)
    assert Claims(groups=True, stops=True).why_not(case) is claims.why_not(case) is None
    assert Claims(groups=feature != "groups", stops=feature != "stops").why_not(case) == f"it does not claim {feature}"


def test_who_does_not_claim_now_is_asked_about_no_robot_under_way() -> None:
    subject = Tampered(as_it_is, ("query", "add"))
    asked = subject.cases
    assert conform(subject, of(Claims(frozenset({"now"})), examples=60)).conforms
    planned = [plan.robot == case.robot for case in asked for plan in case.solution.plans]
    assert planned
    assert not any(planned)
    assert {case.now for case in asked} == {0}


@pytest.mark.parametrize(
    ("case", "can_be"),
    [
        (Case("smoke", "one", "check", ISLANDS), True),
        (Case("smoke", "one", "plan", PLAIN), True),
        (Case("smoke", "one", "plan", ISLANDS), False),
        (Case("smoke", "one", "plan", ONE_BY_ONE), True),
        (Case("smoke", "one", "plan", ONE_BY_ONE, planner=Carp()), False),
        (Case("smoke", "one", "plan", ASIDE, planner=Greedy()), True),
        (Case("smoke", "one", "optimum", ONE_BY_ONE), True),
        (Case("smoke", "one", "optimum", BLOCKED), False),
        (Case("smoke", "one", "query", row([EAST]), robot="new"), True),
        (Case("smoke", "one", "query", ISLANDS, robot="new"), False),
        (Case("smoke", "one", "query", BLOCKED, committed(BLOCKED, first=FIRST_GOES), "new"), False),
        (Case("smoke", "one", "query", ASIDE, committed(ASIDE, first=FIRST_GOES), "new"), True),
        (Case("smoke", "one", "query", ASIDE, committed(ASIDE, first=FIRST_GOES), "new", 3), False),
        (Case("smoke", "one", "add", BLOCKED, committed(BLOCKED, first=FIRST_GOES), "new"), False),
        (Case("smoke", "one", "add", ASIDE, committed(ASIDE, first=FIRST_GOES), "new"), True),
    ],
)
def test_a_case_is_solvable_where_the_robots_that_it_asks_for_can_have_plans(case: Case, can_be: bool) -> None:
    assert is_solvable(case) is can_be
    assert Claims().why_not(case) is None
    assert Claims(solvable=True).why_not(case) == (None if can_be else "it does not claim robots without a plan")


def blind_beyond(resources: int) -> Callable[[Instance], Solution]:
    """A planner that does not look at groups on larger maps."""

    def planner(instance: Instance) -> Solution:
        seen = instance.graph.groups if len(instance.graph.resources) <= resources else ()
        return engine_named(None).plan(replace(instance, graph=replace(instance.graph, groups=seen)), Carp())

    return planner


def test_smoke_cases_alone_tell_who_does_not_look_at_groups() -> None:
    report = conforms(blind_beyond(0), examples=0, large=0, groups=True)
    assert {each.finding.rule for each in report.failures if each.finding} == {"joint/group", "joint/exchange"}
    assert all(each.case.stage == "smoke" for each in report.failures)


def test_large_cases_tell_who_does_not_look_at_groups_on_large_maps() -> None:
    assert conforms(blind_beyond(12), examples=20, large=0, groups=True).conforms
    report = conforms(blind_beyond(12), examples=20, large=60, groups=True)
    assert any("joint/group" in str(each) for each in report.failures)
    assert conforms(blind_beyond(12), examples=20, large=2).conforms


def test_a_planner_that_claims_stops_must_serve_them_in_order() -> None:
    asked: list[bool] = []

    def planner(tamper: Callable[[Robot], tuple[Stop, ...]]) -> Callable[[Instance], Solution]:
        def plan(instance: Instance) -> Solution:
            asked.append(not goals_stand_alone(instance))
            robots = tuple(replace(robot, stops=tamper(robot)) for robot in instance.robots)
            believed = replace(instance, robots=robots)
            plans = carp_reference.plan(believed, Carp()).plans
            return Solution.of(instance, [ended(instance, plan) for plan in plans])

        return plan

    def without_service(robot: Robot) -> tuple[Stop, ...]:
        return tuple(Stop(stop.resource) for stop in robot.stops)

    def without_the_second(robot: Robot) -> tuple[Stop, ...]:
        kept = robot.stops[:1] + robot.stops[2:] if len(robot.stops) > 2 else robot.stops
        return kept if kept[0].resource != kept[-1].resource else robot.stops

    assert conforms(planner(lambda robot: robot.stops[-1:]), examples=40, large=0).conforms
    assert not any(asked)
    assert conforms(planner(lambda robot: robot.stops), examples=40, large=2, stops=True).conforms
    assert any(asked)
    for wrong, robots, stops in ((without_service, 1, 2), (without_the_second, 1, 3)):
        report = conforms(planner(wrong), examples=200, seed=1, large=0, stops=True)
        broken = [each for each in report.failures if each.finding is not None and each.finding.rule == "plan/stops"]
        assert broken, wrong
        smallest = broken[0].case.instance
        assert len(smallest.robots) == robots, smallest
        assert len(smallest.robots[0].stops) <= stops, smallest


def ended(instance: Instance, plan: Plan) -> Plan:
    *visits, last = plan.visits
    stay = instance.stay(plan.robot, instance.robot[plan.robot].stops[-1])
    leave = None if instance.after_goal == "park" else last.enter + stay
    return Plan(plan.robot, (*visits, structs.replace(last, leave=leave)))
