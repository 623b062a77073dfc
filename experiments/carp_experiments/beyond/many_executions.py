"""Many executions of one solution at once: an array has a row for each visit and a column for each execution.

The rules are spelt out here once more, pair by pair of visits, and the campaign compares them with those of the law.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from carp_reference.execution import Order
from carp_spec.execution.dependencies import Node, stays_by_constraint
from carp_spec.limits import refuse
from carproof.execution.delays import Delay, is_last, waits_for_leaving

Longs: TypeAlias = npt.NDArray[np.int64]
Flags: TypeAlias = npt.NDArray[np.bool_]
FOR_EVER = 2**40
ONE_IN = 4
LONGEST = 6


def random_numbers(seed: int, count: int) -> npt.NDArray[np.uint64]:
    """The first numbers of `splitmix64(seed)`."""
    places = np.arange(1, count + 1, dtype=np.uint64)
    mixed = np.uint64(seed % 2**64) + places * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))


def random_delays(order: Order, seed: int, count: int, always: Node | None = None) -> Longs:
    """The ticks by which each visit but the last of a robot is longer; one visit is longer in any case, or `always`."""
    numbers = random_numbers(seed, (2 * len(order.nodes) + 1) * count).reshape(-1, count)
    chances, ticks, chosen = np.split(numbers % np.uint64(2**62), [len(order.nodes), -1])
    visits = np.flatnonzero([not is_last(order, node) for node in order.nodes])
    sure = np.full(count, order.nodes.index(always)) if always else visits[chosen[0] % np.uint64(visits.size)]
    delayed = np.zeros(chances.shape, np.bool_)
    delayed[visits] = chances[visits] % np.uint64(ONE_IN) == 0
    delayed[sure, np.arange(count)] = True
    return np.where(delayed, 1 + ticks % np.uint64(LONGEST), 0).astype(np.int64)


def delays_of(order: Order, column: Longs) -> tuple[Delay, ...]:
    """The delays of one execution."""
    return tuple(Delay(*node, ticks) for node, ticks in zip(order.nodes, column.tolist(), strict=True) if ticks)


def entered_in_order(order: Order, delays: Longs) -> Longs:
    """The entries of executions in order; the dependencies must have no cycle."""
    number = {node: place for place, node in enumerate(order.nodes)}
    releases = {(robot.id, 0): robot.release for robot in order.instance.robots}
    enters = np.repeat([[releases.get(node, 0)] for node in order.nodes], delays.shape[1], axis=1)
    for node in sorted_by_dependency(order):
        for edge in order.out_of.get(node, ()):
            before, after = number[node], number[edge.after]
            longer = delays[before] if waits_for_leaving(order, edge) else 0
            np.maximum(enters[after], enters[before] + edge.ticks + longer, out=enters[after])
    return enters


def sorted_by_dependency(order: Order) -> Sequence[Node]:
    """The visits, each behind those that it waits for."""
    missing = dict.fromkeys(order.nodes, 0)
    for edge in order.edges:
        missing[edge.after] += 1
    ready = [node for node in order.nodes if not missing[node]]
    for node in ready:
        for edge in order.out_of.get(node, ()):
            missing[edge.after] -= 1
            if not missing[edge.after]:
                ready.append(edge.after)
    return ready


def breaches(order: Order, enters: Longs) -> tuple[Flags, Flags]:
    """Which executions do not follow the solution (`execution/...`), and in which robots collide (`joint/...`)."""
    number = {node: place for place, node in enumerate(order.nodes)}
    ticks = {node: enters[place] for node, place in number.items()}
    leaves = {node: left(order, node, ticks) for node in order.nodes}
    strays, crashes = np.zeros(enters.shape[1], np.bool_), np.zeros(enters.shape[1], np.bool_)
    for node in order.nodes:
        strays |= leaves[node] - ticks[node] < order.duration(node)
    gap = order.instance.gap
    refuse(order.instance, "groups")
    for resource, stays in stays_by_constraint(order.instance.graph, order.solution.plans).items():
        crowd = {stay.node: np.ones(enters.shape[1], np.int64) for stay in stays}
        for one, other in permutations(stays, 2):
            leave, enter = leaves[one.node], ticks[other.node]
            planned = FOR_EVER if one.visit.leave is None else one.visit.leave
            is_opposite = one.target is not None and one.target == other.source
            if planned + gap <= other.visit.enter:
                strays |= leave + gap > enter
                if is_opposite and planned < other.visit.enter:
                    strays |= leave >= enter
            if one.node[0] != other.node[0]:
                crowd[other.node] += (ticks[one.node] <= enter) & (enter < leave + gap)
                if is_opposite:
                    crashes |= leave == enter
        for count in crowd.values():
            crashes |= count > order.instance.graph.resources[resource].capacity
    return strays, crashes


def left(order: Order, node: Node, enters: Mapping[Node, Longs]) -> Longs:
    """The ticks at which a visit is left; a last visit lasts for its duration, or for ever."""
    if not is_last(order, node):
        return enters[node[0], node[1] + 1]
    stays = order.visit(node).leave is None
    return enters[node] + (FOR_EVER if stays else order.duration(node))
