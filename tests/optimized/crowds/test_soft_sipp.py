"""Paths through the stays of others: lawful steps, nobody met without need, and each robot met is planned again."""

from collections.abc import Sequence

import numpy as np
import pytest
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.improving import Improving
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.sipp import UNTIL_FOUND
from carp_optimized.crowds.stays import no_paths, solution_along
from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot, Solution, judge

ROBOTS = 60


def planned(
    instance: Instance, order: Sequence[int], *, has_way: bool, greed: int = GREEDY, effort: int = UNTIL_FOUND
) -> tuple[Solution, int]:
    """Plans in order, with way made for those that find none or without; and how often nobody's way was free."""
    improving = Improving(measured(instance), no_paths(len(instance.robots), 400))
    improving.plan_first(np.array(order, np.int32), lambda: True, greed, effort)
    paths = improving.rounds.paths
    if has_way:
        paths = improving.make_way(lambda _: improving.missed < 100 * len(instance.robots))
    return solution_along(instance, instance.robots, paths), improving.missed


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_robots_that_found_no_path_have_one_once_way_is_made(after_goal: AfterGoal) -> None:
    missing = 0
    for seed in range(24):
        instance = on_grid(9, ROBOTS, after_goal, seed)
        greed = GREEDY * (seed % 3) ** 2
        without, _ = planned(instance, range(ROBOTS), has_way=False, greed=greed)
        found, _ = planned(instance, range(ROBOTS), has_way=True, greed=greed)
        hasty, _ = planned(instance, range(ROBOTS), has_way=True, greed=greed, effort=10)
        assert judge(instance, without).valid
        assert judge(instance, hasty).valid
        assert not hasty.unplanned
        assert judge(instance, found).valid
        assert not found.unplanned
        missing += len(without.unplanned)
    assert missing > 60


def corridor() -> Instance:
    """A corridor from a to e, with side rooms at b and c: one robot parks in d before the other has passed to e."""
    edges = (("a", "b"), ("b", "c"), ("c", "d"), ("d", "e"), ("b", "s"), ("c", "t"))
    robots = (Robot("far", "a", "e"), Robot("near", "b", "d"), Robot("aside", "t", "t"))
    return Instance(ResourceGraph(tuple(map(Resource, "abcdest")), edges), robots, after_goal="park")


def test_only_the_robot_in_the_way_is_planned_again() -> None:
    instance = corridor()
    without, _ = planned(instance, [1, 2, 0], has_way=False)
    assert without.unplanned == ("far",)
    found, missed = planned(instance, [1, 2, 0], has_way=True)
    assert judge(instance, found).valid
    assert not found.unplanned
    assert missed == 2
    assert found.plan_of("aside") == without.plan_of("aside")
