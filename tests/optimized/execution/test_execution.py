"""The compiled dependency graph has the edges and the ticks of the readable one."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import pytest

import carp_reference
from carp_optimized import retime as compiled
from carp_optimized.execution.following import timetable
from carp_reference.execution import earliest as read_earliest
from carp_reference.execution import order_of, retime
from carp_spec.execution.dependencies import Node
from carp_spec.permutations import splitmix64
from carproof import Carp, Delay, Instance, Plan, Refusal, Solution, Trace
from carproof.execution.delays import executed, in_order, planned
from carproof.testing.random_instances import Draw, draw_instance

Engine: TypeAlias = Callable[[Instance, Solution, Trace], Solution]


def cases(count: int) -> list[tuple[Instance, Solution, Draw]]:
    found = []
    for number in range(count):
        draw = Draw(splitmix64(number))
        instance = replace(draw_instance(draw), following="forbidden" if number % 3 == 0 else "allowed")
        solution = carp_reference.plan(instance, Carp())
        if solution.plans:
            found.append((instance, solution, draw))
    return found


def numbers(solution: Solution) -> dict[Node, int]:
    """The visits as the timetable numbers them."""
    nodes = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits))]
    return {node: number for number, node in enumerate(nodes)}


def drawn_delays(solution: Solution, draw: Draw) -> list[Delay]:
    places = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits) - 1)]
    return [Delay(*node, draw.between(1, 4)) for node in places if draw.happens(3)]


def test_both_make_the_same_graph() -> None:
    for instance, solution, _ in cases(200):
        order, times, number = order_of(instance, solution), timetable(instance, solution), numbers(solution)
        edges = sorted((number[edge.before], number[edge.after], edge.ticks) for edge in order.edges)
        assert sorted(zip(times.before.tolist(), times.after.tolist(), times.ticks.tolist(), strict=True)) == edges


def test_both_propagate_late_visits_alike() -> None:
    for instance, solution, draw in cases(200):
        order, number = order_of(instance, solution), numbers(solution)
        late_by = {node: draw.between(1, 4) if draw.happens(6) else 0 for node in number}
        least = {node: tick + late_by[node] for node, tick in planned(order).items()}
        expected = read_earliest(order, least)
        found = timetable(instance, solution).times(np.array([least[node] for node in number], np.int64))
        assert found.tolist() == [expected[node] for node in number]


def answer(engine: Engine, instance: Instance, solution: Solution, trace: Trace) -> Solution | str:
    """The plans for the rest, or the reason why there are none."""
    try:
        return engine(instance, solution, trace)
    except Refusal as refusal:
        return str(refusal)


def test_both_retime_alike() -> None:
    kinds = Counter[type]()
    for instance, solution, draw in cases(200):
        order = order_of(instance, solution)
        delays = drawn_delays(solution, draw)
        trace = executed(order, in_order(order, delays), delays, draw.between(0, 6))
        after = answer(retime, instance, solution, trace)
        assert answer(compiled, instance, solution, trace) == after
        kinds[type(after)] += 1
    assert kinds[Solution] > 100
    assert kinds[str] > 0


def test_ticks_that_are_too_large_are_refused() -> None:
    instance, solution, _ = cases(1)[0]
    with pytest.raises(Refusal, match="limit/ticks"):
        compiled(instance, solution, Trace(2**30, tuple(Plan(plan.robot, ()) for plan in solution.plans)))
