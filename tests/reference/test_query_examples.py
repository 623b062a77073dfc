"""The CARP query on instances small enough to work out by hand."""

from tests.spec.making import grid, instance, line, plan_of

import carp_reference
from carp_reference import query
from carp_spec import Carp, Instance, Resource, ResourceGraph


def test_a_query_is_made_at_tick_0_unless_it_says_when() -> None:
    one = instance(line("abc"), ("b", "c"))
    wrong_way = plan_of("r0", ("b", 0, 1), ("a", 1, 2), ("b", 2, 3), ("c", 3, 4))
    assert query(one, (wrong_way,), "r0") == plan_of("r0", ("b", 0, 1), ("c", 1, 2))
    assert query(one, (wrong_way,), "r0", now=1) == wrong_way


def test_a_robot_whose_plan_has_ended_keeps_it() -> None:
    one = instance(line("ab"), ("a", "b"))
    late = plan_of("r0", ("a", 0, 3), ("b", 3, 4))
    assert query(one, (late,), "r0", now=4) == late
    assert query(one, (late,), "r0", now=2) == plan_of("r0", ("a", 0, 2), ("b", 2, 3))


def test_a_robot_vanishes_at_its_goal_if_its_duration_there_is_not_over() -> None:
    one = instance(line("ab", a=3), ("a", "a"))
    wandering = plan_of("r0", ("a", 0, 5), ("b", 5, 6), ("a", 6, 9))
    for now in (2, 3):
        assert query(one, (wandering,), "r0", now=now) == plan_of("r0", ("a", 0, 3))


def test_a_history_that_a_committed_plan_contradicts_leaves_no_plan() -> None:
    two = instance(line("abc"), ("a", "c"), ("b", "a"))
    before = plan_of("r0", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))
    against = plan_of("r1", ("b", 0, 1), ("a", 1, 2))
    assert query(two, (before, against), "r0", now=1) is None


def test_equal_arrivals_go_by_the_order_of_the_resources() -> None:
    square = ResourceGraph(tuple(map(Resource, "axyb")), (("a", "y"), ("a", "x"), ("x", "b"), ("y", "b")))
    found = query(instance(square, ("a", "b")), (), "r0")
    assert found is not None
    assert [visit.resource for visit in found.visits] == ["a", "x", "b"]


def test_equal_arrivals_go_by_f_before_all() -> None:
    """Round by the free cells, r1 would arrive at 4 too; waiting for r0 to vanish has the smaller f."""
    two = instance(grid(2, 3), ("0,0", "1,1"), ("1,2", "1,0"))
    committed = carp_reference.plan(Instance(two.graph, two.robots[:1]), Carp()).plans
    assert query(two, committed, "r1") == plan_of("r1", ("1,2", 0, 3), ("1,1", 3, 4), ("1,0", 4, 5))
