"""Polishing, as it is to be read: it repairs, improves, and never makes a solution worse."""

from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.spec.making import instance_on, line, worth

from carp_reference import polish
from carp_spec import Robot, Solution, judge
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances


@settings(max_examples=draws(300))
@given(planned_instances(Sizes(resources=8, robots=8)), st.integers(0, 15), st.integers(0, 2**64 - 1))
def test_a_polished_solution_breaks_no_rule_and_is_no_worse(
    planned: PlannedInstance, iterations: int, seed: int
) -> None:
    polished = polish(planned.instance, planned.solution, iterations=iterations, seed=seed)
    assert judge(planned.instance, polished).valid
    assert worth(planned.instance, polished) <= worth(planned.instance, planned.solution)


def test_robots_without_a_plan_are_given_one_and_improved() -> None:
    instance = grid_instance(Grid(5, 5, map=15), Fleet(robots=10, seed=4))
    nobody = Solution((), (), tuple(robot.id for robot in instance.robots))
    reported: list[tuple[int, int, int]] = []
    polished = polish(instance, nobody, iterations=120, advance=lambda *each: reported.append(each))
    assert judge(instance, polished).valid
    assert not polished.unplanned
    assert reported[-1][1:] == worth(instance, polished)
    worths = [each[1:] for each in reported]
    assert worths == sorted(worths, reverse=True)


def test_it_ends_where_nothing_can_be_improved() -> None:
    instance = grid_instance(Grid(4, 4), Fleet(robots=1))
    (robot,) = instance.robots
    reported: list[int] = []
    polished = polish(
        instance, Solution((), (), (robot.id,)), seconds=1e6, advance=lambda turn, *_: reported.append(turn)
    )
    assert (reported, polished.unplanned) == ([1], ())


def test_a_robot_without_a_way_stays_unplanned() -> None:
    instance = instance_on(line("ab", directed=True), Robot("r", "b", "a"))
    nobody = Solution((), (), ("r",))
    assert polish(instance, nobody, iterations=3) == nobody
