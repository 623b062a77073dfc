"""The files that a run saves: each distinct finding, in place of those of an earlier run, with all that repeats it."""

import os
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from tests.oracle.conform.judging.test_judges import Tampered, no_plan

from carproof import RULES, Report, Solution
from carproof.conform.asking.smoke import EAST, FIRST, WEST, passing_place, row, smoke_cases
from carproof.conform.asking.vector_cases import vector_cases
from carproof.conform.cases import ASKED_OPS, Case
from carproof.conform.findings import PROGRAM_RULES, wrong
from carproof.conform.judging.outcome import Outcome
from carproof.conform.levels import Level
from carproof.conform.reporting.advice import _ADVICE, advice_for
from carproof.conform.reporting.saved import Saved, own_folder, read_saved, save_all
from carproof.conform.reporting.saving import Origin
from carproof.conform.run import Options, conform
from carproof.rules import ALL_RULES

CASE = Case("smoke", "plan: head-on", "plan", passing_place([FIRST, WEST]), Solution((), (), ("first", "new")))
NOBODY = Solution((), (), ("first", "new"))
FAILURES = [Outcome(CASE, wrong(rule, "it is wrong"), NOBODY) for rule in ("joint/exchange", "plan/duration")]
ORIGIN = Origin("./planner at level sound", "carproof conform --seed 3 -- ./planner", "./planner '{instance}' {agents}")


def files(folder: Path) -> set[str]:
    return {str(each.relative_to(folder)) for each in folder.rglob("*") if each.is_file()}


def test_each_finding_is_saved_with_advice_and_the_way_to_repeat_it(tmp_path: Path) -> None:
    assert save_all(FAILURES, tmp_path, ORIGIN) == [tmp_path, tmp_path / "2-plan-duration"]
    assert {"finding.txt", "map.txt", "map.svg", "request.json", "2-plan-duration/finding.txt"} <= files(tmp_path)
    lines = (tmp_path / "finding.txt").read_text().splitlines()
    assert lines[0] == "wrong answer: it is wrong [joint/exchange]"
    assert "Advice: Look at the moves of the robots before, not only at their places." in lines
    assert "About the case: plan: head-on" in lines
    assert "Again: carproof conform --seed 3 -- ./planner" in lines
    assert f"This case alone: ./planner '{tmp_path}/instance.json' 2" in lines


def test_findings_of_an_earlier_run_are_cleared_and_no_other_file(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").touch()
    save_all(FAILURES, tmp_path, ORIGIN)
    save_all(FAILURES[:1], tmp_path, ORIGIN)
    assert "2-plan-duration/finding.txt" not in files(tmp_path)
    save_all([], tmp_path, ORIGIN)
    assert files(tmp_path) == {"mine.txt"}


def test_findings_that_were_not_asked_again_stay_beside_those_of_the_run(tmp_path: Path) -> None:
    one, other = FAILURES[0], replace(FAILURES[1], case=replace(CASE, name="another"))
    save_all([one, other], tmp_path, ORIGIN)
    before = read_saved(tmp_path, whole=False)
    kept = before.not_asked([Outcome(before.cases[1]), Outcome(before.cases[0], asked=False)])
    assert kept == {"."}
    assert save_all([other], tmp_path, ORIGIN, kept) == [tmp_path / "2-plan-duration"]
    assert len(read_saved(tmp_path, whole=False).cases) == 2
    save_all([], tmp_path, ORIGIN, frozenset(["2-plan-duration"]))
    assert len(read_saved(tmp_path, whole=False).cases) == 1
    assert {each.partition("/")[0] for each in files(tmp_path)} == {"run.json", "2-plan-duration"}


@pytest.mark.parametrize("whole", [False, True])
def test_saved_cases_are_read_as_they_were_asked(tmp_path: Path, whole: bool) -> None:
    ops: tuple[str, ...] = ("plan",) if whole else ASKED_OPS
    cases = [*smoke_cases(ops, Level.COMPLETE, whole), *vector_cases(ops, Level.COMPLETE, whole)]
    one_of_each = list({case.op: case for case in cases}.values())
    save_all([Outcome(case, wrong("plan/move", "it is wrong"), NOBODY) for case in one_of_each], tmp_path, ORIGIN)
    assert [*read_saved(tmp_path, whole).cases] == [replace(case, stage="saved") for case in one_of_each]


def test_each_program_and_level_has_a_folder_of_its_own(tmp_path: Path) -> None:
    first = own_folder(tmp_path, "./my planner", "one")
    assert first.parent == tmp_path
    save_all(FAILURES, first, ORIGIN)
    assert own_folder(tmp_path, "./my planner", ORIGIN.judged) == first
    second = own_folder(tmp_path, "./my planner", "another level")
    assert read_saved(second, whole=True) == Saved()
    save_all(FAILURES, second, Origin("another level"))
    assert len({first, second, own_folder(tmp_path, "./my planner", "a third")}) == 3
    assert read_saved(first, whole=True).cases


@pytest.mark.parametrize("how", ["another text", "a pipe", "a link"])
@pytest.mark.parametrize("name", ["vector.json", "run.json"])
def test_damaged_findings_are_cleared(tmp_path: Path, name: str, how: str) -> None:
    save_all(FAILURES, tmp_path, ORIGIN)
    (tmp_path / name).unlink()
    if how == "another text":
        (tmp_path / name).write_text("{}")
    elif how == "a pipe":
        os.mkfifo(tmp_path / name)
    else:
        (tmp_path / name).symlink_to("/dev/zero")
    stale = f"{tmp_path} holds findings that cannot be read: they are cleared."
    assert read_saved(tmp_path, whole=True) == Saved(stale=stale)
    assert files(tmp_path) == set()


def test_saved_cases_of_ops_that_are_offered_are_asked_first(tmp_path: Path) -> None:
    subject = Tampered(no_plan, ("query",))
    options = Options(Level.COMPLETE_IN_CONTEXT, examples=0)
    save_all(conform(subject, options).failures, tmp_path, ORIGIN)
    saved = read_saved(tmp_path, whole=False).cases
    again = conform(subject, options, saved=[replace(saved[0], op="plan"), *saved])
    first = again.outcomes[0]
    assert (first.case.stage, first.finding and first.finding.rule) == ("saved", "query/complete")
    assert again.failures[0].case.stage == "saved"


def test_a_failure_with_more_features_shows_nothing_more() -> None:
    report = Report(Options())
    simple, two, slow, both = (
        Outcome(Case("smoke", "", "plan", instance), wrong("plan/move", "it is wrong"), NOBODY)
        for instance in (
            row([EAST], cells="abc"),
            row([EAST], cells="ab", capacity="2"),
            row([EAST], cells="ab", duration="2"),
            row([EAST], capacity="2", duration="2"),
        )
    )
    report.outcomes = [both]
    assert report.failures == [both]
    report.outcomes = [both, slow, two]
    assert report.failures == [slow, two]
    report.outcomes = [both, simple, slow]
    assert report.failures == [slow, simple]


def test_every_rule_has_advice_and_what_a_planner_can_break_its_own() -> None:
    ids = {rule.id for rule in ALL_RULES}
    assert _ADVICE.keys() <= ids | {id.partition("/")[0] for id in ids}
    families = ("plan/", "joint/", "solution/", "fleet/", "cost/")
    own = {rule.id for rule in (*RULES, *PROGRAM_RULES) if rule.id.startswith((*families, "program/"))}
    assert own | {"query/complete", "query/optimal", "query/ties"} <= _ADVICE.keys()
    for rule in (*ids, "no/rule"):
        advice = advice_for(rule)
        assert advice.endswith(".")
        assert ". " not in advice
        assert advice[0].isupper()


def test_the_request_of_a_finding_can_be_asked_again(tmp_path: Path) -> None:
    save_all(FAILURES[:1], tmp_path, Origin(one="cat '{request}'"))
    (line,) = (each for each in (tmp_path / "finding.txt").read_text().splitlines() if each.startswith("This case"))
    command = line.partition(": ")[2]
    done = subprocess.run(["/bin/sh", "-c", command], check=True, capture_output=True)
    assert done.stdout == (tmp_path / "request.json").read_bytes()
