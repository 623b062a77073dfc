"""What a run saves: each distinct finding, in place of those of an earlier run, with all that repeats it."""

from pathlib import Path

from carp_spec import Solution
from carproof.conform.advice import _ADVICE
from carproof.conform.cases import Case
from carproof.conform.findings import wrong
from carproof.conform.outcome import Outcome
from carproof.conform.saving import save_all
from carproof.conform.smoke import FIRST, WEST, passing_place
from carproof.rules import ALL_RULES

CASE = Case("smoke", "plan: head-on", "plan", passing_place([FIRST, WEST]), Solution((), (), ("first", "new")))
NOBODY = Solution((), (), ("first", "new"))
FAILURES = [Outcome(CASE, wrong(rule, "it is wrong"), NOBODY) for rule in ("joint/exchange", "plan/duration")]


def files(folder: Path) -> set[str]:
    return {str(each.relative_to(folder)) for each in folder.rglob("*") if each.is_file()}


def test_each_finding_is_saved_with_advice_and_the_way_to_repeat_it(tmp_path: Path) -> None:
    save_all(FAILURES, tmp_path, "carproof conform --seed 3 -- ./planner")
    assert {"finding.txt", "map.txt", "request.json", "2-plan-duration/finding.txt"} <= files(tmp_path)
    lines = (tmp_path / "finding.txt").read_text().splitlines()
    assert lines[0] == "wrong answer: it is wrong [joint/exchange]"
    assert "Advice: Look at the moves of the robots before, not only at their places." in lines
    assert "About the case: plan: head-on" in lines
    assert "Again: carproof conform --seed 3 -- ./planner" in lines


def test_the_map_shows_starts_and_goals_where_no_plan_was_made(tmp_path: Path) -> None:
    save_all(FAILURES, tmp_path, "")
    assert (tmp_path / "map.txt").read_text() == (
        "0: robot first goes from a to d (A)\n1: robot new goes from d to a (B)\n\n0B .  .  1A\n   .\n"
    )


def test_findings_of_an_earlier_run_are_cleared_and_no_other_file(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").touch()
    save_all(FAILURES, tmp_path, "")
    save_all(FAILURES[:1], tmp_path, "")
    assert "2-plan-duration/finding.txt" not in files(tmp_path)
    save_all([], tmp_path, "")
    assert files(tmp_path) == {"mine.txt"}


def test_advice_is_of_rules_that_there_are() -> None:
    assert _ADVICE.keys() <= {rule.id for rule in ALL_RULES}
