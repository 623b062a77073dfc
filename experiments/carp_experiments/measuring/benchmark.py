"""The benchmark of the field: cases of the MAPF tracker, a row each, beside its figures and those of other planners.

A case is a map, a scenario and its first agents, as a line of a table names them: `map,scen,agents,lower,upper`, with
the best lower bound and the cost of the best solution that the tracker knew. Robots park. All times are processor time,
but for those of other planners, which keep their own limits. Whatever is counted has been judged: plans by the law, a
bound by the checker of its certificate.
"""

import csv
import subprocess
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import carproof
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import MEASURED, Row
from carp_spec import Instance, Refusal, Solution, judge
from carp_spec.documents.decoding import write
from carp_verify.bound.verify import verify_bound
from carproof.formats import mapf_tracker, read_foreign_solution
from carproof.formats.movingai import read_movingai

COLUMNS = ("map", "scen", "agents", "lower", "upper")
MANY = 10**9
"""The rounds of MAPF-LNS2, which plays none unless their number is given."""
LONGER = 3
"""Another planner is ended after this many times its time and 10 seconds."""
OTHERS = {
    "LaCAM3": lambda program, files, seconds: [
        *(program, "-m", files["map"], "-i", files["scen"], "-N", files["agents"]),
        *("-t", seconds, "-o", files["result"]),
    ],
    "LNS2": lambda program, files, seconds: [
        *(program, "-m", files["map"], "-a", files["scen"], "-k", files["agents"]),
        *("-t", seconds, "--maxIterations", str(MANY), "--outputPaths", files["result"]),
    ],
}


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the table; `None` where the tracker knew nothing."""

    map: str
    scen: str
    agents: int
    lower: float | None
    upper: int | None


@dataclass(frozen=True, slots=True)
class BenchmarkCase:
    """A case; other planners by their names and programs, and the folder for plans and certificates."""

    line: Line
    maps: Path
    seconds: tuple[int, ...]
    bound_seconds: int
    others: tuple[tuple[str, str], ...]
    plans: Path | None

    @property
    def key(self) -> str:
        """The case by its name."""
        return f"{self.line.map} {self.line.scen} {self.line.agents:05}"

    def run(self) -> Row:
        """The totals and the bound; a total is null where a robot has no plan."""
        files = files_of(self.line, self.maps)
        instance = read_movingai(files["map"].read_bytes(), files["scen"].read_bytes(), self.line.agents)
        measured: dict[str, int | None] = {}
        for seconds in self.seconds:
            found = carproof.plan_within(instance, seconds=seconds, clock=time.process_time)
            measured[f"ours {seconds} s"] = total = judged(instance, found)
            if total is not None:
                self._keep(f"{seconds}s.txt", mapf_tracker.write(instance, found).encode())
            for name, program in self.others:
                total = total_of(name, program, instance, files, self.line.agents, seconds)
                measured[f"{name} {seconds} s"] = total
        if self.bound_seconds:
            measured["bound"] = self._bound(instance)
        return {"case": self.key, "lower": self.line.lower, "upper": self.line.upper, MEASURED: measured}

    def _bound(self, instance: Instance) -> int:
        """The verified bound of a certificate, which is kept."""
        from carp_optimum.bound import lower_bound  # noqa: PLC0415 - loads the planners

        certificate = lower_bound(instance, self.bound_seconds, clock=time.process_time_ns)
        self._keep("bound.json", write(certificate))
        return verify_bound(instance, certificate)

    def _keep(self, suffix: str, data: bytes) -> None:
        """Write plans or a certificate, if there is a folder for them."""
        if self.plans is not None:
            self.plans.mkdir(parents=True, exist_ok=True)
            (self.plans / f"{self.line.map}-{self.line.scen}-{self.line.agents}-{suffix}").write_bytes(data)


def judged(instance: Instance, solution: Solution) -> int | None:
    """The total of plans of all robots; raises `Refusal` if they break a rule."""
    verdict = judge(instance, solution)
    for violation in verdict.violations:
        raise Refusal("document", "solution", violation.rule, violation.message)
    return None if verdict.unplanned else verdict.cost


def files_of(line: Line, maps: Path) -> Mapping[str, Path]:
    """The files of a case by absolute paths, wherever in the folder; raises `Refusal` if one is missing."""
    names = {"map": f"{line.map}.map", "scen": f"{line.map}-{line.scen}.scen"}
    found = {kind: next(iter(sorted(maps.absolute().rglob(name))), None) for kind, name in names.items()}
    for kind, path in found.items():
        if path is None:
            raise Refusal("document", str(maps), "benchmark/files", f"the folder has no file {names[kind]}")
    return {kind: path for kind, path in found.items() if path is not None}


def total_of(
    name: str, program: str, instance: Instance, files: Mapping[str, Path], agents: int, seconds: int
) -> int | None:
    """The judged total of another planner; `None` if it finds no plans in the time, or wrong ones."""
    with TemporaryDirectory() as folder:
        result = Path(folder) / "result.txt"
        where = {**{kind: str(path) for kind, path in files.items()}, "agents": str(agents), "result": str(result)}
        command = OTHERS[name](program, where, str(seconds))
        try:
            subprocess.run(  # noqa: S603 - the user's own program
                command, check=False, capture_output=True, timeout=LONGER * seconds + 10, cwd=folder
            )
            return judged(instance, read_foreign_solution(result.read_bytes(), instance, name))
        except (OSError, subprocess.TimeoutExpired, Refusal):
            return None


def read_lines(table: Path) -> tuple[Line, ...]:
    """The lines of a table; raises `Refusal` for a line that is none."""
    lines = []
    with table.open(newline="") as file:
        for number, row in enumerate(csv.DictReader(file), start=2):
            try:
                lower, upper = row["lower"], row["upper"]
                least, best = float(lower) if lower else None, int(upper) if upper else None
                lines.append(Line(row["map"], row["scen"], int(row["agents"]), least, best))
            except (KeyError, TypeError, ValueError):
                message = f"the line must have {', '.join(COLUMNS)}"
                raise Refusal("document", f"{table}:{number}", "benchmark/bounds", message) from None
    return tuple(lines)


def benchmark_report(stored: Iterable[Row]) -> ExperimentReport:
    """The table, and on how many cases ours is the best, or at or below the tracker's best."""
    rows: list[tuple[str, Mapping[str, Any]]] = [(str(row["case"]), dict(row)) for row in stored]
    names = list(dict.fromkeys(name for _, row in rows for name in row[MEASURED]))
    columns = ("case", "tracker's bound", "tracker's best", *names)
    table = Table(
        "benchmark",
        "Sums of costs, robots park; - is no plan for some robot, or no figure",
        columns,
        tuple((key, *map(shown, (row["lower"], row["upper"], *map(row[MEASURED].get, names)))) for key, row in rows),
        columns[1:],
    )
    summary: dict[str, Any] = {"cases": len(rows)}
    lines = []
    for ours in (name for name in names if name.startswith("ours")):
        known = [row for _, row in rows if row["upper"] is not None]
        at_best = sum((total := row[MEASURED].get(ours)) is not None and total <= row["upper"] for row in known)
        summary[ours] = {"at or below the tracker": at_best}
        line = f"{ours}: tracker's best or less on {at_best} of {len(known)}"
        if any(other in names for other in others_of(ours)):
            summary[ours]["best"] = sum(is_least(row[MEASURED], ours) for _, row in rows)
            line += f", no other planner better on {summary[ours]['best']} of {len(rows)}"
        lines.append(line)
    holds = all(
        row[MEASURED][name] is None or row[MEASURED][name] >= row[MEASURED].get("bound", 0)
        for _, row in rows
        for name in names
    )
    return ExperimentReport(summary, (table,), tuple(lines), holds)


def is_least(measured: Mapping[str, int | None], ours: str) -> bool:
    """Whether no other planner has a smaller total in the same time."""
    total = measured.get(ours)
    others = map(measured.get, others_of(ours))
    return total is not None and all(other is None or total <= other for other in others)


def others_of(ours: str) -> Sequence[str]:
    """The columns of other planners in the same time."""
    return [ours.replace("ours", name) for name in OTHERS]


def shown(value: object) -> str:
    """A figure, or that there is none."""
    return "-" if value is None else str(value)


def benchmark_cases(
    table: Path,
    maps: Path,
    seconds: Sequence[int],
    bound_seconds: int,
    others: Mapping[str, str],
    plans: Path | None,
) -> Sequence[BenchmarkCase]:
    """A case a line; raises `Refusal` if a file is missing."""
    lines = read_lines(table)
    for line in lines:
        files_of(line, maps)
    return [BenchmarkCase(line, maps, tuple(seconds), bound_seconds, tuple(others.items()), plans) for line in lines]
