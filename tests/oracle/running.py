"""The result of a command line, and documents that several tests use."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Outcome:
    """The result of a command line."""

    code: int
    stdout: str
    stderr: str


Run = Callable[..., Outcome]
Document = dict[str, Any]


def town(edges: str, robots: list[Document], after_goal: str = "vanish") -> Document:
    """An instance: its cells are letters, its edges pairs of them."""
    cells = dict.fromkeys(edges.replace(" ", ""))
    return {
        "format": "carproof-instance/1",
        "graph": {
            "nodes": [{"id": cell} for cell in cells],
            "edges": [{"source": edge[0], "target": edge[1]} for edge in edges.split()],
        },
        "after_goal": after_goal,
        "robots": robots,
    }


def corridor(robots: list[Document], after_goal: str = "vanish") -> Document:
    """An instance: five cells a, b, c, d, e in a row."""
    row = town("ab bc cd de", robots, after_goal)
    for x, cell in enumerate(row["graph"]["nodes"]):
        cell |= {"x": x, "y": 0}
    return row


def solution(plans: dict[str, list[list[Any]]], unplanned: list[str] | None = None) -> Document:
    """A solution."""
    return {
        "format": "carproof-solution/1",
        "plans": [{"robot": robot, "visits": visits} for robot, visits in plans.items()],
        "order": list(plans),
        "unplanned": unplanned or [],
    }


def save(**documents: object) -> None:
    """Write documents into the folder that a test is in, each by its name."""
    for name, document in documents.items():
        Path(f"{name}.json").write_text(json.dumps(document))


EAST: Document = {"id": "r1", "start": "a", "goal": "c"}
BEHIND: Document = {"id": "r2", "start": "b", "goal": "e"}
HEAD_ON: Document = {"id": "r3", "start": "e", "goal": "a"}
EAST_PLAN = [["a", 0, 1], ["b", 1, 2], ["c", 2, 3]]
BEHIND_PLAN = [["b", 0, 1], ["c", 1, 2], ["d", 2, 3], ["e", 3, 4]]
TWO = corridor([EAST, BEHIND])
TWO_PLANNED = solution({"r1": EAST_PLAN, "r2": BEHIND_PLAN})
ONE_PLANNED = solution({"r1": EAST_PLAN})
UNDER_WAY: Document = {
    "format": "carproof-trace/1",
    "now": 2,
    "plans": [{"robot": "r1", "visits": [["a", 0, None]]}, {"robot": "r2", "visits": [["b", 0, 2], ["c", 2, None]]}],
}
"""By tick 2 robot r2 has moved, a tick late, and robot r1 waits."""
BOUND: Document = {
    "format": "carproof-bound/1",
    "instance": "463f01f1b451a1dab18d0ca26092932c91cdce8f71488efcf3d9052315f0d679",
    "bound": 5,
    "scale": 1,
    "horizon": 36,
    "resources": [],
    "exchanges": [],
    "cuts": [],
    "robots": [["r1", 2], ["r2", 3]],
}
EARLIEST: Document = {
    "format": "carproof-query/1",
    "robot": "r2",
    "now": 0,
    "bound": 3,
    "labels": [],
    "potential": [["e", 0], ["d", 1], ["c", 2], ["b", 3], ["a", 4]],
}
BROKEN = solution({"r1": EAST_PLAN, "r2": [["b", 0, 2], ["c", 2, 3], ["d", 3, 4], ["e", 4, 5]]})


REQUESTS: dict[str, Document] = {
    "start": {"version": 1},
    "check": {"instance": TWO, "solution": TWO_PLANNED},
    "query": {"instance": TWO, "solution": ONE_PLANNED, "robot": "r2"},
    "plan": {"instance": TWO, "planner": "shuffled", "attempts": 2},
    "plan-within": {"instance": TWO, "iterations": 3},
    "add": {"instance": TWO, "solution": ONE_PLANNED, "robot": "r2", "now": 0, "m": 1},
    "assign": {"instance": TWO, "solution": TWO_PLANNED, "robot": "r1", "stops": [{"resource": "b"}], "now": 1},
    "polish": {"instance": TWO, "solution": TWO_PLANNED, "iterations": 3},
    "optimum": {"instance": TWO, "limit": 10},
    "bound": {"instance": TWO, "steps": 3},
    "verify-bound": {"instance": TWO, "certificate": BOUND},
    "verify-query": {"instance": TWO, "solution": ONE_PLANNED, "certificate": EARLIEST},
    "audit": {"instance": TWO, "solution": TWO_PLANNED},
    "check-trace": {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY},
    "dependencies": {"instance": TWO, "solution": TWO_PLANNED, "delays": [["r2", 0, 2]]},
    "execute": {"instance": TWO, "solution": TWO_PLANNED, "driver": "order", "delays": [["r2", 0, 2]], "now": 2},
    "drive": {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY, "ready": ["r1"]},
    "retime": {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY},
    "release": {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY, "beyond": ["r1"], "states": 9},
    "check-grants": {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY, "grants": [], "states": 9},
    "untangle": {"instance": TWO, "solution": TWO_PLANNED},
    "give-way": {
        "instance": TWO,
        "solution": TWO_PLANNED,
        "robot": "r1",
        "now": 1,
        "route": EAST_PLAN,
    },
    "fleet/open": {"fleet": "f", "instance": TWO, "solution": ONE_PLANNED, "now": 0, "m": 2},
    "fleet/add": {"fleet": "f", "robot": {"id": "r4", "start": "a", "goal": "b", "release": 3}, "now": 1},
    "fleet/assign": {"fleet": "f", "robot": "r1", "stops": [{"resource": "a", "service": 2}], "now": 1},
    "fleet/advance": {"fleet": "f", "now": 3},
    "fleet/trace": {
        "fleet": "f",
        "trace": {"format": "carproof-trace/1", "now": 2, "plans": [{"robot": "r1", "visits": [["a", 0, None]]}]},
    },
    "fleet/remove": {"fleet": "f", "robot": "r1", "now": 2},
    "fleet/polish": {"fleet": "f", "iterations": 3},
    "fleet/rest": {"fleet": "f"},
    "fleet/forget": {"fleet": "f"},
    "fleet/close": {"fleet": "f"},
    "stop": {},
}
"""A right request of each op."""


def line(**fields: object) -> bytes:
    """A request of the protocol."""
    return json.dumps(fields).encode() + b"\n"


def asked(op: str, **fields: object) -> Document:
    """The server's answer, by the reference."""
    import msgspec

    from carproof.engines import engine_named
    from carproof.protocol.ops.op import Session
    from carproof.protocol.server import respond

    session = Session(engine_named("reference"))
    if op.startswith("fleet/") and op != "fleet/open":
        respond(line(id=0, op="fleet/open", **REQUESTS["fleet/open"]), session)
    response, _ = respond(line(id=1, op=op, **fields), session)
    answer: Document = json.loads(msgspec.json.encode(response))
    return answer
