"""The rules of an execution once more, pair by pair, and what follows from them, on drawn solutions and traces."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise, product

import networkx as nx
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import structs
from tests.profiles import draws
from tests.spec.making import is_before
from tests.spec.naive import close, crowds, places_of

import carp_reference
from carp_spec import Carp, Instance, Plan, Solution, Visit, violations_of
from carp_spec.execution.dependencies import Stay, dependencies, shortest_cycle, stays_by_constraint
from carp_spec.execution.execution_rules import is_acyclic, trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.joint_rules import following_is_avoided
from carproof.testing.strategies import PlannedInstance, Sizes, instances, planned_instances

SIZES = Sizes(resources=4, robots=4, groups=2, stops=3, service=4)


@st.composite
def followed(draw: st.DrawFn) -> tuple[Instance, Solution, Trace]:
    """A solution and what robots have done of it, each for itself: most are somewhat late, some keep no rule at all."""
    instance = draw(instances(SIZES))
    if draw(st.booleans()):
        instance = replace(instance, following="forbidden")
    solution = carp_reference.plan(instance, Carp())
    now = draw(st.integers(0, 12))
    odd = draw(st.integers(0, 4)) == 0
    late = st.sampled_from((0, 0, 0, 0, 1, 1, 2, *((-1,) if odd else ())))
    done = []
    for plan in solution.plans:
        visits, shift = [], draw(late)
        for visit in plan.visits:
            enter = visit.enter + shift
            shift += draw(late)
            if enter > now:
                break
            leave = None if visit.leave is None or visit.leave + shift > now else visit.leave + shift
            visits.append(Visit(visit.resource, enter, leave))
        done.append(Plan(plan.robot, tuple(visits)))
    if odd and done and draw(st.booleans()):
        done.pop()
    return instance, solution, Trace(now, tuple(done))


def broken(instance: Instance, solution: Solution, trace: Trace) -> set[str]:
    """The rules of execution that a trace breaks, pair by pair."""
    done = {(plan.robot, place): visit for plan in trace.plans for place, visit in enumerate(plan.visits)}
    rules = set()
    for (robot, _), visit in done.items():
        if visit.leave is not None and visit.leave < visit.enter + instance.duration(robot, visit.resource):
            rules.add("execution/duration")
    for one, other in pairs(instance, solution):
        left = done[one.last].leave if one.last in done else None
        if other.node in done:
            entered = done[other.node].enter
            if left is None or left + instance.gap > entered:
                rules.add("execution/order")
    moves = [(plan.robot, k, *pair) for plan in solution.plans for k, pair in enumerate(pairwise(plan.visits), 1)]
    for (first, k, at, to), (second, j, away, back) in product(moves, moves):
        is_opposite = close(instance, at.resource, back.resource) and close(instance, to.resource, away.resource)
        is_due = to.enter < back.enter and is_opposite and (second, j) in done
        if is_due and ((first, k) not in done or done[first, k].enter >= done[second, j].enter):
            rules.add("execution/exchange")
    return rules


def pairs(instance: Instance, solution: Solution) -> Iterator[tuple[Stay, Stay]]:
    for stays in stays_by_constraint(instance.graph, solution.plans).values():
        yield from ((one, other) for one, other in product(stays, stays) if is_before(instance, one.visit, other.visit))


@settings(max_examples=draws(400))
@given(followed())
def test_a_trace_breaks_the_rules_spelt_out_pair_by_pair(case: tuple[Instance, Solution, Trace]) -> None:
    found = {violation.rule for violation in trace_violations(*case)}
    if not any(rule.startswith("trace/") for rule in found):
        exchanges = {"execution/exchange"}
        assert found - exchanges == broken(*case) - exchanges
        assert broken(*case) & exchanges <= found


@settings(max_examples=draws(200))
@given(followed(), st.data())
def test_a_trace_that_is_none_is_found_before_rules_of_execution(
    case: tuple[Instance, Solution, Trace], data: st.DataObject
) -> None:
    instance, solution, trace = case
    if not trace.plans or trace_violations(*case):
        return
    at = data.draw(st.integers(0, len(trace.plans) - 1))
    plan = trace.plans[at]
    wrong = {
        "trace/robots": (*trace.plans, plan),
        "trace/prefix": (*trace.plans[:at], replace(plan, visits=(Visit("nowhere", 0, None),)), *trace.plans[at + 1 :]),
    }
    for rule, plans in wrong.items():
        assert {each.rule for each in trace_violations(instance, solution, Trace(trace.now, plans))} >= {rule}
    if plan.visits:
        gone = replace(plan, visits=(*plan.visits[:-1], structs.replace(plan.visits[-1], enter=trace.now + 1)))
        plans = (*trace.plans[:at], gone, *trace.plans[at + 1 :])
        assert {each.rule for each in trace_violations(instance, solution, Trace(trace.now, plans))} == {"trace/ticks"}


@settings(max_examples=draws(400))
@given(followed())
def test_what_has_happened_by_a_trace_that_follows_breaks_no_rule_of_robots_together(
    case: tuple[Instance, Solution, Trace],
) -> None:
    instance, _, trace = case
    if not trace_violations(*case):
        together = {violation.rule for violation in violations_of(instance, trace.plans)}
        assert not {rule for rule in together if rule.startswith("joint/")} - {"joint/exchange"}
        rotation_free = "joint/exchange" not in together
        assert rotation_free


@settings(max_examples=draws(400))
@given(planned_instances(SIZES))
def test_a_solution_has_a_cycle_if_its_edges_spelt_out_have_one(case: PlannedInstance) -> None:
    instance, plans = case.instance, case.solution.plans
    edges = nx.DiGraph([(edge.before, edge.after) for edge in dependencies(instance, plans)])
    for one, other in pairs(instance, case.solution):
        robot, place = one.last
        edges.add_edge((robot, place + 1) if one.target is not None else one.last, other.node)
    has_cycle = not nx.is_directed_acyclic_graph(edges)
    assert has_cycle == bool(list(is_acyclic(instance, case.solution)))
    assert has_cycle == bool(shortest_cycle(tuple(dependencies(instance, plans))))


@settings(max_examples=draws(400))
@given(planned_instances(SIZES))
def test_following_is_what_is_too_full_if_robots_count_a_tick_longer(case: PlannedInstance) -> None:
    graph = replace(case.instance.graph, groups=())  # naive checkers count groups
    forbidding = replace(case.instance, graph=graph, following="forbidden")
    longer = [
        replace(plan, visits=tuple(structs.replace(each, leave=each.leave and each.leave + 1) for each in plan.visits))
        for plan in case.solution.plans
    ]
    crowded = {resource for resource, _, _ in crowds(places_of(graph), longer)}
    assert {violation.resource for violation in following_is_avoided(forbidding, case.solution.plans)} == crowded
    assert not list(following_is_avoided(case.instance, case.solution.plans))
