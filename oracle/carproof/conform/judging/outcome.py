"""The outcome of one case that a subject was asked."""

from dataclasses import dataclass
from time import monotonic

from carp_spec import Refusal
from carproof.conform.answers import Answer, Skipped, Subject
from carproof.conform.cases import Case, is_large
from carproof.conform.findings import Fault, Finding
from carproof.conform.judging.by_kernel import require_agreement
from carproof.conform.judging.claims import features
from carproof.conform.judging.gave_up import Effort, effort, why_undecided
from carproof.conform.judging.judges import first_finding
from carproof.conform.levels import Level


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
    def fault(self) -> Finding:
        """The fault of a failure."""
        assert self.finding is not None  # noqa: S101 - a failure has one
        return self.finding

    @property
    def is_judged(self) -> bool:
        """Whether the case was answered, rightly or wrongly."""
        return self.skipped is None

    def subsumes(self, other: "Outcome") -> bool:
        """Same rule and category, and at least this failure's features."""
        return self.fault.key == other.fault.key and features(self.case) <= features(other.case)


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
    if isinstance(reply, Skipped):
        return Outcome(case, skipped=reply.why, asked=reply.asked, seconds=taken)
    try:
        finding = first_finding(case, reply, level)
        if by_kernel:
            require_agreement(case, reply, level, finding)
        if finding is not None:
            return Outcome(case, finding, reply, seconds=taken)
        undecided = why_undecided(case, reply, level)
        shown = effort(case, reply) if undecided is None else None
    except Refusal as refusal:
        if not is_large(case.instance):
            raise
        return Outcome(case, None, reply, f"carproof cannot judge it: {refusal.message}", seconds=taken)
    return Outcome(case, None, reply, undecided, effort=shown, seconds=taken)
