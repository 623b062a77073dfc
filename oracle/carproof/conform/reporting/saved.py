"""The folder of a program's findings: written in place of those of an earlier run, and read again by the next one."""

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Literal

import msgspec

from carp_spec import Refusal
from carp_spec.documents.vectors import VectorsDocument
from carproof.command_line.files import write_whole
from carproof.conform.asking.vector_cases import case_of
from carproof.conform.cases import ASKED_OPS, EXECUTION, Case
from carproof.conform.judging.outcome import Outcome
from carproof.conform.programs.child import plain_file
from carproof.conform.reporting.saving import FILES, Origin, save

RUN = "run.json"
LARGEST = 2**28
"""Bytes of a file that is read again."""
MOST_LETTERS = 60


class SavedRun(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Who was judged, by which level, and the names of the saved cases by their folders."""

    format: Literal["carproof-findings/1"]
    judged: str
    cases: dict[str, str]


@dataclass(frozen=True, slots=True)
class Saved:
    """The cases to ask again, and, where a folder could not be read, one sentence about that."""

    cases: tuple[Case, ...] = ()
    stale: str | None = None


def own_folder(base: Path, program: str, judged: str) -> Path:
    """The folder of the one who is judged, in a folder for the findings of all: no one's findings replace another's.

    `program` names it; where another one with that name has findings there, a number follows.
    """
    name = "".join(c if c.isalnum() or c in "._-" else "-" for c in program).strip(".-")[:MOST_LETTERS] or "program"
    folders = (base / (name if number == 1 else f"{name}-{number}") for number in count(1))
    return next(folder for folder in folders if _judged(folder) in (None, judged))


def _judged(folder: Path) -> str | None:
    """Whose findings a folder holds; `None` if it holds none that can be read."""
    try:
        return msgspec.json.decode(plain_file(folder / RUN, LARGEST), type=SavedRun).judged
    except (OSError, ValueError):
        return None


def read_saved(folder: Path, whole: bool) -> Saved:
    """The saved cases of a folder; those that cannot be read are cleared.

    `whole`: planners of whole instances are asked, who choose the planner themselves.
    """
    if not os.path.lexists(folder / RUN):
        clear(folder)
        return Saved()
    try:
        run = msgspec.json.decode(plain_file(folder / RUN, LARGEST), type=SavedRun)
        cases = tuple(_read_case(folder / name, case) for name, case in run.cases.items())
    except (OSError, ValueError, Refusal):
        clear(folder)
        return Saved(stale=f"{folder} holds findings that cannot be read: they are cleared.")
    return Saved(tuple(replace(case, planner=None) for case in cases) if whole else cases)


def _read_case(folder: Path, name: str) -> Case:
    """A saved case; raises `OSError`, `ValueError` or `Refusal` if it cannot be read."""
    (vector,) = msgspec.json.decode(plain_file(folder / "vector.json", LARGEST), type=VectorsDocument).cases
    if vector.op not in (*ASKED_OPS, EXECUTION):
        raise ValueError(vector.op)
    return replace(case_of(vector), stage="saved", name=name)


def save_all(failures: Sequence[Outcome], folder: Path, origin: Origin) -> list[Path]:
    """Write the smallest failure into a folder, and each other one into a folder in it; return their folders.

    They take the place of earlier findings.
    """
    clear(folder)
    names = [_name(number, outcome) for number, outcome in enumerate(failures, start=1)]
    for name, outcome in zip(names, failures, strict=True):
        save(outcome, folder / name, origin)
    if failures:
        cases = {name: outcome.case.name for name, outcome in zip(names, failures, strict=True)}
        run = SavedRun("carproof-findings/1", origin.judged, cases)
        write_whole(folder / RUN, msgspec.json.format(msgspec.json.encode(run)) + b"\n")
    return [folder / name for name in names]


def _name(number: int, outcome: Outcome) -> str:
    return "." if number == 1 else f"{number}-{outcome.fault.rule.replace('/', '-')}"


def clear(folder: Path) -> None:
    """Remove the files of an earlier run, and no others."""
    (folder / RUN).unlink(missing_ok=True)
    for finding in [*folder.glob("*/finding.txt"), *folder.glob("finding.txt")]:
        for name in FILES:
            (finding.parent / name).unlink(missing_ok=True)
        with suppress(OSError):  # it holds something else
            finding.parent.rmdir()
