"""Distances by landmarks never say too much, and are right where there is nothing to go around."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.crowd import FAR, Crowd, crowd_of, is_stepwise, ways_of
from carp_optimized.crowds.distances import are_right, estimate, landmarks_of
from carp_optimized.jit.references import Native
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carproof.testing.strategies import Sizes, instances

STEPWISE = Sizes(resources=7, robots=5, capacity=1, duration=1, release=0, pace=1)


def estimated(crowd: Crowd) -> Crowd:
    """The same crowd with estimates for distances."""
    crowd = crowd._replace(distance=np.empty_like(crowd.distance))
    order = np.arange(crowd.start.size, dtype=np.int32)
    estimate(Native(landmarks_of(crowd)), Native(crowd), order, 0, order.size)
    return crowd


@given(instances(STEPWISE).filter(lambda each: is_stepwise(each) and len(each.robots) > 0))
def test_an_estimate_is_no_more_than_the_distance_and_falls_by_at_most_one_on_an_edge(instance: Instance) -> None:
    exact = measured(instance)
    source = np.repeat(np.arange(exact.queue.size), np.diff(exact.first))
    for found, distance in zip(estimated(exact).distance, exact.distance, strict=True):
        if found.min() < FAR:
            assert (found <= distance).all()
            assert (found[source].astype(np.int32) <= found[exact.target].astype(np.int32) + 1).all()


def test_on_a_one_way_ring_nothing_follows_from_a_place_nearer_to_a_landmark() -> None:
    ring = tuple(f"{k}" for k in range(6))
    graph = ResourceGraph(tuple(map(Resource, ring)), tuple(pairwise((*ring, ring[0]))), directed=True)
    exact = measured(Instance(graph, tuple(Robot(goal, start="0", goal=goal) for goal in ring), after_goal="park"))
    assert (estimated(exact).distance <= exact.distance).all()


def test_a_goal_on_another_island_is_too_far_away() -> None:
    places = tuple(f"{k}" for k in range(20))
    graph = ResourceGraph(tuple(map(Resource, (*places, "a", "b"))), (*pairwise(places), ("a", "b")))
    robots = (Robot("1", start="0", goal="3"), Robot("2", start="a", goal="3"), Robot("3", start="b", goal="a"))
    found = estimated(crowd_of(Instance(graph, robots, after_goal="park")))
    assert ways_of(found).tolist() == [3, FAR, FAR]


def test_estimates_are_right_on_a_full_grid_and_not_on_a_map_with_walls() -> None:
    exact = measured(on_grid(20, 40))
    assert np.array_equal(estimated(exact).distance, exact.distance)
    assert are_right(exact, landmarks_of(exact))
    walled = measured(on_grid(30, 40, map=0))
    before = walled.distance.copy()
    assert not are_right(walled, landmarks_of(walled))
    assert np.array_equal(walled.distance, before)
