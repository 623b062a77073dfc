"""Robots that a planner leaves out get plans, in the way of others or in small groups, and the law judges them."""

from dataclasses import replace
from itertools import count

import pytest
from hypothesis import given

from carp_optimized import plan
from carp_optimized.improve.repair import repair, repair_jointly
from carp_spec import Carp, Group, Instance, Resource, ResourceGraph, Robot, Solution, judge
from carproof import Following
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances


def passage(pocket: bool, *, capacity: int = 1, others: int = 0, following: Following = "allowed") -> Instance:
    """Two robots that park and have to swap the ends of a passage of three resources, with or without a pocket.

    Other robots stand in the pocket.
    """
    pairs = [("west", "middle"), ("middle", "east"), ("middle", "pocket")][: 3 if pocket else 2]
    resources = tuple(
        Resource(id, capacity=capacity if id == "pocket" else 1) for id in ("west", "middle", "east", "pocket")
    )
    robots = [Robot("r1", "west", "east", 0, 1), Robot("r2", "east", "west", 0, 1)]
    robots += [Robot(f"p{number}", "pocket", "pocket", 0, 1) for number in range(others)]
    return Instance(ResourceGraph(resources, tuple(pairs)), tuple(robots), "park", following)


@pytest.mark.parametrize("following", ["allowed", "forbidden"])
def test_two_robots_that_swap_at_a_pocket_are_planned_jointly(following: Following) -> None:
    instance = passage(pocket=True, following=following)
    given = plan(instance, Carp())
    assert len(given.unplanned) == 1
    for repaired in (repair(instance, given), repair_jointly(instance, given)):
        assert not repaired.unplanned
        assert judge(instance, repaired).valid


def lanes(*zone: str, capacity: int = 1, ends: tuple[str, str] = ("west", "east")) -> Instance:
    """The passage with a pocket, with a lane in each direction between two places, which are a group, and a zone.

    Two robots swap the ends.
    """
    places = tuple(Resource(id) for id in ("west", "middle", "east", "pocket"))
    pairs = [(end, "middle") for end in ("west", "east", "pocket")]
    ways = [way for pair in pairs for way in (pair, pair[::-1])]
    resources = (*places, *(Resource(f"{source}-{target}") for source, target in ways))
    edges = tuple(move for a, b in ways for move in ((a, f"{a}-{b}"), (f"{a}-{b}", b)))
    groups = [Group(f"{a}={b}", (f"{a}-{b}", f"{b}-{a}")) for a, b in pairs]
    if zone:
        groups.append(Group("zone", zone, capacity))
    robots = (Robot("r1", *ends), Robot("r2", *ends[::-1]))
    return Instance(ResourceGraph(resources, edges, True, tuple(groups)), robots, "park")


@pytest.mark.parametrize(
    "instance",
    [
        lanes(),
        lanes("pocket", "middle", capacity=2),
        lanes("pocket", "middle-east", "middle-west"),
        lanes(ends=("pocket", "middle")),
    ],
)
def test_robots_that_swap_where_lanes_are_groups_are_planned_jointly(instance: Instance) -> None:
    given = plan(instance, Carp())
    assert len(given.unplanned) == 1
    repaired = repair_jointly(instance, given)
    assert not repaired.unplanned
    assert judge(instance, repaired).valid


def test_a_robot_that_no_small_group_helps_takes_the_way_of_others() -> None:
    instance = grid_instance(Grid(map=0), Fleet(robots=100, seed=45))
    repaired = repair(instance, plan(instance))
    assert not repaired.unplanned
    assert judge(instance, repaired).valid


@pytest.mark.parametrize("looks", [0, 1, 5, 20, 22, 24, 30])
def test_a_repair_that_goes_on_no_more_ends_with_plans_that_are_no_worse(looks: int) -> None:
    instance = grid_instance(Grid(map=0), Fleet(robots=100, seed=45))
    given = plan(instance, Carp())
    asked = count()
    repaired = repair(instance, given, lambda: next(asked) < looks)
    assert judge(instance, repaired).valid
    assert len(repaired.unplanned) <= len(given.unplanned)


def test_a_pocket_is_used_up_to_its_capacity() -> None:
    for capacity, others, left_out in ((2, 1, 0), (2, 2, 1), (3, 2, 0), (10**9, 2, 0)):
        instance = passage(pocket=True, capacity=capacity, others=others)
        repaired = repair(instance, plan(instance, Carp()))
        assert judge(instance, repaired).valid
        assert len(repaired.unplanned) == left_out


@given(planned_instances(Sizes(resources=7, robots=6)) | planned_instances(Sizes(resources=7, robots=6, groups=2)))
def test_repaired_plans_break_no_rule_and_nobody_loses_a_plan(planned: PlannedInstance) -> None:
    instance, given = planned.instance, planned.solution
    whole = Solution(given.plans, given.order, tuple(each for each in instance.robot if each not in given.order))
    repaired = repair_jointly(instance, whole)
    assert judge(instance, repaired).valid
    assert {*given.order} <= {*repaired.order}
    assert repair_jointly(instance, whole) == repaired


def test_a_repair_moves_a_crowd_tick_by_tick_where_other_means_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimized.improve.repair.ATTEMPTS", 0)
    instance = replace(grid_instance(Grid(width=8, height=8, map=20), Fleet(robots=32)), after_goal="park")
    island = Resource("island")
    graph = ResourceGraph((*instance.graph.resources, island), instance.graph.edges)
    lost = Robot("lost", "island", instance.robots[0].start)
    instance = replace(instance, graph=graph, robots=(*instance.robots, lost))
    repaired = repair(instance, plan(instance, Carp()))
    assert repaired.unplanned == ("lost",)
    assert judge(instance, repaired).valid
