"""Tiny instances, one for each number: for searches and encoders, beside the joint search that tries everything.

They are drawn without a test library, since drawing has to be cheaper than solving, and the same on every machine.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from carp_spec import AfterGoal, Instance, Move, Resource, ResourceGraph, Robot
from carp_spec.permutations import shuffle, splitmix64
from carp_verify.joint_search import joint_states
from carproof.strategies import Sizes

MOST_STATES = 15_000
TINY = Sizes(resources=4, robots=3, capacity=2, duration=2, release=2, pace=2)
"""The values that hypothesis draws where a test needs it to shrink."""


@dataclass(frozen=True, slots=True)
class Case:
    """An instance, and numbers with which to vary what is made of it."""

    instance: Instance
    chance: Iterator[int]


def case(number: int) -> Case:
    """The case of a number: the first instance of its stream with few enough joint states."""
    chance = splitmix64(number)
    instance = _instance(chance)
    while joint_states(instance) > MOST_STATES:
        instance = _instance(chance)
    return Case(instance, chance)


def _instance(chance: Iterator[int]) -> Instance:
    size = 3 + next(chance) % 3
    graph = _graph(chance, size)
    starts, goals = _ends(chance, size), _ends(chance, size)
    robots = tuple(
        Robot(id, starts[id], goals[id], release=_seldom(chance, 0, 4), pace=_seldom(chance, 1, 2))
        for id in range(min(size, 2 + next(chance) % 3))
    )
    after_goal: AfterGoal = "park" if next(chance) % 2 else "vanish"
    return Instance(graph, robots, after_goal)


def _graph(chance: Iterator[int], size: int) -> ResourceGraph:
    """A star, a line, a ring, or a tree with more edges; one in three directed, with some moves one way only."""
    resources = tuple(Resource(id, _seldom(chance, 1, 2), _seldom(chance, 1, 3)) for id in range(size))
    stems = range(1, size)
    shapes = [
        [(0, id) for id in stems],
        [(id - 1, id) for id in stems],
        [(0, size - 1), *((id - 1, id) for id in stems)],
        [(next(chance) % id, id) for id in stems],
    ]
    edges: list[Move] = [*shapes[next(chance) % len(shapes)]]
    edges += [edge for edge in combinations(range(size), 2) if next(chance) % 8 == 0 and edge not in edges]
    if next(chance) % 3:
        return ResourceGraph(resources, tuple(edges))
    moves: list[Move] = []
    for source, target in edges:
        there, back = (source, target), (target, source)
        moves += [(there, back), (there, back), (there, back), (there,)][next(chance) % 4]
    return ResourceGraph(resources, tuple(moves), directed=True)


def _ends(chance: Iterator[int], size: int) -> Sequence[int]:
    """Starts or goals: distinct, or one in four as they come."""
    if next(chance) % 4:
        return shuffle(range(size), chance)
    return [next(chance) % size for _ in range(size)]


def _seldom(chance: Iterator[int], least: int, most: int) -> int:
    """The least, or one time in three a number up to the most."""
    return least if next(chance) % 3 else least + next(chance) % (most - least + 1)
