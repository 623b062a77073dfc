"""Plans for the rest of the way after delays: lawful, in the planned order, and as early as possible."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.spec.making import CROSSED, plan_of

from carp_reference.execution import order_of, retime, solution_at
from carp_spec import Instance, Plan, Refusal, Solution, Visit, check_update, judge
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.execution.traces import Trace
from carproof.execution.delays import Delay, executed, in_order, planned, stuck
from carproof.testing.strategies import Sizes, planned_instances


@st.composite
def delayed(draw: st.DrawFn) -> tuple[Instance, Solution, tuple[Delay, ...]]:
    """A solution and delays of some visits that are no robot's last."""
    case = draw(planned_instances(Sizes(resources=4, robots=4, groups=2, stops=3, service=4)))
    places = [(plan.robot, place) for plan in case.solution.plans for place in range(len(plan.visits) - 1)]
    chosen = draw(st.lists(st.sampled_from(places), max_size=4, unique=True)) if places else []
    return case.instance, case.solution, tuple(Delay(*node, draw(st.integers(1, 4))) for node in chosen)


@settings(max_examples=draws(300))
@given(delayed(), st.integers(0, 12))
def test_retimed_plans_are_lawful_keep_what_has_happened_and_cannot_be_earlier(
    case: tuple[Instance, Solution, tuple[Delay, ...]], now: int
) -> None:
    instance, solution, delays = case
    order = order_of(instance, solution)
    if stuck(order):
        return
    trace = executed(order, in_order(order, delays), delays, now)
    assert not trace_violations(instance, solution, trace)
    try:
        after = retime(instance, solution, trace)
    except Refusal as refusal:
        if refusal.rule != "plan/start":  # its start is not free at its release
            raise
        return
    assert judge(instance, after).valid
    known = [plan for plan in trace.plans if plan.visits]
    assert not check_update(known, after.plans, now)
    for plan in after.plans:
        assert_not_earlier(instance, solution, after, plan, now)


def assert_not_earlier(instance: Instance, solution: Solution, after: Solution, plan: Plan, now: int) -> None:
    """Any visit entered a tick earlier breaks a rule of execution, or is entered before it can be known."""
    for place, visit in enumerate(plan.visits):
        if visit.enter <= now + 1 or place == 0:
            continue
        visits = [*plan.visits]
        before = visits[place - 1]
        visits[place - 1] = Visit(before.resource, before.enter, visit.enter - 1)
        visits[place] = Visit(visit.resource, visit.enter - 1, visit.leave)
        others = [each for each in after.plans if each.robot != plan.robot]
        last = max(each.leave or each.enter for every in after.plans for each in every.visits)
        assert trace_violations(instance, solution, Trace(last, (*others, Plan(plan.robot, tuple(visits)))))


def test_without_delays_the_plans_stay_or_get_earlier() -> None:
    instance, solution = CROSSED
    order = order_of(instance, solution)
    assert retime(instance, solution, executed(order, planned(order), now=1)) == solution
    assert solution_at(order, planned(order)) == solution


@pytest.mark.parametrize(
    ("trace", "rule"),
    [
        (Trace(3, (plan_of("r1", ("b", 2, None)), plan_of("r2", ("a", 0, None)))), "plan/start"),
        (Trace(0, (plan_of("r1"), plan_of("r2", ("a", 0, None)))), "plan/start"),
        (
            Trace(9, (plan_of("r1", ("b", 0, 1), ("c", 1, 2), ("d", 2, None)), plan_of("r2", ("a", 0, None)))),
            "plan/goal",
        ),
        (Trace(9, (plan_of("r1", ("b", 0, 1), ("c", 1, 2), ("d", 2, 5)), plan_of("r2", ("a", 0, None)))), "plan/goal"),
        (Trace(1, (plan_of("r1", ("b", 0, None)), plan_of("r2", ("a", 0, 1), ("b", 1, None)))), "execution/order"),
    ],
)
def test_a_history_that_no_lawful_plan_has_is_refused(trace: Trace, rule: str) -> None:
    with pytest.raises(Refusal) as refused:
        retime(*CROSSED, trace)
    assert refused.value.rule == rule
    assert refused.value.path.startswith("$.plans[")
