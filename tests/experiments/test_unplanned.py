"""Robots that block each other are found, and distinguished from those that can have no plans together."""

import pytest

from carp_experiments.beyond.unplanned import (
    ROUNDS,
    blocking_group,
    blocking_groups,
    group_facts,
    planned_around,
    repaired,
    unplanned_report,
    unplanned_row,
)
from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_spec import Instance, Resource, ResourceGraph, Robot, Solution, judge

BLOCKED = ("r3", "r22", "r42", "r66")


@pytest.fixture(scope="module")
def tree() -> Instance:
    """A tree on which four robots at one end can be planned in no order one after the other."""
    instance = instance_of(MapCase(unplanned_row, 0, 1))
    robots = tuple(robot for robot in instance.robots if robot.id in (*BLOCKED, "r1", "r9", "r40", "r71"))
    return Instance(instance.graph, robots, instance.after_goal)


def test_the_robots_that_block_each_other_are_found(tree: Instance) -> None:
    assert blocking_group(tree, [*tree.robot], 0) == BLOCKED


def test_in_no_order_of_them_all_get_plans_and_yet_there_are_some(tree: Instance) -> None:
    group = group_facts(tree, BLOCKED)
    assert (group.orders, group.failing, group.proved) == (24, 24, True)
    assert group.cost is not None
    assert group.cost > group.shortest
    whole = planned_around(tree, BLOCKED, 0)
    assert whole is not None
    assert judge(tree, whole).valid
    assert not whole.unplanned


def test_what_cannot_be_planned_at_all_is_found() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),))
    instance = Instance(graph, (Robot("east", "a", "b"), Robot("west", "b", "a")))
    group = group_facts(instance, ("east", "west"))
    assert (group.orders, group.failing, group.cost, group.proved) == (2, 2, None, True)
    assert planned_around(instance, ("east", "west"), 0) is None
    assert list(blocking_groups(instance, 0)) == [("east", "west")]


def test_a_repair_ends_when_every_robot_has_a_plan() -> None:
    instance = instance_of(MapCase(unplanned_row, 20, 1, 10))
    nobody = Solution((), (), tuple(instance.robot))
    better, rounds = repaired(instance, nobody, 20_000, 1)
    assert not better.unplanned
    assert rounds == 2000
    assert repaired(instance, better, 20_000, 1) == (better, 0)


def test_the_report_counts_what_came_of_the_failures() -> None:
    group = {"robots": ["a", "b"], "orders": 2, "failing": 2, "shortest": 3, "cost": 9, "proved": True}
    row = {"map": 4, "assignment": 0, "before": 2, "rounds": ROUNDS[-1], "left": ["a"], "groups": [group], "whole": 70}
    rows = [
        row,
        {**row, "assignment": 1, "groups": [{**group, "cost": None}], "whole": None},
        {**row, "assignment": 2, "groups": [{**group, "failing": 1, "orders": 0, "robots": list("abcdefg")}]},
        {**row, "assignment": 3, "rounds": 4000, "left": [], "groups": []},
        {**row, "assignment": 4, "before": 0, "rounds": 0, "left": [], "groups": []},
    ]
    maps, groups = unplanned_report(rows).tables
    assert maps.rows == (("4", "4/5 (1.60)", "4/5", "3/5", "3/5", "2/3", "1/3", "2/3"),)
    assert [line[4:] for line in groups.rows] == [
        ("2/2", "3", "9", "70"),
        ("2/2", "3", "none exists", "-"),
        ("of 5,040 none tried", "3", "9", "70"),
    ]
    (only,) = unplanned_report(rows[3:]).tables
    assert only.name == "unplanned"
