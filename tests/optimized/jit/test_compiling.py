"""Compilation happens once, is announced, and happens again when any source has changed."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import carp_optimized
import carp_optimum
from carp_optimized.jit.compiling import is_cached
from carp_optimized.neighbourhood.adding import add_robot

ENTRIES = """
from carp_optimized.jit.compiling import entry

@entry
def twice(number: int) -> int:
    return 2 * number

@entry
def thrice(number: int) -> int:
    return 3 * number
"""
CALLS = "import entries; print(entries.twice(2), entries.thrice(2))"
NOTICE = "carproof compiles its planner, once: it takes about a minute ...\n"


def start(folder: Path, **variables: str) -> "subprocess.Popen[str]":
    """A new process that calls both entries."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    return subprocess.Popen(
        [sys.executable, "-c", CALLS],
        env={**environment, "PYTHONPATH": str(folder), **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def call_entries(folder: Path, **variables: str) -> tuple[str, str]:
    """The output of a new process that calls both entries."""
    with start(folder, **variables) as process:
        return process.communicate()


def test_compiling_is_told_once_and_done_again_only_after_a_change(tmp_path: Path) -> None:
    source = tmp_path / "entries.py"
    source.write_text(ENTRIES)
    assert call_entries(tmp_path) == ("4 6\n", NOTICE)
    assert call_entries(tmp_path) == ("4 6\n", "")
    later = source.stat().st_mtime + 100
    other = tmp_path / "beside.py"
    other.touch()
    os.utime(other, (later, later))
    assert call_entries(tmp_path) == ("4 6\n", NOTICE)


def test_a_later_source_in_any_folder_of_a_package_has_it_compiled_again(tmp_path: Path) -> None:
    room = tmp_path / "town" / "room"
    room.mkdir(parents=True)
    (room.parent / "__init__.py").touch()
    (room / "doors.py").touch()
    asked = f"""
import os
from carp_optimized.jit.compiling import is_compiled, note_that_it_is_compiled
note_that_it_is_compiled("town")
print(is_compiled("town"))
os.utime("{room}/doors.py", (1 << 40, 1 << 40))
print(is_compiled("town"))
"""
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path),
        "NUMBA_DISABLE_JIT": "0",
        "PYTHONPATH": str(tmp_path),
    }
    done = subprocess.run([sys.executable, "-c", asked], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "True\nFalse\n"


def test_two_first_runs_at_the_same_time_do_not_disturb_each_other(tmp_path: Path) -> None:
    (tmp_path / "entries.py").write_text(ENTRIES)
    processes = [start(tmp_path) for _ in range(2)]
    assert {process.communicate()[0] for process in processes} == {"4 6\n"}
    assert call_entries(tmp_path) == ("4 6\n", "")


@pytest.fixture
def read_only(tmp_path: Path) -> dict[str, str]:
    """Sources beside which nothing can be written, and a home that is not there."""
    (tmp_path / "entries.py").write_text(ENTRIES)
    (tmp_path / "__pycache__").touch()
    return {"HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null", "TMPDIR": str(tmp_path / "temporary")}


def test_what_cannot_be_kept_beside_its_source_is_kept_among_the_temporary_files(
    tmp_path: Path, read_only: dict[str, str]
) -> None:
    (tmp_path / "temporary").mkdir()
    assert call_entries(tmp_path, **read_only) == ("4 6\n", NOTICE)
    assert call_entries(tmp_path, **read_only) == ("4 6\n", "")
    (folder,) = (tmp_path / "temporary").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700


def test_a_folder_that_others_can_write_is_not_trusted(tmp_path: Path, read_only: dict[str, str]) -> None:
    folder = tmp_path / "temporary" / f"carproof-{os.getuid()}"
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    output, errors = call_entries(tmp_path, **read_only)
    assert (output, errors.count("in each process, as it finds no folder")) == ("4 6\n", 1)
    assert list(folder.iterdir()) == []


def test_a_function_that_is_not_compiled_is_not_cached() -> None:
    assert not is_cached(add_robot.__wrapped__ if hasattr(add_robot, "__wrapped__") else add_robot)


def entries() -> set[str]:
    """All functions that Python calls, each with its file."""
    folders = (Path(module.__file__ or "").parent for module in (carp_optimized, carp_optimum))
    return {
        f"{source}:{node.name}"
        for folder in folders
        for source in folder.rglob("*.py")
        for node in ast.walk(ast.parse(source.read_text()))
        if isinstance(node, ast.FunctionDef)
        and any(isinstance(each, ast.Name) and each.id == "entry" for each in node.decorator_list)
    }


def test_the_installation_compiles_every_entry() -> None:
    watched = """
import sys
called = set()
def watch(frame, event, _):
    if event == "call":
        called.add(f"{frame.f_code.co_filename}:{frame.f_code.co_name}")
sys.setprofile(watch)
from carp_optimum.__main__ import compile_all
compile_all()
sys.setprofile(None)
print(*called, sep="\\n")
"""
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore", "-c", watched]
    called = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(entries()) > 13
    assert entries() <= set(called)
