"""Traces that contradict plans, run backwards or have gaps: the rule that they break, and where they are refused."""

from typing import Any

import pytest
from tests.oracle.running import Document, asked, solution, town

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


def traced(op: str, document: Document) -> Document:
    """The answer of the server."""
    return asked(op, instance=TRAIN, solution=PLANS, trace=document)


def test_the_trace_itself_is_right() -> None:
    assert traced("check-trace", GOOD)["result"]["valid"]
    assert "result" in traced("retime", GOOD)


@pytest.mark.parametrize("kind", CONTRADICTIONS)
def test_a_trace_that_contradicts_the_plans_is_refused(kind: str) -> None:
    document, path, rule = CONTRADICTIONS[kind]
    verdict = traced("check-trace", document)["result"]
    assert (verdict["valid"], {each["rule"] for each in verdict["violations"]}) == (False, {rule})
    error = traced("retime", document)["error"]
    assert (error["path"], error["rule"]) == (f"$.trace{path[1:]}", rule)
