"""Programs and functions that are never caught in a wrong answer, as they give none, or damage what judges look at."""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.oracle.test_conform_judges import Tampered, as_it_is

import carp_reference
from carp_spec import Carp, Instance, Plan, Solution, Visit
from carproof.conform.cases import NO_PLANS
from carproof.conform.levels import Level
from carproof.conform.programs.child import Limits
from carproof.conform.programs.function import Function
from carproof.conform.programs.program import Program
from carproof.conform.run import Options, Report, conform

PATIENT = 30.0
EVASIVE = [sys.executable, str(Path(__file__).with_name("evasive.py"))]


def run(how: str, ops: str, level: Level) -> Report:
    program = Program([*EVASIVE, how, ops], Limits(seconds=PATIENT))
    return conform(program, Options(level, examples=60, limit=PATIENT, shrink_seconds=1))


@pytest.mark.parametrize(
    ("how", "ops", "level", "rule"),
    [
        ("is undecided", "optimum", Level.OPTIMAL, "program/answers"),
        ("finds and does not prove", "optimum", Level.OPTIMAL, "program/answers"),
        ("answers empty fleets", "query,plan,add,polish", Level.EXACT, "program/answers"),
        ("answers one robot", "optimum", Level.OPTIMAL, "program/answers"),
        ("answers one robot", "plan", Level.SOUND, "program/answers"),
        ("skips the unknown", "query,plan", Level.EXACT, "program/answers"),
        ("answers one op", "query,plan", Level.CONTEXT_OPTIMAL, "program/answers"),
        ("plans nobody", "query,plan", Level.SOUND, "program/tries"),
        ("plans one", "plan", Level.SOUND, "program/tries"),
        ("adds nobody", "add", Level.SOUND, "program/tries"),
        ("gives back", "polish", Level.SOUND, "program/tries"),
        pytest.param("bounds by nothing", "bound", Level.SOUND, "program/tries", marks=pytest.mark.ci),
    ],
)
def test_who_only_keeps_silent_well_does_not_conform(how: str, ops: str, level: Level, rule: str) -> None:
    report = run(how, ops, level)
    assert (report.conforms, report.findings) == (False, [])
    assert [shortfall for shortfall in report.shortfalls if shortfall.endswith(f"[{rule}]")]


@pytest.mark.parametrize(
    ("how", "ops", "level", "rules"),
    [
        ("repeats itself", "plan", Level.SOUND, {"solution/covers", "plan/start", "plan/goal", "plan/resource"}),
        ("leaves", "query", Level.SOUND, {"program/alive"}),
        ("calls all valid", "check", Level.SOUND, {"plan/duration", "joint/capacity", "joint/exchange", "plan/start"}),
        ("bounds another", "bound", Level.SOUND, {"bound/instance"}),
    ],
)
def test_who_answers_anything_gives_wrong_answers(how: str, ops: str, level: Level, rules: set[str]) -> None:
    report = run(how, ops, level)
    assert report.conforms is False
    assert {finding.rule for finding in report.findings} & rules


@pytest.mark.parametrize("level", [level for level in Level if level > Level.SOUND])
def test_an_op_that_plans_nobody_shows_no_level_above_sound(level: Level) -> None:
    subject = Tampered(as_it_is, ("check", "bound"))
    report = conform(subject, Options(level, examples=20))
    assert (report.conforms, report.findings) == (False, [])
    assert report.shortfalls[0].startswith("it offers nothing that shows the level")


def test_nothing_is_decided_without_random_cases() -> None:
    report = conform(Tampered(as_it_is), Options(Level.SOUND, examples=0))
    assert (report.conforms, report.shortfalls) == (None, [])


def right(instance: Instance) -> Solution:
    return carp_reference.plan(instance, Carp())


def forgets_the_robots(instance: Instance) -> Solution:
    object.__setattr__(instance, "robot", {})
    object.__setattr__(instance, "robots", ())
    return NO_PLANS


def jumps(instance: Instance) -> Solution:
    """Every robot goes from its start straight to its goal, on a map on which that is a move."""
    ids = tuple(instance.graph.index)
    object.__setattr__(instance.graph, "successors", dict.fromkeys(ids, ids))
    return right(instance)


class Fickle(Visit, frozen=True):
    """A visit that ends when it is looked at."""

    def __getattribute__(self, name: str) -> Any:  # noqa: ANN401
        if name == "leave":
            raise RuntimeError("not now")
        return super().__getattribute__(name)


class Never(int):
    """A tick that is in order with every other."""

    def __lt__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    def __eq__(self, other: object) -> bool:
        return True

    def __hash__(self) -> int:
        return 0


def with_visits(solution: Solution, change: Callable[[Visit], Any]) -> Solution:
    plans = [Plan(plan.robot, [change(visit) for visit in plan.visits]) for plan in solution.plans]  # type: ignore[arg-type]
    return replace(solution, plans=plans)  # type: ignore[arg-type]


def never_in_conflict(instance: Instance) -> Solution:
    return with_visits(right(instance), lambda visit: Visit(visit.resource, Never(0), Never(0)))


def says_true_for_one(instance: Instance) -> Solution:
    return with_visits(right(instance), lambda visit: Visit(visit.resource, True, visit.leave))


def is_fickle(instance: Instance) -> Solution:
    return with_visits(right(instance), lambda visit: Fickle(visit.resource, visit.enter, visit.leave))


def names_no_plans(_: Instance) -> Solution:
    return Solution(None, None, None)  # type: ignore[arg-type]


def skips_the_test(_: Instance) -> Solution:
    pytest.skip("it is late")


def ends_python(_: Instance) -> Solution:
    sys.exit(0)


@pytest.mark.parametrize(
    ("planner", "rules"),
    [
        (forgets_the_robots, {"solution/covers"}),
        (jumps, {"plan/move"}),
        (never_in_conflict, {"program/result", "plan/start"}),
        (says_true_for_one, {"program/result"}),
        (is_fickle, {"program/result"}),
        (names_no_plans, {"program/result"}),
        (skips_the_test, {"program/alive"}),
        (ends_python, {"program/alive"}),
    ],
)
def test_a_function_cannot_reach_the_judges(planner: Callable[[Instance], Solution], rules: set[str]) -> None:
    report = conform(Function(planner, "mine"), Options(examples=60, shrink_seconds=1, whole=True))
    assert report.conforms is False
    assert {finding.rule for finding in report.findings} & rules
    assert {finding.rule for finding in report.findings} <= rules | {"plan/goal", "plan/duration", "plan/contiguous"}
