"""A process with limits: it gets one line at a time, and cannot hang or flood its parent."""

import errno
import os
import selectors
import signal
import stat
import subprocess
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep
from typing import IO, cast

from carproof.conform.findings import IN_TIME, Category, Fault, Finding, is_alive, is_response

_PIECE = 2**16
KEPT_STDERR = 8 * 2**10
_HIDDEN = ("PYTEST_", "HYPOTHESIS_", "CARPROOF_")
_LAST_SECONDS = 0.5
_NAP = 0.005
_LIMITED = 'ulimit -c 0 && { [ "$0" = 0 ] || ulimit -v "$0"; } && exec "$@"'


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of a process: seconds for an answer, MiB of address space (0: any), bytes of an answer."""

    seconds: float = 10.0
    memory: int = 4096
    output: int = 16 * 2**20

    def shown(self, seconds: float) -> str:
        """The seconds that something may take, and how they come from those for an answer."""
        share = (
            "" if seconds <= self.seconds else f", {seconds / self.seconds:g} times the {self.seconds:g} s of an answer"
        )
        return f"{seconds:g} s{share}"


def environment() -> Mapping[str, str]:
    """The environment of a process; it does not reveal which case is asked."""
    return {name: value for name, value in os.environ.items() if not name.startswith(_HIDDEN)}


def limited(command: Sequence[str], limits: Limits) -> Sequence[str]:
    """The command under its limits of memory, without core dumps."""
    return ("/bin/sh", "-c", _LIMITED, str(limits.memory * 1024), *command)


def end_group(process: subprocess.Popen[bytes]) -> None:
    """Kill the process and all that it started, and wait for it; its pid is its group as long as nobody waited."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    for pipe in (process.stdin, process.stdout, process.stderr):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()


def exit_code(process: subprocess.Popen[bytes], seconds: float) -> int | None:
    """The exit code as soon as there is one; the process is not reaped, so that its group can still be killed."""
    deadline = monotonic() + seconds
    while (seen := os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)) is None:
        if monotonic() > deadline:
            return None
        sleep(_NAP)
    return seen.si_status if seen.si_code == os.CLD_EXITED else -seen.si_status


def plain_file(path: Path, most: int) -> bytes:
    """As much of a plain file, and a byte; raises `OSError` for a link, a folder, a pipe or a device."""
    opened = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    with os.fdopen(opened, "rb") as file:
        if not stat.S_ISREG(os.fstat(opened).st_mode):
            raise OSError(errno.EINVAL, "it is no plain file", str(path))
        return file.read(most + 1)


def ending(code: int) -> str:
    """How a process ended, in words."""
    if code >= 0:
        return f"it ended with exit code {code}"
    try:
        return f"it was killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"it was killed by signal {-code}"


class Child:
    """A process that stays up until `kill`."""

    def __init__(self, command: Sequence[str], limits: Limits) -> None:
        self._limits = limits
        self._process = subprocess.Popen(  # noqa: S603 - to run the user's command is the task
            limited(command, limits),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment(),
            start_new_session=True,
            bufsize=0,
        )
        self._stdin = cast("IO[bytes]", self._process.stdin)
        self._stdout = cast("IO[bytes]", self._process.stdout)
        self._stderr = cast("IO[bytes]", self._process.stderr)
        for pipe in (self._stdin, self._stdout, self._stderr):
            os.set_blocking(pipe.fileno(), False)
        self._output = bytearray()
        self._errors = bytearray()

    def kill(self) -> None:
        """End the process and all that it started."""
        end_group(self._process)

    @property
    def stderr(self) -> str:
        """The end of what the process wrote on standard error."""
        return self._errors.decode("utf-8", "backslashreplace")

    def ask(self, line: bytes, seconds: float) -> bytes:
        """Send a line and return the line that comes back; raises `Fault` if none does within the seconds."""
        if self._output:
            message = "the program wrote more than one line for a request"
            raise self._fault(Category.PROTOCOL_ERROR, is_response.id, message)
        deadline = monotonic() + seconds
        with selectors.DefaultSelector() as selector:
            selector.register(self._stdin, selectors.EVENT_WRITE)
            selector.register(self._stdout, selectors.EVENT_READ)
            if not self._stderr.closed:
                selector.register(self._stderr, selectors.EVENT_READ)
            return self._exchange(selector, line, deadline, seconds)

    def _exchange(self, selector: selectors.BaseSelector, line: bytes, deadline: float, seconds: float) -> bytes:
        unsent = memoryview(line)
        while True:
            remaining = deadline - monotonic()
            if remaining <= 0 and exit_code(self._process, 0) is not None:
                raise self._death()
            if remaining <= 0:
                message = f"no complete answer within {self._limits.shown(seconds)}"
                raise self._fault(Category.TIMEOUT, IN_TIME.id, message)
            for key, _ in selector.select(remaining):
                if key.fileobj is self._stdin:
                    unsent = self._send(selector, unsent)
                elif key.fileobj is self._stderr:
                    self._keep_errors(selector)
                elif (answer := self._receive()) is not None:
                    return answer

    def _send(self, selector: selectors.BaseSelector, unsent: memoryview) -> memoryview:
        try:
            unsent = unsent[os.write(self._stdin.fileno(), unsent[:_PIECE]) :]
        except BlockingIOError:
            return unsent
        except OSError:
            unsent = unsent[:0]
        if not unsent:
            selector.unregister(self._stdin)
        return unsent

    def _receive(self) -> bytes | None:
        """The line, if it is complete now."""
        piece = os.read(self._stdout.fileno(), _PIECE)
        if not piece:
            raise self._death()
        end = piece.find(b"\n")
        self._output += piece
        if end < 0:
            if len(self._output) > self._limits.output:
                message = f"an answer of more than {self._limits.output} bytes without an end of line"
                raise self._fault(Category.PROTOCOL_ERROR, is_response.id, message)
            return None
        end += len(self._output) - len(piece)
        answer = bytes(self._output[:end])
        del self._output[: end + 1]
        return answer

    def _keep_errors(self, selector: selectors.BaseSelector | None) -> bool:
        """Read from standard error, and return whether more may come."""
        try:
            piece = os.read(self._stderr.fileno(), _PIECE)
        except BlockingIOError:
            return False
        self._errors += piece
        del self._errors[:-KEPT_STDERR]
        if not piece and selector is not None:
            selector.unregister(self._stderr)
            self._stderr.close()
        return bool(piece)

    def end(self, seconds: float) -> None:
        """Wait for the process to end by itself; raises `Fault` if it does not, or not with 0."""
        self._stdin.close()
        deadline = monotonic() + seconds
        while (code := exit_code(self._process, _NAP)) is None and monotonic() < deadline:
            self._keep_all_errors()
        if code is None:
            message = f"it runs on, {seconds:g} s after it was asked to stop"
            raise self._fault(Category.TIMEOUT, IN_TIME.id, message)
        if not is_alive(code):
            raise self._fault(Category.CRASH, is_alive.id, f"{ending(code)} when it was asked to stop")

    def _death(self) -> Fault:
        """The reason why there is no more output."""
        code = exit_code(self._process, _LAST_SECONDS)
        how = "it closed its output" if code is None else ending(code)
        cut = f", after {len(self._output)} bytes of an answer" if self._output else ""
        return self._fault(Category.CRASH, is_alive.id, f"{how} before it answered{cut}")

    def _keep_all_errors(self) -> None:
        """Read what there is on standard error."""
        reads = 0 if self._stderr.closed else KEPT_STDERR
        while reads and self._keep_errors(None):
            reads -= 1

    def _fault(self, category: Category, rule: str, message: str) -> Fault:
        self._keep_all_errors()
        return Fault(Finding(category, rule, message, self.stderr))
