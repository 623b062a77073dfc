"""The search for an optimum, and both formulas of a proof, beside the joint search, on thousands of tiny instances."""

import os
from collections.abc import Iterator

import pytest
from tests.verify.optimum.models import has_model, model_of
from tests.verify.optimum.tiny import GROUPED, MIX, STOPPING, case

from carp_optimum.optimum import optimum
from carp_spec import Instance, Solution, judge
from carp_spec.permutations import shuffle
from carp_verify.optimum.encoding import Encoding, Evidence, beat_formula, reach_formula
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.proof import solution_of
from carp_verify.optimum.unsolvable import FullGoal, NoWay, Obstacle, why_no_obstacle
from carproof.testing.random_instances import Draw, Mix

NIGHTLY = os.environ.get("HYPOTHESIS_PROFILE") == "nightly"
CASES = 50_000 if NIGHTLY else 3_000
BLOCK = 250
SECONDS = 60


def mix_of(number: int) -> Mix:
    """Of half of the cases robots have goals alone, with groups in every second block of them."""
    if number // BLOCK % 2:
        return STOPPING
    return GROUPED if number % 8 < 4 else MIX


def faults(number: int, mix: Mix | None = None) -> Iterator[str]:
    """The disagreements with the joint search in a case, in words; some questions are for one case in four."""
    instance, draw = case(number, mix_of(number) if mix is None else mix)
    is_asked_more = number % 4 == 0
    least = least_total_cost(instance)
    if least is not None or is_asked_more:
        yield from faults_of_search(instance, least)
    if least is not None:
        yield from faults_of_obstacles(instance)
    if not Encoding(instance).wayless:
        yield from faults_of_bounds(instance, draw, least)
        if is_asked_more:
            yield from faults_of_plans(instance, draw, least)


def faults_of_search(instance: Instance, least: int | None) -> Iterator[str]:
    best = optimum(instance, SECONDS)
    if (best.decided, best.cost) != (True, least):
        yield f"the search finds {best.cost}, not {least}"
    if best.solution is not None and best.cost is not None:
        yield from faults_of_solution(instance, best.solution, best.cost)


def faults_of_solution(instance: Instance, solution: Solution, cost: int) -> Iterator[str]:
    verdict = judge(instance, solution)
    if (verdict.violations, verdict.unplanned, verdict.cost) != ((), 0, cost):
        yield f"plans of {cost} are judged {verdict}"


def faults_of_obstacles(instance: Instance) -> Iterator[str]:
    obstacles: list[Obstacle] = [NoWay(robot.id) for robot in instance.robots]
    obstacles += [FullGoal(resource.id) for resource in instance.graph.resources]
    for obstacle in obstacles:
        if why_no_obstacle(instance, obstacle) is None:
            yield f"there are plans, though it has the obstacle {obstacle}"


def faults_of_bounds(instance: Instance, draw: Draw, least: int | None) -> Iterator[str]:
    """Whatever the horizons, more than the least is not refuted; where they reach as far as the bound, less is."""
    bound, delay = bound_of(instance, draw, least)
    if has_model(beat_formula(instance, bound, evidence(instance, draw, max(delay - 1, 0))).formula):
        yield f"the formula of less than {bound} has a model, and the least is {least}"
    nearest = draw.between(0, 1) * delay
    if least is not None:
        beat = beat_formula(instance, least + 1, evidence(instance, draw, nearest, delay))
        if not has_model(beat.formula):
            yield f"the formula of less than {least + 1} has no model, and the least is {least}"


def faults_of_plans(instance: Instance, draw: Draw, least: int | None) -> Iterator[str]:
    """Where no robot is later than its horizon, less than the least has no model, and models hold plans of it."""
    bound, delay = bound_of(instance, draw, least)
    if has_model(reach_formula(instance, bound - 1, evidence(instance, draw, 0, delay)).formula):
        yield f"the formula of at most {bound - 1} has a model, and the least is {least}"
    if least is not None:
        reach = reach_formula(instance, least, evidence(instance, draw, delay))
        model = model_of(reach.formula)
        if model is None:
            yield f"the formula of at most {least} has no model"
        else:
            plans = reach.plans(model)
            yield from faults_of_solution(instance, solution_of(plans), least)


def bound_of(instance: Instance, draw: Draw, least: int | None) -> tuple[int, int]:
    """A total that no plans are below, and the sum of delays of plans that have it."""
    shortest = Encoding(instance).shortest
    delay = draw.between(1, 5) if least is None else least - shortest
    return shortest + delay, delay


def evidence(instance: Instance, draw: Draw, nearest: int, more: int = 1) -> Evidence:
    """Horizons from the nearest to `more` ticks further, and delays added in any order."""
    robots = range(len(instance.robots))
    horizons = tuple(draw.between(nearest, nearest + more) for _ in robots)
    return Evidence(horizons, shuffle(robots, draw.stream))


@pytest.mark.parametrize("first", range(0, CASES, BLOCK))
def test_search_and_formulas_agree_with_the_joint_search(first: int) -> None:
    found = {number: list(faults(number)) for number in range(first, first + BLOCK)}
    assert {number: reported for number, reported in found.items() if reported} == {}
