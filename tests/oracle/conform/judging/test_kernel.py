"""`conform --kernel`: the proved kernel decides on plans and on how early they are, and nobody overrules it."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest
from tests.oracle.conform.judging import test_one_answer as answers
from tests.oracle.conform.judging.test_judges import Tampered, as_it_is
from tests.oracle.judging.test_kernel_option import stand_in
from tests.oracle.running import Run
from tests.verify.kernel.program import program

from carp_spec import Carp, Stop, judge
from carp_spec.documents.verdicts import VerdictDocument
from carp_verify.bound.rules import ContradictionError
from carp_verify.kernel import KernelVerdict, ask, version
from carproof import Report, read_instance, read_query_certificate, read_solution, verify_query
from carproof.conform.answers import Answer
from carproof.conform.asking.smoke import FIRST_GOES
from carproof.conform.cases import Case
from carproof.conform.findings import Finding, wrong
from carproof.conform.judging import by_kernel
from carproof.conform.judging.by_kernel import EARLY, LAWFUL, require_agreement
from carproof.conform.judging.judges import first_finding
from carproof.conform.levels import Level
from carproof.conform.run import Options, conform


def run(ops: tuple[str, ...]) -> Report:
    program()
    return conform(Tampered(as_it_is, ops), Options(Level.CONTEXT_OPTIMAL, 25, shrink_seconds=1, kernel=version()))


def test_the_kernel_accepts_a_planner_whose_plans_are_early() -> None:
    report = run(("check", "query", "plan", "add", "polish"))
    assert (report.conforms, report.findings) == (True, [])
    assert report.options.by == "carproof-kernel 1"


def test_a_kernel_that_differs_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def other(requests: Sequence[bytes]) -> list[KernelVerdict]:
        return [msgspec.structs.replace(answer, verdict="refused") for answer in ask(requests)]

    monkeypatch.setattr(by_kernel, "ask", other)
    with pytest.raises(ContradictionError, match="kernel"):
        run(("plan",))


def test_without_a_kernel_or_above_its_levels_nothing_is_asked(
    carproof: Run, elsewhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(monkeypatch, verdict="accepted")
    outcome = carproof("conform", "--kernel", "--level", "exact", "--", "true")
    assert outcome.code == 2
    assert "--level must be at most context-optimal" in outcome.stderr
    monkeypatch.setenv("CARPROOF_KERNEL", str(elsewhere / "none"))
    outcome = carproof("conform", "--kernel", "--", "true")
    assert outcome.code == 2
    assert "there is no program carproof-kernel" in outcome.stderr


KERNELS_LEVELS = (Level.SOUND, Level.COMPLETE_IN_CONTEXT, Level.CONTEXT_OPTIMAL)
KERNELS_PLANS = [
    row for row in (*answers.QUERIES, *answers.PLANS) if row[0].planner in (None, Carp()) and not row[0].classical
]
LAWLESS = wrong("plan/start", "it starts elsewhere")
MISSING = wrong("query/complete", "it has a plan")
LATE = wrong("query/optimal", "it is late")


def decided(document: Any) -> KernelVerdict:  # noqa: ANN401 - a request
    """The answer of a kernel that decides as carp_spec and carp_verify do."""
    instance, solution, certificate = (
        msgspec.json.encode(document.get(name)) for name in ("instance", "solution", "certificate")
    )
    if document["op"] == "check":
        is_right = judge(read_instance(instance), read_solution(solution)).valid
        return KernelVerdict("7", "accepted" if is_right else "refused")
    verify_query(read_instance(instance), read_solution(solution), read_query_certificate(certificate))
    return KernelVerdict("7", "accepted")


def let_kernel_decide(monkeypatch: pytest.MonkeyPatch, wrong: Mapping[int, bool] | None = None) -> list[Any]:
    """Let a kernel decide that is right but for the requests of these numbers; returns what it is asked."""
    asked: list[Any] = []

    def answer(data: bytes) -> KernelVerdict:
        verdict = decided(json.loads(data))
        if wrong is not None and len(asked) in wrong:
            verdict = msgspec.structs.replace(verdict, verdict="accepted" if wrong[len(asked)] else "refused")
        asked.append(json.loads(data))
        return verdict

    monkeypatch.setattr(by_kernel, "ask", lambda requests: [answer(each) for each in requests])
    return asked


def require_contradiction(asked: Case, answer: Answer, level: Level, finding: Finding | None, words: str) -> None:
    with pytest.raises(ContradictionError, match=re.escape(words)):
        require_agreement(asked, answer, level, finding)


@pytest.mark.parametrize("level", KERNELS_LEVELS)
@pytest.mark.parametrize("row", [*KERNELS_PLANS, *answers.ADDITIONS, *answers.POLISHES, *answers.CHECKS])
def test_a_kernel_agrees_unless_it_decides_otherwise_on_the_plans(
    row: answers.Row, level: Level, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, answer, _ = row
    finding = first_finding(asked, answer, level)
    requests = let_kernel_decide(monkeypatch)
    require_agreement(asked, answer, level, finding)
    is_verdict = isinstance(answer, VerdictDocument)
    if is_verdict and finding is not None:
        assert requests == []
    elif finding is None or finding.rule.startswith(LAWFUL):
        let_kernel_decide(monkeypatch, {0: not decided(requests[0]).accepted})
        shown = "nothing wrong" if finding is None else f"{finding.message} [{finding.rule}]"
        require_contradiction(asked, answer, level, finding, f"differ on one: carp_spec finds {shown}")


@pytest.mark.parametrize("level", KERNELS_LEVELS)
@pytest.mark.parametrize("row", KERNELS_PLANS)
def test_a_kernel_contradicts_what_is_found_otherwise(
    row: answers.Row, level: Level, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, answer, _ = row
    let_kernel_decide(monkeypatch)
    finding = first_finding(asked, answer, level)
    if finding is None:
        for other in (LAWLESS, *(each for each in (MISSING, LATE) if level >= Level.COMPLETE_IN_CONTEXT)):
            require_contradiction(asked, answer, level, other, f"{other.message} [{other.rule}]")
    elif finding.rule.startswith(LAWFUL) or finding.rule in EARLY:
        require_contradiction(asked, answer, level, None, "carp_spec finds nothing wrong")


@pytest.mark.parametrize(
    ("asked", "answer", "robots"),
    [
        (answers.QUERY, answers.goes(*FIRST_GOES), ["new"]),
        (answers.QUERY_UNDER_WAY, answers.goes(*FIRST_GOES), ["new"]),
        (answers.PLAN, answers.ADDED, ["first", "new"]),
        (answers.FREE, answers.ASIDE_SECOND, ["new", "first"]),
    ],
)
def test_a_kernel_is_asked_about_each_robot_for_the_best_plan_and_why_none_is_better(
    asked: Case, answer: Answer, robots: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for level in KERNELS_LEVELS:
        requests = let_kernel_decide(monkeypatch)
        require_agreement(asked, answer, level, None)
        certificates = [each["certificate"] for each in requests if each["op"] == "verify-query"]
        assert [each["robot"] for each in certificates] == (robots if level > Level.SOUND else [])
        assert [each["now"] for each in certificates] == [asked.now] * len(certificates)
        assert [each["op"] for each in requests] == ["check", *["verify-query", "check"] * len(certificates)]
        for number in range(1, len(requests)):
            let_kernel_decide(monkeypatch, {number: False})
            require_contradiction(asked, answer, level, None, "carproof-kernel 7 refuses carproof's own on one")


def test_a_kernel_is_asked_about_plans_alone_with_stops_too(monkeypatch: pytest.MonkeyPatch) -> None:
    requests = let_kernel_decide(monkeypatch)
    require_agreement(answers.OPTIMUM, answers.BEST, Level.SOUND, LAWLESS)
    require_agreement(answers.case("bound", answers.ALONE), answers.BOUND, Level.SOUND, LAWLESS)
    assert requests == []
    [robot] = answers.ALONE.robots
    serving = replace(
        answers.QUERY, instance=replace(answers.ALONE, robots=(replace(robot, stops=(Stop(robot.goal, 1),)),))
    )
    require_agreement(serving, answers.right(serving), Level.SOUND, None)
    assert [each["op"] for each in requests] == ["check"]
