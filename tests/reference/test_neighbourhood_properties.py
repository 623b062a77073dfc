"""Properties of the neighbourhood planner on every instance."""

from unittest.mock import patch

from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws

import carp_reference
from carp_spec import Carp, Instance, Neighbourhood, check_update, judge, neighbourhood_rules, total_cost
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
