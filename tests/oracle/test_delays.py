"""Delays: executions in the planned order are safe, alive and as early as possible; those on the clock collide."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product

from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.spec.making import RING, TURNING, solution_of

from carp_reference.execution import order_of
from carp_spec import Instance, Solution, violations_of
from carp_spec.execution.dependencies import Node
from carp_spec.execution.execution_rules import is_acyclic, trace_violations
from carproof.execution.delays import (
    Delay,
    executed,
    in_order,
    late_robots,
    on_the_clock,
    slack,
    smallest_collision,
    stuck,
)
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

SIZES = Sizes(resources=4, robots=4)
SMALL = Sizes(resources=3, robots=3)


@st.composite
def delayed(draw: st.DrawFn, sizes: Sizes = SIZES) -> tuple[Instance, Solution, tuple[Delay, ...]]:
    """A solution and delays of some visits that are no robot's last."""
    case = draw(planned_instances(sizes))
    places = [(plan.robot, place) for plan in case.solution.plans for place in range(len(plan.visits) - 1)]
    chosen = draw(st.lists(st.sampled_from(places), max_size=4, unique=True)) if places else []
    return case.instance, case.solution, tuple(Delay(*node, draw(st.integers(1, 4))) for node in chosen)


@settings(max_examples=draws(300))
@given(delayed())
def test_an_execution_in_order_is_safe_ends_and_is_late_by_no_more_than_all_delays(
    case: tuple[Instance, Solution, tuple[Delay, ...]],
) -> None:
    instance, solution, delays = case
    order = order_of(instance, solution)
    enters = in_order(order, delays)
    trace = executed(order, enters, delays)
    followed = {violation.rule for violation in trace_violations(instance, solution, trace)}
    assert followed <= {"trace/robots"} if stuck(order) else not followed
    assert bool(stuck(order)) == bool(list(is_acyclic(instance, solution)))
    total = sum(delay.ticks for delay in delays)
    assert all(tick <= order.visit(node).enter + total for node, tick in enters.items())
    if not stuck(order):
        assert len(enters) == len(order.nodes)
        assert not {each.rule for each in violations_of(instance, trace.plans)} & {"joint/capacity", "joint/exchange"}


@settings(max_examples=draws(200))
@given(delayed(), st.data())
def test_a_delay_as_long_as_the_slack_makes_nobody_late_and_a_longer_one_does(
    case: tuple[Instance, Solution, tuple[Delay, ...]], data: st.DataObject
) -> None:
    instance, solution, _ = case
    order = order_of(instance, solution)
    if order.nodes:
        node = data.draw(st.sampled_from(order.nodes))
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
    return bool({each.rule for each in violations_of(instance, trace.plans)} & {"joint/capacity", "joint/exchange"})


@settings(max_examples=draws(100), deadline=None)
@given(planned_instances(SMALL))
def test_no_smaller_set_of_delays_makes_robots_on_the_clock_collide(case: PlannedInstance) -> None:
    smallest = smallest_collision(case.instance, case.solution)
    nodes = order_of(case.instance, case.solution).nodes
    most = 3 if smallest is None else min(3, sum(delay.ticks for delay in smallest))
    first = next((each for each in sets_of_delays(nodes, most) if collides(case.instance, case.solution, each)), None)
    if smallest is not None:
        assert collides(case.instance, case.solution, smallest)
    if first is not None:
        assert smallest is not None
        worth = [(sum(each.ticks for each in delays), len(delays)) for delays in (smallest, first)]
        assert worth[0] == worth[1]


def test_robots_in_a_circle_never_move_and_robots_behind_them_neither() -> None:
    instance, solution = Instance(RING, TURNING[0]), solution_of(TURNING[1])
    order = order_of(instance, solution)
    assert in_order(order, ()).keys() == {("r1", 0), ("r2", 0), ("r3", 0)}
