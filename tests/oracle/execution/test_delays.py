"""Delays: executions in the planned order are safe, alive and as early as possible; those on the clock collide."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product

from tests.profiles import draws

from carp_reference import plan
from carp_reference.execution import order_of
from carp_spec import Carp, Instance, Solution, violations_of
from carp_spec.execution.dependencies import Node
from carp_spec.execution.execution_rules import is_acyclic, trace_violations
from carp_spec.permutations import splitmix64
from carproof import Delay
from carproof.execution.delays import executed, in_order, late_robots, on_the_clock, slack, smallest_collision, stuck
from carproof.testing.random_instances import Draw, Mix, draw_instance

MIX = Mix(
    sizes=(3, 4, 5),
    robots=(2, 3),
    capacities=(1, 1, 2),
    durations=(1, 1, 2),
    paces=(1,),
    groups=(1, 2),
    followings=("allowed", "allowed", "forbidden"),
)
COLLISIONS = {"joint/capacity", "joint/group", "joint/exchange"}
TOGETHER = {*COLLISIONS, "joint/following"}


def few_robots(count: int) -> Iterator[tuple[Instance, Solution]]:
    """Robots that CARP plans where resources and groups overlap."""
    for number in range(count):
        instance = draw_instance(Draw(splitmix64(number)), MIX)
        solution = plan(instance, Carp())
        if len(solution.plans) > 1:
            yield instance, solution


def test_an_execution_in_order_is_safe_ends_and_is_late_by_no_more_than_all_delays() -> None:
    for number, (instance, solution) in enumerate(few_robots(draws(10_000))):
        draw = Draw(splitmix64(number))
        order = order_of(instance, solution)
        nodes = [node for node in order.nodes if order.visit(node).leave is not None]
        delays = tuple(Delay(*node, draw.between(1, 4)) for node in nodes if draw.happens(3))
        enters = in_order(order, delays)
        trace = executed(order, enters, delays)
        followed = {violation.rule for violation in trace_violations(instance, solution, trace)}
        assert followed <= {"trace/robots"} if stuck(order) else not followed
        assert bool(stuck(order)) == bool(list(is_acyclic(instance, solution)))
        total = sum(delay.ticks for delay in delays)
        assert all(tick <= order.visit(node).enter + total for node, tick in enters.items())
        if not stuck(order):
            assert len(enters) == len(order.nodes)
            assert not {each.rule for each in violations_of(instance, trace.plans)} & TOGETHER


def test_a_delay_as_long_as_the_slack_makes_nobody_late_and_a_longer_one_does() -> None:
    for instance, solution in few_robots(draws(5000)):
        order = order_of(instance, solution)
        for node in order.nodes:
            spare = slack(order)[node]
            assert not late_robots(order, [Delay(*node, 99 if spare is None else spare)])
            assert spare is None or late_robots(order, [Delay(*node, spare + 1)])


def sets_of_delays(nodes: Sequence[Node], most: int) -> Iterator[tuple[Delay, ...]]:
    """All delays of some visits with at most that sum, by sum and number."""
    found: list[tuple[Delay, ...]] = [()]
    for count in (1, 2, 3):
        for chosen in combinations(nodes, count):
            found += [
                tuple(Delay(*node, tick) for node, tick in zip(chosen, ticks, strict=True))
                for ticks in product(range(1, most + 1), repeat=count)
                if sum(ticks) <= most
            ]
    yield from sorted(found, key=lambda delays: (sum(delay.ticks for delay in delays), len(delays)))


def collides(instance: Instance, solution: Solution, delays: Sequence[Delay]) -> bool:
    order = order_of(instance, solution)
    trace = executed(order, on_the_clock(order, delays), delays)
    return bool({each.rule for each in violations_of(instance, trace.plans)} & COLLISIONS)


def test_no_smaller_set_of_delays_makes_robots_on_the_clock_collide() -> None:
    for instance, solution in few_robots(draws(9000)):
        smallest = smallest_collision(instance, solution)
        nodes = order_of(instance, solution).nodes
        most = 3 if smallest is None else min(3, sum(delay.ticks for delay in smallest))
        first = next((each for each in sets_of_delays(nodes, most) if collides(instance, solution, each)), None)
        if smallest is not None:
            assert collides(instance, solution, smallest)
        if first is not None:
            assert smallest is not None
            worth = [(sum(each.ticks for each in delays), len(delays)) for delays in (smallest, first)]
            assert worth[0] == worth[1]
