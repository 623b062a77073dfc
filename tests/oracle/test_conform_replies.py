"""Replies of programs: decoded to the letter, or refused by a rule with the beginning of what the program wrote."""

import json
from typing import Any

import msgspec
import pytest

from carp_spec.documents.solutions import solution_document
from carp_spec.documents.verdicts import VerdictDocument
from carproof import BoundDocument, Solution
from carproof.conform.answers import MOST_SHOWN, Skipped, decode_solution, read_result, result_of, shown
from carproof.conform.asking.smoke import EAST, FIRST_GOES, committed, row
from carproof.conform.findings import Category, Fault
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument

ALONE = row([EAST])
GOES = committed(ALONE, new=FIRST_GOES)
VISITS = [list(stay) for stay in FIRST_GOES]
SOLUTION = {"format": "carproof-solution/1", "plans": [{"robot": "new", "visits": VISITS}], "order": ["new"]}
WHOLE = {**SOLUTION, "unplanned": []}
OPTIMUM = {"cost": 3, "lower": 3, "decided": True, "solution": WHOLE}
VERDICT = {"format": "carproof-verdict/1", "valid": True, "cost": 3, "unplanned": 0, "violations": []}


@pytest.mark.parametrize(
    ("line", "id", "result"),
    [
        ('{"id": 1, "result": {"plan": null}}', 1, b'{"plan": null}'),
        ('{"id": "1", "result": null}', "1", b"null"),
        ('{"result": [], "id": 0}', 0, b"[]"),
        ('{"id": 1, "result": 0}', 1, b"0"),
    ],
)
def test_the_result_is_what_stands_in_the_response(line: str, id: object, result: bytes) -> None:
    found = result_of(line.encode(), id)
    assert isinstance(found, msgspec.Raw)
    assert bytes(found) == result


def test_a_response_may_skip_with_a_reason() -> None:
    assert result_of(b'{"id": 1, "skipped": "no time"}', 1) == Skipped("no time")
    assert result_of(b'{"id": 1, "skipped": ""}', 1) == Skipped("")


@pytest.mark.parametrize(
    ("line", "category", "rule"),
    [
        (b"", Category.PROTOCOL_ERROR, "program/response"),
        (b"hello", Category.PROTOCOL_ERROR, "program/response"),
        (b"\xff", Category.PROTOCOL_ERROR, "program/response"),
        (b"[" * 100_000, Category.PROTOCOL_ERROR, "program/response"),
        (b"[]", Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "result": 1, "skipped": "x"}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "result": 1, "error": {}}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "skipped": "x", "error": {}}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "skipped": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "skipped": null}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "result": 1, "more": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 0, "result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 2, "result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": true, "result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1.0, "result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": "1", "result": 1}', Category.PROTOCOL_ERROR, "program/response"),
        (b'{"id": 1, "error": {"message": "no"}}', Category.WRONG_ANSWER, "program/accepts"),
        (b'{"id": 1, "error": null}', Category.WRONG_ANSWER, "program/accepts"),
        (b'{"id": 1, "result": {"a": 1, "a": 2}}', Category.PROTOCOL_ERROR, "program/response"),
    ],
)
def test_any_other_response_is_refused(line: bytes, category: Category, rule: str) -> None:
    with pytest.raises(Fault) as refused:
        result_of(line, 1)
    assert (refused.value.finding.category, refused.value.finding.rule) == (category, rule)


def test_a_refusal_shows_what_the_program_wrote() -> None:
    for line, message in (
        (b'{"id": 2, "result": 1}', "the id must be 1, not '2'"),
        (b'{"id": 1, "error": {"a": 1}}', "the program refuses a right request: '{\"a\": 1}'"),
        (b'{"id": 1}', "must have one of result, skipped and error: '{\"id\": 1}'"),
        (b'{"id": 1, "more": 1}', "the response is not as it must be: object contains unknown field more"),
    ):
        with pytest.raises(Fault) as refused:
            result_of(line, 1)
        assert message in refused.value.finding.message


def test_of_a_long_line_the_beginning_is_shown() -> None:
    assert shown(b"a" * MOST_SHOWN) == repr("a" * MOST_SHOWN)
    assert shown(b"a" * (MOST_SHOWN + 7)) == repr("a" * MOST_SHOWN) + " and 7 more bytes"
    assert shown(b"\xff") == r"'\\xff'"


def decoded(op: str, document: Any) -> Any:  # noqa: ANN401 - JSON, and a result
    return read_result(op, json.dumps(document).encode())


def test_each_op_has_its_answer() -> None:
    assert decoded("query", {"plan": None}) == QueryDocument(None)
    assert decoded("query", {"plan": VISITS}).plan_of("new") == GOES.plans[0]
    for op in ("plan", "add", "polish"):
        assert decoded(op, WHOLE) == Solution(GOES.plans, ("new",))
    assert decoded("optimum", OPTIMUM) == OptimumDocument(3, 3, decided=True, solution=solution_document(GOES))
    nothing = {"cost": None, "lower": None, "decided": False, "solution": None}
    assert decoded("optimum", nothing) == OptimumDocument(None, None, decided=False, solution=None)
    assert isinstance(decoded("check", VERDICT), VerdictDocument)
    bound = {"format": "carproof-bound/1", "instance": "0", "bound": 0, "scale": 1, "horizon": 0}
    lists: dict[str, list[Any]] = {"resources": [], "exchanges": [], "robots": [], "cuts": []}
    assert isinstance(decoded("bound", bound | lists), BoundDocument)


@pytest.mark.parametrize(
    ("op", "document"),
    [
        ("query", {}),
        ("query", {"plan": [["a", 0]]}),
        ("query", {"plan": [["a", 0.5, 1]]}),
        ("query", {"plan": [["a", True, 1]]}),
        ("query", {"plan": None, "more": 1}),
        ("query", WHOLE),
        ("plan", {"plan": None}),
        ("plan", {**WHOLE, "more": 1}),
        ("add", None),
        ("check", {**VERDICT, "valid": 1}),
        ("check", {**VERDICT, "cost": None}),
        ("optimum", {**OPTIMUM, "solution": {}}),
        ("optimum", {**OPTIMUM, "solution": []}),
        ("optimum", {**OPTIMUM, "cost": "3"}),
        ("optimum", {name: value for name, value in OPTIMUM.items() if name != "decided"}),
        ("bound", {}),
    ],
)
def test_a_result_of_another_shape_is_refused(op: str, document: Any) -> None:  # noqa: ANN401 - JSON
    with pytest.raises(Fault) as refused:
        decoded(op, document)
    finding = refused.value.finding
    assert (finding.category, finding.rule) == (Category.PROTOCOL_ERROR, "program/result")


@pytest.mark.parametrize("op", ["plan", "query"])
@pytest.mark.parametrize("data", [b"[" * 100_000, b'{"format": "carproof-solution/1", "order": [1e999]}', b"\xff", b""])
def test_a_result_that_cannot_be_read_is_refused(op: str, data: bytes) -> None:
    with pytest.raises(Fault) as refused:
        read_result(op, data)
    assert refused.value.finding.rule == "program/result"


def test_a_solution_is_read_as_the_result_of_plan_is() -> None:
    assert decode_solution(json.dumps(WHOLE).encode()) == decoded("plan", WHOLE)
    with pytest.raises(Fault, match="the result of plan is not as it must be"):
        decode_solution(b"{}")


def test_a_start_names_the_program_and_its_ops() -> None:
    started = read_result("start", (b'{"name": "mine", "version": "1", "ops": ["query"]}'))
    assert (started.name, started.version, started.ops) == ("mine", "1", ("query",))
    for wrong in (
        b"{}",
        b'{"name": "mine", "version": 1, "ops": []}',
        b"[]",
        b'{"name": "", "version": "", "ops": "q"}',
    ):
        with pytest.raises(Fault, match="the result of start is not as it must be"):
            read_result("start", (wrong))
