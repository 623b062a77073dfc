"""Formulas made small by a lower bound hold an optimum, and nothing cheaper."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.verify.bound.examples import completed, priced
from tests.verify.optimum.models import model_of
from tests.verify.optimum.tiny import TINY, case

from carp_optimum.bound import lower_bound
from carp_optimum.lagrangian.reduced_costs import PricedBound, ReducedCosts
from carp_optimum.sat.core_guided import core_guided
from carp_optimum.sat.priced_formula import priced_formula
from carp_spec import AfterGoal, Instance, judge
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.proof import solution_of
from carproof import verify_bound
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import instances

SECONDS = 60
SCALE = 64


def cheapest(instance: Instance, bound: PricedBound, cost: int) -> int | None:
    """The total of the plans in a model of the formula, which must be lawful; `None` if it has no model."""
    encoding = priced_formula(instance, bound, cost, lambda: None).encoding
    model = model_of(encoding.formula)
    if model is None:
        return None
    plans = encoding.plans(model)
    verdict = judge(instance, solution_of(plans))
    assert (verdict.violations, verdict.unplanned) == ((), 0)
    return verdict.cost


@settings(max_examples=draws(300))
@given(instances(TINY, least_robots=1), st.sampled_from([0, 5, 60]))
def test_the_formula_holds_plans_from_the_optimum_on(instance: Instance, steps: int) -> None:
    least = least_total_cost(instance)
    if least is not None:
        bound = PricedBound(instance, lower_bound(instance, steps=steps))
        assert cheapest(instance, bound, least) == least
        assert cheapest(instance, bound, least - 1) is None
        later = cheapest(instance, bound, least + 2)
        assert later is not None
        assert least <= later <= least + 2


@pytest.mark.parametrize("number", range(200))
def test_the_formula_leaves_resources_free_behind_robots(number: int) -> None:
    instance = replace(case(number)[0], following="forbidden")
    least = least_total_cost(instance)
    if least is not None:
        bound = PricedBound(instance, lower_bound(instance, steps=0))
        assert cheapest(instance, bound, least) == least
        assert cheapest(instance, bound, least - 1) is None


def town(seed: int, after_goal: AfterGoal) -> Instance:
    """Nine robots that are in each other's way."""
    return grid_instance(Grid(5, 5, 10, map_seed=seed), Fleet(9, seed, after_goal))


@settings(max_examples=draws(1000))
@given(instances(TINY, least_robots=2), st.data())
def test_any_prices_leave_the_optimum_and_nothing_cheaper(instance: Instance, data: st.DataObject) -> None:
    least = least_total_cost(instance)
    if least is None:
        return
    resources = [resource.id for resource in instance.graph.resources]
    places = st.tuples(st.sampled_from(resources), st.integers(0, 5))
    prices = data.draw(st.dictionaries(places, st.integers(1, 2 * SCALE), max_size=6))
    certificate = completed(
        instance,
        priced(instance, horizon=6, scale=SCALE, resources=tuple((*at, price) for at, price in prices.items())),
    )
    assert verify_bound(instance, certificate) <= least
    bound = PricedBound(instance, certificate)
    assert cheapest(instance, bound, least) == least
    assert cheapest(instance, bound, least - 1) is None


@pytest.mark.parametrize(("seed", "after_goal"), [(7, "park"), (10, "vanish")])
@pytest.mark.parametrize("is_seen", [False, True])
def test_the_certificate_s_deadlines_count(
    seed: int, after_goal: AfterGoal, is_seen: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of robots that are seen have no clauses of their own, but a part of the nodes' reduced costs."""
    if not is_seen:
        monkeypatch.setattr("carp_optimum.claims.pair_search.LARGEST_ENCODING", 0)
    instance = town(seed, after_goal)
    least = core_guided(instance, SECONDS).cost
    assert least is not None
    certificate = lower_bound(instance, steps=1500)
    assert len(certificate.deadlines) > 1
    assert any(each.seen for each in certificate.deadlines) == is_seen
    assert verify_bound(instance, certificate) <= least
    bound = PricedBound(instance, certificate)
    assert -(-bound.parts // bound.scale) == certificate.bound
    encoding = Encoding(instance)
    shortest = {robot.robot.id: robot.shortest or 0 for robot in encoding.robots}
    for robot in encoding.robots:
        assert min(ReducedCosts(bound, robot, shortest, least + 6).delays.values()) == 0
    assert cheapest(instance, bound, least) == least
    assert cheapest(instance, bound, least - 1) is None
