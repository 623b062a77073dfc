"""Files that are read as they are meant, and outputs that are whole or not there."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Run


def test_a_byte_order_mark_is_passed_over(carproof: Run, folder: Path) -> None:
    marked = b"\xef\xbb\xbf" + (folder / "town.json").read_bytes()
    (folder / "marked.json").write_bytes(marked)
    plans = carproof("plan town.json --json")
    assert carproof("plan marked.json --json") == carproof("plan - --json", stdin=marked) == plans
    assert plans.code == 0


def test_a_file_is_replaced_whole_behind_a_link_too_and_keeps_its_mode(carproof: Run, folder: Path) -> None:
    link, target = folder / "link.json", folder / "target.json"
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to(target)
    before = {*folder.iterdir()}
    assert carproof("plan town.json -o link.json").code == 0
    assert json.loads(target.read_text())["format"] == "carproof-solution/1"
    assert (link.is_symlink(), target.stat().st_mode & 0o777) == (True, 0o640)
    assert {*folder.iterdir()} == before


@pytest.mark.usefixtures("folder")
def test_a_device_is_written_and_not_replaced(carproof: Run) -> None:
    assert carproof("plan town.json -o /dev/null").code == 0
    assert not Path("/dev/null").is_file()


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(
    carproof: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    before = {path: path.read_bytes() for path in folder.iterdir()}
    monkeypatch.setattr(Path, "replace", fail)
    outcome = carproof("plan town.json -o plans.json")
    assert outcome.code == 2
    assert outcome.stderr.endswith("plans.json: it cannot be written: No space left on device\n")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
