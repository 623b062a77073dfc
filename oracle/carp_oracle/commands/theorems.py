"""`carproof theorems`: prove what holds for all whole numbers."""

import json
from collections.abc import Sequence
from difflib import get_close_matches
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carp_oracle.answer import Answer
from carp_oracle.files import print_document
from carp_oracle.options import examples, json_option
from carp_oracle.progress import progress
from carp_oracle.tables import print_line, print_table

if TYPE_CHECKING:
    from carp_verify.engine import Report

COLUMNS = ("theorem", "rules", "lemmas", "mutants refuted", "result")


@click.command(
    epilog=examples(
        "carproof theorems",
        "carproof theorems earliest_entry_dominates",
        "carproof theorems --json > theorems.json",
    )
)
@click.argument("name", required=False)
@json_option
def command(name: str | None, as_json: bool) -> Answer:
    """Prove all theorems, or tell and prove the one called NAME.

    A theorem is proved for whole numbers of any size: z3 shows that its premises can hold and that its claims
    cannot fail. Each theorem has mutants, with one planted error, which z3 must refute by an example.

    Exit codes: 0 all are proved, 1 some are not (or z3 could not tell), 2 bad input.
    """
    from carp_verify.engine import examine  # noqa: PLC0415 - loads z3
    from carp_verify.theorems import MODULES, theorem_named  # noqa: PLC0415

    modules = MODULES if name is None else (known(name, MODULES),)
    started = perf_counter()
    reports: dict[str, Report] = {}
    with progress("proving", len(modules)) as advance:
        for module in modules:
            reports[module] = examine(theorem_named(module))
            advance()
    proved = all(report.proved for report in reports.values())
    if as_json:
        print_document(document(reports, proved))
    elif name is not None:
        print_report(reports[modules[0]])
    else:
        print_table(COLUMNS, [row(module, report) for module, report in reports.items()], numbers=COLUMNS[2:4])
        for report in reports.values():
            print_failures(report)
        count = sum(report.proved for report in reports.values())
        print_line(f"\n{count} of {len(reports)} theorems proved in {perf_counter() - started:.1f} s".strip())
    return Answer.of(proved)


def known(name: str, modules: Sequence[str]) -> str:
    """The theorem of that name; the nearest names are suggested where there is none."""
    asked = name.replace("-", "_")
    if asked not in modules:
        near = get_close_matches(asked, modules, cutoff=0.4)
        hint = f"the nearest are {', '.join(near)}" if near else "carproof theorems lists them all"
        raise click.BadParameter(f"there is no theorem {name!r}; {hint}.", param_hint="NAME")
    return asked


def row(module: str, report: "Report") -> Sequence[object]:
    """A row of the columns."""
    result = "proved" if report.proved else "NOT PROVED"
    return (module, ", ".join(report.theorem.rules), len(report.lemmas), len(report.refuted), result)


def print_report(report: "Report") -> None:
    """Print a theorem in full: its statement, what was proved, and what refutes its mutants."""
    click.echo(f"{report.theorem.name}\n\n{report.theorem.statement.strip()}\n")
    print_line(f"Supports: {', '.join(report.theorem.rules)}")
    print_table(["lemma", "result"], [(lemma, "proved") for lemma in report.lemmas])
    print_table(["mutant", "refuted by"], report.refuted)
    print_failures(report)
    print_line("proved" if report.proved else "NOT PROVED")


def print_failures(report: "Report") -> None:
    """Print why a theorem is not proved, if it is not."""
    for failure in report.failures:
        print_line(f"{report.theorem.name}: {failure}")


def document(reports: "dict[str, Report]", proved: bool) -> bytes:
    """All reports as one JSON document."""
    theorems = [
        {
            "theorem": module,
            "name": report.theorem.name,
            "statement": report.theorem.statement.strip(),
            "rules": report.theorem.rules,
            "proved": report.proved,
            "lemmas": report.lemmas,
            "mutants": [{"error": error, "refuted_by": model} for error, model in report.refuted],
            "failures": report.failures,
        }
        for module, report in reports.items()
    ]
    return json.dumps({"proved": proved, "theorems": theorems}).encode() + b"\n"
