"""Files that others put into a folder: only plain ones are read, at once, and no more than is allowed."""

import os
import signal
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.oracle.running import Run

from carp_verify.plain_files import PlainFileError, read_plain_file


@pytest.fixture(autouse=True)
def _impatience() -> Iterator[None]:
    """Fail a test that waits for a pipe."""
    signal.alarm(20)
    yield
    signal.alarm(0)


def test_a_plain_file_is_read_up_to_its_size(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"12345")
    assert read_plain_file(tmp_path, "file", 5) == b"12345"
    with pytest.raises(PlainFileError, match="it has more than 4 bytes"):
        read_plain_file(tmp_path, "file", 4)
    with pytest.raises(PlainFileError, match="it cannot be read: No such file"):
        read_plain_file(tmp_path, "other", 4)


def test_the_folder_may_be_a_link(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder/file").write_bytes(b"")
    (tmp_path / "link").symlink_to("folder")
    assert read_plain_file(tmp_path / "link", "file", 0) == b""


def bound_socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(path))


def link_inside(path: Path) -> None:
    (path.parent / "beside").write_bytes(b"12345")
    path.symlink_to("beside")


@pytest.mark.parametrize(
    "make",
    [
        os.mkfifo,
        Path.mkdir,
        bound_socket,
        link_inside,
        lambda path: path.symlink_to("/dev/zero"),
        lambda path: path.symlink_to("/etc/passwd"),
        lambda path: path.symlink_to("nowhere"),
        lambda path: path.symlink_to(path),
    ],
)
def test_anything_else_is_refused_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make: Callable[[Path], object]
) -> None:
    monkeypatch.chdir(tmp_path)  # the path of a socket must be short
    make(Path("file"))
    with pytest.raises(PlainFileError, match="it must be a plain file"):
        read_plain_file(Path(), "file", 1 << 20)


def test_a_device_is_refused() -> None:
    with pytest.raises(PlainFileError, match="it must be a plain file"):
        read_plain_file(Path("/dev"), "zero", 1 << 20)


@pytest.mark.parametrize("replaced", [os.mkfifo, lambda path: path.symlink_to("/dev/zero")])
def test_a_file_that_is_replaced_meanwhile_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, replaced: Callable[[Path], object]
) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    status = path.lstat()
    path.unlink()
    replaced(path)
    monkeypatch.setattr(Path, "lstat", lambda _: status)
    with pytest.raises(PlainFileError):
        read_plain_file(tmp_path, "file", 1 << 20)


@pytest.mark.parametrize("name", ["manifest.json", "instance.json", "beat.lrat"])
def test_a_proof_with_such_a_file_is_not_proved(carproof: Run, folder: Path, name: str) -> None:
    carproof("optimum town.json --proof proof")
    (folder / "proof" / name).unlink()
    os.mkfifo(folder / "proof" / name)
    outcome = carproof("verify proof")
    assert (outcome.code, outcome.stderr) == (1, "")
    assert outcome.stdout.startswith(f"not proved: {name}: it must be a plain file, and is ")
