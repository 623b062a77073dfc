"""CARP in an order, and the planners that differ from it in the order alone."""

from unittest.mock import Mock

import pytest
from tests.spec.making import grid, instance, line

from carp_reference import orderings, plan
from carp_spec import Carp, Greedy, LongestFirst, Resource, ResourceGraph, Shuffled

SIDING = ResourceGraph(tuple(map(Resource, "abcde")), (("a", "b"), ("b", "c"), ("c", "d"), ("b", "e")))


def test_a_robot_without_a_plan_is_left_out_and_the_rest_goes_on() -> None:
    three = instance(line("abc"), ("a", "a"), ("a", "c"), ("c", "b"))
    solution = plan(three, Carp())
    assert (solution.order, solution.unplanned) == (("r0", "r2"), ("r1",))


def test_shuffled_finds_the_order_that_plans_every_robot() -> None:
    two = instance(SIDING, ("b", "c"), ("a", "d"), after_goal="park")
    assert plan(two, Shuffled(attempts=1)).unplanned == ("r1",)
    assert plan(two, Shuffled(attempts=10)).order == ("r1", "r0")


def test_shuffled_keeps_the_first_of_equally_good_passes() -> None:
    rows = [(f"0,{row}", f"1,{row}") for row in range(5)]
    for attempts in (2, 3, 4):
        assert plan(instance(grid(2, 5), *rows), Shuffled(attempts=attempts)).order == ("r0", "r1", "r2", "r3", "r4")


def test_shuffled_makes_as_many_passes_as_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    carp = Mock(return_value=())
    monkeypatch.setattr(orderings, "carp", carp)
    plan(instance(line("ab"), ("a", "b")), Shuffled(attempts=3))
    assert carp.call_count == 3


def test_longest_first_plans_the_longest_way_first_and_the_earlier_of_equals() -> None:
    four = instance(grid(4, 4), ("0,0", "1,0"), ("0,1", "3,1"), ("0,2", "1,2"), ("0,3", "3,3"))
    assert plan(four, LongestFirst()).order == ("r1", "r3", "r0", "r2")


def test_greedy_plans_the_cheapest_of_each_round() -> None:
    four = instance(grid(4, 4), ("0,0", "3,0"), ("0,1", "1,1"), ("0,2", "2,2"), ("0,3", "1,3"))
    assert plan(four, Greedy()).order == ("r1", "r3", "r2", "r0")
    three = instance(line("abc"), ("a", "a"), ("a", "c"), ("c", "b"))
    assert plan(three, Greedy()).unplanned == ("r1",)
