"""Robots together: who is blamed, where and when."""

import tracemalloc
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from typing import TypeAlias

import pytest
from tests.spec.making import Stay, instance_on, line, plan_of

from carp_spec import Group, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Violation, Visit, violations_of
from carp_spec.joint_rules import capacity_is_kept, exchanges_are_avoided, solution_covers_robots, solution_orders_plans

NAMES = ("r1", "r2", "r3", "r4")
ROW = instance_on(line("ab"), *(Robot(name, "a", "b") for name in NAMES))
Stays: TypeAlias = tuple[str, *tuple[Stay, ...]]
WIDE = Instance(ResourceGraph((Resource("a", capacity=2),), ()), ROW.robots)


def crowd(start: int, end: int | None, *robots: str, capacity: int = 1, resource: str = "a") -> Violation:
    return Violation("joint/capacity", robots, resource, start, end, f"capacity {capacity}")


@pytest.mark.parametrize(
    ("plans", "crowds"),
    [
        # robots that change places at a tick keep a crowd up
        ([("r1", ("a", 0, 9)), ("r2", ("a", 1, 4)), ("r3", ("a", 4, 6))], [crowd(1, 6, "r1", "r2", "r3")]),
        # it names nobody who left before it began or came after it ended
        (
            [("r1", ("a", 0, 2), ("a", 8, 9)), ("r2", ("a", 2, 5)), ("r3", ("a", 3, 5)), ("r4", ("a", 8, 9))],
            [crowd(3, 5, "r2", "r3"), crowd(8, 9, "r1", "r4")],
        ),
        ([("r1", ("a", 3, None)), ("r2", ("a", 5, None))], [crowd(5, None, "r1", "r2")]),
        # who leaves at a tick makes room for who enters at it
        ([("r1", ("a", 0, 5)), ("r2", ("a", 5, 9))], []),
        # a visit of no ticks takes no room, and is no part of a crowd
        ([("r1", ("a", 0, 9)), ("r2", ("a", 5, 5)), ("r3", ("a", 7, 3))], []),
        ([("r1", ("a", 0, 9)), ("r2", ("a", 5, 5)), ("r3", ("a", 1, 9))], [crowd(1, 9, "r1", "r3")]),
        # crowds come in the order of the resources
        (
            [(name, ("b", 0, 1), ("a", 1, 2)) for name in ("r1", "r2")],
            [crowd(1, 2, "r1", "r2"), crowd(0, 1, "r1", "r2", resource="b")],
        ),
    ],
)
def test_a_crowd_is_one_violation_from_when_it_begins_until_it_ends(
    plans: Sequence[Stays], crowds: list[Violation]
) -> None:
    assert list(capacity_is_kept(ROW, [plan_of(robot, *stays) for robot, *stays in plans])) == crowds


def test_capacity_counts_robots_and_not_visits() -> None:
    plans = [plan_of("r1", ("a", 0, 5), ("a", 2, 4)), plan_of("r2", ("a", 3, 9)), plan_of("r3", ("a", 1, 9))]
    assert list(capacity_is_kept(WIDE, plans[:2])) == []
    assert list(capacity_is_kept(WIDE, plans)) == [crowd(3, 5, "r1", "r2", "r3", capacity=2)]


def test_an_exchange_names_all_who_take_part_and_comes_in_order_of_time() -> None:
    plans = [
        plan_of("r2", ("b", 0, 9), ("a", 9, 10)),
        plan_of("r1", ("a", 8, 9), ("b", 9, 10), ("a", 10, 11)),
        plan_of("r3", ("a", 2, 9), ("b", 9, 12)),
        plan_of("r4", ("a", 9, 10), ("b", 10, 12)),
    ]
    assert list(exchanges_are_avoided(ROW, plans)) == [
        Violation("joint/exchange", ("r1", "r3", "r2"), "a", 9, 10, "they exchange a and b at tick 9"),
        Violation("joint/exchange", ("r4", "r1"), "a", 10, 11, "they exchange a and b at tick 10"),
    ]


def test_exchanges_at_one_tick_come_in_the_order_of_the_resources() -> None:
    ends = [("b", "c"), ("c", "b"), ("d", "a"), ("a", "d"), ("a", "c"), ("c", "a")]
    names = [f"r{at}" for at in range(len(ends))]
    instance = instance_on(line("abcd"), *(Robot(name, "a", "b") for name in names))
    moves = zip(names, ends, strict=True)
    plans = [plan_of(name, (source, 0, 1), (target, 1, 2)) for name, (source, target) in moves]
    assert [each.reason for each in exchanges_are_avoided(instance, plans)] == [
        "they exchange a and c at tick 1",
        "they exchange a and d at tick 1",
        "they exchange b and c at tick 1",
    ]


@pytest.mark.parametrize(("there", "back"), [("ax", "xa"), ("bb", "bb")], ids=["nowhere", "staying on"])
def test_moves_to_nowhere_and_second_visits_are_no_exchange(there: str, back: str) -> None:
    ends = zip(("r1", "r2"), (there, back), strict=True)
    plans = [plan_of(robot, (way[0], 0, 1), (way[1], 1, 2)) for robot, way in ends]
    assert list(exchanges_are_avoided(ROW, plans)) == []


def told(instance: Instance, *plans: Plan) -> list[str]:
    """What the checker says of the plans together."""
    return [str(each) for each in violations_of(instance, plans) if each.rule.startswith("joint/")]


def grouped(*groups: Group, names: str = "abcde") -> Instance:
    graph = line(names)
    roomy = tuple(replace(each, capacity=4) for each in graph.resources)
    return replace(ROW, graph=replace(graph, resources=roomy, groups=groups))


def test_a_crowd_of_a_group_is_blamed_on_the_place_at_which_it_begins() -> None:
    instance = grouped(Group("all", ("c", "a", "b")))
    plans = [plan_of("r1", ("a", 0, 6), ("c", 6, 7)), plan_of("r2", ("b", 2, 4), ("d", 4, 5))]
    assert told(instance, *plans) == [
        "[joint/group] resource b in [2,4): robots r1, r2 (capacity 1 of group all)",
    ]


def test_the_name_of_a_group_is_told_unless_it_is_that_of_its_resource() -> None:
    plans = [plan_of("r1", ("b", 0, 6)), plan_of("r2", ("b", 2, 4))]
    for name in "acz":
        (said,) = told(grouped(Group(name, ("b",))), *plans)
        assert said.endswith(f"(capacity 1 of group {name})")


def test_moves_between_close_resources_are_an_exchange() -> None:
    """The two move into each other's group; d is in a group of two, and so is close to itself alone."""
    instance = grouped(Group("left", ("a", "b")), Group("right", ("c",)), Group("wide", ("c", "d"), 2))
    into, out_of = plan_of("r2", ("a", 0, 3), ("c", 3, 4)), plan_of("r1", ("c", 0, 3), ("b", 3, 4))
    assert told(instance, into, out_of)[-1] == (
        "[joint/exchange] resource a in [3,4): robots r2, r1 (they exchange ('a', 'c') and ('c', 'b') at tick 3)"
    )
    assert told(instance, into, plan_of("r1", ("c", 0, 4), ("b", 4, 5)))[1:] == []
    assert told(instance, into, plan_of("r1", ("d", 0, 3), ("b", 3, 4))) == []


def test_a_move_that_comes_close_but_from_elsewhere_is_no_exchange() -> None:
    """Two robots leave the groups that the first one enters: one robot enters its own group, so that is looked at."""
    moves = (("r", "s"), ("t", "q"), ("m", "u"), ("n", "v"))
    groups = (Group("R", ("r", "q"), 1), Group("M", ("s", "m"), 1), Group("N", ("s", "n"), 1))
    resources = tuple(Resource(each) for move in moves for each in move)
    robots = tuple(Robot(name, *move) for name, move in zip(NAMES, moves, strict=True))
    instance = Instance(ResourceGraph(resources, moves, groups=groups), robots)
    plans = [plan_of(name, (start, 0, 1), (goal, 1, 2)) for name, (start, goal) in zip(NAMES, moves, strict=True)]
    assert violations_of(instance, plans) == ()


def test_an_exchange_is_told_as_that_of_two_resources_where_it_is_one() -> None:
    instance = grouped(Group("left", ("a", "b")))
    for there, back, said in (
        ("ac", "ca", "a and c"),
        ("ac", "cb", "('a', 'c') and ('c', 'b')"),
        ("bc", "ca", "('b', 'c') and ('c', 'a')"),
    ):
        ends = zip(("r1", "r2"), (there, back), strict=True)
        plans = [plan_of(robot, (way[0], 0, 3), (way[1], 3, 4)) for robot, way in ends]
        assert [each.split(" (", 1)[1] for each in told(instance, *plans)] == [f"they exchange {said} at tick 3)"]


def test_two_robots_that_make_a_move_within_a_group_exchange() -> None:
    instance = grouped(Group("left", ("a", "b")))
    same = [plan_of(name, ("a", 0, 3), ("b", 3, 4)) for name in ("r2", "r1")]
    assert told(instance, *same) == [
        "[joint/group] resource a in [0,4): robots r1, r2 (capacity 1 of group left)",
        "[joint/exchange] resource a in [3,4): robots r2, r1 (they exchange ('a', 'b') and ('a', 'b') at tick 3)",
    ]
    assert told(instance, same[0]) == []


def test_where_following_is_forbidden_a_robot_enters_after_a_free_tick() -> None:
    instance = replace(ROW, following="forbidden")
    before = plan_of("r1", ("a", 0, 3), ("b", 3, 4))
    assert told(instance, before, plan_of("r2", ("a", 4, 5))) == []
    assert told(instance, before, plan_of("r2", ("a", 3, 4))) == [
        "[joint/following] resource a in [3,4): robots r1, r2 (capacity 1, with a free tick after each robot)"
    ]
    assert told(ROW, before, plan_of("r2", ("a", 3, 4))) == []


def test_a_solution_is_told_what_it_names_too_often_and_too_rarely() -> None:
    plans = tuple(plan_of(name) for name in ("r2", "r2", "r1", "r9"))
    solution = Solution(plans, ("r3", "r2", "r2", "r1"), ("r1", "r8"))
    assert [str(violation) for violation in solution_covers_robots(ROW, solution)] == [
        "[solution/covers] robot r1 (it must have one plan or be unplanned once, and has 1 and 1)",
        "[solution/covers] robot r2 (it must have one plan or be unplanned once, and has 2 and 0)",
        "[solution/covers] robot r3 (it must have one plan or be unplanned once, and has 0 and 0)",
        "[solution/covers] robot r4 (it must have one plan or be unplanned once, and has 0 and 0)",
        "[solution/covers] robot r9 (the instance has no such robot)",
        "[solution/covers] robot r8 (the instance has no such robot)",
    ]
    assert [str(violation) for violation in solution_orders_plans(ROW, solution)] == [
        "[solution/order] robot r2 (the order must name it once, and names it 2 times)",
        "[solution/order] robot r9 (the order must name it once, and names it 0 times)",
        "[solution/order] robot r3 (the order must name it never, and names it 1 times)",
    ]


def test_the_first_exchange_between_groups_is_found_without_all_others() -> None:
    many = 300
    ids = range(2 * many)
    groups = (Group("left", tuple(ids[:many])), Group("right", tuple(ids[many:])))
    graph = ResourceGraph(tuple(map(Resource, ids)), (), groups=groups)
    plans = [Plan(each, (Visit(each, 0, 1), Visit((each + many) % (2 * many), 1, 2))) for each in ids]
    crowd = Instance(graph, tuple(Robot(each, each, each) for each in ids))
    tracemalloc.start()
    found = [*islice(exchanges_are_avoided(crowd, plans), 3)]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000
    assert [each.robots for each in found] == [(0, many), (0, many + 1), (0, many + 2)]


def test_groups_by_groups_take_no_memory() -> None:
    """Each of two resources is alone in many groups of capacity 1."""
    groups = tuple(Group(f"{each}{number}", (each,)) for each in "ab" for number in range(500))
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), groups=groups)
    instance = Instance(graph, tuple(Robot(number, "a", "b", release=2 * number) for number in range(4)))
    ticks = [robot.release for robot in instance.robots]
    plans = [
        Plan(robot, (Visit("a", tick, tick + 1), Visit("b", tick + 1, tick + 2))) for robot, tick in enumerate(ticks)
    ]
    tracemalloc.start()
    assert violations_of(instance, plans) == ()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000
