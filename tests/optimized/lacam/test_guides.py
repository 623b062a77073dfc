"""Guides: ways along edges that are little longer than the shortest, and that meet few others."""

from collections import Counter
from itertools import pairwise

import numpy as np
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.crowd import Crowd, ways_of
from carp_optimized.jit.compiling import entry
from carp_optimized.jit.references import Native
from carp_optimized.lacam.guides import SLACK, Guides, find_guides, guides_at, guides_of, uses_of

ROBOTS = 40


@entry
def uses(native: Native[Guides], tick: int, what: int) -> int:
    return uses_of(guides_at(native), tick, what)


def way(guides: Guides, robot: int) -> list[int]:
    """The guide of the robot, place by place."""
    first = int(guides.first[robot])
    places: list[int] = guides.way[first : first + int(guides.size[robot])].tolist()
    return places


def targets(crowd: Crowd, place: int) -> list[int]:
    """Where edges lead to."""
    places: list[int] = crowd.target[crowd.first[place] : crowd.first[place + 1]].tolist()
    return places


def meetings(others: list[list[int]], tick: int, source: int, target: int) -> int:
    """How many others are in the target at the tick, come the other way, or are parked there."""
    found = 0
    for other in others:
        if tick < len(other):
            found += (other[tick] == target) + ((other[tick - 1], other[tick]) == (target, source))
        found += other[-1] == target and len(other) <= tick
    return found


def fewest(crowd: Crowd, others: list[list[int]], robot: int, slack: int) -> int:
    """The fewest meetings of any way without waits of at most that slack, which does not go through the goal."""
    goal = int(crowd.goal[robot])
    here = {int(crowd.start[robot]): 0}
    best = [0] if goal in here else []
    for tick in range(1, int(crowd.distance[robot][crowd.start[robot]]) + slack + 1):
        there = dict[int, int]()
        for place, met in here.items():
            for target in targets(crowd, place):
                meets = met + meetings(others, tick, place, target)
                there[target] = min(meets, there.get(target, meets))
        if goal in there:
            best.append(there.pop(goal))
        here = there
    return min(best)


def crowd_and_guides(seed: int) -> tuple[Crowd, Guides]:
    crowd = measured(on_grid(8, ROBOTS, "park", seed, map=seed))
    *_, guides = guides_of(crowd, lambda: True)
    return crowd, guides


def test_guides_lead_along_edges_from_start_to_goal_and_are_little_longer_than_the_shortest_way() -> None:
    for seed in range(5):
        crowd, guides = crowd_and_guides(seed)
        for robot in range(ROBOTS):
            places = way(guides, robot)
            assert (places[0], places[-1]) == (crowd.start[robot], crowd.goal[robot])
            assert all(target in targets(crowd, place) for place, target in pairwise(places))
            assert len(places) - 1 <= crowd.distance[robot][places[0]] + SLACK


def test_there_is_no_guide_where_the_distance_is_an_estimate_that_is_too_low() -> None:
    crowd = measured(on_grid(12, ROBOTS, "park"))
    ways = ways_of(crowd)
    crowd.distance[:] //= 4
    *_, guides = guides_of(crowd, lambda: True)
    sizes = {(ways[robot] - ways[robot] // 4 > SLACK, len(way(guides, robot)) > 0) for robot in range(ROBOTS)}
    assert sizes == {(True, False), (False, True)}


def test_uses_are_those_of_the_guides() -> None:
    crowd, guides = crowd_and_guides(0)
    native = Native(guides)
    ways = [way(guides, robot) for robot in range(ROBOTS)]
    of_places = Counter((tick, place) for places in ways for tick, place in enumerate(places))
    of_moves = Counter((k, *move) for places in ways for k, move in enumerate(pairwise(places), 1))
    resources = crowd.queue.size
    for tick in range(max(map(len, ways))):
        for place in range(resources):
            assert uses(native, tick, place) == of_places[tick, place]
            for edge in range(int(crowd.first[place]), int(crowd.first[place + 1])):
                assert uses(native, tick, resources + edge) == of_moves[tick, place, int(crowd.target[edge])]


def test_a_guide_meets_no_more_others_than_a_shortest_way() -> None:
    fewer = 0
    for seed in range(5):
        crowd, guides = crowd_and_guides(seed)
        native = Native(guides)
        for robot in range(ROBOTS):
            find_guides(native, np.array([robot], np.int32), 0, 1)
            others = [way(guides, other) for other in range(ROBOTS) if other != robot]
            moves = enumerate(pairwise(way(guides, robot)), 1)
            met = sum(meetings(others, tick, source, target) for tick, (source, target) in moves)
            assert fewest(crowd, others, robot, SLACK) <= met <= fewest(crowd, others, robot, 0)
            fewer += met < fewest(crowd, others, robot, 0)
    assert fewer > ROBOTS // 2
