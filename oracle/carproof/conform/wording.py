"""The verdict of a run in a line: what was tested, on how many answers, and what was left out."""

from carproof.command_line.tables import counted
from carproof.conform.findings import LEAST_ANSWERED
from carproof.conform.run import Report


def verdict(report: Report) -> str:
    """The verdict, with the answers that decided it."""
    level = report.options.level
    answers = counted(report.tested, "answer")
    tested = f"{report.program}, level {level.label} ({report.options.statement}), tested on {answers}"
    if report.conforms:
        return f"CONFORMS: {tested}; {_answered(report)}"
    if report.conforms is None:
        why = "interrupted before anything wrong was found" if report.interrupted else "no random case decided it"
        return f"UNDECIDED: {tested}: {why}; {_answered(report)}"
    return f"DOES NOT CONFORM: {tested}; {_answered(report)}"


def _answered(report: Report) -> str:
    """How many cases were answered."""
    random = ", ".join(f"{op} {tally}" for op, tally in report.tallies.items()) or "none"
    needed = f"{LEAST_ANSWERED} in 100 needed, seed {report.options.seed}"
    left_out = "".join(f", {name}" for name in report.options.claims.left_out)
    answered = f"rightly answered: smoke {report.smoke}; random {random} ({needed})"
    return f"{answered}; not asked:{left_out[1:]}" if left_out else answered
