"""Compilation is one step that is announced, and no limit of time counts it."""

import sys

import pytest
from tests.oracle.running import Run


def test_warm_says_that_the_planner_is_compiled(carproof: Run) -> None:
    outcome = carproof("warm")
    assert (outcome.code, outcome.stdout, outcome.stderr) == (0, "carproof's planner is compiled already\n", "")


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "command",
    [
        "polish town.json plans.json --seconds 0.1",
        "bound town.json --seconds 1",
        f"conform --examples 0 --one-shot -- {sys.executable} -c 0 {{instance}}",
    ],
)
def test_a_limit_of_time_begins_when_the_planner_is_compiled(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    compiled: list[str] = []
    monkeypatch.setattr("carp_optimum.__main__.compile_all", lambda: compiled.append(command))
    monkeypatch.setattr("carp_optimized.compiling.is_compiled", lambda: False)
    assert carproof(command).code in (0, 1)
    assert compiled == [command]
