"""The rules of a query, asked of the readable planner against every rival on a short line."""

from collections.abc import Iterator
from itertools import combinations, pairwise, product

import pytest
from tests.spec.making import Stay, instance_on, line, plan_of

import carp_reference
from carp_spec import AfterGoal, Instance, Plan, Robot
from carp_spec.query_rules import absence_is_true, plan_is_optimal, plan_is_sound

LATEST = 6
NAMES = "abc"


def rivals(robot: Robot, after_goal: AfterGoal) -> Iterator[Plan]:
    """Every plan on the line, right or wrong, that enters at most five resources, the last by the tick LATEST."""
    for length in range(1, 6):
        for names in product(NAMES, repeat=length):
            if names[0] == robot.start and all(abs(ord(one) - ord(two)) == 1 for one, two in pairwise(names)):
                for enters in combinations(range(LATEST + 1), length):
                    leave = None if after_goal == "park" else enters[-1] + 1
                    yield plan_of(robot.id, *zip(names, enters, [*enters[1:], leave], strict=True))


def committed_plan(id: str, after_goal: AfterGoal, *stays: Stay) -> tuple[Robot, Plan]:
    """A correct plan, and the robot for which it is correct."""
    name, enter, leave = stays[-1]
    last = (name, enter, None if after_goal == "park" else leave)
    return Robot(id, stays[0][0], name, stays[0][1]), plan_of(id, *stays[:-1], last)


@pytest.mark.parametrize("after_goal", ["vanish", "park"])
@pytest.mark.parametrize(
    "committed",
    [
        [],
        [[("c", 0, 1), ("b", 1, 2), ("a", 2, 3)]],
        [[("b", 0, 4), ("c", 4, 5)]],
        [[("a", 0, 3), ("b", 3, 4)]],
        [[("c", 1, 2)], [("b", 3, 4)]],
        [[("b", 0, 1)]],
    ],
)
def test_the_readable_query_is_sound_optimal_and_complete(committed: list[list[Stay]], after_goal: AfterGoal) -> None:
    others = [committed_plan(f"other{at}", after_goal, *stays) for at, stays in enumerate(committed)]
    plans = [plan for _, plan in others]
    for start, goal in product(NAMES, repeat=2):
        asked = Robot("asked", start, goal)
        instance = instance_on(line(NAMES), *(robot for robot, _ in others), asked, after_goal=after_goal)
        plan = carp_reference.query(instance, plans, "asked")
        if plan is None:
            assert absence_is_true(instance, plans, rivals(asked, after_goal))
        else:
            assert plan_is_sound(instance, plans, plan)
            assert plan_is_optimal(instance, plans, plan, rivals(asked, after_goal))
            assert not absence_is_true(instance, plans, rivals(asked, after_goal))


def test_a_plan_that_arrives_later_than_a_sound_rival_is_not_optimal() -> None:
    asked = Robot("asked", "a", "b")
    instance = Instance(line(NAMES), (asked,))
    late = plan_of("asked", ("a", 0, 2), ("b", 2, 3))
    assert not plan_is_optimal(instance, [], late, rivals(asked, "vanish"))
