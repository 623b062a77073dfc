"""The optimised planner makes the reference's plans, visit for visit, whatever kinds of reuse are on."""

from dataclasses import replace
from random import Random
from typing import get_args

from hypothesis import given
from hypothesis import strategies as st

import carp_optimized
import carp_reference
from carp_optimized import Reuse
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Instance,
    LongestFirst,
    Neighbourhood,
    Planner,
    Refusal,
    Shuffled,
    Stop,
    has_ended,
)
from carp_spec.planners import PathKind
from carproof import AfterGoal
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way, instances

SIZES = Sizes(resources=6, robots=6, groups=2)
WITH_STOPS = Sizes(resources=5, robots=4, stops=3, service=4, groups=2)
SEEDS = st.integers(0, 2**64 - 1)


def neighbourhoods() -> st.SearchStrategy[Neighbourhood]:
    return st.builds(
        Neighbourhood,
        m=st.integers(1, 5),
        sample=st.none() | st.integers(1, 8),
        seed=SEEDS,
        baseline=st.booleans(),
        fallback=st.none() | st.integers(1, 3),
    )


def planners() -> st.SearchStrategy[Planner]:
    others = st.sampled_from([Carp(), LongestFirst(), Greedy()])
    return st.one_of(neighbourhoods(), others, st.builds(Shuffled, attempts=st.integers(1, 4), seed=SEEDS))


def kinds_of_reuse() -> st.SearchStrategy[Reuse]:
    on = st.booleans()
    return st.builds(Reuse, kept=on, unchanged=on, prefixes=on, shared=on, bounds=on)


@given(fleets_under_way(SIZES) | fleets_under_way(WITH_STOPS), st.data())
def test_a_query_finds_the_same_plan(fleet: FleetUnderWay, data: st.DataObject) -> None:
    robot = data.draw(st.sampled_from([fleet.robot, *fleet.solution.order]))
    question = (fleet.instance, fleet.solution.plans, robot, fleet.now)
    assert carp_optimized.query(*question) == carp_reference.query(*question)


@given(instances(SIZES) | instances(WITH_STOPS), planners(), kinds_of_reuse())
def test_planning_all_robots_makes_the_same_solution(instance: Instance, planner: Planner, reuse: Reuse) -> None:
    assert carp_optimized.plan(instance, planner, reuse=reuse) == carp_reference.plan(instance, planner)


def crowded_grid(seed: int) -> Instance:
    """A small grid on which many paths are of equal length and robots wait for one another."""
    random = Random(seed)  # noqa: S311 - no secret
    fleet = Fleet(10, seed=seed, after_goal=random.choice(get_args(AfterGoal)))
    drawn = grid_instance(Grid(5, 5, random.randint(8, 20), seed), fleet)
    resources = tuple(replace(each, duration=random.choice([1, 1, 2, 4, 9])) for each in drawn.graph.resources)
    return replace(drawn, graph=replace(drawn.graph, resources=resources))


@given(st.builds(crowded_grid, SEEDS) | instances(SIZES), st.integers(1, 6))
def test_robots_take_the_same_of_a_few_paths(instance: Instance, k: int) -> None:
    for kind in get_args(PathKind):
        planner = FixedPaths(k, kind)
        assert carp_optimized.plan(instance, planner) == carp_reference.plan(instance, planner)


@given(fleets_under_way(SIZES) | fleets_under_way(WITH_STOPS), neighbourhoods(), kinds_of_reuse())
def test_adding_a_robot_makes_the_same_solution(fleet: FleetUnderWay, options: Neighbourhood, reuse: Reuse) -> None:
    question = (fleet.instance, fleet.solution, fleet.robot, fleet.now, options)
    assert carp_optimized.add(*question, reuse) == carp_reference.add(*question)


@given(fleets_under_way(WITH_STOPS), neighbourhoods(), st.data())
def test_assigning_a_stop_makes_the_same_solution(
    fleet: FleetUnderWay, options: Neighbourhood, data: st.DataObject
) -> None:
    going = [plan.robot for plan in fleet.solution.plans if not has_ended(plan, fleet.now)]
    robot = data.draw(st.sampled_from(going or [fleet.robot]))
    stop = Stop(data.draw(st.sampled_from([*fleet.instance.graph.index])), data.draw(st.integers(0, 4)))
    question = (fleet.instance, fleet.solution, robot, [stop], fleet.now, options)
    try:
        assert carp_optimized.assign(*question) == carp_reference.assign(*question)
    except Refusal:
        assert not going or fleet.instance.robot[robot].goal == stop.resource
