"""Properties of the neighbourhood planner on every instance."""

from itertools import permutations
from unittest.mock import patch

from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws

import carp_reference
from carp_reference import neighbourhood
from carp_reference.problem import prepare
from carp_reference.query import find_plan
from carp_spec import (
    Carp,
    Instance,
    Neighbourhood,
    Plan,
    check_update,
    has_ended,
    judge,
    neighbourhood_rules,
    total_cost,
    violations_of,
)
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way, instances

CROWDED = Sizes(resources=6, robots=5, duration=2)

OPTIONS = st.builds(
    Neighbourhood,
    m=st.integers(1, 4),
    sample=st.none() | st.integers(1, 7),
    seed=st.integers(0, 2**64 - 1),
    baseline=st.booleans(),
    fallback=st.none() | st.integers(1, 3),
)


@settings(max_examples=draws(500))
@given(fleets_under_way(CROWDED), OPTIONS)
def test_adding_a_robot_breaks_no_rule_and_keeps_history(fleet: FleetUnderWay, options: Neighbourhood) -> None:
    instance, before = fleet.instance, fleet.solution
    after = carp_reference.add(instance, before, fleet.robot, fleet.now, options)
    assert judge(instance, after).valid
    assert not check_update(before.plans, after.plans, fleet.now)
    assert set(after.order) - {fleet.robot} == set(before.order)
    if fleet.robot in after.unplanned:
        assert after == before
    kept = carp_reference.query(instance, before.plans, fleet.robot, fleet.now)
    if options.baseline and kept is not None:
        assert total_cost(instance, after.plans) <= total_cost(instance, (*before.plans, kept))


@settings(max_examples=draws(300))
@given(instances(CROWDED), st.integers(2, 4))
def test_replanning_from_scratch_equals_keeping_the_prefix_in_paper_mode(instance: Instance, m: int) -> None:
    paper = Neighbourhood(m=m, baseline=False)
    with patch.object(neighbourhood_rules, "replanned_from", lambda taken, planned: 0 * (taken + planned)):
        from_scratch = carp_reference.plan(instance, paper)
    assert carp_reference.plan(instance, paper) == from_scratch


@settings(max_examples=draws(300))
@given(instances(CROWDED))
def test_every_plan_is_the_query_against_those_before_it(instance: Instance) -> None:
    for planner in (Carp(), Neighbourhood(m=3), Neighbourhood(m=3, baseline=False)):
        solution = carp_reference.plan(instance, planner)
        for position, plan in enumerate(solution.plans):
            assert plan == carp_reference.query(instance, solution.plans[:position], plan.robot)


@settings(max_examples=draws(300))
@given(instances(CROWDED), st.data())
def test_sharing_the_beginnings_of_orders_changes_no_plan(instance: Instance, data: st.DataObject) -> None:
    members = [robot.id for robot in instance.robots][:3]
    drawn = data.draw(st.sets(st.sampled_from([*permutations(range(len(members)))]), min_size=1))
    orders = [order for order in sorted(drawn) if order]
    problem = prepare(instance, 0)
    one_by_one: list[tuple[Plan, ...]] = []
    for order in orders:
        plans: list[Plan] = []
        for member in order:
            plan = find_plan(problem, plans, members[member])
            plans.extend([] if plan is None else [plan])
        if len(plans) == len(members):
            one_by_one.append(tuple(plans))
    shared = neighbourhood._plans_of_orders(problem, (), members, orders)
    assert [*shared] == one_by_one


@settings(max_examples=draws(300))
@given(fleets_under_way(CROWDED), OPTIONS)
def test_a_plan_that_has_ended_is_left_alone(fleet: FleetUnderWay, options: Neighbourhood) -> None:
    after = carp_reference.add(fleet.instance, fleet.solution, fleet.robot, fleet.now, options)
    assert not violations_of(fleet.instance, after.plans)
    ended = [plan for plan in fleet.solution.plans if has_ended(plan, fleet.now)]
    assert [plan for plan in ended if plan not in after.plans] == []
