"""The same source runs uncompiled, and makes the same plans."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
UNCOMPILED = ("test_replanning", "test_reasons", "test_sorting", "test_little_memory", "test_adding")
CROSSCHECK = "from carp_experiments.measuring.crosscheck import first_difference; print(first_difference(60, seed=3))"


def uncompiled(*arguments: str) -> subprocess.CompletedProcess[str]:
    """The result of plain Python for the arguments; wrap-around, which is intended, gives no warning."""
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore::RuntimeWarning", *arguments]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False, cwd=ROOT)


@pytest.mark.ci
def test_the_engines_agree_with_compilation_switched_off() -> None:
    done = uncompiled("-c", CROSSCHECK)
    assert done.stdout == "None\n", done.stderr


def test_the_tests_that_only_run_uncompiled_pass() -> None:
    quietly = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-W", "ignore::RuntimeWarning"]
    done = uncompiled("-m", "pytest", *quietly, *(f"tests/optimized/{name}.py" for name in UNCOMPILED))
    assert done.returncode == 0, done.stdout
    assert "skipped" not in done.stdout
    assert "passed" in done.stdout
