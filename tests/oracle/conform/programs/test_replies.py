"""Replies of programs: decoded to the letter, or refused by a rule with the beginning of what the program wrote."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from carproof.conform.answers import Skipped, read_result, result_of
from carproof.conform.asking.smoke import FIRST_GOES
from carproof.conform.findings import Category, Fault, Finding

VISITS = [list(stay) for stay in FIRST_GOES]
SOLUTION = {"format": "carproof-solution/1", "plans": [{"robot": "new", "visits": VISITS}], "order": ["new"]}
WHOLE = {**SOLUTION, "unplanned": []}
OPTIMUM = {"cost": 3, "lower": 3, "decided": True, "solution": WHOLE}
VERDICT = {"format": "carproof-verdict/1", "valid": True, "cost": 3, "unplanned": 0, "violations": []}
UNREADABLE = (
    b"[" * 100_000,
    b"[" * 100_000 + b"]" * 100_000,
    b'{"format": "carproof-solution/1", "order": [1e999]}',
    b'{"plan": [["a", 1' + b"0" * 5000 + b", null]]}",
    b"\xff",
    b"",
)


def finding_of(read: Callable[..., object], *arguments: object) -> Finding:
    with pytest.raises(Fault) as refused:
        read(*arguments)
    finding = refused.value.finding
    assert finding.message == finding.message.strip()
    assert "\n" not in finding.message
    return finding


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
        b'{"id": 1, "result": {"pl',
        b'{"id": 1, "result": {"plan": [["a", 1e999, null]]}}',
    ],
)
def test_any_other_response_is_refused(line: bytes) -> None:
    finding = finding_of(result_of, line, 1)
    assert (finding.category, finding.rule) == (Category.PROTOCOL_ERROR, "program/response")


@pytest.mark.parametrize(
    ("end", "told"), [(b'"a": NaN}', "at line 1, column 331"), (b'"id": 1}', "has the name 'id' 2 times")]
)
def test_a_long_response_that_is_no_json_is_told_where_and_why(end: bytes, told: str) -> None:
    finding = finding_of(result_of, b'{"id": 1, "skipped": "' + b"x" * 300 + b'", ' + end, 1)
    assert told in finding.message


@pytest.mark.parametrize("error", [b'""', b'{"message": "no"}'])
def test_an_error_is_a_wrong_answer(error: bytes) -> None:
    finding = finding_of(result_of, b'{"id": 1, "error": ' + error + b"}", 1)
    assert (finding.category, finding.rule) == (Category.WRONG_ANSWER, "program/accepts")


def test_a_response_may_skip_with_a_reason() -> None:
    assert result_of(b'{"id": 1, "skipped": "no time"}', 1) == Skipped("no time")
    assert result_of(b'{"id": 1, "skipped": ""}', 1) == Skipped("")


@pytest.mark.parametrize(
    ("op", "document"),
    [
        ("query", {}),
        ("query", {"plan": [["a", 0]]}),
        ("query", {"plan": [["a", True, 1]]}),
        ("query", {"plan": [["a", 0.0, 1]]}),
        ("query", {"plan": None, "more": 1}),
        ("query", WHOLE),
        ("plan", {"plan": None}),
        ("add", None),
        ("check", {**VERDICT, "valid": 1}),
        ("optimum", {**OPTIMUM, "solution": {}}),
        ("optimum", {**OPTIMUM, "cost": "3"}),
        ("optimum", {name: value for name, value in OPTIMUM.items() if name != "decided"}),
        ("bound", {}),
        *((op, unreadable) for op in ("plan", "query") for unreadable in UNREADABLE),
    ],
)
def test_a_result_of_another_shape_is_refused(op: str, document: Any) -> None:  # noqa: ANN401 - JSON
    finding = finding_of(read_result, op, document if isinstance(document, bytes) else json.dumps(document).encode())
    assert (finding.category, finding.rule) == (Category.PROTOCOL_ERROR, "program/result")
