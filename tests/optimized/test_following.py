"""Where following is forbidden, both engines make the same plans, and these leave a free tick."""

from dataclasses import replace

import pytest
from tests.twin import find_plan_by_ticks

import carp_optimized
import carp_reference
from carp_optimized import Reuse
from carp_spec import Carp, Instance, Solution, check_update, judge, plan_cost, violations_of
from carp_spec.permutations import splitmix64
from carproof.testing.random_instances import Draw, draw_instance, draw_neighbourhood, draw_planner

QUESTIONS = range(150)
REUSES = (Reuse(), Reuse(kept=False, unchanged=False, prefixes=False, shared=False, bounds=False))


def question(number: int) -> tuple[Draw, Instance]:
    draw = Draw(splitmix64(number))
    return draw, replace(draw_instance(draw), following="forbidden")


def all_but_last(instance: Instance, order: Solution) -> Solution:
    """The plans without that of the instance's last robot, which is not named."""
    last = instance.robots[-1].id
    plans = tuple(plan for plan in order.plans if plan.robot != last)
    return Solution(
        plans, tuple(plan.robot for plan in plans), tuple(robot for robot in order.unplanned if robot != last)
    )


@pytest.mark.parametrize("reuse", REUSES, ids=["reuse", "no reuse"])
def test_the_engines_plan_alike_and_lawfully(reuse: Reuse) -> None:
    for number in QUESTIONS:
        draw, instance = question(number)
        planner = draw_planner(draw)
        solution = carp_reference.plan(instance, planner)
        assert judge(instance, solution).valid
        assert carp_optimized.plan(instance, planner, reuse=reuse) == solution, number


def test_the_engines_ask_and_add_alike_to_a_fleet_under_way() -> None:
    for number in QUESTIONS:
        draw, instance = question(number)
        before = all_but_last(instance, carp_reference.plan(instance, Carp()))
        new, now, options = instance.robots[-1].id, draw.between(0, 6), draw_neighbourhood(draw)
        added = carp_reference.add(instance, before, new, now, options)
        assert carp_optimized.add(instance, before, new, now, options) == added, number
        assert not violations_of(instance, added.plans)
        assert not check_update(before.plans, added.plans, now)
        for robot in instance.robot:
            asked = (instance, before.plans, robot, now)
            assert carp_optimized.query(*asked) == carp_reference.query(*asked)


def test_the_engines_polish_alike() -> None:
    for number in range(30):
        _, instance = question(number)
        solution = carp_reference.plan(instance, Carp())
        polished = carp_reference.polish(instance, solution, iterations=20, seed=number)
        assert judge(instance, polished).valid
        assert carp_optimized.polish(instance, solution, iterations=20, seed=number) == polished, number


def test_a_query_arrives_as_early_as_its_naive_twin() -> None:
    for number in QUESTIONS:
        draw, instance = question(number)
        committed = all_but_last(instance, carp_reference.plan(instance, Carp())).plans
        robot = draw.one_of(instance.robots).id
        now = draw.between(0, 6)
        before = next((plan for plan in committed if plan.robot == robot), None)
        others = [plan for plan in committed if plan.robot != robot]
        found = carp_reference.query(instance, committed, robot, now)
        twin = find_plan_by_ticks(instance, others, robot, now, before)
        assert (found is None) == (twin is None)
        if found is not None and twin is not None:
            assert plan_cost(instance, found) == plan_cost(instance, twin)
            assert not violations_of(instance, [*others, twin])
