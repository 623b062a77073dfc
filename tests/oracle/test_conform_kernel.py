"""`conform --kernel`: the proved kernel decides on plans and on how early they are, and nobody overrules it."""

import json
from collections.abc import Sequence
from pathlib import Path

import msgspec
import pytest
from tests.oracle.running import Run
from tests.oracle.test_conform_judges import (
    Tamper,
    Tampered,
    as_it_is,
    late_plan,
    no_plan,
    polishes_into_each_other,
    verdict_is_always_valid,
)
from tests.oracle.test_kernel_option import stand_in
from tests.verify.kernel_program import program

from carp_verify.bound_rules import ContradictionError
from carp_verify.kernel import KernelVerdict, ask, version
from carproof.conform import by_kernel
from carproof.conform.levels import Level
from carproof.conform.run import Options, Report, conform

CONTEXT_OPTIMAL = Level.CONTEXT_OPTIMAL
OPS = ("check", "query", "plan", "add", "polish")


def run(tamper: Tamper, level: Level = CONTEXT_OPTIMAL, ops: tuple[str, ...] = OPS) -> Report:
    program()
    subject = Tampered(tamper)
    subject.ops = ops
    return conform(subject, Options(level, 25, shrink_seconds=1, kernel=version()))


def test_the_kernel_accepts_a_planner_whose_plans_are_early() -> None:
    report = run(as_it_is)
    assert (report.conforms, report.findings) == (True, [])
    assert report.options.by == "carproof-kernel 1"


@pytest.mark.parametrize(
    ("tamper", "level", "op", "rule"),
    [
        (late_plan, CONTEXT_OPTIMAL, "query", "query/optimal"),
        (no_plan, Level.COMPLETE_IN_CONTEXT, "query", "query/complete"),
        (polishes_into_each_other, Level.SOUND, "plan", "joint/"),
        (verdict_is_always_valid, Level.SOUND, "check", ""),
    ],
)
def test_the_kernel_refuses_as_carp_spec_does(tamper: Tamper, level: Level, op: str, rule: str) -> None:
    report = run(tamper, level, (op,))
    assert report.conforms is False
    assert any(finding.rule.startswith(rule) for finding in report.findings)


@pytest.mark.parametrize(
    ("tamper", "op", "wrong"),
    [
        (as_it_is, "plan", {"verdict": "refused"}),
        (as_it_is, "check", {"verdict": "refused"}),
        (polishes_into_each_other, "plan", {"verdict": "accepted"}),
    ],
)
def test_a_kernel_that_differs_ends_the_run(
    monkeypatch: pytest.MonkeyPatch, tamper: Tamper, op: str, wrong: dict[str, str]
) -> None:
    def other(requests: Sequence[bytes]) -> list[KernelVerdict]:
        return [msgspec.structs.replace(answer, **wrong) for answer in ask(requests)]

    monkeypatch.setattr(by_kernel, "ask", other)
    with pytest.raises(ContradictionError, match="kernel"):
        run(tamper, ops=(op,))


def test_a_certificate_that_the_kernel_refuses_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def other(requests: Sequence[bytes]) -> list[KernelVerdict]:
        refused = b'"op":"verify-query"'
        return [
            msgspec.structs.replace(answer, verdict="refused") if refused in asked else answer
            for asked, answer in zip(requests, ask(requests), strict=True)
        ]

    monkeypatch.setattr(by_kernel, "ask", other)
    with pytest.raises(ContradictionError, match="refuses carproof's own"):
        run(as_it_is, ops=("plan",))
    assert run(as_it_is, Level.SOUND, ("plan",)).conforms


def test_the_verdict_names_who_decided(carproof: Run, tmp_path: Path) -> None:
    program()
    arguments = ("conform", "--save", tmp_path, "--level", "context-optimal")
    by = [
        json.loads(carproof(*arguments, *kernel, "--json", "--", "false").stdout)["by"]
        for kernel in ((), ("--kernel",))
    ]
    assert by == ["carp_spec", "carproof-kernel 1"]
    outcome = carproof(*arguments, "--kernel", "--", "false")
    assert (outcome.code, outcome.stdout.splitlines()[-1]) == (1, "decided by carproof-kernel 1")


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
