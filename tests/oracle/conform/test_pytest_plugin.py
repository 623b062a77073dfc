"""The fixture carproof: another project's tests run in a process of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

PLANNERS = """
import dataclasses
import carp_reference
from carp_spec import Carp, Instance, Solution, Visit

def right(instance: Instance) -> Solution:
    return carp_reference.plan(instance, Carp())

def hurries(instance: Instance) -> Solution:
    solution = right(instance)
    plans = []
    for plan in solution.plans:
        first, *rest = plan.visits
        late = Visit(first.resource, first.enter + 1, first.leave)
        plans.append(dataclasses.replace(plan, visits=(late, *rest)))
    return dataclasses.replace(solution, plans=tuple(plans))

def gives_up(instance: Instance) -> Solution:
    return Solution((), (), tuple(instance.robot))

def hurries_or_gives_up(instance: Instance) -> Solution:
    return (hurries if len(instance.robots) == 1 else gives_up)(instance)

def right_documents(document):
    import json
    from carp_spec.documents.instances import read_instance
    from carp_spec.documents.solutions import write_solution
    return json.loads(write_solution(right(read_instance(json.dumps(document).encode()))))

def no_document(document):
    return {"plans": []}
"""


def pytest_of_another_project(folder: Path, *tests: str) -> subprocess.CompletedProcess[str]:
    body = "\n".join(f"def test_{number}(carproof):\n    {test}\n" for number, test in enumerate(tests))
    (folder / "test_mine.py").write_text(PLANNERS + body)
    (folder / "pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--no-header"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)  # noqa: PLW1510 - the tests look at it


def test_planners_that_are_right_pass(tmp_path: Path) -> None:
    done = pytest_of_another_project(
        tmp_path,
        'carproof.conforms(right, level="context-optimal", examples=30, seed=3, large=1)',
        "carproof.conforms(right_documents, examples=20, documents=True, large=0)",
    )
    assert "2 passed" in done.stdout, done.stdout


@pytest.mark.parametrize(
    ("test", "category", "rule"),
    [
        ("carproof.conforms(hurries)", "wrong answer", "plan/start"),
        ('carproof.conforms(gives_up, level="complete-in-context")', "wrong answer", "query/complete"),
        ("carproof.conforms(no_document, documents=True)", "protocol error", "program/result"),
    ],
)
def test_a_planner_that_is_wrong_fails_the_test_by_its_rule(
    test: str, category: str, rule: str, tmp_path: Path
) -> None:
    done = pytest_of_another_project(tmp_path, test)
    (saved,) = (tmp_path / "conform-failure" / "test_0").iterdir()
    assert "1 failed" in done.stdout
    (reported,) = (line for line in done.stdout.splitlines() if line.startswith(f"{category}: "))
    assert reported.endswith(f"[{rule}]")
    assert f"saved in {saved}" in done.stdout
    assert len(json.loads((saved / "instance.json").read_bytes())["robots"]) <= 1
    assert "Function" not in done.stdout, "no traceback through the runner"


def test_all_findings_are_saved_and_asked_first_by_the_next_run(tmp_path: Path) -> None:
    test = 'carproof.conforms(hurries_or_gives_up, level="complete-in-context", examples=0)'
    done = pytest_of_another_project(tmp_path, test)
    saved = tmp_path / "conform-failure" / "test_0" / "hurries_or_gives_up"
    cases = json.loads((saved / "run.json").read_bytes())["cases"]
    assert f"saved in {saved}, with {len(cases) - 1} more" in done.stdout
    assert len(cases) > 1
    assert all((saved / each / "finding.txt").is_file() for each in cases)
    assert "Again: pytest test_mine.py::test_0" in (saved / "finding.txt").read_text()
    done = pytest_of_another_project(tmp_path, test.replace("hurries_or_gives_up", "gives_up"))
    assert f"saved in {saved.with_name('gives_up')}" in done.stdout
    assert (saved / "finding.txt").is_file()


@pytest.mark.parametrize(
    ("test", "reason"),
    [
        (
            'carproof.conforms(gives_up, level="sound", large=0)',
            "gives_up does not conform to level sound: no plan breaks a rule\nit gave up",
        ),
        (
            'carproof.conforms(right, level="sound", examples=0, large=0)',
            "right is not shown to conform to level sound: no plan breaks a rule\nno random case decided it",
        ),
    ],
)
def test_a_planner_that_shows_nothing_fails_the_test(test: str, reason: str, tmp_path: Path) -> None:
    done = pytest_of_another_project(tmp_path, test)
    assert "1 failed" in done.stdout
    assert reason in done.stdout


def test_an_option_that_is_refused_is_told_once(tmp_path: Path) -> None:
    done = pytest_of_another_project(tmp_path, 'carproof.conforms(right, level="best")')
    assert done.stdout.count("it must be one of sound, complete-in-context") == 1


def test_pytest_starts_without_loading_what_judges_planners() -> None:
    look = "import sys, carproof.pytest_plugin; print(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", look], check=True, capture_output=True, text=True)
    slow = {"hypothesis", "z3", "networkx", "numpy", "msgspec", "carp_spec", "carp_reference"}
    assert not slow & set(done.stdout.split())
