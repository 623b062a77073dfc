"""Branching over first moves finds the least total of a crowd, and refutes each total below it."""

import itertools

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_optimum.branching.branching import Branching, is_crowded
from carp_optimum.sat.core_guided import core_guided
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot, judge
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.proof import solution_of
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

SECONDS = 60


def nothing() -> None:
    """Look at no clock."""


def searched(instance: Instance, most: int, half: int | None = None) -> Branching:
    """The search at its end; its plans must be lawful, and cost as it says."""
    search = Branching(instance, most, nothing, half)
    works = list(search.run())
    assert all(work <= later for work, later in itertools.pairwise([*works, search.work]))
    if search.plans is None:
        assert search.least == most + 1
    else:
        verdict = judge(instance, solution_of(list(search.plans)))
        assert (verdict.violations, verdict.unplanned, verdict.cost) == ((), 0, search.least)
    return search


@st.composite
def crowds(draw: st.DrawFn) -> Instance:
    """Two to four robots on four or five resources, with moves that may lead one way only."""
    ids = "abcde"[: draw(st.integers(4, 5))]
    moves = draw(st.lists(st.sampled_from(list(itertools.permutations(ids, 2))), min_size=4, unique=True))
    graph = ResourceGraph(tuple(map(Resource, ids)), tuple(moves), directed=True)
    starts = draw(st.permutations(ids))
    goals = draw(st.lists(st.sampled_from(ids), min_size=2, max_size=4))
    return Instance(graph, tuple(Robot(number, starts[number], goal) for number, goal in enumerate(goals)), "vanish")


def directed(moves: str, *ends: str) -> Instance:
    """Robots with these starts and goals, on resources a to d with these moves."""
    graph = ResourceGraph(
        tuple(map(Resource, "abcd")), tuple((move[0], move[1]) for move in moves.split()), directed=True
    )
    robots = (Robot(number, start_and_goal[0], start_and_goal[1]) for number, start_and_goal in enumerate(ends))
    return Instance(graph, tuple(robots), "vanish")


def searched_by_halves(instance: Instance, most: int) -> int:
    """The least total of the two halves, if it is at most this, or one more than this."""
    return min(searched(instance, most, half).least for half in (0, 1))


@settings(max_examples=draws(600))
@given(crowds(), st.sampled_from([1, 3, 75]), st.sampled_from([1, 2, 5]))
@example(directed("ab ac ad ba bc bd ca", "ba", "ca"), 1, 1)  # a robot may be gone
@example(directed("dc ab ac ad cb", "dc", "cb", "ab"), 1, 1)  # dear nodes leave each robot one way
@example(directed("ab ac ad ba bc bd ca", "ab", "ba", "cb"), 1, 1)  # where all is tried, no robot has a choice left
@example(directed("ab ac ad ba bc bd ca cb cd da db dc", "bd", "ab", "cb", "db"), 75, 2)  # a third part is the best
def test_the_cheapest_plans_are_found_and_no_cheaper_ones(instance: Instance, steps: int, parts: int) -> None:
    """With few steps the bounds are weak, so that there is much to split."""
    if Encoding(instance).wayless:
        return
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("carp_optimum.branching.branching.FIRST_STEPS", steps)
        patched.setattr("carp_optimum.branching.branching.STEPS", steps)
        patched.setattr("carp_optimum.branching.branching.PARTS_TO_SHARE", parts)
        _the_optimum_is_found(instance)


def _the_optimum_is_found(instance: Instance) -> None:
    least = least_total_cost(instance)
    if least is None:
        assert searched(instance, 20).plans is None
        return
    assert searched(instance, least).least == least
    assert searched(instance, least + 3).least == least
    assert searched_by_halves(instance, least + 3) == least
    assert searched_by_halves(instance, least - 1) == least
    refuted = searched(instance, least - 1)
    assert (refuted.plans, refuted.least) == (None, least)


@pytest.mark.parametrize("seed", range(4))
def test_a_full_grid_is_searched_as_far_as_its_optimum(seed: int) -> None:
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, seed))
    least = core_guided(instance, SECONDS).cost
    assert least is not None
    assert searched(instance, least + 1).least == searched_by_halves(instance, least + 1) == least
    assert searched(instance, least - 1).plans is None
    assert searched_by_halves(instance, least - 1) == least


def test_the_bound_of_all_parts_together_is_below_the_optimum_and_above_the_shortest_paths() -> None:
    instance = grid_instance(Grid(4, 4, 20), Fleet(16, 2))
    least = core_guided(instance, SECONDS)
    assert least.cost is not None
    assert least.shortest is not None
    assert least.shortest + 2 < Branching(instance, least.cost + 5, nothing).least_of_all() <= least.cost
    assert Branching(instance, least.shortest, nothing).least_of_all() == least.shortest + 1


def test_crowds_are_robots_that_vanish_and_stand_on_most_resources() -> None:
    assert is_crowded(grid_instance(Grid(6, 6, 20), Fleet(25, 0)))
    assert not is_crowded(grid_instance(Grid(6, 6, 20), Fleet(24, 0)))
    assert not is_crowded(grid_instance(Grid(6, 6, 20), Fleet(30, 0, "park")))
    assert not is_crowded(grid_instance(Grid(4, 4, 20), Fleet(16, 0), Traits(duration=Range(2, 2))))


def test_tables_that_would_be_too_large_are_refused() -> None:
    with pytest.raises(Refusal, match="robots times ticks times resources must be at most"):
        Branching(grid_instance(Grid(10, 10, 20), Fleet(100, 0)), 1000, nothing)
