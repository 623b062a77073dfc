"""`carproof experiment`: the same digest every time, and errors are one sentence."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Document, Run

QUALITY = "experiment quality --json --robots 8"
SMALL = f"{QUALITY} --assignments 2 --map 5 --map 12"
pytestmark = pytest.mark.usefixtures("elsewhere")


def document(carproof: Run, command: str) -> Document:
    outcome = carproof(command)
    assert outcome.code == 0, outcome
    parsed: Document = json.loads(outcome.stdout)
    return parsed


def test_twice_the_same_digest_and_another_for_other_cases(carproof: Run) -> None:
    once = document(carproof, SMALL)
    again = document(carproof, f"{SMALL} --store store")
    assert (once["cases"], once["digest"]) == (4, again["digest"])
    other = document(carproof, f"{QUALITY} --assignments 2 --map 5 --store store")
    assert other["digest"] != once["digest"]


def test_a_larger_run_takes_over_what_a_smaller_one_left(carproof: Run) -> None:
    document(carproof, f"{QUALITY} --assignments 1 --map 5 --map 12 --store store")
    assert document(carproof, f"{SMALL} --store store")["digest"] == document(carproof, SMALL)["digest"]


def test_a_report_holds_tables_figures_and_numbers(carproof: Run) -> None:
    document(carproof, f"{SMALL} --report report")
    assert sorted(path.name for path in Path("report").iterdir()) == [
        "quality-failures.svg",
        "quality-savings.svg",
        "quality-totals.svg",
        "quality.json",
        "quality.md",
    ]
