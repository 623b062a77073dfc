"""The page of results in the documentation, from the stored runs in experiments/results.

`carproof experiment NAME --store FILE --report experiments/results` writes the results of a run there.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar

import msgspec

from carp_experiments.paper.adding_time import Time
from carp_experiments.paper.claims import Claim, quality_claims, related_claims, reuse_claims, time_claims
from carp_experiments.paper.quality import QualitySummary
from carp_experiments.paper.related_work import Related
from carp_experiments.paper.reuse_counts import ReuseOf

T = TypeVar("T")
RESULTS = Path(__file__).parents[1] / "results"
TITLES = {
    "quality": "Experiment 1: failures and total cost",
    "conventions": "Under which conventions the paper's numbers come out",
    "nearest": "The conventions nearest to the paper, over more assignments",
    "remaining": "Conventions that the screening left out",
    "time": "Experiment 2: the time to plan when the k-th robot comes",
    "reuse": "Queries asked and avoided",
    "gap": "Small maps against the optimum",
    "related": "Fixed paths and greedy best-first",
    "polish": "The distance to the optimum at the paper's size, and the polish",
    "neighbours": "Where the neighbourhood planner helps: kinds of instances, M, and polish",
    "execution": "Late robots: drivers compared",
    "following": "The price of plans without rotations",
    "people": "People first: the cost for the robots",
    "stream": "Streams of robots: throughput up to saturation",
}
MEANINGS = {
    "conventions": "The paper does not say how long a robot stays at its goal, whether it may appear late, or how ties "
    "are broken. Each line changes such answers, and has the paper's algorithms as published or with all plans as they "
    "are as a candidate. The distance was fixed before the run: the relative errors of the two savings, and 1 for each "
    "comparison that is contradicted. Robots that stay until all have arrived have the plans of those that park. "
    "Not among these, but run below: that a robot for which CARP fails at line 10 keeps its plan, and "
    "other divisors of the distance of two robots.",
    "nearest": "The conventions that the screening brought nearest, for more assignments than it had, and carproof's. "
    "Most probably the paper's program kept all plans as they are as one more candidate, its robots stayed at their "
    "goals one tick longer than carproof's, and goals were repeated.",
    "neighbours": "Robots wait in docks beside their starts, so every planner plans all of them. Neighbours save most "
    "where robots are in each other's way. With little time, few neighbours save more than a polish of CARP's plans; "
    "with more, the polish does, which plans all robots again.",
    "execution": "On the clock late robots collide; in order, and switching, none collides or stands for ever, but "
    "robots are later.",
    "following": "Removing rotations costs next to nothing; forbidding following costs much more, and leaves more "
    "robots unplanned.",
    "people": "Every person gets the proved first arrival, and the robots that give way lose a few ticks together. A "
    "robot that becomes a person no longer counts in the cost, so it need not grow with the people.",
    "stream": "Both planners serve every arrival up to the rate at which the map is full; beyond it the throughput "
    "stays and robots wait. Robots wait less where neighbours make room. The throughput is that between the first "
    "quarter of the arrivals at goals and the third.",
}
EXPLANATIONS = """\
Numbers of actions are means over the assignments on which neither of the two fails, so both are compared on the same
ones. A claim with a number is reproduced if the number lies in the 95 % intervals. Any other claim is reproduced if the
intervals support all that it names, in part if they support some of it, and not reproduced if they contradict all of
it; otherwise it is undecided.

Where our conventions may make the difference:

- when a robot appears at its start and leaves its goal, which the paper does not say: ours is at its start from tick 0
  on, and vanishes one tick after it has entered its goal (`plan/start`, `plan/goal`);
- whether two robots may swap places: ours may not (`joint/exchange`);
- how ties are broken, in a query, among nearest robots, and among orders of equal cost (`query/ties`,
  `neighbourhood/nearest`, `neighbourhood/best`);
- what Algorithm 1 does where CARP fails at its line 10, on which the failures of Proposed depend
  (`neighbourhood/replan`);
- whether all plans as they are, and CARP for the new robot, are a candidate: not in Algorithm 1 as published, but maybe
  in the program that was measured (`neighbourhood/baseline`; the second verdict concerns that variant);
- whether starts and goals are distinct (ours are), and which trees and edges the maps have;
- over which assignments the paper's means are: an algorithm that fails on the hard ones looks better without them;
- times depend on the program: ours never asks most queries of the neighbourhood planner, which the paper's asks.
"""


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


def claims_of(run: Run) -> Iterator[Claim]:
    """The paper's claims that a run decides."""
    if run.experiment == "quality":
        yield from quality_claims(summary_of(run, QualitySummary))
    elif run.experiment == "time":
        yield from time_claims(summary_of(run, tuple[Time, ...]))
    elif run.experiment == "reuse":
        yield from reuse_claims(summary_of(run, tuple[ReuseOf, ...]))
    elif run.experiment == "related":
        yield from related_claims(summary_of(run, tuple[Related, ...]))


def summary_of(run: Run, type: type[T]) -> T:
    """The summary of a run, in its own type."""
    return msgspec.json.decode(run.summary, type=type)


def results(stored: Path = RESULTS) -> str:
    """The claims, then each experiment with its run, tables and figures, of the runs stored in a folder."""
    runs = {name: read_run(path) for name in TITLES if (path := stored / f"{name}.json").exists()}
    claims = [claim for run in runs.values() for claim in claims_of(run)]
    lines = [
        f"| {claim.claim} | {with_reason(claim.verdict, claim.reason)} | "
        f"{with_reason(claim.with_baseline or '', claim.reason_with_baseline)} | {claim.found} |\n"
        for claim in claims
    ]
    head = "| the paper says | as published | with the baseline | we find |\n| --- | --- | --- | --- |\n"
    parts = [f"## The paper's claims\n\n{head}{''.join(lines)}\n{EXPLANATIONS}"]
    parts += [section(name, run, stored) for name, run in runs.items()]
    return "\n".join(parts)


def with_reason(verdict: str, reason: str) -> str:
    """A verdict in bold, or with its reason behind it; fpdf prints no cell that is both."""
    return f"{verdict}: {reason}" if reason else f"**{verdict}**" if verdict else ""


def section(name: str, run: Run, stored: Path) -> str:
    """An experiment: the run, its tables, its figures."""
    made = f"`{run.command}`: {run.size}; {run.cases} cases took {run.processor_seconds} s of processor time."
    note = f"{run.note} Digest: `{run.digest}`.".strip()
    meaning = f"{MEANINGS[name]}\n\n" if name in MEANINGS else ""
    tables = (stored / f"{name}.md").read_text(encoding="utf-8")
    drawn = sorted(path.stem for path in stored.glob(f"{name}*.svg"))
    figures = "".join(f"\n![{each}](figures/{each}.svg)\n" for each in drawn)
    return f"## {TITLES[name]}\n\n{made}\n{note}\n\n{meaning}{tables}{figures}"
