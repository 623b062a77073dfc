"""A machine on which nothing can be written, by real read-only mounts in a namespace of the test's own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.optimized.jit.test_compiling import CALLS, ENTRIES

READ_ONLY = """
awk '{print $2}' /proc/self/mounts | sort -u | while read -r folder; do
    case $folder in /proc*|/sys*|/dev*) ;; *) mount -o remount,ro,bind "$folder" || exit 9 ;; esac
done || exit 9
mount -o remount,ro,bind /dev/shm 2>/dev/null
if touch "$0" 2>/dev/null; then exit 9; fi
exec "$@"
"""


def run_read_only(folder: Path, *command: str) -> "subprocess.CompletedProcess[str]":
    """Run a command where no file can be written; skip the test where that cannot be arranged."""
    variables = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA_", "XDG_"))}
    done = subprocess.run(
        ["/usr/bin/env", "unshare", "--mount", "/bin/sh", "-c", READ_ONLY, str(folder / "probe"), *command],
        cwd=folder,
        env={**variables, "HOME": "/nonexistent", "PYTHONPATH": str(folder)},
        check=False,
        capture_output=True,
        text=True,
    )
    if done.returncode == 9 or "unshare" in done.stderr:
        pytest.skip("no file system can be mounted read-only here")
    return done


def test_solutions_are_checked(folder: Path) -> None:
    done = run_read_only(folder, sys.executable, "-m", "carproof", "check", "town.json", "plans.json")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("no rule is broken")


def test_what_is_compiled_is_not_kept_and_that_is_said_once(folder: Path) -> None:
    (folder / "entries.py").write_text(ENTRIES)
    done = run_read_only(folder, sys.executable, "-c", CALLS)
    assert (done.returncode, done.stdout) == (0, "4 6\n"), done.stderr
    assert done.stderr.count("in each process, as it finds no folder") == 1
    assert done.stderr.count("\n") == 1


def test_a_planner_that_reads_files_needs_a_place_for_them(folder: Path) -> None:
    command = [sys.executable, "-m", "carproof", "conform", "--one-shot", "--", "true", "{instance}"]
    done = run_read_only(folder, "env", "NUMBA_DISABLE_JIT=1", *command)
    assert done.returncode == 2
    assert "TMPDIR can name one" in done.stderr
    assert done.stderr.count("\n") == 1
