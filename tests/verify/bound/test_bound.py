"""Lower bounds by prices: plans that break no rule pay no more than the prices collect, and cost no less."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import count, product
from random import Random

import msgspec
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.spec.making import instance_on, line, row
from tests.verify.bound.examples import (
    HORIZON,
    SCALE,
    certificates,
    completed,
    crossing,
    left,
    payment,
    plans_of,
    priced,
)
from tests.verify.bound.plain_search import least_cost_of
from tests.verify.optimum.tiny import TINY

from carp_optimum.bound import Progress, lower_bound
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.model import AfterGoal, Group
from carp_spec.plan_rules import plan_cost
from carp_verify.bound.rules import LARGEST_TABLE
from carp_verify.bound.tariff import Fees, Tariff
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.joint_search import least_total_cost
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import PlannedInstance, Sizes, instances, planned_instances


@settings(max_examples=draws(300))
@given(
    st.data(),
    instances(Sizes(resources=3, robots=1, capacity=1, duration=3, release=3, pace=1, groups=2), least_robots=1),
)
def test_the_least_cost_is_that_of_the_cheapest_of_all_plans(data: st.DataObject, instance: Instance) -> None:
    """Without fees, and with fees for who keeps a deadline or is seen in a place on its way."""
    certificate = data.draw(certificates(instance))
    (robot,) = instance.robots
    ticks, prices = st.integers(0, HORIZON - 1), st.integers(0, 4 * SCALE)
    arrivals = data.draw(st.lists(st.tuples(ticks, prices), max_size=3))
    sights = data.draw(
        st.lists(st.tuples(ticks, st.sets(st.sampled_from([*instance.graph.index])), prices), max_size=4)
    )
    plans = [*plans_of(instance, robot)]
    costs = [SCALE * plan_cost(instance, plan) + payment(instance, certificate, plan) for plan in plans]
    assert certificate.robots == ((robot.id, min(costs, default=None)),)
    for at, plan in enumerate(plans):
        costs[at] += sum(price for tick, price in arrivals if plan.visits[-1].enter <= tick)
        costs[at] += sum(
            price
            for tick, counted, price in sights
            if any(visit.resource in counted and visit.enter <= tick < left(visit) for visit in plan.visits[:-1])
        )
    fees = Fees([*arrivals, *((0, 0) for _ in sights)], sights)
    assert least_cost_of(Tariff(instance, certificate), robot, SCALE, fees) == min(costs, default=None)


@settings(max_examples=draws(100))
@given(st.data(), instances(Sizes(resources=5, robots=2, duration=2, release=3, pace=2, groups=2), least_robots=1))
def test_a_claim_is_judged_alike_with_shortcuts_and_without(data: st.DataObject, instance: Instance) -> None:
    tariff = Tariff(instance, data.draw(certificates(instance)))
    times = st.integers(0, HORIZON)
    places = st.sets(st.sampled_from(list(instance.graph.index)))
    arrivals = data.draw(st.lists(st.tuples(times, st.integers(0, 9)), max_size=2))
    sights = data.draw(st.lists(st.tuples(times, places, st.integers(0, 9)), max_size=2))
    for robot in instance.robots:
        least_cost_of(
            tariff, robot, data.draw(st.integers(0, SCALE)), Fees([*arrivals, *((0, 0) for _ in sights)], sights)
        )


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_where_many_ways_meet_a_claim_is_judged_alike_with_shortcuts_and_without(after_goal: AfterGoal) -> None:
    for seed in range(20):
        random = Random(seed)  # noqa: S311 - no secret
        instance = grid_instance(Grid(3, 3), Fleet(robots=2, seed=seed, after_goal=after_goal))
        cells = [cell for cell in product(instance.graph.index, range(HORIZON)) if random.random() < 0.6]
        prices = tuple((*cell, random.randrange(9)) for cell in cells)
        tariff = Tariff(instance, priced(instance, resources=prices))
        for robot in instance.robots:
            least_cost_of(tariff, robot, random.randrange(SCALE + 1), Fees())


@pytest.mark.parametrize("durations", [*product((1, 6), repeat=4)])
def test_a_part_of_a_tick_more_than_the_only_way_takes_is_refused(durations: Sequence[int]) -> None:
    robots = (Robot("there", 0, 3), Robot("back", 3, 0, pace=2))
    lane = Instance(row(*durations), robots, after_goal="vanish")
    most = sum(durations[:3]), 2 * sum(durations[1:])
    claims = tuple((robot.id, SCALE * cost) for robot, cost in zip(robots, most, strict=True))
    certificate = priced(lane, bound=sum(most), horizon=0, robots=claims)
    assert verify_bound(lane, certificate) == sum(most)
    for robot in range(2):
        forged = tuple((name, claim + (robot == place)) for place, (name, claim) in enumerate(claims))
        with pytest.raises(Refusal, match="can have no more than"):
            verify_bound(lane, msgspec.structs.replace(certificate, bound=sum(most) + 1, robots=forged))


@settings(max_examples=draws(300))
@given(st.data(), planned_instances(Sizes(resources=4, robots=4, release=2, wait=1, groups=2)))
def test_whatever_the_prices_sound_plans_pay_no_more_than_they_are_worth_and_cost_no_less_than_the_least(
    data: st.DataObject, planned: PlannedInstance
) -> None:
    instance, plans = planned.instance, planned.solution.plans
    certificate = data.draw(certificates(instance))
    verify_bound(instance, certificate)
    least = dict(certificate.robots)
    for plan in plans:
        own = least[plan.robot]
        assert own is not None
        assert own <= SCALE * plan_cost(instance, plan) + payment(instance, certificate, plan)
    assert sum(payment(instance, certificate, plan) for plan in plans) <= Tariff(instance, certificate).worth


@settings(max_examples=draws(80))
@given(instances(replace(TINY, groups=2), least_robots=2))
def test_a_bound_that_was_found_is_verified_and_at_most_the_optimum(instance: Instance) -> None:
    seen: list[Progress] = []
    certificate = lower_bound(instance, steps=600, on_step=seen.append)
    assert verify_bound(instance, certificate) == certificate.bound
    event(f"seen: {any(deadlines.seen for deadlines in certificate.deadlines)}")
    if not certificate.cuts:
        assert completed(instance, certificate) == certificate
    assert certificate.bound >= seen[0].bound
    best = least_total_cost(instance)
    if best is not None:
        assert certificate.bound <= best


def test_prices_find_what_the_shortest_paths_miss() -> None:
    seen: list[Progress] = []
    certificate = lower_bound(crossing(), steps=500, on_step=seen.append)
    assert (seen[0].bound, certificate.bound, least_total_cost(crossing())) == (6, 11, 11)


def test_prices_of_groups_find_what_those_of_resources_miss() -> None:
    lanes = tuple((f"a{lane}", f"b{lane}", f"c{lane}") for lane in range(3))
    edges = tuple(move for a, b, c in lanes for move in ((a, b), (b, c)))
    cells = tuple(Resource(cell) for lane in lanes for cell in lane)
    block = Group("block", tuple(b for _, b, _ in lanes))
    robots = tuple(Robot(f"r{number}", a, c) for number, (a, _, c) in enumerate(lanes))
    instance = Instance(ResourceGraph(cells, edges, groups=(block,)), robots)
    certificate = lower_bound(instance, steps=400)
    assert len(certificate.groups) > 0
    assert (certificate.bound, least_total_cost(instance)) == (9, 9)
    assert verify_bound(instance, certificate) == 9
    without = completed(instance, msgspec.structs.replace(certificate, groups=()))
    assert without.bound == 6


LANE = Instance(replace(line("ab"), groups=(Group("block", ("a", "b"), 2),)), (Robot("robot", "a", "b"),))


def test_a_price_of_a_group_is_worth_as_much_as_all_robots_in_it_pay() -> None:
    claim = priced(LANE, scale=1, robots=(("robot", 1 + 3),), groups=(("block", 0, 3),))
    assert verify_bound(LANE, msgspec.structs.replace(claim, bound=-2)) == -2
    with pytest.raises(Refusal, match="the bound must be -2"):
        verify_bound(LANE, msgspec.structs.replace(claim, bound=3))


@pytest.mark.parametrize(
    ("prices", "rule"),
    [
        ((("block", 0, -1),), "bound/price"),
        ((("block", 6, 1),), "bound/price"),
        ((("a", 0, 1),), "bound/price"),
        ((("block", 0, 1), ("block", 0, 1)), "bound/once"),
    ],
)
def test_wrong_prices_of_groups_are_refused(prices: tuple[tuple[str, int, int], ...], rule: str) -> None:
    with pytest.raises(Refusal) as refused:
        verify_bound(LANE, priced(LANE, robots=(("robot", 0),), groups=prices))
    assert (refused.value.rule, refused.value.path) == (rule, f"$.groups[{len(prices) - 1}]")


def test_prices_of_groups_for_too_many_resources_are_refused_before_they_are_looked_at() -> None:
    cells = tuple(Resource(cell) for cell in range(1000))
    instance = Instance(ResourceGraph(cells, (), groups=(Group("block", tuple(range(1000))),)), (Robot("robot", 0, 0),))
    prices = (("block", -1, -1),) * (LARGEST_TABLE // 1000 + 1)
    with pytest.raises(Refusal) as refused:
        Tariff(instance, priced(instance, groups=prices))
    assert (refused.value.rule, refused.value.path) == ("bound/size", "$.groups")


def test_prices_end_early_where_ticks_are_many_and_the_bound_holds_all_the_same() -> None:
    lane = instance_on(line("ab"), Robot("r", "a", "b", release=10**8), Robot("s", "b", "a", release=10**8))
    certificate = lower_bound(lane, steps=30)
    assert certificate.horizon == 20_000
    assert verify_bound(lane, certificate) == certificate.bound >= 2


def test_a_robot_in_a_resource_pays_its_price_once_and_all_at_most_price_times_capacity() -> None:
    for value, most, enter, leave, tick in product(range(3), (1, 2), range(3), range(1, 4), range(3)):
        graph = ResourceGraph((Resource("r", capacity=most), Resource("s")), ())
        instance = Instance(graph, (Robot("robot", "r", "s"),))
        tariff = Tariff(instance, priced(instance, resources=(("r", tick, value),)))
        assert tariff.stay("r", enter, leave) == (value if enter <= tick < leave else 0) or leave <= enter
        assert tariff.worth == value * most


def test_who_leaves_r_for_s_at_the_tick_comes_from_there_or_stays_in_r_pays_for_the_exchange_once() -> None:
    graph = ResourceGraph((Resource("r"), Resource("s"), Resource("q")), (("r", "s"), ("r", "q")))
    instance = Instance(graph, (Robot("robot", "r", "s"),))
    tariff = Tariff(instance, priced(instance, exchanges=(("r", "s", 2, 1),)))
    for source, target, tick in product("rsq", "rsq", range(4)):
        assert tariff.move(source, target, tick) == ((source, target, tick) in {("r", "s", 2), ("s", "r", 2)})
    for resource, enter, leave in product("rs", range(4), range(5)):
        assert tariff.stay(resource, enter, leave) == (resource == "r" and enter < 2 < leave)


def test_the_clock_is_looked_at_within_a_step_and_what_is_found_by_then_is_a_bound() -> None:
    instance = grid_instance(Grid(12, 12), Fleet(robots=140, seed=1, after_goal="park"))
    certificate = lower_bound(instance, seconds=10**6, steps=20, clock=(looks := count()).__next__)
    assert next(looks) > 20 * 140 / 32
    assert verify_bound(instance, certificate) == certificate.bound
    for seconds in range(10, 50, 3):
        ticks = count(step=10**9)
        certificate = lower_bound(instance, seconds=seconds, clock=ticks.__next__)
        assert next(ticks) // 10**9 <= seconds + 12
        assert verify_bound(instance, certificate) == certificate.bound


def test_robots_that_meet_beside_one_without_a_way_have_a_bound() -> None:
    graph = ResourceGraph((Resource("here"), Resource("there")), ())
    robots = (Robot("lost", "here", "there"), Robot("one", "there", "there"), Robot("other", "there", "there"))
    certificate = lower_bound(Instance(graph, robots), steps=600)
    assert verify_bound(Instance(graph, robots), certificate) == certificate.bound
    assert dict(certificate.robots)["lost"] is None
