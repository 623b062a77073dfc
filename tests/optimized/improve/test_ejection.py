"""Robots left out get plans in the way of others, who are planned again."""

import numpy as np
from tests.profiles import draws

import carp_optimized
from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.ejection import plan_left_out
from carp_optimized.neighbourhood.meetings import first_meetings
from carp_optimized.state.arrays import ALONE, NEVER, NONE
from carp_spec import Carp, Group, Instance, Resource, ResourceGraph, Robot, Solution, judge, violations_of
from carp_spec.permutations import splitmix64
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.testing.random_instances import Draw, Mix, draw_instance

MIX = Mix(robots=(3, 4, 5), groups=(0, 1, 2), followings=("allowed", "allowed", "forbidden"), stops=2, services=(0, 2))


def planned_by_carp(instance: Instance) -> PlannedFleet:
    fleet = PlannedFleet(instance)
    fleet.commit(carp_optimized.plan(instance, Carp()).plans)
    return fleet


def solution_of(fleet: PlannedFleet) -> Solution:
    return Solution.of(fleet.instance, fleet.plans)


def order_of(fleet: PlannedFleet) -> list[int]:
    return [*fleet.order]


def test_who_parks_in_the_way_is_planned_again_and_a_robot_without_path_changes_nothing() -> None:
    resources = tuple(Resource(id) for id in ("west", "east", "middle", "dead end", "island"))
    graph = ResourceGraph(resources, (("middle", "west"), ("middle", "east"), ("middle", "dead end")))
    robots = (Robot("r1", "west", "middle"), Robot("r2", "east", "dead end"), Robot("r3", "island", "west"))
    fleet = planned_by_carp(Instance(graph, robots, "park"))
    assert order_of(fleet) == [0]
    for _ in range(2):
        plan_left_out(fleet, lambda: True, times=9)
        assert order_of(fleet) == [1, 0]
        assert judge(fleet.instance, solution_of(fleet)).valid


def test_who_waits_in_the_same_group_is_planned_again() -> None:
    resources = tuple(Resource(id, 3) for id in ("a", "b", "c", "d"))
    graph = ResourceGraph(resources, (("a", "b"), ("c", "d")), True, (Group("lanes", ("b", "c")),))
    fleet = planned_by_carp(Instance(graph, (Robot("r1", "a", "b"), Robot("r2", "c", "d", 9)), "park"))
    assert order_of(fleet) == [0]
    plan_left_out(fleet, lambda: True, times=9)
    assert order_of(fleet) == [1, 0]
    assert judge(fleet.instance, solution_of(fleet)).valid


def test_nobody_more_is_left_out_and_some_are_planned() -> None:
    before, after = 0, 0
    for number in range(draws(5000)):
        fleet = planned_by_carp(draw_instance(Draw(splitmix64(number)), MIX))
        given = len(fleet.order)
        plan_left_out(fleet, lambda: True, times=3)
        assert judge(fleet.instance, solution_of(fleet)).valid
        assert len(fleet.order) >= given
        before, after = before + given, after + len(fleet.order)
    assert before < after


def in_the_way(fleet: PlannedFleet, plan: int) -> dict[int, int]:
    """By robot with a plan, the tick from which on it is in the way of a plan."""
    size, ticks = fleet.state.graph.room.size, np.zeros(fleet.planned.size, np.int32)
    scratch = np.zeros(size, np.int32), np.zeros(size, np.int32)
    first_meetings(fleet.native, plan, fleet.held[fleet.planned], *scratch, ticks)
    return dict(zip(fleet.order, ticks.tolist(), strict=True))


def plan_alone(fleet: PlannedFleet, robot: int) -> int:
    return fleet.call(lambda: passes.find_one(fleet.empty, robot, NONE, 0, ALONE))


def test_whoever_breaks_a_rule_together_with_a_plan_is_in_its_way_by_then() -> None:
    met = 0
    for number in range(draws(5000)):
        fleet = planned_by_carp(draw_instance(Draw(splitmix64(number)), MIX))
        for robot in range(len(fleet.instance.robots)):
            alone = plan_alone(fleet, robot)
            for other, tick in () if alone == NONE else in_the_way(fleet, alone).items():
                plans = fleet.plan_of(alone), fleet.plan_of(int(fleet.held[other]))
                broken = violations_of(fleet.instance, plans) if other != robot else ()
                met += bool(broken)
                assert all(tick < NEVER and tick <= each.start for each in broken if each.start is not None)
    assert met


def test_all_is_as_before_if_several_could_not_make_way() -> None:
    graph = ResourceGraph(tuple(map(Resource, "abcxy")), (("a", "b"), ("b", "c"), ("x", "y")))
    robots = Robot("r1", "a", "c"), Robot("r2", "b", "c"), Robot("r3", "x", "y"), Robot("r4", "c", "a")
    fleet = planned_by_carp(Instance(graph, robots))
    given = solution_of(fleet)
    assert given.unplanned == ("r4",)
    plan_left_out(fleet, lambda: True, times=5)
    assert solution_of(fleet) == given


def test_one_that_is_broken_off_leaves_nobody_more_out() -> None:
    parking = Fleet(robots=30, seed=1, after_goal="park")
    instance = grid_instance(Grid(width=10, height=10, map=5), parking, Traits(duration=Range(1, 3)))
    given = carp_optimized.plan(instance, Carp())
    for queries in range(0, 500, 7):
        fleet = PlannedFleet(instance)
        fleet.commit(given.plans)
        plan_left_out(fleet, lambda fleet=fleet, queries=queries: fleet.queries.asked < queries)  # type: ignore[misc]
        assert fleet.queries.asked <= queries + 2
        assert judge(instance, solution_of(fleet)).valid
        assert len(fleet.order) >= len(given.order)
