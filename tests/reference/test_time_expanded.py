"""The naive twin: hand-made cases and its limit; that it agrees with the query, test_twins holds."""

import pytest
from tests.spec.making import instance, line, plan_of

from carp_reference import plan, time_expanded
from carp_reference.time_expanded import find_plan_by_ticks
from carp_spec import Instance, Refusal, ResourceGraph, Robot, TimeExpanded


def test_a_table_that_memory_should_not_hold_is_refused() -> None:
    two = instance(line("abc"), ("b", "b"), ("a", "c"))
    with pytest.raises(Refusal, match="the committed plans occupy 10000000 ticks") as refused:
        find_plan_by_ticks(two, (plan_of("r0", ("b", 0, 10_000_000)),), "r1")
    assert (refused.value.kind, refused.value.rule) == ("limit", "limit/ticks")


@pytest.mark.parametrize("graph", [line("abc", a=10**9), line("abc", b=10**9)])
def test_a_way_of_more_ticks_than_it_holds_is_refused(graph: ResourceGraph) -> None:
    one = instance(graph, ("a", "a"))
    with pytest.raises(Refusal, match=r"robot r0 may be under way for 100000000\d ticks"):
        find_plan_by_ticks(one, (), "r0")


def test_a_robot_whose_start_is_not_free_has_no_plan_and_the_rest_goes_on() -> None:
    three = instance(line("abc"), ("a", "a"), ("a", "c"), ("c", "b"))
    assert plan(three, TimeExpanded()).unplanned == ("r1",)


def test_a_late_release_is_no_long_way() -> None:
    late = Instance(line("ab"), (Robot("r0", "a", "b", release=10**9),))
    assert find_plan_by_ticks(late, (), "r0") == plan_of("r0", ("a", 10**9, 10**9 + 1), ("b", 10**9 + 1, 10**9 + 2))


def test_what_it_holds_is_counted_to_the_tick(monkeypatch: pytest.MonkeyPatch) -> None:
    two = instance(line("abc"), ("a", "b"), ("c", "c"), after_goal="park")
    parked = plan_of("r0", ("a", 0, 4), ("b", 4, None))
    for most, refused in ((4, True), (5, False)):
        monkeypatch.setattr(time_expanded, "LARGEST_TABLE", most)
        if refused:
            with pytest.raises(Refusal, match="the committed plans occupy 5 ticks"):
                time_expanded.table_of(two, (parked,))
        else:
            assert time_expanded.table_of(two, (parked,)).still == 4
