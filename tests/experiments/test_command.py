"""`carproof experiment`: the same digest every time, and errors are one sentence."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Document, Run

from carp_experiments.redrawing import draw_figures

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


def test_a_report_holds_tables_numbers_and_the_figures_of_the_stored_numbers(carproof: Run) -> None:
    document(carproof, f"{SMALL} --report report")
    written = {path.name: path.read_bytes() for path in Path("report").iterdir()}
    assert sorted(written) == [
        "quality-failures.svg",
        "quality-savings.svg",
        "quality.json",
        "quality.md",
    ]
    draw_figures(Path("report"), Path("report"))
    assert {path.name: path.read_bytes() for path in Path("report").iterdir()} == written
