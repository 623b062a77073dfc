"""The CARP query on instances small enough to work out by hand."""

import pytest
from tests.spec.making import grid, instance, line, plan_of

import carp_reference
from carp_reference import query
from carp_spec import AfterGoal, Carp, Instance, Plan, Resource, ResourceGraph, Robot


def test_a_lone_robot_takes_the_shortest_path() -> None:
    assert query(instance(line("abc"), ("a", "c")), (), "r0") == plan_of("r0", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))


def test_durations_and_pace_stretch_the_visits() -> None:
    slow = Instance(line("abc", b=3), (Robot("r0", "a", "c", release=5, pace=2),))
    assert query(slow, (), "r0") == plan_of("r0", ("a", 5, 7), ("b", 7, 13), ("c", 13, 15))


def test_a_robot_follows_another_without_a_gap() -> None:
    two = instance(line("abcd"), ("b", "d"), ("a", "c"))
    ahead = plan_of("r0", ("b", 0, 1), ("c", 1, 2), ("d", 2, 3))
    assert query(two, (ahead,), "r1") == plan_of("r1", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))


@pytest.mark.parametrize("capacity", [1, 2])
def test_a_robot_lets_another_pass_rather_than_exchange_with_it(capacity: int) -> None:
    graph = ResourceGraph(tuple(Resource(name, capacity) for name in "ab"), (("a", "b"),))
    two = instance(graph, ("b", "a"), ("a", "b"))
    other = plan_of("r0", ("b", 0, 1), ("a", 1, 2))
    expected = None if capacity == 1 else plan_of("r1", ("a", 0, 2), ("b", 2, 3))
    assert query(two, (other,), "r1") == expected


@pytest.mark.parametrize(
    ("after_goal", "expected"),
    [("vanish", plan_of("r0", ("a", 0, 1))), ("park", plan_of("r0", ("a", 0, None)))],
)
def test_a_robot_whose_start_is_its_goal_is_there_at_once(after_goal: AfterGoal, expected: Plan) -> None:
    assert query(instance(line("ab"), ("a", "a"), after_goal=after_goal), (), "r0") == expected


def test_a_robot_that_parks_moves_aside_for_a_committed_one_and_comes_back() -> None:
    two = instance(line("abc"), ("b", "b"), ("c", "a"), after_goal="park")
    passing = plan_of("r1", ("c", 0, 2), ("b", 2, 3), ("a", 3, None))
    assert query(two, (passing,), "r0") is None
    star = ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "c"), ("b", "d")))
    aside = instance(star, ("b", "b"), ("c", "a"), after_goal="park")
    assert query(aside, (passing,), "r0") == plan_of("r0", ("b", 0, 1), ("d", 1, 3), ("b", 3, None))


def test_there_is_no_plan_from_a_start_that_is_taken() -> None:
    two = instance(line("ab"), ("a", "a"), ("a", "b"))
    assert query(two, (plan_of("r0", ("a", 0, 1)),), "r1") is None


def test_there_is_no_plan_along_a_one_way_move_backwards() -> None:
    one_way = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), directed=True)
    assert query(instance(one_way, ("b", "a")), (), "r0") is None


def test_a_window_one_tick_too_short_is_not_used() -> None:
    three = instance(line("abc", b=2), ("b", "b"), ("c", "b"), ("a", "c"))
    first = plan_of("r0", ("b", 0, 2))
    later = plan_of("r1", ("c", 0, 3), ("b", 3, 5))
    assert query(three, (first, later), "r2") == plan_of("r2", ("a", 0, 5), ("b", 5, 7), ("c", 7, 8))


def test_a_robot_under_way_keeps_what_it_has_done() -> None:
    two = instance(line("abcd"), ("a", "d"), ("b", "d"))
    before = plan_of("r0", ("a", 0, 1), ("b", 1, 4), ("c", 4, 5), ("d", 5, 6))
    assert query(two, (before,), "r0", now=2) == plan_of("r0", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3), ("d", 3, 4))


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


def test_a_robot_that_stayed_at_its_goal_too_long_to_vanish_there_comes_back_to_it() -> None:
    one = instance(line("ab"), ("a", "a"))
    wandering = plan_of("r0", ("a", 0, 4), ("b", 4, 5), ("a", 5, 6))
    assert query(one, (wandering,), "r0", now=2) == plan_of("r0", ("a", 0, 2), ("b", 2, 3), ("a", 3, 4))


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


def test_a_robot_added_after_its_release_has_been_standing_at_its_start() -> None:
    one = instance(line("ab"), ("a", "b"))
    assert query(one, (), "r0", now=3) == plan_of("r0", ("a", 0, 3), ("b", 3, 4))


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


def test_a_certifier_gives_the_plan_of_a_query() -> None:
    two = instance(line("abc"), ("b", "b"), ("a", "c"))
    committed = (plan_of("r0", ("b", 0, 2)),)
    certifier = carp_reference.certifier(two)
    certifier.commit(committed)
    assert certifier.certify("r1")[0] == carp_reference.find(two, committed, "r1")
