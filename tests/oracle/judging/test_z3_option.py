"""`carproof check --z3` heeds the other options of the command."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import EAST_PLAN, Run, save, solution


@pytest.mark.usefixtures("folder")
def test_a_robot_without_a_plan_is_told_where_all_are_required(carproof: Run) -> None:
    save(part=solution({"r1": EAST_PLAN}, ["r2"]))
    assert carproof("check town.json part.json --z3").code == 0
    outcome = carproof("check town.json part.json --z3 --require-all")
    assert outcome.code == 1
    assert outcome.stdout.endswith("INCOMPLETE: unplanned robots 1\n")
    assert carproof("check town.json part.json --z3 --require-all --json").code == 1
    assert carproof("check town.json plans.json --z3 --require-all").code == 0


@pytest.mark.usefixtures("folder")
def test_what_z3_says_is_written_where_it_is_asked_for(carproof: Run) -> None:
    outcome = carproof("check town.json plans.json --z3 -o said.json")
    assert outcome.stdout.startswith("certified: ")
    assert json.loads(Path("said.json").read_text())["accepted"] is True
