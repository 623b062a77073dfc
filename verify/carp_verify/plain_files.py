"""Reads files that somebody else put into a folder: plain ones alone, and no more of them than is allowed.

A link may lead anywhere, a pipe keeps its reader waiting, and a device such as `/dev/zero` has no end.
"""

import os
import stat
from pathlib import Path
from typing import Final

UNFOLLOWED: Final = os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY


class PlainFileError(Exception):
    """Why a file was not read, as the end of a sentence that begins with its name."""


def read_plain_file(folder: Path, name: str, most: int) -> bytes:
    """The content of the plain file of that name in the folder itself, of at most `most` bytes.

    Raises `PlainFileError` for anything else: a link, folder, pipe, socket or device, also if it takes the file's place
    meanwhile, or a file that is larger.
    """
    path = folder / name
    try:
        _require_plain(path.lstat())
        with open(path, "rb", opener=lambda file, _: os.open(file, UNFOLLOWED)) as file:
            _require_plain(os.fstat(file.fileno()))
            content = file.read(most + 1) if os.fstat(file.fileno()).st_size <= most else None
    except OSError as error:
        raise PlainFileError(f"it cannot be read: {error.strerror}") from error
    if content is None or len(content) > most:
        raise PlainFileError(f"it has more than {most} bytes")
    return content


def _require_plain(status: os.stat_result) -> None:
    if not stat.S_ISREG(status.st_mode):
        kind = "a link" if stat.S_ISLNK(status.st_mode) else "a folder, pipe, socket or device"
        raise PlainFileError(f"it must be a plain file, and is {kind}")
