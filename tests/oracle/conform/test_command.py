"""The command conform: what it prints, what it writes, and its exit codes."""

import json
import re
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from tests.oracle.running import Run
from tests.profiles import rest_in

SERVE = [sys.executable, "-m", "carproof", "serve"]


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("engine", rest_in("ci", [["--engine", "reference"], []], 1))
def test_carproof_conforms_to_its_strictest_level(process: Run, engine: list[str]) -> None:
    """On a machine that is busy too, where the time for large cases ends before the first one is answered."""
    patient = ["--timeout", "120", "--large", "2"]
    outcome = process("conform", "--level", "exact", "--examples", "60", *patient, "--", *SERVE, *engine)
    assert outcome.code == 0, outcome.stdout
    claim, extent = outcome.stdout.splitlines()[-2:]
    assert claim.startswith("CONFORMS: carproof ")
    assert re.search(r"level exact \(the plans are carproof's, visit for visit\), tested on \d\d+ answers\.", claim)
    is_any_large = re.search(r"; large [1-9]", outcome.stdout) is not None
    assert (int(re.findall(r"had (\d+) robots", extent)[0]) >= 10) is is_any_large


def test_each_run_draws_new_cases_by_a_seed_that_it_names(carproof: Run) -> None:
    seeds = [json.loads(carproof("conform --json --examples 0 -- false").stdout)["seed"] for _ in range(2)]
    assert seeds[0] != seeds[1]


LIMITS = """
import json, sys

for line in sys.stdin:
    request = json.loads(line)
    answer = {"id": request["id"], "result": {"name": "mine", "version": "1", "ops": ["optimum"]}}
    if request["op"] == "optimum":
        print(request["limit"], file=open("limits", "a"))
        answer = {"id": request["id"], "skipped": "not now"}
    print(json.dumps(answer), flush=True)
"""


def test_an_optimum_is_searched_for_as_long_as_an_answer_may_take_and_not_to_its_end(
    process: Run, elsewhere: Path
) -> None:
    options = ["--examples", "0", "--large", "0", "--timeout", "20"]
    process("conform", "--level", "optimal", *options, "--", sys.executable, "-c", LIMITS)
    limits = {float(line) for line in (elsewhere / "limits").read_text().split()}
    assert 10 <= min(limits) <= max(limits) < 20


def test_json_and_junit_tell_the_same(process: Run, elsewhere: Path) -> None:
    outcome = process("conform", "--examples", "20", "--large", "0", "--json", "--junit", "conform.xml", "--", *SERVE)
    assert outcome.code == 0, outcome
    report = json.loads(outcome.stdout)
    assert report["conforms"]
    assert report["statement"] == "no plan breaks a rule"
    assert report["tested"] >= 20
    assert report["cases"]["random"] == {"passed": 20}
    suite = ET.parse(elsewhere / "conform.xml").getroot()  # noqa: S314 - written by the test
    fixed = report["cases"]["smoke"]["passed"] + report["cases"]["vectors"]["passed"]
    assert int(suite.get("tests", "")) == fixed + 1
    assert suite.get("failures") == "0"


@pytest.mark.usefixtures("elsewhere")
def test_where_findings_cannot_be_saved_there_is_a_verdict(process: Run) -> None:
    outcome = process("conform --one-shot --examples 0 --save /proc/findings -- false {instance}")
    assert outcome.code == 1
    assert outcome.stderr.startswith("Nothing is saved: /proc/findings/")
    assert outcome.stdout.splitlines()[-2].startswith("DOES NOT CONFORM: ")
