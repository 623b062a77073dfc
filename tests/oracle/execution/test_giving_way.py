"""People first: the robot with priority arrives as early as histories allow, and the others keep theirs."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.running import Run, save, solution, town
from tests.profiles import draws

import carp_reference
from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit, check_update, judge
from carproof.engines import engine_named
from carproof.execution.giving_way import give_way, history
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

REFERENCE = engine_named("reference")
SIZES = Sizes(resources=6, robots=5, stops=3, service=5)


EAST = [["a", 0, 1], ["b", 1, 2], ["c", 2, 3], ["d", 3, 4]]
APART = [["d", 0, 1], ["c", 1, 2], ["b", 2, 3], ["a", 3, 4]]
ROBOTS = [{"id": "r1", "start": "a", "goal": "d"}, {"id": "person", "start": "d", "goal": "a"}]
PERSON_FIRST = "execution give-way town.json plans.json person --engine reference"


@pytest.fixture(autouse=True)
def _corridor_with_a_bay(elsewhere: Path) -> None:
    """The bay x is beside b."""
    del elsewhere
    save(town=town("ab bc cd bx", ROBOTS), plans=solution({"r1": EAST}, ["person"]))


def test_a_fixed_route_is_kept_and_a_wrong_one_refused(carproof: Run, elsewhere: Path) -> None:
    save(route=APART, half=APART[:2])
    outcome = carproof(f"{PERSON_FIRST} --route route.json -o after.json")
    assert (outcome.code, outcome.stdout.splitlines()[0]) == (0, "robot person arrives at tick 3: on its route")
    plans = json.loads((elsewhere / "after.json").read_text())["plans"]
    assert plans[0] == {"robot": "person", "visits": APART}
    outcome = carproof(f"{PERSON_FIRST} --route half.json -o none.json")
    assert outcome.code == 2
    assert "[plan/goal]" in outcome.stderr
    assert not (elsewhere / "none.json").exists()


def test_who_cannot_be_planned_is_named_before_anything_is_written(carproof: Run, elsewhere: Path) -> None:
    """r1 is in the corridor, without a bay, and a person that keeps to its route comes the other way."""
    save(town=town("ab bc cd", ROBOTS, "park"), plans=solution({"r1": [*EAST[:-1], ["d", 3, None]]}, ["person"]))
    save(route=[["d", 0, 3], ["c", 3, 4], ["b", 4, 5], ["a", 5, None]])
    outcome = carproof(f"{PERSON_FIRST} --now 2 --route route.json -o none.json")
    assert (outcome.code, outcome.stdout, (elsewhere / "none.json").exists()) == (1, "", False)
    assert outcome.stderr.startswith("Robot r1 finds no plan around the earliest one of robot person.\n")


@settings(max_examples=draws(80), deadline=None)
@given(planned_instances(SIZES), st.data())
def test_an_update_is_lawful_keeps_histories_and_is_first_where_it_says_so(
    case: PlannedInstance, data: st.DataObject
) -> None:
    instance, solution = case.instance, case.solution
    if not solution.plans:
        return
    robot = data.draw(st.sampled_from(solution.order))
    now = data.draw(st.integers(0, 8))
    found = give_way(instance, solution, robot, now, REFERENCE)
    assert found.solution is not None  # to change nothing is always possible
    assert judge(instance, found.solution).valid
    assert not check_update(solution.plans, found.solution.plans, now)
    before = {plan.robot: plan for plan in solution.plans}
    assert found.arrival is not None
    assert found.arrival <= before[robot].visits[-1].enter
    others = [history(instance, plan, now) for plan in solution.plans if plan.robot != robot]
    least = carp_reference.find(instance, [*others, before[robot]], robot, now)
    assert least is not None
    assert found.least == least.visits[-1].enter <= found.arrival
    assert found.is_first == (found.arrival == found.least)
    changed = {plan.robot for plan in found.solution.plans if plan != before[plan.robot]}
    assert changed - {robot} == set(found.extra)


def test_robots_that_find_no_plan_in_turn_end_the_search() -> None:
    cells = (Resource("a"), Resource("b", 2), Resource("c", 3), Resource("d", 2, 2))
    robots = (
        Robot("q", "b", "d"),
        Robot("s", "b", "b", pace=2),
        Robot("t", "a", "c", 2),
        Robot("u", "a", "d", 1),
        Robot("person", "c", "b"),
    )
    instance = Instance(ResourceGraph(cells, (("a", "b"), ("c", "b"), ("b", "d"))), robots, "park")
    plans = (
        Plan("q", (Visit("b", 0, 1), Visit("d", 1, None))),
        Plan("s", (Visit("b", 0, None),)),
        Plan("t", (Visit("a", 2, 3), Visit("b", 3, 4), Visit("c", 4, None))),
        Plan("u", (Visit("a", 1, 2), Visit("b", 2, 3), Visit("d", 3, None))),
        Plan("person", (Visit("c", 0, 5), Visit("b", 5, None))),
    )
    found = give_way(instance, Solution.of(instance, plans), "person", 2, REFERENCE)
    assert found.solution is None
    assert found.stuck
