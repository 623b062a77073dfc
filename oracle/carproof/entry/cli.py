"""The command `carproof`: loads the named command and turns its result into an exit code."""

import gc
import io
import os
import re
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from errno import EBADF
from time import perf_counter

import click
from click.shell_completion import shell_complete

from carp_spec import Refusal
from carp_verify.bound.rules import ContradictionError
from carp_verify.kernel import UndecidedError
from carproof.command_line.answer import INTERNAL_ERROR, INTERRUPTED, PIPE_CLOSED, Answer
from carproof.command_line.lazy import LazyGroup
from carproof.command_line.tables import printable, remark
from carproof.commands import RENAMED, SECTIONS
from carproof.entry.supervising import supervised
from carproof.extras import advice

ALLOCATIONS = 50_000
"""After how many objects a process of our own looks for garbage: documents are many objects, and hold no cycles."""
COMPLETION = "_CARPROOF_COMPLETE"
SETTINGS = {"help_option_names": ["-h", "--help"], "show_default": True}
EPILOG = """\b
Examples:
  carproof generate grid -o town.json             20 x 20 grid, 100 robots
  carproof plan town.json -o plans.json           plan them
  carproof check town.json plans.json             judge the plans
  carproof rules joint/capacity                   explain a rule
  carproof plan town.json --json | carproof check town.json -

\b
Exit codes: 0 yes, 1 no (a broken rule; of commands that plan, and of
check --require-all, a robot without a plan), 2 bad input or usage,
3 undecided within the limit given.
"""

ARGUMENTS = {"$.robot": "ROBOT", "$.stops": "STOP", "$.format": "--from"}
"""The arguments and options of commands that stand for fields of other names."""


@click.group(
    cls=LazyGroup,
    sections=SECTIONS,
    added="carproof.commands",
    renamed=RENAMED,
    epilog=EPILOG,
    context_settings=SETTINGS,
)
@click.version_option(package_name="carproof", message="carproof %(version)s")
def carproof() -> None:
    """Plan robots in an automated warehouse, and judge any planner's plans by stable rules."""


def main(arguments: Sequence[str] | None = None, began: float | None = None) -> int:
    """Run one command line, by default that of this process, which began then, and return its exit code."""
    began = perf_counter() if began is None else began
    _open_closed_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    if arguments is not None:
        return _run(arguments, began)
    gc.set_threshold(ALLOCATIONS)
    return supervised(lambda: _run(sys.argv[1:], began))


def _run(arguments: Sequence[str], began: float) -> int:
    try:
        if COMPLETION in os.environ:
            answer: int = shell_complete(carproof, {}, "carproof", COMPLETION, os.environ[COMPLETION])
        else:
            answer = _answer(arguments, began)
        sys.stdout.flush()
    except BrokenPipeError:
        _forget_output()
        return PIPE_CLOSED
    except KeyboardInterrupt:
        return _tell("Interrupted.", INTERRUPTED)
    except OSError as error:
        _forget_output()
        reason = "standard output is closed" if error.errno == EBADF else error.strerror
        return _complain(f"the output cannot be written: {reason}")
    except ContradictionError as error:
        report = "A checker of carproof is wrong; please report both."
        return _tell(f"Internal contradiction: {error}. {report}", INTERNAL_ERROR)
    except Exception:  # noqa: BLE001 - a fault of ours must not look like the answer no
        text = f"{traceback.format_exc()}carproof failed by a fault of its own; the lines above say where."
        return _tell(text, INTERNAL_ERROR)
    return answer


def _answer(arguments: Sequence[str], began: float) -> int:
    try:
        with carproof.make_context("carproof", list(arguments), obj=began) as context, _naming_extras(context):
            answer = carproof.invoke(context)
    except click.exceptions.Exit as done:
        return done.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message())
        return Answer.YES
    except click.ClickException as error:
        return _complain(_sentence(error))
    except (UndecidedError, MemoryError) as error:
        return _tell(f"Undecided: {printable(error) or 'the memory does not suffice.'}", Answer.UNDECIDED)
    except Refusal as refusal:
        return _complain(f"{_option(refusal.path)}: {refusal.message} [{refusal.rule}]")
    return Answer(answer)


@contextmanager
def _naming_extras(context: click.Context) -> Iterator[None]:
    """Name the extra that has a missing library."""
    try:
        yield
    except ModuleNotFoundError as error:
        advised = advice(error)
        if advised is None:
            raise
        raise click.ClickException(f"carproof {context.invoked_subcommand} {advised}") from error


def _option(path: str) -> str:
    """The command line's name of what Python and documents call `$.map_seed`, `$.robot` or `$.stops[0].resource`."""
    if path in ARGUMENTS:
        return ARGUMENTS[path]
    if stop := re.match(r"\$\.stops\[(\d+)\]", path):
        return f"STOP {int(stop[1]) + 1}"
    return "--" + path[2:].replace("_", "-") if path.startswith("$.") else path


def _sentence(error: click.ClickException) -> str:
    if not isinstance(error, click.UsageError):
        return error.format_message()
    asked = error.ctx.command_path if error.ctx else "carproof"
    return f"{error.format_message()} (See {asked} --help.)"


def _complain(sentence: str) -> int:
    return _tell(f"Error: {printable(sentence)}", Answer.BAD_INPUT)


def _tell(text: str, code: int) -> int:
    """Print why a command ends, and return its exit code."""
    remark(text)
    return code


def _open_closed_streams() -> None:
    """Give a process that was started without standard streams, as by `>&-`, an empty input, and an output that fails.

    Messages are lost without standard error, and nothing else.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_WRONLY if name == "stderr" else os.O_RDONLY)
            setattr(sys, name, open(nowhere, mode, encoding="utf-8"))  # noqa: PTH123, SIM115 - as long as the process


def _forget_output() -> None:
    """Discard buffered output, so that the interpreter's last flush finds an open file."""
    with open(os.devnull, "w", encoding="utf-8") as nowhere:  # noqa: PTH123 - a device, not a path
        os.dup2(nowhere.fileno(), sys.__stdout__.fileno() if sys.__stdout__ else 1)
