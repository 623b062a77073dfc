"""Groups planned together lower the total, down to the optimum on small maps, and the law judges each plan set."""

from itertools import islice

import pytest
from hypothesis import assume, given, settings
from tests.optimum.test_branching import nothing
from tests.profiles import draws
from tests.verify.optimum.tiny import TINY

from carp_optimized import plan
from carp_optimized.improve.repair import repair
from carp_optimum.sat.core_guided import core_guided
from carp_optimum.sat.group_search import improved
from carp_spec import AfterGoal, Carp, Instance, Plan, Solution, judge
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import least_total_cost
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import instances

TRIES = 30
SECONDS = 60


def totals(instance: Instance, plans: tuple[Plan, ...]) -> list[int]:
    """The total after each try, of plans that break no rule."""
    found = []
    for _, each in islice(improved(instance, plans, nothing), TRIES):
        verdict = judge(instance, Solution(tuple(each), tuple(plan.robot for plan in each)))
        assert (verdict.violations, verdict.unplanned) == ((), 0)
        assert verdict.cost is not None
        found.append(verdict.cost)
    return found


@settings(max_examples=draws(200))
@given(instances(TINY, least_robots=2))
def test_a_group_of_all_robots_is_planned_best(instance: Instance) -> None:
    given = plan(instance, Carp())
    assume(not given.unplanned)
    found = totals(instance, given.plans)
    least = least_total_cost(instance)
    assert least is not None
    assert found == sorted(found, reverse=True)
    assert all(each >= least for each in found)
    late = judge(instance, given).cost != sum(robot.shortest or 0 for robot in Encoding(instance).robots)
    assert not late or found[-1] == least


@pytest.mark.parametrize(("robots", "seed", "after_goal"), [(12, 3, "park"), (16, 2, "vanish")])
def test_the_total_falls_to_the_optimum_where_groups_leave_robots_out(
    robots: int, seed: int, after_goal: AfterGoal
) -> None:
    instance = grid_instance(Grid(5, 5, 20), Fleet(robots, seed, after_goal))
    given = repair(instance, plan(instance, Carp()))
    assert not given.unplanned
    least = core_guided(instance, SECONDS).cost
    before = judge(instance, given).cost
    assert before is not None
    assert least is not None
    assert before > least
    assert totals(instance, given.plans)[-1] == least
