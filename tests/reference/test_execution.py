"""Executions in the order of the plans: safe, alive and as early as possible; what delays do; plans for the rest."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.spec.making import CROSSED, RING, TURNING, plan_of, solution_of

import carp_reference
from carp_reference.execution import (
    Delay,
    executed,
    in_order,
    late_robots,
    on_the_clock,
    order_of,
    planned,
    retime,
    slack,
    smallest_collision,
    solution_at,
    stuck,
)
from carp_spec import Carp, Instance, Plan, Refusal, Solution, Visit, check, check_update, judge
from carp_spec.dependencies import Node
from carp_spec.execution_rules import is_acyclic, trace_violations
from carp_spec.traces import Trace
from carproof.strategies import PlannedInstance, Sizes, planned_instances

SIZES = Sizes(resources=4, robots=4)
SMALL = Sizes(resources=3, robots=3)
AHEAD = (("b", 0, 1), ("c", 1, 2))


@st.composite
def delayed(draw: st.DrawFn, sizes: Sizes = SIZES) -> tuple[Instance, Solution, tuple[Delay, ...]]:
    """A solution and delays of some visits that are no robot's last."""
    case = draw(planned_instances(sizes))
    places = [(plan.robot, place) for plan in case.solution.plans for place in range(len(plan.visits) - 1)]
    chosen = draw(st.lists(st.sampled_from(places), max_size=4, unique=True)) if places else []
    return case.instance, case.solution, tuple(Delay(*node, draw(st.integers(1, 4))) for node in chosen)


@settings(max_examples=draws(300))
@given(delayed())
def test_an_execution_in_order_is_safe_ends_and_is_late_by_no_more_than_all_delays(
    case: tuple[Instance, Solution, tuple[Delay, ...]],
) -> None:
    instance, solution, delays = case
    order = order_of(instance, solution)
    enters = in_order(order, delays)
    trace = executed(order, enters, delays)
    followed = {violation.rule for violation in trace_violations(instance, solution, trace)}
    assert followed <= {"trace/robots"} if stuck(order) else not followed
    assert bool(stuck(order)) == bool(list(is_acyclic(instance, solution)))
    total = sum(delay.ticks for delay in delays)
    assert all(tick <= order.visit(node).enter + total for node, tick in enters.items())
    if not stuck(order):
        assert len(enters) == len(order.nodes)
        assert not {each.rule for each in check(instance, trace.plans)} & {"joint/capacity", "joint/exchange"}


@settings(max_examples=draws(200))
@given(delayed(), st.data())
def test_a_delay_as_long_as_the_slack_makes_nobody_late_and_a_longer_one_does(
    case: tuple[Instance, Solution, tuple[Delay, ...]], data: st.DataObject
) -> None:
    instance, solution, _ = case
    order = order_of(instance, solution)
    if order.nodes:
        node = data.draw(st.sampled_from(order.nodes))
        spare = slack(order)[node]
        assert not late_robots(order, [Delay(*node, 99 if spare is None else spare)])
        assert spare is None or late_robots(order, [Delay(*node, spare + 1)])


def sets_of_delays(nodes: Sequence[Node], most: int) -> Iterator[tuple[Delay, ...]]:
    """All delays of some visits with at most that sum, by sum and number."""
    found: list[tuple[Delay, ...]] = [()]
    for count in (1, 2, 3):
        for chosen in combinations(nodes, count):
            found += [
                tuple(Delay(*node, tick) for node, tick in zip(chosen, ticks, strict=True))
                for ticks in product(range(1, most + 1), repeat=count)
                if sum(ticks) <= most
            ]
    yield from sorted(found, key=lambda delays: (sum(delay.ticks for delay in delays), len(delays)))


def collides(instance: Instance, solution: Solution, delays: Sequence[Delay]) -> bool:
    order = order_of(instance, solution)
    trace = executed(order, on_the_clock(order, delays), delays)
    return bool({each.rule for each in check(instance, trace.plans)} & {"joint/capacity", "joint/exchange"})


@settings(max_examples=draws(100), deadline=None)
@given(planned_instances(SMALL))
def test_no_smaller_set_of_delays_makes_robots_on_the_clock_collide(case: PlannedInstance) -> None:
    smallest = smallest_collision(case.instance, case.solution)
    nodes = order_of(case.instance, case.solution).nodes
    most = 3 if smallest is None else min(3, sum(delay.ticks for delay in smallest))
    first = next((each for each in sets_of_delays(nodes, most) if collides(case.instance, case.solution, each)), None)
    if smallest is not None:
        assert collides(case.instance, case.solution, smallest)
    if first is not None:
        assert smallest is not None
        worth = [(sum(each.ticks for each in delays), len(delays)) for delays in (smallest, first)]
        assert worth[0] == worth[1]


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


def test_robots_in_a_circle_never_move_and_robots_behind_them_neither() -> None:
    instance, solution = Instance(RING, TURNING[0]), solution_of(TURNING[1])
    order = order_of(instance, solution)
    assert in_order(order, ()).keys() == {("r1", 0), ("r2", 0), ("r3", 0)}
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


def test_a_retimed_fleet_is_under_way_for_queries() -> None:
    instance, solution = CROSSED
    order = order_of(instance, solution)
    delays = [Delay("r1", 0, 3)]
    after = retime(instance, solution, executed(order, in_order(order, delays), delays, 3))
    assert carp_reference.query(instance, after.plans, "r2", 3) is not None
    assert carp_reference.plan(instance, Carp()) == solution
