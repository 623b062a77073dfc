"""A run: smoke cases, test vectors, then random cases; it ends with a report, also when it is interrupted."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from carp_oracle.conform.cases import Case
from carp_oracle.conform.findings import Category, Fault, Finding
from carp_oracle.conform.levels import JUDGED_OPS, Level
from carp_oracle.conform.outcome import Outcome, ask
from carp_oracle.conform.shrinking import SHRINK_SECONDS, Search
from carp_oracle.conform.smoke import smoke_cases
from carp_oracle.conform.subjects import Subject
from carp_oracle.conform.vector_cases import vector_cases
from carp_spec import Solution

MOST_FAULTS = 3
"""After so many crashes, timeouts and protocol errors no further fixed case is asked: each costs a new process."""


@dataclass(frozen=True, slots=True)
class Options:
    """How a program is asked; `whole`: whole instances, each by a planner of the program's own.

    `classical`: besides, random ones are classical multi-agent path finding.
    """

    level: Level = Level.SOUND
    examples: int = 200
    seed: int = 0
    limit: float = 5.0
    shrink_seconds: float = SHRINK_SECONDS
    whole: bool = False
    classical: bool = False


@dataclass(slots=True)
class Report:
    """What a run has found so far.

    `outcomes` are those of the fixed cases, `random` counts the random ones by what came of them, and `judged` the
    answers of each op. `smallest` is the failing random case after shrinking. A fault without a case, at the
    start or at the stop, is in `faults`.
    """

    options: Options
    program: str = ""
    outcomes: list[Outcome] = field(default_factory=list)
    random: Counter[str] = field(default_factory=Counter)
    judged: Counter[str] = field(default_factory=Counter)
    smallest: Outcome | None = None
    faults: list[Finding] = field(default_factory=list)
    interrupted: bool = False

    @property
    def failures(self) -> list[Outcome]:
        """The failures, the smallest first, of each rule and category one."""
        found = ([] if self.smallest is None else [self.smallest]) + self.outcomes
        by_key: dict[tuple[Category, str], Outcome] = {}
        for outcome in sorted(found, key=lambda outcome: outcome.case.size):
            if outcome.finding is not None:
                by_key.setdefault(outcome.finding.key, outcome)
        return list(by_key.values())

    @property
    def findings(self) -> list[Finding]:
        """All that is wrong."""
        return [*self.faults, *(outcome.finding for outcome in self.failures if outcome.finding is not None)]

    @property
    def processes_lost(self) -> int:
        """How many of the fixed cases ended in anything but an answer."""
        findings = [outcome.finding for outcome in self.outcomes if outcome.finding is not None]
        return sum(finding.category != Category.WRONG_ANSWER for finding in findings)

    @property
    def reaches_level(self) -> bool:
        """Whether the program has answered what the level is about; who skips everything conforms to nothing."""
        ops = JUDGED_OPS[self.options.level]
        if self.options.whole:
            return self.judged["plan"] > 0
        return any(self.judged[op] for op in ops)

    @property
    def conforms(self) -> bool | None:
        """Whether the program conforms; `None` if an interruption leaves it undecided."""
        if self.findings:
            return False
        return None if self.interrupted else self.reaches_level

    def add(self, outcome: Outcome) -> None:
        """Count an outcome."""
        if outcome.case.stage == "random":
            self.random[label(outcome)] += 1
        else:
            self.outcomes.append(outcome)
        if outcome.answer is not None and not _is_silent(outcome):
            self.judged[outcome.case.op] += 1


def _is_silent(outcome: Outcome) -> bool:
    """Whether a classical planner has planned nobody: as good as no answer, if it never does more."""
    answer = outcome.answer
    return outcome.case.classical and isinstance(answer, Solution) and not answer.plans


def label(outcome: Outcome) -> str:
    """What came of a case, in a word or two."""
    if outcome.finding is not None:
        return outcome.finding.category.value
    return "passed" if outcome.is_judged else "skipped"


def conform(subject: Subject, options: Options, advance: Callable[[], None] = lambda: None) -> Report:
    """Ask the subject everything, and report; `advance` is called for each case but those of shrinking."""
    report = Report(options, subject.name)
    try:
        _ask_everything(subject, report, advance)
        subject.finish()
    except Fault as fault:
        report.faults.append(fault.finding)
    except KeyboardInterrupt:
        report.interrupted = True
    finally:
        subject.kill()
    report.program = subject.name
    return report


def _ask_everything(subject: Subject, report: Report, advance: Callable[[], None]) -> None:
    options = report.options
    subject.start()
    for cases in (smoke_cases, vector_cases):
        _ask_fixed(subject, report, cases(subject.ops, options.level, options.whole), advance)
    _ask_random(subject, report, advance)


def _ask_fixed(subject: Subject, report: Report, cases: Iterable[Case], advance: Callable[[], None]) -> None:
    for case in cases:
        if report.processes_lost >= MOST_FAULTS:
            return
        asked = replace(case, classical=report.options.classical)
        report.add(ask(subject, asked, report.options.level))
        advance()


def _ask_random(subject: Subject, report: Report, advance: Callable[[], None]) -> None:
    from carp_oracle.conform.classical_cases import classical_cases  # noqa: PLC0415 - loads hypothesis
    from carp_oracle.conform.random_cases import random_cases  # noqa: PLC0415 - loads hypothesis

    options = report.options
    cases = classical_cases() if options.classical else random_cases(subject.ops, options.level, options.whole)
    if cases is None or options.examples == 0:
        return

    def ask_one(case: Case, seconds: float | None) -> Outcome:
        outcome = ask(subject, case, options.level, seconds)
        if search.best is None:
            report.add(outcome)
            advance()
        return outcome

    search = Search(ask_one, options.limit, options.shrink_seconds)
    try:
        search.run(cases, options.examples, options.seed)
    finally:
        report.smallest = search.best
