"""Sums over all robots, in which those are added first that are likely in each other's way.

A solver learns about a few such robots at a time. Then one clause about their part of the sum says what it learned. In
the order of the instance it takes many clauses, one for each way in which their delays add up.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from carp_verify.optimum.clauses import Formula, Unary
from carp_verify.optimum.robot_clauses import Node

Group: TypeAlias = tuple[int, ...]


def groups_of_near(weights: Sequence[Mapping[Node, int]]) -> Sequence[Sequence[Group]]:
    """In rounds, the numbers to add: pairs, and one alone if they are odd, by their positions in the round before.

    `weights` has for each robot its nodes, and how much each one matters. Robots are near if nodes that matter for both
    are the same.
    """
    near = _nearness(weights)
    rounds = []
    while len(near) > 1:
        groups = _pairs_of_near(near)
        rounds.append(groups)
        members = np.zeros((len(groups), len(near)), np.int64)
        for number, group in enumerate(groups):
            members[number, list(group)] = 1
        near = members @ near @ members.T
    return rounds


def sum_of_near(formula: Formula, numbers: Sequence[Unary], rounds: Sequence[Sequence[Group]], most: int) -> Unary:
    """A unary number of up to `most` that is at least the sum of the robots' numbers, or at least `most`."""
    for groups in rounds:
        numbers = [formula.at_least([numbers[position] for position in group], most) for group in groups]
    return formula.at_least(numbers, most)


def _nearness(weights: Sequence[Mapping[Node, int]]) -> npt.NDArray[np.int64]:
    visitors: dict[Node, list[tuple[int, int]]] = defaultdict(list)
    for position, nodes in enumerate(weights):
        for node, weight in nodes.items():
            visitors[node].append((position, weight))
    near = np.zeros((len(weights), len(weights)), np.int64)
    for visits in visitors.values():
        positions, matters = np.array(visits, np.int64).T
        near[np.ix_(positions, positions)] += np.outer(matters, matters)
    return near


def _pairs_of_near(near: npt.NDArray[np.int64]) -> Sequence[Group]:
    """The nearest two, the nearest two of the others, and so on; who is left over comes last."""
    first, second = np.triu_indices(len(near), 1)
    pairs: list[Group] = []
    left = dict.fromkeys(range(len(near)))
    for pair in np.argsort(-near[first, second], kind="stable"):
        one, other = int(first[pair]), int(second[pair])
        if one in left and other in left:
            pairs.append((one, other))
            del left[one], left[other]
    return [*pairs, *((position,) for position in left)]
