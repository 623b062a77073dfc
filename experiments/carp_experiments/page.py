"""The page of results in the documentation, from the stored runs in experiments/results.

`carproof experiment NAME --store FILE --report experiments/results` writes the results of a run there.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import msgspec

from carp_experiments.paper.claims import Claim, quality_claims, related_claims, reuse_claims, time_claims

T = TypeVar("T")
RESULTS = Path(__file__).parents[1] / "results"
CLAIMS = "claims"
"""The section of `meanings.md` about the claims of all runs."""


class Run(msgspec.Struct, frozen=True):
    """The facts about a run beside its summary."""

    experiment: str
    command: str
    size: str
    cases: int
    digest: str
    processor_seconds: int
    note: str
    summary: msgspec.Raw


def read_run(path: Path) -> Run:
    """A stored run."""
    return msgspec.json.decode(path.read_bytes(), type=Run)


def claims_of(run: Run) -> Iterable[Claim]:
    """The paper's claims that a run decides."""
    deciding: Mapping[str, Callable[[Any], Iterable[Claim]]] = {
        "quality": quality_claims,
        "time": time_claims,
        "reuse": reuse_claims,
        "related": related_claims,
    }
    return of_summary(deciding[run.experiment], run) if run.experiment in deciding else ()


def of_summary(function: Callable[[Any], T], run: Run) -> T:
    """What a function makes of the summary of a run, which it gets in the type that it asks for."""
    return function(msgspec.json.decode(run.summary, type=get_type_hints(function)["summary"]))


@cache
def meanings() -> Mapping[str, tuple[str, str]]:
    """The title of each section of `meanings.md` by its name, which is that of an experiment, and its text."""
    page = files("carp_experiments").joinpath("meanings.md").read_text(encoding="utf-8")
    parts = re.split(r"^## ([a-z-]+): (.*)\n", page, flags=re.MULTILINE)[1:]
    return {name: (title, text.strip()) for name, title, text in zip(parts[::3], parts[1::3], parts[2::3], strict=True)}


def results(stored: Path = RESULTS) -> str:
    """The claims, then each experiment with its run, tables and figures, of the runs stored in a folder."""
    runs = {name: read_run(path) for name in meanings() if (path := stored / f"{name}.json").exists()}
    claims = [claim for run in runs.values() for claim in claims_of(run)]
    lines = [
        f"| {claim.claim} | {with_reason(claim.verdict, claim.reason)} | "
        f"{with_reason(claim.with_baseline or '', claim.reason_with_baseline)} | {claim.found} |\n"
        for claim in claims
    ]
    head = "| the paper says | as published | with the baseline | we find |\n| --- | --- | --- | --- |\n"
    title, text = meanings()[CLAIMS]
    parts = [f"## {title}\n\n{head}{''.join(lines)}\n{text}\n"]
    parts += [section(name, run, stored) for name, run in runs.items()]
    return "\n".join(parts)


def with_reason(verdict: str, reason: str) -> str:
    """A verdict in bold, or with its reason behind it; fpdf prints no cell that is both."""
    return f"{verdict}: {reason}" if reason else f"**{verdict}**" if verdict else ""


def section(name: str, run: Run, stored: Path) -> str:
    """An experiment: the run, its tables, its figures."""
    made = f"`{run.command}`: {run.size}; {run.cases} cases took {run.processor_seconds} s of processor time."
    note = f"{run.note} Digest: `{run.digest}`.".strip()
    title, text = meanings()[name]
    meaning = f"{' '.join(text.split())}\n\n" if text else ""
    tables = (stored / f"{name}.md").read_text(encoding="utf-8")
    drawn = sorted(path.stem for path in stored.glob(f"{name}*.svg"))
    figures = "".join(f"\n![{each}](figures/{each}.svg)\n" for each in drawn)
    return f"## {title}\n\n{made}\n{note}\n\n{meaning}{tables}{figures}"
