"""The runner passes planners that are right, and refuses each bug by its rule with a small instance."""

import json
import subprocess
import sys
from pathlib import Path
from time import monotonic
from typing import Any

import pytest
from tests.foreign.building import built
from tests.profiles import rest_in

from carp_spec import judge
from carproof import read_instance, read_solution

BUGS = {
    ("cpp", "one-tick-short"): {"plan/goal", "plan/duration"},
    ("cpp", "swaps-ignored"): {"joint/exchange"},
    ("cpp", "parked-robots-forgotten"): {"joint/capacity"},
    ("cpp", "start-is-goal"): {"plan/start"},
    ("cpp", "goal-unconstrained"): {"joint/capacity"},
    ("cpp", "endless-search"): {"program/in-time"},
    ("cpp", "never-vanishes"): {"plan/goal"},
    ("cpp", "zero-length-windows"): {"plan/duration", "joint/capacity"},
    ("cpp", "capacity-off-by-one"): {"joint/capacity"},
    ("go", "blocks-for-ever"): {"query/complete", "query/optimal"},
    ("go", "pace-ignored"): {"plan/goal", "plan/duration"},
    ("go", "history-forgotten"): {"fleet/history"},
    ("go", "release-ignored"): {"plan/start"},
    ("go", "one-window-each"): {"query/complete", "query/optimal"},
    ("go", "first-found"): {"query/complete", "query/optimal"},
    ("go", "no-waiting"): {"query/complete", "query/optimal"},
    ("go", "directions-ignored"): {"plan/move"},
}
LEVEL = ("--level", "context-optimal")


def conform(folder: Path, command: list[str], *options: str) -> dict[str, Any]:
    """Run the runner as a process of its own."""
    asked = ["--json", "--seed", "0", "--large", "5", *options]
    run = [sys.executable, "-m", "carproof", "conform", *asked, "--", *command]
    done = subprocess.run(run, capture_output=True, cwd=folder, text=True)  # noqa: PLW1510 - in the report
    assert done.returncode in (0, 1), done.stderr
    report: dict[str, Any] = json.loads(done.stdout)
    assert report["conforms"] == (done.returncode == 0)
    return report


@pytest.mark.parametrize("language", ["cpp", "go"])
def test_a_right_planner_conforms(language: str, tmp_path: Path) -> None:
    report = conform(tmp_path, [str(built(language))], *LEVEL, "--examples", "250")
    assert report["conforms"], report["failures"]
    assert report["cases"]["random"] == {"passed": 250}
    assert report["judged"].keys() == {"query", "plan"}
    assert list(tmp_path.iterdir()) == [], "nothing is left behind"


def test_a_program_that_only_plans_whole_instances_conforms(tmp_path: Path) -> None:
    command = [str(built("go")), "--one-shot", "{instance}", "{solution}"]
    report = conform(tmp_path, command, *LEVEL, "--one-shot", "--examples", "40")
    assert report["conforms"], report["failures"]
    assert report["judged"].keys() == {"plan"}


def test_a_bug_of_a_program_that_only_plans_whole_instances_is_refused(tmp_path: Path) -> None:
    command = [str(built("go")), "--bug", "pace-ignored", "--one-shot", "{instance}", "{solution}"]
    report = conform(tmp_path, command, "--one-shot", "--shrinking", "3")
    assert {failure["rule"] for failure in report["failures"]} <= BUGS["go", "pace-ignored"]
    assert report["failures"][0]["robots"] <= 3
    assert_saved(tmp_path / report["saved"], report["failures"][0]["rule"])


@pytest.mark.parametrize(("language", "bug"), rest_in("ci", list(BUGS), 0, len(BUGS) - 1))
def test_a_bug_is_refused_by_its_rule_with_a_small_instance(language: str, bug: str, tmp_path: Path) -> None:
    command = [str(built(language)), "--bug", bug]
    started = monotonic()
    report = conform(
        tmp_path, command, *LEVEL, "--timeout", "1" if bug == "endless-search" else "5", "--shrinking", "3"
    )
    assert monotonic() - started < 60
    assert not report["conforms"]
    smallest = report["failures"][0]
    assert {failure["rule"] for failure in report["failures"]} <= BUGS[language, bug]
    assert smallest["robots"] <= 3
    assert smallest["resources"] <= 9
    assert_saved(tmp_path / report["saved"], smallest["rule"])


def assert_saved(folder: Path, rule: str) -> None:
    names = {"finding.txt", "instance.json", "request.json", "solution.json", "vector.json"}
    names |= {"picture.txt", "picture.svg", "map.txt", "map.svg", "run.json"}
    assert {path.name for path in folder.iterdir() if path.is_file()} == names
    assert f"[{rule}]" in (folder / "finding.txt").read_text()
    instance = read_instance((folder / "instance.json").read_bytes())
    violations = judge(instance, read_solution((folder / "solution.json").read_bytes())).violations
    broken = {violation.rule for violation in violations}
    assert rule in broken or rule.startswith(("query/", "program/", "fleet/"))
