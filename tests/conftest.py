"""Hypothesis' profile, what the environment of every test lacks, and the command line in a folder with documents."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from tests.oracle.running import BROKEN, ONE_PLANNED, TWO, TWO_PLANNED, Outcome, Run, save
from tests.profiles import load_profile

load_profile()

# A shell that runs the tests in the background ignores interrupts for them, and programs would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The programs that the tests start print for a person at a terminal of the usual width, on a build server too: pytest
# for one prints its summary otherwise where CI is set.
for name in ("CI", "BUILD_NUMBER", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "PY_COLORS", "PYTEST_ADDOPTS"):
    os.environ.pop(name, None)


@pytest.fixture
def carproof() -> Run:
    """Run `carproof` in this process: its first argument is split into words."""
    from carproof.entry.cli import main

    def run(words: str = "", *arguments: object, stdin: bytes = b"") -> Outcome:
        with CliRunner().isolation(input=stdin) as (stdout, stderr, _):
            code = main([*words.split(), *map(str, arguments)])
            sys.stdout.flush()
            return Outcome(code, stdout.getvalue().decode(), stderr.getvalue().decode())

    return run


@pytest.fixture
def process() -> Run:
    """Run `carproof` as a process of its own."""

    def run(words: str, *arguments: object, stdin: bytes = b"") -> Outcome:
        command = [sys.executable, "-m", "carproof", *words.split(), *map(str, arguments)]
        done = subprocess.run(command, input=stdin, capture_output=True)  # noqa: PLW1510 - the code is the outcome
        return Outcome(done.returncode, done.stdout.decode(), done.stderr.decode())

    return run


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to be in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def folder(elsewhere: Path) -> Path:
    """A folder to be in, with an instance, plans of both its robots, of one, and broken ones."""
    save(town=TWO, plans=TWO_PLANNED, one=ONE_PLANNED, broken=BROKEN)
    return elsewhere
