"""The neighbourhood planner: counts, candidates, rounds, fallback."""

from collections.abc import Iterator, Sequence

import pytest
from tests.spec.making import grid, instance, line, plan_of

import carp_reference
from carp_reference import neighbourhood
from carp_reference.problem import Problem
from carp_spec import Carp, Instance, Neighbourhood, Plan, Resource, ResourceGraph, RobotId, Solution, judge, total_cost
from carp_spec.permutations import splitmix64

EMPTY = Solution((), (), ())


def in_each_others_way() -> Instance:
    """r0 waits in the lane's middle for r1 to come past if r1 arrives second, and nobody waits the other way."""
    return instance(line("abc"), ("b", "b"), ("a", "c"), after_goal="park")


def test_a_robot_that_blocks_the_goal_stays_where_no_order_helps() -> None:
    blocked = in_each_others_way()
    solution = carp_reference.plan(blocked, Neighbourhood(m=2))
    assert (solution.order, solution.unplanned) == (("r0",), ("r1",))


def test_the_fallback_counts_only_if_it_plans_every_robot() -> None:
    siding = ResourceGraph(tuple(map(Resource, "abcde")), (("a", "b"), ("b", "c"), ("c", "d"), ("b", "e")))
    two = instance(siding, ("b", "c"), ("a", "d"), after_goal="park")
    first = carp_reference.add(two, EMPTY, "r0", 0, Neighbourhood(m=1))
    without = carp_reference.add(two, first, "r1", 0, Neighbourhood(m=1))
    assert (without.order, without.unplanned) == (("r0",), ("r1",))
    with_fallback = carp_reference.add(two, first, "r1", 0, Neighbourhood(m=1, fallback=20))
    assert (with_fallback.order, with_fallback.unplanned) == (("r1", "r0"), ())
    assert judge(two, with_fallback).valid
    hopeless = carp_reference.plan(in_each_others_way(), Neighbourhood(m=1, fallback=3))
    assert (hopeless.order, hopeless.unplanned) == (("r0",), ("r1",))


def test_a_robot_whose_goal_is_out_of_reach_is_unplanned_at_once() -> None:
    apart = ResourceGraph((Resource("a"), Resource("z")), ())
    assert carp_reference.plan(instance(apart, ("a", "z")), Neighbourhood()).unplanned == ("r0",)


def test_a_robot_that_has_left_is_neither_taken_in_nor_replanned() -> None:
    two = instance(line("abcd"), ("a", "b"), ("c", "d"))
    done = Solution((plan_of("r0", ("a", 0, 3), ("b", 3, 4)),), ("r0",), ())
    late = carp_reference.add(two, done, "r1", 5, Neighbourhood(m=4, baseline=False))
    assert late.plans[0] == done.plans[0]
    assert late.order == ("r0", "r1")


def test_in_paper_mode_the_result_may_cost_more_than_keeping_all_plans() -> None:
    """The claim "never worse than CARP" needs `neighbourhood/baseline`: without it this is a counterexample."""
    three = instance(grid(2, 2), ("1,1", "1,0"), ("0,0", "1,0"), ("0,1", "1,1"))
    two = Instance(three.graph, three.robots[:2])
    committed = carp_reference.plan(two, Carp())
    costs = {
        baseline: total_cost(three, carp_reference.add(three, committed, "r2", 0, options).plans)
        for baseline, options in ((True, Neighbourhood(m=2)), (False, Neighbourhood(m=2, baseline=False)))
    }
    kept = carp_reference.plan(three, Carp())
    assert (total_cost(three, kept.plans), costs[True], costs[False]) == (4, 4, 5)


def test_a_round_in_which_a_replanned_robot_finds_no_plan_has_no_candidate_and_the_next_one_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without r0, r1 goes its way undelayed and leaves none for r2; the next round takes in r2 itself.

    r3 is far away and behind r2: it has no plan in the first round either, though it would find one.
    """
    corridor = line("abcde")
    far = (Resource("x", x=100, y=0), Resource("y", x=101, y=0))
    graph = ResourceGraph((*corridor.resources, *far), (*corridor.edges, ("x", "y")))
    five = instance(graph, ("d", "c"), ("c", "e"), ("e", "d"), ("x", "y"), ("b", "c"))
    committed = carp_reference.plan(Instance(five.graph, five.robots[:4]), Carp())
    rounds: list[tuple[list[RobotId], int]] = []

    def replan(problem: Problem, kept: tuple[Plan, ...], outside: Sequence[RobotId]) -> tuple[Plan, ...]:
        plans = replan_outside(problem, kept, outside)
        rounds.append(([plan.robot for plan in plans], len(outside)))
        return plans

    replan_outside = neighbourhood._replan
    monkeypatch.setattr(neighbourhood, "_replan", replan)
    solution = carp_reference.add(five, committed, "r4", 0, Neighbourhood(m=4, baseline=False))
    assert rounds == [(["r1"], 3), (["r1", "r3"], 2), (["r3"], 1)]
    assert judge(five, solution).valid
    assert solution.unplanned == ()


def test_orders_are_drawn_from_the_seed_plus_the_index_of_the_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    seeds: list[int] = []

    def stream(seed: int) -> Iterator[int]:
        seeds.append(seed)
        return splitmix64(seed)

    monkeypatch.setattr(neighbourhood, "splitmix64", stream)
    three = instance(grid(3, 3), ("0,0", "2,0"), ("0,1", "2,1"), ("0,2", "2,2"))
    carp_reference.plan(three, Neighbourhood(m=3, sample=2, seed=40))
    assert seeds == [40, 41, 42]


def test_a_robot_replanned_to_end_now_can_still_be_taken_in() -> None:
    """r0 waits at its goal until 4 and would wander on; replanned behind r1 at tick 1, it vanishes there at 1."""
    graph = ResourceGraph(
        (*(Resource(name, x=90, y=0) for name in "ab"), *(Resource(name, x=0, y=0) for name in "cdef")),
        (("a", "b"), ("c", "d"), ("e", "f")),
    )
    three = instance(graph, ("a", "a"), ("c", "d"), ("e", "f"))
    wandering = plan_of("r0", ("a", 0, 4), ("b", 4, 5), ("a", 5, 6))
    committed = Solution((plan_of("r1", ("c", 0, 2), ("d", 2, 3)), wandering), ("r1", "r0"), ())
    solution = carp_reference.add(three, committed, "r2", 1, Neighbourhood(m=3, baseline=False))
    assert solution.plans[0] == plan_of("r0", ("a", 0, 1))
    assert solution.order == ("r0", "r2", "r1")


def test_a_round_with_a_robot_without_plan_has_no_candidate_though_the_orders_have_plans() -> None:
    ends = (("3,1", "3,0"), ("1,1", "0,1"), ("0,1", "2,1"), ("3,0", "3,1"), ("2,1", "0,0"))
    five = instance(grid(4, 2), *ends, after_goal="park")
    committed = carp_reference.plan(Instance(five.graph, five.robots[:4], "park"), Carp())
    assert committed.unplanned == ()
    solution = carp_reference.add(five, committed, "r4", 0, Neighbourhood(m=2, baseline=False))
    assert solution == Solution(committed.plans, committed.order, ("r4",))
