"""The GitHub Action and the hook of pre-commit: their own commands, run as those programs run them."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
import yaml
from tests.oracle.running import BROKEN, TWO, TWO_PLANNED
from tests.programs import require_programs

ROOT = Path(__file__).parents[3]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())
(HOOK,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
STEPS = {step["name"]: step for step in ACTION["runs"]["steps"] if "name" in step}
PLANNER = """
import pathlib, sys
from carp_reference import plan
from carp_spec import Carp
from carp_spec.documents.instances import read_instance
from carp_spec.documents.solutions import write_solution

sys.stdout.buffer.write(write_solution(plan(read_instance(pathlib.Path(sys.argv[1]).read_bytes()), Carp())))
"""


@pytest.fixture(autouse=True)
def documents(tmp_path: Path) -> None:
    for name, document in (("town", TWO), ("town.solution", TWO_PLANNED), ("broken", TWO), ("broken.solution", BROKEN)):
        (tmp_path / f"{name}.json").write_text(json.dumps(document))


def run_step(name: str, folder: Path, **inputs: str) -> "subprocess.CompletedProcess[str]":
    """Run a step's script as a composite action does."""
    given = {each: field["default"] for each, field in ACTION["inputs"].items()}
    given |= {each.replace("_", "-"): value for each, value in inputs.items()}
    step = STEPS[name]
    require_programs(step["shell"])
    variables = {
        variable: re.sub(r"\$\{\{ inputs\.([a-z-]+) \}\}", lambda match: given[match[1]], value)
        for variable, value in step.get("env", {}).items()
    }
    path = f"{folder}:{Path(sys.executable).parent}:{os.environ['PATH']}"
    return subprocess.run(
        [step["shell"], "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],
        cwd=folder,
        env={**os.environ, "PATH": path, "GITHUB_ACTION_PATH": str(ROOT), **variables},
        check=False,
        capture_output=True,
        text=True,
    )


def run_hook(folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """Run the hook as pre-commit does."""
    python, *entry = HOOK["entry"].split()
    assert python == "python"
    command = [sys.executable, *entry, *arguments]
    return subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)


def test_the_action_installs_what_it_lies_in(tmp_path: Path) -> None:
    pip = tmp_path / "python"
    pip.write_text('#!/bin/sh\necho "$@"\n')
    pip.chmod(0o755)
    assert run_step("Install carproof", tmp_path).stdout == f"-m pip install --quiet {ROOT}[test]\n"
    assert (ROOT / "pyproject.toml").is_file()


def test_the_action_does_not_pass_if_it_has_nothing_to_judge(tmp_path: Path) -> None:
    for given, code in (({}, 2), ({"program": "./planner"}, 0), ({"solutions": "plans.json"}, 0)):
        assert run_step("Refuse nothing to judge", tmp_path, **given).returncode == code


def test_the_action_judges_a_planner_and_leaves_a_report(tmp_path: Path) -> None:
    (tmp_path / "planner.py").write_text(PLANNER)
    program, options = f"{sys.executable} planner.py {{instance}}", "--seed 1 --timeout 60"
    done = run_step("Judge the planner", tmp_path, program=program, one_shot="true", examples="0", options=options)
    report = tmp_path / "carproof-report"
    assert done.returncode == 3, done.stderr  # no random case decides
    assert (report / "conform.txt").read_text() == done.stdout
    assert done.stdout.splitlines()[-2].startswith("UNDECIDED: ")
    assert ET.parse(report / "conform.xml").getroot().tag == "testsuite"  # noqa: S314 - written by the test
    assert "UNDECIDED" in (report / "conform.html").read_text()


def test_the_action_checks_solutions(tmp_path: Path) -> None:
    assert (
        run_step("Check the solutions", tmp_path, instance="town.json", solutions="town.solution.json").returncode == 0
    )
    both = "broken.solution.json town.solution.json"
    done = run_step("Check the solutions", tmp_path, instance="town.json", solutions=both)
    assert done.returncode == 1
    assert "joint/capacity" in (tmp_path / "carproof-report" / "check.txt").read_text()


def test_every_step_of_the_action_takes_inputs_that_exist() -> None:
    named = set(re.findall(r"inputs\.([a-z-]+)", (ROOT / "action.yml").read_text()))
    assert named == set(ACTION["inputs"])
    assert [step["run"] for step in STEPS.values() if "${{" in step.get("run", "")] == [], "texts go through variables"


def test_the_hook_checks_each_solution_beside_its_instance(tmp_path: Path) -> None:
    assert run_hook(tmp_path, "town.solution.json").returncode == 0
    done = run_hook(tmp_path, "broken.solution.json", "town.solution.json")
    assert done.returncode == 1
    assert done.stdout.startswith("broken.solution.json:\n[joint/capacity] ")
    (tmp_path / "town.json").rename(tmp_path / "map.json")
    assert run_hook(tmp_path, "town.solution.json").returncode == 2
    assert run_hook(tmp_path, "--instance", "map.json", "town.solution.json").returncode == 0
    assert run_hook(tmp_path).returncode == 0


def test_the_hook_concerns_solutions_alone() -> None:
    assert re.search(HOOK["files"], "plans/town.solution.json")
    assert not re.search(HOOK["files"], "plans/town.json")
