"""The report as documents: JSON for programs, JUnit's XML for continuous integration."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from itertools import zip_longest
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import msgspec

from carproof.command_line.tables import printable
from carproof.conform.findings import Finding
from carproof.conform.judging.deciding import Tally
from carproof.conform.reporting.advice import advice_for
from carproof.conform.run import Report, label

FORMAT = "carproof-conformance/1"
RESULTS = ("passed", "gave up", "skipped", "not asked", "wrong answer", "crash", "timeout", "protocol error")
"""What a case can come to, in the order in which they are counted."""


def counts(report: Report) -> dict[str, Counter[str]]:
    """The number of cases of each stage, by result."""
    by_stage: dict[str, Counter[str]] = {}
    for outcome in report.outcomes:
        by_stage.setdefault(outcome.case.stage, Counter())[label(outcome)] += 1
    large = {"large": report.large} if report.large else {}
    return {**by_stage, "random": report.random, **large}


def report_document(report: Report, saved: Sequence[Path]) -> bytes:
    """The report as one JSON document; `saved` are the folders of the failures."""
    failures = [asdict(finding) for finding in report.faults]
    for outcome, folder in zip_longest(report.failures, saved):
        case = outcome.case
        sizes = {"robots": len(case.instance.robots), "resources": len(case.instance.graph.resources)}
        asked = {"stage": case.stage, "case": case.name, "op": case.op, **sizes}
        asked |= {} if folder is None else {"folder": str(folder)}
        asked |= {"minimal": report.minimal, "repeats": report.repeats} if outcome is report.smallest else {}
        failures.append({**asdict(outcome.fault), **asked})
    random = {op: _tally_fields(tally) for op, tally in report.tallies.items()}
    document = {
        "format": FORMAT,
        "program": report.program,
        "level": report.options.level.label,
        "statement": report.options.statement,
        "tested": report.tested,
        "conforms": report.conforms,
        "by": report.options.by,
        "reaches_level": report.reaches_level,
        "left_out": report.options.claims.left_out,
        "interrupted": report.interrupted,
        "seed": report.options.seed,
        "cases": counts(report),
        "judged": report.judged,
        "largest": report.extent,
        "not_asked": report.cut,
        "answered": {"smoke": _tally_fields(report.smoke), "random": random},
        "shortfalls": report.shortfalls,
        "failures": failures,
        "saved": str(saved[0]) if saved else None,
    }
    return msgspec.json.encode(document) + b"\n"


def _tally_fields(tally: Tally) -> dict[str, int]:
    return {"asked": tally.asked, "answered": tally.answered, "gave_up": tally.gave_up}


def junit_document(report: Report, saved: Sequence[Path]) -> bytes:
    """The report as JUnit's XML: a test for each fixed case, one for all random ones; failures name their folders."""
    suite = Element("testsuite", name=f"carproof conform --level {report.options.level.label}")
    folders = {id(outcome): folder for outcome, folder in zip(report.failures, saved, strict=False)}
    for outcome in report.outcomes:
        test = _test(suite, outcome.case.stage, outcome.case.name, outcome.finding, folders.get(id(outcome)))
        test.set("time", f"{outcome.seconds:.3f}")
        if not outcome.is_judged:
            SubElement(test, "skipped", message=printable(outcome.skipped or ""))
    for stage, count in (("random", report.random), ("large", report.large)):
        if count:
            name = f"{count.total()} cases, seed {report.options.seed}"
            found = report.smallest if report.smallest is not None and report.smallest.case.stage == stage else None
            _test(suite, stage, name, None if found is None else found.finding, folders.get(id(found)))
    for finding in report.faults:
        _test(suite, "process", "start and stop", finding)
    if not report.reaches_level:
        test = _test(suite, "level", report.options.level.label, None)
        message = "; ".join(report.shortfalls) or "no random case decided it"
        SubElement(test, "failure", message=printable(message))
    tests = suite.findall("testcase")
    suite.set("tests", str(len(tests)))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")
    suite.set("skipped", str(len(suite.findall("testcase/skipped"))))
    indent(suite)
    xml: bytes = tostring(suite, encoding="utf-8", xml_declaration=True)
    return xml + b"\n"


def _test(suite: Element, stage: str, name: str, finding: Finding | None, folder: Path | None = None) -> Element:
    test = SubElement(suite, "testcase", classname=f"carproof.{stage}", name=printable(name))
    if finding is not None:
        message = f"{finding.category}: {finding.message} [{finding.rule}]"
        failure = SubElement(test, "failure", type=finding.rule, message=printable(message))
        lines = [f"Advice: {advice_for(finding.rule)}", *([] if folder is None else [f"Saved in {folder}"])]
        failure.text = "".join(c if c in "\n\t" else printable(c) for c in "\n".join([*lines, finding.stderr]).rstrip())
    return test
