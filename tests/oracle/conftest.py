"""Runs the command line within the test's own process, or as a process of its own."""

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from tests.oracle.running import Outcome, Run

from carproof.cli import main


@pytest.fixture(scope="session", autouse=True)
def _compiled() -> None:
    """Compile before the first test, whose output would tell of it."""
    from carp_optimum.__main__ import compile_all

    compile_all()


@pytest.fixture
def carproof() -> Run:
    """Run `carproof` in this process."""

    def run(*arguments: str | Path, stdin: bytes = b"") -> Outcome:
        with CliRunner().isolation(input=stdin) as (stdout, stderr, _):
            code = main([str(argument) for argument in arguments])
            sys.stdout.flush()
            return Outcome(code, stdout.getvalue().decode(), stderr.getvalue().decode())

    return run


@pytest.fixture
def process() -> Run:
    """Run `carproof` as a process of its own."""

    def run(*arguments: str | Path, stdin: bytes = b"") -> Outcome:
        done = subprocess.run([sys.executable, "-m", "carproof", *arguments], input=stdin, capture_output=True)  # noqa: PLW1510 - the code is the outcome
        return Outcome(done.returncode, done.stdout.decode(), done.stderr.decode())

    return run
