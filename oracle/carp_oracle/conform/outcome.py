"""What came of asking one case."""

from dataclasses import dataclass, replace
from time import monotonic

from carp_oracle.conform.answers import Answer, Skipped
from carp_oracle.conform.cases import Case
from carp_oracle.conform.findings import Fault, Finding
from carp_oracle.conform.judges import first_finding
from carp_oracle.conform.levels import Level
from carp_oracle.conform.subjects import Subject


@dataclass(frozen=True, slots=True)
class Outcome:
    """A case, what is wrong with the answer if anything is, the answer if there is one, and why it was skipped."""

    case: Case
    finding: Finding | None = None
    answer: Answer | None = None
    skipped: str | None = None
    seconds: float = 0.0

    @property
    def is_judged(self) -> bool:
        """Whether the case was answered, rightly or wrongly."""
        return self.skipped is None


def ask(subject: Subject, case: Case, level: Level, seconds: float | None = None) -> Outcome:
    """Ask a subject one case, and judge its answer by the level; `seconds` is the time of the subject alone."""
    started = monotonic()
    try:
        reply = subject.ask(case, seconds)
    except Fault as fault:
        return Outcome(case, fault.finding, seconds=monotonic() - started)
    taken = monotonic() - started
    if isinstance(reply, Skipped):
        return Outcome(case, skipped=reply.why, seconds=taken)
    return replace(Outcome(case, answer=reply, seconds=taken), finding=first_finding(case, reply, level))
