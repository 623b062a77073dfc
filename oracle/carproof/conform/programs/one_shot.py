"""A program that plans whole instances: started for each case, with a file for the instance and one for its answer."""

import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import BinaryIO

from carp_spec import Instance, Refusal, Robot, Solution
from carp_spec.documents.instances import write_instance
from carproof.conform.answers import Reply, Skipped, Subject, decode_solution, protocol_error, shown
from carproof.conform.cases import Case
from carproof.conform.findings import IN_TIME, RIGHT_RESULT, Category, Fault, Finding, is_alive
from carproof.conform.programs.child import Limits, end_group, ending, environment, exit_code, limited, plain_file
from carproof.formats import carproof_documents, format_of, looks_like_none, read_foreign_solution
from carproof.formats.movingai import GridMap, movingai_instance
from carproof.formats.movingai_writer import MAP_NAME, is_classical, write_movingai

SHELL = 128
"""A shell whose command was killed by a signal ends with its number and this."""
INSTANCE, MAP, SCEN, AGENTS, SOLUTION = "{instance}", "{map}", "{scen}", "{agents}", "{solution}"
PROBE = movingai_instance(GridMap(3, 2, ("...", "...")), [Robot("r1", "2,0", "0,1")], "park")
"""An instance whose right answer fits only one format: only in one order of coordinates is the robot's start a cell."""
KEPT_STDERR = 8 * 2**10


def _folder() -> TemporaryDirectory[str]:
    """A folder for a program's files. The program may have changed it so that it cannot be removed."""
    return TemporaryDirectory(prefix="carproof-", ignore_cleanup_errors=True)


def names(template: Sequence[str], placeholder: str) -> bool:
    """Whether the placeholder is in a template of a command line."""
    return any(placeholder in part for part in template)


class OneShot(Subject):
    """A program with a template of its command line.

    `{instance}` stands for the file that it reads, or `{map}` and `{scen}` for MovingAI files and `{agents}` for the
    number of their agents. `{solution}` stands for the file that it writes; without it, the standard output is the
    answer. A program that leaves robots unplanned may end with 1.

    A program that reads MovingAI files, or writes another format than carproof's, is classical: it is asked only what
    these formats can express. The format of its answer is recognised if it is not given, and empty output means that no
    robot was planned.
    """

    def __init__(self, template: Sequence[str], limits: Limits, format: str | None = None) -> None:
        self._template = template
        self._limits = limits
        self._format = format
        is_foreign = format not in (None, carproof_documents.ADAPTER.name)
        self.is_classical = is_foreign or names(template, MAP) or names(template, SCEN)
        self.name = template[0]
        self.ops = ("plan",)

    def start(self) -> None:
        """Recognise the format that the program writes; raises `Refusal` if it must be named."""
        if self.is_classical and self._format is None:
            with suppress(Fault), _folder() as folder, TemporaryFile() as errors:
                self._format = self._format_of(self._written(PROBE, Path(folder), errors, self._limits.seconds))

    def _format_of(self, written: bytes) -> str | None:
        """The format of the probe's answer; `None` if it fits none, which the cases will show."""
        try:
            return format_of(written, PROBE, "its output")
        except Refusal:
            if looks_like_none(written):
                return None
            raise

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Run the program on the case's instance."""
        if self.is_classical and not is_classical(case.instance):
            return Skipped("it plans classical grids", asked=False)
        with _folder() as folder, TemporaryFile() as errors, self._explained(errors):
            written = self._written(case.instance, Path(folder), errors, seconds or self._limits.seconds)
            return self._read(written, case.instance) if written else Solution((), (), tuple(case.instance.robot))

    @contextmanager
    def _explained(self, errors: BinaryIO) -> Iterator[None]:
        """A fault has the end of standard error."""
        try:
            yield
        except Fault as fault:
            ending_of_errors = self._beginning(errors)[-KEPT_STDERR:].decode("utf-8", "backslashreplace")
            raise Fault(replace(fault.finding, stderr=ending_of_errors)) from fault

    def _written(self, instance: Instance, folder: Path, errors: BinaryIO, seconds: float) -> bytes:
        """Run the program on an instance, and return its answer; only a classical one may be empty."""
        solution = folder / "solution"
        command = self._command(instance, folder, solution)
        with TemporaryFile() as output:
            code = self._wait(command, output.fileno(), errors.fileno(), seconds)
            printed = self._beginning(output)
        if code is None:
            message = f"no answer within {self._limits.shown(seconds)}"
            raise Fault(Finding(Category.TIMEOUT, IN_TIME.id, message))
        written = self._solution(solution) if names(self._template, SOLUTION) else printed
        if code in (-signal.SIGXFSZ, SHELL + signal.SIGXFSZ):
            message = f"it wrote a file, or output, of more than {self._limits.output} bytes, which is the most it may"
            raise protocol_error(RIGHT_RESULT.id, message)
        if code not in (0, 1) or (code == 1 and not written):
            raise Fault(Finding(Category.CRASH, is_alive.id, ending(code)))
        if not (written or self.is_classical) or len(written) > self._limits.output:
            much = "nothing" if not written else f"more than {self._limits.output} bytes"
            raise protocol_error(RIGHT_RESULT.id, f"it wrote {much} as its answer")
        return written

    def _command(self, instance: Instance, folder: Path, solution: Path) -> list[str]:
        """Write the files that the program reads, and put all files' names into the template."""
        files = {INSTANCE: folder / "instance.json", MAP: folder / MAP_NAME, SCEN: folder / "instance.scen"}
        files[INSTANCE].write_bytes(write_instance(instance))
        if self.is_classical:
            benchmark = write_movingai(instance)
            files[MAP].write_bytes(benchmark.map)
            files[SCEN].write_bytes(benchmark.scen)
        filled = {**files, SOLUTION: solution, AGENTS: len(instance.robots)}
        command = list(self._template)
        for placeholder, value in filled.items():
            command = [part.replace(placeholder, str(value)) for part in command]
        return command

    def _read(self, written: bytes, instance: Instance) -> Solution:
        if not self.is_classical:
            return decode_solution(written)
        try:
            return read_foreign_solution(written, instance, "solution", self._format)
        except Refusal as refusal:
            message = f"the solution is not as it must be, at {refusal}; it is {shown(written)}"
            raise protocol_error(RIGHT_RESULT.id, message) from refusal

    def _wait(self, command: Sequence[str], stdout: int, stderr: int, seconds: float) -> int | None:
        """Run the command, and return its exit code, or `None` if it took too long."""
        blocks = self._limits.output // 512 + 1
        bounded = ("/bin/sh", "-c", 'ulimit -f "$0" && exec "$@"', str(blocks), *limited(command, self._limits))
        process = subprocess.Popen(  # noqa: S603 - to run the user's command is the task
            bounded,
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
            env=environment(),
            start_new_session=True,
        )
        try:
            return exit_code(process, seconds)
        finally:
            end_group(process)

    def _beginning(self, file: BinaryIO) -> bytes:
        """As much of a file as an answer may have, and a byte."""
        file.seek(0)
        return file.read(self._limits.output + 1)

    def _solution(self, solution: Path) -> bytes:
        """The file that the program wrote; nothing if it wrote none."""
        try:
            return plain_file(solution, self._limits.output)
        except FileNotFoundError:
            return b""
        except OSError as error:
            message = f"its answer must be a plain file that can be read: {error.strerror}"
            raise protocol_error(RIGHT_RESULT.id, message) from error
