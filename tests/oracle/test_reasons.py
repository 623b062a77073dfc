"""Why a robot is unplanned."""

from tests.spec.making import instance, line, plan_of

from carp_spec import Resource, ResourceGraph
from carproof.judging.unplanned import why_unplanned


def test_a_goal_that_no_moves_lead_to() -> None:
    split = instance(ResourceGraph((Resource("a"), Resource("b")), ()), ("a", "b"))
    assert why_unplanned(split, (), "r0") == "no moves lead from its start a to its goal b"


def test_a_start_that_is_taken() -> None:
    two = instance(line("abc"), ("a", "a"), ("a", "c"))
    reason = why_unplanned(two, (plan_of("r0", ("a", 0, 1)),), "r1")
    assert reason == "its start a is taken in [0,1), from its release on"


def test_a_goal_that_is_taken_for_ever() -> None:
    two = instance(line("abc"), ("b", "b"), ("a", "b"), after_goal="park")
    assert why_unplanned(two, (plan_of("r0", ("b", 0, None)),), "r1") == "its goal b is taken for ever"


def test_a_goal_that_is_taken_for_ever_after_a_while() -> None:
    two = instance(line("abc"), ("c", "b"), ("a", "b"), after_goal="park")
    reason = why_unplanned(two, (plan_of("r0", ("c", 0, 1), ("b", 1, None)),), "r1")
    assert reason == "its goal b is taken for ever"


def test_plans_in_the_way_of_a_goal_that_is_free() -> None:
    two = instance(line("abc"), ("b", "b"), ("a", "c"), after_goal="park")
    reason = why_unplanned(two, (plan_of("r0", ("b", 0, None)),), "r1")
    assert reason == "the committed plans leave no way to its goal"


def test_plans_in_the_way() -> None:
    two = instance(line("abc"), ("c", "a"), ("a", "c"))
    across = plan_of("r0", ("c", 0, 1), ("b", 1, 2), ("a", 2, 3))
    assert why_unplanned(two, (across,), "r1") == "the committed plans leave no way to its goal"
