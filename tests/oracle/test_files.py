"""Files that are read as they are meant, and outputs that are whole or not there."""

import json
from pathlib import Path

import click
import pytest
from tests.oracle.running import Run

from carproof.command_line.files import write_whole


def test_a_byte_order_mark_is_passed_over(carproof: Run, folder: Path) -> None:
    marked = b"\xef\xbb\xbf" + (folder / "town.json").read_bytes()
    (folder / "marked.json").write_bytes(marked)
    plans = carproof("plan town.json --json")
    assert carproof("plan marked.json --json") == carproof("plan - --json", stdin=marked) == plans
    assert plans.code == 0


def test_a_file_is_replaced_whole_and_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    path.write_bytes(b"old")
    path.chmod(0o640)
    (tmp_path / "link").symlink_to(path)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o640
    assert sorted(each.name for each in tmp_path.iterdir()) == ["link", "out.json"]


def test_a_link_is_followed_and_stays_a_link(carproof: Run, folder: Path) -> None:
    link = folder / "link.json"
    link.symlink_to(folder / "target.json")
    assert carproof("plan town.json -o link.json").code == 0
    assert link.is_symlink()
    assert json.loads(link.read_text())["format"] == "carproof-solution/1"


@pytest.mark.usefixtures("folder")
def test_a_device_is_written_and_not_replaced(carproof: Run) -> None:
    assert carproof("plan town.json -o /dev/null").code == 0
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
