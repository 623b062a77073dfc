"""The report in words: how the answers counted, and in two lines what was shown, and on how large cases."""

from collections.abc import Iterator

from carproof.command_line.tables import counted
from carproof.conform.findings import LEAST_ANSWERED
from carproof.conform.run import Report


def verdict(report: Report) -> tuple[str, str]:
    """Two lines: what the run shows on how many answers, and how large the cases were."""
    return _shown(report), _extent(report)


def _shown(report: Report) -> str:
    level = report.options.level
    answers = counted(report.tested, "answer")
    claim = f"{report.program}, level {level.label} ({report.options.statement}), tested on {answers}"
    if report.conforms:
        return f"CONFORMS: {claim}."
    if report.conforms is None:
        why = "interrupted before anything wrong was found" if report.interrupted else "no random case decided it"
        return f"UNDECIDED: {claim}: {why}."
    return f"DOES NOT CONFORM: {claim}."


def _extent(report: Report) -> str:
    extent = report.extent
    if not extent.robots:
        return "Nothing is shown: no case in which there was something to do was rightly answered."
    size = f"{counted(extent.robots, 'robot')} and {counted(extent.resources, 'resource')}"
    numbers = f"capacity {extent.capacity:,}, duration {extent.duration:,}, pace {extent.pace:,}, tick {extent.tick:,}"
    return f"The largest case rightly answered had {size}; the largest numbers were {numbers}. Nothing is shown beyond."


def details(report: Report) -> Iterator[str]:
    """How many cases of each kind were answered, what was not asked, and whether the failing case is minimal."""
    if report.smallest is not None:
        yield f"the failing {report.smallest.case.stage} case is {_how_small(report)}"
    random = ", ".join(f"{op} {tally}" for op, tally in report.tallies.items()) or "none"
    needed = f"{LEAST_ANSWERED} in 100 needed, seed {report.options.seed}"
    yield f"rightly answered: smoke {report.smoke}; random {random} ({needed}); large {_large(report)}"
    if report.options.claims.left_out:
        yield f"not asked, as it does not claim it: {', '.join(report.options.claims.left_out)}"
    yield from (f"large cases: {cut}" for cut in report.cut)
    if report.options.kernel is not None:
        yield f"decided by {report.options.by}"


def _large(report: Report) -> str:
    """The large cases that were answered, as a `Tally` has the random ones."""
    passed, given_up = report.large["passed"], report.large["gave up"]
    return f"{passed + given_up}" + (f", {given_up} given up" if given_up else "")


def _how_small(report: Report) -> str:
    """Whether the failing random or large case can be made smaller."""
    if not report.repeats:
        return "answered otherwise when it is asked once more: the answer depends on more than the question"
    if report.minimal:
        return "minimal: with any one robot, resource, edge, group or unit of a number less it does not fail"
    return f"perhaps not minimal: the {report.options.shrink_seconds:g} s for shrinking (--shrinking) were over"
