"""The command line as a whole: help, lazy loading, exit codes and closed pipes."""

import json
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
from tests.oracle.running import Run

from carproof.commands import COMMANDS, RENAMED

SLOW_TO_LOAD = ("z3", "numba", "numpy", "networkx", "pysat", "hypothesis", "matplotlib")
CARPROOF = Path(sys.executable).with_name("carproof")


def test_help_which_no_arguments_ask_for_too_names_every_command_and_fits_eighty_columns(carproof: Run) -> None:
    outcome = carproof("--help")
    assert outcome.code == 0
    assert carproof() == outcome
    assert all(f"\n  {name} " in outcome.stdout for name in (*COMMANDS, "experiment"))
    assert max(map(len, outcome.stdout.splitlines())) <= 80


@pytest.mark.parametrize("name", [*COMMANDS, "experiment"])
def test_each_command_explains_itself_with_an_example(carproof: Run, name: str) -> None:
    outcome = carproof(name, "--help")
    assert outcome.code == 0
    assert f"\n    carproof {name}" in outcome.stdout
    assert max(map(len, outcome.stdout.splitlines())) <= 80


@pytest.mark.parametrize("old", RENAMED)
def test_old_names_stand_for_the_new_ones(carproof: Run, old: str) -> None:
    now = " ".join(RENAMED[old])
    outcome = carproof(old, "--help")
    assert outcome.code == 0
    assert outcome.stdout == carproof(*RENAMED[old], "--help").stdout
    assert f"carproof {now}" in outcome.stderr


def test_a_shell_completes_commands_options_and_files(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_CARPROOF_COMPLETE", "bash_source")
    assert "_carproof_completion() {" in carproof().stdout
    monkeypatch.setenv("_CARPROOF_COMPLETE", "bash_complete")
    for words, index, completion in (
        ("carproof confo", "1", "plain,conform"),
        ("carproof check --requ", "2", "plain,--require-all"),
        ("carproof check to", "2", "file,to"),
        ("carproof plan town.json -o pl", "4", "file,pl"),
    ):
        monkeypatch.setenv("COMP_WORDS", words)
        monkeypatch.setenv("COMP_CWORD", index)
        assert carproof().stdout == f"{completion}\n"


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "command", ["plan town.json", "check town.json plans.json", "bound town.json --steps 1", "generate grid"]
)
def test_a_document_on_standard_output_leaves_standard_error_to_people(carproof: Run, command: str) -> None:
    outcome = carproof(f"{command} -o -")
    assert outcome.code == 0, outcome
    assert json.loads(outcome.stdout)["format"].startswith("carproof-")
    assert outcome.stderr


@pytest.mark.usefixtures("folder")
def test_check_loads_nothing_slow() -> None:
    program = (
        "import sys; from carproof.entry.cli import main; code = main(['check', 'town.json', 'plans.json', '--json']);"
        f"assert code == 0; print([name for name in {SLOW_TO_LOAD} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert done.stdout.endswith("}\n[]\n")


@pytest.mark.parametrize("arguments", ["rules", "--help", "rules joint/capacity"])
def test_a_closed_pipe_ends_a_command_quietly(arguments: str) -> None:
    shell = f"{{ {{ {CARPROOF} {arguments}; echo $? >&3; }} | true; }} 3>&1"
    done = subprocess.run(["/bin/sh", "-c", shell], check=True, capture_output=True, text=True)
    assert done.stdout in ("141\n", "0\n"), "0: the output fitted into the pipe before it was closed"
    assert done.stderr == ""


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "arguments",
    [
        "rules",
        "--help",
        "plan town.json",
        "plan town.json -o -",
        "plan town.json -o new.json",
        "check town.json plans.json",
    ],
)
def test_output_that_is_lost_is_no_answer(arguments: str) -> None:
    for where, reason in ((">&-", "standard output is closed"), (">/dev/full", "No space left on device")):
        shell = f"{CARPROOF} {arguments} {where}"
        done = subprocess.run(["/bin/sh", "-c", shell], check=False, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (2, f"Error: the output cannot be written: {reason}\n")


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("where", ["2>&-", "2>/dev/full"])
@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ("check town.json plans.json", 0),
        ("check town.json broken.json", 1),
        ("rules >&-", 2),
        ("rules >/dev/full", 2),
    ],
)
def test_messages_that_are_lost_change_no_answer(arguments: str, code: int, where: str) -> None:
    shell = f"{CARPROOF} {arguments} {where}"
    assert subprocess.run(["/bin/sh", "-c", shell], check=False, stdout=subprocess.PIPE).returncode == code


@pytest.mark.parametrize(("arguments", "code"), [("check - x <&- 2>&-", 2), ("plan - <&-", 2), ("serve <&-", 0)])
def test_a_closed_standard_input_is_an_empty_one(arguments: str, code: int) -> None:
    done = subprocess.run(["/bin/sh", "-c", f"{CARPROOF} {arguments}"], check=False, capture_output=True, text=True)
    assert done.returncode == code
    assert "Traceback" not in done.stderr


def test_a_terminal_without_unicode_gets_plain_tables() -> None:
    shell = f"PYTHONIOENCODING=ascii {CARPROOF} rules"
    done = subprocess.run(["/bin/sh", "-c", shell], check=True, capture_output=True, text=True)
    assert done.stdout.isascii()
    assert done.stdout.splitlines()[0].startswith("rule ")


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("command", ["rules", "check town.json broken.json", "gap town.json --limit 5"])
def test_a_narrow_terminal_shows_every_word_of_a_table_whole(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    wide = [word for word in carproof(command).stdout.split() if len(word) <= 20 and word.isalpha()]
    for name, value in (("COLUMNS", "40"), ("FORCE_COLOR", "1"), ("TERM", "xterm")):
        monkeypatch.setenv(name, value)
    narrow = re.sub(r"\x1b\[[0-9;]*m|:", " ", carproof(command).stdout).split()
    assert wide
    assert {*wide} <= {*narrow}


def test_progress_goes_to_standard_error_and_only_to_a_terminal(tmp_path: Path) -> None:
    town = tmp_path / "town.json"
    subprocess.run([CARPROOF, "generate", "grid", "--robots", "5", "-o", town], check=True, capture_output=True)
    terminal, end = pty.openpty()
    plan: list[str | Path] = [CARPROOF, "plan", town, "--json"]
    shown = subprocess.run(plan, check=True, stdout=subprocess.PIPE, stderr=end, env={**os.environ, "TERM": "xterm"})
    os.close(end)
    assert b"planning" in os.read(terminal, 100_000)
    silent = subprocess.run(plan, check=True, capture_output=True)
    assert silent.stderr == b""
    assert silent.stdout == shown.stdout
    assert silent.stdout.startswith(b'{"format":')


def test_a_fault_of_ours_is_no_answer(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carproof.commands.judge.rules.rule_named", lambda _: 1 // 0)
    outcome = carproof("rules", "joint/capacity")
    assert outcome.code == 70
    assert outcome.stderr.endswith("carproof failed by a fault of its own; the lines above say where.\n")
