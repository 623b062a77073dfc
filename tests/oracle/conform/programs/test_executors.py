"""Executors: programs that let late robots go on, tick by tick, and their faults."""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.conform.programs import executors
from tests.oracle.running import Run, asked
from tests.profiles import draws

from carp_reference.execution import order_of
from carp_spec.permutations import splitmix64
from carproof import Delay, Report, Robot, RobotId, Trace
from carproof.conform.answers import Skipped
from carproof.conform.asking.random_cases import execution_case
from carproof.conform.asking.smoke import committed, row
from carproof.conform.cases import EXECUTION, Case
from carproof.conform.findings import Fault
from carproof.conform.judging.claims import Claims
from carproof.conform.judging.driving import execution, execution_findings
from carproof.conform.levels import Level
from carproof.conform.programs.child import Limits
from carproof.conform.programs.program import Program
from carproof.conform.reporting.saved import read_saved, save_all
from carproof.conform.reporting.saving import Origin
from carproof.conform.run import Options, conform
from carproof.execution.delays import executed, in_order
from carproof.protocol.ops.executing import DriveDocument, drive
from carproof.testing.random_instances import Draw

SERVE = [sys.executable, "-m", "carproof", "serve", "--engine", "reference"]
NEAR = row([Robot("first", "a", "b")])
ALONE = Case("random", EXECUTION, EXECUTION, NEAR, committed(NEAR, first=[("a", 0, 1), ("b", 1, 2)]))
WAITING = (("first", 0, 2),)


def way(how: str) -> list[str]:
    return [sys.executable, executors.__file__, how]


class Called(Program):
    """An executor of this process: its answers need no pipes."""

    def __init__(self, how: str) -> None:
        super().__init__(way(how), Limits())
        self.may_go = executors.WAYS[how]

    def start(self) -> None:
        self.ops = ("drive",)

    def answer(self, op: str, fields: dict[str, Any], seconds: float | None = None) -> DriveDocument:
        del op, seconds
        request = msgspec.json.decode(msgspec.json.encode(fields))
        return DriveDocument(tuple(executors.decide(request, self.may_go)))


def run(program: Program, level: Level = Level.SOUND, examples: int = 200) -> Report:
    return conform(program, Options(level, examples, seed=5, shrink_seconds=60, executor=True))


def smallest(report: Report) -> tuple[str, Case]:
    assert report.smallest is not None
    assert report.smallest.finding is not None
    return report.smallest.finding.rule, report.smallest.case


@pytest.mark.parametrize("command", [SERVE, way("order")])
def test_who_keeps_the_planned_order_conforms(command: list[str]) -> None:
    report = run(Program(command, Limits()), Level.EXACT, 20)
    assert (report.findings, report.conforms, report.tested) == ([], True, 20)


def test_a_program_that_can_stand_for_ever_is_found_and_shrunk_to_few_robots(process: Run, elsewhere: Path) -> None:
    outcome = process("conform --executor --examples 100 --seed 1 --", *way("room"))
    assert outcome.code == 1
    assert "stand for ever: nobody has entered for" in outcome.stdout
    saved = json.loads(next((elsewhere / "conform-failure").glob("*/request.json")).read_bytes())
    assert len(saved["instance"]["robots"]) == 2
    assert (saved["driver"], saved["delays"], "now" in saved) == ("order", [], False)
    assert saved.pop("id") == 1
    assert asked(**saved)["result"]["standing"] == []


def test_who_keeps_to_the_clock_enters_too_early() -> None:
    rule, case = smallest(run(Called("clock")))
    assert rule == "joint/capacity"
    assert len(case.instance.robots) == 2
    assert [ticks for _, _, ticks in case.delays] == [1]


@settings(max_examples=draws(200))
@given(st.integers(0, 2**64 - 1))
def test_carproof_drives_as_its_simulation_in_order_does(seed: int) -> None:
    case = execution_case(Claims(stops=True))(Draw(splitmix64(seed)))
    driven = execution(case, lambda trace, ready: drive(case.instance, case.solution, trace, ready))
    assert isinstance(driven, Trace)
    delays = [Delay(*delay) for delay in case.delays]
    order = order_of(case.instance, case.solution)
    assert driven == executed(order, in_order(order, delays), delays, driven.now)
    assert not list(execution_findings(case, driven, Level.EXACT))


def test_an_execution_waits_for_delays_and_ends_with_the_last_arrival() -> None:
    ticks: list[int] = []

    def decide(trace: Trace, ready: tuple[RobotId, ...]) -> DriveDocument:
        ticks.append(trace.now)
        return DriveDocument(ready)

    late = replace(ALONE, delays=WAITING)
    trace = execution(late, decide)
    assert isinstance(trace, Trace)
    assert [(visit.enter, visit.leave) for visit in trace.plans[0].visits] == [(0, 3), (3, 4)]
    assert (trace.now, ticks) == (4, [0, 3])


def test_who_lets_nobody_go_is_given_up_after_the_ticks_of_plans_and_delays() -> None:
    trace = execution(ALONE, lambda *_: DriveDocument(()))
    assert isinstance(trace, Trace)
    assert trace.now == 2
    (finding,) = execution_findings(ALONE, trace, Level.SOUND)
    assert finding.rule == "program/arrives"
    assert finding.message.startswith("robot first stands for ever: nobody has entered for 1 ticks until 2")


TWO = row([Robot("first", "b", "c"), Robot("second", "a", "b")])
PLANS = committed(TWO, first=[("b", 0, 1), ("c", 1, 2)], second=[("a", 0, 1), ("b", 1, 2)])
MEETING = Case("random", EXECUTION, EXECUTION, TWO, PLANS)


def decided(case: Case, *entering: tuple[int, tuple[str, ...]]) -> Trace:
    """The execution in which robots enter at ticks, each when it is asked for."""
    trace = execution(case, lambda trace, _: DriveDocument(dict(entering).get(trace.now, ())))
    assert isinstance(trace, Trace)
    return trace


def rules(case: Case, trace: Trace, level: Level) -> list[str]:
    return [finding.rule for finding in execution_findings(case, trace, level)]


def test_an_execution_ends_with_the_first_collision_and_its_rule() -> None:
    trace = decided(MEETING, (0, ("first", "second")), (1, ("second",)))
    assert trace.now == 2
    for level in (Level.SOUND, Level.EXACT):
        assert rules(MEETING, trace, level)[0] == "joint/capacity"


def test_robots_in_another_order_are_reported_once_and_at_level_exact_alone() -> None:
    trace = decided(MEETING, (0, ("second",)), (1, ("second",)), (2, ("first",)), (3, ("first",)))
    assert rules(MEETING, trace, Level.SOUND) == []
    assert rules(MEETING, trace, Level.EXACT) == ["execution/order"]


def test_a_program_that_does_not_drive_is_skipped() -> None:
    skipped = Skipped("no drive here")
    assert execution(ALONE, lambda *_: skipped) is skipped


def test_patience_starts_again_whenever_a_robot_enters() -> None:
    trace = decided(ALONE, (1, ("first",)), (2, ("first",)))
    assert [visit.enter for visit in trace.plans[0].visits] == [1, 2]


@pytest.mark.parametrize("named", [("first", "first"), ("second",)])
def test_only_robots_that_are_ready_may_be_named_each_once(named: tuple[str, ...]) -> None:
    with pytest.raises(Fault) as caught:
        execution(ALONE, lambda *_: DriveDocument(named))
    assert caught.value.finding.rule == "program/ready"
    assert caught.value.finding.message == f"at tick 0 robots ['first'] are ready, and {[*named]} are to enter"


def test_a_failing_execution_is_saved_and_asked_again_with_its_delays(tmp_path: Path) -> None:
    report = run(Called("clock"))
    save_all(report.failures, tmp_path, Origin("carproof conform"))
    (again,) = read_saved(tmp_path, whole=False).cases
    _, case = smallest(report)
    assert (again.op, again.instance, again.solution, again.now, again.delays) == (
        EXECUTION,
        case.instance,
        case.solution,
        0,
        case.delays,
    )
    saved = json.loads((tmp_path / "vector.json").read_bytes())
    assert saved["cases"][0]["claim"]["format"] == "carproof-trace/1"


def test_an_executor_must_offer_to_drive(tmp_path: Path) -> None:
    planner = tmp_path / "planner.py"
    planner.write_text(Path(executors.__file__).read_text().replace('["drive"]', '["plan"]'))
    (fault,) = run(Program([sys.executable, str(planner), "order"], Limits()), examples=0).faults
    assert (fault.rule, fault.message) == ("program/answers", "the answer to start of an executor must name drive")
