"""People first: the robot with priority arrives as early as histories allow, and the others keep theirs."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.running import Document, Run
from tests.profiles import draws

import carp_reference
from carp_spec import check_update, judge
from carproof.engines import engine_named
from carproof.giving_way import give_way, history
from carproof.strategies import PlannedInstance, Sizes, planned_instances

REFERENCE = engine_named("reference")
SIZES = Sizes(resources=6, robots=5)


def town(after_goal: str = "vanish") -> Document:
    """A corridor a - b - c - d with a bay beside b."""
    return {
        "format": "carproof-instance/1",
        "graph": {
            "nodes": [{"id": cell} for cell in ("a", "b", "c", "d", "bay")],
            "edges": [{"source": a, "target": b} for a, b in (("a", "b"), ("b", "c"), ("c", "d"), ("b", "bay"))],
        },
        "after_goal": after_goal,
        "robots": [{"id": "r1", "start": "a", "goal": "d"}, {"id": "person", "start": "d", "goal": "a"}],
    }


PLANS: Document = {
    "format": "carproof-solution/1",
    "plans": [
        {"robot": "r1", "visits": [["a", 0, 1], ["b", 1, 2], ["c", 2, 3], ["d", 3, 4]]},
        {"robot": "person", "visits": [["d", 0, 1], ["c", 1, 2]]},
    ],
    "order": ["r1", "person"],
    "unplanned": [],
}
APART = [["d", 0, 1], ["c", 1, 2], ["b", 2, 3], ["a", 3, 4]]


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    instance, plans = tmp_path / "town.json", tmp_path / "plans.json"
    instance.write_text(json.dumps(town()))
    only = {**PLANS, "plans": PLANS["plans"][:1], "order": ["r1"], "unplanned": ["person"]}
    plans.write_text(json.dumps(only))
    return instance, plans


def test_the_others_give_way(carproof: Run, files: tuple[Path, Path], tmp_path: Path) -> None:
    after = tmp_path / "after.json"
    outcome = carproof("give-way", *files, "person", "-o", after, "--engine", "reference")
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout.startswith("robot person arrives at tick 3: no lawful update is earlier\n")
    assert outcome.stdout.splitlines()[-1].split()[0] == "r1"
    assert carproof("check", files[0], after).code == 0


def test_a_fixed_route_is_kept_and_a_wrong_one_refused(carproof: Run, files: tuple[Path, Path], tmp_path: Path) -> None:
    route, after = tmp_path / "route.json", tmp_path / "after.json"
    route.write_text(json.dumps(APART))
    outcome = carproof("give-way", *files, "person", "--route", route, "-o", after, "--engine", "reference")
    assert outcome.code == 0
    plans = json.loads(after.read_text())["plans"]
    assert plans[0] == {"robot": "person", "visits": APART}
    route.write_text(json.dumps(APART[:2]))
    outcome = carproof("give-way", *files, "person", "--route", route, "-o", tmp_path / "none", "--engine", "reference")
    assert outcome.code == 2
    assert "[plan/goal]" in outcome.stderr
    assert not (tmp_path / "none").exists()


def test_who_cannot_be_planned_is_named_before_anything_is_written(
    carproof: Run, files: tuple[Path, Path], tmp_path: Path
) -> None:
    """r1 is in the corridor, without a bay, and a person that keeps to its route comes the other way."""
    parked = town("park")
    parked["graph"]["nodes"].pop()
    parked["graph"]["edges"].pop()
    files[0].write_text(json.dumps(parked))
    plans = json.loads(files[1].read_text())
    plans["plans"][0]["visits"][-1][2] = None
    files[1].write_text(json.dumps(plans))
    route = tmp_path / "route.json"
    route.write_text(json.dumps([["d", 0, 3], ["c", 3, 4], ["b", 4, 5], ["a", 5, None]]))
    outcome = carproof(
        "give-way", *files, "person", "--now", "2", "--route", route, "-o", tmp_path / "none", "--engine", "reference"
    )
    assert (outcome.code, outcome.stdout, (tmp_path / "none").exists()) == (1, "", False)
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
    least = carp_reference.query(instance, [*others, before[robot]], robot, now)
    assert least is not None
    assert found.least == least.visits[-1].enter <= found.arrival
    assert found.is_first == (found.arrival == found.least)
    changed = {plan.robot for plan in found.solution.plans if plan != before[plan.robot]}
    assert changed - {robot} == set(found.extra)
