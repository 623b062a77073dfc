"""Large cases: bugs that show only beyond a size or a number are found, shrunk, and nothing is claimed beyond."""

import json
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from tests.oracle.conform.asking.planted import ARRIVES_ONLY, BUGS, Bug, Planted, beyond, robots, run
from tests.oracle.conform.judging.test_judges import right_reply
from tests.oracle.running import Run

from carp_spec import Solution
from carproof.conform.answers import Reply
from carproof.conform.asking.ladder import LARGE_OPS, SIZES, Rung, large_case, rungs
from carproof.conform.cases import Case
from carproof.conform.findings import IN_TIME, Category, Fault, Finding
from carproof.conform.judging.claims import EVERYTHING, FEATURES, Claims
from carproof.conform.judging.judges import first_finding
from carproof.conform.levels import Level
from carproof.conform.run import Options, conform

BUDGET = 60.0
NO_BUG = Bug("none", "nothing", "plan", Level.SOUND, lambda _: None)
CHEAP = {"8 resources", "5 robots", "64 robots", "capacity 2", "duration 9", "pace 3", "tick 100,000", "id 2^31"}


@pytest.mark.parametrize(
    "bug",
    [
        pytest.param(bug, id=f"{bug.what} beyond {bug.beyond}", marks=[] if bug.beyond in CHEAP else pytest.mark.ci)
        for bug in BUGS
    ],
)
def test_a_bug_that_shows_only_beyond_a_size_or_a_number_is_found(bug: Bug) -> None:
    report = run(bug, BUDGET, examples=10)
    assert report.conforms is False
    assert run(bug, 0.0, examples=10).conforms is bool(report.large)


def cases_of(ladder: Iterable[Rung], claims: Claims = EVERYTHING) -> list[Case]:
    made = (large_case(rung, claims, classical=False) for rung in ladder)
    return [case for case in made if case is not None]


def test_the_same_seed_asks_the_same_large_cases() -> None:
    first, again, other = (cases_of([*rungs(LARGE_OPS, Level.EXACT, seed, whole=False)][:60]) for seed in (3, 3, 4))
    assert first == again != other
    assert len(first) > 50


@pytest.mark.parametrize("feature", FEATURES)
def test_large_cases_have_no_feature_that_is_not_claimed(feature: str) -> None:
    ladder = (r for r in rungs(("plan", "query", "add"), Level.SOUND, 1, whole=False) if r.robots == SIZES[0])
    cases = cases_of(ladder, Claims(frozenset({feature})))
    assert len(cases) > 100
    assert not [case.name for case in cases if FEATURES[feature](case)]


class Slow(Planted):
    """Right, and too slow beyond 20 robots."""

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        if len(case.instance.robots) > 20:
            raise Fault(Finding(Category.TIMEOUT, IN_TIME.id, "no answer"))
        return super().ask(case, seconds)


def test_a_planner_that_is_too_slow_for_a_size_is_named_and_judged_below_it() -> None:
    report = conform(Slow(NO_BUG), Options(examples=10, large=BUDGET))
    assert report.conforms
    assert report.extent.robots == SIZES[0]
    assert [cut for cut in report.cut if "too slow" in cut and f"{SIZES[1]} robots" in cut]


def test_who_gives_up_on_large_cases_has_shown_nothing_about_them() -> None:
    def gives_up(case: Case) -> Reply:
        return Solution((), (), tuple(case.instance.robot))

    lazy = Bug("gives up", "8 robots", "plan", Level.SOUND, beyond(robots, 8, gives_up))
    report = conform(Planted(lazy), Options(examples=10, large=1.0))
    assert report.conforms
    assert report.large["gave up"]
    assert report.extent.robots <= 8


def test_right_answers_to_large_cases_pass_at_the_strictest_level() -> None:
    cases = cases_of([r for r in rungs(LARGE_OPS, Level.EXACT, 1, whole=False) if r.robots == SIZES[2]][:45])
    assert {case.op for case in cases} == {*LARGE_OPS}
    assert [case.name for case in cases if first_finding(case, right_reply(case, None), Level.EXACT) is not None] == []


def test_a_failure_is_shrunk_until_nothing_can_be_taken_away() -> None:
    report = run(ARRIVES_ONLY, 0.0, examples=200, shrinking=60.0)
    assert report.smallest is not None
    instance = report.smallest.case.instance
    sizes = len(instance.robots), len(instance.graph.resources), len(instance.graph.edges)
    assert (sizes, report.minimal) == ((2, 1, 0), True)


def test_a_large_failure_is_shrunk_to_the_number_beyond_which_it_shows() -> None:
    (bug,) = (each for each in BUGS if each.beyond == "tick 100,000")
    report = run(bug, BUDGET, examples=10, shrinking=60.0)
    assert report.smallest is not None
    (robot,) = report.smallest.case.instance.robots
    assert (robot.release, robot.start == robot.goal, report.minimal) == (100_001, True, True)


UNTIDY = """
import os, pathlib, sys

how, source, target = sys.argv[1:]
folder = pathlib.Path(source).parent
for name in ["output", "errors", "solution", *os.listdir(folder)]:
    each = folder / name
    each.unlink(missing_ok=True)
    if how == "pipes":
        os.mkfifo(each)
    elif how == "links":
        each.symlink_to("/dev/zero")
if how == "no folder":
    folder.rmdir()
"""


@pytest.mark.parametrize("how", ["pipes", "links", "no folder"])
def test_a_program_that_replaces_the_files_beside_its_instance_is_at_fault(
    process: Run, elsewhere: Path, how: str
) -> None:
    program = elsewhere / "untidy.py"
    program.write_text(UNTIDY)
    command = [sys.executable, str(program), how, "{instance}", "{solution}"]
    outcome = process("conform", "--one-shot", "--examples", "0", "--json", "--", *command)
    assert outcome.code == 1, outcome
    failures = json.loads(outcome.stdout)["failures"]
    assert {failure["category"] for failure in failures} == {"protocol error"}
