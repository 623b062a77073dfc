"""Writes a failure as files that need no program of ours to read, and a vector that can be asked again."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, cast
from xml.sax.saxutils import escape

import click
import msgspec

from carp_spec import Refusal, Solution, write_instance, write_solution
from carp_spec.documents import instance_document, solution_of
from carp_spec.vectors import vectors
from carproof.conform.advice import advice_for
from carproof.conform.answers import Answer
from carproof.conform.cases import POLISH_ROUNDS, Case, case_input, request_fields
from carproof.conform.drawing import drawing, map_drawing
from carproof.conform.outcome import Outcome
from carproof.files import write_whole
from carproof.movingai_writer import MAP_NAME, write_movingai
from carproof.ops.op import made
from carproof.ops.planning import QueryDocument
from carproof.optima import OptimumDocument
from carproof.rules import ALL_RULES

FILES = (
    "finding.txt",
    "instance.json",
    "request.json",
    "vector.json",
    "map.txt",
    "picture.txt",
    "picture.svg",
    "solution.json",
    MAP_NAME,
    "instance.scen",
)
"""What a folder of a failure can hold."""
NO_PICTURE = '<svg xmlns="http://www.w3.org/2000/svg" width="900" height="40"><text x="8" y="24">{}</text></svg>\n'


def save_all(failures: Sequence[Outcome], folder: Path, again: str) -> None:
    """Write the smallest failure into a folder, and each other one into a folder in it, in place of earlier findings.

    `again` is the command line that repeats the run.
    """
    clear(folder)
    for number, outcome in enumerate(failures, start=1):
        assert outcome.finding is not None  # noqa: S101 - a failure has a finding
        save(outcome, folder if number == 1 else folder / f"{number}-{outcome.finding.rule.replace('/', '-')}", again)


def clear(folder: Path) -> None:
    """Remove the files of an earlier run, and no others."""
    for finding in [*folder.glob("*/finding.txt"), *folder.glob("finding.txt")]:
        for name in FILES:
            (finding.parent / name).unlink(missing_ok=True)
        with suppress(OSError):  # it holds something else
            finding.parent.rmdir()


def save(outcome: Outcome, folder: Path, again: str = "") -> None:
    """Write a failure into a folder, which is made if it is not there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be made: {error.strerror}") from error
    judged = judged_solution(outcome)
    files = {
        "finding.txt": _finding_text(outcome, again).encode(),
        "map.txt": map_drawing(outcome.case.instance).encode(),
        "instance.json": write_instance(outcome.case.instance),
        "request.json": msgspec.json.encode({"id": 1, "op": outcome.case.op, **request_fields(outcome.case)}) + b"\n",
        "vector.json": msgspec.json.format(msgspec.json.encode(vectors_document(outcome))) + b"\n",
        "picture.txt": picture_of(outcome).encode(),
        "picture.svg": chart_of(outcome),
        "solution.json": write_solution(judged),
    }
    if outcome.case.classical:
        benchmark = write_movingai(outcome.case.instance)
        files |= {MAP_NAME: benchmark.map, "instance.scen": benchmark.scen}
    for name, data in files.items():
        write_whole(folder / name, data)


def picture_of(outcome: Outcome) -> str:
    """A small picture in text."""
    return drawing(outcome.case.instance, judged_solution(outcome).plans)


def chart_of(outcome: Outcome) -> bytes:
    """The viewer's chart of resources by time; where it is too large, a picture that says so."""
    from carproof.viewer.stills import chart_still  # noqa: PLC0415 - only failures are drawn

    assert outcome.finding is not None  # noqa: S101 - only failures are saved
    try:
        return chart_still(outcome.case.instance, judged_solution(outcome), outcome.finding.rule)
    except Refusal as refusal:
        return NO_PICTURE.format(escape(refusal.message)).encode()


def judged_solution(outcome: Outcome) -> Solution:
    """The plans to look at: the program's, together with those that it was given."""
    answer, given = outcome.answer, outcome.case.solution
    if isinstance(answer, Solution):
        return answer
    if isinstance(answer, OptimumDocument) and answer.solution is not None:
        return solution_of(answer.solution)
    robot = outcome.case.robot
    plan = answer.plan_of(robot) if isinstance(answer, QueryDocument) and robot is not None else None
    if plan is not None:
        others = tuple(plan for plan in given.plans if plan.robot != robot)
        order = (*(plan.robot for plan in others), plan.robot)
        return Solution((*others, plan), order, tuple(each for each in given.unplanned if each != robot))
    return given


def _finding_text(outcome: Outcome, again: str) -> str:
    finding, case = outcome.finding, outcome.case
    assert finding is not None  # noqa: S101 - only failures are saved
    statement = next((rule.statement for rule in ALL_RULES if rule.id == finding.rule), "")
    asked = "" if case.robot is None else f" of robot {case.robot} at tick {case.now}"
    lines = [
        f"{finding.category}: {finding.message} [{finding.rule}]",
        f"The rule: {statement}",
        f"Advice: {advice_for(finding.rule)}",
        f"Asked: {case.op}{asked} (request.json). The plans, the program's with those it was given: solution.json.",
    ]
    comment = _comments().get(case.name) if case.stage == "vectors" else case.name if case.stage == "smoke" else None
    if comment:
        lines.append(f"About the case: {comment}")
    if again:
        lines.append(f"Again: {again}")
    if finding.stderr:
        lines += ["The end of the program's standard error:", finding.stderr]
    return "\n".join(lines) + "\n"


def _comments() -> Mapping[str, str]:
    """What each published vector is about."""
    return {vector.id: vector.comment for vector in vectors()}


def vectors_document(outcome: Outcome) -> dict[str, Any]:
    """The failure as a file of one test vector; the program's answer is its claim."""
    finding, case = outcome.finding, outcome.case
    assert finding is not None  # noqa: S101 - only failures are saved
    vector = {
        "id": f"{finding.rule}/found",
        "op": case.op,
        "instance": instance_document(case.instance),
        "input": case_input(case),
        "claim": None if outcome.answer is None else claim(outcome.answer),
        "expected": "invalid",
        "violated": [finding.rule],
        "answer": right_answer(case),
        "flags": [],
        "comment": f"{finding.category}: {finding.message}",
    }
    return {"format": "carproof-vectors/1", "subject": finding.rule, "flags": {}, "cases": [vector]}


def claim(answer: Answer) -> dict[str, Any]:
    """A program's answer as the result that it gave."""
    return cast("dict[str, Any]", msgspec.to_builtins(made(answer)))


def right_answer(case: Case) -> dict[str, Any]:
    """The right answer, as far as vectors tell it."""
    from carp_spec import Carp, judge, plan_cost  # noqa: PLC0415
    from carproof.engines import engine_named  # noqa: PLC0415 - only failures need it

    engine = engine_named("reference")
    if case.op == "query" and case.robot is not None:
        plan = engine.query(case.instance, case.solution.plans, case.robot, case.now)
        return {"cost": None if plan is None else plan_cost(case.instance, plan)}
    solution = case.solution
    if case.op == "plan":
        solution = engine.plan(case.instance, case.planner or Carp())
    if case.op == "add" and case.robot is not None:
        solution = engine.add(case.instance, solution, case.robot, case.now, case.options)
    if case.op == "polish":
        solution = engine.polish(case.instance, solution, iterations=POLISH_ROUNDS)
    verdict = judge(case.instance, solution)
    return {"cost": verdict.cost, "unplanned": verdict.unplanned}
