"""Files: unreadable, malformed and unwritable ones, and outputs that are whole or not there."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest
from tests.oracle.running import TWO, TWO_PLANNED, Run

from carproof.files import write_whole


@pytest.fixture
def town(tmp_path: Path) -> Path:
    path = tmp_path / "town.json"
    path.write_text(json.dumps(TWO))
    return path


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("", "$: the document must be JSON in UTF-8: Input data was truncated [document/json]"),
        (
            json.dumps({"format": "carproof-verdict/1", "valid": True, "cost": 0, "unplanned": 0, "violations": []}),
            "$.format: the format must be carproof-instance/1, and is carproof-verdict/1 [document/format]",
        ),
        (
            "?",
            "$: the document must be JSON in UTF-8: JSON is malformed: invalid character (byte 0) [document/json]",
        ),
        ("{}", "$.format: the format must be carproof-instance/1 [document/format]"),
        (
            json.dumps(TWO_PLANNED),
            "$.format: the format must be carproof-instance/1, and is carproof-solution/1 [document/format]",
        ),
        (json.dumps({**TWO, "extra": 1}), "$: object contains unknown field extra [document/shape]"),
        (
            json.dumps({**TWO, "robots": [{"id": "r1", "start": "a", "goal": "q"}]}),
            "$.robots[0].goal: the goal must be the id of a resource, and 'q' is not [instance/endpoint]",
        ),
        (
            json.dumps({**TWO, "robots": [{"id": "r1", "start": "a", "goal": "b", "release": 1.0}]}),
            "$.robots[0].release: expected int, got float [document/shape]",
        ),
    ],
)
def test_a_malformed_document_is_named_with_path_and_rule(carproof: Run, tmp_path: Path, text: str, error: str) -> None:
    broken = tmp_path / "broken.json"
    broken.write_text(text)
    outcome = carproof("plan", broken, "-o", tmp_path / "out.json")
    assert (outcome.code, outcome.stdout, outcome.stderr) == (2, "", f"Error: {broken}: {error}\n")
    assert not (tmp_path / "out.json").exists()
    assert carproof("plan", "-", stdin=text.encode()).stderr == f"Error: standard input: {error}\n"


def test_a_missing_file_and_a_folder_are_refused(carproof: Run, tmp_path: Path) -> None:
    assert f"{tmp_path / 'none'}: there is no such file." in carproof("plan", tmp_path / "none").stderr
    assert f"{tmp_path}: it is a folder." in carproof("plan", tmp_path).stderr


def test_a_name_that_is_empty_is_no_folder(carproof: Run) -> None:
    for arguments in (["plan", ""], ["generate", "grid", "-o", ""]):
        outcome = carproof(*arguments)
        assert (outcome.code, outcome.stdout) == (2, "")
        assert "the name of a file must not be empty." in outcome.stderr


def test_a_byte_order_mark_is_passed_over(carproof: Run, town: Path) -> None:
    marked = town.with_name("marked.json")
    marked.write_bytes(b"\xef\xbb\xbf" + town.read_bytes())
    assert carproof("plan", marked, "--json").stdout == carproof("plan", town, "--json").stdout
    assert carproof("plan", "-", "--json", stdin=marked.read_bytes()).code == 0


def test_an_unreadable_file_is_refused(carproof: Run) -> None:
    outcome = carproof("plan", "/proc/self/mem")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr == "Error: /proc/self/mem: it cannot be read: Input/output error\n"


@pytest.mark.parametrize(
    ("output", "error"),
    [
        ("{0}", "{0}: it is a folder."),
        ("{0}/none/out.json", "there is no folder {0}/none."),
        ("/proc/x", "/proc/x: it "),
    ],
)
def test_an_unwritable_output_is_refused(carproof: Run, town: Path, output: str, error: str) -> None:
    outcome = carproof("plan", town, "-o", output.format(town.parent))
    assert (outcome.code, outcome.stdout) == (2, "")
    assert error.format(town.parent) in outcome.stderr


def test_only_one_input_can_be_standard_input(carproof: Run) -> None:
    outcome = carproof("check", "-", "-")
    assert outcome.code == 2
    assert "Only one of the files can be standard input." in outcome.stderr


def test_a_file_is_replaced_whole_and_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    path.write_bytes(b"old")
    path.chmod(0o640)
    (tmp_path / "link").symlink_to(path)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o640
    assert sorted(each.name for each in tmp_path.iterdir()) == ["link", "out.json"]


def test_a_link_is_followed_and_stays_a_link(carproof: Run, town: Path) -> None:
    link = town.parent / "link.json"
    link.symlink_to(town.parent / "target.json")
    assert carproof("plan", town, "-o", link).code == 0
    assert link.is_symlink()
    assert json.loads(link.read_text())["format"] == "carproof-solution/1"


def test_a_device_is_written_and_not_replaced(carproof: Run, town: Path) -> None:
    assert carproof("plan", town, "-o", "/dev/null").code == 0
    assert not Path("/dev/null").is_file()


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "out.json"
    path.write_bytes(b"old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(click.ClickException, match="it cannot be written: No space left on device"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_an_interrupt_ends_with_one_word_and_no_output_file(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "carproof"]
    large = subprocess.run([*command, "generate", "grid", "--map", "10"], check=True, capture_output=True).stdout
    (tmp_path / "town.json").write_bytes(large)
    arguments = ["plan", "town.json", "--planner", "shuffled", "--attempts", "1000000", "-o", "out.json"]
    with subprocess.Popen(
        [*command, *arguments], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        time.sleep(3)
        os.kill(process.pid, signal.SIGINT)
        try:
            output, errors = process.communicate(timeout=20)
        finally:
            process.kill()
    assert (process.returncode, output, errors) == (130, b"", b"Interrupted.\n")
    assert [each.name for each in tmp_path.iterdir()] == ["town.json"]
