"""SIGINT and SIGTERM end every command at once with 130 or 143, and nothing is left of it."""

import itertools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from carp_optimized import plan
from carproof import Carp, write_instance, write_solution
from carproof.entry.supervising import GRACE
from carproof.generate import Fleet, Grid, grid_instance

CARPROOF = [sys.executable, "-m", "carproof"]
PATIENCE = 5.0
"""Seconds beyond the grace after which a test calls it a hang: the machine may be busy."""
LOADING = 60.0
"""Seconds after which a program that has not started its processes is called a hang."""
FEW = ["bound town.json --seconds 600 -o out.json", "check - plans.json"]
MORE = [
    "optimum town.json --limit 600 -o out.json",
    "polish town.json plans.json --seconds 600 -o out.json",
    "plan town.json --planner shuffled --attempts 1000000 -o out.json",
    "gap town.json --limit 600",
    "check --z3 large.json large-plans.json",
    "dev bench",
    "dev crosscheck",
    "audit large.json large-plans.json --engine reference",
    "serve",
    "conform --examples 100000 -- {carproof} serve",
    "experiment quality --quick --store quality.sqlite --workers 2",
]
TWO_CORES = sys.platform == "linux" and len(os.sched_getaffinity(0)) > 1


@pytest.fixture(scope="module")
def town(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("town")
    for name, side, robots in (("town", 20, 100), ("large", 60, 300)):
        instance = grid_instance(Grid(width=side, height=side), Fleet(robots=robots))
        (folder / f"{name}.json").write_bytes(write_instance(instance))
        (folder / f"{'' if name == 'town' else 'large-'}plans.json").write_bytes(write_solution(plan(instance, Carp())))
    return folder


def processes_of(marker: str) -> list[str]:
    """The processes, but this one, whose environment has the marker."""
    found = []
    for folder in Path("/proc").iterdir():
        try:
            if folder.name.isdigit() and marker.encode() in (folder / "environ").read_bytes():
                found.append(folder.name)
        except OSError:
            continue
    return found


def interrupted(command: str, number: signal.Signals, folder: Path, seconds: float, processes: int = 2) -> None:
    """Run a command, interrupt it some seconds after it has that many processes, and look at what is left."""
    before = {each.name for each in folder.iterdir()}
    marker = f"CARPROOF_TEST={number}-{os.getpid()}-{time.monotonic_ns()}"
    name, _, value = marker.partition("=")
    arguments = command.format(carproof=" ".join(CARPROOF)).split()
    with subprocess.Popen(
        [*CARPROOF, *arguments],
        cwd=folder,
        env={**os.environ, name: value},
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        deadline = time.monotonic() + LOADING
        while len(processes_of(marker)) < processes and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(seconds)
        assert process.poll() is None, f"{command} ended by itself"
        assert len(processes_of(marker)) >= processes
        started = time.monotonic()
        process.send_signal(number)
        process.wait()
        left = processes_of(marker)
        taken = time.monotonic() - started
        stderr = process.stderr.read() if process.stderr else ""
    assert process.returncode == 128 + number
    assert taken < GRACE + PATIENCE
    assert stderr.endswith("Interrupted.\n")
    assert "Traceback" not in stderr
    assert left == []
    assert {each.name for each in folder.iterdir()} <= before | {"quality.sqlite"}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("command", FEW)
def test_a_signal_ends_a_command_with_all_that_it_started(command: str, number: signal.Signals, town: Path) -> None:
    interrupted(command, number, town, 1.0)


@pytest.mark.nightly
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(("command", "seconds"), [*itertools.product(MORE, (0.1, 0.3))])
def test_a_signal_ends_every_long_command(command: str, number: signal.Signals, seconds: float, town: Path) -> None:
    interrupted(command, number, town, seconds)


@pytest.mark.nightly
@pytest.mark.skipif(not TWO_CORES, reason="the search has a process of its own on a second core of a Linux machine")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_search_and_the_one_beside_it(number: signal.Signals, town: Path) -> None:
    (town / "hard.json").write_bytes(write_instance(grid_instance(Grid(map=8), Fleet(robots=80))))
    interrupted("optimum hard.json --limit 600 --processes 2 -o out.json", number, town, 0.3, processes=3)


EARLY = """
import os, sys
from carproof.entry import start

class Interrupting:
    def find_spec(self, name, *_):
        if name == "carproof.entry.cli":
            os.kill(os.getpid(), int(sys.argv[1]))

sys.meta_path.insert(0, Interrupting())
sys.exit(start.main())
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_the_command_is_loaded_shows_no_traceback(number: signal.Signals) -> None:
    done = subprocess.run([sys.executable, "-c", EARLY, str(int(number))], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (128 + number, b"", b"Interrupted.\n")


STUCK = """
import os, signal, sys
from carproof.entry.supervising import supervised

def stuck():
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])
    if os.fork():
        print("ready", flush=True)
    while True:
        signal.pause()

sys.exit(supervised(stuck))
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_command_that_looks_at_no_signal_is_killed_with_its_workers(number: signal.Signals) -> None:
    marker = f"CARPROOF_STUCK={os.getpid()}-{number}"
    name, _, value = marker.partition("=")
    with subprocess.Popen(
        [sys.executable, "-c", STUCK], env={**os.environ, name: value}, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        process.send_signal(number)
        code = process.wait(GRACE + PATIENCE)
    assert code == (-9 if number == signal.SIGKILL else 128 + number)
    deadline = time.monotonic() + PATIENCE
    while number != signal.SIGKILL and processes_of(marker) and time.monotonic() < deadline:
        time.sleep(0.05)
    left = processes_of(marker)
    for each in left:
        os.kill(int(each), signal.SIGKILL)
    assert number == signal.SIGKILL or not left


def test_the_exit_code_is_that_of_the_command(tmp_path: Path) -> None:
    def ends(how: str) -> tuple[int, bytes]:
        program = (
            f"import os, sys; from carproof.entry.supervising import supervised; sys.exit(supervised(lambda: {how}))"
        )
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, cwd=tmp_path)  # noqa: PLW1510 - looked at
        return done.returncode, done.stderr

    assert [ends(str(code)) for code in (0, 1, 3)] == [(0, b""), (1, b""), (3, b"")]
    code, stderr = ends("os.kill(os.getpid(), 9)")
    assert (code, stderr) == (70, b"carproof was ended by SIGKILL; if nobody sent it, memory has run out.\n")


def test_exhausted_memory_is_no_answer(tmp_path: Path) -> None:
    (tmp_path / "large.json").write_bytes(b" " * 2**28)
    shell = f"ulimit -v 400000; exec {' '.join(CARPROOF)} check large.json large.json"
    done = subprocess.run(["/bin/sh", "-c", shell], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (3, "Undecided: the memory does not suffice.\n")
