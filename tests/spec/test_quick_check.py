"""The quick check of many plans says that they break no rule only if the rules say so, and says it of most."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from tests.spec.making import PARKED, PARKING, SOLVED, VANISHING, instance_on, line, plan_of
from tests.spec.strategies import SIZES, instances_with_plans

import carp_optimized
import carp_reference
from carp_spec import Carp, Group, Instance, Plan, Robot, Visit, judge, quick_check, violations_of
from carp_spec.execution.logs import judge_log
from carp_spec.execution.traces import Trace
from carp_spec.model import Following, Resource, ResourceGraph
from carp_spec.quick_check import LATEST, breaks_no_rule, is_large
from carproof.execution.delays import until
from carproof.generate import Fleet, Grid, grid_instance, with_headings
from carproof.testing.mutations import MUTATIONS
from carproof.testing.strategies import PlannedInstance, broken_solutions, instances, planned_instances
from carproof.testing.vectors import vectors


def test_no_broken_vector_passes() -> None:
    passed = 0
    for case in vectors():
        if case.op == "check" and case.id.startswith(("plan-", "joint-")):
            instance, solution = case.read_instance(), case.read_solution()
            plans = [plan for plan in solution.plans if plan.robot in instance.robot]
            if breaks_no_rule(instance, plans):
                assert not violations_of(instance, plans), case.id
                passed += 1
    assert passed > 20


@given(instances_with_plans())
def test_what_passes_breaks_no_rule(case: tuple[Instance, tuple[Plan, ...]]) -> None:
    instance, plans = case
    assert not breaks_no_rule(instance, plans) or not violations_of(instance, plans)


@given(instances(SIZES), st.sampled_from(["allowed", "forbidden"]))
def test_right_plans_pass_and_no_mutant_does(drawn: Instance, following: Following) -> None:
    instance = replace(drawn, following=following)
    solution = carp_reference.plan(instance, Carp())
    if not solution.plans:
        return
    is_sure = not instance.graph.groups or following == "allowed"
    assert breaks_no_rule(instance, solution.plans) or not is_sure
    for mutation in MUTATIONS:
        for mutant in mutation(instance, solution):
            known = [plan for plan in mutant.solution.plans if plan.robot in mutant.instance.robot]
            assert not breaks_no_rule(mutant.instance, known) or not violations_of(mutant.instance, known)


def test_right_plans_of_robots_that_turn_pass() -> None:
    instance = with_headings(grid_instance(Grid(width=6, height=6), Fleet(robots=8)))
    assert breaks_no_rule(instance, carp_reference.plan(instance, Carp()).plans)


def test_a_right_move_within_two_groups_passes() -> None:
    graph = replace(line("ab"), groups=(Group("g", ("a", "b"), 1), Group("h", ("a", "b"), 1)))
    instance = instance_on(graph, Robot("r", "a", "b"))
    assert breaks_no_rule(instance, (plan_of("r", ("a", 0, 1), ("b", 1, 2)),))


@pytest.mark.parametrize(("instance", "plans"), [(VANISHING, SOLVED), (PARKING, PARKED)])
def test_ticks_that_arrays_do_not_hold_are_left_to_the_rules(instance: Instance, plans: tuple[Plan, ...]) -> None:
    assert breaks_no_rule(instance, plans)
    for tick in (LATEST, 2**63, 2**64, -1):
        last = structs.replace(plans[0].visits[-1], leave=tick)
        assert not breaks_no_rule(instance, (replace(plans[0], visits=(*plans[0].visits[:-1], last)), *plans[1:]))


def test_moves_at_late_ticks_on_a_large_graph_are_left_to_the_rules() -> None:
    """Their numbers do not fit into 64 bits."""
    tick = LATEST - 10
    instance = instance_on(ResourceGraph(tuple(map(Resource, range(70_000))), ((0, 1),)), Robot("r", 0, 1))
    plans = [plan_of("r", (0, 0, tick), (1, tick, tick + 1))]
    assert not breaks_no_rule(instance, plans)
    assert not violations_of(instance, plans)


@pytest.mark.parametrize(
    ("instance", "plans", "now"),
    [
        pytest.param(
            instance_on(line("abc"), Robot("r", "a", "b"), Robot("s", "c", "b"), after_goal="park"),
            (
                plan_of("r", ("a", 0, LATEST), ("b", LATEST, None)),
                plan_of("s", ("c", 0, LATEST + 1), ("b", LATEST + 1, None)),
            ),
            None,
            id="two that park in one place",
        ),
        pytest.param(
            instance_on(line("ab"), Robot("r", "a", "b"), Robot("s", "a", "b")),
            (plan_of("r", ("a", 0, None)), plan_of("s", ("a", 0, None))),
            2 * LATEST,
            id="two in one place until now",
        ),
        pytest.param(
            instance_on(line("ab", a=2**40), Robot("r", "a", "b", pace=2**40), after_goal="park"),
            (plan_of("r", ("a", 0, 1), ("b", 1, None)),),
            None,
            id="a stay that is too short",
        ),
    ],
)
def test_what_is_wrong_at_ticks_that_arrays_do_not_hold_does_not_pass(
    instance: Instance, plans: tuple[Plan, ...], now: int | None
) -> None:
    assert not breaks_no_rule(instance, plans, now)


def test_more_ways_between_areas_at_a_tick_than_the_limit_are_left_to_the_rules(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One move from a resource in two groups of capacity 1 to one in none: three ways."""
    graph = ResourceGraph(
        (Resource("a"), Resource("b")), (("a", "b"),), groups=(Group("g", ("a",)), Group("h", ("a",)))
    )
    plans = [plan_of("r", ("a", 0, 1), ("b", 1, 2))]
    for most, passes in ((3, True), (2, False)):
        monkeypatch.setattr(quick_check, "MOST_WAYS", most)
        assert breaks_no_rule(Instance(graph, (Robot("r", "a", "b"),)), plans) == passes


def test_an_exchange_with_a_group_does_not_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = ResourceGraph(
        (Resource("a"), Resource("b"), Resource("c", 2), Resource("d", 2)),
        (("a", "c"), ("a", "d"), ("b", "c"), ("c", "d")),
        groups=(Group("g", ("a", "c")),),
    )
    instance = instance_on(graph, Robot("r", "a", "d"), Robot("s", "d", "a"), after_goal="park")
    plans = plan_of("r", ("a", 0, 1), ("c", 1, 2), ("d", 2, None)), plan_of("s", ("d", 0, 2), ("a", 2, None))
    assert [each.rule for each in violations_of(instance, plans)] == ["joint/exchange"]
    for most in (quick_check.MOST_WAYS, 5, 4):  # 4 ways at each of two ticks
        monkeypatch.setattr(quick_check, "MOST_WAYS", most)
        assert not breaks_no_rule(instance, plans)


@given(instances_with_plans(), st.integers(1, 9))
def test_what_passes_part_by_part_passes_as_a_whole(case: tuple[Instance, tuple[Plan, ...]], most: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(quick_check, "MOST_WAYS", most)
        passes = breaks_no_rule(*case)
    assert breaks_no_rule(*case) or not passes


@given(planned_instances(), st.integers(0, 20))
def test_right_logs_pass_while_all_robots_are_there(planned: PlannedInstance, now: int) -> None:
    plans = [plan for plan in until(Trace(now, planned.solution.plans), now).plans if plan.visits]
    all_there = all(plan.visits[-1].leave is None for plan in plans)
    assert breaks_no_rule(planned.instance, plans, now) == bool(plans and all_there)


def test_robots_that_meet_at_the_tick_of_the_log_do_not_pass() -> None:
    instance = instance_on(line("ab"), Robot("r", "a", "b"), Robot("s", "b", "a"))
    plans = plan_of("r", ("a", 0, 1), ("b", 1, None)), plan_of("s", ("b", 0, None))
    assert not breaks_no_rule(instance, plans, 1)


def test_the_checker_words_the_violation_in_many_plans() -> None:
    instance = grid_instance(Grid(width=150, height=150), Fleet(robots=250))
    solution = carp_optimized.plan(instance, Carp())
    assert is_large(solution.plans)
    assert judge(instance, solution).valid
    seen = until(Trace(99, solution.plans), 99)
    assert judge_log(instance, seen).valid
    first = solution.plans[0]
    late = tuple(Visit(each.resource, each.enter + 1, each.leave and each.leave + 1) for each in first.visits)
    wrong = replace(solution, plans=(replace(first, visits=late), *solution.plans[1:]))
    assert "plan/start" in {each.rule for each in judge(instance, wrong).violations}
    moved = replace(seen, plans=(replace(seen.plans[0], visits=seen.plans[1].visits), *seen.plans[1:]))
    assert {"plan/start", "joint/capacity"} <= {each.rule for each in judge_log(instance, moved).violations}


@given(broken_solutions(), st.integers(0, 20))
def test_a_log_has_the_same_verdict_by_arrays_and_by_the_rules(planned: PlannedInstance, now: int) -> None:
    log = until(Trace(now, planned.solution.plans), now)
    by_rules = judge_log(planned.instance, log)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carp_spec.quick_check.MANY", 0)
        assert judge_log(planned.instance, log) == by_rules
