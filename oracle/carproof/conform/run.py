"""A run: smoke cases, test vectors, random cases, large ones; it ends with a report, also when it is interrupted."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from time import monotonic

from carp_spec.permutations import splitmix64
from carproof.conform.answers import Subject, protocol_error
from carproof.conform.asking.ladder import SIZES, Rung, large_case, rungs
from carproof.conform.asking.random_cases import classical_case, execution_case, random_cases
from carproof.conform.asking.smoke import smoke_cases
from carproof.conform.asking.vector_cases import vector_cases
from carproof.conform.cases import EXECUTION, Case
from carproof.conform.findings import Category, Fault, Finding, answers_enough
from carproof.conform.judging.claims import EVERYTHING, Claims
from carproof.conform.judging.deciding import Extent, Tally, random_shortfalls, smoke_shortfalls
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome, ask
from carproof.conform.levels import EXAMPLES, EXECUTOR_LEVELS, JUDGED_OPS, Level
from carproof.conform.shrinking import SHRINK_SECONDS, FailureSearch
from carproof.extras import require
from carproof.testing.random_instances import Draw

MOST_FAULTS = 3
"""After this many crashes, timeouts and protocol errors no further fixed case is asked: each costs a new process."""
MOST_DRAWN = 50
"""So many random cases are drawn for one that a program claims."""
LARGEST_PART = 10
"""A large case that takes more than this part of the time for all is too slow: none of its size is asked again."""


@dataclass(frozen=True, slots=True)
class Options:
    """The way a program is asked.

    `whole`: only whole instances, each planned by the program's own planner. `classical`: also, random instances are
    classical multi-agent path finding. `claims`: the features that it can be asked. `kernel`: the name and version of
    the proved kernel, if it decides. `executor`: it is to execute plans, not to make them. `large`: the seconds for
    large cases.
    """

    level: Level = Level.SOUND
    examples: int = EXAMPLES
    seed: int = 0
    limit: float = 5.0
    shrink_seconds: float = SHRINK_SECONDS
    whole: bool = False
    classical: bool = False
    claims: Claims = EVERYTHING
    kernel: str | None = None
    executor: bool = False
    large: float = 0.0

    @property
    def statement(self) -> str:
        """The claim that is judged."""
        return EXECUTOR_LEVELS[self.level] if self.executor else self.level.statement

    @property
    def by(self) -> str:
        """Who decides."""
        return self.kernel or "carp_spec"

    @property
    def ops(self) -> tuple[str, ...]:
        """The ops by which the level is shown."""
        if self.executor:
            return (EXECUTION,)
        return ("plan",) if self.whole else JUDGED_OPS[self.level]


@dataclass(slots=True)
class Report:
    """The results of a run so far.

    `outcomes` are those of the fixed cases. `random` counts the random cases by outcome, `tallies` those of each op,
    `large` the large cases, and `judged` all answers of each op. `extent` is how large the cases rightly answered were,
    and `cut` says which large cases were not asked. `smallest` is the failing random or large case after shrinking, and
    `minimal` whether nothing more can be taken away from it; with `repeats` it failed again when it was asked once
    more. A fault without a case, at the start or at the stop, is in `faults`.
    """

    options: Options
    program: str = ""
    outcomes: list[Outcome] = field(default_factory=list, repr=False)
    random: Counter[str] = field(default_factory=Counter)
    tallies: dict[str, Tally] = field(default_factory=dict)
    large: Counter[str] = field(default_factory=Counter)
    judged: Counter[str] = field(default_factory=Counter)
    extent: Extent = field(default_factory=Extent)
    cut: list[str] = field(default_factory=list)
    smallest: Outcome | None = None
    minimal: bool = False
    repeats: bool = True
    faults: list[Finding] = field(default_factory=list)
    interrupted: bool = False

    @property
    def failures(self) -> list[Outcome]:
        """The distinct failures, the smallest first.

        Of a rule and a category that is the smallest, and each larger one that lacks a feature of all the smaller.
        """
        found = ([] if self.smallest is None else [self.smallest]) + self.outcomes
        distinct: list[Outcome] = []
        for outcome in sorted(found, key=lambda outcome: outcome.case.size):
            if outcome.finding is not None and not any(each.subsumes(outcome) for each in distinct):
                distinct.append(outcome)
        return distinct

    @property
    def findings(self) -> list[Finding]:
        """All findings."""
        return [*self.faults, *(outcome.fault for outcome in self.failures)]

    @property
    def processes_lost(self) -> int:
        """The number of fixed cases that ended without an answer."""
        findings = [outcome.finding for outcome in self.outcomes if outcome.finding is not None]
        return sum(finding.category != Category.WRONG_ANSWER for finding in findings)

    @property
    def smoke(self) -> Tally:
        """The smoke cases."""
        tally = Tally()
        for outcome in self.outcomes:
            if outcome.case.stage == "smoke":
                tally.add(outcome)
        return tally

    @property
    def shortfalls(self) -> list[str]:
        """The reasons why the right answers are too few for the level."""
        if self.findings or self.interrupted:
            return []
        ops = self.options.ops
        if not any(outcome.case.op in ops for outcome in self.outcomes) and not any(op in self.tallies for op in ops):
            level, lower = self.options.level, Level.COMPLETE_IN_CONTEXT
            other = f" (level {lower.label}: {' or '.join(JUDGED_OPS[lower])})" if level == Level.COMPLETE else ""
            offer = f"its answer to start must name {' or '.join(ops)}{other}"
            return [f"it offers nothing that shows the level {level.label}: {offer}"]
        return [*smoke_shortfalls(self.outcomes), *random_shortfalls(self.tallies)]

    @property
    def tested(self) -> int:
        """The number of judged answers to the ops that show the level."""
        return sum(self.judged[op] for op in self.options.ops)

    @property
    def is_decided(self) -> bool:
        """Whether a random case, which no program knows in advance, has decided anything."""
        return any(self.tallies[op].decides for op in self.options.ops if op in self.tallies)

    @property
    def reaches_level(self) -> bool:
        """Whether there are enough answers to what the level is about."""
        return not self.shortfalls and self.is_decided

    @property
    def conforms(self) -> bool | None:
        """Whether the program conforms; `None` if an interruption or too few random cases leave it undecided."""
        if self.findings:
            return False
        if self.interrupted:
            return None
        return False if self.shortfalls else self.is_decided or None

    def add(self, outcome: Outcome) -> None:
        """Count an outcome."""
        if outcome.case.stage == "random":
            self.random[label(outcome)] += 1
            self.tallies.setdefault(outcome.case.op, Tally()).add(outcome)
        elif outcome.case.stage == "large":
            self.large[label(outcome)] += 1
        else:
            self.outcomes.append(outcome)
        by_rules_alone = outcome.case.stage == "large" and self.options.level in (Level.COMPLETE, Level.OPTIMAL)
        if outcome.answer is not None and outcome.is_judged and not by_rules_alone:
            self.judged[outcome.case.op] += 1
            if outcome.case.op in self.options.ops:
                self.extent.add(outcome)


def label(outcome: Outcome) -> str:
    """The outcome of a case, in a word or two."""
    if outcome.finding is not None:
        return outcome.finding.category.value
    if outcome.effort == Effort.GAVE_UP:
        return "gave up"
    return "passed" if outcome.is_judged else "skipped" if outcome.asked else "not asked"


def conform(
    subject: Subject, options: Options, advance: Callable[[], None] = lambda: None, saved: Sequence[Case] = ()
) -> Report:
    """Ask the subject everything, the cases that an earlier run saved first, and report.

    `advance` is called for each case but those of shrinking.
    """
    report = Report(options, subject.name)
    run = _Run(subject, report, advance)
    try:
        run.ask_everything(saved)
        subject.finish(restart=run.search.best is None and not report.findings)
    except Fault as fault:
        report.faults.append(fault.finding)
    except KeyboardInterrupt:
        report.interrupted = True
    finally:
        subject.kill()
        search = run.search
        report.smallest, report.minimal, report.repeats = search.best, search.minimal, search.repeats
    report.program = subject.name
    return report


class _Run:
    """The questions of a run, asked one after the other; the search looks for a random or large failure."""

    def __init__(self, subject: Subject, report: Report, advance: Callable[[], None]) -> None:
        self.subject, self.report, self.advance, self.options = subject, report, advance, report.options
        self.search = FailureSearch(
            self.ask_to_search, self.options.limit, self.options.shrink_seconds, may_ask=self.is_claimed
        )

    def ask(self, case: Case, seconds: float | None = None) -> Outcome:
        return ask(self.subject, case, self.options.level, seconds, self.options.kernel is not None)

    def ask_to_search(self, case: Case, seconds: float | None) -> Outcome:
        """Ask a random case, or after the first failure a smaller one, which does not count."""
        outcome = self.ask(case, seconds)
        if self.search.best is None:
            self.add(outcome)
        return outcome

    def add(self, outcome: Outcome) -> None:
        self.report.add(outcome)
        self.advance()

    def is_claimed(self, case: Case) -> bool:
        return self.options.claims.why_not(case) is None

    def ask_everything(self, saved: Sequence[Case]) -> None:
        options = self.options
        self.subject.start()
        ops = self.subject.ops
        if options.executor:
            if "drive" not in ops:
                raise protocol_error(answers_enough.id, "the answer to start of an executor must name drive")
            ops = options.ops
        compares = not options.executor and (options.level >= Level.COMPLETE or "bound" in ops)
        if compares or options.claims.solvable:
            require("pysat")  # it finds the optima of small instances
        self.ask_fixed(case for case in saved if case.op in ops)
        self.ask_fixed(smoke_cases(ops, options.level, options.whole, options.claims.groups))
        self.ask_fixed(vector_cases(ops, options.level, options.whole, options.claims))
        self.ask_random(ops)
        if options.large and options.examples and not options.executor:
            self.ask_large(ops)

    def ask_fixed(self, cases: Iterable[Case]) -> None:
        for case in cases:
            if self.report.processes_lost >= MOST_FAULTS:
                return
            asked = replace(case, classical=self.options.classical)
            why_not = self.options.claims.why_not(asked)
            self.add(self.ask(asked) if why_not is None else Outcome(asked, skipped=why_not, asked=False))

    def ask_random(self, ops: Sequence[str]) -> None:
        """Ask as many of each op."""
        options = self.options
        by_op = random_cases(ops, options.level, options.whole, options.claims)
        if options.executor:
            by_op = {EXECUTION: execution_case(options.claims)}
        elif options.classical:
            by_op = {"plan": classical_case}
        for number, draw_case in enumerate(by_op.values()):
            examples = (options.examples + number) // len(by_op)
            if self.search.best is None:
                draw = Draw(splitmix64(options.seed))
                drawn = (draw_case(draw) for _ in range(MOST_DRAWN * examples))
                self.search.run(islice(filter(self.is_claimed, drawn), examples))

    def ask_large(self, ops: Sequence[str]) -> None:
        """Ask large cases until one fails or the time is over; of what is too slow, none of its size is asked again."""
        if self.search.best is not None or self.report.findings:
            return
        options, cut = self.options, self.report.cut
        ends, most = monotonic() + options.large, options.large / LARGEST_PART
        too_large: dict[str, int] = {}
        ladder = list(rungs(ops, options.level, options.seed, options.whole))
        for position, rung in enumerate(ladder):
            if monotonic() >= ends:
                cut.append(_not_asked(ladder, position, options.large))
                return
            if rung.robots >= too_large.get(rung.op, rung.robots + 1):
                continue
            started = monotonic()
            case = large_case(rung, options.claims, options.classical)
            if case is None or not self.is_claimed(case):
                continue
            outcome = self.ask(case, min(options.limit, most))
            if outcome.finding is not None and outcome.finding.category == Category.TIMEOUT:
                too_large[rung.op] = rung.robots
                cut.append(f"{rung.op} of {rung.robots} robots is too slow: {outcome.finding.message} ({case.name})")
                continue
            self.add(outcome)
            if outcome.finding is not None:
                self.search.shrink(outcome, outcome.seconds)
                return
            if monotonic() - started > most and rung.robots < SIZES[-1]:
                too_large[rung.op] = next(robots for robots in SIZES if robots > rung.robots)
                message = f"{rung.op} of {rung.robots} robots took more than {most:g} s with its judgement"
                message += ", so none of more robots was asked"
                cut += [message] if message not in cut else []


def _not_asked(ladder: Sequence[Rung], position: int, seconds: float) -> str:
    of_all, left = (Counter(rung.robots for rung in ladder[first:]) for first in (0, position))
    sizes = ", ".join(f"{left[robots]} of {of_all[robots]} of {robots} robots" for robots in SIZES if left[robots])
    return f"the {seconds:g} s for large cases were over; not asked: {sizes}"
