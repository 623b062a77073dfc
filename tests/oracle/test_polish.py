"""`carproof polish` and the op `polish`."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import BROKEN, HEAD_ON, ONE_PLANNED, TWO, TWO_PLANNED, Document, Run, corridor, line, solution

from carproof.engines import engine_named
from carproof.server import respond

LATE = solution({"r1": [["a", 0, 2], ["b", 2, 4], ["c", 4, 5]], "r2": TWO_PLANNED["plans"][1]["visits"]})


def write(folder: Path, **documents: Document) -> list[Path]:
    for name, document in documents.items():
        (folder / name).write_text(json.dumps(document))
    return [folder / name for name in documents]


@pytest.mark.parametrize("engine", ["reference", "optimized"])
def test_polish_tells_what_it_gained_and_writes_the_plans(carproof: Run, tmp_path: Path, engine: str) -> None:
    files = write(tmp_path, instance=TWO, late=LATE)
    outcome = carproof("polish", *files, "--iterations", "9", "--engine", engine, "-o", tmp_path / "better")
    assert outcome.code == 0
    heading, _, given, polished = outcome.stdout.splitlines()
    assert heading.split() == ["plans", "unplanned", "total", "cost", "bound", "gap", "rounds", "time"]
    assert given.split() == ["given", "0", "7", "5", "40.00", "%"]
    assert polished.split()[:6] == ["polished", "0", "5", "5", "0.00", "%"]
    assert carproof("check", tmp_path / "instance", tmp_path / "better").code == 0


def test_a_robot_without_a_plan_gets_one(carproof: Run, tmp_path: Path) -> None:
    files = write(tmp_path, instance=TWO, one=ONE_PLANNED)
    outcome = carproof("polish", *files, "--json", "--iterations", "1")
    assert outcome.code == 0
    assert not json.loads(outcome.stdout)["unplanned"]


def test_a_robot_that_cannot_be_planned_is_told_and_the_answer_is_no(carproof: Run, tmp_path: Path) -> None:
    files = write(tmp_path, instance=corridor([*TWO["robots"], HEAD_ON]), two=TWO_PLANNED)
    outcome = carproof("polish", *files, "--iterations", "20")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == "unplanned: robot r3: the committed plans leave no way to its goal"


def test_the_gap_is_that_of_a_certificate_which_is_verified(carproof: Run, tmp_path: Path) -> None:
    files = write(tmp_path, instance=TWO, late=LATE)
    certificate = tmp_path / "certificate"
    assert carproof("bound", files[0], "--steps", "0", "-o", certificate).code == 0
    outcome = carproof("polish", *files, "--iterations", "0", "--bound", certificate)
    assert outcome.stdout.splitlines()[2].split() == ["given", "0", "7", "5", "40.00", "%"]
    certificate.write_text(certificate.read_text().replace('"bound":5', '"bound":6'))
    refused = carproof("polish", *files, "--iterations", "0", "--bound", certificate)
    assert refused.code == 2
    assert "$.bound" in refused.stderr


def test_the_op_gives_a_solution() -> None:
    response, _ = respond(line(id=1, op="polish", instance=TWO, solution=LATE, iterations=9), engine_named("reference"))
    assert [plan.robot for plan in response.result.plans] == list(response.result.order)
    assert not response.result.unplanned


@pytest.mark.parametrize(
    ("fields", "kind", "path", "rule"),
    [
        ({"iterations": True}, "option", "$.iterations", "polish/options"),
        ({"seconds": "1"}, "option", "$.seconds", "polish/options"),
        ({"rounds": 1}, "request", "$.rounds", "protocol/request"),
        ({"solution": BROKEN}, "request", "$.solution.plans[0].visits[1]", "joint/capacity"),
    ],
)
def test_a_bad_request_is_refused(fields: Document, kind: str, path: str, rule: str) -> None:
    asked = {"instance": TWO, "solution": TWO_PLANNED, **fields}
    response, _ = respond(line(id=1, op="polish", **asked), engine_named("reference"))
    assert response.error
    assert (response.error.kind, response.error.path, response.error.rule) == (kind, path, rule)
