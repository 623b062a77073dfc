"""The same source runs uncompiled, and with every index checked, and makes the same plans."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import carp_optimized
from carp_experiments.measuring.crosscheck import first_difference
from carp_spec import Instance, Planner, Solution

ROOT = Path(__file__).parents[3]
UNCOMPILED = (
    "neighbourhood/test_replanning",
    "neighbourhood/test_sorting",
    "neighbourhood/test_adding",
    "queries/test_reasons",
)
CROSSCHECK = "from carp_experiments.measuring.crosscheck import first_difference; print(first_difference({}, seed=3))"
BEYOND = """
from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Resource, ResourceGraph, Robot

fleet = PlannedFleet(Instance(ResourceGraph((Resource("a"),), ()), (Robot("r", "a", "a"),)))
try:
    passes.shortest(fleet.native, {})
except IndexError:
    print("an index out of bounds is noticed")
"""
NOTICED = "an index out of bounds is noticed\n"


def python(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """The result of Python for the arguments; wrap-around, which is intended, gives no warning."""
    command = [sys.executable, "-W", "ignore::RuntimeWarning", *arguments]
    environment = {**os.environ, **variables}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False, cwd=ROOT)


@pytest.mark.ci
def test_the_engines_agree_with_compilation_switched_off() -> None:
    done = python("-c", BEYOND.format(-1) + CROSSCHECK.format(200), NUMBA_DISABLE_JIT="1", NUMBA_BOUNDSCHECK="1")
    assert done.stdout == NOTICED + "None\n", done.stderr


@pytest.mark.nightly
def test_no_index_is_out_of_bounds() -> None:
    checked = {
        "NUMBA_BOUNDSCHECK": "1",
        "NUMBA_CACHE_DIR": str(ROOT / "build/bounds-checked"),
        "NUMBA_DISABLE_JIT": "0",
    }
    done = python("-c", BEYOND.format(1) + CROSSCHECK.format(300), **checked)
    assert done.stdout == NOTICED + "None\n", done.stderr


def test_a_planted_difference_is_found_and_made_small(monkeypatch: pytest.MonkeyPatch) -> None:
    def forgetful(instance: Instance, _: Planner) -> Solution:
        return Solution((), (), tuple(instance.robot))

    monkeypatch.setattr(carp_optimized, "plan", forgetful)
    difference = first_difference(200, seed=1)
    assert difference is not None
    assert len(difference.case.instance.robots) == 1
    assert difference.reference.plans
    assert not difference.optimized.plans


def test_the_tests_that_only_run_uncompiled_pass() -> None:
    quietly = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-W", "ignore::RuntimeWarning"]
    files = [f"tests/optimized/{name}.py" for name in UNCOMPILED]
    done = python("-m", "pytest", *quietly, *files, NUMBA_DISABLE_JIT="1", NUMBA_BOUNDSCHECK="1")
    assert done.returncode == 0, done.stdout
    assert "skipped" not in done.stdout
    assert "passed" in done.stdout
