"""The outcome of one case."""

from dataclasses import dataclass
from time import monotonic

from carproof.conform.answers import Answer, NotAsked, Skipped
from carproof.conform.by_kernel import require_agreement
from carproof.conform.cases import Case
from carproof.conform.claims import features
from carproof.conform.effort import Effort, effort, why_undecided
from carproof.conform.findings import Fault, Finding
from carproof.conform.judges import first_finding
from carproof.conform.levels import Level
from carproof.conform.subjects import Subject


@dataclass(frozen=True, slots=True)
class Outcome:
    """A case with the fault of the answer, if any, the answer, if any, and the reason if it was skipped.

    `asked` is whether the program could be asked at all, and `effort` the effort of a right answer.
    """

    case: Case
    finding: Finding | None = None
    answer: Answer | None = None
    skipped: str | None = None
    asked: bool = True
    effort: Effort | None = None
    seconds: float = 0.0

    @property
    def is_judged(self) -> bool:
        """Whether the case was answered, rightly or wrongly."""
        return self.skipped is None

    def shows_what(self, other: "Outcome") -> bool:
        """Whether another failure shows nothing more: of the same rule and category, with all features of this one."""
        assert self.finding is not None  # noqa: S101 - both are failures
        assert other.finding is not None  # noqa: S101
        is_alike = self.finding.key == other.finding.key
        return is_alike and features(self.case.instance) <= features(other.case.instance)


def ask(subject: Subject, case: Case, level: Level, seconds: float | None = None, by_kernel: bool = False) -> Outcome:
    """Ask a subject one case, and judge its answer by the level; `seconds` is the time of the subject alone.

    Raises `ContradictionError` if the proved kernel, where it is to decide, decides otherwise.
    """
    started = monotonic()
    try:
        reply = subject.ask(case, seconds)
    except Fault as fault:
        return Outcome(case, fault.finding, seconds=monotonic() - started)
    taken = monotonic() - started
    if isinstance(reply, Skipped | NotAsked):
        return Outcome(case, skipped=reply.why, asked=isinstance(reply, Skipped), seconds=taken)
    finding = first_finding(case, reply, level)
    if by_kernel:
        require_agreement(case, reply, level, finding)
    if finding is not None:
        return Outcome(case, finding, reply, seconds=taken)
    undecided = why_undecided(case, reply, level)
    shown = effort(case, reply) if undecided is None else None
    return Outcome(case, None, reply, undecided, effort=shown, seconds=taken)
