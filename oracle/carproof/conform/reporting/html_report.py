"""The report as one HTML page, which a browser shows without network: the verdict, and each failure in the viewer."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files
from itertools import zip_longest
from pathlib import Path
from string import Template

from carp_spec import Refusal
from carproof.command_line.tables import counted
from carproof.conform.findings import Finding
from carproof.conform.judging.outcome import Outcome
from carproof.conform.reporting.advice import advice_for
from carproof.conform.reporting.documents import RESULTS, counts
from carproof.conform.reporting.drawing import map_drawing
from carproof.conform.reporting.saving import Origin, about_case, filled, judged_solution
from carproof.conform.reporting.wording import verdict
from carproof.conform.run import Report
from carproof.rules import ALL_RULES
from carproof.viewer.colours import variables
from carproof.viewer.page import view

POLICY = "base-uri 'none'; form-action 'none'; connect-src 'none'; object-src 'none'; font-src 'none'; img-src data:"
"""The pages in the frames inherit it, and allow their own script and style alone by one of their own."""


def html_document(report: Report, saved: Sequence[Path], origin: Origin) -> bytes:
    """The page; `saved` are the folders of the failures."""
    level = report.options.level
    failures = [_failure(*each, origin) for each in zip_longest(report.failures, saved)]
    found = [*map(_fault, report.faults), *failures, *(f"<p>{escape(each)}</p>" for each in report.shortfalls)]
    page = Template(files("carproof.conform.reporting").joinpath("report.html").read_text(encoding="utf-8"))
    filled_in = page.substitute(
        policy=POLICY,
        colours=variables(),
        title=escape(f"{report.program}: level {level.label}"),
        answer={True: "yes", False: "no", None: "undecided"}[report.conforms],
        verdict=escape(" ".join(verdict(report))),
        counts=_table(report),
        asked=_list(_asked(report, origin)),
        heading="Findings" if found else "Nothing is wrong",
        findings="\n".join(found),
    )
    return filled_in.encode()


def _table(report: Report) -> str:
    """How many cases of each stage came to what."""
    head = "".join(f"<th>{name}</th>" for name in ("cases", *RESULTS))
    rows = "".join(
        f"<tr><th>{stage}</th>{''.join(f'<td>{count[name]}</td>' for name in RESULTS)}</tr>"
        for stage, count in counts(report).items()
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _asked(report: Report, origin: Origin) -> Mapping[str, str]:
    """The tested parts, and those that were left out."""
    options = report.options
    unasked = Counter(outcome.skipped for outcome in report.outcomes if not outcome.asked)
    return {
        "level": f"{options.level.label}: {options.statement}",
        "tested": f"{counted(report.tested, 'answer')} to {', '.join(options.ops)}",
        "left out": ", ".join(options.claims.left_out) or "nothing",
        "not asked": "; ".join(f"{counted(count, 'case')}: {why}" for why, count in unasked.items()),
        "seed": str(options.seed),
        "large cases": "; ".join(report.cut),
        "decided by": options.by,
        "again": origin.again,
    }


def _list(entries: Mapping[str, str]) -> str:
    return f"<dl>{''.join(f'<dt>{name}</dt><dd>{escape(text)}</dd>' for name, text in entries.items() if text)}</dl>"


def _fault(finding: Finding) -> str:
    """The faults of a program at its start or stop."""
    return _details(_headline(finding, "start and stop"), [_list(_explained(finding)), _stderr(finding)])


def _failure(outcome: Outcome, folder: Path | None, origin: Origin) -> str:
    finding, case, instance = outcome.fault, outcome.case, outcome.case.instance
    size = f"{counted(len(instance.robots), 'robot')}, {counted(len(instance.graph.resources), 'resource')}"
    entries = {**_explained(finding), "about the case": about_case(case)}
    if folder is not None:
        entries |= {"saved in": str(folder), "this case alone": filled(origin.one, case, folder)}
    shown = [_list(entries), f"<pre>{escape(map_drawing(case.instance))}</pre>", _frame(outcome, finding.rule)]
    return _details(_headline(finding, f"{case.name}; {size}"), [*shown, _stderr(finding)])


def _frame(outcome: Outcome, rule: str) -> str:
    """The viewer with the plans; where they are too large for it, a sentence that says so."""
    try:
        shown = view(outcome.case.instance, judged_solution(outcome), title=rule).decode()
    except Refusal as refusal:
        return f"<p>{escape(refusal.message)}</p>"
    return f'<iframe title="{escape(rule)}" sandbox="allow-scripts" loading="lazy" srcdoc="{escape(shown)}"></iframe>'


def _headline(finding: Finding, where: str) -> str:
    return f"<b>{escape(finding.rule)}</b> {finding.category}: {escape(finding.message)} <i>({escape(where)})</i>"


def _explained(finding: Finding) -> Mapping[str, str]:
    statement = next((rule.statement for rule in ALL_RULES if rule.id == finding.rule), "")
    return {"rule": statement, "advice": advice_for(finding.rule)}


def _stderr(finding: Finding) -> str:
    return f"<p>Standard error ended with:</p><pre>{escape(finding.stderr)}</pre>" if finding.stderr else ""


def _details(headline: str, content: Iterable[str]) -> str:
    return f"<details open><summary>{headline}</summary>{''.join(content)}</details>"
