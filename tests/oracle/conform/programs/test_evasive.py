"""Programs and functions that are never caught in a wrong answer, as they give none, or damage what judges look at."""

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeAlias

import pytest
from msgspec import structs
from tests.oracle.conform.judging.test_judges import Tampered, as_it_is

import carp_reference
from carp_spec import Carp, Instance, Plan, Solution, Visit
from carp_spec.documents.instances import digest
from carp_spec.documents.verdicts import VerdictDocument
from carproof import BoundDocument
from carproof.conform.answers import Reply, Skipped
from carproof.conform.cases import NO_PLANS, Case
from carproof.conform.levels import Level
from carproof.conform.programs.function import Function
from carproof.conform.run import Options, conform
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument

Right: TypeAlias = Any
"""The right reply, of the kind that the case asks for."""
Evasion = Callable[[Case, Right], Reply]
NO_TIME = Skipped("no time")


def is_undecided(_: Case, __: Right) -> Reply:
    return OptimumDocument(None, None, decided=False, solution=None)


def finds_and_does_not_prove(_: Case, reply: Right) -> Reply:
    return OptimumDocument(reply.cost, reply.lower, decided=False, solution=reply.solution)


def answers_up_to(robots: int) -> Evasion:
    return lambda case, reply: reply if len(case.instance.robots) <= robots else NO_TIME


def skips_the_unknown(case: Case, reply: Right) -> Reply:
    return NO_TIME if case.stage == "random" else reply


def answers_one_op(case: Case, reply: Right) -> Reply:
    return reply if case.op == "query" else NO_TIME


def plans_nobody(case: Case, _: Right) -> Reply:
    return QueryDocument(None) if case.op == "query" else Solution.of(case.instance, ())


def plans_one(case: Case, reply: Right) -> Reply:
    return Solution.of(case.instance, reply.plans[:1])


def gives_back(case: Case, _: Right) -> Reply:
    return Solution.of(case.instance, case.solution.plans)


def bounds_by_nothing(_: Case, reply: Right) -> Reply:
    robots = tuple((robot, None if least is None else 0) for robot, least in reply.robots)
    return BoundDocument("carproof-bound/1", reply.instance, 0, 1, 0, (), (), (), robots)


@pytest.mark.parametrize(
    ("evasion", "ops", "level", "rule"),
    [
        (is_undecided, "optimum", Level.OPTIMAL, "program/answers"),
        (finds_and_does_not_prove, "optimum", Level.OPTIMAL, "program/answers"),
        (answers_up_to(0), "query plan add polish", Level.EXACT, "program/answers"),
        (answers_up_to(1), "optimum", Level.OPTIMAL, "program/answers"),
        (answers_up_to(1), "plan", Level.SOUND, "program/answers"),
        (skips_the_unknown, "query plan", Level.EXACT, "program/answers"),
        (answers_one_op, "query plan", Level.CONTEXT_OPTIMAL, "program/answers"),
        (plans_nobody, "query plan", Level.SOUND, "program/tries"),
        (plans_one, "plan", Level.SOUND, "program/tries"),
        (gives_back, "add", Level.SOUND, "program/tries"),
        (gives_back, "polish", Level.SOUND, "program/tries"),
        (bounds_by_nothing, "bound", Level.SOUND, "program/tries"),
    ],
)
def test_who_only_keeps_silent_well_does_not_conform(evasion: Evasion, ops: str, level: Level, rule: str) -> None:
    report = conform(Tampered(evasion, tuple(ops.split())), Options(level, examples=60, shrink_seconds=1))
    assert (report.conforms, report.findings) == (False, [])
    assert [shortfall for shortfall in report.shortfalls if shortfall.endswith(f"[{rule}]")]


class Repeating(Tampered):
    """Right where everybody knows the question; to any other it gives the last right answer once more."""

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        if case.stage != "random":
            self.last = super().ask(case, seconds)
        return self.last


def calls_all_valid(_: Case, reply: Right) -> Reply:
    assert isinstance(reply, VerdictDocument)
    return structs.replace(reply, valid=True, violations=())


def bounds_another(case: Case, reply: Right) -> Reply:
    other = replace(case.instance, after_goal="park", robots=case.instance.robots[:-1])
    assert isinstance(reply, BoundDocument)
    return structs.replace(reply, instance=digest(other))


@pytest.mark.parametrize(
    ("subject", "rules"),
    [
        (Repeating(as_it_is, ("plan",)), {"solution/covers", "plan/start", "plan/goal", "plan/resource"}),
        (Tampered(calls_all_valid, ("check",)), {"plan/duration", "joint/capacity", "joint/exchange", "plan/start"}),
        (Tampered(bounds_another, ("bound",)), {"bound/instance"}),
    ],
)
def test_who_answers_anything_gives_wrong_answers(subject: Tampered, rules: set[str]) -> None:
    report = conform(subject, Options(examples=60, shrink_seconds=1))
    assert report.conforms is False
    assert {finding.rule for finding in report.findings} & rules


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
