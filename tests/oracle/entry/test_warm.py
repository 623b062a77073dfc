"""Compilation is one step that is announced, and no limit of time counts it."""

import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from tests.oracle.running import Run
from tests.spec.making import VANISHING

import carproof
from carproof import Instance


@pytest.fixture
def uncompiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """As if nothing were compiled: a list that gets longer when it would be."""
    steps: list[str] = []
    monkeypatch.setattr("carp_optimum.__main__.compile_all", lambda: steps.append("compiled"))
    monkeypatch.setattr("carp_optimized.jit.compiling.is_compiled", lambda _: bool(steps))
    return steps


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("command", "timed"),
    [
        ("polish town.json plans.json --seconds 0.1", "carp_optimized.improve.annealing.polish_or_anneal"),
        ("bound town.json --seconds 1", "carp_optimum.bound.lower_bound"),
        ("optimum town.json", "carp_optimum.optimum.optimum"),
        ("gap town.json", "carp_optimum.gap.gap"),
        (f"conform --examples 0 --one-shot -- {sys.executable} -c 0 {{instance}}", "carproof.conform.run.conform"),
    ],
)
def test_a_limit_of_time_begins_when_the_planner_is_compiled(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, uncompiled: list[str], command: str, timed: str
) -> None:
    class Begins(Exception):  # noqa: N818 - nothing is wrong
        """The limit begins."""

    def begin(*_: object, **__: object) -> None:
        assert uncompiled == ["compiled"]
        raise Begins

    monkeypatch.setattr(timed, begin)
    assert "Begins" in carproof(command).stderr


@pytest.mark.parametrize(
    "search",
    [
        partial(carproof.plan_within, seconds=0.1),
        partial(carproof.bound, steps=1),
        partial(carproof.optimum, limit=5),
        partial(carproof.optimality_gap, planners=[carproof.Carp()], limit=5),
    ],
)
def test_from_python_too_the_planner_is_compiled_before_a_limit_begins(
    search: Callable[[Instance], object], uncompiled: list[str]
) -> None:
    search(VANISHING)
    assert uncompiled == ["compiled"]


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "command",
    [
        "demo",
        "plan town.json",
        "query town.json one.json r2",
        "add town.json one.json r2",
        "polish town.json plans.json --iterations 3",
        "audit town.json plans.json",
        "execution give-way town.json plans.json r1",
    ],
)
def test_every_command_that_plans_compiles_everything_at_once(
    carproof: Run, uncompiled: list[str], command: str
) -> None:
    carproof(command)
    assert uncompiled == ["compiled"]


@pytest.mark.nightly
def test_the_first_command_compiles_and_announces_it_and_no_later_one_does(folder: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache")}

    def announced(*words: str) -> str:
        command = [sys.executable, "-m", "carproof", *words]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stderr

    assert announced("plan", "town.json").count("compiles") == 1
    for later in ("demo", "polish town.json plans.json --seconds 0.1", "bound town.json --seconds 1", "warm"):
        assert announced(*later.split()) == ""
