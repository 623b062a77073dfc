"""The output on a terminal while bound and polish search."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path

import pytest

from carp_optimized import plan
from carproof import Carp, write_instance, write_solution
from carproof.generate import Fleet, Grid, grid_instance
from carproof.progress import search_progress

CODES = re.compile(r"\x1b\[[0-9;?]*[a-zA-Z]")


def on_a_terminal(*arguments: object, columns: int = 80) -> list[str]:
    """The output of carproof on a terminal, each line as often as it is written again."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {name: value for name, value in os.environ.items() if name not in ("CI", "COLUMNS", "NO_COLOR")}
    command = [sys.executable, "-m", "carproof", *map(str, arguments)]
    with subprocess.Popen(
        command, stdin=theirs, stdout=theirs, stderr=theirs, env={**environment, "TERM": "xterm"}
    ) as child:
        os.close(theirs)
        shown = b""
        while data := read(ours):
            shown += data
        assert child.wait() in (0, 1)
    os.close(ours)
    return [line for line in re.split(r"[\r\n]+", CODES.sub("", shown.decode())) if line.strip()]


def read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 1 << 16)
    except OSError:  # Linux reports the end of a terminal like this
        return b""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("progress")
    instance = grid_instance(Grid(8, 8, map=12), Fleet(robots=20, seed=3))
    town, plans = folder / "town.json", folder / "plans.json"
    town.write_bytes(write_instance(instance))
    plans.write_bytes(write_solution(plan(instance, Carp())))
    return town, plans


def test_bound_and_polish_show_a_bar_that_fits_and_what_they_found(files: tuple[Path, Path]) -> None:
    town, plans = files
    for label, arguments in (
        ("bounding", ("bound", town, "--steps", 100, "--plans", plans)),
        ("polishing", ("polish", town, plans, "--iterations", 500)),
    ):
        lines = on_a_terminal(*arguments)
        bars = [line for line in lines if line.startswith(label)]
        assert re.fullmatch(label + r" ━+ 0:00:00 total \d+, bound \d+, gap \d+\.\d\d %", bars[-1].strip())
        assert max(map(len, lines)) <= 80
        assert not lines[-1].startswith(label)


def test_where_there_is_no_terminal_nothing_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    with search_progress("bounding", 10, None) as show:
        show(3, "bound 7")
    assert capsys.readouterr() == ("", "")
