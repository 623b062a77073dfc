"""Queries among robots with paths: the earliest arrival without greed, and a lawful path with any greed."""

import numpy as np
import pytest
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.improving import Improving, arrivals
from carp_optimized.crowds.rounds import DEGREES, GREEDY
from carp_optimized.crowds.sipp import UNTIL_FOUND
from carp_optimized.crowds.stays import no_paths, solution_along
from carp_reference import query
from carp_spec import AfterGoal, Instance, judge

ROBOTS = 14
DEGREES_OF_GREED = [GREEDY * degree**2 for degree in range(DEGREES)]


def never_ends() -> bool:
    return True


def planned(instance: Instance, greed: int, last: int) -> Improving:
    """All robots planned in their order without greed, up to the last one with some."""
    improving = Improving(measured(instance), no_paths(ROBOTS, 200))
    order = np.arange(ROBOTS, dtype=np.int32)
    improving.plan_first(order[:last], never_ends, 0, UNTIL_FOUND)
    improving.plan_first(order[last : last + 1], never_ends, greed, UNTIL_FOUND)
    return improving


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_a_path_is_found_with_any_greed_or_with_none_and_comes_no_earlier_than_without(after_goal: AfterGoal) -> None:
    later = 0
    for seed in range(12):
        instance = on_grid(6, ROBOTS, after_goal, seed)
        for last in range(1, ROBOTS):
            found = [planned(instance, greed, last).rounds.paths for greed in DEGREES_OF_GREED]
            assert len({bool(paths.size[last]) for paths in found}) == 1
            if found[0].size[last]:
                ticks = [int(arrivals(paths)[last]) for paths in found]
                assert min(ticks) == ticks[0]
                later += max(ticks) > ticks[0]
            for paths in found:
                assert judge(instance, solution_along(instance, instance.robots, paths)).valid
    assert later > 0


def test_a_free_way_of_any_length_is_found_without_effort() -> None:
    crowd = measured(on_grid(40, 1))
    for greed in DEGREES_OF_GREED:
        improving = Improving(crowd, no_paths(1, 200))
        improving.plan_first(np.zeros(1, np.int32), never_ends, greed, 0)
        assert arrivals(improving.rounds.paths)[0] == improving.rounds.least[0] > 0


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_without_greed_robots_arrive_as_early_as_by_the_reference(after_goal: AfterGoal) -> None:
    for seed in range(4):
        instance = on_grid(6, ROBOTS, after_goal, seed)
        for last in range(1, ROBOTS):
            paths = planned(instance, 0, last).rounds.paths
            plans = solution_along(instance, instance.robots, paths).plans
            others = [each for each in plans if each.robot != instance.robots[last].id]
            found = next((each for each in plans if each.robot == instance.robots[last].id), None)
            expected = query(instance, others, instance.robots[last].id)
            assert (found and found.visits[-1].enter) == (expected and expected.visits[-1].enter)
