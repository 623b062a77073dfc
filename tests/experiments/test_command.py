"""`carproof experiment`: the same digest every time, and errors are one sentence."""

import json
import sys
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from carproof.cli import main

SMALL = ("--robots", "8", "--assignments", "2", "--map", "5", "--map", "12")


def document(*arguments: str) -> dict[str, Any]:
    with CliRunner().isolation() as (stdout, stderr, _):
        assert main(["experiment", *arguments, "--json"]) == 0, stderr.getvalue()
        sys.stdout.flush()
        parsed: dict[str, Any] = json.loads(stdout.getvalue())
        return parsed


def test_twice_the_same_digest_and_another_for_other_cases(tmp_path: Path) -> None:
    once = document("quality", *SMALL)
    again = document("quality", *SMALL, "--store", str(tmp_path / "store"))
    assert (once["cases"], once["digest"]) == (4, again["digest"])
    assert document("quality", *SMALL[:4], "--map", "5", "--store", str(tmp_path / "store"))["digest"] != once["digest"]


def test_a_larger_run_takes_over_what_a_smaller_one_left(tmp_path: Path) -> None:
    store = str(tmp_path / "store")
    document("quality", *SMALL[:2], "--assignments", "1", *SMALL[4:], "--store", store)
    assert document("quality", *SMALL, "--store", store)["digest"] == document("quality", *SMALL)["digest"]


def test_a_report_holds_tables_figures_and_numbers(tmp_path: Path) -> None:
    document("quality", *SMALL, "--report", str(tmp_path))
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "quality-failures.svg",
        "quality-savings.svg",
        "quality-totals.svg",
        "quality.json",
        "quality.md",
    ]
