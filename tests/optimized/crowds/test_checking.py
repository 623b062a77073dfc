"""Paths of a crowd pass if the law finds no fault in them, and only then."""

from dataclasses import replace
from itertools import pairwise
from random import Random

import pytest
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.checking import require_lawful
from carp_optimized.crowds.stays import Paths, solution_along
from carp_optimized.lacam.search import Search
from carp_spec import AfterGoal, judge


def is_lawful(crowd: object, paths: Paths) -> bool:
    try:
        require_lawful(crowd, paths)  # type: ignore[arg-type]
    except AssertionError:
        return False
    return True


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
@pytest.mark.parametrize("directed", [False, True])
def test_changed_paths_pass_if_they_break_no_rule(after_goal: AfterGoal, directed: bool) -> None:
    instance = on_grid(5, 9, after_goal)
    crowd = measured(instance)
    search = Search(crowd)
    search.go(10_000)
    right = search.paths
    assert right is not None
    assert is_lawful(crowd, right)
    if directed:  # the moves that were made alone
        plans = solution_along(instance, instance.robots, right).plans
        made = dict.fromkeys((at.resource, to.resource) for plan in plans for at, to in pairwise(plan.visits))
        instance = replace(instance, graph=replace(instance.graph, edges=(*made,), directed=True))
        crowd = measured(instance)
        assert is_lawful(crowd, right)
    random, passed = Random(1), set()  # noqa: S311 - a test
    for _ in range(400):
        changed = Paths(*(each.copy() for each in right))
        robot = random.randrange(9)
        visit = random.randrange(int(changed.size[robot]))
        if random.random() < 1 / 3:
            changed.place[robot, visit] = random.randrange(25)
        elif random.random() < 1 / 2:
            changed.enter[robot, visit:] += random.choice([-1, 1])
        else:
            changed.size[robot] = visit
        solution = solution_along(instance, instance.robots, changed)
        passed.add(judge(instance, solution).valid)
        assert is_lawful(crowd, changed) == judge(instance, solution).valid
    assert passed == {False, True}


def test_a_graph_without_moves_has_paths_of_robots_that_stay() -> None:
    instance = on_grid(3, 2)
    still = replace(
        instance,
        graph=replace(instance.graph, edges=()),
        robots=tuple(replace(each, stops=(replace(each.stops[0], resource=each.start),)) for each in instance.robots),
    )
    crowd = measured(still)
    search = Search(crowd)
    search.go(10)
    assert search.paths is not None
    assert is_lawful(crowd, search.paths)
    assert not is_lawful(crowd._replace(goal=crowd.start[::-1].copy()), search.paths)
