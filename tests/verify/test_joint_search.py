import pytest
from tests.spec.making import row

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.model import Following
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


def test_a_search_too_large_is_refused_with_the_limit_named() -> None:
    with pytest.raises(Refusal, match="at most 2, the limit"):
        least_total_cost(Instance(row(1, 1, 1), (Robot("a", 0, 2), Robot("b", 2, 0))), most=2)


@pytest.mark.parametrize(("following", "least"), [("allowed", 3), ("forbidden", 4)])
def test_robots_that_may_not_follow_leave_a_free_tick(following: Following, least: int) -> None:
    robots = (Robot("ahead", 1, 2), Robot("behind", 0, 2))
    assert least_total_cost(Instance(row(1, 1, 1), robots, following=following)) == least
