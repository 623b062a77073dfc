"""The protocol: every op, every refusal with its path and rule, and a process that survives every line."""

import io
import json
import subprocess
import sys
from importlib.metadata import version
from typing import Any, Never

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.running import (
    BROKEN,
    EAST,
    EAST_PLAN,
    HEAD_ON,
    ONE_PLANNED,
    REQUESTS,
    TWO,
    TWO_PLANNED,
    UNDER_WAY,
    asked,
    corridor,
    line,
    solution,
)

from carproof.engines import engine_named
from carproof.protocol.lines import LONGEST_LINE
from carproof.protocol.ops import OPS
from carproof.protocol.ops.op import Session
from carproof.protocol.server import respond, serve
from carproof.rules import ALL_RULES

STOP = line(id="last", op="stop")
THREE = corridor([*TWO["robots"], HEAD_ON])
GOODBYE = {"id": "last", "result": {}}


def ask(*lines: bytes) -> list[dict[str, Any]]:
    responses = io.BytesIO()
    serve(io.BytesIO(b"".join(lines)), responses, engine_named("reference"))
    return [json.loads(response) for response in responses.getvalue().splitlines()]


def test_start_tells_name_version_and_ops() -> None:
    told = {"name": "carproof", "version": version("carproof"), "ops": list(OPS)}
    assert ask(line(id=1, op="start", version=1)) == [{"id": 1, "result": told}]


@pytest.mark.parametrize("id", [None, 0, "x", [1, {"a": [None]}], 1.5, 10**30])
def test_the_id_comes_back_as_it_was(id: object) -> None:
    (response,) = ask(line(id=id, op="stop"))
    assert response == {"id": id, "result": {}}


MISSING = object()
BAD_GOAL = {**TWO, "robots": [TWO["robots"][0], {**TWO["robots"][1], "goal": "z"}]}
NO_SHAPE = {**TWO_PLANNED, "plans": [TWO_PLANNED["plans"][0], {"robot": "r2", "visits": [["b", 0, 1.0]]}]}
FOREIGN = {**TWO_PLANNED, "plans": [*TWO_PLANNED["plans"], {"robot": "r9", "visits": []}]}
BESIDE_BROKEN = {"instance": THREE, "solution": BROKEN, "robot": "r3"}
FLEET = line(id=0, op="fleet/open", fleet="f", instance=corridor([EAST]))
NEW = {"id": "r2", "start": "b", "goal": "e", "release": 2}
NO_STOP = {"resource": "a", "service": -1}


@pytest.mark.parametrize(
    ("op", "changes", "kind", "path", "rule"),
    [
        ("start", {"version": MISSING}, "request", "$.version", "protocol/request"),
        ("start", {"version": 2}, "request", "$.version", "protocol/version"),
        ("start", {"more": 1}, "request", "$.more", "protocol/request"),
        ("fly", {}, "request", "$.op", "protocol/request"),
        (MISSING, {}, "request", "$.op", "protocol/request"),
        ("check", {"solution": MISSING}, "request", "$.solution", "protocol/request"),
        ("check", {"instance": 3}, "document", "$.instance.format", "document/format"),
        ("check", {"instance": BAD_GOAL}, "document", "$.instance.robots[1].goal", "instance/endpoint"),
        ("check", {"solution": NO_SHAPE}, "document", "$.solution.plans[1].visits[0][2]", "document/shape"),
        ("query", BESIDE_BROKEN, "request", "$.solution.plans[0].visits[1]", "joint/capacity"),
        ("query", {"robot": "r9"}, "request", "$.robot", "request/robot"),
        ("query", {"robot": True}, "request", "$.robot", "protocol/request"),
        ("query", {"now": 1.0}, "request", "$.now", "protocol/request"),
        ("plan", {"planner": "x"}, "option", "$.planner", "planner/options"),
        ("plan", {"colour": "red"}, "option", "$.colour", "planner/options"),
        ("add", {"attempts": 3}, "option", "$.attempts", "planner/options"),
        ("polish", {"rounds": 1}, "request", "$.rounds", "protocol/request"),
        ("optimum", {"limit": "long"}, "request", "$.limit", "protocol/request"),
        ("bound", {"steps": MISSING, "seconds": 0}, "request", "$.seconds", "request/limit"),
        ("audit", {"solution": {**TWO_PLANNED, "order": []}}, "request", "$.solution.plans[0]", "solution/order"),
        ("check-trace", {"trace": MISSING}, "request", "$.trace", "protocol/request"),
        ("dependencies", {"delays": [["r9", 0, 1]]}, "request", "$.delays[0]", "request/delays"),
        ("dependencies", {"delays": [["r1", 0, 1], ["r1", 0, 1]]}, "request", "$.delays[1]", "request/delays"),
        ("dependencies", {"delays": [["r2", 0]]}, "request", "$.delays[0]", "protocol/request"),
        ("execute", {"driver": "wild"}, "request", "$.driver", "protocol/request"),
        ("drive", {"ready": ["r9"]}, "request", "$.ready", "request/robot"),
        ("retime", {"trace": {**UNDER_WAY, "now": 1}}, "document", "$.trace.plans[1]", "trace/ticks"),
        ("give-way", {"route": [["a", 0]]}, "request", "$.route[0]", "protocol/request"),
        ("give-way", {"route": [["a", 0, 1], ["b", 1, 2]]}, "request", "$.route", "plan/goal"),
        ("fleet/open", {}, "request", "$.fleet", "fleet/name"),
        (
            "fleet/open",
            {"fleet": "g", "instance": BAD_GOAL},
            "document",
            "$.instance.robots[1].goal",
            "instance/endpoint",
        ),
        ("fleet/open", {"fleet": "g", "solution": FOREIGN}, "request", "$.solution.plans[2]", "solution/covers"),
        ("fleet/add", {"fleet": "g"}, "request", "$.fleet", "fleet/name"),
        ("fleet/add", {"robot": EAST}, "request", "$.robot.id", "fleet/robot"),
        ("fleet/add", {"robot": {**NEW, "colour": 1}}, "request", "$.robot", "protocol/request"),
        ("fleet/assign", {"stops": [NO_STOP]}, "request", "$.stops[0].service", "instance/stops"),
        ("fleet/trace", {"trace": UNDER_WAY}, "request", "$.trace.plans[1].robot", "fleet/robot"),
        ("fleet/advance", {"now": True}, "request", "$.now", "protocol/request"),
    ],
)
def test_a_bad_request_is_refused_with_path_and_rule(
    op: object, changes: dict[str, object], kind: str, path: str, rule: str
) -> None:
    fields = {"op": op, **REQUESTS.get(str(op), {}), **changes}
    given = {name: value for name, value in fields.items() if value is not MISSING}
    _, response = ask(FLEET, line(id=1, **given))
    assert response.keys() == {"id", "error"}, response
    assert response["error"].keys() == {"kind", "path", "rule", "message"}
    assert (response["error"]["kind"], response["error"]["path"], response["error"]["rule"]) == (kind, path, rule)
    assert rule in {each.id for each in ALL_RULES}


@pytest.mark.parametrize(
    ("bad", "rule"),
    [
        (b"hello\n", "document/json"),
        (b'{"id": 1, "op": "start"\n', "document/json"),
        (b'{"id": "\xff", "op": "start"}\n', "document/json"),
        (b'{"id": "\\ud800", "op": "start"}\n', "document/json"),
        (b"[" * 1_000_000 + b"\n", "document/json"),
        (b'{"id":' + b"[" * 100_000 + b"]" * 100_000 + b"}\n", "document/json"),
        (b'{"id": 1, "op": "check", "instance": 1e999}\n', "document/json"),
        (b"[]\n", "protocol/request"),
        (b'{"op": "stop"}\n', "protocol/request"),
        (b'{"id": "' + b"x" * 10_000_000 + b'"}\n', "protocol/request"),
        (b"x" * (LONGEST_LINE + 1) + b"\n", "protocol/line"),
        (b" " * (LONGEST_LINE + 2**21 + 5) + b"\n", "protocol/line"),
    ],
)
def test_no_line_ends_the_process(bad: bytes, rule: str) -> None:
    first, last = ask(bad, STOP)
    assert first["error"]["rule"] == rule
    assert last == GOODBYE


def test_a_line_at_the_limit_is_read() -> None:
    assert ask(b'{"id": 1, "op": "stop"}'.ljust(LONGEST_LINE) + b"\n") == [{"id": 1, "result": {}}]


def test_the_end_of_the_input_and_stop_end_the_process() -> None:
    assert ask() == []
    assert ask(STOP, line(id=2, op="start", version=1)) == [GOODBYE]
    assert ask(b'{"id": "last", "op": "stop"}') == [GOODBYE], "a last line without its end is a line"


@given(st.binary(max_size=60).filter(lambda data: b"\n" not in data))
def test_random_bytes_get_one_error_each(data: bytes) -> None:
    first, last = ask(data + b"\n", STOP)
    assert "error" in first
    assert last == GOODBYE


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
VALUES = JSON | st.just(TWO) | st.just(ONE_PLANNED)
FIELDS = ["instance", "solution", "robot", "now", "planner", "m", "version", "x"]


@given(st.sampled_from([*OPS, "x"]), st.dictionaries(st.sampled_from(FIELDS), VALUES))
def test_random_fields_never_fail_by_a_fault_of_ours(op: str, fields: dict[str, object]) -> None:
    (response,) = ask(line(id=7, op=op, **fields))
    assert response["id"] == 7
    assert response.get("error", {}).get("kind") != "internal"


SLOW_END = {**TWO["graph"], "nodes": [*TWO["graph"]["nodes"][:4], {"id": "e", "duration": 2**40}]}
ALONE = {"instance": corridor([EAST]), "solution": ONE_PLANNED}
LARGE = {"instance": {**ALONE["instance"], "graph": SLOW_END}, "solution": ONE_PLANNED}
LONG = {
    "instance": corridor([EAST], "park"),
    "solution": solution({"r1": [["a", 0, 2**40], ["b", 2**40, 2**41], ["c", 2**41, None]]}),
}
BEGUN = {**UNDER_WAY, "now": 0, "plans": UNDER_WAY["plans"][:1]}


@pytest.mark.parametrize(
    ("op", "fields", "path"),
    [
        ("plan", {"instance": LARGE["instance"]}, "$.instance.graph.nodes[4].duration"),
        ("query", {**LARGE, "robot": "r1"}, "$.instance.graph.nodes[4].duration"),
        ("add", {**LARGE, "solution": solution({}), "robot": "r1"}, "$.instance.graph.nodes[4].duration"),
        ("polish", {**LARGE, "iterations": 1}, "$.instance.graph.nodes[4].duration"),
        ("assign", {**LARGE, "robot": "r1", "stops": [{"resource": "b"}]}, "$.instance.graph.nodes[4].duration"),
        ("audit", LARGE, "$.instance.graph.nodes[4].duration"),
        ("give-way", {**LARGE, "robot": "r1"}, "$.instance.graph.nodes[4].duration"),
        ("retime", {**LARGE, "trace": BEGUN}, "$.instance.graph.nodes[4].duration"),
        ("fleet/open", {**LARGE, "fleet": "f"}, "$.instance.graph.nodes[4].duration"),
        ("query", {**ALONE, "robot": "r1", "now": 2**40}, "$.now"),
        ("add", {**ALONE, "solution": solution({}), "robot": "r1", "now": 2**40}, "$.now"),
        ("polish", {**ALONE, "iterations": 1, "now": 2**40}, "$.now"),
        ("give-way", {**ALONE, "robot": "r1", "now": 2**40}, "$.now"),
        ("retime", {**ALONE, "trace": {**BEGUN, "now": 2**40}}, "$.trace.now"),
        ("polish", {**LONG, "iterations": 1}, "$.solution.plans"),
        ("audit", LONG, "$.solution.plans"),
        ("retime", {**LONG, "trace": BEGUN}, "$.solution.plans"),
    ],
)
def test_a_refusal_of_the_engine_has_its_place_in_the_request(op: str, fields: dict[str, object], path: str) -> None:
    response, _ = respond(line(id=1, op=op, **fields), Session(engine_named("optimized")))
    reported = json.loads(msgspec.json.encode(response))["error"]
    assert (reported["kind"], reported["path"]) == ("limit", path)


class Faulty:
    """An engine that fails."""

    def __init__(self, fault: type[Exception]) -> None:
        self.fault = fault

    def __getattr__(self, name: str) -> Never:
        raise self.fault(name)


@pytest.mark.parametrize("fault", [ZeroDivisionError, KeyError, RecursionError, MemoryError])
def test_a_fault_of_ours_is_an_error_of_kind_internal(
    capsys: pytest.CaptureFixture[str], fault: type[Exception]
) -> None:
    response, running = respond(line(id=5, op="plan", instance=TWO), Session(Faulty(fault)))
    assert running
    reported = json.loads(msgspec.json.encode(response))
    assert (reported["id"], reported["error"]["kind"], reported["error"]["rule"]) == (5, "internal", None)
    assert fault.__name__ in reported["error"]["message"]
    assert "Traceback" in capsys.readouterr().err


def test_the_process_answers_each_line_before_it_reads_the_next() -> None:
    command = [sys.executable, "-m", "carproof", "serve"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for request in (line(id=1, op="start", version=1), b"nonsense\n", line(id=2, op="plan", instance=TWO), STOP):
            process.stdin.write(request)
            process.stdin.flush()
            assert process.stdout.readline().startswith(b'{"id":')
        assert process.wait(timeout=20) == 0


def test_a_server_keeps_fleets_and_tells_what_changed() -> None:
    opened, added, gone, rest, closed, unknown = ask(
        FLEET,
        line(id=1, op="fleet/add", fleet="f", robot=NEW, now=1, audit=True),
        line(id=2, op="fleet/advance", fleet="f", now=4),
        line(id=3, op="fleet/rest", fleet="f"),
        line(id=4, op="fleet/close", fleet="f"),
        line(id=5, op="fleet/rest", fleet="f"),
    )
    assert opened["result"] == {
        "now": 0,
        "plans": [{"robot": "r1", "visits": EAST_PLAN}],
        "unplanned": [],
        "left": [],
    }
    assert [plan["robot"] for plan in added["result"]["plans"]] == added["result"]["audit"]["certified"]
    assert gone["result"] == {"now": 4, "plans": [], "unplanned": [], "left": ["r1"]}
    assert [robot["id"] for robot in rest["result"]["instance"]["robots"]] == ["r2"]
    is_sound = asked("check", instance=rest["result"]["instance"], solution=rest["result"]["solution"])
    assert is_sound["result"]["valid"]
    assert closed["result"] == {"fleets": []}
    assert unknown["error"]["rule"] == "fleet/name"


def test_a_server_keeps_few_fleets() -> None:
    opened = [line(id=n, op="fleet/open", fleet=str(n), instance=TWO) for n in range(9)]
    assert [answer.get("error", {}).get("rule") for answer in ask(*opened)] == [*8 * [None], "fleet/name"]
