"""The CARP query and its naive twin agree: in the tick of arrival, and in that there is no plan."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.enumeration import ASKED, PATTERNS, Pattern, small_cases
from tests.profiles import rest_in
from tests.twin import find_plan_by_ticks

from carp_reference import query
from carp_spec import Instance, Plan, RobotId, check_update, plan_cost, violations_of
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

SMALL_CASES_OF_A_PATTERN = 52_198
RICHEST = 3
SIZES = Sizes(groups=2)
WITH_STOPS = Sizes(stops=3, service=5, groups=2)


def arrivals_of_both(
    instance: Instance, committed: tuple[Plan, ...], robot: RobotId, now: int
) -> tuple[int | None, int | None]:
    """The costs that both find, after a look at whether their plans are sound."""
    before = [plan for plan in committed if plan.robot == robot]
    others = [plan for plan in committed if plan.robot != robot]
    by_windows = query(instance, committed, robot, now)
    by_ticks = find_plan_by_ticks(instance, others, robot, now, before[0] if before else None)
    for plan in (by_windows, by_ticks):
        if plan is not None:
            assert not violations_of(instance, (*others, plan))
            assert not check_update(before, [plan], now)
    return (
        None if by_windows is None else plan_cost(instance, by_windows),
        None if by_ticks is None else plan_cost(instance, by_ticks),
    )


@given(fleets_under_way(SIZES) | fleets_under_way(WITH_STOPS))
def test_a_new_robot_arrives_as_early_by_windows_as_by_ticks(fleet: FleetUnderWay) -> None:
    for now in (0, fleet.now):
        by_windows, by_ticks = arrivals_of_both(fleet.instance, fleet.solution.plans, fleet.robot, now)
        assert by_windows == by_ticks


@given(fleets_under_way(SIZES) | fleets_under_way(WITH_STOPS), st.data())
def test_a_robot_under_way_arrives_as_early_by_windows_as_by_ticks(fleet: FleetUnderWay, data: st.DataObject) -> None:
    if fleet.solution.order:
        robot = data.draw(st.sampled_from(fleet.solution.order))
        by_windows, by_ticks = arrivals_of_both(fleet.instance, fleet.solution.plans, robot, fleet.now)
        assert by_windows == by_ticks
        assert by_windows is not None, "the plan that it follows is one"


@given(fleets_under_way(SIZES) | fleets_under_way(WITH_STOPS), st.data())
def test_a_robot_replanned_against_other_plans_arrives_as_early_by_windows_as_by_ticks(
    fleet: FleetUnderWay, data: st.DataObject
) -> None:
    """The others are replanned at the same tick one by one, so that they may contradict what the robot has done."""
    committed = fleet.solution.plans
    for robot in data.draw(st.permutations(fleet.solution.order)):
        dropped = data.draw(st.sampled_from([None, *fleet.solution.order]))
        some = tuple(plan for plan in committed if plan.robot not in {dropped} - {robot})
        by_windows, by_ticks = arrivals_of_both(fleet.instance, some, robot, fleet.now)
        assert by_windows == by_ticks
        replanned = query(fleet.instance, some, robot, fleet.now)
        if replanned is not None:
            committed = tuple(replanned if plan.robot == robot else plan for plan in committed)


@pytest.mark.ci
@pytest.mark.parametrize(
    "pattern", rest_in("nightly", PATTERNS, RICHEST), ids=lambda pattern: f"durations {pattern.durations}"
)
def test_the_twins_agree_on_every_small_query(pattern: Pattern) -> None:
    """Connected graphs of up to 4 resources, two robots committed, both policies: 208,792 queries in four patterns."""
    cases = 0
    for case in small_cases(pattern):
        cases += 1
        by_windows = query(case.instance, case.committed, ASKED)
        by_ticks = find_plan_by_ticks(case.instance, case.committed, ASKED)
        if by_windows is None or by_ticks is None:
            assert by_windows == by_ticks, case
        else:
            assert plan_cost(case.instance, by_windows) == plan_cost(case.instance, by_ticks), case
    assert cases == SMALL_CASES_OF_A_PATTERN
