"""Ends a command, with all processes that it started, within a second of SIGINT or SIGTERM.

A solver or compiled code may ignore signals for many seconds. So the command runs in a child process, which may clean
up when it is interrupted and is killed if that takes too long. The exit code is that of the parent.
"""

import atexit
import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import NoReturn

from carproof.command_line.answer import INTERNAL_ERROR

GRACE = 0.6
"""Seconds in which an interrupted command may clean up."""
INTERRUPTIONS = (signal.SIGINT, signal.SIGTERM)
_DEATH_SIGNAL, _SUBREAPER = 1, 36  # of Linux's prctl
_SHOW_CURSOR = "\x1b[?25h"


def supervised(command: Callable[[], int]) -> int:
    """Run a command in a child process, and return its exit code, or 130 or 143 if it was interrupted.

    The parent handles no signal: it waits for them, so that none can come between a look and a wait.
    """
    heeded = {number for number in INTERRUPTIONS if signal.getsignal(number) != signal.SIG_IGN}
    awaited = {*heeded, signal.SIGCHLD, signal.SIGALRM}
    signal.signal(signal.SIGCHLD, lambda *_: None)  # a system may drop a signal that is ignored, blocked or not
    signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    _control(_SUBREAPER, 1)
    child = os.fork()
    if child == 0:
        _control(_DEATH_SIGNAL, signal.SIGKILL)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for number in heeded:
            signal.signal(number, stop_once)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, awaited)
        _end(command())
    status, interruption = _watched(child, awaited)
    _kill_orphans()
    return _exit_code(status, interruption)


def _end(code: int) -> NoReturn:
    """End this process, but free nothing: millions of visits take a quarter of a second, and the system is quicker."""
    atexit._run_exitfuncs()  # noqa: SLF001 - the only way to run them
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, OSError, ValueError):  # it is closed
            stream.flush()
    os._exit(code)


def _watched(child: int, awaited: set[signal.Signals]) -> tuple[int, int | None]:
    """The status with which the child ended, and the first interruption, which was passed on; `None`: there was none.

    A child that has not ended `GRACE` seconds after it is killed.
    """
    interruption: int | None = None
    while True:
        number = signal.sigwait(awaited)
        if number == signal.SIGCHLD:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                signal.setitimer(signal.ITIMER_REAL, 0)
                return status, interruption
        elif number == signal.SIGALRM:
            _send(child, signal.SIGKILL)
        elif interruption is None:
            interruption = number
            _send(child, number)
            signal.setitimer(signal.ITIMER_REAL, GRACE)


def stop_once(_: int, __: FrameType | None) -> None:
    """Raise `KeyboardInterrupt`; nothing may interrupt the cleaning up, or print beside the parent's message."""
    for number in INTERRUPTIONS:
        signal.signal(number, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    raise KeyboardInterrupt


def _exit_code(status: int, interruption: int | None) -> int:
    if interruption is not None:
        _tell((_SHOW_CURSOR if sys.stderr.isatty() else "") + "Interrupted.\n")
        return 128 + interruption
    code = os.waitstatus_to_exitcode(status)
    if code >= 0:
        return code
    _tell(f"carproof was ended by {signal.Signals(-code).name}; if nobody sent it, memory has run out.\n")
    return INTERNAL_ERROR


def _tell(text: str) -> None:
    with suppress(OSError):
        os.write(2, text.encode())


def _send(child: int, number: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(child, number)


def _kill_orphans() -> None:
    """End the processes that the command left behind, which this process has adopted."""
    with suppress(OSError):
        while children := Path(f"/proc/self/task/{os.getpid()}/children").read_text().split():
            for child in children:
                _send(int(child), signal.SIGKILL)
            os.waitpid(-1, 0)


def _control(option: int, value: int) -> None:
    """Linux's prctl; elsewhere nothing."""
    if sys.platform == "linux":
        from ctypes import CDLL  # noqa: PLC0415 - loaded only where it is used

        CDLL(None).prctl(option, value)
