"""The small language in which the cases are written."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from carp_spec.documents import INSTANCE_FORMAT, SOLUTION_FORMAT
from carp_spec.vectors import Expected, Fields, Flag, Vector

Stay: TypeAlias = list[str | int | None]
Flags: TypeAlias = Sequence[Flag]

EDGE: Flags = ("edge-case",)
KNOWN_BUG: Flags = ("known-bug-elsewhere",)
FREE: Flags = ("free-choice",)


def graph(edges: str, *, directed: bool = False, **attributes: Mapping[str, int]) -> Fields:
    """A graph of resources with one-letter ids: `ab bc` are two edges; `b={"capacity": 2}` is more about b."""
    ids = dict.fromkeys(edges.replace(" ", ""))
    return {
        "directed": directed,
        "nodes": [{"id": id, **attributes.get(id, {})} for id in ids],
        "edges": [{"source": edge[0], "target": edge[1]} for edge in edges.split()],
    }


def row(ids: str, **attributes: Mapping[str, int]) -> Fields:
    """A corridor: resources in a row, each joined to the next."""
    return graph(" ".join(ids[at : at + 2] for at in range(len(ids) - 1)), directed=False, **attributes)


def robot(id: str | int, start: str, goal: str, **more: int) -> Fields:
    """A robot; `more` are its release and its pace."""
    return {"id": id, "start": start, "goal": goal, **more}


def instance(graph: Fields, *robots: Fields, after_goal: str = "vanish") -> Fields:
    """An instance."""
    return {"format": INSTANCE_FORMAT, "graph": graph, "after_goal": after_goal, "robots": [*robots]}


def parking(graph: Fields, *robots: Fields) -> Fields:
    """An instance whose robots stay at their goals."""
    return instance(graph, *robots, after_goal="park")


def stays(text: str) -> list[Stay]:
    """Visits: `a 0 1, b 1 -` is a from 0 to 1, then b for ever."""
    visits: list[Stay] = []
    for stay in text.split(", ") if text else []:
        resource, enter, leave = stay.split()
        visits.append([resource, int(enter), None if leave == "-" else int(leave)])
    return visits


def solution(unplanned: Sequence[str | int] = (), /, **plans: str) -> Fields:
    """A solution with these plans, planned in this order."""
    return {
        "format": SOLUTION_FORMAT,
        "plans": [{"robot": robot, "visits": stays(visits)} for robot, visits in plans.items()],
        "order": [*plans],
        "unplanned": [*unplanned],
    }


def case(  # noqa: PLR0913 - the fields of a case
    id: str,
    op: str,
    comment: str,
    *,
    instance: Any = None,  # noqa: ANN401 - some documents are malformed
    input: Fields | None = None,
    claim: Fields | None = None,
    violated: Sequence[str] = (),
    answer: Fields | None = None,
    flags: Flags = (),
) -> Vector:
    """A case; it is invalid if it violates a rule."""
    expected: Expected = "invalid" if violated else "valid"
    return Vector(id, op, instance, input or {}, claim, expected, tuple(violated), answer or {}, tuple(flags), comment)


def check(  # noqa: PLR0913 - the fields of a case
    id: str,
    comment: str,
    instance: Fields,
    solution: Fields,
    *violated: str,
    cost: int,
    unplanned: int = 0,
    flags: Flags = (),
) -> Vector:
    """A solution to judge."""
    answer = {"cost": cost, "unplanned": unplanned}
    return case(
        id,
        "check",
        comment,
        instance=instance,
        input={"solution": solution},
        violated=violated,
        answer=answer,
        flags=flags,
    )


def query(  # noqa: PLR0913 - the fields of a case
    id: str,
    comment: str,
    instance: Fields,
    committed: Fields,
    claim: str | None,
    *violated: str,
    cost: int | None,
    now: int = 0,
    flags: Flags = (),
) -> Vector:
    """A query for the instance's first robot; the claim is a plan, or `None` for the claim that there is none."""
    named = {plan["robot"] for plan in committed["plans"]}
    unplanned = [robot["id"] for robot in instance["robots"] if robot["id"] not in named]
    return case(
        id,
        "query",
        comment,
        instance=instance,
        input={"solution": {**committed, "unplanned": unplanned}, "robot": instance["robots"][0]["id"], "now": now},
        claim={"plan": None if claim is None else stays(claim)},
        violated=violated,
        answer={"cost": cost},
        flags=flags,
    )


def predicate(  # noqa: PLR0913 - the fields of a case
    rule: str,
    id: str,
    comment: str,
    input: Fields,
    *,
    name: str,
    right: object,
    claimed: Sequence[object] = (),
    flags: Flags = (),
    instance: Fields | None = None,
) -> list[Vector]:
    """The right answer of a rule's predicate as a valid case, and each other one claimed as an invalid case."""
    valid = case(
        id, rule, comment, instance=instance, input=input, claim={name: right}, answer={name: right}, flags=flags
    )
    wrong = [
        case(
            f"{id}-wrong{'' if number == 1 else f'-{number}'}",
            rule,
            comment,
            instance=instance,
            input=input,
            claim={name: claim},
            violated=[rule],
            answer={name: right},
            flags=flags,
        )
        for number, claim in enumerate(claimed, start=1)
    ]
    return [valid, *wrong]
