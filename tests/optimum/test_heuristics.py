"""Heuristics for the search for an optimum: plans of all robots that the law accepts, also where time is short."""

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, assume, given, settings
from tests.optimum.test_branching import nothing
from tests.profiles import draws
from tests.spec.making import grid, line
from tests.verify.optimum.test_optimum import turned_ring

from carp_optimum.deadline import Deadline, TimeOver, clock_of
from carp_optimum.sat.heuristics import ever_better, plans_of_all
from carp_reference import plan
from carp_spec import Carp, Instance, Robot, Solution, judge
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import Sizes, instances

SMALL = Sizes(resources=6, robots=4, capacity=2, duration=3, release=3, pace=2)


def forty_looks() -> Deadline:
    """The time until a clock was looked at forty times."""
    return Deadline(40, clock_of(nothing))


@pytest.fixture(params=[False, True], ids=["read", "run"])
def _engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Plan with the reference, or with compiled code even where its first call has to compile."""
    monkeypatch.setattr("carp_optimized.jit.compiling.is_cached", lambda _: request.param)


@pytest.mark.usefixtures("_engine")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(SMALL))
def test_the_plans_are_sound_and_of_all_robots(instance: Instance) -> None:
    plans = plans_of_all(instance, [*instance.robot], forty_looks())
    if plans is not None:
        verdict = judge(instance, Solution(tuple(plans), tuple(each.robot for each in plans)))
        assert (verdict.violations, verdict.unplanned) == ((), 0)


@pytest.mark.usefixtures("_engine")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(replace(SMALL, robots=2), least_robots=2))
def test_a_robot_that_found_no_plan_is_planned_earlier(instance: Instance) -> None:
    backwards = Instance(instance.graph, instance.robots[::-1], instance.after_goal)
    assume(any(not plan(each, Carp()).unplanned for each in (instance, backwards)))
    assert plans_of_all(instance, [*instance.robot], forty_looks()) is not None


@pytest.mark.usefixtures("_engine")
def test_there_is_nothing_to_find_where_the_time_is_over() -> None:
    instance = turned_ring(3)
    assert plans_of_all(instance, [*instance.robot], forty_looks()) is not None
    many = grid_instance(Grid(30, 30), Fleet(200))
    assert plans_of_all(many, [*many.robot], Deadline(0, clock_of(nothing))) is None


def test_numbers_that_the_arrays_do_not_hold_are_planned_by_the_reference() -> None:
    for release in (2**31, 0):
        instance = Instance(line("abc", a=2**29, b=2**29), (Robot("r", "a", "c", release), Robot("s", "b", "c")))
        assert plans_of_all(instance, [*instance.robot], forty_looks()) is not None


@pytest.mark.parametrize(("pace", "last"), [(1, 50), (2, 0)])
def test_annealings_look_at_the_clock(pace: int, last: int) -> None:
    """Robots that move a step a tick are planned as a crowd, others by CARP."""
    instance = Instance(grid(8, 8), tuple(Robot(str(k), f"{k},0", f"{7 - k},7", pace=pace) for k in range(8)))
    looks = 0

    def end() -> None:
        nonlocal looks
        looks += 1
        if looks > last:
            raise TimeOver

    with pytest.raises(TimeOver):
        next(ever_better(instance, end))
    work, plans = next(ever_better(instance, nothing))
    assert work > 0
    assert judge(instance, Solution(tuple(plans), tuple(each.robot for each in plans))).unplanned == 0
