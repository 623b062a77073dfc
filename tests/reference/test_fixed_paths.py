"""Fixed-path scheduling: which paths are chosen, and which of them is taken."""

from typing import get_args

import pytest
from tests.spec.making import grid, instance, line, plan_of

from carp_reference import plan
from carp_reference.fixed_paths import disjoint_paths, find_on_path, shortest_paths
from carp_reference.problem import prepare
from carp_spec import FixedPaths, Instance, Resource, ResourceGraph, Robot, Solution, judge
from carp_spec.planners import PathKind

OVERLAPPING = ResourceGraph(
    tuple(map(Resource, "sabtxyuv")),
    tuple((source, target) for source, target in ("sa", "ab", "bt", "ax", "xy", "yt", "su", "uv", "vb")),
)


def test_shortest_paths_come_shortest_first_and_by_duration() -> None:
    square = ResourceGraph(
        (Resource("a"), Resource("slow", duration=5), Resource("quick"), Resource("b")),
        (("a", "slow"), ("slow", "b"), ("a", "quick"), ("quick", "b")),
    )
    problem = prepare(instance(square, ("a", "b")), 0)
    assert shortest_paths(problem, problem.instance.robots[0], 5) == [("a", "quick", "b"), ("a", "slow", "b")]
    assert shortest_paths(problem, problem.instance.robots[0], 1) == [("a", "quick", "b")]


def test_disjoint_paths_share_nothing_between_start_and_goal() -> None:
    problem = prepare(instance(grid(3, 3), ("0,0", "2,2")), 0)
    paths = disjoint_paths(problem, problem.instance.robots[0], 4)
    assert [len(path) for path in paths] == [5, 5]
    assert not set(paths[0][1:-1]) & set(paths[1][1:-1])
    assert len(disjoint_paths(problem, problem.instance.robots[0], 1)) == 1


def test_disjoint_paths_are_the_shortest_together_not_one_by_one() -> None:
    problem = prepare(instance(OVERLAPPING, ("s", "t")), 0)
    assert shortest_paths(problem, problem.instance.robots[0], 1) == [("s", "a", "b", "t")]
    assert disjoint_paths(problem, problem.instance.robots[0], 2) == [
        ("s", "a", "x", "y", "t"),
        ("s", "u", "v", "b", "t"),
    ]


def test_a_robot_at_its_goal_has_the_path_of_one_resource() -> None:
    problem = prepare(instance(grid(2, 2), ("0,0", "0,0")), 0)
    for paths_of in (shortest_paths, disjoint_paths):
        assert paths_of(problem, problem.instance.robots[0], 3) == [("0,0",)]


def test_a_goal_out_of_reach_has_no_path() -> None:
    split = ResourceGraph((Resource("a"), Resource("b")), ())
    apart = instance(split, ("a", "b"))
    for paths_of in (shortest_paths, disjoint_paths):
        assert paths_of(prepare(apart, 0), apart.robots[0], 3) == []
    assert plan(apart, FixedPaths()) == Solution((), (), ("r0",))


def test_a_robot_waits_on_its_path_and_does_not_leave_it() -> None:
    two = Instance(grid(2, 2), (Robot("r0", "1,0", "1,0", 0, pace=3), Robot("r1", "0,0", "1,1")))
    ahead = plan_of("r0", ("1,0", 0, 3))
    found = find_on_path(prepare(two, 0), (ahead,), two.robots[1], ("0,0", "1,0", "1,1"))
    assert found == plan_of("r1", ("0,0", 0, 3), ("1,0", 3, 4), ("1,1", 4, 5))


def test_the_path_that_arrives_earliest_is_taken() -> None:
    two = Instance(grid(2, 2), (Robot("r0", "1,0", "1,0", 0, pace=3), Robot("r1", "0,0", "1,1")))
    for paths in (FixedPaths(k=2), FixedPaths(k=2, paths="disjoint")):
        solution = plan(two, paths)
        assert solution.plans[1] == plan_of("r1", ("0,0", 0, 1), ("0,1", 1, 2), ("1,1", 2, 3))


@pytest.mark.parametrize("kind", get_args(PathKind))
def test_plans_on_fixed_paths_break_no_rule(kind: PathKind) -> None:
    four = instance(grid(3, 3), ("0,0", "2,2"), ("2,2", "0,0"), ("0,2", "2,0"), ("1,1", "1,1"))
    solution = plan(four, FixedPaths(k=3, paths=kind))
    assert judge(four, solution).valid
    assert not solution.unplanned


def test_with_one_path_alone_no_robot_evades_another() -> None:
    meeting = instance(line("abc"), ("a", "c"), ("c", "a"))
    assert plan(meeting, FixedPaths(k=3)).unplanned == ("r1",)


def test_each_kind_of_paths_is_the_one_that_is_asked_for() -> None:
    one = instance(OVERLAPPING, ("s", "t"))
    costs = {kind: plan(one, FixedPaths(k=2, paths=kind)).plans[0].visits[-1].enter for kind in get_args(PathKind)}
    assert costs == {"shortest": 3, "disjoint": 4}


@pytest.mark.parametrize("ends", [("s", "t"), ("t", "s")])
def test_paths_lead_from_start_to_goal_whichever_comes_first_in_the_alphabet(ends: tuple[str, str]) -> None:
    problem = prepare(instance(line("sat"), ends), 0)
    for paths_of in (shortest_paths, disjoint_paths):
        assert paths_of(problem, problem.instance.robots[0], 2) == [(ends[0], "a", ends[1])]


def test_disjoint_paths_do_not_meet_in_a_resource_between() -> None:
    hourglass = [("s", "a"), ("s", "b"), ("a", "m"), ("b", "m"), ("m", "x"), ("m", "y"), ("x", "t"), ("y", "t")]
    problem = prepare(instance(ResourceGraph(tuple(map(Resource, "sabmxyt")), tuple(hourglass)), ("s", "t")), 0)
    assert len(disjoint_paths(problem, problem.instance.robots[0], 2)) == 1


def test_the_direct_move_is_one_path() -> None:
    triangle = ResourceGraph(tuple(map(Resource, "sat")), (("s", "t"), ("s", "a"), ("a", "t")))
    problem = prepare(instance(triangle, ("s", "t")), 0)
    assert disjoint_paths(problem, problem.instance.robots[0], 2) == [("s", "t"), ("s", "a", "t")]
