"""Instances that forbid following: which parts plan, judge and execute them, and which refuse them in one sentence."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import BEHIND_PLAN, EAST_PLAN, ONE_PLANNED, TWO, Document, Run, asked, save, solution

FORBIDDING = {**TWO, "following": "forbidden"}
APART = solution({"r1": [["a", 0, 2], ["b", 2, 3], ["c", 3, 4]], "r2": BEHIND_PLAN})
SENTENCE = "following must be allowed here: checks and planners alone know of instances that forbid it"


@pytest.fixture(autouse=True)
def _instances(elsewhere: Path) -> None:
    del elsewhere
    save(allowing=TWO, forbidding=FORBIDDING, one=ONE_PLANNED, apart=APART)


@pytest.mark.parametrize(
    "command",
    [
        "plan forbidding.json --engine reference -o plans.json",
        "add forbidding.json one.json r2 --engine reference -o plans.json",
        "polish forbidding.json apart.json --engine reference --iterations 1 -o plans.json",
        "execution give-way forbidding.json apart.json r1 --engine reference -o plans.json",
        "execution untangle forbidding.json apart.json --engine reference -o plans.json",
    ],
)
def test_commands_that_plan_keep_a_free_tick(command: str, carproof: Run) -> None:
    assert carproof(command).code == 0
    assert carproof("check forbidding.json plans.json").code == 0
    assert carproof("execution dependencies forbidding.json plans.json").code == 0
    assert carproof("execution simulate forbidding.json plans.json --driver order --delays 0.5").code == 0


def test_plans_without_a_free_tick_are_wrong(carproof: Run) -> None:
    save(close=solution({"r1": EAST_PLAN, "r2": BEHIND_PLAN}))
    outcome = carproof("check forbidding.json close.json")
    assert outcome.code == 1
    assert outcome.stdout.startswith("[joint/following] ")


def certificates(carproof: Run) -> None:
    """Those of the same robots where following is allowed."""
    assert carproof("bound allowing.json --steps 1 -o bound.json").code == 0
    assert carproof("query allowing.json one.json r2 --engine reference --certificate query.json").code == 0


@pytest.mark.parametrize(
    "command",
    [
        "check forbidding.json apart.json --kernel",
        "audit forbidding.json apart.json",
        "audit forbidding.json apart.json --find-order",
        "audit forbidding.json apart.json --kernel",
        "check --z3 forbidding.json apart.json",
        "optimum forbidding.json -o new.json",
        "optimum forbidding.json --proof new",
        "gap forbidding.json",
        "bound forbidding.json -o new.json",
        "query forbidding.json one.json r2 --certificate new.json",
        "verify forbidding.json bound.json",
        "verify forbidding.json bound.json --kernel",
        "verify forbidding.json one.json query.json",
        "verify forbidding.json one.json query.json --kernel",
    ],
)
def test_commands_that_prove_refuse_in_one_sentence(command: str, carproof: Run) -> None:
    if command.startswith("verify"):
        certificates(carproof)
    outcome = carproof(command)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr == f"Error: forbidding.json: $.following: {SENTENCE} [limit/following]\n"
    assert not list(Path().glob("new*"))


@pytest.mark.parametrize(
    ("op", "fields"),
    [
        ("optimum", {}),
        ("bound", {"steps": 1}),
        ("audit", {"solution": APART}),
        ("audit", {"solution": APART, "kernel": True}),
    ],
)
def test_ops_that_prove_refuse_with_path_and_rule(op: str, fields: Document) -> None:
    error = asked(op, instance=FORBIDDING, **fields)["error"]
    assert (error["path"], error["rule"], error["message"]) == ("$.instance.following", "limit/following", SENTENCE)


def test_certificates_prove_nothing_where_following_is_forbidden(carproof: Run) -> None:
    certificates(carproof)
    for op, fields in (("verify-bound", {}), ("verify-query", {"solution": ONE_PLANNED})):
        certificate = json.loads(Path(f"{op.partition('-')[2]}.json").read_bytes())
        result = asked(op, instance=FORBIDDING, certificate=certificate, **fields)["result"]
        assert (result["bound"], result["rule"]) == (None, "limit/following")
        result = asked(op, instance=TWO, certificate=certificate, **fields)["result"]
        assert result["bound"] is not None
