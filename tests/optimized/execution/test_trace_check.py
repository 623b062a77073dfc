"""The quick check of traces says the same as the law, of traces that follow the plans and of others."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import pytest
from msgspec import structs

import carp_reference
from carp_optimized.execution import following as execution
from carp_optimized.execution import trace_check
from carp_optimized.execution.trace_check import follows
from carp_reference.execution import order_of
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.permutations import splitmix64
from carproof import Carp, Delay, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Trace, Visit
from carproof.conform.asking.smoke import committed, row
from carproof.execution.delays import executed, in_order, on_the_clock
from carproof.testing.random_instances import Draw, draw_fleet, draw_instance


def traced(number: int) -> tuple[Draw, Instance, Solution, Trace]:
    """A solution and a trace of it with delays, made by robots in order or on the clock."""
    draw = Draw(splitmix64(number))
    instance = draw_instance(draw)
    if draw.happens(3):
        instance = replace(instance, following="forbidden")
    solution = draw_fleet(draw, instance).solution if draw.happens(2) else carp_reference.plan(instance, Carp())
    order = order_of(instance, solution)
    visits = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits))]
    delays = [Delay(*node, draw.between(1, 3)) for node in visits if draw.happens(4)]
    enters = on_the_clock(order, delays) if draw.happens(3) else in_order(order, delays)
    return draw, instance, solution, executed(order, enters, delays, draw.between(0, 9))


def changed(draw: Draw, trace: Trace) -> Trace:
    """The trace with a tick moved, a visit lost or elsewhere, a robot lost or twice, or another tick now."""
    plans = list(trace.plans)
    kind = draw.between(0, 7)
    if kind == 0 or not plans:
        return replace(trace, now=max(0, trace.now + draw.between(-2, 1)))
    place = draw.between(0, len(plans) - 1)
    plan = plans[place]
    visits = list(plan.visits)
    if kind == 1:
        del plans[place]
    elif kind == 2:
        plans.insert(draw.between(0, len(plans)), plan)
    elif kind == 3:
        plans[place] = replace(plan, robot="nobody")
    elif visits:
        at = draw.between(0, len(visits) - 1)
        visit = visits[at]
        if kind == 4:
            visits[at] = structs.replace(visit, enter=visit.enter + draw.one_of([-2, -1, 1, 2]))
        elif kind == 5:
            visits[at] = structs.replace(
                visit, leave=draw.one_of([None, (visit.leave or trace.now) + draw.between(-2, 1)])
            )
        elif kind == 6:
            del visits[at]
        else:
            visits[at] = Visit("nowhere", visit.enter, visit.leave)
        plans[place] = replace(plan, visits=tuple(visits))
    return replace(trace, plans=tuple(plans))


def test_the_quick_check_says_what_the_law_says() -> None:
    found: Counter[str] = Counter()
    for number in range(700):
        draw, instance, solution, trace = traced(number)
        for each in (trace, *(changed(draw, trace) for _ in range(3))):
            broken = {violation.rule for violation in trace_violations(instance, solution, each)}
            assert follows(instance, solution, each) == (not broken), (number, broken)
            found.update(broken or {"follows"})
    rules = {"trace/robots", "trace/prefix", "trace/ticks"}
    rules |= {"execution/duration", "execution/order", "execution/exchange"}
    assert found.keys() == {"follows", *rules}
    assert found["follows"] > 500


def judged(instance: Instance, solution: Solution, done: Mapping[str, Sequence[tuple[str, int, int]]]) -> set[str]:
    """The rules of the law that a trace by tick 9 breaks, which the quick check must say too."""
    visits = {robot: tuple(Visit(*visit) for visit in each) for robot, each in done.items()}
    trace = Trace(9, tuple(Plan(robot, each) for robot, each in visits.items()))
    broken = {violation.rule for violation in trace_violations(instance, solution, trace)}
    assert follows(instance, solution, trace) == (not broken)
    return broken


def test_an_exchange_where_two_have_room_is_found() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b", 2)), (("a", "b"),))
    instance = Instance(graph, (Robot("r", "a", "b"), Robot("s", "b", "a")), "vanish")
    solution = committed(instance, r=[("a", 0, 1), ("b", 1, 2)], s=[("b", 0, 2), ("a", 2, 3)])
    behind = [("b", 0, 2), ("a", 2, 3)]
    assert judged(instance, solution, {"r": [("a", 0, 2), ("b", 2, 3)], "s": behind}) == {"execution/exchange"}
    assert not judged(instance, solution, {"r": [("a", 0, 1), ("b", 1, 2)], "s": behind})


def test_a_free_tick_is_kept_where_following_is_forbidden() -> None:
    free = row([Robot("r", "b", "c"), Robot("s", "a", "b")])
    instance = replace(free, following="forbidden")
    solution = committed(instance, r=[("b", 0, 1), ("c", 1, 2)], s=[("a", 0, 2), ("b", 2, 3)])
    done = {"r": [("b", 0, 2), ("c", 2, 3)], "s": [("a", 0, 2), ("b", 2, 3)]}
    assert judged(instance, solution, done) == {"execution/order"}
    assert not judged(free, solution, done)


def test_a_robot_that_appears_comes_from_nowhere() -> None:
    instance = row([Robot("r", "a", "b"), Robot("s", "c", "b", 4), Robot("t", "a", "a", 2)])
    plans = {"r": [("a", 0, 1), ("b", 1, 2)], "s": [("c", 4, 5), ("b", 5, 6)], "t": [("a", 2, 3)]}
    solution = committed(instance, **plans)
    assert not judged(instance, solution, {**plans, "r": [("a", 0, 2), ("b", 2, 3)]})


def test_ticks_beyond_the_arrays_are_left_to_the_law() -> None:
    _, instance, solution, trace = next(each for each in map(traced, range(99)) if each[3].plans[0].visits)
    assert not follows(instance, solution, replace(trace, now=2**40))
    late = replace(trace.plans[0], visits=(structs.replace(trace.plans[0].visits[0], enter=10**30),))
    assert not follows(instance, solution, replace(trace, plans=(late, *trace.plans[1:])))


def test_where_the_quick_check_finds_a_breach_the_law_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(60):
        draw, instance, solution, trace = traced(number)
        for each in (trace, changed(draw, trace)):
            expected = outcome(instance, solution, each)
            monkeypatch.setattr(execution, "follows", lambda *_: False)
            assert outcome(instance, solution, each) == expected
            monkeypatch.setattr(execution, "follows", trace_check.follows)


def outcome(instance: Instance, solution: Solution, trace: Trace) -> tuple[Plan, ...] | str:
    """The plans of retime, or its refusal."""
    try:
        return execution.retime(instance, solution, trace).plans
    except Refusal as refusal:
        return str(refusal)
