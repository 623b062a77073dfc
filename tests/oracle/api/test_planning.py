"""`plan`, `add`, `query` and `check`: what people see, what programs get, and the exit codes."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import (
    BEHIND_PLAN,
    EAST,
    EAST_PLAN,
    TWO_PLANNED,
    Document,
    Run,
    asked,
    corridor,
    save,
    solution,
    town,
)

import carproof as public

pytestmark = pytest.mark.usefixtures("folder")


def test_a_robot_that_another_planner_could_plan_is_told_so(carproof: Run) -> None:
    robots = [{"id": "r1", "start": "m", "goal": "m"}, {"id": "r2", "start": "s", "goal": "t"}]
    save(ring=town("sm mt sx xy yt", robots, "park"))
    outcome = carproof("plan ring.json --planner fixed-paths --k 1")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == (
        "unplanned: robot r2: the planner found no plan for it, though there is one beside the plans of the others"
    )


def test_a_robot_left_out_after_rounds_is_told_without_a_time(carproof: Run) -> None:
    save(opposite=corridor([EAST, {"id": "r2", "start": "c", "goal": "a"}], "park"))
    outcome = carproof("plan opposite.json --iterations 3")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1].endswith(": no plan was found for it")


@pytest.mark.parametrize(
    "options",
    [
        "--planner neighbourhood --m 2 --sample 3 --seed 1 --no-baseline --fallback 2",
        "--planner neighbourhood --baseline",
        "--planner shuffled --attempts 3 --seed 4",
        "--planner longest-first",
        "--planner greedy",
        "--planner fixed-paths --k 2 --paths disjoint",
        "--planner time-expanded",
    ],
)
def test_every_planner_runs_and_its_plans_are_right(carproof: Run, options: str) -> None:
    planned = carproof(f"plan town.json --json {options}")
    assert planned.code == 0
    checked = carproof("check town.json -", stdin=planned.stdout.encode())
    assert (checked.code, checked.stdout) == (0, "no rule is broken: total cost 5, unplanned robots 0\n")


def test_check_prints_the_first_hundred_violations_of_a_rule_and_all_of_them_if_asked(carproof: Run) -> None:
    save(one=corridor([EAST]), plans=solution({"r1": [["b", 3 * tick, 3 * tick - 1] for tick in range(150)]}))
    for option, shown, count in (("", 100, "100 or more"), ("--all", 150, "150")):
        lines = carproof(f"check one.json plans.json {option}").stdout.splitlines()
        assert sum(line.startswith("[plan/duration]") for line in lines) == shown
        assert [line.split(maxsplit=1)[1] for line in lines if line.startswith("plan/duration")] == [count]
    verdict = json.loads(carproof("check one.json plans.json --json").stdout)
    assert sum(violation["rule"] == "plan/duration" for violation in verdict["violations"]) == 100


def test_check_asks_for_plans_of_all_robots_only_where_it_is_asked_to(carproof: Run) -> None:
    save(nobody=solution({}, ["r1", "r2"]))
    for plans, code, last in (
        ("nobody.json", 0, "no rule is broken: total cost 0, unplanned robots 2"),
        ("nobody.json --require-all", 1, "INCOMPLETE: total cost 0, unplanned robots 2"),
        ("plans.json --require-all", 0, "no rule is broken: total cost 5, unplanned robots 0"),
        ("broken.json --require-all", 1, "INVALID: total cost 6, unplanned robots 0"),
    ):
        outcome = carproof(f"check town.json {plans}")
        assert (outcome.code, outcome.stdout.splitlines()[-1]) == (code, last)


def test_ids_with_control_characters_are_shown_and_not_obeyed(carproof: Run) -> None:
    save(evil=corridor([{**EAST, "id": "r\n\x1b[2J"}]), plans=solution({"r\n\x1b[2J": [["a", 0, 1]]}))
    outcome = carproof("check evil.json plans.json")
    assert outcome.stdout.startswith("[plan/goal] resource a in [0,1): robot r\\n\\x1b[2J (")


def test_add_plans_the_robot_and_tells_what_changed(carproof: Run) -> None:
    outcome = carproof("add town.json one.json r2 --m 1 -o more.json")
    assert outcome.code == 0
    assert outcome.stdout.splitlines() == [
        "robot r2 arrives at tick 3",
        "plans of other robots that changed: none",
        "total cost 2 before, 5 now",
    ]
    assert json.loads(Path("more.json").read_text()) == TWO_PLANNED
    assert json.loads(carproof("add town.json one.json r2 --m 1 --json").stdout) == TWO_PLANNED
    assert carproof("add town.json one.json r2 --now 2").code == 1, "r1 has passed its start by then"


def test_a_plan_that_is_in_the_way_of_others_can_be_replaced(carproof: Run) -> None:
    assert json.loads(carproof("query town.json broken.json r2 --json").stdout) == {"plan": BEHIND_PLAN}


def test_a_robot_whose_id_is_a_number_is_found_by_it(carproof: Run) -> None:
    save(numbered=corridor([{**EAST, "id": 7}, {**EAST, "id": "8", "start": "b"}]), none=solution({}))
    assert json.loads(carproof("query numbered.json none.json 7 --json").stdout) == {"plan": EAST_PLAN}


@pytest.fixture(name="pocket")
def swapping_at_a_pocket(folder: Path) -> Document:
    """Two robots that park at each other's start, and no planning order leaves room for both."""
    del folder
    robots = [{"id": "r1", "start": "a", "goal": "e"}, {"id": "r2", "start": "e", "goal": "a"}]
    document = town("am em pm", robots, "park")
    save(pocket=document)
    return document


@pytest.mark.usefixtures("pocket")
@pytest.mark.parametrize("options", ["--planner carp", "--no-baseline", "--no-repair"])
def test_the_pure_result_of_a_planner_is_not_repaired(carproof: Run, options: str) -> None:
    outcome = carproof(f"plan pocket.json {options}")
    assert outcome.code == 1
    assert "repaired" not in outcome.stdout


def test_polish_leaves_numbers_too_large_for_groups_as_they_are(carproof: Run, pocket: Document) -> None:
    pocket["graph"]["nodes"][3]["duration"] = 2**40
    save(slow=pocket)
    carproof("plan slow.json --planner carp --engine reference -o plans.json")
    assert carproof("polish slow.json plans.json --iterations 3 --engine reference").code == 1


def test_python_and_the_op_repair_as_the_command_does_but_an_op_gives_the_plans_of_a_planner_that_it_names(
    pocket: Document,
) -> None:
    instance = public.read_instance(json.dumps(pocket).encode())
    for planner, left_out in (
        (None, 0),
        (public.Neighbourhood(m=2), 0),
        (public.Neighbourhood(baseline=False), 1),
        (public.Carp(), 1),
    ):
        assert len(public.plan(instance, planner).unplanned) == left_out
    for fields, left_out in (({}, 0), ({"m": 2}, 1), ({"planner": "neighbourhood"}, 1)):
        assert len(asked("plan", instance=pocket, **fields)["result"]["unplanned"]) == left_out
