"""Traces that contradict the plans, run backwards or have gaps: all that read one refuse it, with path and rule."""

from pathlib import Path
from typing import Any

import pytest
from tests.oracle.running import Document, Run, asked, save, solution, town

ROBOTS = [{"id": "r0", "start": "b", "goal": "c"}, {"id": "r1", "start": "a", "goal": "b"}]
TRAIN = town("ab bc cd ae", ROBOTS)
PLANS = solution({"r0": [["b", 0, 1], ["c", 1, 2]], "r1": [["a", 0, 1], ["b", 1, 2]]})
AHEAD: list[list[Any]] = [["b", 0, 3], ["c", 3, None]]
BEHIND: list[list[Any]] = [["a", 0, None]]


def trace(ahead: list[list[Any]] = AHEAD, behind: list[list[Any]] = BEHIND, now: object = 3) -> Document:
    """By tick 3 the first robot has moved, three ticks late, and the second waits."""
    visits = {"r0": ahead, "r1": behind}
    plans = [{"robot": robot, "visits": each} for robot, each in visits.items()]
    return {"format": "carproof-trace/1", "now": now, "plans": plans}


GOOD = trace()
CONTRADICTIONS: dict[str, tuple[Document, str, str]] = {
    "an unknown robot": (
        {**GOOD, "plans": [*GOOD["plans"], {"robot": "ghost", "visits": []}]},
        "$.plans[2]",
        "trace/robots",
    ),
    "a robot too few": ({**GOOD, "plans": GOOD["plans"][:1]}, "$.plans", "trace/robots"),
    "a robot twice": ({**GOOD, "plans": [*GOOD["plans"], GOOD["plans"][1]]}, "$.plans[1]", "trace/robots"),
    "another way": (trace(behind=[["a", 0, 2], ["e", 2, None]]), "$.plans[1]", "trace/prefix"),
    "an unknown resource": (trace(behind=[["nowhere", 0, None]]), "$.plans[1]", "trace/prefix"),
    "beyond the goal": (trace([["b", 0, 1], ["c", 1, 2], ["d", 2, None]]), "$.plans[0]", "trace/prefix"),
    "a gap": (trace([["b", 0, 1], ["c", 3, None]]), "$.plans[0]", "trace/ticks"),
    "back in time": (trace([["b", 0, 3], ["c", 2, None]]), "$.plans[0]", "trace/ticks"),
    "left before entered": (trace([["b", 2, 1], ["c", 1, None]]), "$.plans[0]", "trace/ticks"),
    "left twice": (trace([["b", 0, None], ["c", 3, None]]), "$.plans[0]", "trace/ticks"),
    "before the release": (trace(behind=[["a", -1, None]]), "$.plans[1]", "trace/ticks"),
    "after now": (trace(now=2), "$.plans[0]", "trace/ticks"),
    "gone from its way": (trace(behind=[["a", 0, 2]]), "$.plans[1]", "trace/ticks"),
    "too fast": (trace([["b", 0, 0], ["c", 0, None]]), "$.plans[0]", "execution/duration"),
    "out of order": (trace(behind=[["a", 0, 2], ["b", 2, None]]), "$.plans[1]", "execution/order"),
}
MALFORMED: dict[str, tuple[object, str, str]] = {
    "another format": ({**GOOD, "format": "carproof-solution/1"}, "$.format", "document/format"),
    "no trace": ([1], "$.format", "document/format"),
    "a time before the first": (trace(now=-1), "$.now", "document/shape"),
    "half a tick": (trace(now=2.5), "$.now", "document/shape"),
    "a truth for a tick": (trace(now=True), "$.now", "document/shape"),
    "one field more": ({**GOOD, "seconds": 3}, "$", "document/shape"),
    "a visit without its end": (trace(behind=[["a", 0]]), "$.plans[1].visits[0]", "document/shape"),
    "a list for a resource": (trace(behind=[[["a"], 0, None]]), "$.plans[1].visits[0][0]", "document/shape"),
}


@pytest.fixture(autouse=True)
def _train(elsewhere: Path) -> None:
    del elsewhere
    save(train=TRAIN, plans=PLANS)


def traced(op: str, document: object) -> Document:
    """The answer of the server."""
    fields: Document = {"instance": TRAIN, "solution": PLANS, "trace": document}
    if op == "drive":
        fields["ready"] = []
    return asked(op, **fields)


def test_the_trace_itself_is_right(carproof: Run) -> None:
    save(trace=GOOD)
    assert carproof("execution check train.json plans.json trace.json").code == 0
    assert carproof("execution retime train.json plans.json trace.json --engine reference").code == 0
    assert [*traced("drive", GOOD)] == [*traced("retime", GOOD)] == ["id", "result"]


@pytest.mark.parametrize("kind", CONTRADICTIONS)
def test_a_trace_that_contradicts_the_plans_is_refused_and_nothing_is_written(kind: str, carproof: Run) -> None:
    document, path, rule = CONTRADICTIONS[kind]
    save(trace=document)
    outcome = carproof("execution check train.json plans.json trace.json")
    assert (outcome.code, outcome.stderr) == (1, "")
    assert outcome.stdout.startswith(f"[{rule}] ")
    assert outcome.stdout.endswith("INVALID: the trace does not follow the plans\n")
    for engine in ("reference", "optimized"):
        outcome = carproof(f"execution retime train.json plans.json trace.json --engine {engine} -o late.json")
        assert (outcome.code, outcome.stdout, outcome.stderr.count("\n")) == (2, "", 1)
        assert outcome.stderr.startswith(f"Error: trace.json: {path}: ")
        assert outcome.stderr.endswith(f" [{rule}]\n")
    assert not Path("late.json").exists()
    verdict = traced("check-trace", document)["result"]
    assert (verdict["valid"], {each["rule"] for each in verdict["violations"]}) == (False, {rule})
    for op in ("retime", "drive"):
        error = traced(op, document)["error"]
        assert (error["path"], error["rule"]) == (f"$.trace{path[1:]}", rule)


@pytest.mark.parametrize("kind", MALFORMED)
def test_a_document_that_is_no_trace_is_refused_everywhere(kind: str, carproof: Run) -> None:
    document, path, rule = MALFORMED[kind]
    save(trace=document)
    for command in ("check", "retime"):
        more = " --engine reference -o late.json" if command == "retime" else ""
        outcome = carproof(f"execution {command} train.json plans.json trace.json{more}")
        assert (outcome.code, outcome.stdout, outcome.stderr.count("\n")) == (2, "", 1)
        assert outcome.stderr.startswith(f"Error: trace.json: {path}: ")
        assert outcome.stderr.endswith(f" [{rule}]\n")
    assert not Path("late.json").exists()
    for op in ("check-trace", "retime", "drive"):
        error = traced(op, document)["error"]
        assert (error["path"], error["rule"]) == (f"$.trace{path[1:]}", rule)
