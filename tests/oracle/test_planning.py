"""`plan`, `add`, `query` and `check`: what people see, what programs get, and the exit codes."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from tests.oracle.running import (
    BEHIND_PLAN,
    BROKEN,
    EAST_PLAN,
    HEAD_ON,
    ONE_PLANNED,
    TWO,
    TWO_PLANNED,
    Run,
    corridor,
    solution,
)

Write = Callable[..., Path]
THREE = corridor([*TWO["robots"], HEAD_ON])


@pytest.fixture
def file(tmp_path: Path) -> Write:
    def write(document: object, name: str = "document.json") -> Path:
        path = tmp_path / name
        path.write_text(json.dumps(document))
        return path

    return write


def test_plan_prints_a_table_and_writes_the_document(carproof: Run, file: Write, tmp_path: Path) -> None:
    output = tmp_path / "plans.json"
    outcome = carproof("plan", file(TWO), "--planner", "carp", "-o", output)
    assert (outcome.code, outcome.stderr) == (0, "")
    heading, _, row = outcome.stdout.splitlines()
    assert heading.split() == ["planner", "robots", "unplanned", "total", "cost", "shortest", "paths", "ratio", "time"]
    assert row.split()[:6] == ["carp", "2", "0", "5", "5", "1.0000"]
    assert json.loads(output.read_text()) == TWO_PLANNED


def test_plan_prints_nothing_but_the_document_for_json(carproof: Run, file: Write) -> None:
    outcome = carproof("plan", file(TWO), "--planner", "carp", "--json")
    assert outcome.stdout.count("\n") == 1
    assert json.loads(outcome.stdout) == TWO_PLANNED


def test_an_unplanned_robot_is_told_with_its_reason_and_the_answer_is_no(carproof: Run, file: Write) -> None:
    outcome = carproof("plan", file(THREE), "--planner", "carp")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == "unplanned: robot r3: the committed plans leave no way to its goal"


def test_a_robot_that_another_planner_could_plan_is_told_so(carproof: Run, file: Write) -> None:
    edges = [("s", "m"), ("m", "t"), ("s", "x"), ("x", "y"), ("y", "t")]
    ring = {
        "format": "carproof-instance/1",
        "graph": {
            "nodes": [{"id": id} for id in "smtxy"],
            "edges": [{"source": source, "target": target} for source, target in edges],
        },
        "after_goal": "park",
        "robots": [{"id": "r1", "start": "m", "goal": "m"}, {"id": "r2", "start": "s", "goal": "t"}],
    }
    outcome = carproof("plan", file(ring), "--planner", "fixed-paths", "--k", "1")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == (
        "unplanned: robot r2: the planner found no plan for it, though there is one beside the plans of the others"
    )


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
def test_every_planner_runs_and_its_plans_are_right(carproof: Run, file: Write, options: str) -> None:
    instance = file(TWO)
    planned = carproof("plan", instance, "--json", *options.split())
    assert planned.code == 0
    checked = carproof("check", instance, "-", stdin=planned.stdout.encode())
    assert (checked.code, checked.stdout) == (0, "no rule is broken: total cost 5, unplanned robots 0\n")


def test_without_an_engine_asked_for_the_fastest_plans_that_has_the_planner(
    carproof: Run, file: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def watched(name: str) -> ModuleType:
        asked.append(name)
        return import_module(name)

    monkeypatch.setattr("carproof.engines.import_module", watched)
    for planner, readable in (("neighbourhood", set()), ("fixed-paths", {"carp_reference"})):
        asked.clear()
        outcome = carproof("plan", file(TWO), "--planner", planner, "--json")
        assert (outcome.code, outcome.stderr, set(asked)) == (0, "", readable)
    asked.clear()
    assert carproof("add", file(TWO), file(ONE_PLANNED, "one.json"), "r2", "--json").code == 0
    assert asked == ["carp_optimized"]
    asked.clear()
    assert carproof("add", file(TWO), file(ONE_PLANNED, "one.json"), "r2", "--engine", "reference", "--json").code == 0
    assert asked == ["carp_reference"]


def test_check_prints_each_violation_and_counts_them(carproof: Run, file: Write) -> None:
    outcome = carproof("check", file(TWO), file(BROKEN, "plans.json"))
    assert outcome.code == 1
    assert outcome.stdout.splitlines() == [
        "[joint/capacity] resource b in [1,2): robots r1, r2 (capacity 1)",
        "[joint/capacity] resource c in [2,3): robots r1, r2 (capacity 1)",
        "",
        "rule            violations",
        "──────────────────────────",
        "joint/capacity           2",
        "",
        "INVALID: total cost 6, unplanned robots 0",
    ]


def test_check_prints_the_first_hundred_violations_of_a_rule_and_all_of_them_if_asked(
    carproof: Run, file: Write
) -> None:
    instance = file(corridor([{"id": "r1", "start": "a", "goal": "c"}]))
    plans = file(solution({"r1": [["b", 3 * tick, 3 * tick - 1] for tick in range(150)]}), "plans.json")
    first, everything = carproof("check", instance, plans), carproof("check", instance, plans, "--all")
    for outcome, shown, count in ((first, 100, "100 or more"), (everything, 150, "150")):
        lines = outcome.stdout.splitlines()
        assert sum(line.startswith("[plan/duration]") for line in lines) == shown
        assert [line.split(maxsplit=1)[1] for line in lines if line.startswith("plan/duration")] == [count]
    verdict = json.loads(carproof("check", instance, plans, "--json").stdout)
    assert sum(violation["rule"] == "plan/duration" for violation in verdict["violations"]) == 100


def test_check_writes_a_verdict(carproof: Run, file: Write, tmp_path: Path) -> None:
    outcome = carproof("check", file(TWO), file(BROKEN, "plans.json"), "--json", "-o", tmp_path / "verdict.json")
    assert outcome.code == 1
    verdict = json.loads(outcome.stdout)
    assert (verdict["valid"], len(verdict["violations"])) == (False, 2)
    assert json.loads((tmp_path / "verdict.json").read_text()) == verdict


def test_check_asks_for_plans_of_all_robots_only_where_it_is_asked_to(carproof: Run, file: Write) -> None:
    files = file(TWO), file(solution({}, ["r1", "r2"]), "empty.json")
    outcome = carproof("check", *files)
    assert (outcome.code, outcome.stdout) == (0, "no rule is broken: total cost 0, unplanned robots 2\n")
    outcome = carproof("check", *files, "--require-all")
    assert (outcome.code, outcome.stdout) == (1, "INCOMPLETE: total cost 0, unplanned robots 2\n")
    assert carproof("check", file(TWO), file(TWO_PLANNED, "plans.json"), "--require-all").code == 0
    assert carproof("check", file(TWO), file(BROKEN, "broken.json"), "--require-all").stdout.endswith("robots 0\n")


def test_ids_with_control_characters_are_shown_and_not_obeyed(carproof: Run, file: Write) -> None:
    evil = corridor([{"id": "r\n\x1b[2J", "start": "a", "goal": "c"}])
    outcome = carproof("check", file(evil), file(solution({"r\n\x1b[2J": [["a", 0, 1]]}), "plans.json"))
    assert outcome.stdout.startswith("[plan/goal] resource a in [0,1): robot r\\n\\x1b[2J (")


def test_add_plans_the_robot_and_tells_what_changed(carproof: Run, file: Write, tmp_path: Path) -> None:
    arguments = (file(TWO), file(ONE_PLANNED, "plans.json"), "r2", "--m", "1")
    outcome = carproof("add", *arguments, "-o", tmp_path / "more.json")
    assert outcome.code == 0
    assert outcome.stdout.splitlines() == [
        "robot r2 arrives at tick 3",
        "plans of other robots that changed: none",
        "total cost 2 before, 5 now",
    ]
    assert json.loads((tmp_path / "more.json").read_text()) == TWO_PLANNED
    assert json.loads(carproof("add", *arguments, "--json").stdout) == TWO_PLANNED


def test_add_says_no_where_there_is_no_plan(carproof: Run, file: Write) -> None:
    outcome = carproof("add", file(THREE), file(TWO_PLANNED, "plans.json"), "r3")
    assert (outcome.code, outcome.stderr) == (1, "")
    assert outcome.stdout == "unplanned: robot r3: the committed plans leave no way to its goal\n"


def test_query_prints_the_plan(carproof: Run, file: Write) -> None:
    arguments = (file(TWO), file(ONE_PLANNED, "plans.json"), "r2")
    outcome = carproof("query", *arguments)
    assert outcome.code == 0
    assert [row.split() for row in outcome.stdout.splitlines()[2:-1]] == [
        [resource, str(enter), str(leave)] for resource, enter, leave in BEHIND_PLAN
    ]
    assert outcome.stdout.endswith("cost 3\n")
    assert json.loads(carproof("query", *arguments, "--json").stdout) == {"plan": BEHIND_PLAN}


def test_query_says_no_where_there_is_no_plan(carproof: Run, file: Write) -> None:
    arguments = (file(THREE), file(TWO_PLANNED, "plans.json"), "r3")
    outcome = carproof("query", *arguments)
    assert (outcome.code, outcome.stdout) == (1, "no plan: the committed plans leave no way to its goal\n")
    assert carproof("query", *arguments, "--json").stdout == '{"plan":null}\n'


def test_a_parked_robot_stays_for_ever(carproof: Run, file: Write) -> None:
    outcome = carproof("query", file(corridor([TWO["robots"][0]], "park")), file(solution({}), "plans.json"), "r1")
    assert outcome.stdout.splitlines()[-2].split() == ["c", "2", "for", "ever"]


def test_a_plan_that_is_in_the_way_of_others_can_be_replaced(carproof: Run, file: Write) -> None:
    outcome = carproof("query", file(TWO), file(BROKEN, "plans.json"), "r2", "--json")
    assert json.loads(outcome.stdout) == {"plan": BEHIND_PLAN}


def test_a_robot_whose_id_is_a_number_is_found_by_it(carproof: Run, file: Write) -> None:
    numbered = {**TWO, "robots": [{"id": 7, "start": "a", "goal": "c"}, {"id": "8", "start": "b", "goal": "c"}]}
    empty = file(solution({}), "plans.json")
    assert json.loads(carproof("query", file(numbered), empty, "7", "--json").stdout) == {"plan": EAST_PLAN}
    twice = {**TWO, "robots": [{"id": 7, "start": "a", "goal": "c"}, {"id": "7", "start": "b", "goal": "c"}]}
    assert "2 print as 7" in carproof("query", file(twice), empty, "7").stderr


def swapping_at_a_pocket() -> dict[str, Any]:
    """Two robots that park at each other's start, and no planning order leaves room for both."""
    return {
        "format": "carproof-instance/1",
        "graph": {
            "nodes": [{"id": id} for id in "amep"],
            "edges": [{"source": other, "target": "m"} for other in "aep"],
        },
        "after_goal": "park",
        "robots": [{"id": "r1", "start": "a", "goal": "e"}, {"id": "r2", "start": "e", "goal": "a"}],
    }


@pytest.mark.parametrize(
    ("options", "name"),
    [([], "neighbourhood, repaired"), (["--planner", "carp", "--repair"], "carp, repaired")],
)
def test_plan_leaves_nobody_out_as_it_is_first_called(
    carproof: Run, file: Write, options: Sequence[str], name: str
) -> None:
    outcome = carproof("plan", file(swapping_at_a_pocket()), *options)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout.splitlines()[2].split("  ")[0] == name


@pytest.mark.parametrize("options", [["--planner", "carp"], ["--no-baseline"], ["--no-repair"]])
def test_the_pure_result_of_a_planner_is_not_repaired(carproof: Run, file: Write, options: Sequence[str]) -> None:
    outcome = carproof("plan", file(swapping_at_a_pocket()), *options)
    assert outcome.code == 1
    assert "repaired" not in outcome.stdout


def test_polish_plans_small_groups_jointly(carproof: Run, file: Write, tmp_path: Path) -> None:
    instance = file(swapping_at_a_pocket(), "instance.json")
    carproof("plan", instance, "--planner", "carp", "-o", tmp_path / "plans.json")
    assert carproof("polish", instance, tmp_path / "plans.json", "--iterations", "20").code == 0


def test_the_examples_of_add_work(process: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert process("generate", "grid", "--width", "5", "--height", "5", "--robots", "3", "-o", "town.json").code == 0
    lines = process("add", "--help").stdout.partition("Examples:\n")[2]
    done = subprocess.run(
        ["/bin/sh", "-ec", lines],
        env={**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"},
        check=False,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_polish_leaves_numbers_too_large_for_groups_as_they_are(carproof: Run, file: Write, tmp_path: Path) -> None:
    document = swapping_at_a_pocket()
    document["graph"]["nodes"][3]["duration"] = 2**40
    instance, plans = file(document, "instance.json"), tmp_path / "plans.json"
    reference = ("--engine", "reference")
    carproof("plan", instance, "--planner", "carp", *reference, "-o", plans)
    assert carproof("polish", instance, plans, "--iterations", "3", *reference).code == 1
