"""Writes a failure as files that can be read without carproof, and as a vector that can be asked again."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import click
import msgspec

from carp_spec import Refusal, Solution, judge, plan_cost, violations_of
from carp_spec.documents.instances import instance_document, write_instance
from carp_spec.documents.solutions import solution_of, write_solution
from carp_spec.execution.traces import Trace
from carproof.command_line.files import write_whole
from carproof.command_line.tables import printable
from carproof.conform.cases import POLISH_ROUNDS, Case, planned_by, request_fields
from carproof.conform.judging.claims import features
from carproof.conform.judging.outcome import Outcome
from carproof.conform.reporting.advice import advice_for
from carproof.conform.reporting.drawing import drawing, map_drawing
from carproof.engines import engine_named
from carproof.formats.movingai_writer import MAP_NAME, write_movingai
from carproof.optima import OptimumDocument
from carproof.protocol.ops.op import made
from carproof.protocol.ops.planning import QueryDocument
from carproof.rules import ALL_RULES
from carproof.testing.vectors import vectors
from carproof.viewer.stills import view_chart, view_map

SCEN_NAME = "instance.scen"
FILES = (
    "finding.txt",
    "instance.json",
    "request.json",
    "vector.json",
    "map.txt",
    "map.svg",
    "picture.txt",
    "picture.svg",
    "solution.json",
    MAP_NAME,
    SCEN_NAME,
)
"""The files that the folder of a failure can hold."""
NO_PICTURE = '<svg xmlns="http://www.w3.org/2000/svg" width="900" height="40"><text x="8" y="24">{}</text></svg>\n'


@dataclass(frozen=True, slots=True)
class Origin:
    """Where findings come from: who was judged by which level, and the command lines that repeat all or one case.

    The command line of one case names the files of its folder as `{request}`, `{instance}`, `{map}` and `{scen}`, and
    the number of agents as `{agents}`.
    """

    judged: str = ""
    again: str = ""
    one: str = ""


def save(outcome: Outcome, folder: Path, origin: Origin = Origin()) -> None:
    """Write a failure into a folder, which is made if it does not exist."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be made: {error.strerror}") from error
    case, judged = outcome.case, judged_solution(outcome)
    files = {
        "finding.txt": _finding_text(outcome, folder, origin).encode(),
        "map.txt": map_drawing(case.instance).encode(),
        "map.svg": _drawn(lambda: view_map(case.instance, judged, at=_first_tick(outcome), title=outcome.fault.rule)),
        "instance.json": write_instance(case.instance),
        "request.json": msgspec.json.encode({"id": 1, "op": case.op, **request_fields(case)}) + b"\n",
        "vector.json": msgspec.json.format(msgspec.json.encode(vectors_document(outcome))) + b"\n",
        "picture.txt": picture_of(outcome).encode(),
        "picture.svg": _drawn(lambda: view_chart(case.instance, judged, title=outcome.fault.rule)),
        "solution.json": write_solution(judged),
    }
    if case.classical:
        benchmark = write_movingai(case.instance)
        files |= {MAP_NAME: benchmark.map, SCEN_NAME: benchmark.scen}
    for name, data in files.items():
        write_whole(folder / name, data)


def picture_of(outcome: Outcome) -> str:
    """A small picture in text."""
    return drawing(outcome.case.instance, judged_solution(outcome).plans)


def _drawn(draw: Callable[[], bytes]) -> bytes:
    """A picture; where it is too large, one that says so."""
    try:
        return draw()
    except Refusal as refusal:
        return NO_PICTURE.format(escape(refusal.message)).encode()


def _first_tick(outcome: Outcome) -> int:
    """The tick at which a rule is first broken; where no plan breaks one, that of the first release."""
    instance, plans = outcome.case.instance, judged_solution(outcome).plans
    starts = [violation.start for violation in violations_of(instance, plans) if violation.start is not None]
    return min(starts) if starts else min((robot.release for robot in instance.robots), default=0)


def judged_solution(outcome: Outcome) -> Solution:
    """The plans to look at: the program's, together with those that it was given."""
    answer, given = outcome.answer, outcome.case.solution
    if isinstance(answer, Solution):
        return answer
    if isinstance(answer, OptimumDocument) and answer.solution is not None:
        return solution_of(answer.solution)
    if isinstance(answer, Trace):
        entered = tuple(plan for plan in answer.plans if plan.visits)
        missing = tuple(plan.robot for plan in answer.plans if not plan.visits)
        return Solution(entered, tuple(plan.robot for plan in entered), (*missing, *given.unplanned))
    robot = outcome.case.robot
    plan = answer.plan_of(robot) if isinstance(answer, QueryDocument) and robot is not None else None
    if plan is not None:
        others = tuple(plan for plan in given.plans if plan.robot != robot)
        order = (*(plan.robot for plan in others), plan.robot)
        return Solution((*others, plan), order, tuple(each for each in given.unplanned if each != robot))
    return given


def _finding_text(outcome: Outcome, folder: Path, origin: Origin) -> str:
    finding, case = outcome.fault, outcome.case
    statement = next((rule.statement for rule in ALL_RULES if rule.id == finding.rule), "")
    asked = "" if case.robot is None else f" of robot {case.robot} at tick {case.now}"
    lines = [
        f"{finding.category}: {finding.message} [{finding.rule}]",
        f"The rule: {statement}",
        f"Advice: {advice_for(finding.rule)}",
        f"Asked: {case.op}{asked} (request.json). The plans, the program's with those it was given: solution.json.",
    ]
    about = about_case(case)
    lines += [f"About the case: {about}"] if about else []
    lines += [f"This case alone: {filled(origin.one, case, folder)}"] if origin.one else []
    lines += [f"Again: {origin.again}"] if origin.again else []
    if finding.stderr:
        lines += ["The end of the program's standard error:", *map(printable, finding.stderr.splitlines())]
    return "\n".join(lines) + "\n"


def filled(one: str, case: Case, folder: Path) -> str:
    """The command line of one case, with the files of its folder."""
    names = {"request": "request.json", "instance": "instance.json", "map": MAP_NAME, "scen": SCEN_NAME}
    values = {name: str(folder / file) for name, file in names.items()} | {"agents": str(len(case.instance.robots))}
    for name, value in {**values, "solution": "/dev/stdout"}.items():
        one = one.replace(f"{{{name}}}", value)
    return one


def about_case(case: Case) -> str:
    """The comment of the vector or the name of the smoke case, and the features; of a random case its features."""
    comments = {vector.id: vector.comment for vector in vectors()}
    named = comments.get(case.name, "" if case.name == case.op else case.name)
    return "; ".join(each for each in (named, ", ".join(sorted(features(case)))) if each)


def vectors_document(outcome: Outcome) -> dict[str, Any]:
    """The failure as a file of one test vector; the program's answer is its claim."""
    finding, case = outcome.fault, outcome.case
    vector = {
        "id": f"{finding.rule}/found",
        "op": case.op,
        "instance": instance_document(case.instance),
        "input": {name: value for name, value in request_fields(case).items() if name != "instance"},
        "claim": None if outcome.answer is None else msgspec.to_builtins(made(outcome.answer)),
        "expected": "invalid",
        "violated": [finding.rule],
        "answer": right_answer(case),
        "flags": [],
        "comment": f"{finding.category}: {finding.message}",
    }
    return {"format": "carproof-vectors/1", "subject": finding.rule, "flags": {}, "cases": [vector]}


def right_answer(case: Case) -> dict[str, Any]:
    """The right answer, as far as vectors have it."""
    engine = engine_named("reference")
    if case.op == "query" and case.robot is not None:
        plan = engine.query(case.instance, case.solution.plans, case.robot, case.now)
        return {"cost": None if plan is None else plan_cost(case.instance, plan)}
    solution = case.solution
    if case.op in ("plan", "add"):
        solution = planned_by(engine, case)
    if case.op == "polish":
        solution = engine.polish(case.instance, solution, iterations=POLISH_ROUNDS)
    verdict = judge(case.instance, solution)
    return {"cost": verdict.cost, "unplanned": verdict.unplanned}
