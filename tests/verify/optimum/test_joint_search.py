from dataclasses import replace

import pytest
from tests.spec.making import row

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.model import Following, Group, Stop
from carp_verify.optimum.joint_search import least_total_cost

APART = (Robot("a", 0, 1), Robot("b", 1, 0))
PASSING = (Robot("a", 0, 1), Robot("b", 0, 2, release=1))
BAY = ResourceGraph(tuple(map(Resource, range(4))), ((0, 1), (1, 2), (1, 3)))


@pytest.mark.parametrize(
    ("instance", "least"),
    [
        pytest.param(Instance(row(2, 3, 1), (Robot("a", 0, 2, release=4, pace=2),)), 10, id="the durations on the way"),
        pytest.param(Instance(row(1), ()), 0, id="nobody"),
        pytest.param(Instance(row(2, 1), (Robot("a", 0, 0, release=1),)), 0, id="a robot at its goal"),
        pytest.param(Instance(row(1, 1), APART), None, id="face to face"),
        pytest.param(Instance(row(1, 1), APART, "park"), None, id="face to face, parking"),
        pytest.param(Instance(row(1, 1, capacity=2), APART), 3, id="with room for two they pass a tick later"),
        pytest.param(Instance(row(1, 1, 1), PASSING), 3, id="past a robot that vanishes"),
        pytest.param(Instance(row(1, 1, 1), PASSING, "park"), None, id="not past a parked robot"),
        pytest.param(Instance(BAY, PASSING, "park"), 3 + 2, id="a robot passes its goal and comes back"),
        pytest.param(Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 0, 1))), None, id="released into one place"),
        *(
            pytest.param(Instance(row(1, duration), (Robot("a", 1, 1), Robot("b", 0, 1))), duration, id=f"{duration}")
            for duration in (1, 2, 3, 4)
        ),
    ],
)
def test_the_least_total_is_that_of_plans_that_break_no_rule(instance: Instance, least: int | None) -> None:
    assert least_total_cost(instance) == least


def order(*stops: tuple[int, int], start: int = 0) -> Robot:
    return Robot("a", start, stops=tuple(Stop(*stop) for stop in stops))


@pytest.mark.parametrize(
    ("instance", "least"),
    [
        pytest.param(Instance(row(1, 1, 1), (order((1, 3), (2, 0)),)), 4, id="on the way"),
        pytest.param(Instance(row(1, 1, 1), (order((2, 2), (0, 0)),)), 5, id="beyond the goal"),
        pytest.param(Instance(row(1, 1), (order((0, 2), (1, 0)),)), 2, id="at the start"),
        pytest.param(Instance(row(1, 1, 1), (order((2, 1), (1, 3), (0, 0)),)), 6, id="in order, not in passing"),
        pytest.param(Instance(row(1, 1, 1), (order((0, 1), (2, 0), start=2),)), 4, id="there and nowhere else"),
        pytest.param(Instance(row(1, 3, 1), (order((1, 2), (2, 0)),)), 4, id="no longer than the duration"),
        pytest.param(Instance(row(1, 1, 1), (order((1, 4), start=1), Robot("b", 0, 2))), 5, id="at the goal"),
    ],
)
def test_a_stop_is_served_for_its_time(instance: Instance, least: int) -> None:
    assert least_total_cost(instance) == least


@pytest.mark.parametrize(("capacity", "least"), [(1, None), (2, 2)])
def test_robots_exchange_groups_of_two_and_not_of_one(capacity: int, least: int | None) -> None:
    groups = (Group("left", (0, 3), capacity), Group("right", (1, 2), capacity))
    lanes = ResourceGraph(tuple(map(Resource, range(4))), ((0, 1), (2, 3)), groups=groups)
    assert least_total_cost(Instance(lanes, (Robot("a", 0, 1), Robot("b", 2, 3)))) == least


@pytest.mark.parametrize(("capacity", "least"), [(1, 9), (2, 7)])
def test_robots_pass_in_a_group_of_two_and_not_of_one(capacity: int, least: int) -> None:
    graph = replace(row(1, 1, 1, 1, capacity=2), groups=(Group("between", (1, 2), capacity),))
    assert least_total_cost(Instance(graph, (Robot("a", 0, 3), Robot("b", 3, 0)))) == least


def test_a_search_too_large_is_refused_with_the_limit_named() -> None:
    with pytest.raises(Refusal, match="at most 2, the limit"):
        least_total_cost(Instance(row(1, 1, 1), (Robot("a", 0, 2), Robot("b", 2, 0))), most=2)


@pytest.mark.parametrize(("following", "least"), [("allowed", 3), ("forbidden", 4)])
def test_robots_that_may_not_follow_leave_a_free_tick(following: Following, least: int) -> None:
    robots = (Robot("ahead", 1, 2), Robot("behind", 0, 2))
    assert least_total_cost(Instance(row(1, 1, 1), robots, following=following)) == least
