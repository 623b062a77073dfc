from collections.abc import Mapping

import pytest
from hypothesis import HealthCheck, assume, given, settings
from tests.profiles import draws
from tests.verify.test_optimum import turned_ring

from carp_optimum.sat import heuristics
from carp_optimum.sat.heuristics import plans_of_all
from carp_optimum.sat.solver import TimeOver
from carp_reference import plan
from carp_reference.problem import prepare
from carp_spec import (
    Carp,
    Instance,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    judge,
    total_cost,
)
from carp_verify.optimum.encoding import Encoding
from carproof.testing.strategies import Sizes, instances

SMALL = Sizes(resources=6, robots=4, capacity=2, duration=3, release=3, pace=2)


def never() -> None:
    """Let the search run as long as it likes."""


@pytest.fixture(params=["read", "run"])
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Plan with the reference, or with compiled code even where its first call has to compile."""
    if request.param == "read":
        monkeypatch.setattr(heuristics, "_run", lambda *_: None)
    else:
        monkeypatch.setattr("carp_optimized.jit.compiling.is_cached", lambda _: True)


def distances(instance: Instance) -> Mapping[RobotId, Mapping[ResourceId, int]]:
    return {robot: to_goal for robot, (to_goal,) in prepare(instance, 0).ticks_to_goal.items()}


def found(instance: Instance, enough: int = 0) -> tuple[Plan, ...] | None:
    return plans_of_all(
        instance,
        distances(instance),
        never,
        enough,
        attempts=30,
    )


@pytest.mark.usefixtures("engine")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(SMALL))
def test_the_plans_are_sound_and_of_all_robots(instance: Instance) -> None:
    plans = found(instance)
    if plans is not None:
        verdict = judge(instance, Solution(plans, tuple(each.robot for each in plans)))
        assert (verdict.violations, verdict.unplanned) == ((), 0)


@pytest.mark.usefixtures("engine")
@settings(max_examples=draws(100), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(instances(SMALL, least_robots=2))
def test_a_robot_that_found_no_plan_is_planned_earlier(instance: Instance) -> None:
    backwards = Instance(instance.graph, instance.robots[::-1], instance.after_goal)
    assume(len(instance.robots) == 2 and any(not plan(each, Carp()).unplanned for each in (instance, backwards)))
    assert found(instance) is not None


@settings(max_examples=draws(200))
@given(instances(SMALL))
def test_the_distances_of_the_encoding_are_those_of_the_planner(instance: Instance) -> None:
    ticks_to_goal = {robot.robot.id: robot.ticks_to_goal for robot in Encoding(instance).robots}
    assert ticks_to_goal == distances(instance)


@pytest.mark.usefixtures("engine")
def test_what_was_found_before_the_end_of_the_time_is_kept() -> None:
    instance = turned_ring(3)
    looks = 0

    def check() -> None:
        nonlocal looks
        looks += 1
        if looks > 240:
            raise TimeOver

    assert plans_of_all(instance, distances(instance), check) == found(instance)


@pytest.mark.usefixtures("engine")
def test_the_search_ends_where_the_plans_are_good_enough() -> None:
    instance = turned_ring(3)
    plans = found(instance)
    assert plans is not None
    looks = 0

    def check() -> None:
        nonlocal looks
        looks += 1

    enough = total_cost(instance, plans)
    assert plans_of_all(instance, distances(instance), check, enough) == plans
    assert looks <= 30 * len(instance.robots)


def test_numbers_that_the_arrays_do_not_hold_are_planned_by_the_reference() -> None:
    graph = ResourceGraph(
        (Resource("a", duration=2**29), Resource("b", duration=2**29), Resource("c")), (("a", "b"), ("b", "c"))
    )
    for release in (2**31, 0):
        instance = Instance(graph, (Robot("r", "a", "c", release), Robot("s", "b", "c")))
        assert found(instance) is not None
