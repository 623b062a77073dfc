from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import given, settings
from tests.profiles import draws

from carp_optimum.deadline import TimeOver
from carp_optimum.gap import best_order, gap
from carp_optimum.optimum import optimum
from carp_reference import query
from carp_spec import Carp, Instance, Neighbourhood, Plan, Refusal, Resource, ResourceGraph, Robot, total_cost
from carp_verify.bound.rules import ContradictionError
from carproof.testing.strategies import Sizes, instances

SECONDS = 60
SMALL_FLEET = Sizes(resources=5, robots=4, capacity=2, duration=2, release=2, pace=2)
ROOM = ResourceGraph(tuple(map(Resource, range(5))), ((0, 1), (1, 2), (1, 3), (2, 4)))


def order_total(instance: Instance, order: tuple[Robot, ...]) -> int | None:
    """Plan in the order, and nothing clever."""
    plans: list[Plan] = []
    for robot in order:
        plan = query(instance, plans, robot.id)
        if plan is None:
            return None
        plans.append(plan)
    return total_cost(instance, plans)


@settings(max_examples=draws(250))
@given(instances(SMALL_FLEET))
def test_the_best_order_is_the_least_of_all(instance: Instance) -> None:
    totals = [order_total(instance, order) for order in permutations(instance.robots)]
    least = min((total for total in totals if total is not None), default=None)
    assert best_order(instance, SECONDS) == least
    assert best_order(instance, SECONDS, floor=least or 0) == least


@settings(max_examples=draws(150))
@given(instances(SMALL_FLEET, least_robots=2))
def test_no_order_and_no_planner_beats_the_optimum(instance: Instance) -> None:
    measured = gap(instance, [Carp(), Neighbourhood(m=2)], SECONDS)
    assert measured.optimum.decided
    for reached in measured.planners:
        if not reached.unplanned:
            assert measured.optimum.cost is not None
            assert reached.total >= measured.optimum.cost
    if measured.best_order is not None:
        assert measured.optimum.cost is not None
        assert measured.best_order >= measured.optimum.cost


def test_the_orders_of_many_robots_are_not_all_tried() -> None:
    robots = tuple(Robot(i, i % 5, i % 5, release=i) for i in range(10))
    instance = Instance(ROOM, robots)
    assert gap(instance, [], SECONDS).best_order is None
    with pytest.raises(Refusal, match="at most 9, the limit"):
        best_order(instance, SECONDS)


def test_a_search_for_the_best_order_keeps_its_limit() -> None:
    with pytest.raises(TimeOver):
        best_order(Instance(ROOM, (Robot("a", 0, 4),)), 0)
    assert gap(Instance(ROOM, (Robot("a", 0, 4),)), [Carp()], 0).best_order is None


def test_plans_that_cost_less_than_a_lower_bound_are_a_contradiction(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = Instance(ROOM, (Robot("a", 0, 4),))
    too_much = replace(optimum(instance, SECONDS), lower=4)
    monkeypatch.setattr("carp_optimum.gap.optimum", lambda *_: too_much)
    with pytest.raises(ContradictionError, match="plans that break no rule cost 3, less than the lower bound 4"):
        gap(instance, [Carp()], SECONDS)
