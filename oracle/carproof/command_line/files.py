"""Reading and writing the user's files: one clear sentence when it cannot be done, and never half a file."""

import os
import secrets
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, TypeVar

import click

from carp_spec import Instance, Refusal, Solution
from carp_spec.documents.instances import read_instance
from carp_spec.documents.solutions import read_solution
from carp_spec.requests import sound_solution
from carproof.formats.layouts import MAP, layout_named
from carproof.requests import document_of

T = TypeVar("T")
FileName: TypeAlias = str | os.PathLike[str]
STANDARD_INPUT = "-"
STANDARD_OUTPUT = Path("/dev/stdout")
TAKEN = "carproof.standard-output-is-taken"
READ = "carproof.standard-input-is-read"
WRITTEN = "carproof.files-to-write"
BYTE_ORDER_MARK = b"\xef\xbb\xbf"


class InputFile(click.Path[str]):
    """An existing file to read, or for one input of a command `-`; its value is the name. Perhaps a folder too."""

    def __init__(self, *, folders: bool = False) -> None:
        super().__init__(dir_okay=folders)

    def convert(self, value: FileName, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Refuse a name that cannot be an input, before any work is done."""
        name = os.fspath(value)
        if not name:
            self.fail("the name of a file must not be empty.", param, ctx)
        if name == STANDARD_INPUT:
            if ctx is not None and ctx.meta.get(READ):
                raise click.UsageError("Only one of the files can be standard input.", ctx)
            if ctx is not None:
                ctx.meta[READ] = True
        elif os.path.isdir(name) and not self.dir_okay:  # noqa: PTH112 - a name that is too long is none
            self.fail(f"{name}: it is a folder.", param, ctx)
        elif not os.path.exists(name):  # noqa: PTH110
            self.fail(f"{name}: there is no such file.", param, ctx)
        return name


class OutputFile(click.Path[Path]):
    """A file to write; its value is the path."""

    def __init__(self) -> None:
        super().__init__(dir_okay=False)

    def convert(self, value: FileName, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Refuse a name that cannot be written, before any work is done.

        With `-` standard output is for the document alone, and text for people goes to standard error.
        """
        if not value:
            self.fail("the name of a file must not be empty.", param, ctx)
        path = STANDARD_OUTPUT if value == "-" else Path(os.path.realpath(value))
        if value == "-" and ctx is not None:
            ctx.meta[TAKEN] = True
        try:
            path.exists()
        except OSError as error:
            self.fail(f"{value}: it cannot be written: {error.strerror}.", param, ctx)
        others: dict[Path, object] = {} if ctx is None else ctx.meta.setdefault(WRITTEN, {})
        if others.setdefault(path, param) is not param and (value == "-" or not path.exists() or path.is_file()):
            self.fail(f"{value}: another option writes there too.", param, ctx)
        if value == "-":
            return path
        if path.is_dir():
            self.fail(f"{value}: it is a folder.", param, ctx)
        if not path.parent.is_dir():
            self.fail(f"{value}: there is no folder {path.parent}.", param, ctx)
        if not os.access(path if path.exists() and not path.is_file() else path.parent, os.W_OK):
            self.fail(f"{value}: it may not be written.", param, ctx)
        return Path(value)


def read_bytes(name: str, *, layouts: bool = False, map: bool = False) -> bytes:
    """Read a file, or standard input for `-`, without the byte order mark that some systems put before UTF-8.

    A layout or a map is refused by its name, unless one is expected.
    """
    try:
        data = sys.stdin.buffer.read() if name == STANDARD_INPUT else Path(name).read_bytes()
    except OSError as error:
        raise click.ClickException(f"{name}: it cannot be read: {error.strerror}") from error
    if not layouts and (layout := layout_named(data)) is not None and not (map and layout == MAP):
        advice = "carproof convert makes instances of layouts and maps."
        raise click.ClickException(f"{shown(name)}: this is {layout}, not an instance; {advice}")
    return data.removeprefix(BYTE_ORDER_MARK)


def read_instance_file(name: str) -> Instance:
    """Read an instance from a file or standard input."""
    return read_file(name, read_instance)


def read_solution_file(name: str) -> Solution:
    """Read a solution from a file or standard input."""
    return read_file(name, read_solution)


def read_file(name: str, decode: Callable[[bytes], T]) -> T:
    """Read a document from a file or standard input."""
    data = read_bytes(name)
    with naming(name):
        return decode(data)


def read_sound(instance: str, solution: str) -> tuple[Instance, Solution]:
    """Read an instance and a solution that breaks no rule."""
    problem, given = read_instance_file(instance), read_solution_file(solution)
    with naming(solution):
        return problem, sound_solution(problem, given)


@contextmanager
def naming(name: str) -> Iterator[None]:
    """Put the file's name before every refusal of its content, but not before that of an option."""
    try:
        yield
    except Refusal as refusal:
        if refusal.kind == "option":
            raise
        raise click.ClickException(f"{shown(name)}: {refusal}") from refusal


@contextmanager
def naming_documents(instance: str, solution: str) -> Iterator[None]:
    """Put the file's name before a planner's refusal of an instance or a solution, but not before one of an option."""
    try:
        yield
    except Refusal as refusal:
        document = document_of(refusal)
        if document is None:
            raise
        with naming(instance if document == "instance" else solution):
            raise


def shown(name: str) -> str:
    """The name of an input for people."""
    return "standard input" if name == STANDARD_INPUT else name


def write_whole(path: Path, data: bytes) -> None:
    """Write a file whole or not at all: beside it, then in its place. A device or pipe is written as it is."""
    if path == STANDARD_OUTPUT:
        print_document(data)
        return
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            _replace(Path(os.path.realpath(path)), data)
    except OSError as error:
        raise click.ClickException(f"{path}: it cannot be written: {error.strerror}") from error


def _replace(path: Path, data: bytes) -> None:
    part = path.with_name(f".carproof-{secrets.token_hex(8)}")
    try:
        with part.open("xb") as file:
            file.write(data)
        if path.exists():
            part.chmod(path.stat().st_mode)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


@dataclass(frozen=True, slots=True)
class Output:
    """Where the document of a command goes: to a file, if one is given, and to standard output, if it is asked for."""

    file: Path | None
    as_json: bool

    def write(self, document: bytes) -> bool:
        """Write the document; returns whether people are to get text as well."""
        if self.file is not None:
            write_whole(self.file, document)
        if self.as_json:
            print_document(document)
        return not self.as_json


def print_document(data: bytes) -> None:
    """Print one document on standard output."""
    sys.stdout.flush()
    sys.stdout.buffer.write(data)
    sys.stdout.buffer.flush()
