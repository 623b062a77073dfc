"""`bound`, `verify-bound` and the op `bound`."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from msgspec import to_builtins
from tests.oracle.running import HEAD_ON, TWO, TWO_PLANNED, Run, corridor, line

from carp_optimum.bound import Progress
from carp_spec.bounds import BOUND_FORMAT, BoundDocument, read_bound

EMPTY = BoundDocument(BOUND_FORMAT, "", 0, 1, 0, (), (), (), ())


@pytest.fixture
def town(tmp_path: Path) -> Path:
    return written(tmp_path / "town.json", TWO)


def written(path: Path, document: object) -> Path:
    path.write_text(json.dumps(document))
    return path


def test_a_bound_is_found_shown_and_verified(carproof: Run, town: Path, tmp_path: Path) -> None:
    certificate = tmp_path / "certificate.json"
    outcome = carproof("bound", town, "-o", certificate)
    assert outcome.code == 0
    assert outcome.stdout.splitlines()[-1].split()[:6] == ["2", "5", "5", "5", "0.00", "%"]
    verified = carproof("verify-bound", town, certificate)
    assert (verified.code, verified.stderr) == (0, "")
    assert verified.stdout.splitlines()[-1].split()[:2] == ["5", "2"]
    document = json.loads(carproof("verify-bound", town, certificate, "--json").stdout)
    assert document == {
        "bound": 5, "path": None, "rule": None, "reason": None, "by": "carp_verify", "assumed": []
    }  # fmt: skip


def test_plans_given_are_set_against_the_bound(carproof: Run, town: Path, tmp_path: Path) -> None:
    plans = written(tmp_path / "plans.json", TWO_PLANNED)
    outcome = carproof("bound", town, "--steps", 0, "--plans", plans)
    assert outcome.stdout.splitlines()[-1].split()[:6] == ["2", "5", "5", "5", "0.00", "%"]
    broken = {**TWO_PLANNED, "plans": TWO_PLANNED["plans"][:1]}
    refused = carproof("bound", town, "--plans", written(tmp_path / "broken.json", broken))
    assert refused.code == 2
    assert "plans to compare with must break no rule" in refused.stderr


def test_the_certificate_as_a_document(carproof: Run, town: Path) -> None:
    outcome = carproof("bound", town, "--steps", 3, "--json")
    assert read_bound(outcome.stdout.encode()).bound == 5


def test_a_robot_without_a_way_is_told(carproof: Run, tmp_path: Path) -> None:
    document = corridor([{"id": "r1", "start": "a", "goal": "island"}, HEAD_ON])
    document["graph"]["nodes"].append({"id": "island"})
    town, certificate = written(tmp_path / "town.json", document), tmp_path / "certificate.json"
    outcome = carproof("bound", town, "--steps", 3, "-o", certificate)
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == "unplanned: no way leads from a to island, the goal of robot r1"
    verified = carproof("verify-bound", town, certificate)
    assert verified.code == 0
    assert verified.stdout.splitlines()[-1] == "robot r1 has no way to its goal: the bound is that of the others"


def test_a_certificate_that_proves_nothing_is_refused_with_path_rule_and_reason(
    carproof: Run, town: Path, tmp_path: Path
) -> None:
    document = json.loads(carproof("bound", town, "--steps", 3, "--json").stdout)
    wrong = written(tmp_path / "wrong.json", {**document, "bound": 6})
    outcome = carproof("verify-bound", town, wrong)
    message = "the bound must be 5, the sum of all parts rounded up, and is 6"
    assert (outcome.code, outcome.stdout) == (1, f"not proved: $.bound: {message} [bound/total]\n")
    told = json.loads(carproof("verify-bound", town, wrong, "--json").stdout)
    assert (told["bound"], told["path"], told["rule"], told["reason"]) == (None, "$.bound", "bound/total", message)


def test_the_op_bound_is_served(carproof: Run) -> None:
    requests = [
        line(id=1, op="bound", instance=TWO, steps=3),
        line(id=2, op="bound", instance=TWO, seconds=0),
        line(id=3, op="bound", instance=TWO, steps=0),
        line(id=4, op="bound", instance=TWO, steps=True),
        line(id=5, op="bound", instance=TWO, seconds=0.5),
        line(id=6, op="stop"),
    ]
    answers = [json.loads(each) for each in carproof("serve", stdin=b"".join(requests)).stdout.splitlines()]
    assert read_bound(json.dumps(answers[0]["result"]).encode()).bound == 5
    assert (answers[1]["error"]["path"], answers[1]["error"]["rule"]) == ("$.seconds", "request/limit")
    assert (answers[2]["error"]["path"], answers[2]["error"]["rule"]) == ("$.steps", "request/limit")
    assert answers[3]["error"]["path"] == "$.steps"
    assert answers[4]["result"]["bound"] == 5


@pytest.mark.parametrize("command", ["bound", "polish"])
def test_plans_that_cost_less_than_the_bound_are_a_contradiction(
    carproof: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    def too_much(_: object, __: object, ___: object, keep: Callable[[Progress], None]) -> BoundDocument:
        keep(Progress(1, 1_000_000))
        return EMPTY

    monkeypatch.setattr("carp_verify.verify_bound.verify_bound", lambda *_: 1_000_000)
    monkeypatch.setattr("carp_optimum.bound.lower_bound", too_much)
    town, plans = written(tmp_path / "town.json", TWO), written(tmp_path / "plans.json", TWO_PLANNED)
    if command == "bound":
        outcome = carproof("bound", town, "--steps", 1, "--plans", plans)
    else:
        outcome = carproof("polish", town, plans, "--bound", written(tmp_path / "bound.json", to_builtins(EMPTY)))
    assert outcome.code == 70
    assert outcome.stderr.startswith("Internal contradiction: plans that break no rule cost 5, less than the lower")
    assert "Traceback" not in outcome.stderr
