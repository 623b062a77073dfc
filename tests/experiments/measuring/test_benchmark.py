"""The benchmark of the field: cases of a table, planned, judged and compared."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Run

MAP = "type octile\nheight 2\nwidth 3\nmap\n...\n...\n"
SCEN = "version 1\n0\tyard.map\t3\t2\t0\t0\t2\t0\t2\n0\tyard.map\t3\t2\t2\t1\t0\t1\t2\n"


@pytest.fixture(autouse=True)
def _files(elsewhere: Path) -> None:
    (elsewhere / "maps/deep").mkdir(parents=True)
    (elsewhere / "maps/yard.map").write_text(MAP)
    (elsewhere / "maps/deep/yard-even-1.scen").write_text(SCEN)
    (elsewhere / "bounds.csv").write_text("map,scen,agents,lower,upper\nyard,even-1,2,4,4\n")
    program = elsewhere / "silent"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)


def test_cases_are_planned_and_stand_beside_the_tracker_and_other_planners(carproof: Run) -> None:
    options = "--maps maps --bounds bounds.csv --seconds 1 --bound-seconds 1 --lacam3 silent --plans plans"
    outcome = carproof(f"experiment benchmark {options}")
    assert outcome.code == 0, outcome
    assert "yard even-1 00002 4.0 4 - 4 4" in " ".join(outcome.stdout.split())
    assert "tracker's best or less on 1 of 1, no other planner better on 1 of 1" in outcome.stdout
    assert {path.name for path in Path("plans").iterdir()} == {"yard-even-1-2-1s.txt", "yard-even-1-2-bound.json"}
    judged = carproof(
        "check --map maps/yard.map --scen maps/deep/yard-even-1.scen --agents 2 plans/yard-even-1-2-1s.txt"
    )
    assert judged.code == 0, judged


def test_figures_without_another_planner_neither_compare_with_one_nor_stand_in_for_a_comparison(carproof: Run) -> None:
    asked = "experiment benchmark --maps maps --bounds bounds.csv --seconds 1 --store results.sqlite"
    alone = carproof(f"{asked} --json")
    assert (alone.code, json.loads(alone.stdout)["summary"]["ours 1 s"]) == (0, {"at or below the tracker": 1})
    beside = carproof(f"{asked} --lacam3 silent")
    assert (beside.code, "campaign/store" in beside.stderr) == (2, True), beside


def test_another_planner_finds_the_map_and_plays_rounds(carproof: Run) -> None:
    paths = "Agent 0:(0,0)->(0,1)->(0,2)->\nAgent 1:(1,2)->(1,1)->(1,0)->\n"
    Path("known").write_text(paths)
    writes = f'for last; do :; done; cp {Path("known").absolute()} "$last"'
    Path("silent").write_text(f'#!/bin/sh\ncase "$*" in *"--maxIterations 1"*) test -f "$2" && {writes};; esac\n')
    outcome = carproof(
        "experiment benchmark --maps maps --bounds bounds.csv --seconds 1 --bound-seconds 0 --lns2 silent"
    )
    assert outcome.code == 0, outcome
    assert "yard even-1 00002 4.0 4 4 4" in " ".join(outcome.stdout.split())


@pytest.mark.parametrize(
    ("line", "rule"),
    [("yard,even-2,2,4,4", "benchmark/files"), ("yard,even-1,two,4,4", "benchmark/bounds")],
)
def test_a_line_that_cannot_be_asked_is_refused(line: str, rule: str, carproof: Run) -> None:
    Path("bounds.csv").write_text(f"map,scen,agents,lower,upper\n{line}\n")
    outcome = carproof("experiment benchmark --maps maps --bounds bounds.csv --seconds 1")
    assert (outcome.code, rule in outcome.stderr) == (2, True), outcome
