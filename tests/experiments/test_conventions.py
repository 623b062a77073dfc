"""The planner of the experiment on conventions obeys the law where its rules are those of the law."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from carp_experiments.paper.conventions import (
    CONVENTIONS,
    Convention,
    add_robot,
    conventions_row,
    drawn_robots,
    drawn_tree,
    grid_edges,
    one_pass,
    world_of,
)
from carp_experiments.paper.conventions_report import conventions_report
from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.paper.space_time import World
from carp_optimized import query
from carp_spec import Instance, Neighbourhood, Plan, Visit, violations_of
from carp_spec.permutations import splitmix64

CASE = MapCase(conventions_row, 15, 3, 30)
LAWFUL: dict[str, tuple[Convention, dict[str, Any]]] = {
    "carproof": (Convention(), {}),
    "robots park": (Convention(stay=-1), {"after_goal": "park"}),
    "following forbidden": (Convention(following=False), {"following": "forbidden"}),
    "first nodes first": (Convention(ties="shallow"), {}),
}


def plans_of(world: World, instance: Instance, order: Sequence[int]) -> list[Plan]:
    """The world's plans as the law reads them."""
    plans = []
    for robot in order:
        first, last = int(world.entered[robot]), int(world.arrival[robot])
        cells = [int(cell) for cell in world.path[robot, first : last + 1]]
        enters = [first, *(first + at for at in range(1, len(cells)) if cells[at] != cells[at - 1])]
        ends = [*(end for _, end in pairwise(enters)), None if instance.after_goal == "park" else enters[-1] + 1]
        ids = [instance.graph.resources[cells[enter - first]].id for enter in enters]
        visits = tuple(Visit(*each) for each in zip(ids, enters, ends, strict=True))
        plans.append(Plan(instance.robots[robot].id, visits))
    return plans


@pytest.mark.parametrize("name", LAWFUL)
def test_one_robot_after_the_other_arrives_as_early_as_the_compiled_planner_lets_it(name: str) -> None:
    convention, law = LAWFUL[name]
    instance = replace(instance_of(CASE), **law)
    world = world_of(CASE, convention)
    planned, _ = one_pass(world, range(CASE.robots))
    plans = plans_of(world, instance, range(planned))
    assert not list(violations_of(instance, plans))
    for number, plan in enumerate(plans):
        best = query(instance, plans[:number], plan.robot)
        assert best is not None
        assert best.visits[-1].enter == plan.visits[-1].enter
    if planned < CASE.robots:
        assert query(instance, plans, instance.robots[planned].id) is None


@pytest.mark.parametrize("options", [Neighbourhood(4, baseline=False), Neighbourhood(5), Neighbourhood(6, sample=40)])
def test_the_neighbourhood_planner_makes_lawful_plans(options: Neighbourhood) -> None:
    instance = instance_of(CASE)
    world = world_of(CASE, Convention())
    order: Sequence[int] = []
    for robot in range(CASE.robots):
        updated = add_robot(world, Convention(), options, order, robot, splitmix64(robot))
        if updated is None:
            break
        order = updated
        assert not list(violations_of(instance, plans_of(world, instance, order)))
    assert len(order) > 1


def test_robots_that_stay_keep_their_goals_free_of_others() -> None:
    world = world_of(CASE, Convention(stay=5))
    planned, _ = one_pass(world, range(CASE.robots))
    for robot in range(planned):
        arrival = int(world.arrival[robot])
        assert all(world.occupant[arrival : arrival + 6, world.goal[robot]] == robot)


def test_ends_repeat_where_the_convention_says_so() -> None:
    case = replace(CASE, robots=100)
    for convention, repeats in {
        Convention(): (False, False),
        Convention(goals_repeated=True): (False, True),
        Convention(repeated=True): (True, True),
    }.items():
        starts, goals, _ = zip(*drawn_robots(case, convention), strict=True)
        assert tuple(len(set(ends)) < case.robots for ends in (starts, goals)) == repeats


@pytest.mark.parametrize("is_depth_first", [True, False])
def test_a_tree_spans_the_map_without_a_circle(is_depth_first: bool) -> None:
    tree = drawn_tree(grid_edges(), is_depth_first, splitmix64(7))
    assert len(tree) == 20 * 20 - 1
    reached = {0}
    while more := {end for edge in tree if reached & set(edge) for end in edge} - reached:
        reached |= more
    assert len(reached) == 20 * 20


def test_the_report_has_each_convention_twice() -> None:
    rows = [MapCase(conventions_row, map, 0, 6).run() for map in (10, 20)]
    summary = conventions_report(rows, 6).summary
    assert isinstance(summary, tuple)
    assert len(summary) == 2 * len(CONVENTIONS)
