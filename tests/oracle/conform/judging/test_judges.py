"""Whole runs: of right programs, and of programs that are wrong always or at times; what is asked, kept and saved."""

import json
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import msgspec
import pytest

from carp_spec.documents.vectors import VectorsDocument
from carproof.conform.answers import Reply, Subject
from carproof.conform.cases import ASKED_OPS, Case, request_fields, request_of
from carproof.conform.levels import Level
from carproof.conform.reporting.saving import save
from carproof.conform.run import Options, Report, conform
from carproof.engines import engine_named
from carproof.protocol.ops import OPS
from carproof.protocol.ops.op import Session
from carproof.protocol.ops.planning import QueryDocument

Tamper = Callable[[Case, Reply], Reply]


def right_reply(case: Case, engine: str | None = "reference") -> Any:  # noqa: ANN401 - of the kind that is asked for
    return OPS[case.op].call(request_of(case), Session(engine_named(engine)))


class Tampered(Subject):
    """A subject whose right answers go through a function."""

    def __init__(self, tamper: Tamper, ops: tuple[str, ...] = ASKED_OPS) -> None:
        self.name = "tampered"
        self.ops = ops
        self.tamper = tamper
        self.killed = False
        self.cases: list[Case] = []

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        del seconds
        self.cases.append(case)
        return self.tamper(case, right_reply(case))

    def kill(self) -> None:
        self.killed = True


def run(tamper: Tamper, level: Level, ops: tuple[str, ...] = ASKED_OPS, examples: int = 40) -> Report:
    subject = Tampered(tamper, ops)
    return conform(subject, Options(level, examples, shrink_seconds=1))


def no_plan(_: Case, reply: Reply) -> Reply:
    return QueryDocument(None) if isinstance(reply, QueryDocument) else reply


def as_it_is(_: Case, reply: Reply) -> Reply:
    return reply


@pytest.mark.parametrize("level", Level)
def test_right_answers_conform_to_every_level(level: Level) -> None:
    report = run(as_it_is, level)
    assert report.conforms, report.findings
    assert set(report.judged) == {*ASKED_OPS} - (set() if level >= Level.COMPLETE else {"optimum"})


def test_a_program_that_is_wrong_only_now_and_then_is_refused_all_the_same() -> None:
    asked = count(1)
    subject = Tampered(lambda case, reply: reply if next(asked) % 29 else no_plan(case, reply), ("query",))
    report = conform(subject, Options(Level.COMPLETE_IN_CONTEXT, examples=200, shrink_seconds=1))
    assert report.conforms is False


def interrupts(*_: object) -> Reply:
    raise KeyboardInterrupt


def test_an_interruption_leaves_undecided_and_ends_the_subject() -> None:
    subject = Tampered(interrupts)
    report = conform(subject, Options())
    assert (report.interrupted, report.conforms, subject.killed) == (True, None, True)


def test_a_failure_is_saved_as_a_vector_that_asks_it_again(tmp_path: Path) -> None:
    smallest = run(no_plan, Level.COMPLETE_IN_CONTEXT, ("query",)).failures[0]
    save(smallest, tmp_path)
    (vector,) = msgspec.json.decode((tmp_path / "vector.json").read_bytes(), type=VectorsDocument).cases
    assert vector.read_instance() == smallest.case.instance
    assert (vector.op, vector.claim, vector.violated) == ("query", {"plan": None}, ("query/complete",))
    assert vector.answer["cost"] is not None
    request = json.loads((tmp_path / "request.json").read_bytes())
    assert request == {"id": 1, **vector.request}
    assert request == json.loads(msgspec.json.encode({"id": 1, "op": "query", **request_fields(smallest.case)}))


def test_the_same_seed_asks_the_same_cases() -> None:
    subjects = [Tampered(as_it_is, ("query", "plan")) for _ in range(2)]
    for subject in subjects:
        conform(subject, Options(Level.SOUND, examples=20, seed=5))
    assert subjects[0].cases == subjects[1].cases
