"""Mutants run in processes forked from one that has loaded everything, which saves starting it for each of them.

`planner.py`, `checkers.py` and `specified.py` have the checks. The check that noticed the last mutant is the first that
the next one has to pass.
"""

import os
import resource
import signal
import struct
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from mmap import mmap
from pathlib import Path
from types import ModuleType

from tests.mutation.mutants import Mutant

ROOT = Path(__file__).parents[2]
BYTES = 4 << 30


@dataclass(frozen=True, slots=True)
class Case:
    """A check, which fails by an exception, or takes longer than some seconds of the processor; it may count work.

    One that is a `pin` comes last: it notices every change, right or wrong, and so shows what the others do not notice.
    """

    run: Callable[[], int]
    seconds: float
    is_pin: bool = False


@dataclass(slots=True)
class Score:
    """How many mutants a module has, how many were noticed, and of these only by a pin, or by taking too long."""

    mutants: int = 0
    noticed: int = 0
    pinned: int = 0
    too_long: int = 0


@dataclass(frozen=True, slots=True)
class Outcome:
    """The exit status of a process, 0 if it passes all cases, the case that it came to, and the work counted."""

    status: int
    case: Case
    work: int


class Changed(MetaPathFinder, Loader):
    """Loads a module from another source than its file."""

    def __init__(self, name: str, path: Path, source: str) -> None:
        self.name, self.path, self.source = name, path, source

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        del path, target
        return spec_from_loader(name, self) if name == self.name else None

    def exec_module(self, module: ModuleType) -> None:
        module.__file__ = str(self.path)
        exec(compile(self.source, module.__file__, "exec"), module.__dict__)  # noqa: S102 - a mutant is to be run


def run_mutants(
    name: str,
    mutants: Iterator[Mutant],
    lines: Sequence[int],
    cases: list[Case],
    load: Callable[[Mutant], None],
    usual: int,
) -> Score:
    """Print the mutants of a module, or of some lines, that no case notices, with the work beyond the usual."""
    score = Score()
    for mutant in (each for each in mutants if not lines or each.line in lines):
        score.mutants += 1
        found = outcome(lambda mutant=mutant: load(mutant), cases)  # type: ignore[misc]
        is_pinned = found.status != 0 and found.case.is_pin
        score.noticed += found.status != 0
        score.pinned += is_pinned
        score.too_long += os.WIFSIGNALED(found.status)
        if found.status == 0 or is_pinned:
            more = "" if is_pinned or found.work == usual else f"  ({found.work - usual:+} queries)"
            only = "  (only by a pin)" if is_pinned else ""
            print(f"{name}:{mutant.line}  {mutant.change}{more}{only}", flush=True)  # noqa: T201 - a report
    ways = f"{score.pinned} of them only by a pin, {score.too_long} by the time they take"
    print(f"{name}: {score.mutants} mutants, {score.noticed} noticed, {ways}", flush=True)  # noqa: T201
    return score


def outcome(load: Callable[[], None], cases: list[Case]) -> Outcome:
    """The result of a process that loads the cases and runs them; one that fails, and is no pin, goes to the front."""
    place = mmap(-1, 1 << 12)
    child = os.fork()
    if child:
        status = os.waitpid(child, 0)[1]
        number, work = struct.unpack_from("qq", place)
        place.close()
        reached = cases[number]
        if status and not reached.is_pin:
            cases.insert(0, cases.pop(number))
        return Outcome(status, reached, work)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
        sys.stderr = sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - until the end
        load()
        work = 0
        for number, case in enumerate(cases):
            struct.pack_into("qq", place, 0, number, work)
            signal.setitimer(signal.ITIMER_PROF, case.seconds)
            work += case.run()
        struct.pack_into("qq", place, 0, 0, work)
        os._exit(0)
    finally:
        os._exit(1)


def chosen(arguments: Sequence[str], known: Sequence[str]) -> Mapping[str, Sequence[int]]:
    """The modules that are named, alone or by their package, with the lines behind each, `module:89:91`; or all."""
    found: dict[str, Sequence[int]] = {}
    for name, *lines in (each.split(":") for each in arguments):
        within = [each for each in known if f"{each}.".startswith(f"{name}.")]
        if not within:
            sys.exit(f"no such module: {name}")
        found |= {each: [int(line) for line in lines] for each in within}
    return found or {name: [] for name in known}
