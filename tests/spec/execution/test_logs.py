"""Logs are judged by the law without plans: robots may be under way, and what is seen up to the tick now counts."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import Stay, line, plan_of

from carp_spec import Instance, Plan, Refusal, Robot, Stop, Visit, judge
from carp_spec.execution.logs import Served, judge_log
from carp_spec.execution.traces import Trace
from carproof.execution.delays import until
from carproof.testing.strategies import PlannedInstance, broken_solutions, planned_instances

LANE = line("abcd")
EAST = Robot("r", "a", stops=(Stop("c", 2), Stop("b")))
UNDER_WAY = plan_of("r", ("a", 0, 1), ("b", 1, 2), ("c", 2, None))


@given(planned_instances(), st.integers(0, 20))
def test_what_sound_plans_do_breaks_no_rule_at_any_tick(planned: PlannedInstance, now: int) -> None:
    log = until(Trace(now, planned.solution.plans), now)
    unplanned = {*planned.solution.unplanned}
    found = judge_log(planned.instance, log).violations
    assert all(each.rule == "plan/start" and unplanned & {*each.robots} for each in found)


@given(broken_solutions())
def test_what_robots_do_together_is_judged_as_for_plans(planned: PlannedInstance) -> None:
    plans = planned.solution.plans
    now = max((tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave or 0)), default=0)
    by_law = judge(planned.instance, planned.solution, None).violations
    in_log = judge_log(planned.instance, Trace(now, plans), None).violations
    together = [[each for each in found if each.rule.startswith("joint/")] for found in (by_law, in_log)]
    assert [(e.rule, e.robots, e.resource, e.start) for e in together[0]] == [
        (e.rule, e.robots, e.resource, e.start) for e in together[1]
    ]


def test_stops_served_so_far_are_told_with_the_visits_that_served_them() -> None:
    instance = Instance(LANE, (EAST,))
    under_way = judge_log(instance, Trace(9, (UNDER_WAY,)))
    assert (under_way.valid, under_way.done, under_way.served) == (True, 0, (Served("r", 0, "c", 2, None),))
    back = Plan("r", (*UNDER_WAY.visits[:2], Visit("c", 2, 4), Visit("b", 4, 5)))
    done = judge_log(instance, Trace(9, (back,)))
    assert (done.valid, done.done, done.cost) == (True, 1, 4)
    on = Plan("r", (*back.visits[:3], Visit("b", 4, 5), Visit("c", 5, None)))
    under_way = judge_log(instance, Trace(9, (on,)))
    assert (under_way.done, under_way.cost, len(under_way.served)) == (0, 0, 2)
    again = Plan("r", (*on.visits[:4], Visit("c", 5, 6), Visit("b", 6, None)))
    assert judge_log(instance, Trace(9, (again,))).cost == 6
    hasty = Plan("r", (*UNDER_WAY.visits[:2], Visit("c", 2, 3), Visit("b", 3, 4)))
    judged = judge_log(instance, Trace(9, (hasty,)))
    assert ([each.rule for each in judged.violations], judged.served) == (["plan/stops"], ())


@pytest.mark.parametrize(
    ("visits", "rule"),
    [
        ([("a", 0, 1), ("c", 1, None)], "plan/move"),
        ([("a", 0, 1), ("b", 2, None)], "plan/contiguous"),
        ([("a", 0, None), ("b", 2, None)], "plan/contiguous"),
        ([("b", 0, None)], "plan/start"),
        ([], "plan/start"),
        ([("a", 0, 1), ("nowhere", 1, None)], "plan/resource"),
        ([("a", 0, 1), ("b", 1, 1), ("c", 1, None)], "plan/duration"),
        ([("a", 0, 1)], "plan/goal"),
    ],
)
def test_a_log_keeps_the_rules_of_plans(visits: list[Stay], rule: str) -> None:
    log = Trace(5, (plan_of("r", *visits),))
    found = [each.rule for each in judge_log(Instance(LANE, (EAST,)), log).violations]
    assert rule in found


@pytest.mark.parametrize(
    ("release", "visits", "rules"),
    [(6, [], []), (5, [], ["plan/start"]), (6, [("a", 3, None)], ["plan/start"])],
)
def test_a_robot_appears_at_its_release(release: int, visits: list[Stay], rules: list[str]) -> None:
    instance = Instance(LANE, (Robot("r", "a", "b", release=release),))
    plans = (plan_of("r", *visits),) if visits else ()
    assert [each.rule for each in judge_log(instance, Trace(5, plans)).violations] == rules


def test_what_robots_do_together_is_judged_up_to_the_end_of_the_log() -> None:
    instance = Instance(LANE, (Robot("r", "a", "c"), Robot("s", "c", "a")))
    both = (plan_of("r", ("a", 0, 1), ("b", 1, None)), plan_of("s", ("c", 0, 1), ("b", 1, None)))
    found = judge_log(instance, Trace(4, both)).violations
    assert [(each.rule, each.start, each.end) for each in found] == [("joint/capacity", 1, 5)]


def test_robots_that_are_released_later_may_be_absent_and_unknown_ones_may_not() -> None:
    instance = Instance(LANE, (Robot("late", "a", "b", release=6), Robot("now", "d", "b")))
    log = Trace(5, (plan_of("now", ("d", 0, None)), plan_of("who", ("a", 0, None))))
    assert [(each.rule, each.robots) for each in judge_log(instance, log).violations] == [("solution/covers", ("who",))]


@pytest.mark.parametrize("last", [Visit("b", 2, None), Visit("b", 1, 2), Visit("b", 2, 3)])
def test_nothing_happens_after_the_end_of_a_log(last: Visit) -> None:
    with pytest.raises(Refusal) as refusal:
        judge_log(Instance(LANE, (EAST,)), Trace(1, (Plan("r", (Visit("a", 0, 1), last)),)))
    assert (refusal.value.rule, refusal.value.path) == ("log/now", "$.plans[0].visits[1]")


def test_malformed_instances_and_logs_are_refused() -> None:
    with pytest.raises(Refusal) as refusal:
        judge_log(Instance(LANE, (EAST, EAST)), Trace(9, (UNDER_WAY,)))
    assert refusal.value.rule == "instance/robot-id"
    with pytest.raises(Refusal) as refusal:
        judge_log(Instance(LANE, (EAST,)), Trace(9, (UNDER_WAY, "r")))  # type: ignore[arg-type]
    assert refusal.value.rule == "document/shape"
