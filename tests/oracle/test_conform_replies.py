"""Replies of programs: decoded to the letter, or refused by a rule with the beginning of what the program wrote."""

import json
from typing import Any

import pytest

from carproof.conform.answers import Skipped, read_result, result_of
from carproof.conform.asking.smoke import FIRST_GOES
from carproof.conform.findings import Category, Fault

VISITS = [list(stay) for stay in FIRST_GOES]
SOLUTION = {"format": "carproof-solution/1", "plans": [{"robot": "new", "visits": VISITS}], "order": ["new"]}
WHOLE = {**SOLUTION, "unplanned": []}
OPTIMUM = {"cost": 3, "lower": 3, "decided": True, "solution": WHOLE}
VERDICT = {"format": "carproof-verdict/1", "valid": True, "cost": 3, "unplanned": 0, "violations": []}


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"[" * 100_000,
        b'{"id": 1}',
        b'{"result": 1}',
        b'{"id": 1, "result": 1, "skipped": "x"}',
        b'{"id": 1, "skipped": 1}',
        b'{"id": 1, "result": 1, "more": 1}',
        b'{"id": 0, "result": 1}',
        b'{"id": 1.0, "result": 1}',
        b'{"id": "1", "result": 1}',
        b'{"id": true, "result": 1}',
        b'{"id": 1, "result": {"a": 1, "a": 2}}',
    ],
)
def test_any_other_response_is_refused(line: bytes) -> None:
    with pytest.raises(Fault) as refused:
        result_of(line, 1)
    assert (refused.value.finding.category, refused.value.finding.rule) == (Category.PROTOCOL_ERROR, "program/response")


@pytest.mark.parametrize("error", [b'""', b'{"message": "no"}'])
def test_an_error_is_a_wrong_answer(error: bytes) -> None:
    with pytest.raises(Fault) as refused:
        result_of(b'{"id": 1, "error": ' + error + b"}", 1)
    assert (refused.value.finding.category, refused.value.finding.rule) == (Category.WRONG_ANSWER, "program/accepts")


def test_a_response_may_skip_with_a_reason() -> None:
    assert result_of(b'{"id": 1, "skipped": "no time"}', 1) == Skipped("no time")
    assert result_of(b'{"id": 1, "skipped": ""}', 1) == Skipped("")


@pytest.mark.parametrize(
    ("op", "document"),
    [
        ("query", {}),
        ("query", {"plan": [["a", 0]]}),
        ("query", {"plan": [["a", True, 1]]}),
        ("query", {"plan": None, "more": 1}),
        ("query", WHOLE),
        ("plan", {"plan": None}),
        ("add", None),
        ("check", {**VERDICT, "valid": 1}),
        ("optimum", {**OPTIMUM, "solution": {}}),
        ("optimum", {**OPTIMUM, "cost": "3"}),
        ("optimum", {name: value for name, value in OPTIMUM.items() if name != "decided"}),
        ("bound", {}),
    ],
)
def test_a_result_of_another_shape_is_refused(op: str, document: Any) -> None:  # noqa: ANN401 - JSON
    with pytest.raises(Fault) as refused:
        read_result(op, json.dumps(document).encode())
    finding = refused.value.finding
    assert (finding.category, finding.rule) == (Category.PROTOCOL_ERROR, "program/result")


@pytest.mark.parametrize("op", ["plan", "query"])
@pytest.mark.parametrize("data", [b"[" * 100_000, b'{"format": "carproof-solution/1", "order": [1e999]}', b"\xff", b""])
def test_a_result_that_cannot_be_read_is_refused(op: str, data: bytes) -> None:
    with pytest.raises(Fault) as refused:
        read_result(op, data)
    assert refused.value.finding.rule == "program/result"
