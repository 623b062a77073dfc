"""Bounds over stops: what robots pay at least is that of a search tick by tick, and bounds hold and are verified."""

import tracemalloc
from collections.abc import Mapping
from dataclasses import replace
from heapq import heappop, heappush
from itertools import count

import msgspec
import pytest
from hypothesis import given
from tests.spec.making import row
from tests.verify.bound.examples import SCALE, priced
from tests.verify.bound.plain_search import least_cost_of
from tests.verify.optimum.tiny import STOPPING, case

from carp_optimum.bound import lower_bound
from carp_spec import Instance, Refusal, ResourceId, Robot
from carp_spec.documents.bounds import BoundDocument
from carp_spec.model import Stop
from carp_verify.bound.network import network_of, network_over
from carp_verify.bound.tariff import Fees, Tariff
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.joint_search import WAITS, State, _Search, least_total_cost
from carp_verify.routes import routes_of
from carproof.testing.random_instances import Draw
from carproof.testing.strategies import Sizes, instances

PARTS, SIZE = 4, 40
HORIZON = 14
LAST = 90  # no cheapest plan of a tiny robot is longer


@given(instances(Sizes(stops=3, service=3)))
def test_the_places_of_a_robot_with_several_stops_are_the_stages_of_its_formula(instance: Instance) -> None:
    for robot in instance.robots:
        if len(robot.stops) > 1:
            routes = routes_of(instance, robot, {})
            over, starts, there = network_over(network_of(instance), instance, robot)
            places = range(len(routes.stages))
            assert len(over.resource) == len(over.duration) == len(places)
            assert [over.resource[each] for each in places] == [routes.resource(each) for each in places]
            assert [over.duration[each] for each in places] == [routes.duration[each] for each in places]
            for mine, of_formula in ((over.successors, routes.successors), (over.predecessors, routes.predecessors)):
                assert [sorted(mine[each]) for each in places] == [
                    sorted(map(int, of_formula[each])) for each in places
                ]
            assert ([*starts], there) == ([*map(int, routes.starts)], int(routes.there))


def drawn_prices(instance: Instance, draw: Draw) -> BoundDocument:
    """Prices on some resources and exchanges, with robots and bound yet to be filled in."""
    graph = instance.graph
    ticks = range(HORIZON)
    resources = [(each, tick, draw.between(1, 9)) for each in graph.index for tick in ticks if draw.between(0, 2) == 0]
    both = sorted((move for move in graph.moves if move[::-1] in graph.moves), key=str)
    exchanges = [(*move, tick, draw.between(1, 9)) for move in both for tick in ticks if draw.between(0, 5) == 0]
    return priced(instance, horizon=HORIZON, resources=tuple(resources), exchanges=tuple(exchanges))


def least_by_ticks(instance: Instance, robot: Robot, prices: BoundDocument) -> int | None:
    """The least cost of the robot with its payments, by Dijkstra over its states tick by tick."""
    present = {(resource, tick): price for resource, tick, price in prices.resources}
    rows = {(source, target, tick): price for source, target, tick, price in prices.exchanges}
    search = _Search(replace(instance, robots=(robot,)))
    number = count()
    queue: list[tuple[int, int, int, State]] = [(0, next(number), -1, WAITS)]
    settled: set[tuple[int, State]] = set()
    while queue:
        paid, _, tick, state = heappop(queue)
        if (tick, state) in settled:
            continue
        settled.add((tick, state))
        if tick == LAST:
            if state.phase == "arrived":
                return paid
            continue
        for after in search.at(robot, tick + 1, state):
            cost = SCALE * (after.phase == "moves")
            cost += _payment(state, after, tick + 1, present, rows)
            heappush(queue, (paid + cost, next(number), tick + 1, after))
    return None


def _payment(
    before: State,
    after: State,
    tick: int,
    present: Mapping[tuple[ResourceId, int], int],
    rows: Mapping[tuple[ResourceId, ResourceId, int], int],
) -> int:
    """For being in a resource at the tick, and for staying in it or moving then."""
    here, there = before.resource, after.resource
    if there is None:
        return 0
    paid = present.get((there, tick), 0)
    if here == there:
        return paid + sum(price for (source, _, at), price in rows.items() if (source, at) == (there, tick))
    if here is not None:
        paid += rows.get((here, there, tick), 0) + rows.get((there, here, tick), 0)
    return paid


@pytest.mark.parametrize("part", range(PARTS))
def test_what_robots_pay_at_least_is_that_of_a_search_by_ticks(part: int) -> None:
    for number in range(part * SIZE, (part + 1) * SIZE):
        instance, draw = case(number, STOPPING)
        prices = drawn_prices(instance, draw)
        tariff = Tariff(instance, prices)
        least = [least_cost_of(tariff, robot, SCALE, Fees()) for robot in instance.robots]
        assert least == [least_by_ticks(instance, robot, prices) for robot in instance.robots], number
        if None not in least:
            parts = sum(each or 0 for each in least) - tariff.worth
            claims = tuple((robot.id, each) for robot, each in zip(instance.robots, least, strict=True))
            certificate = msgspec.structs.replace(prices, robots=claims, bound=-(-parts // SCALE))
            bound, best = verify_bound(instance, certificate), least_total_cost(instance)
            assert best is None or bound <= best
            too_much = tuple((robot, (each or 0) + 1) for robot, each in claims)
            with pytest.raises(Refusal, match="can have no more than"):
                verify_bound(instance, msgspec.structs.replace(certificate, robots=too_much))


@pytest.mark.parametrize("part", range(PARTS))
def test_bounds_that_are_searched_for_are_verified_and_hold(part: int) -> None:
    met = above = 0
    for number in range(part * SIZE, (part + 1) * SIZE):
        instance, _ = case(number, STOPPING)
        if all(robot.has_goal_alone for robot in instance.robots):
            continue
        certificate, best = lower_bound(instance, steps=20), least_total_cost(instance)
        assert verify_bound(instance, certificate) == certificate.bound
        assert best is None or certificate.bound <= best
        met += certificate.bound == best
        above += len(certificate.cuts) > 0
    assert met > SIZE // 3
    assert above > 0


def test_the_places_of_many_stops_are_not_made_before_they_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    many = 300
    back_and_forth = tuple(Stop(place) for place in (many - 1, 0) * (many // 2))
    lane = Instance(row(*(1,) * many), (Robot("r", 0, stops=back_and_forth),))
    certificate = priced(lane, robots=(("r", 0),))
    tracemalloc.start()
    assert verify_bound(lane, certificate) == 0
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < many * many * 50
    monkeypatch.setattr("carp_verify.bound.verify.LARGEST_TABLE", many * many - 1)
    with pytest.raises(Refusal, match=r"the table of a robot's stops by resources would be 90000, and at most 89999"):
        verify_bound(lane, certificate)
