"""The folder of a program's findings: written in place of those of an earlier run, and read again by the next one."""

import os
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
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
    """The cases to ask again with the folders that have them; where one could not be read, one sentence about that."""

    cases: tuple[Case, ...] = ()
    folders: tuple[str, ...] = ()
    stale: str | None = None

    def not_asked(self, asked: Iterable[Outcome]) -> frozenset[str]:
        """The folders of the cases that are not among these outcomes, or could not be asked."""
        done = [replace(each.case, classical=False) for each in asked if each.asked and each.case.stage == "saved"]
        return frozenset(name for name, case in zip(self.folders, self.cases, strict=True) if case not in done)


def own_folder(base: Path, program: str, judged: str) -> Path:
    """The folder of the one who is judged, in a folder for the findings of all: no one's findings replace another's.

    `program` names it; where another one with that name has findings there, a number follows.
    """
    name = "".join(c if c.isalnum() or c in "._-" else "-" for c in program).strip(".-")[:MOST_LETTERS] or "program"
    folders = (base / (name if number == 1 else f"{name}-{number}") for number in count(1))
    return next(folder for folder in folders if (run := _run(folder)) is None or run.judged == judged)


def _run(folder: Path) -> SavedRun | None:
    """The run whose findings a folder holds; `None` if it holds none that can be read."""
    try:
        return msgspec.json.decode(plain_file(folder / RUN, LARGEST), type=SavedRun)
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
    return Saved(tuple(replace(case, planner=None) for case in cases) if whole else cases, tuple(run.cases))


def _read_case(folder: Path, name: str) -> Case:
    """A saved case; raises `OSError`, `ValueError` or `Refusal` if it cannot be read."""
    (vector,) = msgspec.json.decode(plain_file(folder / "vector.json", LARGEST), type=VectorsDocument).cases
    if vector.op not in (*ASKED_OPS, EXECUTION):
        raise ValueError(vector.op)
    return replace(case_of(vector), stage="saved", name=name)


def save_all(
    failures: Sequence[Outcome], folder: Path, origin: Origin, kept: AbstractSet[str] = frozenset()
) -> list[Path]:
    """Write the smallest failure into a folder, and each other one into a folder in it; return their folders.

    They take the place of earlier findings, but for those whose folders are `kept`.
    """
    before = _run(folder)
    cases = {} if before is None else {name: case for name, case in before.cases.items() if name in kept}
    clear(folder, kept)
    names: list[str] = []
    for number, outcome in enumerate(failures, start=1):
        names.append(next(name for name in _names(number, outcome) if name not in cases))
        cases[names[-1]] = outcome.case.name
        save(outcome, folder / names[-1], origin)
    if cases:
        run = SavedRun("carproof-findings/1", origin.judged, cases)
        write_whole(folder / RUN, msgspec.json.format(msgspec.json.encode(run)) + b"\n")
    return [folder / name for name in names]


def _names(number: int, outcome: Outcome) -> Iterator[str]:
    """The names that the folder of a finding may have, in order."""
    if number == 1:
        yield "."
    yield from (f"{other}-{outcome.fault.rule.replace('/', '-')}" for other in count(max(number, 2)))


def clear(folder: Path, kept: AbstractSet[str] = frozenset()) -> None:
    """Remove the files of an earlier run, and no others; folders that are `kept` stay."""
    (folder / RUN).unlink(missing_ok=True)
    for finding in [*folder.glob("*/finding.txt"), *folder.glob("finding.txt")]:
        if str(finding.parent.relative_to(folder)) in kept:
            continue
        for name in FILES:
            (finding.parent / name).unlink(missing_ok=True)
        with suppress(OSError):  # it holds something else
            finding.parent.rmdir()
