"""Programs that misbehave: each ends in the right category, in time, and leaves no process and no descriptor behind."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from tests.oracle.entry.test_signals import processes_of

from carproof.conform.asking.smoke import smoke_cases
from carproof.conform.cases import Case
from carproof.conform.findings import Category, Fault
from carproof.conform.judging.outcome import ask
from carproof.conform.levels import Level
from carproof.conform.programs.child import Child, Limits
from carproof.conform.programs.one_shot import OneShot
from carproof.conform.programs.program import Program
from carproof.conform.run import Options, Report, conform

HOSTILE = [sys.executable, "-IS", str(Path(__file__).with_name("hostile.py"))]
LIMITS = Limits(seconds=0.5, memory=128, output=2**20)
GENEROUS = 20.0
"""Seconds after which a test calls it a hang: the machine may be busy."""

HOW = {
    "random bytes": (Category.PROTOCOL_ERROR, "program/response"),
    "unknown field": (Category.PROTOCOL_ERROR, "program/result"),
    "endless output": (Category.PROTOCOL_ERROR, "program/response"),
    "endless lines": (Category.PROTOCOL_ERROR, "program/response"),
    "silence": (Category.TIMEOUT, "program/in-time"),
    "slow drip": (Category.TIMEOUT, "program/in-time"),
    "endless standard error": (Category.TIMEOUT, "program/in-time"),
    "exit": (Category.CRASH, "program/alive"),
    "killed": (Category.CRASH, "program/alive"),
    "half an answer": (Category.CRASH, "program/alive"),
    "closed output": (Category.CRASH, "program/alive"),
    "memory": (Category.CRASH, "program/alive"),
    "child left behind": (Category.CRASH, "program/alive"),
}


def opened() -> tuple[int, str]:
    """The number of this process's descriptors, and its children, zombies included."""
    children = Path(f"/proc/self/task/{os.getpid()}/children").read_text()
    return len(list(Path("/proc/self/fd").iterdir())), children


@pytest.fixture(autouse=True)
def marker(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """What the environment of all processes of a test has; afterwards nothing of them is left."""
    name, value = "OF_TEST", f"{os.getpid()}-{time.monotonic_ns()}"
    monkeypatch.setenv(name, value)
    marker, before, started = f"{name}={value}", opened(), time.monotonic()
    yield marker
    assert time.monotonic() - started < GENEROUS
    while processes_of(marker) and time.monotonic() - started < GENEROUS:
        time.sleep(0.05)
    assert processes_of(marker) == []
    assert opened() == before


def query() -> Case:
    return next(iter(smoke_cases(["query"], Level.SOUND, whole=False)))


def run(how: str, *more: str, seconds: float = LIMITS.seconds) -> Report:
    limits = replace(LIMITS, seconds=seconds)
    return conform(Program([*HOSTILE, how, *more], limits), Options(examples=0, limit=seconds))


@pytest.mark.parametrize("how", HOW)
def test_what_is_no_answer_ends_in_its_category(how: str) -> None:
    category, rule = HOW[how]
    waits = category == Category.TIMEOUT or how == "child left behind"
    program = Program([*HOSTILE, how], replace(LIMITS, seconds=LIMITS.seconds if waits else GENEROUS))
    program.start()
    finding = ask(program, query(), Level.SOUND).finding
    program.kill()
    assert finding is not None
    assert finding.category == category, finding
    assert finding.rule == rule
    assert finding.message == finding.message.strip()
    assert "\n" not in finding.message


@pytest.mark.parametrize("how", ["silence", "exit", "random bytes", "endless output", "slow drip"])
def test_a_program_that_fails_at_start_does_not_conform(how: str) -> None:
    report = run(how, "--at-start")
    assert report.conforms is False
    assert not report.outcomes
    assert [fault.category for fault in report.faults] == [HOW[how][0]]


def test_a_second_line_is_an_answer_that_nobody_asked_for() -> None:
    child = Child([sys.executable, "-IS", "-c", "input(); print('one\\ntwo')"], LIMITS)
    try:
        assert child.ask(b"?\n", GENEROUS) == b"one"
        with pytest.raises(Fault, match="more than one line"):
            child.ask(b"?\n", GENEROUS)
    finally:
        child.kill()


def test_a_run_gives_up_after_a_few_lost_processes() -> None:
    report = run("silence")
    assert report.conforms is False
    assert [outcome.finding is not None for outcome in report.outcomes] == [True] * 3


def test_who_skips_everything_does_not_conform() -> None:
    report = run("skips everything", seconds=GENEROUS)
    assert (report.conforms, report.findings, report.judged.total()) == (False, [], 0)
    assert all(outcome.skipped == "no time" for outcome in report.outcomes)


def test_the_end_of_standard_error_is_kept_and_bounded() -> None:
    assert run("exit", seconds=GENEROUS).findings[0].stderr == "out of robots\n"
    assert 0 < len(run("endless standard error").findings[0].stderr) <= 2**14


@pytest.mark.parametrize(("how", "category"), [("never stops", Category.TIMEOUT), ("stops badly", Category.CRASH)])
def test_a_program_must_stop_when_it_is_asked_to(how: str, category: Category) -> None:
    assert [fault.category for fault in run(how, seconds=2).faults] == [category]


def test_a_program_may_write_much_on_standard_error_before_it_ends() -> None:
    assert run("counts at the end", seconds=2).faults == []


def test_a_program_that_was_killed_is_started_again_to_be_stopped() -> None:
    program = Program([*HOSTILE, "stops badly"], LIMITS)
    program.start()
    program.kill()
    program.finish()
    with pytest.raises(Fault, match="asked to stop"):
        program.finish(restart=True)


def test_a_program_that_writes_more_than_it_may_is_told_so() -> None:
    limits = replace(LIMITS, seconds=GENEROUS, output=2**16)
    program = OneShot(["sh", "-c", "head -c 200000 /dev/zero >&2", "{instance}", "{solution}"], limits)
    smoke = next(iter(smoke_cases(("plan",), Level.SOUND, True)))
    with pytest.raises(Fault, match="more than 65536 bytes"):
        program.ask(smoke)


def test_a_program_that_ends_within_its_answer_is_shown_with_its_complaint() -> None:
    program = OneShot(["sh", "-c", "echo '{'; echo no such cell >&2; exit 1", "{instance}"], LIMITS)
    outcome = ask(program, next(iter(smoke_cases(("plan",), Level.SOUND, True))), Level.SOUND)
    assert (outcome.fault.rule, outcome.fault.stderr) == ("program/result", "no such cell\n")


def test_the_environment_tells_nothing_of_the_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CARPROOF_SECRET", "the answer")
    assert os.environ["PYTEST_CURRENT_TEST"]
    assert {outcome.skipped for outcome in run("environment", seconds=GENEROUS).outcomes} == {"nothing visible"}


def test_a_program_that_cannot_be_run_is_a_crash() -> None:
    program = Program(["/nowhere/planner"], LIMITS)
    with pytest.raises(Fault, match="127"):
        program.start()
    program.kill()


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_leaves_no_child_and_ends_with_what_was_found(
    stop: signal.Signals, marker: str, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "carproof", "conform", "--timeout", "60", "--", *HOSTILE, "silence"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + GENEROUS
        while len(processes_of(marker)) < 3 and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.3)
        process.send_signal(stop)
        stdout, stderr = process.communicate(timeout=GENEROUS)
    assert (process.returncode, stderr) == (128 + stop, "Interrupted.\n")
    assert "UNDECIDED" in stdout
