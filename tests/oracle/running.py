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
BROKEN = solution({"r1": EAST_PLAN, "r2": [["b", 0, 2], ["c", 2, 3], ["d", 3, 4], ["e", 4, 5]]})


REQUESTS: dict[str, Document] = {
    "start": {"version": 1},
    "check": {"instance": TWO, "solution": TWO_PLANNED},
    "query": {"instance": TWO, "solution": ONE_PLANNED, "robot": "r2"},
    "plan": {"instance": TWO, "planner": "shuffled", "attempts": 2},
    "add": {"instance": TWO, "solution": ONE_PLANNED, "robot": "r2", "now": 0, "m": 1},
    "polish": {"instance": TWO, "solution": TWO_PLANNED, "iterations": 3},
    "optimum": {"instance": TWO, "limit": 10},
    "bound": {"instance": TWO, "steps": 3},
    "audit": {"instance": TWO, "solution": TWO_PLANNED},
    "stop": {},
}
"""A right request of each op."""


def line(**fields: object) -> bytes:
    """A request of the protocol."""
    return json.dumps(fields).encode() + b"\n"
