"""The campaign of texts: they are various, the kernel decides them as Python does, and a difference is shown."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import pytest
from tests.oracle.running import Run
from tests.verify.kernel.program import program

from carp_experiments.measuring.blocks import BlockCase
from carp_experiments.measuring.kernel_texts import TEXTS, Texts, decided, drawn_texts
from carp_verify.kernel import PROGRAM, VARIABLE

STAND_IN = """#!/bin/sh
while read -r line; do {does}; done
"""


def stand_in(monkeypatch: pytest.MonkeyPatch, folder: Path, does: str) -> None:
    """A kernel that does one thing with all that it is asked."""
    path = folder / PROGRAM
    path.write_text(STAND_IN.format(does=does))
    path.chmod(0o755)
    monkeypatch.setenv(VARIABLE, str(path))


def differences(cases: Sequence[BlockCase]) -> list[dict[str, Any]]:
    """The texts on which the kernel differs."""
    return [each for case in cases for each in msgspec.convert(case.run(), Texts).differences]


def test_texts_are_the_same_every_time_and_of_all_kinds() -> None:
    texts = drawn_texts(5, 0, 1000)
    assert drawn_texts(5, 0, 1000) == texts
    assert not any(b"\n" in text for text in texts)
    found = [decided(text) for text in texts]
    for verdict in ("accepted", "refused", "bad input"):
        assert sum(each.verdict == verdict for each in found) > 50
    for op in (b"check", b"verify-query", b"verify-bound", b"audit"):
        assert sum(op in text for text in texts) > 30


def test_the_kernel_reads_and_decides_as_python_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, program())
    report = TEXTS.report(case.run() for case in TEXTS.cases(2000, seed=3))
    assert report.lines == ()
    assert report.holds


def test_a_kernel_that_reads_what_python_refuses_differs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    stand_in(monkeypatch, tmp_path, """echo '{"kernel": "7", "verdict": "accepted"}'""")
    report = TEXTS.report(case.run() for case in TEXTS.cases(50, seed=0))
    assert not report.holds
    assert '"bad input"' in report.lines[0]


def test_a_kernel_that_does_not_answer_differs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("carp_experiments.measuring.kernel_texts.LONGEST", 0.2)
    stand_in(monkeypatch, tmp_path, "exec sleep 100")
    assert len(differences(TEXTS.cases(2, seed=0))) == 2


def test_the_command_continues_where_it_stopped(carproof: Run, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.setenv(VARIABLE, program())
    assert carproof("experiment texts --texts 1000 --store texts.sqlite").code == 0
    stand_in(monkeypatch, folder, "exit 1")  # nothing is asked again
    outcome = carproof("experiment texts --texts 1000 --store texts.sqlite --json")
    assert (outcome.code, json.loads(outcome.stdout)["summary"]["differences"]) == (0, [])
