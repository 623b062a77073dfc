import pytest
from tests.spec.making import row

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_verify.joint_search import least_total_cost


def test_one_robot_costs_the_durations_on_its_way() -> None:
    assert least_total_cost(Instance(row(2, 3, 1), (Robot("a", 0, 2, release=4, pace=2),))) == 10


def test_nobody_costs_nothing() -> None:
    assert least_total_cost(Instance(row(1), ())) == 0


def test_a_robot_at_its_goal_costs_nothing() -> None:
    assert least_total_cost(Instance(row(2, 1), (Robot("a", 0, 0, release=1),))) == 0


def test_two_robots_face_to_face_in_a_lane_have_no_plans_whatever_the_capacities() -> None:
    robots = (Robot("a", 0, 1), Robot("b", 1, 0))
    assert least_total_cost(Instance(row(1, 1), robots)) is None
    assert least_total_cost(Instance(row(1, 1, capacity=1), robots, "park")) is None


def test_with_room_for_two_they_pass_one_tick_later() -> None:
    robots = (Robot("a", 0, 1), Robot("b", 1, 0))
    assert least_total_cost(Instance(row(1, 1, capacity=2), robots)) == 3


def test_a_parked_robot_lets_another_one_pass_only_before_it_parks() -> None:
    robots = (Robot("a", 0, 1), Robot("b", 0, 2, release=1))
    assert least_total_cost(Instance(row(1, 1, 1), robots, "vanish")) == 3
    assert least_total_cost(Instance(row(1, 1, 1), robots, "park")) is None


def test_a_robot_may_pass_its_goal_and_come_back() -> None:
    graph = ResourceGraph(tuple(Resource(i) for i in range(4)), ((0, 1), (1, 2), (1, 3)))
    robots = (Robot("a", 0, 1), Robot("b", 0, 2, release=1))
    assert least_total_cost(Instance(graph, robots, "park")) == 3 + 2


def test_robots_released_into_one_place_have_no_plans() -> None:
    assert least_total_cost(Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 0, 1)))) is None


def test_a_search_too_large_is_refused_with_the_limit_named() -> None:
    with pytest.raises(Refusal, match="at most 2, the limit"):
        least_total_cost(Instance(row(1, 1, 1), (Robot("a", 0, 2), Robot("b", 2, 0))), most=2)


def test_a_robot_stays_at_its_goal_for_as_long_as_that_takes() -> None:
    robots = (Robot("a", 1, 1), Robot("b", 0, 1))
    for duration in (1, 2, 3, 4):
        assert least_total_cost(Instance(row(1, duration), robots)) == duration


def test_an_instance_that_forbids_following_is_refused() -> None:
    with pytest.raises(Refusal, match="following"):
        least_total_cost(Instance(row(1), (), "vanish", "forbidden"))
