"""The clauses about some robots alone hold whatever these must not do, so a search for deadlines among them ends."""

import pytest

from carp_optimum.bound import Progress, lower_bound
from carproof import Instance, Resource, ResourceGraph, Robot, verify_bound

MOST_REPORTS = 5000
"""Fewer than 1,000 are needed here; a search that goes round in circles reports again and again."""


def two_to_one_goal() -> Instance:
    """All three cells are neighbours, and robots park: there is no plan set."""
    graph = ResourceGraph(tuple(map(Resource, "abc")), (("c", "a"), ("b", "a"), ("c", "b")))
    starts_and_goals = ("ac", "ab", "ba", "aa")
    return Instance(graph, tuple(Robot(f"robot {at}", *ends) for at, ends in enumerate(starts_and_goals)), "park")


def two_to_a_cell_for_two() -> Instance:
    """A capacity of 2 is a sum, whose variables are about no robot."""
    cells = (("west", 2, 2), ("hall", 1, 2), ("door", 1, 1), ("east", 2, 1), ("yard", 1, 3))
    edges = (("west", "hall"), ("hall", "door"), ("door", "east"), ("hall", "yard"))
    robots = (
        Robot("leaves", "east", "yard", release=1),
        Robot("crosses", "yard", "west", release=3),
        Robot("enters", "door", "east", release=4),
        Robot("slow", "hall", "east", release=1, pace=2),
    )
    return Instance(ResourceGraph(tuple(Resource(*cell) for cell in cells), edges), robots, "park")


@pytest.mark.parametrize(("instance", "steps"), [(two_to_one_goal(), 16), (two_to_a_cell_for_two(), 100)])
def test_the_search_for_deadlines_ends(instance: Instance, steps: int) -> None:
    reports: list[Progress] = []

    def report(progress: Progress) -> None:
        reports.append(progress)
        assert len(reports) < MOST_REPORTS

    certificate = lower_bound(instance, steps=steps, on_step=report)
    assert verify_bound(instance, certificate) == certificate.bound
