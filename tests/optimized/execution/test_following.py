"""Where following is forbidden, both engines make the same plans, and these leave a free tick.

That they add robots alike there too is asked in test_arrivals.py.
"""

from dataclasses import replace

from tests.twin import find_plan_by_ticks

import carp_optimized
import carp_reference
from carp_spec import Carp, Instance, judge, plan_cost, violations_of
from carp_spec.permutations import splitmix64
from carproof.testing.random_instances import Draw, draw_instance, draw_planner

QUESTIONS = range(150)


def question(number: int) -> tuple[Draw, Instance]:
    draw = Draw(splitmix64(number))
    return draw, replace(draw_instance(draw), following="forbidden")


def test_the_engines_plan_alike_and_lawfully() -> None:
    for number in QUESTIONS:
        draw, instance = question(number)
        planner = draw_planner(draw)
        solution = carp_reference.plan(instance, planner)
        assert judge(instance, solution).valid
        assert carp_optimized.plan(instance, planner) == solution, number


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
        last = instance.robots[-1].id
        committed = [plan for plan in carp_reference.plan(instance, Carp()).plans if plan.robot != last]
        robot = draw.one_of(instance.robots).id
        now = draw.between(0, 6)
        before = next((plan for plan in committed if plan.robot == robot), None)
        others = [plan for plan in committed if plan.robot != robot]
        found = carp_reference.query(instance, committed, robot, now)
        assert carp_optimized.query(instance, committed, robot, now) == found
        twin = find_plan_by_ticks(instance, others, robot, now, before)
        assert (found is None) == (twin is None)
        if found is not None and twin is not None:
            assert plan_cost(instance, found) == plan_cost(instance, twin)
            assert not violations_of(instance, [*others, twin])
